//! Sample surfaces with known truth.

mod catalogue;
mod curves;
mod flat;
mod henneberg;
mod jet;
mod motion;
mod nearest;
mod piece;
mod projective;
mod random;
mod ring;
mod round;
mod sample;
mod strips;
mod thin;
mod truth;
mod two_holed_torus;

pub use catalogue::{SampleSurface, catalogue};
pub use flat::{Rectangle, Segment, SwissRoll};
pub use henneberg::Henneberg;
pub use jet::{Jet, area_element, first_fundamental_form};
pub use motion::{RigidMotion, embed, scaled};
pub use piece::{Drawn, Piece, RimSegment, SamplingLaw, place_at};
pub use projective::{BoySurface, ProjectivePlane, RomanSurface};
pub use random::Random;
pub use ring::{RingConformations, RingSample};
pub use round::{Cylinder, Ring, SphereCap, Torus};
pub use sample::{Sample, Sampling};
pub use strips::{KleinFigureEight, MoebiusStrip};
pub use thin::{thin, thin_randomly};
pub use truth::{CurveKind, PaperExample, PieceTruth, TrueCurve, Truth};
pub use two_holed_torus::TwoHoledTorus;

#[cfg(test)]
mod tests;
