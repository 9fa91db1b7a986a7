//! Cells: what a flood over the dense points reaches without crossing a curve, and which landmarks are
//! around each landmark in which cell.

mod contacts;
mod flood;
mod found;
mod graph;
mod labels;
mod neighborhoods;
mod plain;
mod region;

pub(super) use contacts::Contacts;
pub(super) use found::Found;
pub(super) use labels::Labels;
pub(super) use neighborhoods::Neighborhoods;

crosscap_core::id! {
    /// A node of the graph: a regular point of the region where floods run.
    struct Node(u32);
}

impl Node {
    /// No node: of a row outside of the region, of a link that is not there. Links are looked up millions of times,
    /// and a node beside a flag would be twice as large.
    const NONE: Self = Self(u32::MAX);
}

crosscap_core::id! {
    /// One cell at one curve landmark.
    struct Rim(u32);
}

crosscap_core::id! {
    /// A fit among those that label rows.
    struct Labelling(u32);
}
