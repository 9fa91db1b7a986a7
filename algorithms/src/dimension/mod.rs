//! Dimension estimators, of neighborhoods and of whole clouds.
//!
//! | estimator | source | reads | needs coordinates |
//! | --- | --- | --- | --- |
//! | [`PrincipalComponents`] | Martin & Watson 2011 | variances along axes | yes |
//! | [`MaximumLikelihood`] | Levina & Bickel 2005, MacKay & Ghahramani 2005 | distances from the center | no |
//! | [`CorrelationDimension`] | Grassberger & Procaccia 1983 | how the number of close pairs grows | no |
//! | [`PackingNumbers`] | Kegl 2003 | how many balls fit beside each other | no |
//! | [`SpanningTree`] | Costa & Hero 2004 | how the length of a spanning tree grows | no |
//!
//! Each is a [`DimensionEstimator`](crosscap_core::DimensionEstimator) of a neighborhood and a
//! [`GlobalEstimator`] of a [`WholeCloud`].
//!
//! # Confidence
//! All but principal components answer with a number that is rounded, and know the standard error of
//! it. Their confidence is the probability that a normal error of that size stays smaller than the
//! distance of the value from the nearest half: 0 for a toss-up between two dimensions, 1 for a value
//! many standard errors away from one. It tells about chance, not about bias: curvature, noise and
//! edges move all values alike, and no confidence shows it. For principal components see
//! [`PrincipalComponents::dimension_of`].
//!
//! # Crossings
//! Where two surfaces cross, the points are still those of a 2-dimensional set: on the crossing the number of
//! points, balls or branches grows as on one surface, and every estimator but principal components says 2.
//! (Beside it the second sheet is seen from some distance on only, and values are between 2 and 3.)
//! In the pipeline they serve for surfaces that do not cross; crossings are found by principal
//! components, which see the three axes that two planes need.

mod correlation;
mod decision;
mod geodesic_tree;
mod global;
mod jackknife;
mod likelihood;
mod ordered;
mod packing;
mod pairs;
mod pca;
mod spanning_tree;

pub use correlation::CorrelationDimension;
pub use global::{GlobalDimension, GlobalEstimator, Scale, WholeCloud};
pub use likelihood::MaximumLikelihood;
pub use packing::PackingNumbers;
pub use pca::PrincipalComponents;
pub use spanning_tree::SpanningTree;
