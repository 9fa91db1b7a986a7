//! Where on the mesh the input points stand: the nearest place of the mesh to each.

use crate::certificate::distance::{Products, point_triangle};
use crate::certificate::frame::Frame;
use crate::certificate::geometry::corners;
use crate::certificate::incidence::Incidence;
use crate::certificate::tree::Tree;
use crosscap_core::{Mesh, PointCloud, squared_distance};

/// Weight of a corner up to which a place is on the opposite side: what rounding leaves of zero.
const TIE: f64 = 1e-9;

/// The nearest places of the mesh to the input points, in the order of their rows.
///
/// A sample on a surface with noise becomes a sample on the mesh, so that its gaps are measured
/// within the surface, whatever the noise across it.
pub(in crate::certificate) struct Footprints {
    /// Rows of the input.
    pub rows: Vec<u32>,
    /// The triangle each stands on, the first of several, or the number of triangles plus the number of the curve edge
    /// without triangles.
    pub items: Vec<u32>,
    /// The places, one after the other.
    pub places: Vec<f64>,
    /// How far each point is from its place; infinite where there is no mesh.
    pub heights: Vec<f64>,
    /// Whether the place is on the boundary of the mesh: such a point may lie beyond it.
    pub on_boundary: Vec<bool>,
}

impl Footprints {
    /// Looks up the points `rows` in the tree of all triangles and of the curve edges `bare`.
    pub fn new(
        mesh: &Mesh,
        incidence: &Incidence,
        frame: &Frame,
        tree: &Tree,
        bare: &[[u32; 2]],
        points: &PointCloud<f64>,
        rows: impl Iterator<Item = usize>,
    ) -> Self {
        let count = mesh.complex.triangles.len();
        let open = open_sides(mesh, incidence);
        let shape = |item: usize| {
            if item < count {
                corners(mesh, item as u32)
            } else {
                let [a, b] = bare[item - count];
                [a, b, b].map(|v| mesh.vertices.point(v as usize))
            }
        };
        let mut all = Self {
            rows: Vec::new(),
            items: Vec::new(),
            places: Vec::new(),
            heights: Vec::new(),
            on_boundary: Vec::new(),
        };
        for p in rows {
            let row = points.point(p);
            let found = tree.nearest(&frame.spot(row), frame.slack, f64::INFINITY, |item| {
                let [a, b, c] = shape(item as usize);
                point_triangle(row, a, b, c)
            });
            all.rows.push(p as u32);
            let Some((item, square)) = found else {
                all.items.push(u32::MAX);
                all.places.extend_from_slice(row);
                all.heights.push(f64::INFINITY);
                all.on_boundary.push(true);
                continue;
            };
            let sides = shape(item as usize);
            let weights = nearest_weights(row, sides);
            all.places.extend((0..row.len()).map(|k| {
                weights[0] * sides[0][k] + weights[1] * sides[1][k] + weights[2] * sides[2][k]
            }));
            all.heights.push(square.sqrt());
            let (item, beyond) = if (item as usize) < count {
                owner(mesh, incidence, &open, item, weights)
            } else {
                (item, false)
            };
            all.items.push(item);
            all.on_boundary.push(beyond);
        }
        all
    }

    /// Number of points looked up.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Place of the one at `index`.
    pub fn place(&self, index: usize) -> &[f64] {
        let width = self.places.len() / self.rows.len().max(1);
        &self.places[index * width..(index + 1) * width]
    }
}

/// The triangle that a place of triangle `t` counts for, and whether it is on the boundary of the mesh.
///
/// Over an edge that bends outward the nearest place of many points is on that edge, as near by each of its triangles. Rounding would
/// choose one, and another one where the data is turned; so the first of them is taken.
fn owner(
    mesh: &Mesh,
    incidence: &Incidence,
    open: &[u8],
    t: u32,
    weights: [f64; 3],
) -> (u32, bool) {
    let triangles = &mesh.complex.triangles;
    let own = triangles[t as usize];
    let holds = |corner: &u32| own.iter().zip(weights).any(|(c, w)| c == corner && w > TIE);
    let held = weights.iter().filter(|w| **w > TIE).count();
    let Some(first) = own.iter().find(|c| holds(c)).filter(|_| held < 3) else {
        return (t, false);
    };
    let (mut least, mut on_boundary) = (t, false);
    for &other in incidence.at_vertex(*first as usize) {
        let corners = triangles[other as usize];
        if corners.iter().filter(|c| holds(c)).count() == held {
            least = least.min(other);
            on_boundary |=
                (0..3).any(|k| open[other as usize] >> k & 1 == 1 && !holds(&corners[k]));
        }
    }
    (least, on_boundary)
}

