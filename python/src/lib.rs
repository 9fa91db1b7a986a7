//! The extension module `crosscap._crosscap`: what the Python package `crosscap` is built on.
//!
//! Arrays and settings come in, arrays and JSON go out; classes, defaults and documentation are in
//! `package/crosscap`. Points are copied once, by the pass that checks that they are finite: the
//! interpreter goes on while a run works, and could change an array that is only borrowed.

mod arrays;
mod command;
mod compare;
mod laws;
mod mesh;
mod model;
mod plugins;
mod points;
mod reconstruct;
mod refusal;
mod run;
mod tiles;

use pyo3::prelude::*;

/// The extension module.
#[pymodule]
fn _crosscap(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(command::main, module)?)?;
    module.add_function(wrap_pyfunction!(compare::compare, module)?)?;
    module.add_function(wrap_pyfunction!(laws::laws_of_estimator, module)?)?;
    module.add_function(wrap_pyfunction!(laws::laws_of_metric, module)?)?;
    module.add_function(wrap_pyfunction!(laws::laws_of_model, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::check, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::curves, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::homology, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::isomap, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::page, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::read_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::write_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(points::dimension, module)?)?;
    module.add_function(wrap_pyfunction!(points::read_points, module)?)?;
    module.add_function(wrap_pyfunction!(points::sample, module)?)?;
    module.add_function(wrap_pyfunction!(points::surfaces, module)?)?;
    module.add_function(wrap_pyfunction!(reconstruct::reconstruct, module)?)?;
    module.add_function(wrap_pyfunction!(
        reconstruct::reconstruct_distances,
        module
    )?)?;
    module.add_function(wrap_pyfunction!(tiles::random_ranks, module)?)?;
    module.add_function(wrap_pyfunction!(tiles::reconstruct_tiles, module)?)?;
    module.add_function(wrap_pyfunction!(tiles::tile_answer, module)?)?;
    module.add_function(wrap_pyfunction!(tiles::tile_dimension, module)?)?;
    module.add_function(wrap_pyfunction!(tiles::tile_halo, module)?)?;
    module.add_function(wrap_pyfunction!(tiles::tile_members, module)?)?;
    module.add_function(wrap_pyfunction!(tiles::tiling, module)?)?;
    Ok(())
}
