//! Sample surfaces with known truth.
