//! Coordinates so coarse that what is seen may be their rounding.

use super::input::Input;
use crate::pipeline::distinct_points;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::prepare::{LocalSpacing, Resolution};
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
    pub(super) fn of(input: &Input<'_>) -> Option<Self> {
        match input {
            Input::Points(cloud) => Self::in_cloud(cloud),
            Input::Distances(_) => None,
        }
    }

    fn in_cloud(cloud: &PointCloud<f64>) -> Option<Self> {
        let coordinates = cloud.coordinates().iter();
        let largest = coordinates.fold(0.0_f64, |most, x| most.max(x.abs()));
        // Most clouds are told by this alone.
        if coordinates_are_fine(cloud, largest) {
            return None;
        }
        let distinct = distinct_points(cloud);
        let spacing = LocalSpacing::of(&distinct, &Serial).ok()?;
        let found = Resolution::of(&distinct, &spacing);
        let is_far = largest >= FAR * found.step;
        (is_far && found.of_spacing >= TOO_COARSE).then(|| Self {
            step: found.step,
            spacing: spacing.median(),
            largest,
        })
    }
}

/// Whether some coordinate of the first rows has more digits than a 32-bit number as large as the largest one.
fn coordinates_are_fine(cloud: &PointCloud<f64>, largest: f64) -> bool {
    let step = largest / FAR / 4.0;
    let column_is_fine = |axis: usize| {
        let mut values = cloud.iter().take(ROWS).map(|row| row[axis] / step);
        values.any(|x| (x - x.round()).abs() > 1e-3)
    };
    largest == 0.0 || (0..cloud.dimension()).all(column_is_fine)
}

/// Rows whose digits are looked at first.
const ROWS: usize = 100;

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "coordinates as large as {:.3e} are rounded to steps of {:.1e}, and points are {:.1e} apart",
            self.largest, self.step, self.spacing
        )
    }
}
