//! Empty discs measured in the points themselves.

use super::{POINTS, plate, sample};
use crate::certificate::faithful::footprints::Footprints;
use crate::certificate::faithful::ground::Ground;
use crate::certificate::faithful::in_points::PointDisc;
use crate::certificate::faithful::search::Search;
use crate::certificate::frame::Frame;
use crate::certificate::geometry;
use crate::certificate::incidence::Incidence;
use crosscap_core::{Complex, Mesh, PointCloud};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The unit sphere as an octahedron whose faces are cut into four: edges of 0.77 and 1.
fn coarse_sphere() -> Mesh {
    let unit = |p: [f64; 3]| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    let mut places: Vec<[f64; 3]> = Vec::new();
    let mut at = |p: [f64; 3]| {
        let p = unit(p);
        let known = places
            .iter()
            .position(|q| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9));
        known.unwrap_or_else(|| {
            places.push(p);
            places.len() - 1
        }) as u32
    };
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let side = |k: usize| if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
        let corner: [[f64; 3]; 3] =
            std::array::from_fn(|k| std::array::from_fn(|i| if i == k { side(k) } else { 0.0 }));
        let middle = |i: usize, j: usize| std::array::from_fn(|k| corner[i][k] + corner[j][k]);
        let [a, b, c] = corner.map(&mut at);
        let [ab, bc, ca] = [middle(0, 1), middle(1, 2), middle(2, 0)].map(&mut at);
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    let complex = Complex::new(places.len(), triangles, Vec::new()).unwrap();
    let count = places.len();
    let places = PointCloud::new(3, places.concat()).unwrap();
    Mesh::new(complex, places, vec![-1; count]).unwrap()
}

/// So many random points of the unit sphere, none nearer to a place than `radius`.
fn sphere_with_hole(seed: u64, count: usize, middle: [f64; 3], radius: f64) -> PointCloud<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut rows = Vec::new();
    while rows.len() < 3 * count {
        let p: [f64; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        let p = p.map(|x| x / length);
        let away: f64 = (0..3).map(|k| (p[k] - middle[k]).powi(2)).sum();
        if length < 1.0 && away > radius * radius {
            rows.extend(p);
        }
    }
    PointCloud::new(3, rows).unwrap()
}

/// The radius of the largest empty disc on a mesh, and that disc in the points.
fn largest_disc(mesh: &Mesh, points: &PointCloud<f64>) -> (f64, Option<PointDisc>) {
    let (incidence, count) = (Incidence::new(&mesh.complex), points.len());
    let frame = Frame::new(&mesh.vertices, Some(points));
    let tree = geometry::tree(mesh, &frame, &[]);
    let feet = Footprints::new(mesh, &incidence, &frame, &tree, &[], points, 0..count);
    let ground = Ground::new(mesh, &incidence, &feet);
    let search = Search::new(mesh, &incidence, &feet, &ground, points, count);
    let (tiles, middles) = search.far_tiles();
    let widest = (0..tiles.len()).max_by(|&a, &b| tiles[a].away.total_cmp(&tiles[b].away));
    let tile = &tiles[widest.unwrap()];
    let place = &middles[3 * widest.unwrap()..][..3];
    let (away, _) = search.distances(place);
    let disc = search.disc_in_points(tile.triangle, place, away, away / tile.away);
    (away, disc)
}

/// On a mesh of few triangles a hole of a sphere is narrower than in the points, which are squeezed together at its edges. In the points
/// it is as wide as it is, and what is expected in it is what the sphere would have there.
#[test]
fn a_hole_under_a_coarse_mesh() {
    let mesh = coarse_sphere();
    let (count, middle) = (900, [0.6, 0.64, 0.48]);
    let radius = 2.6 * (4.0 * std::f64::consts::PI / count as f64).sqrt();
    for seed in 0..6 {
        let points = sphere_with_hole(seed, count, middle, radius);
        let (away, disc) = largest_disc(&mesh, &points);
        let disc = disc.expect("the sphere has neither an end nor a curve");
        assert!(
            disc.radius > radius && disc.radius > 1.02 * away,
            "{seed}: {away} {}",
            disc.radius
        );
        assert!(disc.radius < 1.25 * radius, "{seed}: {}", disc.radius);
        let truly = count as f64 * disc.radius * disc.radius / (4.0 - radius * radius);
        let found = disc.expected.points / truly;
        assert!((0.8..1.2).contains(&found), "{seed}: {found} of {truly}");
    }
}

/// The plate folded along its second axis to two half planes at an angle.
fn folded(places: &PointCloud<f64>, angle: f64) -> PointCloud<f64> {
    let (sine, cosine) = (0.5 * angle).to_radians().sin_cos();
    let rows = places.coordinates().chunks_exact(3);
    let rows = rows.flat_map(|p| [p[0] * sine, p[1], -p[0].abs() * cosine]);
    PointCloud::new(3, rows.collect()).unwrap()
}

/// Beside a crease a ball holds more of a surface than a disc does, and no disc is measured in the points there.
#[test]
fn a_hole_beside_a_crease() {
    let flat = plate(|_, _| false);
    for seed in 0..4 {
        let outside = |x: f64, y: f64| if (x - 0.15).hypot(y) > 0.12 { 1.0 } else { 0.0 };
        let points = sample(seed, POINTS, outside);
        for (angle, smooth) in [(180.0, true), (90.0, false), (60.0, false)] {
            let mesh = Mesh {
                vertices: folded(&flat.vertices, angle),
                ..flat.clone()
            };
            let (away, disc) = largest_disc(&mesh, &folded(&points, angle));
            assert!(away > 0.12, "{seed}, {angle}: {away}");
            assert_eq!(disc.is_some(), smooth, "{seed}, {angle}");
            if let Some(disc) = disc {
                let truly = 0.25 * POINTS as f64 * std::f64::consts::PI * disc.radius.powi(2);
                let found = disc.expected.points / truly;
                assert!((0.75..1.25).contains(&found), "{seed}: {found} of {truly}");
            }
        }
    }
}
