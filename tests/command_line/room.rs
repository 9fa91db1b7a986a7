//! A folder to run the program in, and meshes and points to run it on.

use crosscap_algorithms::surfaces::Random;
use crosscap_backends::files::{MeshExtras, PointOptions, read_points, write_mesh};
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::process::Command;
use tempfile::TempDir;

/// What a run of the program left behind.
pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Ran {
    #[track_caller]
    pub fn expect(self, code: i32) -> Self {
        assert!(!self.err.contains("panicked"), "{}", self.err);
        assert_eq!(
            self.code,
            Some(code),
            "\nstdout: {}\nstderr: {}",
            self.out,
            self.err
        );
        self
    }

    #[track_caller]
    pub fn says(self, part: &str) -> Self {
        assert!(self.out.contains(part), "no {part:?} in: {}", self.out);
        self
    }

    #[track_caller]
    pub fn complains(self, part: &str) -> Self {
        assert!(self.err.contains(part), "no {part:?} in: {}", self.err);
        self
    }

    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap()
    }
}

/// A folder to run the program in, which goes away with the test.
pub struct Room(pub TempDir);

impl Room {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Arguments between white space; file names are relative to the folder.
    pub fn run(&self, arguments: &str) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_crosscap"))
            .args(arguments.split_whitespace())
            .current_dir(self.0.path())
            .output()
            .unwrap();
        Ran {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    pub fn files(&self) -> Vec<String> {
        let all = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = all
            .map(|f| f.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    pub fn mesh(&self, name: &str, mesh: &Mesh) {
        write_mesh(self.path(name), mesh, &MeshExtras::default(), None).unwrap();
    }

    pub fn points(&self, name: &str) -> PointCloud<f64> {
        let cloud = read_points(self.path(name), &PointOptions::default());
        cloud.unwrap().into_f64()
    }
}

pub fn mesh(
    dimension: usize,
    places: Vec<f64>,
    triangles: Vec<[u32; 3]>,
    curves: Vec<CurveEdge>,
) -> Mesh {
    let places = PointCloud::new(dimension, places).unwrap();
    let count = places.len();
    let complex = Complex::new(count, triangles, curves).unwrap();
    Mesh::new(complex, places, vec![-1; count]).unwrap()
}

/// A sphere of eight triangles.
pub fn octahedron() -> Mesh {
    let places = vec![
        1., 0., 0., -1., 0., 0., 0., 1., 0., 0., -1., 0., 0., 0., 1., 0., 0., -1.,
    ];
    let signs = [0, 1].into_iter();
    let faces = signs.flat_map(|x| {
        [2, 3]
            .into_iter()
            .flat_map(move |y| [4, 5].map(|z| [x, y, z]))
    });
    mesh(3, places, faces.collect(), vec![])
}

/// Two spheres that cross in a circle of `n` edges: four caps over one rim, two of them bulging out over a
/// ring of their own.
pub fn two_spheres(n: u32) -> Mesh {
    let mut places = Vec::new();
    for (x, radius) in [(0.0, 1.0), (-0.8, 1.5), (0.8, 1.5)] {
        for k in 0..n {
            let (sine, cosine) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            places.extend([x, radius * cosine, radius * sine]);
        }
    }
    for apex in [-3.0, 3.0, -1.6, 1.6] {
        places.extend([apex, 0.0, 0.0]);
    }
    let mut faces = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        for side in [1, 2] {
            let (a, b) = (side * n + k, side * n + next);
            faces.extend([[k, next, a], [next, a, b], [a, b, 3 * n + side - 1]]);
            faces.push([k, next, 3 * n + 1 + side]);
        }
    }
    let rim = (0..n).map(|k| CurveEdge::new(k, (k + 1) % n, 4));
    mesh(3, places, faces, rim.collect())
}

/// A torus in R^4, the product of two circles.
pub fn flat_torus(n: u32) -> Mesh {
    let mut places = Vec::new();
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..n {
            for k in [i, j] {
                let (sine, cosine) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
                places.extend([cosine, sine]);
            }
            let at = |i: u32, j: u32| (i % n) * n + j % n;
            faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            faces.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
    }
    mesh(4, places, faces, vec![])
}

/// Points that fill a ball of R^3: no surface.
pub fn ball(count: usize) -> PointCloud<f64> {
    let mut random = Random::new(5);
    let mut coordinates = Vec::new();
    while coordinates.len() < 3 * count {
        let p = [0; 3].map(|_| random.between(-1.0, 1.0));
        if p.iter().map(|c| c * c).sum::<f64>() < 1.0 {
            coordinates.extend(p);
        }
    }
    PointCloud::new(3, coordinates).unwrap()
}

pub const SPHERE: &str = "--eps 0.5 --dl 0.25 --surface";

pub fn sphere_points(room: &Room) {
    room.run("sample sphere -n 3000 --seed 1 -o points.npy")
        .expect(0);
}

/// Width and height from the header of a PNG image.
pub fn image_size(image: &[u8]) -> String {
    assert_eq!(&image[1..4], b"PNG");
    let side = |at: usize| u32::from_be_bytes(image[at..at + 4].try_into().unwrap());
    format!("{}x{}", side(16), side(20))
}
