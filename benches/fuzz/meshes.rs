//! Triangles and curves that need not fit together.

use crosscap_algorithms::certificate::{CertificateOptions, certify};
use crosscap_algorithms::homology::homology;
use crosscap_algorithms::pieces::pieces;
use crosscap_algorithms::surfaces::Random;
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};

/// Coordinates of one kind for a whole mesh.
fn places(count: usize, dimension: usize, random: &mut Random) -> PointCloud<f64> {
    let kind = random.below(6);
    let coordinates = (0..count * dimension)
        .map(|k| match kind {
            0 => 0.0,
            1 => (k / dimension) as f64,
            2 => random.between(-1.0, 1.0) * 1e300,
            3 => random.between(-1.0, 1.0) * 5e-324 * 1e3,
            4 => random.below(3) as f64,
            _ => random.between(-1.0, 1.0),
        })
        .collect();
    PointCloud::new(dimension, coordinates).unwrap()
}

/// A grid of triangles that closes to a torus, a Klein bottle, a strip or nothing, before anything is done to it.
fn grid(side: usize, random: &mut Random) -> Vec<[u32; 3]> {
    let [around, along] = [random.below(2) == 0, random.below(2) == 0];
    let turned = random.below(2) == 0;
    let node = |i: usize, j: usize| {
        let j = if turned && i == side {
            side - j % side
        } else {
            j
        };
        (i % side * side + j % side) as u32
    };
    let mut triangles = Vec::new();
    for i in 0..side - usize::from(!around) {
        for j in 0..side - usize::from(!along) {
            let [a, b, c, d] = [
                node(i, j),
                node(i + 1, j),
                node(i, j + 1),
                node(i + 1, j + 1),
            ];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    triangles
}

/// What is left once repeated corners, triangles and edges are taken away.
fn distinct<const K: usize>(mut simplices: Vec<[u32; K]>) -> Vec<[u32; K]> {
    for simplex in &mut simplices {
        simplex.sort_unstable();
    }
    simplices.retain(|s| s.windows(2).all(|w| w[0] < w[1]));
    simplices.sort_unstable();
    simplices.dedup();
    simplices
}

/// Triangles from nowhere, or a grid with some taken away, added and glued together; curves on their edges and elsewhere.
fn mesh(random: &mut Random) -> Option<Mesh> {
    let side = 3 + random.below(4);
    let mut count = 1 + random.below(12);
    let mut triangles = Vec::new();
    if random.below(3) > 0 {
        count = side * side;
        triangles = grid(side, random);
        triangles.retain(|_| random.below(20) > 0);
    }
    for _ in 0..random.below(if triangles.is_empty() { 30 } else { 4 }) {
        triangles.push(std::array::from_fn(|_| random.below(count) as u32));
    }
    if random.below(2) == 0 {
        let [from, to] = [random.below(count) as u32, random.below(count) as u32];
        let glued = |corner: u32| if corner == from { to } else { corner };
        triangles = triangles.into_iter().map(|t| t.map(glued)).collect();
    }
    let triangles = distinct(triangles);
    let mut ends: Vec<[u32; 2]> = (0..random.below(4))
        .map(|_| std::array::from_fn(|_| random.below(count) as u32))
        .collect();
    if random.below(2) == 0 {
        ends.extend(
            triangles
                .iter()
                .filter(|_| random.below(3) == 0)
                .map(|t| [t[0], t[1]]),
        );
    }
    let curves = distinct(ends).into_iter();
    let curves = curves
        .map(|[a, b]| CurveEdge::new(a, b, random.below(6) as u8))
        .collect();
    let complex = Complex::new(count, triangles, curves).ok()?;
    let dimension = 1 + random.below(5);
    let places = places(count, dimension, random);
    Mesh::new(complex, places, (0..count as i64).collect()).ok()
}

/// Looks at a mesh in every way that there is, and says what came of it.
pub fn run(random: &mut Random) -> &'static str {
    let Some(mesh) = mesh(random) else {
        return "no complex";
    };
    let points = places(1 + random.below(60), mesh.vertices.dimension(), random);
    let options = CertificateOptions {
        points: (random.below(3) > 0).then_some(&points),
        landmark_separation: (random.below(2) == 0).then(|| random.between(1e-9, 2.0)),
        closed: random.below(2) == 0,
        ..CertificateOptions::default()
    };
    let certificate = certify(&mesh, &options);
    assert!(!certificate.to_string().is_empty());
    let homology = homology(&mesh.complex).unwrap();
    assert!(homology.betti_rational[0] >= 1, "a vertex is a component");
    let pieces = pieces(&mesh);
    if let Ok(pieces) = &pieces {
        assert!(!pieces.to_string().is_empty() || mesh.complex.triangles.is_empty());
    }
    match (certificate.violations().next().is_none(), pieces.is_ok()) {
        (true, _) => "nothing wrong",
        (false, true) => "faults",
        (false, false) => "no surface",
    }
}
