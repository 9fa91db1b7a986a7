//! What measures charts.

use crate::space::Space;
use crosscap_core::Scalar;

/// What says how far a chart reaches, and measures the distances in it.
#[derive(Clone, Copy)]
pub enum ChartSpace<'a, S: Scalar> {
    /// Straight lines between the places of the points, those on curves moved onto them.
    Places,
    /// A metric on the rows of the input.
    Metric(Space<'a, S>),
}
