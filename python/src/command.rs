//! The command line.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs a command line, the name of the program first, and returns its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| crosscap::command::run(arguments))
}
