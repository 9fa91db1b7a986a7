//! Sample surfaces with known truth.

mod jet;
mod motion;
mod random;
mod thin;

pub use jet::{Jet, area_element, first_fundamental_form};
pub use motion::{RigidMotion, embed, scaled};
pub use random::Random;
pub use thin::{thin, thin_randomly};
