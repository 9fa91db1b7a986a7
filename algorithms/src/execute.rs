//! Running independent jobs: the vocabulary is that of the core, where plug-ins find it too.

pub use crosscap_core::execute::{Execute, Serial};
pub(crate) use crosscap_core::execute::{few, map, map_blocks};
