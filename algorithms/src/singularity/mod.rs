//! Singularity models.

mod boundary;
mod choice;
mod curve;
mod curve_and_sheet;
mod curve_fit;
mod envelope;
mod flats;
mod isolated_crossing;
mod patch;
mod regular;
mod sheet_in_four;
mod sheets;
mod tolerance;
mod triple_point;
mod two_planes;
mod vanishing;
mod y_junction;
pub use boundary::Boundary;
pub use choice::ModelName;
pub use curve::BareCurve;
pub use curve_and_sheet::{CurveOnSheet, CurveThroughSheet};
pub use isolated_crossing::IsolatedCrossing;
pub use patch::QuadraticPatch;
pub use regular::OneSheet;
pub use triple_point::TriplePoint;
pub use two_planes::{PlanePair, TwoPlanes};
pub use y_junction::YJunction;
