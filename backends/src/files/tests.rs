//! Laws of all formats at once: round trips, refusals, and bytes that nobody meant.

use super::mesh::{mesh_bytes, parse as parse_mesh};
use super::points::{parse as parse_points, points_bytes};
use super::*;
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
use ndarray::{Array1, Array2, ShapeBuilder};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1e3..1e3_f64,
        any::<f64>().prop_filter("finite", |x| x.is_finite()),
        Just(-0.0),
        Just(0.1),
    ]
}

prop_compose! {
    fn a_cloud(dimensions: std::ops::Range<usize>)
        (rows in 1..12_usize, columns in dimensions)
        (columns in Just(columns), all in prop::collection::vec(number(), rows * columns))
        -> PointCloud<f64> {
        PointCloud::new(columns, all).unwrap()
    }
}

prop_compose! {
    fn a_mesh(dimensions: std::ops::Range<usize>)
        (vertices in 4..10_usize, dimension in dimensions)
        (coordinates in prop::collection::vec(number(), vertices * dimension),
         triangles in prop::collection::btree_set(
             prop::sample::subsequence((0..vertices as u32).collect::<Vec<_>>(), 3), 0..12),
         ends in prop::collection::btree_set(
             prop::sample::subsequence((0..vertices as u32).collect::<Vec<_>>(), 2), 0..8),
         cells in prop::collection::vec(0..7_u8, 8),
         rows in prop::collection::vec(-1..i64::from(u32::MAX) + 5, vertices),
         labels in prop::option::of(prop::collection::vec(-3..1_i64 << 40, 12)),
         dimension in Just(dimension), vertices in Just(vertices),
         x in number())
        -> (Mesh, MeshExtras) {
        let curves = ends.iter().zip(cells).map(|(e, c)| CurveEdge::new(e[0], e[1], c)).collect();
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| [t[0], t[1], t[2]]).collect();
        let pieces = labels.map(|l| l[..triangles.len()].to_vec());
        let complex = Complex::new(vertices, triangles, curves).unwrap();
        let cloud = PointCloud::new(dimension, coordinates).unwrap();
        let metadata = serde_json::json!({"eps": x, "by": "a \"test\"\n", "list": [1, null]});
        (Mesh::new(complex, cloud, rows).unwrap(), MeshExtras { metadata, pieces })
    }
}

/// The curves that the triangles alone tell.
fn deduced(mesh: &Mesh) -> Vec<CurveEdge> {
    let complex = &mesh.complex;
    let edges: BTreeSet<[u32; 2]> = complex
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [a, c], [b, c]])
        .collect();
    edges
        .into_iter()
        .filter_map(|[a, b]| {
            let at = |t: &&[u32; 3]| t.contains(&a) && t.contains(&b);
            match complex.triangles.iter().filter(at).count() {
                2 => None,
                n => Some(CurveEdge::new(a, b, n as u8)),
            }
        })
        .collect()
}

