//! Round pieces with closed forms: spheres and their caps, tori, rings.

use super::{Jet, Piece, Random, RimSegment};
use std::f64::consts::{PI, TAU};

/// An orthonormal frame of space whose third axis is given.
pub(super) fn frame_about(axis: [f64; 3]) -> [[f64; 3]; 3] {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let z = axis.map(|x| x / length);
    // The coordinate axis that is farthest from z gives the best conditioned first vector.
    let k = (0..3)
        .min_by(|&a, &b| z[a].abs().total_cmp(&z[b].abs()))
        .unwrap_or(0);
    let mut x: [f64; 3] = std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 } - z[k] * z[i]);
    let length = x.iter().map(|a| a * a).sum::<f64>().sqrt();
    x = x.map(|a| a / length);
    [x, cross(z, x), z]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

/// Coordinates of `place` in a frame at `center`.
fn local(frame: &[[f64; 3]; 3], center: [f64; 3], place: &[f64]) -> [f64; 3] {
    frame.map(|axis| (0..3).map(|k| axis[k] * (place[k] - center[k])).sum())
}

fn compose(frame: &[[f64; 3]; 3], center: [f64; 3], local: [Jet; 3], place: &mut [Jet]) {
    for (k, out) in place.iter_mut().enumerate() {
        *out = local[0] * frame[0][k] + local[1] * frame[1][k] + local[2] * frame[2][k] + center[k];
    }
}

/// A rim that runs through the whole range of the second parameter at a fixed first one.
pub(super) fn rim_at_first(first: f64, [low, high]: [f64; 2]) -> Vec<RimSegment> {
    vec![RimSegment {
        from: [first, low],
        to: [first, high],
    }]
}

/// A sphere, or the cap of it within an angle of an axis. Parameters: polar angle from the
/// axis, azimuth.
#[derive(Clone, Debug)]
pub struct SphereCap {
    name: &'static str,
    center: [f64; 3],
    radius: f64,
    frame: [[f64; 3]; 3],
    angle: f64,
}

impl SphereCap {
    /// A whole sphere.
    pub fn sphere(name: &'static str, center: [f64; 3], radius: f64) -> Self {
        Self::cap(name, center, radius, [0.0, 0.0, 1.0], PI)
    }

    /// The places of a sphere whose direction from the center is within `angle` (radians) of `axis`.
    pub fn cap(
        name: &'static str,
        center: [f64; 3],
        radius: f64,
        axis: [f64; 3],
        angle: f64,
    ) -> Self {
        Self {
            name,
            center,
            radius,
            frame: frame_about(axis),
            angle,
        }
    }
}

impl Piece for SphereCap {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, self.angle], [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [polar, azimuth]: [Jet; 2], place: &mut [Jet]) {
        let ((sp, cp), (sa, ca)) = (polar.sin_cos(), azimuth.sin_cos());
        let local = [sp * ca, sp * sa, cp].map(|x| x * self.radius);
        compose(&self.frame, self.center, local, place);
    }
    fn area_element_bound(&self) -> f64 {
        self.radius * self.radius
    }
    fn area(&self) -> f64 {
        TAU * self.radius * self.radius * (1.0 - libm::cos(self.angle))
    }
    /// Archimedes: the height above the base is uniform.
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let height = 1.0 - random.uniform() * (1.0 - libm::cos(self.angle));
        let at = [libm::acos(height), random.between(0.0, TAU)];
        self.map(at.map(Jet::constant), place);
        (at, 1.0)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        if self.angle < PI {
            vec![rim_at_first(self.angle, [0.0, TAU])]
        } else {
            Vec::new()
        }
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let [x, y, z] = local(&self.frame, self.center, place);
        let across = libm::hypot(x, y);
        Some(if libm::atan2(across, z) <= self.angle {
            (libm::hypot(across, z) - self.radius).abs()
        } else {
            let (s, c) = libm::sincos(self.angle);
            libm::hypot(across - self.radius * s, z - self.radius * c)
        })
    }
}

/// A torus of revolution. Parameters: angle about the axis, angle about the tube.
#[derive(Clone, Debug)]
pub struct Torus {
    name: &'static str,
    center: [f64; 3],
    frame: [[f64; 3]; 3],
    radius: f64,
    tube: f64,
}

