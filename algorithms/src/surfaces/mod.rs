//! Sample surfaces with known truth.
//!
//! A test of a reconstruction is worth what is known about its input. Here every surface comes with its
//! topology ([`Truth`]), its pieces, the distance of any place to it, its double curves and its boundary, and
//! for the paper's nine with the paper's parameters and results ([`PaperExample`]).
//!
//! | idea | item |
//! | --- | --- |
//! | the catalogue, and one surface of it | [`catalogue`], [`SampleSurface`] |
//! | how to draw, and what was drawn | [`Sampling`], [`Sample`] |
//! | a parametrized piece; bring your own | [`Piece`] |
//! | a formula with its derivatives | [`Jet`] |
//! | minimal spacing | [`thin`](fn@thin), [`thin_randomly`] |
//! | rigid motion, scaling, isometric embedding | [`RigidMotion`], [`scaled`], [`embed`] |
//! | surfaces around one feature of variable size | [`Feature`], [`FeatureCloud`] |
//! | conformations of cyclo-octane | [`RingConformations`] |
//!
//! Points are uniform by area unless asked otherwise: a piece proposes parameters and accepts them in
//! proportion to its area element, below a bound derived by hand (for Boy's surface and the
//! two-holed torus: measured on a grid, with a margin, and tested). Random numbers are ChaCha8 and elementary functions
//! those of `libm`, so a seed gives the same cloud on every platform (conformations: on one).

mod books;
mod catalogue;
mod cayley;
mod curves;
mod faceted;
mod features;
mod flat;
mod foam;
mod further;
mod henneberg;
mod higher;
mod jet;
mod minimal;
mod motion;
mod nearest;
mod paper;
mod piece;
mod pierced;
mod pinched;
mod plates;
mod projective;
mod random;
mod ring;
mod round;
mod ruled;
mod sample;
mod sampling;
mod singular;
mod strips;
mod surface;
mod thin;
mod truth;
mod two_holed_torus;

pub use catalogue::catalogue;
pub use faceted::Triangle;
pub use features::{Drawing, Feature, FeatureCloud, Spot};
pub use flat::{HalfDisc, Polygon, Rectangle, Segment, SwissRoll};
pub use henneberg::Henneberg;
pub use jet::{Jet, area_element, first_fundamental_form};
pub use motion::{RigidMotion, embed, scaled};
pub use piece::{Drawn, Piece, RimSegment, SamplingLaw, place_at};
pub use pinched::{CrossCap, Umbrella};
pub use projective::{BoySurface, ProjectivePlane, RomanSurface};
pub use random::Random;
pub use ring::{RingConformations, RingError, RingGeometry, RingProjection, RingSample};
pub use round::{Ring, SphereCap, Torus};
pub use ruled::{Cone, Cylinder};
pub use sample::Sample;
pub use sampling::Sampling;
pub use strips::{KleinFigureEight, MoebiusStrip};
pub use surface::SampleSurface;
pub use thin::{thin, thin_randomly};
pub use truth::{CurveKind, PaperExample, PieceTruth, PointKind, TrueCurve, TruePoint, Truth};
pub use two_holed_torus::TwoHoledTorus;

#[cfg(test)]
mod tests;