proptest! {
    #[test]
    fn points_come_back_to_the_bit(cloud in a_cloud(2..8)) {
        for extension in ["npy", "csv", "xyz"] {
            let bytes = points_bytes(extension, &cloud).unwrap().unwrap();
            // A plain table whose first row is one whole number cannot occur: N is 2 or more.
            let back = parse_points(extension, &bytes, &PointOptions::default()).unwrap();
            prop_assert_eq!(back, AnyCloud::F64(cloud.clone()), "{}", extension);
        }
    }

    #[test]
    fn polygon_points_come_back_to_the_bit(cloud in a_cloud(3..4)) {
        let bytes = points_bytes("ply", &cloud).unwrap().unwrap();
        let back = parse_points("ply", &bytes, &PointOptions::default()).unwrap();
        prop_assert_eq!(back, AnyCloud::F64(cloud));
    }

    #[test]
    fn transposing_and_column_order_are_the_same_points(cloud in a_cloud(2..6)) {
        let (rows, columns) = (cloud.len(), cloud.dimension());
        let rows_first = Array2::from_shape_vec((rows, columns), cloud.coordinates().to_vec()).unwrap();
        let transpose = PointOptions { transpose: true, ..PointOptions::default() };
        let turned = npy::bytes(rows_first.t().as_standard_layout().view());
        prop_assert_eq!(parse_points("npy", &turned, &transpose).unwrap(), AnyCloud::F64(cloud.clone()));
        let mut fortran = Array2::zeros((rows, columns).f());
        fortran.assign(&rows_first);
        let fortran = npy::bytes(fortran.view());
        let plain = PointOptions::default();
        prop_assert_eq!(parse_points("npy", &fortran, &plain).unwrap(), AnyCloud::F64(cloud.clone()));
        let column_major: Vec<f64> = rows_first.t().iter().copied().collect();
        for compressed in [false, true] {
            let mat = mat::tests::file(&[("X", rows as u32, columns as u32, &column_major)], compressed);
            prop_assert_eq!(parse_points("mat", &mat, &plain).unwrap(), AnyCloud::F64(cloud.clone()));
        }
    }

    #[test]
    fn indices_come_back(indices in prop::collection::vec(0..1_usize << 40, 0..20)) {
        for extension in ["npy", "txt"] {
            let bytes = indices::indices_bytes(extension, &indices).unwrap();
            prop_assert_eq!(&indices::parse(extension, &bytes).unwrap(), &indices);
        }
    }

    #[test]
    fn archives_keep_everything((mesh, extras) in a_mesh(1..7)) {
        let bytes = mesh_bytes("npz", &mesh, &extras, None).unwrap().unwrap();
        let back = parse_mesh("npz", &bytes).unwrap();
        prop_assert_eq!(&back.mesh, &mesh);
        prop_assert_eq!(&back.extras, &extras);
        // Reproducible, and a fixed point of reading and writing.
        let again = mesh_bytes("npz", &back.mesh, &back.extras, None).unwrap().unwrap();
        prop_assert_eq!(bytes, again);
    }

    #[test]
    fn grids_keep_the_mesh_in_any_dimension((mesh, extras) in a_mesh(2..7)) {
        let bytes = mesh_bytes("vtu", &mesh, &extras, None).unwrap().unwrap();
        let back = parse_mesh("vtu", &bytes).unwrap();
        prop_assert_eq!(&back.mesh, &mesh);
        prop_assert_eq!(&back.extras.pieces, &extras.pieces);
    }

    #[test]
    fn polygon_files_keep_the_mesh((mesh, extras) in a_mesh(3..4)) {
        let bytes = mesh_bytes("ply", &mesh, &extras, None).unwrap().unwrap();
        let back = parse_mesh("ply", &bytes).unwrap();
        prop_assert_eq!(&back.mesh, &mesh);
        prop_assert_eq!(&back.extras.pieces, &extras.pieces);
    }

    #[test]
    fn texts_keep_places_and_triangles((mesh, extras) in a_mesh(3..4)) {
        for extension in ["obj", "off"] {
            let bytes = mesh_bytes(extension, &mesh, &extras, None).unwrap().unwrap();
            let back = parse_mesh(extension, &bytes).unwrap().mesh;
            prop_assert_eq!(&back.vertices, &mesh.vertices);
            prop_assert_eq!(&back.complex.triangles, &mesh.complex.triangles);
            let lines = extension == "obj" && !mesh.complex.curve_edges.is_empty();
            let curves = if lines { mesh.complex.curve_edges.clone() } else { deduced(&mesh) };
            prop_assert_eq!(back.complex.curve_edges, curves);
        }
    }

    #[test]
    fn given_places_are_shown((mesh, extras) in a_mesh(4..7), shift in number()) {
        let places: Vec<f64> = (0..3 * mesh.complex.vertices).map(|i| i as f64 + shift).collect();
        let places = PointCloud::new(3, places).unwrap();
        for extension in ["ply", "obj", "off"] {
            prop_assert!(mesh_bytes(extension, &mesh, &extras, None).unwrap().is_err());
            let bytes = mesh_bytes(extension, &mesh, &extras, Some(&places)).unwrap().unwrap();
            prop_assert_eq!(&parse_mesh(extension, &bytes).unwrap().mesh.vertices, &places);
        }
        for extension in ["npz", "vtu"] {
            let bytes = mesh_bytes(extension, &mesh, &extras, Some(&places)).unwrap().unwrap();
            prop_assert_eq!(&parse_mesh(extension, &bytes).unwrap().mesh, &mesh);
        }
    }

    /// Random bytes behind the beginning of each format: an answer, no panic.
    #[test]
    fn random_bytes_are_survived(tail in prop::collection::vec(any::<u8>(), 0..400)) {
        let mut mat = mat::tests::file(&[], false);
        mat.extend(&tail);
        read_all(&mat);
        for start in [
            &b""[..], b"\x93NUMPY\x01\x00", b"\x93NUMPY\x03\x00", b"PK\x03\x04", b"PK\x05\x06",
            b"OFF\n", b"OFF\n3 1 0\n", b"ply\nformat ascii 1.0\nelement vertex 3\n", b"v ", b"f ",
            b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty list uint float x\nend_header\n",
            b"<VTKFile><UnstructuredGrid><Piece><Points><DataArray>", b"2\n\nC ", b"ATOM  ",
        ] {
            read_all(&[start, &tail[..]].concat());
        }
    }

    /// Valid files cut short or with a few bytes changed: an answer, no panic.
    #[test]
    fn damaged_files_are_survived(
        (mesh, extras) in a_mesh(3..4),
        cut in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        for bytes in valid_files(&mesh, &extras) {
            read_all(&bytes[..cut.index(bytes.len())]);
            let mut changed = bytes;
            for (at, byte) in &changes {
                let at = at.index(changed.len());
                changed[at] = *byte;
            }
            read_all(&changed);
        }
    }

    /// Binary files are never taken for whole when their end is missing.
    #[test]
    fn truncation_is_noticed((mesh, extras) in a_mesh(3..4), cut in any::<prop::sample::Index>()) {
        let cloud = &mesh.vertices;
        let npy = points_bytes("npy", cloud).unwrap().unwrap();
        prop_assert!(parse_points("npy", &npy[..cut.index(npy.len())], &PointOptions::default()).is_err());
        for extension in ["npz", "ply", "vtu"] {
            let bytes = mesh_bytes(extension, &mesh, &extras, None).unwrap().unwrap();
            // The last byte of a grid is the end of a line.
            let short = &bytes[..cut.index(bytes.len() - 1)];
            prop_assert!(parse_mesh(extension, short).is_err(), "{}", extension);
        }
    }

    #[test]
    fn dense_distances_of_points(cloud in a_cloud(2..4), forth in any::<bool>()) {
        let n = cloud.len();
        // Squares of the largest numbers overflow, which is no matter of files.
        let near = cloud.coordinates().iter().map(|x| if x.abs() > 1e100 { 1.0 } else { *x }).collect();
        let cloud = PointCloud::new(cloud.dimension(), near).unwrap();
        let d: Vec<f64> = (0..n * n).map(|k| cloud.squared_distance(k / n, k % n).sqrt()).collect();
        let bytes = npy::bytes(Array2::from_shape_vec((n, n), d.clone()).unwrap().view());
        let Distances::Dense { count, values } = distances::parse("npy", &bytes).unwrap() else {
            return Err(TestCaseError::fail("dense"));
        };
        prop_assert_eq!((count, &values), (n, &d));
        let (rows, columns): (Vec<i64>, Vec<i64>) = (0..n * n)
            .map(|k| ((k / n) as i64, (k % n) as i64))
            .filter(|(a, b)| if forth { a < b } else { a != b })
            .unzip();
        let data: Vec<f64> = rows.iter().zip(&columns).map(|(&a, &b)| d[a as usize * n + b as usize]).collect();
        let bytes = npz::bytes(&[
            ("row", npy::bytes(Array1::from(rows).view())),
            ("col", npy::bytes(Array1::from(columns).view())),
            ("shape", npy::bytes(Array1::from(vec![n as i64; 2]).view())),
            ("data", npy::bytes(Array1::from(data).view())),
        ]);
        let Distances::Sparse(kept) = distances::parse("npz", &bytes).unwrap() else {
            return Err(TestCaseError::fail("sparse"));
        };
        prop_assert_eq!(kept.pairs(), n * (n - 1) / 2);
        for (k, &d) in d.iter().enumerate() {
            prop_assert_eq!(kept.get((k / n) as u32, (k % n) as u32), Some(d));
        }
    }
}

