//! Surfaces with pinch points: Whitney's umbrella and the cross-cap.

use super::flat::rectangle_rim;
use super::projective::{on_sphere, propose_from_half_sphere};
use super::{Jet, Piece, Random, RimSegment};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Whitney's umbrella without its handle, (u v, v, u^2) with |u| and |v| at most 1: the double segment
/// on the third axis ends in the pinch point at the origin, and at the other end where the boundary
/// crosses itself. Parameters: u, v.
///
/// Source: H. Whitney, The general type of singularity of a set of 2n - 1 smooth functions of n
/// variables, Duke Math. J. 10 (1943).
#[derive(Clone, Copy, Debug)]
pub struct Umbrella;

impl Piece for Umbrella {
    fn name(&self) -> &'static str {
        "umbrella"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }
    fn ends(&self) -> [bool; 2] {
        [true; 2]
    }
    fn map(&self, [u, v]: [Jet; 2], place: &mut [Jet]) {
        place.copy_from_slice(&[u * v, v, u * u]);
    }
    fn area_element_bound(&self) -> f64 {
        // Its square is v^2 + 4 u^2 + 4 u^4.
        3.0
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rectangle_rim(self.domain())]
    }
}

/// The cross-cap, (x z, y z, (z^2 - x^2) / 2) of the unit sphere: the projective plane with one double
/// segment on the third axis between two pinch points, the origin and (0, 0, -1/2). Parameters: polar angle up to the equator, azimuth.
///
/// Source: G. Francis, A Topological Picturebook (1987), chapter 1.
#[derive(Clone, Copy, Debug)]
pub struct CrossCap;

impl Piece for CrossCap {
    fn name(&self) -> &'static str {
        "cross-cap"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, FRAC_PI_2], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, at: [Jet; 2], place: &mut [Jet]) {
        let [x, y, z] = on_sphere(at);
        place.copy_from_slice(&[x * z, y * z, (z * z - x * x) * 0.5]);
    }
    fn area_element_bound(&self) -> f64 {
        // Up to a factor of sqrt(2) three orthonormal functionals of p p^T, which stretches by sqrt(2).
        1.0
    }
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        propose_from_half_sphere(self, random, place, 1.0)
    }
}
