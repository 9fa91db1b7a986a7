//! From points to the narrow waist: which stratum every point is in, landmarks, chains, cells.

mod analysis;
mod cells;
mod chains;
mod net;
mod paper;
mod plain;
mod waist;

pub use analysis::{Analysis, AnalysisOptions, Analyzer, Dimensions, Role};
pub use paper::Published;
pub use waist::{
    ChartSpace, PointStratum, Stratification, StratifyCounts, StratifyOptions, stratify,
};
