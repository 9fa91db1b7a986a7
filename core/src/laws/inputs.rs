//! Inputs that laws are tested on, as strategies of proptest.

use crate::{ChartTriangle, Landmark, PointCloud};
use proptest::collection::vec;
use proptest::prelude::*;
use std::ops::RangeInclusive;

/// Clouds: half of them on a coarse lattice, full of ties and copies, half anywhere; at scales from
/// an eighth to eight.
pub fn clouds(
    dimensions: RangeInclusive<usize>,
    points: RangeInclusive<usize>,
) -> impl Strategy<Value = PointCloud<f64>> {
    (dimensions, points, any::<bool>(), -3..=3_i32).prop_flat_map(
        |(dimension, points, anywhere, exponent)| {
            let coordinate = if anywhere {
                (-1.0..1.0_f64).boxed()
            } else {
                (-3..=3_i32).prop_map(f64::from).boxed()
            };
            vec(coordinate, dimension * points)
                .prop_map(move |rows| cloud(dimension, &rows, f64::from(exponent).exp2()))
        },
    )
}

/// A cloud from finite coordinates of moderate size.
pub(super) fn cloud(dimension: usize, rows: &[f64], factor: f64) -> PointCloud<f64> {
    let rows = rows.iter().map(|x| x * factor).collect();
    PointCloud::new(dimension, rows).expect("coordinates are finite and in whole rows")
}

/// Points near a flat piece, the first of them in its middle: what a neighborhood looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatSample {
    /// Dimension of the flat piece.
    pub intrinsic: usize,
    /// The points; their leading `intrinsic` coordinates are in -1..1, the others much smaller or 0.
    pub cloud: PointCloud<f64>,
}

/// Flat pieces of dimension 1 to 4 in spaces of at most two dimensions more, with 12 to 60 points.
pub fn flat_samples() -> impl Strategy<Value = FlatSample> {
    let thickness = prop_oneof![Just(0.0), Just(0.01), Just(0.1)];
    (1..=4_usize, 0..=2_usize, 12..=60_usize, thickness).prop_flat_map(
        |(intrinsic, more, points, thickness)| {
            let dimension = intrinsic + more;
            vec(-1.0..1.0_f64, dimension * points).prop_map(move |mut rows| {
                for (k, x) in rows.iter_mut().enumerate() {
                    if k < dimension {
                        *x *= 0.01;
                    }
                    if k % dimension >= intrinsic {
                        *x *= thickness;
                    }
                }
                FlatSample {
                    intrinsic,
                    cloud: cloud(dimension, &rows, 1.0),
                }
            })
        },
    )
}

/// New places for things in a row: the ranks of random keys, so that it shrinks to "all stay".
pub fn permutations(count: usize) -> impl Strategy<Value = Vec<usize>> {
    vec(any::<u16>(), count).prop_map(|keys| ranks(&keys))
}

/// The indices in the order of their keys.
pub(super) fn ranks(keys: &[u16]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by_key(|&k| keys[k]);
    order
}

/// Two triangles on a small lattice, neither of them flat. Landmarks are named by their places, so
/// equal corners are shared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticePair {
    /// Corners of the first.
    pub a: [[i32; 2]; 3],
    /// Corners of the second.
    pub b: [[i32; 2]; 3],
}

impl LatticePair {
    /// The triangles in a chart, each place moved by `place`.
    pub fn triangles(&self, place: impl Fn([f64; 2]) -> [f64; 2]) -> [ChartTriangle; 2] {
        [self.a, self.b].map(|t| ChartTriangle {
            corners: t.map(|[x, y]| Landmark::new((64 * (x + 16) + y + 16) as usize)),
            places: t.map(|p| place(p.map(f64::from))),
        })
    }
}

/// Twice the signed area of a lattice triangle.
pub(super) fn area(p: [i32; 2], q: [i32; 2], r: [i32; 2]) -> i64 {
    let d = |a: i32, b: i32| i64::from(a) - i64::from(b);
    d(q[0], p[0]) * d(r[1], p[1]) - d(q[1], p[1]) * d(r[0], p[0])
}

/// Pairs of all kinds: apart, with common corners or sides, touching, crossing, one in the other.
pub fn lattice_pairs() -> impl Strategy<Value = LatticePair> {
    let corner = || [0..=6_i32, 0..=6_i32];
    let triangle = || [corner(), corner(), corner()];
    // How many corners of the second are taken from the first.
    (triangle(), triangle(), 0..=3_usize, 0..3_usize).prop_filter_map(
        "flat triangle",
        |(a, mut b, shared, turn)| {
            for k in 0..shared {
                b[(k + turn) % 3] = a[k];
            }
            let flat = |t: [[i32; 2]; 3]| area(t[0], t[1], t[2]) == 0;
            (!flat(a) && !flat(b)).then_some(LatticePair { a, b })
        },
    )
}