impl Torus {
    /// A torus with a core circle of `radius` about `axis` through `center` and a tube of radius `tube`.
    pub fn new(
        name: &'static str,
        center: [f64; 3],
        axis: [f64; 3],
        radius: f64,
        tube: f64,
    ) -> Self {
        Self {
            name,
            center,
            frame: frame_about(axis),
            radius,
            tube,
        }
    }

    /// Distance to the surface, negative inside the tube.
    pub fn signed_distance(&self, place: &[f64]) -> f64 {
        let [x, y, z] = local(&self.frame, self.center, place);
        libm::hypot(libm::hypot(x, y) - self.radius, z) - self.tube
    }
}

impl Piece for Torus {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, TAU]; 2]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, [about_axis, about_tube]: [Jet; 2], place: &mut [Jet]) {
        let ((s, c), (st, ct)) = (about_axis.sin_cos(), about_tube.sin_cos());
        let reach = ct * self.tube + self.radius;
        compose(
            &self.frame,
            self.center,
            [reach * c, reach * s, st * self.tube],
            place,
        );
    }
    fn area_element_bound(&self) -> f64 {
        self.tube * (self.radius + self.tube)
    }
    fn area(&self) -> f64 {
        TAU * TAU * self.radius * self.tube
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        Some(self.signed_distance(place).abs())
    }
}

/// A flat ring in a plane of R^N, a disc when the inner radius is 0. Parameters: distance from
/// the center, angle.
#[derive(Clone, Debug)]
pub struct Ring {
    name: &'static str,
    center: Vec<f64>,
    axes: [Vec<f64>; 2],
    radii: [f64; 2],
}

impl Ring {
    /// The ring between two `radii` (inner, outer) about `center`, in the plane of two orthonormal `axes`.
    pub fn new(name: &'static str, center: Vec<f64>, axes: [Vec<f64>; 2], radii: [f64; 2]) -> Self {
        Self {
            name,
            center,
            axes,
            radii,
        }
    }
}

impl Piece for Ring {
    fn name(&self) -> &'static str {
        self.name
    }
    fn ambient_dimension(&self) -> usize {
        self.center.len()
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.radii, [0.0, TAU]]
    }
    fn ends(&self) -> [bool; 2] {
        [true, false]
    }
    fn map(&self, [distance, angle]: [Jet; 2], place: &mut [Jet]) {
        let (s, c) = angle.sin_cos();
        let [x, y] = [distance * c, distance * s];
        for (k, out) in place.iter_mut().enumerate() {
            *out = x * self.axes[0][k] + y * self.axes[1][k] + self.center[k];
        }
    }
    fn area_element_bound(&self) -> f64 {
        self.radii[1]
    }
    fn area(&self) -> f64 {
        PI * (self.radii[1] * self.radii[1] - self.radii[0] * self.radii[0])
    }
    /// The squared distance from the center is uniform.
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let [inner, outer] = self.radii.map(|r| r * r);
        let at = [
            random.between(inner, outer).sqrt(),
            random.between(0.0, TAU),
        ];
        self.map(at.map(Jet::constant), place);
        (at, 1.0)
    }
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        self.radii
            .into_iter()
            .filter(|&r| r > 0.0)
            .map(|r| rim_at_first(r, [0.0, TAU]))
            .collect()
    }
    fn closed_form_distance(&self, place: &[f64]) -> Option<f64> {
        let mut rest: Vec<f64> = place.iter().zip(&self.center).map(|(x, c)| x - c).collect();
        let mut within = [0.0; 2];
        for (along, axis) in within.iter_mut().zip(&self.axes) {
            *along = rest.iter().zip(axis).map(|(r, a)| r * a).sum();
            rest.iter_mut()
                .zip(axis)
                .for_each(|(r, a)| *r -= *along * a);
        }
        let off = rest.iter().map(|r| r * r).sum::<f64>().sqrt();
        let distance = libm::hypot(within[0], within[1]);
        let beyond = distance - distance.clamp(self.radii[0], self.radii[1]);
        Some(libm::hypot(off, beyond))
    }
}