fn valid_files(mesh: &Mesh, extras: &MeshExtras) -> Vec<Vec<u8>> {
    let mut files: Vec<Vec<u8>> = ["npz", "vtu", "ply", "obj", "off"]
        .iter()
        .map(|e| mesh_bytes(e, mesh, extras, None).unwrap().unwrap())
        .collect();
    files.extend(
        ["npy", "csv", "xyz", "ply"]
            .iter()
            .map(|e| points_bytes(e, &mesh.vertices).unwrap().unwrap()),
    );
    let rows = mesh.vertices.len() as u32;
    for compressed in [false, true] {
        files.push(mat::tests::file(
            &[("points", rows, 3, mesh.vertices.coordinates())],
            compressed,
        ));
    }
    files.push(b"2\n\nC 0 0 1\nH 1 2 3\n2\n\nC 4 5 6\nH 7 8 9\n".to_vec());
    files.push(csr(3, &[0, 1, 2, 3], &[1, 0, 1], &[1.0, 1.0, 2.0]));
    files
}

/// Every reader on the same bytes; the answers do not matter, coming back does.
fn read_all(bytes: &[u8]) {
    for extension in ["npy", "npz", "csv", "txt", "xyz", "pdb", "ply", "mat"] {
        for transpose in [false, true] {
            let options = PointOptions {
                array: None,
                transpose,
            };
            let _ = parse_points(extension, bytes, &options);
        }
    }
    for extension in ["npz", "vtu", "ply", "obj", "off"] {
        let _ = parse_mesh(extension, bytes);
    }
    for extension in ["npy", "txt"] {
        let _ = indices::parse(extension, bytes);
    }
    for extension in ["npy", "npz"] {
        let _ = distances::parse(extension, bytes);
    }
}

