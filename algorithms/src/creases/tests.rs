//! Creases of folded and of bent grids, whose clouds are drawn apart from them.

use super::*;
use crate::execute::Serial;
use crate::surfaces::{Random, embed};
use crosscap_core::Complex;
use proptest::prelude::*;

/// Squares of a grid, one way, and points for each of them.
const SIDE: usize = 22;
const POINTS: usize = 6;

/// A grid of unit squares about the origin of the plane with a random cloud, both brought into space.
fn brought(seed: u64, noise: f64, place: impl Fn([f64; 2]) -> [f64; 3]) -> (Mesh, PointCloud<f64>) {
    let half = SIDE as f64 / 2.0;
    let row = SIDE + 1;
    let vertices = (0..row * row).flat_map(|k| {
        let at = [k % row, k / row].map(|x| x as f64 - half);
        place(at)
    });
    let vertices = PointCloud::new(3, vertices.collect()).unwrap();
    let squares = (0..SIDE * SIDE).map(|k| (k / SIDE * row + k % SIDE) as u32);
    let down = row as u32;
    let triangles = squares.flat_map(|k| [[k, k + 1, k + down], [k + 1, k + down, k + down + 1]]);
    let complex = Complex::new(row * row, triangles.collect(), vec![]).unwrap();
    let mut random = Random::new(seed);
    let points = (0..POINTS * SIDE * SIDE).flat_map(|_| {
        let at = [random.between(-half, half), random.between(-half, half)];
        place(at).map(|x| x + noise * random.normal())
    });
    let cloud = PointCloud::new(3, points.collect()).unwrap();
    let rows = vec![-1; row * row];
    (Mesh::new(complex, vertices, rows).unwrap(), cloud)
}

/// A plane folded along a line that goes through the squares, so that the faces are at an angle (degrees).
fn folded(turn: f64, aside: f64, angle: f64) -> impl Fn([f64; 2]) -> [f64; 3] {
    let bend = (180.0 - angle).to_radians();
    move |[x, y]| {
        let (s, c) = turn.sin_cos();
        let across = c * x + s * y - aside;
        let [out, up] = match across > 0.0 {
            true => [across * bend.cos(), across * bend.sin()],
            false => [across, 0.0],
        };
        [out, c * y - s * x, up]
    }
}

fn found(mesh: &Mesh, cloud: &PointCloud<f64>) -> Creases {
    creases(mesh, cloud, &CreaseLimits::MEASURED, &Serial).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn a_fold_is_one_crease_wherever_it_goes(
        turn in 0.0..3.0f64,
        aside in -3.0..3.0f64,
        angle in 30.0..145.0f64,
        seed in 0..1000u64,
    ) {
        let (mesh, cloud) = brought(seed, 0.0, folded(turn, aside, angle));
        let all = found(&mesh, &cloud);
        prop_assert_eq!((all.faces, all.creases.len(), all.corners.len()), (2, 1, 0));
        let crease = &all.creases[0];
        prop_assert_eq!(crease.ends, Some([CreaseEnd::Boundary; 2]));
        // At the rim of the cloud, where few points hold the sheets, the angle is less exact.
        prop_assert!((crease.angle.median - angle).abs() < 0.1, "{:?} {angle}", crease.angle);
        // At the rim of the cloud few points hold the sheets.
        let near = crease.places.iter().filter(|place| place[0].hypot(place[2]) < 0.5).count();
        prop_assert!(10 * near >= 8 * crease.places.len(), "{:?}", crease.places);
        // Moved into R^5 it is the same.
        let moved = Mesh { vertices: embed(&mesh.vertices, 5, seed).unwrap(), ..mesh.clone() };
        let again = found(&moved, &embed(&cloud, 5, seed).unwrap());
        prop_assert_eq!((again.faces, again.creases.len(), again.corners.len()), (2, 1, 0));
        prop_assert!((again.creases[0].angle.median - crease.angle.median).abs() < 0.1);
    }
}

#[test]
fn noise_hides_no_right_angle() {
    for seed in 0..4 {
        let (mesh, cloud) = brought(seed, 0.05, folded(0.4, 1.0, 90.0));
        assert_eq!(found(&mesh, &cloud).creases.len(), 1, "{seed}");
    }
}

#[test]
fn what_bends_has_no_crease() {
    for seed in 0..3 {
        for length in [8.0, 4.0] {
            // A bend of 115 degrees, of a radius of four edges and of two, between two planes.
            let place = |[x, y]: [f64; 2]| {
                let around = x.clamp(-0.5 * length, 0.5 * length);
                let beyond = x - around;
                let (s, c) = (2.0 * around / length).sin_cos();
                let radius = 0.5 * length;
                [radius * s + beyond * c, y, radius * (1.0 - c) + beyond * s]
            };
            let (mesh, cloud) = brought(seed, 0.0, place);
            let all = found(&mesh, &cloud);
            assert_eq!((all.faces, all.creases.len()), (1, 0), "{length} {seed}");
        }
    }
}

#[test]
fn sheets_that_cross_in_a_point_have_no_crease_there() {
    // Two copies of one plane in R^4, at right angles, that have the middle vertex in common.
    let (flat, cloud) = brought(0, 0.0, |[x, y]| [x, y, 0.0]);
    let near = |v: usize| flat.vertices.point(v).iter().map(|x| x * x).sum::<f64>();
    let count = flat.complex.vertices;
    let middle = (0..count)
        .min_by(|&a, &b| near(a).total_cmp(&near(b)))
        .unwrap();
    let center = flat.vertices.point(middle).to_vec();
    let both = |places: &PointCloud<f64>| -> Vec<f64> {
        let own = || places.iter().map(|p| [p[0] - center[0], p[1] - center[1]]);
        let first = own().flat_map(|[x, y]| [x, y, 0.0, 0.0]);
        first
            .chain(own().flat_map(|[x, y]| [0.0, 0.0, x, y]))
            .collect()
    };
    let second = |v: u32| {
        if v as usize == middle {
            v
        } else {
            v + count as u32
        }
    };
    let mut triangles = flat.complex.triangles.clone();
    triangles.extend(flat.complex.triangles.iter().map(|t| t.map(second)));
    let complex = Complex::new(2 * count, triangles, vec![]).unwrap();
    let vertices = PointCloud::new(4, both(&flat.vertices)).unwrap();
    let mesh = Mesh::new(complex, vertices, vec![-1; 2 * count]).unwrap();
    let found = found(&mesh, &PointCloud::new(4, both(&cloud)).unwrap());
    assert!(found.creases.is_empty(), "{found:?}");
}

#[test]
fn points_of_another_space_are_refused() {
    let (mesh, _) = brought(0, 0.0, folded(0.0, 0.0, 90.0));
    let flat = PointCloud::new(2, vec![0.0; 4]).unwrap();
    assert!(creases(&mesh, &flat, &CreaseLimits::MEASURED, &Serial).is_err());
}
