//! Files that are nearly right.

use crosscap_algorithms::surfaces::Random;
use crosscap_backends::files::{
    MESH_READ_EXTENSIONS, MeshExtras, POINT_EXTENSIONS, PointOptions, read_distances, read_indices,
    read_mesh, read_points, write_mesh, write_points,
};
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
use std::path::Path;

/// Small files that are right, each with the extension that it belongs to.
pub struct Corpus {
    files: Vec<(String, Vec<u8>)>,
    extensions: Vec<String>,
}

const TEXTS: [(&str, &str); 11] = [
    ("csv", "x;y;z\n0,5;1,25;2\n3;4,5;-1e3\n# end\n"),
    (
        "tsv",
        "a\tx\ty\tz\tnx\tny\n1\t0\t0\t0\t1\t0\n2\t1\t0\t0\t1\t0\n",
    ),
    (
        "xyz",
        "2\nfirst\nC 0 0 0\nH 0 0 1.1\n2\nsecond\nC 0 0 0\nH 0 1.1 0\n",
    ),
    (
        "pdb",
        "MODEL        1\nATOM      1  CA  ALA A   1      11.104   6.134  -6.504  1.00  0.00           C\nENDMDL\nEND\n",
    ),
    (
        "off",
        "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n",
    ),
    (
        "off",
        "nOFF\n4\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n",
    ),
    (
        "obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf -1 -2 -3\n",
    ),
    (
        "stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n",
    ),
    (
        "pcd",
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n0 0 0\n1 2 3\n",
    ),
    (
        "vtk",
        "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n",
    ),
    (
        "vtp",
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"2\"><Points>\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 2 3</DataArray></Points></Piece></PolyData></VTKFile>",
    ),
];