fn csr(n: i64, starts: &[i64], columns: &[i64], data: &[f64]) -> Vec<u8> {
    let integers = |v: &[i64]| npy::bytes(Array1::from(v.to_vec()).view());
    npz::bytes(&[
        ("indices", integers(columns)),
        ("indptr", integers(starts)),
        ("format", npy::bytes(Array1::from(b"csr".to_vec()).view())),
        ("shape", integers(&[n, n])),
        ("data", npy::bytes(Array1::from(data.to_vec()).view())),
    ])
}

#[test]
fn bad_points_are_refused_with_place_and_expectation() {
    let folder = tempfile::tempdir().unwrap();
    let array = |rows: usize, columns: usize, v: Vec<f64>| {
        npy::bytes(Array2::from_shape_vec((rows, columns), v).unwrap().view())
    };
    let good = array(2, 2, vec![0.0, 1.0, 2.0, 3.0]);
    let two_arrays = npz::bytes(&[("a", good.clone()), ("b", good.clone())]);
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        ("nan.npy", array(2, 2, vec![0.0, 1.0, f64::NAN, 2.0]),
            "row 1, column 0 (from 0): found NaN, expected a finite number"),
        ("inf.npz", npz::bytes(&[("points", array(1, 2, vec![0.0, f64::INFINITY]))]),
            "points, row 0, column 1 (from 0): found inf, expected a finite number"),
        ("empty.npy", vec![], "found an empty file, expected at least one point"),
        ("empty.npz", vec![], "found an empty file"),
        ("empty.csv", vec![], "found an empty file"),
        ("empty.mat", vec![], "found an empty file"),
        ("empty.ply", vec![], "found an empty file"),
        ("empty.pdb", vec![], "found an empty file"),
        ("none.npy", array(0, 3, vec![]), "found 0 rows of 3 columns, expected at least one point"),
        ("column.npy", array(2, 1, vec![0.0, 1.0]), "found 2 rows of one column, expected at least 2 coordinates"),
        ("column.csv", b"1\n2\n".to_vec(), "found 2 rows of one column"),
        ("flat.npy", npy::bytes(Array1::from(vec![1.0, 2.0]).view()), "found an array of shape [2], expected 2 dimensions"),
        ("cut.npy", good[..good.len() - 1].to_vec(), "found 31 bytes of data, expected 32, as the header promises shape [2, 2]"),
        ("long.npy", [&good[..], b"x"].concat(), "found 33 bytes of data, expected 32"),
        ("bool.npy", npy::bytes(Array2::from_elem((2, 2), true).view()), "type \"|b1\", expected float32"),
        ("text.npy", b"1 2 3\n".to_vec(), "expected a NumPy array, which starts with"),
        ("text.npz", b"1 2 3\n".to_vec(), "found a bad archive"),
        ("two.npz", two_arrays, "found the arrays [a, b], expected one"),
        ("ragged.csv", b"1,2\n3,4,5\n".to_vec(), "line 2: found 3 columns, expected 2 as in the first row"),
        ("word.txt", b"1 2\n3 x4\n".to_vec(), "line 2, column 2: found \"x4\", expected a number"),
        ("infinite.xyz", b"1 2 inf\n".to_vec(), "line 1, column 3: found inf, expected a finite number"),
        ("header.csv", b"x,y\n".to_vec(), "found a header and no row of numbers"),
        ("binary.csv", b"1,2\n\xff\xfe\n".to_vec(), "line 2: found bytes that are no UTF-8, expected a text file"),
        ("frame.xyz", b"2\n\nC 0 0 0\n".to_vec(), "found the end of the file after 1 atoms, expected 2 atoms"),
        ("atoms.pdb", b"REMARK\n".to_vec(), "found no frame with an atom"),
        ("lie.ply", b"ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n".to_vec(),
            "vertex: found 6 bytes behind the header, expected 6000000000 or more"),
        ("flat.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n".to_vec(),
            "vertex: found no number z"),
        ("none.ply", b"ply\nformat ascii 1.0\nend_header\n".to_vec(), "found no element vertex"),
        ("nan.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 NaN\n".to_vec(),
            "line 8: found \"1 2 NaN\", expected the finite numbers"),
        ("nan-binary.ply", [
            &b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\nend_header\n"[..],
            &1.0_f64.to_le_bytes(), &f64::NAN.to_le_bytes(), &1.0_f64.to_le_bytes()].concat(),
            "vertex, row 0, column 1 (from 0): found NaN"),
        ("text.mat", vec![b'x'; 200], "found no MATLAB header"),
        ("nan.mat", mat::tests::file(&[("X", 1, 2, &[1.0, f64::NAN])], true), "row 0, column 1 (from 0): found NaN"),
        ("points.dat", vec![], "found extension .dat, expected one of .npy"),
        ("points", vec![], "found no extension, expected one of .npy"),
    ];
    for (name, bytes, expected) in cases {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let message = read_points(&path, &PointOptions::default())
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{name}: {message}");
        assert!(
            message.starts_with(&path.display().to_string()),
            "{message}"
        );
    }
    let missing = read_points(folder.path().join("no.npy"), &PointOptions::default());
    assert!(missing.unwrap_err().to_string().ends_with("no such file"));
    let inside = folder.path().join("folder.npy");
    std::fs::create_dir(&inside).unwrap();
    let error = read_points(&inside, &PointOptions::default()).unwrap_err();
    assert!(error.to_string().contains("a folder"), "{error}");
}

