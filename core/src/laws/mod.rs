//! The law kit: what any implementation of a trait can be put through.
//!
//! The traits of this crate state laws that the pipeline relies on. The kit turns each law into a
//! property that is tested on drawn inputs. In a test of your crate one line writes a test for each law of a trait:
//!
//! ```
//! # use crosscap_core::laws::StraightLine as MyMetric;
//! crosscap_core::law_tests! {
//!     mod my_metric = metric(|cloud| MyMetric(cloud.clone()));
//! }
//! ```
//!
//! and the functions below put a plug-in through all of them at once:
//!
//! ```
//! # use crosscap_core::laws::StraightLine as MyMetric;
//! use crosscap_core::laws::{self, Settings};
//! laws::metric(&Settings::default(), |cloud| MyMetric(cloud.clone())).unwrap();
//! ```
//!
//! ```toml
//! [dev-dependencies]
//! crosscap-core = { version = "0.1", features = ["laws"] }
//! ```
//!
//! | trait | put through its laws by | what you give |
//! | --- | --- | --- |
//! | [`MetricSpace`](crate::MetricSpace) | [`metric()`] | how to build it over a cloud |
//! | [`NeighborhoodOracle`](crate::NeighborhoodOracle) | [`oracle()`] | how to build it, and the metric that it serves |
//! | [`DimensionEstimator`](crate::DimensionEstimator) | [`estimator()`] | the estimator |
//! | [`SingularityModel`](crate::SingularityModel) | [`model()`] | the model, and a sampler of exact [`Instances`] |
//! | [`LocalChart`](crate::LocalChart) | [`chart()`] | the chart |
//! | [`LandmarkSelector`](crate::LandmarkSelector) | [`selector()`] | the selector |
//! | [`CompatibilityTest`](crate::CompatibilityTest) | [`compatibility()`] | the test |
//! | [`TriangleRule`](crate::TriangleRule) | [`rule()`] | the rule |
//! | [`Triangulator`](crate::Triangulator) | [`triangulator()`] | the triangulator |
//! | whole reconstructions, quantities of complexes | [`reconstruction()`], [`topology()`], [`relabelling()`] | a function |
//! | Betti numbers | [`euler_poincare()`] | a complex and its Betti numbers |
//!
//! # What a failure says
//! [`LawBroken`] names the law, shows the smallest input that was found to break it, what came out,
//! and what usually is wrong in such a case. Laws are tried one after the other, the more basic
//! first, and [`Failures`] holds all that do not hold: the first often explains the others. Inputs are the same at
//! every run: a failure stays until it is mended. [`Settings`] says how many there are, picks one law, and marks
//! those that are known not to hold.
//!
//! A law that holds on all inputs that were drawn is not proven. And the kit does not judge what it
//! cannot know: whether a dimension is the right one, whether a distance is a useful one.
//!
//! # What is behind it
//! Inputs come from [proptest](https://docs.rs/proptest), which also makes them smaller; [`inputs`]
//! has the strategies, for tests of your own. [`all`] lists the laws. For each of them the tests of
//! this module hold an implementation that breaks that law and none before it.

mod chart;
mod compatibility;
mod dimension;
pub mod inputs;
pub mod instances;
mod landmarks;
mod law;
mod listing;
mod metric;
mod motion;
mod neighborhood;
mod reference;
mod result;
mod rule;
mod settings;
mod singularity;
mod trial;
mod triangulation;
#[cfg(test)]
mod twins;

pub use chart::chart;
pub use compatibility::{compatibility, reference_meeting};
pub use dimension::estimator;
pub use instances::{Draw, Instance};
pub use landmarks::selector;
pub use law::{Failure, Failures, Findings, Law, LawBroken};
pub use metric::metric;
pub use motion::{MOST_DIMENSIONS, Motion, motions};
pub use neighborhood::oracle;
pub use reference::{Scan, StraightLine};
pub use result::{euler_poincare, reconstruction, relabelling, topology};
pub use rule::rule;
pub use settings::Settings;
pub use singularity::{Instances, model};
pub use triangulation::triangulator;

/// All laws of the kit, by trait.
///
/// ```
/// let laws = crosscap_core::laws::all();
/// assert!(laws.iter().any(|l| l.subject == "MetricSpace" && l.name == "symmetry"));
/// ```
pub fn all() -> Vec<&'static Law> {
    let traits: [&[&'static Law]; 10] = [
        &metric::ALL,
        &neighborhood::ALL,
        &dimension::ALL,
        &singularity::ALL,
        &chart::ALL,
        &landmarks::ALL,
        &compatibility::ALL,
        &rule::ALL,
        &triangulation::ALL,
        &result::ALL,
    ];
    traits.concat()
}
