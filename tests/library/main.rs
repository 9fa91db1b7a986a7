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

use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::triangulate::{AdvancingFront, LargestAngle, Rules};
use crosscap_algorithms::tuning::FrontTuning;

/// The triangulator with the parts of the pipeline.
const FRONT: AdvancingFront<'static> = AdvancingFront {
    chart: &ClassicalScaling,
    test: &PlanarPredicate,
    rule: &LargestAngle,
    largest_circumradius: f64::INFINITY,
    repair: true,
    rules: Rules::MEASURED,
    tuning: &FrontTuning::MEASURED,
};