#[test]
fn single_precision_is_kept_and_integers_become_double() {
    let plain = PointOptions::default();
    let single = npy::bytes(Array2::from_elem((2, 3), 0.1_f32).view());
    let AnyCloud::F32(cloud) = parse_points("npy", &single, &plain).unwrap() else {
        panic!("single precision");
    };
    assert_eq!(cloud.point(1), [0.1_f32; 3]);
    let integers = npy::bytes(Array2::from_elem((2, 3), 7_u16).view());
    let cloud = parse_points("npy", &integers, &plain).unwrap();
    assert_eq!(
        (cloud.len(), cloud.dimension(), cloud.scalar_name()),
        (2, 3, "f64")
    );
}

#[test]
fn bad_meshes_are_refused_with_place_and_expectation() {
    let grid = |cells: &str, offsets: &str, types: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece>\
             <Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\
             0 0 0 1 0 0 0 1 0 1 1 0</DataArray></Points><Cells>\
             <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{cells}</DataArray>\
             <DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{offsets}</DataArray>\
             <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{types}</DataArray>\
             </Cells></Piece></UnstructuredGrid></VTKFile>"
        )
        .into_bytes()
    };
    let archive = |triangles: Vec<i64>| {
        let t = Array2::from_shape_vec((triangles.len() / 3, 3), triangles).unwrap();
        npz::bytes(&[
            ("vertices", npy::bytes(Array2::<f64>::zeros((3, 4)).view())),
            ("triangles", npy::bytes(t.view())),
        ])
    };
    let off = |rest: &str| format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{rest}\n").into_bytes();
    let obj = |rest: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n{rest}\n").into_bytes();
    assert!(parse_mesh("vtu", &grid("0 1 2", "3", "5")).is_ok());
    assert!(parse_mesh("npz", &archive(vec![2, 1, 0])).is_ok());
    assert!(parse_mesh("off", &off("3 0 1 2 255 0 0")).is_ok());
    assert!(parse_mesh("obj", &obj("f 1/1/1 2//1 -1")).is_ok());
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        (
            "npz",
            archive(vec![0, 1, 3]),
            "triangles, row 0, column 2 (from 0): found vertex 3, expected a vertex from 0 to 2",
        ),
        ("npz", archive(vec![0, 1, -1]), "found vertex -1"),
        (
            "npz",
            archive(vec![0, 1, 2, 1, 1, 2]),
            "triangles, row 1 (from 0): found corners [1, 1, 2], expected three different ones",
        ),
        (
            "npz",
            archive(vec![0, 1, 2, 2, 1, 0]),
            "triangle [0, 1, 2] twice",
        ),
        (
            "npz",
            npz::bytes(&[("vertices", npy::bytes(Array2::<f64>::zeros((3, 4)).view()))]),
            "found no array triangles",
        ),
        (
            "npz",
            npz::bytes(&[
                (
                    "vertices",
                    npy::bytes(Array2::from_elem((3, 2), f64::NAN).view()),
                ),
                ("triangles", npy::bytes(Array2::<i64>::zeros((0, 3)).view())),
            ]),
            "vertices, row 0, column 0 (from 0): found NaN",
        ),
        (
            "vtu",
            grid("0 1 2", "4", "5"),
            "offsets, row 0 (from 0): found 4, expected a number from 0 to 3",
        ),
        ("vtu", grid("0 1 2", "-1", "5"), "found -1"),
        (
            "vtu",
            grid("0 1 2 3", "4", "9"),
            "found a cell of type 9 with 4 corners",
        ),
        ("vtu", grid("0 1 4", "3", "5"), "found vertex 4"),
        (
            "vtu",
            grid("0 1 x", "3", "5"),
            "connectivity: found \"x\", expected a number",
        ),
        (
            "vtu",
            grid("0 1 2", "3", "5 5"),
            "types: found 2 entries, expected 1",
        ),
        ("vtu", b"<VTKFile/>".to_vec(), "found 0 pieces"),
        ("vtu", b"<VTKFile>".to_vec(), "line 1: found bad XML"),
        (
            "off",
            off("4 0 1 2 0"),
            "line 6: found \"4\" corners, expected 3",
        ),
        ("off", off("3 0 1 7"), "found vertex 7"),
        (
            "off",
            off(""),
            "found the end of the file after 0 faces, expected 1",
        ),
        (
            "off",
            b"OFF\n1000000000000 1 0\n0 0 0\n".to_vec(),
            "after 1 vertices, expected 1000000000000",
        ),
        (
            "obj",
            obj("f 1 2 3 4"),
            "line 5: found 4 corners, expected 3",
        ),
        ("obj", obj("f 1 2 0"), "line 5, column 4: found \"0\""),
        ("obj", obj("f 1 2 5"), "found vertex 4"),
        ("obj", obj("v 0 nan 0"), "line 5, column 3: found NaN"),
        ("obj", obj("f 1 2 2"), "expected three different ones"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (extension, bytes, expected) in cases {
        let path = folder.path().join(format!("mesh.{extension}"));
        std::fs::write(&path, bytes).unwrap();
        let message = read_mesh(&path).unwrap_err().to_string();
        assert!(message.contains(expected), "{extension}: {message}");
    }
    let error = read_mesh(folder.path().join("mesh.stl")).unwrap_err();
    assert!(matches!(error, FileError::Extension { .. }), "{error}");
}

