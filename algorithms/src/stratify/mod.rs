//! From points to the narrow waist: which stratum every point is in, landmarks, chains, cells.

mod analysis;
mod cells;
mod chains;
mod waist;

pub use analysis::{Analysis, AnalysisOptions, Analyzer, Dimensions, Role};
pub use waist::{Stratification, StratifyCounts, StratifyOptions, stratify};
