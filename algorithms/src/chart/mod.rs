//! Local charts.

mod mds;
pub use mds::ClassicalScaling;