impl Corpus {
    /// One file or more of every format that can be written here, and texts and headers of those that cannot.
    pub fn new() -> Self {
        let mut files: Vec<(String, Vec<u8>)> = TEXTS
            .iter()
            .map(|(extension, text)| (extension.to_string(), text.as_bytes().to_vec()))
            .collect();
        let cloud = PointCloud::new(3, (0..30).map(|k| f64::from(k) * 0.37).collect()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
        for extension in ["npy", "csv", "xyz", "ply"] {
            let name = format!("points.{extension}");
            write_points(folder.path().join(&name), &cloud).unwrap();
            files.push((extension.into(), read(&name)));
        }
        for extension in ["npz", "vtu", "ply", "obj", "off", "stl"] {
            let name = format!("mesh.{extension}");
            let path = folder.path().join(&name);
            write_mesh(path, &tetrahedron(), &MeshExtras::default(), None).unwrap();
            files.push((extension.into(), read(&name)));
        }
        files.push(("mat".into(), matrix()));
        files.push(("las".into(), scan()));
        let all = format!("{POINT_EXTENSIONS}, {MESH_READ_EXTENSIONS}");
        let mut extensions: Vec<String> = all.split(", ").map(|e| e[1..].to_string()).collect();
        extensions.sort();
        extensions.dedup();
        Self { files, extensions }
    }
}

fn tetrahedron() -> Mesh {
    let triangles = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    let complex = Complex::new(4, triangles, vec![CurveEdge::new(0, 1, 2)]).unwrap();
    let places = vec![0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.];
    Mesh::new(
        complex,
        PointCloud::new(3, places).unwrap(),
        vec![0, 1, 2, 3],
    )
    .unwrap()
}

/// A matrix of two points in MATLAB's format, version 5.
fn matrix() -> Vec<u8> {
    let mut bytes = vec![b' '; 124];
    bytes.extend([0, 1, b'I', b'M']);
    for word in [
        14,
        104_u32,
        6,
        8,
        6,
        0,
        5,
        8,
        2,
        3,
        1 | 1 << 16,
        u32::from(b'X'),
        9,
        48,
    ] {
        bytes.extend(word.to_le_bytes());
    }
    for value in [0.0_f64, 1.0, 2.0, 3.0, 4.0, 5.0] {
        bytes.extend(value.to_le_bytes());
    }
    bytes
}

/// A scan of two points, LAS 1.2.
fn scan() -> Vec<u8> {
    let mut bytes = b"LASF".to_vec();
    bytes.resize(227, 0);
    bytes[24..26].copy_from_slice(&[1, 2]);
    bytes[94..96].copy_from_slice(&227_u16.to_le_bytes());
    bytes[96..100].copy_from_slice(&227_u32.to_le_bytes());
    bytes[105..107].copy_from_slice(&20_u16.to_le_bytes());
    bytes[107..111].copy_from_slice(&2_u32.to_le_bytes());
    for scale in 0..3 {
        let at = 131 + 8 * scale;
        bytes[at..at + 8].copy_from_slice(&0.01_f64.to_le_bytes());
    }
    bytes.extend([0, 0, 1, 0].repeat(10));
    bytes
}

/// Words that readers stumble over.
const WORDS: [&[u8]; 16] = [
    b"nan",
    b"inf",
    b"-1",
    b"1e999",
    b"18446744073709551616",
    b"4294967295",
    b"1000000000000",
    b"0",
    b"",
    b"\n",
    b"\0",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\x00\x00\x00\x00\x00\x00\xf0\x7f",
    b"\xef\xbb\xbf",
    b"<!DOCTYPE a [<!ENTITY b 'bb'>]>",
];

/// Changes a file in one place.
fn change(bytes: &mut Vec<u8>, corpus: &Corpus, random: &mut Random) {
    let length = bytes.len().max(1);
    let at = random.below(length).min(bytes.len());
    let end = (at + 1 + random.below(16)).min(bytes.len());
    match random.below(8) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        1 if at < bytes.len() => bytes[at] = random.below(256) as u8,
        2 => bytes.truncate(at),
        3 => {
            bytes.drain(at..end);
        }
        4 => {
            let again = bytes[at..end].to_vec();
            bytes.splice(at..at, again);
        }
        5 => {
            let word = WORDS[random.below(WORDS.len())];
            bytes.splice(at..at, word.iter().copied());
        }
        6 => {
            let word = WORDS[random.below(WORDS.len())];
            bytes.splice(at..end, word.iter().copied());
        }
        _ => {
            let (_, other) = &corpus.files[random.below(corpus.files.len())];
            let from = random.below(other.len());
            bytes.truncate(at);
            bytes.extend(&other[from..]);
        }
    }
}

/// Gives a file that is nearly right to all readers; says whether one took it for points or a mesh.
pub fn run(corpus: &Corpus, random: &mut Random, folder: &Path) -> &'static str {
    let (extension, file) = &corpus.files[random.below(corpus.files.len())];
    let mut bytes = file.clone();
    for _ in 0..random.below(6) {
        change(&mut bytes, corpus, random);
    }
    let extension = match random.below(8) {
        0 => &corpus.extensions[random.below(corpus.extensions.len())],
        _ => extension,
    };
    let path = folder.join(format!("file.{extension}"));
    std::fs::write(&path, &bytes).unwrap();
    let options = PointOptions {
        transpose: random.below(4) == 0,
        ..PointOptions::default()
    };
    let points = read_points(&path, &options);
    let mesh = read_mesh(&path);
    let indices = read_indices(&path);
    let distances = read_distances(&path);
    // A refusal is there to be read.
    let words = [
        points.as_ref().err().map(ToString::to_string),
        mesh.as_ref().err().map(ToString::to_string),
        indices.as_ref().err().map(ToString::to_string),
        distances.as_ref().err().map(ToString::to_string),
    ];
    assert!(
        words.iter().flatten().all(|w| w.contains("file.")),
        "a refusal names the file: {words:?}"
    );
    match (points.is_ok(), mesh.is_ok()) {
        (true, true) => "both",
        (true, false) => "points",
        (false, true) => "a mesh",
        (false, false) => "refused",
    }
}
