//! What measures charts.

use crate::space::Space;
use crate::tangents::TangentField;
use crosscap_core::Scalar;

/// What says how far a chart reaches, and measures the distances in it.
#[derive(Clone, Copy)]
pub enum ChartSpace<'a, S: Scalar> {
    /// Straight lines between the places of the points, those on curves moved onto them.
    Places,
    /// A metric on the rows of the input.
    Metric(Space<'a, S>),
    /// The same, where that are lengths of paths along the surface: what they are too long by is taken away where the tangent planes
    /// tell ([`TangentField::length`]), and elsewhere what they usually are. How far a chart reaches is asked of the metric alone.
    Along(Space<'a, S>, &'a TangentField),
}

impl<'a, S: Scalar> ChartSpace<'a, S> {
    /// The space whose metric it is; `None` for places.
    pub fn space(&self) -> Option<&Space<'a, S>> {
        match self {
            Self::Places => None,
            Self::Metric(space) | Self::Along(space, _) => Some(space),
        }
    }

    /// What is known of the tangent planes.
    pub(super) fn planes(&self) -> Option<&'a TangentField> {
        match self {
            Self::Along(_, planes) => Some(planes),
            Self::Places | Self::Metric(_) => None,
        }
    }
}
