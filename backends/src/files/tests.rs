//! Laws of all formats at once: round trips, refusals, and bytes that nobody meant.

use super::mesh::{mesh_bytes, parse as parse_mesh};
use super::point_writer::points_bytes;
use super::points::parse as parse_points;
use super::*;
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud, Row};
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

/// Every column is a coordinate.
fn all_columns() -> PointOptions {
    PointOptions {
        columns: ColumnChoice::All,
        ..PointOptions::default()
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
            let back = parse_points(extension, &bytes, &all_columns()).unwrap().points;
            prop_assert_eq!(back, AnyCloud::F64(cloud.clone()), "{}", extension);
        }
    }

    #[test]
    fn polygon_points_come_back_to_the_bit(cloud in a_cloud(3..4)) {
        let bytes = points_bytes("ply", &cloud).unwrap().unwrap();
        let back = parse_points("ply", &bytes, &PointOptions::default()).unwrap();
        prop_assert_eq!(back.points, AnyCloud::F64(cloud));
    }

    #[test]
    fn transposing_and_column_order_are_the_same_points(cloud in a_cloud(2..6)) {
        let (rows, columns) = (cloud.len(), cloud.dimension());
        let transpose = PointOptions { transpose: true, ..PointOptions::default() };
        let column_major: Vec<f64> = (0..columns)
            .flat_map(|c| (0..rows).map(move |r| (r, c)))
            .map(|(r, c)| cloud.point(r)[c])
            .collect();
        let turned = npy::bytes(&[columns, rows], &column_major);
        prop_assert_eq!(parse_points("npy", &turned, &transpose).unwrap().points, AnyCloud::F64(cloud.clone()));
        let plain = PointOptions::default();
        for compressed in [false, true] {
            let mat = mat::tests::file(&[("X", rows as u32, columns as u32, &column_major)], compressed);
            prop_assert_eq!(parse_points("mat", &mat, &plain).unwrap().points, AnyCloud::F64(cloud.clone()));
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
        prop_assert_eq!(&back.extras, &extras);
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

    /// Corners with 24 bits are kept; the others are where they were, as far as that goes.
    #[test]
    fn printers_files_keep_the_triangles((mesh, extras) in a_mesh(3..4)) {
        let small: Vec<f64> = (0..3 * mesh.complex.vertices).map(|k| (k * k) as f64 / 8.0).collect();
        let places = PointCloud::new(3, small).unwrap();
        let mesh = Mesh::new(mesh.complex, places, mesh.point_index).unwrap();
        let bytes = mesh_bytes("stl", &mesh, &extras, None).unwrap().unwrap();
        let back = parse_mesh("stl", &bytes).unwrap().mesh;
        let corners = |mesh: &Mesh| -> BTreeSet<Vec<Vec<u64>>> {
            let place = |v: u32| mesh.vertices.point(v as usize).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            let sorted = |t: &[u32; 3]| { let mut all = t.map(place).to_vec(); all.sort(); all };
            mesh.complex.triangles.iter().map(sorted).collect()
        };
        prop_assert_eq!(corners(&back), corners(&mesh));
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
            b"# .PCD\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA binary_compressed\n",
            b"# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 2 ", b"LASF", b"solid\nvertex ",
            b"nOFF\n4\n", b"<VTKFile compressor=\"vtkZLibDataCompressor\"><PolyData><Piece><Points>\
            <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>\
            </Piece></PolyData><AppendedData encoding=\"raw\">_",
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
        let bytes = npy::bytes(&[n, n], &d);
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
            ("row", npy::bytes(&[rows.len()], &rows)),
            ("col", npy::bytes(&[columns.len()], &columns)),
            ("shape", npy::bytes(&[2], &[n as i64; 2])),
            ("data", npy::bytes(&[data.len()], &data)),
        ]);
        let Distances::Sparse(kept) = distances::parse("npz", &bytes).unwrap() else {
            return Err(TestCaseError::fail("sparse"));
        };
        prop_assert_eq!(kept.pairs(), n * (n - 1) / 2);
        for (k, &d) in d.iter().enumerate() {
            prop_assert_eq!(kept.get(Row::new(k / n), Row::new(k % n)), Some(d));
        }
    }
}

