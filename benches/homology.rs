//! Seconds for the exact homology of complexes with a million vertices.
//!
//! `cargo bench --bench homology` prints the table; `cargo bench --bench homology -- --write DIR`
//! also writes the complexes, for `benches/homology_gudhi.py` to compute the same of.

use crosscap::algorithms::homology::homology;
use crosscap::algorithms::surfaces::Random;
use crosscap::backends::files::{MeshExtras, write_mesh};
use crosscap::core::{Complex, Mesh, PointCloud};
use rustix::time::{ClockId, clock_gettime};
use std::path::PathBuf;

/// How often each is measured.
const RUNS: usize = 7;

/// Processor time of this process in seconds.
fn seconds() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Triangles of a rectangle of `m` by `n` squares whose sides are glued: a torus, or with the first
/// coordinate mirrored where the second closes, a Klein bottle. `name` tells the vertices.
fn closed_grid(m: u32, n: u32, mirror: bool, name: impl Fn(u32, u32) -> u32) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| {
        let i = if j == n && mirror { 2 * m - i } else { i };
        name(i % m, j % n)
    };
    let squares = (0..m).flat_map(|i| (0..n).map(move |j| (i, j)));
    squares
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            [[a, b, d], [a, c, d]]
        })
        .collect()
}

/// A torus and a Klein bottle through two circles of `m`, each one-sided on the Klein bottle.
fn crossing(m: u32) -> (u32, Vec<[u32; 3]>) {
    let mut triangles = closed_grid(m, m, false, |i, j| i * m + j);
    let half = m / 2;
    triangles.extend(closed_grid(m, m, true, |i, j| {
        if i % half == 0 {
            i * m + j
        } else {
            m * m + (i - 1 - u32::from(i > half)) * m + j
        }
    }));
    (2 * m * (m - 1), triangles)
}

fn complex(vertices: u32, triangles: Vec<[u32; 3]>) -> Complex {
    Complex::new(vertices as usize, triangles, Vec::new()).expect("a complex by construction")
}

/// The same complex, its vertices in random order, as the landmarks of a sample are.
fn shuffled(complex: &Complex) -> Complex {
    let names = Random::new(1).permutation(complex.vertices);
    let triangles = complex.triangles.iter();
    let triangles = triangles.map(|t| t.map(|v| names[v as usize] as u32));
    self::complex(complex.vertices as u32, triangles.collect())
}

fn write(folder: &std::path::Path, name: &str, complex: &Complex) {
    let count = complex.vertices;
    // The homology does not depend on places.
    let places = PointCloud::new(3, vec![0.0; 3 * count]).expect("zeros are finite");
    let mesh = Mesh::new(complex.clone(), places, vec![-1; count]).expect("one place a vertex");
    let path = folder.join(format!("{}.npz", name.replace(' ', "_")));
    write_mesh(path, &mesh, &MeshExtras::default(), None).expect("the folder can be written");
}

fn main() {
    let mut arguments = std::env::args().skip_while(|a| a != "--write").skip(1);
    let folder = arguments.next().map(PathBuf::from);
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder).expect("the folder can be made");
    }
    let grid = |mirror| {
        complex(
            1_000_000,
            closed_grid(1000, 1000, mirror, |i, j| 1000 * i + j),
        )
    };
    let (vertices, triangles) = crossing(708);
    let plain = [
        ("torus", grid(false), [1, 2, 1], ""),
        ("klein bottle", grid(true), [1, 1, 0], "2"),
        ("crossing", complex(vertices, triangles), [1, 3, 2], ""),
    ];
    println!(
        "{:<24} {:>9} {:>9}  {:<9} {:<8} {:>8}",
        "complex", "vertices", "triangles", "Betti", "torsion", "CPU s"
    );
    for (name, ordered, betti, torsion) in plain {
        let other = shuffled(&ordered);
        for (name, complex) in [
            (name.to_string(), ordered),
            (format!("{name} shuffled"), other),
        ] {
            let mut least = f64::INFINITY;
            for _ in 0..RUNS {
                let start = seconds();
                let found = homology(&complex).expect("a complex by construction");
                least = least.min(seconds() - start);
                assert_eq!(found.betti_rational, betti);
                let factors: Vec<String> = found.torsion.iter().map(ToString::to_string).collect();
                assert_eq!(factors.join(","), torsion);
            }
            println!(
                "{name:<24} {:>9} {:>9}  {:<9} {:<8} {least:>8.3}",
                complex.vertices,
                complex.triangles.len(),
                betti.map(|b| b.to_string()).join(","),
                if torsion.is_empty() {
                    "none".into()
                } else {
                    format!("Z/{torsion}")
                },
            );
            if let Some(folder) = &folder {
                write(folder, &name, &complex);
            }
        }
    }
}