/// For every triangle the sides (bit k: opposite corner k) that no other triangle has.
fn open_sides(mesh: &Mesh, incidence: &Incidence) -> Vec<u8> {
    let mut open = vec![0; mesh.complex.triangles.len()];
    for (e, ends) in incidence.edges.iter().enumerate() {
        if let &[t] = incidence.at_edge(e) {
            let corners = mesh.complex.triangles[t as usize];
            for (k, corner) in corners.iter().enumerate() {
                if !ends.contains(corner) {
                    open[t as usize] |= 1 << k;
                }
            }
        }
    }
    open
}

/// Weights of the corners at the place of a triangle that is nearest to a point; the triangle may
/// be an edge whose end is named twice.
pub(super) fn nearest_weights(point: &[f64], [a, b, c]: [&[f64]; 3]) -> [f64; 3] {
    let products = Products::of(point, a, [a, b, c]);
    if let Some([s, t]) = products.inside() {
        return [1.0 - (s + t), s, t];
    }
    let Products {
        uu, uv, vv, wu, wv, ..
    } = products;
    let share = |along: f64, length: f64| {
        if length > 0.0 {
            (along / length).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let (ab, ac) = (share(wu, uu), share(wv, vv));
    let bc = share(wv - wu - uv + uu, uu - 2.0 * uv + vv);
    let sides = [
        [1.0 - ab, ab, 0.0],
        [1.0 - ac, 0.0, ac],
        [0.0, 1.0 - bc, bc],
    ];
    let square = |w: &[f64; 3]| -> f64 {
        let at: Vec<f64> = (0..point.len())
            .map(|k| w[0] * a[k] + w[1] * b[k] + w[2] * c[k])
            .collect();
        squared_distance(&at, point)
    };
    let mut best = (square(&sides[0]), sides[0]);
    for side in &sides[1..] {
        let away = square(side);
        if away < best.0 {
            best = (away, *side);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certificate::geometry;
    use crate::surfaces::{Random, RigidMotion};
    use crosscap_core::{Complex, CurveEdge};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_nearest_place_is_as_near_as_its_distance(x in prop::collection::vec(-1.0..1.0_f64, 16)) {
            let (p, t) = (&x[..4], [&x[4..8], &x[8..12], &x[12..]]);
            let w = nearest_weights(p, t);
            prop_assert!(w.iter().all(|&w| (0.0..=1.0).contains(&w)));
            prop_assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let at: Vec<f64> = (0..4).map(|k| w[0] * t[0][k] + w[1] * t[1][k] + w[2] * t[2][k]).collect();
            let square = point_triangle(p, t[0], t[1], t[2]);
            prop_assert!((squared_distance(&at, p) - square).abs() < 1e-12);
        }
    }

    /// A pyramid without its base, over which many points are nearest to an edge or to the tip. However it is turned, each point counts for
    /// the same triangle, the first that holds its nearest place, and is on the boundary or not.
    #[test]
    fn a_point_over_an_edge_counts_for_the_same_triangle_however_the_data_is_turned() {
        let rim = |k: u32| f64::from(k) * 0.4 * std::f64::consts::PI;
        let mut places = vec![0.0, 0.0, 0.7];
        places.extend((0..5).flat_map(|k| [rim(k).cos(), rim(k).sin(), 0.0]));
        let triangles = (0..5).map(|k| {
            let mut corners = [0, 1 + k, 1 + (k + 1) % 5];
            corners.sort_unstable();
            corners
        });
        let rims = (0..5).map(|k| CurveEdge::new(1 + k, 1 + (k + 1) % 5, 1));
        let complex = Complex::new(6, triangles.collect(), rims.collect()).unwrap();
        let mut random = Random::stream(5, 0);
        let rows: Vec<f64> = (0..300).map(|_| random.between(-1.5, 1.5)).collect();
        let standing = |motion: Option<RigidMotion>| {
            let moved = |rows: &[f64]| {
                let cloud = PointCloud::new(3, rows.to_vec()).unwrap();
                motion
                    .as_ref()
                    .map_or(cloud.clone(), |m| m.apply(&cloud).unwrap())
            };
            let (vertices, points) = (moved(&places), moved(&rows));
            let mesh = Mesh::new(complex.clone(), vertices, vec![-1; 6]).unwrap();
            let incidence = Incidence::new(&mesh.complex);
            let frame = Frame::new(&mesh.vertices, Some(&points));
            let tree = geometry::tree(&mesh, &frame, &[]);
            let feet = Footprints::new(&mesh, &incidence, &frame, &tree, &[], &points, 0..100);
            (feet.items, feet.on_boundary)
        };
        let plain = standing(None);
        assert!(plain.1.contains(&true) && plain.1.contains(&false));
        for seed in 0..5 {
            assert_eq!(
                standing(Some(RigidMotion::random(3, 2.0, seed))),
                plain,
                "{seed}"
            );
        }
    }
}
