//! Dimension estimators by name.

use clap::ValueEnum;
use crosscap_algorithms::dimension::{
    CorrelationDimension, GlobalEstimator, MaximumLikelihood, PackingNumbers, PrincipalComponents,
    SpanningTree,
};
use crosscap_core::{DimensionEstimator, Error};

/// Which estimator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum EstimatorName {
    /// Principal components with tolerance dt
    #[default]
    Pca,
    /// Maximum likelihood (Levina and Bickel; inverses averaged as MacKay and Ghahramani do)
    Mle,
    /// Correlation dimension (Grassberger and Procaccia)
    Correlation,
    /// Packing numbers (Kegl)
    Packing,
    /// Geodesic minimum spanning trees (Costa and Hero)
    SpanningTree,
}

impl EstimatorName {
    /// As it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pca => "pca",
            Self::Mle => "mle",
            Self::Correlation => "correlation",
            Self::Packing => "packing",
            Self::SpanningTree => "spanning-tree",
        }
    }

    /// The one of this name.
    ///
    /// # Errors
    /// [`Error::Parameter`] where there is none, with the names that there are.
    pub fn named(name: &str) -> Result<Self, Error> {
        let all = Self::value_variants();
        let known = all.iter().find(|kind| kind.name() == name).copied();
        known.ok_or_else(|| {
            let names: Vec<&str> = all.iter().map(|kind| kind.name()).collect();
            Error::Parameter {
                name: "estimator",
                value: name.into(),
                expected: format!("one of {}", names.join(", ")),
            }
        })
    }

    /// The estimator of neighborhoods.
    pub fn local(self, dt: f64) -> Result<Box<dyn DimensionEstimator<Scalar = f64>>, Error> {
        Ok(match self {
            Self::Pca => Box::new(PrincipalComponents::new(dt)?),
            Self::Mle => Box::new(MaximumLikelihood::new()),
            Self::Correlation => Box::new(CorrelationDimension::new()),
            Self::Packing => Box::new(PackingNumbers::new()),
            Self::SpanningTree => Box::new(SpanningTree::new()),
        })
    }

    /// The estimator of whole clouds.
    pub fn global(self, dt: f64) -> Result<Box<dyn GlobalEstimator<f64>>, Error> {
        Ok(match self {
            Self::Pca => Box::new(PrincipalComponents::new(dt)?),
            Self::Mle => Box::new(MaximumLikelihood::new()),
            Self::Correlation => Box::new(CorrelationDimension::new()),
            Self::Packing => Box::new(PackingNumbers::new()),
            Self::SpanningTree => Box::new(SpanningTree::new()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_are_typed_and_those_of_the_estimators() {
        for &kind in EstimatorName::value_variants() {
            let typed = kind.to_possible_value().unwrap();
            assert_eq!(typed.get_name(), kind.name());
            assert_eq!(kind.local(0.05).unwrap().name(), kind.name());
        }
    }
}
