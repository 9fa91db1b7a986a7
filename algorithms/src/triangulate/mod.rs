//! From the waist to the complex: an advancing front of stars.

mod front;
mod parts;
mod repair;
mod rule;
mod rules;
mod run;
mod star;
pub use parts::AdvancingFront;
pub use rule::{LargestAngle, MinimumCircumradius};
pub use rules::Rules;
