//! Dimension estimators.

mod pca;
pub use pca::PrincipalComponents;
