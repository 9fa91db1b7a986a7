//! How the pieces meet: double curves, junctions, points.

mod angle;
mod bare;
mod contacts;
mod crossings;
mod junctions;
mod trail;

pub(super) use bare::bare_curves;
pub(super) use contacts::point_contacts;
pub(super) use crossings::double_curves;
pub(super) use junctions::junctions;
