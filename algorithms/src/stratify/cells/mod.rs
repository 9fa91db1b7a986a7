//! Cells: what a flood over the dense points reaches without crossing a curve, and which landmarks are
//! around each landmark in which cell.

mod contacts;
mod flood;
mod graph;
mod labels;
mod neighborhoods;
mod plain;
mod region;

pub(super) use contacts::Contacts;
pub(super) use labels::Labels;
pub(super) use neighborhoods::Neighborhoods;

/// No row, node, fit or landmark of that number.
const NONE: u32 = u32::MAX;