#[test]
fn writers_refuse_what_does_not_fit() {
    let mesh = Mesh::new(
        Complex::new(3, vec![[0, 1, 2]], vec![]).unwrap(),
        PointCloud::new(4, vec![0.0; 12]).unwrap(),
        vec![0, 1, 2],
    )
    .unwrap();
    let plain = MeshExtras::default();
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, extras: &MeshExtras, places: Option<&PointCloud<f64>>| {
        let path = folder.path().join(name);
        let message = write_mesh(&path, &mesh, extras, places)
            .unwrap_err()
            .to_string();
        assert!(!path.exists());
        message
    };
    assert!(refused("a.ply", &plain, None).contains("found a mesh in R^4, expected places in R^3"));
    let flat = PointCloud::new(2, vec![0.0; 6]).unwrap();
    assert!(refused("a.obj", &plain, Some(&flat)).contains("found 3 places in R^2"));
    let pieces = MeshExtras {
        pieces: Some(vec![1, 2]),
        ..plain.clone()
    };
    assert!(refused("a.npz", &pieces, None).contains("pieces: found 2 labels, expected 1"));
    assert!(refused("a.stl", &plain, None).contains("found extension .stl"));
    assert!(refused("no/a.npz", &plain, None).contains("there is no folder"));
    let points = write_points(folder.path().join("a.ply"), &flat).unwrap_err();
    assert!(
        points.to_string().contains("found points of R^2"),
        "{points}"
    );
}

