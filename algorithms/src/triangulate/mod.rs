//! From the waist to the complex: an advancing front of stars.
//!
//! Four numberings meet here: landmarks, the neighborhoods whose stars are closed, triangles, and positions in a chart. The
//! first three are types; a position is a plain index of the arrays of one chart.

mod front;
mod parts;
mod repair;
mod rule;
mod rules;
mod run;
mod star;

crosscap_core::id! {
    /// A neighborhood of the waist, as the star that is closed in it.
    struct Star(u32);
}

crosscap_core::id! {
    /// A triangle of the growing complex.
    struct Triangle(u32);
}

pub use parts::AdvancingFront;
pub use rule::{LargestAngle, MinimumCircumradius};
pub use rules::Rules;