fn valid_files(mesh: &Mesh, extras: &MeshExtras) -> Vec<Vec<u8>> {
    let mut files: Vec<Vec<u8>> = MESH_EXTENSIONS
        .split(", ")
        .map(|e| &e[1..])
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
    files.push(las::tests::file(&[[1, 2, 3], [4, 5, 6]]));
    files.push(las::tests::packed(&[[1, 2, 3], [4, 5, 6]]));
    files.push(trajectory::tests::xtc(2, 12));
    files.push(trajectory::tests::dcd(2, 3, false, true));
    files.push(b"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n".to_vec());
    files.push(b"solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n".to_vec());
    files.push(b"2\n\nC 0 0 1\nH 1 2 3\n2\n\nC 4 5 6\nH 7 8 9\n".to_vec());
    files.push(csr(3, &[0, 1, 2, 3], &[1, 0, 1], &[1.0, 1.0, 2.0]));
    files
}

/// Every reader on the same bytes; the answers do not matter, coming back does.
fn read_all(bytes: &[u8]) {
    for extension in [
        "npy", "npz", "csv", "tsv", "txt", "xyz", "pts", "pdb", "ply", "mat", "pcd", "laz", "xtc",
        "dcd",
    ] {
        for transpose in [false, true] {
            let options = PointOptions {
                transpose,
                ..PointOptions::default()
            };
            let _ = parse_points(extension, bytes, &options);
        }
    }
    for extension in MESH_READ_EXTENSIONS.split(", ").map(|e| &e[1..]) {
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
    let integers = |v: &[i64]| npy::bytes(&[v.len()], v);
    npz::bytes(&[
        ("indices", integers(columns)),
        ("indptr", integers(starts)),
        ("format", npy::bytes(&[3], b"csr")),
        ("shape", integers(&[n, n])),
        ("data", npy::bytes(&[data.len()], data)),
    ])
}

#[test]
fn bad_points_are_refused_with_place_and_expectation() {
    let folder = tempfile::tempdir().unwrap();
    let array = |rows: usize, columns: usize, v: Vec<f64>| npy::bytes(&[rows, columns], &v);
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
        ("flat.npy", npy::bytes(&[2], &[1.0, 2.0]), "found an array of shape [2], expected 2 dimensions"),
        ("cut.npy", good[..good.len() - 1].to_vec(), "found 31 bytes of data, expected 32, as the header promises shape [2, 2]"),
        ("long.npy", [&good[..], b"x"].concat(), "found 33 bytes of data, expected 32"),
        ("batch.npy", npy::bytes(&[2, 1, 2], &[1.0; 4]), "shape [2, 1, 2], expected 2 dimensions: rows and columns: array.reshape"),
        ("wide.csv.gz", b"1,2\n".to_vec(), "found bad gzip data"),
        ("text.npy", b"1 2 3\n".to_vec(), "expected a NumPy array, which starts with"),
        ("text.npz", b"1 2 3\n".to_vec(), "found a bad archive"),
        ("two.npz", two_arrays, "found the arrays [a, b], expected one"),
        ("ragged.csv", b"1,2\n3,4,5\n".to_vec(), "line 2: found 3 columns, expected 2 as in the first row"),
        ("word.txt", b"1 2\n3 x4\n".to_vec(), "line 2, column 2: found \"x4\", expected a number: leave the row out"),
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
            "line 8, column 3: found NaN, expected a finite number"),
        ("nan-binary.ply", [
            &b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\nend_header\n"[..],
            &1.0_f64.to_le_bytes(), &f64::NAN.to_le_bytes(), &1.0_f64.to_le_bytes()].concat(),
            "vertex, row 0, column 1 (from 0): found NaN"),
        ("text.mat", vec![b'x'; 200], "found no MATLAB header"),
        ("nan.mat", mat::tests::file(&[("X", 1, 2, &[1.0, f64::NAN])], true), "row 0, column 1 (from 0): found NaN"),
        ("points.bin", vec![], "found extension .bin, expected one of .npy"),
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

/// Places on a unit sphere about (2, 0, 0), with what scanners and viewers write behind them.
fn sphere_rows(attributes: impl Fn(usize, [f64; 3]) -> String) -> String {
    let row = |k: usize| {
        let (u, v) = (2.4 * k as f64, 1.0 - (2 * k + 1) as f64 / 200.0);
        let r = (1.0 - v * v).sqrt();
        let n = [r * u.cos(), r * u.sin(), v];
        format!(
            "{:.6} {:.6} {:.6} {}\n",
            n[0] + 2.0,
            n[1],
            n[2],
            attributes(k, n)
        )
    };
    (0..200).map(row).collect()
}

#[test]
fn normals_and_colors_are_no_dimensions() {
    let read = |extension: &str, text: &str| {
        parse_points(extension, text.as_bytes(), &PointOptions::default()).unwrap()
    };
    let plain = read("xyz", &sphere_rows(|_, _| String::new()));
    assert!(plain.remarks.is_empty() && plain.points.dimension() == 3);
    let normal = |n: [f64; 3]| format!("{:.6} {:.6} {:.6}", n[0], n[1], n[2]);
    let color = |k: usize| format!("{} {} 7", k % 256, 255 - k % 256);
    let normals = sphere_rows(|k, n| {
        if k % 50 == 9 {
            "0 0 0".into()
        } else {
            normal(n)
        }
    });
    let both = sphere_rows(|k, n| format!("{} {}", color(k), normal(n)));
    for (text, meanings) in [
        (&normals, vec![Meaning::Normals { from: 3 }]),
        (
            &sphere_rows(|k, _| color(k)),
            vec![Meaning::Colors { from: 3 }],
        ),
        (
            &sphere_rows(|k, n| format!("{} 0.{k}", normal(n))),
            vec![Meaning::Normals { from: 3 }],
        ),
        (
            &sphere_rows(|k, _| format!("0.{k} {}", color(k))),
            vec![Meaning::Colors { from: 4 }],
        ),
        (
            &both,
            vec![Meaning::Colors { from: 3 }, Meaning::Normals { from: 6 }],
        ),
    ] {
        let columns = text.lines().next().unwrap().split_whitespace().count();
        let file = read("xyz", text);
        assert_eq!(file.points, plain.points);
        assert_eq!(
            file.remarks,
            [Remark::FirstThree {
                columns,
                meanings: meanings.clone()
            }]
        );
        // Elsewhere they are taken, and told.
        let table = read("txt", text);
        assert_eq!(table.points.dimension(), columns);
        assert_eq!(table.remarks[0], Remark::Suspect { columns, meanings });
        let three = PointOptions {
            columns: "0-2".parse().unwrap(),
            ..PointOptions::default()
        };
        let chosen = parse_points("txt", text.as_bytes(), &three).unwrap();
        assert_eq!(
            (chosen.points, chosen.remarks),
            (plain.points.clone(), vec![])
        );
    }
    // Two numbers more could be anything, and vectors of other lengths are no normals.
    for extra in [
        |_, n: [f64; 3]| format!("{0} {0} {0} 0 0", n[0]),
        |k, _| format!("0.5 0.1 0.{k}"),
    ] {
        let text = sphere_rows(extra);
        let columns = text.lines().next().unwrap().split_whitespace().count();
        assert_eq!(read("xyz", &text).points.dimension(), columns);
    }
    let scan = read(
        "pts",
        &format!("200\n{}", sphere_rows(|k, _| format!("-{k}"))),
    );
    assert_eq!(scan.points, plain.points);
}

#[test]
fn columns_that_tell_nothing_are_told() {
    let read = |extension: &str, bytes: &[u8]| {
        parse_points(extension, bytes, &PointOptions::default())
            .unwrap()
            .remarks
    };
    let numbered: String = (0..9)
        .map(|k| format!("{k},{}.5,7,{}\n", k * k, k % 3))
        .collect();
    let expected = [
        Remark::Counts { column: 0 },
        Remark::Constant {
            column: 2,
            value: 7.0,
        },
    ];
    assert_eq!(read("csv", numbered.as_bytes()), expected);
    let flat = npy::bytes(&[3, 100], &[0.5; 300]);
    assert_eq!(
        read("npy", &flat),
        [Remark::Wide {
            rows: 3,
            columns: 100
        }]
    );
    let named = format!("id,x,y,z\n{numbered}");
    let [
        Remark::Named { left, .. },
        Remark::Constant { column: 2, .. },
    ] = &read("csv", named.as_bytes())[..]
    else {
        panic!("x, y, z are taken by name");
    };
    assert_eq!(left, &["id"]);
    let six: String = (0..9)
        .map(|k| format!("{0},{0},{1},{0},{1},{1}\n", k * k, k % 4))
        .collect();
    assert_eq!(read("csv", six.as_bytes()), [Remark::Many { columns: 6 }]);
    // A map in single precision: steps of 1/32 at 500,000, points a tenth apart.
    let map: Vec<f32> = (0..300)
        .map(|k| 5e5 + (k / 3) as f32 * 0.01 * ((k % 3) as f32))
        .collect();
    let bytes = npy::bytes(&[100, 3], &map);
    let coarse = read("npy", &bytes);
    assert!(
        coarse
            .iter()
            .any(|r| matches!(r, Remark::Coarse { bits: 32, step, .. } if *step == 0.03125)),
        "{coarse:?}"
    );
    let near: Vec<f32> = map.iter().map(|x| x - 5e5).collect();
    let near = read("npy", &npy::bytes(&[100, 3], &near));
    assert!(
        !near.iter().any(|r| matches!(r, Remark::Coarse { .. })),
        "{near:?}"
    );
}

#[test]
fn single_precision_is_kept_and_integers_become_double() {
    let plain = PointOptions::default();
    let single = npy::bytes(&[2, 3], &[0.1_f32; 6]);
    let AnyCloud::F32(cloud) = parse_points("npy", &single, &plain).unwrap().points else {
        panic!("single precision");
    };
    assert_eq!(cloud.point(1), [0.1_f32; 3]);
    let integers = npy::bytes(&[2, 3], &[7_u16; 6]);
    let cloud = parse_points("npy", &integers, &plain).unwrap().points;
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
        let t = npy::bytes(&[triangles.len() / 3, 3], &triangles);
        npz::bytes(&[
            ("vertices", npy::bytes(&[3, 4], &[0.0; 12])),
            ("triangles", t),
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
            npz::bytes(&[("vertices", npy::bytes(&[3, 4], &[0.0; 12]))]),
            "found no array triangles",
        ),
        (
            "npz",
            npz::bytes(&[
                ("vertices", npy::bytes(&[3, 2], &[f64::NAN; 6])),
                ("triangles", npy::bytes::<i64>(&[0, 3], &[])),
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
            "found the end of the file, expected 1 faces, as the header promises, behind 0",
        ),
        (
            "off",
            b"OFF\n1000000000000 1 0\n0 0 0\n".to_vec(),
            "expected 1000000000000 vertices, as the header promises, behind 1",
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
    let error = read_mesh(folder.path().join("mesh.glb")).unwrap_err();
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
    assert!(refused("a.dae", &plain, None).contains("found extension .dae"));
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
    let json = deep("[");
    let json = npy::bytes(&[json.len()], &json);
    let bytes = npz::bytes(&[
        ("vertices", npy::bytes(&[3, 4], &[0.0; 12])),
        ("triangles", npy::bytes::<i64>(&[0, 3], &[])),
        ("metadata", json),
    ]);
    let flaw = parse_mesh("npz", &bytes).unwrap_err();
    assert!(flaw.found.contains("bad JSON"), "{flaw:?}");
}

#[test]
fn bad_indices_are_refused() {
    let cases = [
        ("npy", npy::bytes(&[2], &[0, -2_i64]), "-2"),
        (
            "npy",
            npy::bytes(&[2, 2], &[0_i64; 4]),
            "an array of shape [2, 2]",
        ),
        ("npy", npy::bytes(&[1], &[0.5]), "floating point numbers"),
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
        npy::bytes(&[n, columns], &v)
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
    // What differences of squares and cosines leave of zero.
    for noise in [1e-8, -2e-16] {
        let Ok(Distances::Dense { values, .. }) =
            distances::parse("npy", &dense(2, vec![noise, 1.0, 1.0, 0.0]))
        else {
            panic!("rounding on the diagonal is refused");
        };
        assert_eq!(values, [0.0, 1.0, 1.0, 0.0]);
        assert!(distances::parse("npz", &csr(2, &[0, 2, 2], &[0, 1], &[noise, 3.0])).is_ok());
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
