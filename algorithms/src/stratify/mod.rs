//! From points to the narrow waist, stage by stage. Each stage is a value that is not changed after it is
//! made:
//!
//! | stage | value | says |
//! | --- | --- | --- |
//! | analysis | [`Analysis`] | where every point is, by models that compete for its neighborhood |
//! | strata | [`Strata`] | the same with gaps in curves filled, and places moved onto the curves |
//! | skeleton | (inside) | landmarks on points and curves, chains, fits that label what is around |
//! | landmarks | (inside) | landmarks in cells, chosen by a selector |
//! | cells | (inside) | what is around every landmark in each of its cells |
//! | waist | [`Stratification`] | all of that without coordinates, for the triangulator |
//!
//! [`Cut`] goes through the later stages; [`Published`] is another way to the same waist.

mod analysis;
mod atlas;
mod cells;
mod curve_ends;
mod distances;
mod landmarks;
mod published;
mod refine;
mod site;
mod skeleton;
mod strata;
mod tuning;
mod waist;

pub use analysis::{Analysis, AnalysisOptions, Analyzer, Dimensions, ModelCounts};
pub use published::{Published, PublishedCut};
pub use refine::Refinement;
pub use site::{FitUsed, On, Site, StratumKind};
pub use strata::Strata;
pub use tuning::{AnalysisTuning, CellTuning, EndTuning, RefinementTuning, SkeletonTuning, Tuning};
pub use waist::{
    ChartSpace, Cut, PointStratum, Stratification, StratifyCounts, StratifyOptions, WaistProducer,
};
