//! Facade of Crosscap.

pub mod pipeline;
