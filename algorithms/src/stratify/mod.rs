//! From points to the narrow waist: which stratum every point is in, landmarks, chains, cells.

mod analysis;
mod cells;
mod chains;
mod paper;
mod waist;

pub use analysis::{Analysis, AnalysisOptions, Analyzer, Dimensions, Role};
pub use paper::Published;
pub use waist::{ChartSpace, Stratification, StratifyCounts, StratifyOptions, stratify};
