//! The library, used as a program uses it.
//!
//! One program, as each would compile the pipeline anew for what it asks: `cargo test --test library tiles::` runs a part of it.

mod broken_plugins;
mod catalogue_pieces;
mod creases;
mod cyclo_octane;
mod dimension;
mod distances;
mod invariants;
mod laws;
mod model_numbers;
mod models;
mod paper_method;
mod plugins_of_the_guide;
mod spaces;
mod surfaces;
mod tiles;
mod without_parameters;
