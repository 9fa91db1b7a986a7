//! Singularity models.

mod book;
mod book_end;
mod boundary;
mod boundary_corner;
mod choice;
mod cone_point;
mod curve;
mod curve_and_sheet;
mod curve_end;
mod curve_fit;
mod envelope;
mod flats;
mod isolated_crossing;
mod kink;
mod lowest;
mod one_fit;
mod page_sheets;
mod pages;
mod patch;
mod pinch_map;
mod pinch_point;
mod plane_pair;
mod quadric_cone;
mod regular;
mod rim;
mod sheet_in_four;
mod sheets;
mod tangency;
mod tolerance;
mod triple_point;
mod two_planes;
mod vanishing;
mod wedge;
mod y_junction;
pub use book::Book;
pub use book_end::BookEnd;
pub use boundary::Boundary;
pub use boundary_corner::BoundaryCorner;
pub use choice::ModelName;
pub use cone_point::ConePoint;
pub use curve::BareCurve;
pub use curve_and_sheet::{CurveOnSheet, CurveThroughSheet};
pub use isolated_crossing::IsolatedCrossing;
pub use patch::QuadraticPatch;
pub use pinch_point::PinchPoint;
pub use plane_pair::PlanePair;
pub use regular::OneSheet;
pub use tangency::Tangency;
pub use triple_point::TriplePoint;
pub use two_planes::TwoPlanes;
pub use y_junction::YJunction;

/// Points of R^3 about the first of them, all of them fitted.
#[cfg(test)]
fn about_first(coordinates: &[f64], radius: f64) -> crosscap_core::LocalPoints<'_> {
    crosscap_core::LocalPoints {
        dimension: 3,
        coordinates,
        fitted: coordinates.len() / 3,
        center: 0,
        middle: 0,
        radius,
    }
}