/// Nesting must not cost stack: a parser that recursed would end the process.
#[test]
fn deep_nesting_is_survived() {
    let deep = |open: &str| open.repeat(200_000).into_bytes();
    for bytes in [deep("<a>"), deep("<VTKFile>"), deep("["), deep("(")] {
        read_all(&bytes);
    }
    let json = npy::bytes(Array1::from(deep("[")).view());
    let bytes = npz::bytes(&[
        ("vertices", npy::bytes(Array2::<f64>::zeros((3, 4)).view())),
        ("triangles", npy::bytes(Array2::<i64>::zeros((0, 3)).view())),
        ("metadata", json),
    ]);
    let flaw = parse_mesh("npz", &bytes).unwrap_err();
    assert!(flaw.found.contains("bad JSON"), "{flaw:?}");
}

#[test]
fn bad_indices_are_refused() {
    let cases = [
        (
            "npy",
            npy::bytes(Array1::from(vec![0, -2_i64]).view()),
            "-2",
        ),
        (
            "npy",
            npy::bytes(Array2::<i64>::zeros((2, 2)).view()),
            "an array of shape [2, 2]",
        ),
        (
            "npy",
            npy::bytes(Array1::from(vec![0.5]).view()),
            "floating point numbers",
        ),
        ("txt", b"1 2\n3 -4\n".to_vec(), "\"-4\""),
        ("txt", b"1.5".to_vec(), "\"1.5\""),
    ];
    for (extension, bytes, found) in cases {
        assert_eq!(indices::parse(extension, &bytes).unwrap_err().found, found);
    }
    assert_eq!(
        indices::parse("txt", b"# rows\n1, 2\t3\n").unwrap(),
        [1, 2, 3]
    );
}

#[test]
fn bad_distances_are_refused() {
    let dense = |n: usize, v: Vec<f64>| {
        let columns = v.len() / n;
        npy::bytes(Array2::from_shape_vec((n, columns), v).unwrap().view())
    };
    for (bytes, found) in [
        (dense(1, vec![0.0, 1.0]), "1 rows of 2 columns"),
        (
            dense(2, vec![0.0, 1.0, 2.0, 0.0]),
            "2, and 1 in the other direction",
        ),
        (dense(2, vec![0.0, -1.0, -1.0, 0.0]), "-1"),
        (dense(2, vec![0.0, f64::INFINITY, 1.0, 0.0]), "inf"),
        (dense(2, vec![0.5, 1.0, 1.0, 0.0]), "0.5"),
    ] {
        assert_eq!(distances::parse("npy", &bytes).unwrap_err().found, found);
    }
    assert!(distances::parse("npz", &csr(2, &[0, 1, 1], &[1], &[3.0])).is_ok());
    for (bytes, found) in [
        (
            csr(2, &[0, 1, 2], &[1, 0], &[3.0, 4.0]),
            "3, and 4 in the other direction",
        ),
        (
            csr(2, &[0, 2, 2], &[1, 1], &[3.0, 3.0]),
            "more than one distance",
        ),
        (csr(2, &[0, 1, 1], &[2], &[3.0]), "2"),
        (csr(2, &[0, 1, 1], &[0], &[3.0]), "3"),
        (csr(2, &[0, 1, 1], &[1], &[f64::NAN]), "NaN"),
        (
            csr(2, &[0, 9, 1], &[1], &[1.0]),
            "3 starts from Some(0) to Some(1)",
        ),
        (
            csr(2, &[0, 1, 1], &[1], &[1.0, 2.0]),
            "2 distances at 1 rows and 1 columns",
        ),
        (csr(0, &[0], &[], &[]), "shape [0, 0]"),
    ] {
        assert_eq!(distances::parse("npz", &bytes).unwrap_err().found, found);
    }
}
