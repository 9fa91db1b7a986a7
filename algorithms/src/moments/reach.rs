//! The radius of the balls, and when exactly a point is inside.

use super::tree::Tree;
use crosscap_core::{Error, PointCloud, Scalar, squared_distance};

/// Radii outside of this window square to zero or infinity.
const SMALLEST: f64 = 1e-140;
const LARGEST: f64 = 1e140;

/// A radius with what follows from it.
pub(super) struct Reach<'a, S> {
    pub(super) tree: &'a Tree,
    pub(super) cloud: &'a PointCloud<S>,
    /// The radius in units of the tree.
    pub(super) unit: f64,
    pub(super) inverse: f64,
    /// Largest squared distance whose root, rounded to `S`, is below the radius.
    largest_square: f64,
    /// Relative spacing of `S`.
    spacing: f64,
}

impl<'a, S: Scalar> Reach<'a, S> {
    pub(super) fn new(tree: &'a Tree, cloud: &'a PointCloud<S>, eps: f64) -> Result<Self, Error> {
        let radius = S::of(eps);
        let wide = radius.as_f64();
        if !(wide > SMALLEST && wide < LARGEST && wide.is_finite()) {
            return Err(Error::Parameter {
                name: "eps",
                value: eps.to_string(),
                expected: format!(
                    "a radius between {SMALLEST:e} and {LARGEST:e} that {} can hold",
                    S::NAME
                ),
            });
        }
        // The test is monotonic, and so are positive numbers in their bits.
        let (mut inside, mut outside) = (0_u64, f64::INFINITY.to_bits());
        while outside - inside > 1 {
            let middle = inside + (outside - inside) / 2;
            if S::of(f64::from_bits(middle).sqrt()) < radius {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let unit = wide * tree.placement.scale;
        Ok(Self {
            tree,
            cloud,
            unit,
            inverse: 1.0 / unit,
            largest_square: f64::from_bits(inside),
            spacing: S::default_epsilon().as_f64(),
        })
    }

    /// Whether two positions of the tree are within reach, from the original coordinates.
    pub(super) fn holds(&self, a: usize, b: usize) -> bool {
        let row = |position: usize| self.cloud.point(self.tree.order[position] as usize);
        squared_distance(row(a), row(b)) <= self.largest_square
    }

    /// Bound on what rounding displaces a point by in the tree, in units of the radius, within
    /// a few radii of a place of the given norm.
    pub(super) fn noise(&self, norm: f64) -> f64 {
        let ambient = self.tree.placement.ambient as f64;
        let steps = if self.tree.placement.axes.is_some() {
            4.0 * ambient + 16.0
        } else {
            ambient + 4.0
        };
        (steps * f64::EPSILON * (norm + 4.0 * self.unit) + 2.0 * self.tree.placement.dropped)
            * self.inverse
    }

    /// Relative half width of the shell around the sphere in which the original coordinates
    /// decide: rounding to `f32`, to `S`, and `noise`.
    pub(super) fn shell(&self, noise: f64) -> f64 {
        8e-6 + 16.0 * self.spacing + 8.0 * noise
    }
}
