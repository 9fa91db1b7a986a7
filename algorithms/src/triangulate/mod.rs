//! From the waist to the complex: an advancing front of stars.

mod front;
mod rule;
mod rules;
mod star;
pub use front::{Incomplete, Triangulation, TriangulationCounts, Triangulator};
pub use rule::{LargestAngle, MinimumCircumradius};
pub use rules::Rules;
