//! Cayley's nodal cubic, which has four cone points.

use super::nearest::{Patch, nearest_distances};
use super::round::rim_at_first;
use super::surface::SampleSurface;
use super::truth::{DISC, SPHERE, plain};
use super::{Jet, Piece, PointKind, RimSegment, Truth};
use crosscap_core::PointCloud;
use std::f64::consts::{PI, TAU};

/// How far the outer parts reach: squared hyperbolic length from their nodes.
const REACH: f64 = 1.69;
/// How far coordinates about the nodes reach over the bounded part: squared length, a little more than half way between three.
const HALF_WAY: f64 = 4.6;
/// Greatest area elements: of the pillow 3 sqrt(3) / 4, in its middle; of an outer part at its rim, rounded up.
const BOUNDS: [f64; 2] = [1.299_04, 0.83];

/// The places at which `x^2 + y^2 + z^2 - 2 x y z = 1` is the tip of two cones.
const NODES: [[f64; 3]; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
];

/// Coordinates about a node: the cosines of three lengths whose sum is 0, hyperbolic ones where the first parameter is negative. It is their
/// squared size, and the second an angle that goes around once from 0 to pi.
fn about(node: [f64; 3], [square, angle]: [Jet; 2], place: &mut [Jet]) {
    for (k, (x, sign)) in place.iter_mut().zip(node).enumerate() {
        let (_, cosine) = (angle + TAU * k as f64 / 3.0).sin_cos();
        *x = (square * cosine * cosine).cos_of_root() * sign;
    }
}

/// The bounded part, a pillow with a tip at each of the four nodes: cosines of three angles of which one is the sum of the
/// others. Parameters: these two.
struct Pillow;

impl Piece for Pillow {
    fn name(&self) -> &'static str {
        "pillow"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, PI], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, [a, b]: [Jet; 2], place: &mut [Jet]) {
        place.copy_from_slice(&[a, b, a + b].map(|angle| angle.sin_cos().1));
    }
    fn area_element_bound(&self) -> f64 {
        BOUNDS[0]
    }
    /// The parameters are singular at the nodes; coordinates about each of them are not.
    fn distances(&self, cloud: &PointCloud<f64>) -> Vec<f64> {
        let mut nearest = vec![f64::INFINITY; cloud.len()];
        for node in NODES {
            let patch = Patch {
                dimension: 3,
                domain: [[0.0, HALF_WAY], [0.0, PI]],
                ends: [true, false],
                map: &|parameters, place| about(node, parameters, place),
            };
            for (least, d) in nearest.iter_mut().zip(nearest_distances(&patch, cloud)) {
                *least = d.min(*least);
            }
        }
        nearest
    }
}

/// An outer part, a funnel that opens from a node.
struct Funnel {
    name: &'static str,
    node: [f64; 3],
}

impl Piece for Funnel {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-REACH, 0.0], [0.0, PI]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, parameters: [Jet; 2], place: &mut [Jet]) {
        about(self.node, parameters, place);
    }
    fn area_element_bound(&self) -> f64 {
        BOUNDS[1]
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rim_at_first(-REACH, [0.0, PI])]
    }
}

/// Four funnels on the corners of a pillow.
pub(super) fn cayley() -> SampleSurface {
    const NAMES: [&str; 4] = ["funnel 1", "funnel 2", "funnel 3", "funnel 4"];
    let mut pieces: Vec<Box<dyn Piece>> = vec![Box::new(Pillow)];
    for (name, node) in NAMES.into_iter().zip(NODES) {
        pieces.push(Box::new(Funnel { name, node }));
    }
    SampleSurface::new(
        "cayley",
        "Cayley's cubic about its four cone points: a pillow, at each corner of which a funnel opens",
        pieces,
        Truth {
            isolated_crossings: 4,
            ..plain([1, 0, 1], &[SPHERE, DISC, DISC, DISC, DISC], 4)
        },
        12_000,
    )
    .at(PointKind::Isolated, NODES.map(Vec::from))
}
