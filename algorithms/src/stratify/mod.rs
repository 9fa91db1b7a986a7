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
//! [`Cells`] goes through all of them, [`PublishedMethod`] is another way to the same waist, and whoever has a third
//! implements [`Stratifier`].

mod analysis;
mod atlas;
mod cells;
mod charts;
mod curve_ends;
mod distances;
mod in_part;
mod landmarks;
mod producer;
mod published;
mod refine;
mod site;
mod skeleton;
mod strata;
mod stratification;
mod stratifier;
mod waist;

pub use crate::tuning::{
    AnalysisTuning, CellTuning, EndTuning, RefinementTuning, SkeletonTuning, Tuning,
};
pub(crate) use analysis::Looks;
pub use analysis::{Analysis, AnalysisOptions, Analyzer, KnownBalls, ModelCounts, Seen};
pub use charts::ChartSpace;
pub use producer::WaistProducer;
pub use published::{Published, PublishedCut, PublishedMethod};
pub use refine::{Refinement, has_company};
pub use site::{FitUsed, On, Site, StratumKind};
pub use strata::Strata;
pub use stratification::{PointStratum, Stratification, StratifyCounts};
pub use stratifier::{Cells, Ground, Stratifier};
pub use waist::{Cut, StratifyOptions};
