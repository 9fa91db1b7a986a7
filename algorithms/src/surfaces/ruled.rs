//! Pieces made of straight lines, with closed forms: cylinders and cones.

use super::round::rim_at_first;
use super::{Jet, Piece, Random, RimSegment};
use std::f64::consts::{PI, TAU};

/// A cylinder of finite height about the z axis. Parameters: angle, height.
#[derive(Clone, Debug)]
pub struct Cylinder {
    name: &'static str,
    radius: f64,
    half_height: f64,
}

impl Cylinder {
    /// The cylinder of `radius` with heights from `-half_height` to `half_height`.
    pub fn new(name: &'static str, radius: f64, half_height: f64) -> Self {
        Self {
            name,
            radius,
            half_height,
        }
    }
}

impl Piece for Cylinder {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, TAU], [-self.half_height, self.half_height]]
    }
    fn ends(&self) -> [bool; 2] {
        [false, true]
    }
    fn map(&self, [angle, height]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = angle.sin_cos();
        place.copy_from_slice(&[c * self.radius, s * self.radius, height]);
    }
    fn area_element_bound(&self) -> f64 {
        self.radius
    }
    fn area(&self) -> f64 {
        2.0 * TAU * self.radius * self.half_height
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        [-1.0, 1.0]
            .map(|side| {
                let height = side * self.half_height;
                vec![RimSegment {
                    from: [0.0, height],
                    to: [TAU, height],
                }]
            })
            .into()
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let beyond = place[2] - place[2].clamp(-self.half_height, self.half_height);
        Some(libm::hypot(
            libm::hypot(place[0], place[1]) - self.radius,
            beyond,
        ))
    }
}

/// The surface of a cone about the z axis, without its lid. Parameters: distance from the apex as a share of
/// that of the rim, angle.
#[derive(Clone, Debug)]
pub struct Cone {
    name: &'static str,
    apex: f64,
    base: f64,
    radius: f64,
}

impl Cone {
    /// The cone with its apex at height `apex` and a rim of `radius` at height `base`.
    pub fn new(name: &'static str, apex: f64, base: f64, radius: f64) -> Self {
        Self {
            name,
            apex,
            base,
            radius,
        }
    }

    fn slant(&self) -> f64 {
        libm::hypot(self.radius, self.base - self.apex)
    }
}

impl Piece for Cone {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [share, angle]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = angle.sin_cos();
        let across = share * self.radius;
        let height = share * (self.base - self.apex) + self.apex;
        place.copy_from_slice(&[across * c, across * s, height]);
    }
    fn area_element_bound(&self) -> f64 {
        self.radius * self.slant() * (1.0 + 1e-12)
    }
    fn area(&self) -> f64 {
        PI * self.radius * self.slant()
    }
    /// The squared distance from the apex is uniform.
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let at = [random.uniform().sqrt(), random.between(0.0, TAU)];
        self.map(at.map(Jet::constant), place);
        (at, 1.0)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![rim_at_first(1.0, [0.0, TAU])]
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let (across, height) = (libm::hypot(place[0], place[1]), place[2] - self.apex);
        let rise = self.base - self.apex;
        let share = (across * self.radius + height * rise) / self.slant().powi(2);
        let share = share.clamp(0.0, 1.0);
        Some(libm::hypot(
            across - share * self.radius,
            height - share * rise,
        ))
    }
}
