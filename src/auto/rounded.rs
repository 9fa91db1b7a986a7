//! Coordinates so coarse that what is seen may be their rounding.

use super::input::Input;
use crate::pipeline::distinct_points;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::prepare::{LocalSpacing, Resolution};
use crosscap_algorithms::tuning::ResolutionTuning;
use crosscap_core::PointCloud;
use serde::Serialize;
use std::fmt;

/// Coordinates that are rounded to steps larger than the points are apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rounded {
    /// The step, unit of the data.
    pub step: f64,
    /// Spacing of the points, unit of the data.
    pub spacing: f64,
    /// The largest coordinate, unit of the data.
    pub largest: f64,
}

/// Steps in spacings that are too coarse: rounding to steps of h scatters points by h / sqrt 12 across the surface, which
/// is half a spacing, and of points that lie in sheets, a step apart, the sheets are what is seen. A sphere of
/// 6000 points rounded to steps of 1.4 spacings came out right, and one of 5.5 as four pieces.
const TOO_COARSE: f64 = 2.0;
/// Steps between the points and the origin, from which on the step is that of 32-bit numbers (whose steps are between
/// 2^-24 and 2^-23 of a number) and not of a lattice, which somebody wants.
const FAR: f64 = (1_u32 << 22) as f64;

impl Rounded {
    /// What there is to say against the coordinates of an input; nothing for distances.
    pub(super) fn of(input: &Input<'_>, tuning: &ResolutionTuning) -> Option<Self> {
        match input {
            Input::Points(cloud) => Self::in_cloud(cloud, tuning),
            Input::Distances(_) => None,
        }
    }

    fn in_cloud(cloud: &PointCloud<f64>, tuning: &ResolutionTuning) -> Option<Self> {
        let coordinates = cloud.coordinates().iter();
        let largest = coordinates.fold(0.0_f64, |most, x| most.max(x.abs()));
        // Most clouds are told by this alone.
        if is_near(cloud, largest) {
            return None;
        }
        let distinct = distinct_points(cloud);
        let spacing = LocalSpacing::of(&distinct, &Serial).ok()?;
        let found = Resolution::of(&distinct, &spacing, tuning);
        let is_far = largest >= FAR * found.step;
        (is_far && found.of_spacing >= TOO_COARSE).then(|| Self {
            step: found.step,
            spacing: spacing.median(),
            largest,
        })
    }
}

/// Whether the points are so near to the origin, or so few, that steps of 32-bit numbers are less than their spacing:
/// points of a surface of that extent are no nearer to each other than those of a line.
fn is_near(cloud: &PointCloud<f64>, largest: f64) -> bool {
    let extent = |axis: usize| {
        let column = || cloud.iter().map(|row| row[axis]);
        column().fold(f64::NEG_INFINITY, f64::max) - column().fold(f64::INFINITY, f64::min)
    };
    let longest = (0..cloud.dimension()).map(extent).fold(0.0, f64::max);
    largest * cloud.len() as f64 <= FAR * longest
}

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "coordinates as large as {:.3e} are rounded to steps of {:.1e}, and points are {:.1e} apart",
            self.largest, self.step, self.spacing
        )
    }
}
