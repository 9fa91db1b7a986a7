//! Singularity models by name.

use super::{
    BareCurve, Book, BookEnd, Boundary, BoundaryCorner, ConePoint, CurveOnSheet, CurveThroughSheet,
    IsolatedCrossing, PinchPoint, TriplePoint, TwoPlanes, YJunction,
};
use crate::tuning::ModelTuning;
use crosscap_core::{Error, SingularityModel};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The models that come with the program.
///
/// ```
/// use crosscap_algorithms::singularity::ModelName;
/// let model = "triple-point".parse::<ModelName>()?.model(0.05, 0.02)?;
/// assert_eq!(model.name(), "triple-point");
/// # Ok::<(), crosscap_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelName {
    /// [`TwoPlanes`].
    TwoPlanes,
    /// [`TwoPlanes`] with the pair of planes refined by the paper's equation (5).
    RefinedTwoPlanes,
    /// [`Boundary`].
    Boundary,
    /// [`YJunction`].
    YJunction,
    /// [`TriplePoint`].
    TriplePoint,
    /// [`IsolatedCrossing`].
    IsolatedCrossing,
    /// [`BareCurve`].
    Curve,
    /// [`CurveThroughSheet`].
    CurveThroughSheet,
    /// [`CurveOnSheet`].
    CurveOnSheet,
    /// [`PinchPoint`].
    PinchPoint,
    /// [`Book`].
    Book,
    /// [`BookEnd`].
    BookEnd,
    /// [`ConePoint`].
    ConePoint,
    /// [`BoundaryCorner`].
    BoundaryCorner,
}

/// Rounds of the refinement by equation (5).
const REFINEMENT_ROUNDS: usize = 20;

impl ModelName {
    /// All of them.
    pub const ALL: [Self; 14] = [
        Self::TwoPlanes,
        Self::RefinedTwoPlanes,
        Self::Boundary,
        Self::YJunction,
        Self::TriplePoint,
        Self::IsolatedCrossing,
        Self::Curve,
        Self::CurveThroughSheet,
        Self::CurveOnSheet,
        Self::PinchPoint,
        Self::Book,
        Self::BookEnd,
        Self::ConePoint,
        Self::BoundaryCorner,
    ];

    /// Those that compete where the user leaves the choice to the program.
    pub const AUTO: [Self; 13] = [
        Self::TwoPlanes,
        Self::Boundary,
        Self::YJunction,
        Self::TriplePoint,
        Self::IsolatedCrossing,
        Self::Curve,
        Self::CurveThroughSheet,
        Self::CurveOnSheet,
        Self::PinchPoint,
        Self::Book,
        Self::BookEnd,
        Self::ConePoint,
        Self::BoundaryCorner,
    ];

    /// The name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::TwoPlanes => "two-planes",
            Self::RefinedTwoPlanes => "refined-two-planes",
            Self::Boundary => "boundary",
            Self::YJunction => "y-junction",
            Self::TriplePoint => "triple-point",
            Self::IsolatedCrossing => "isolated-crossing",
            Self::Curve => "curve",
            Self::CurveThroughSheet => "curve-through-sheet",
            Self::CurveOnSheet => "curve-on-sheet",
            Self::PinchPoint => "pinch-point",
            Self::Book => "book",
            Self::BookEnd => "book-end",
            Self::ConePoint => "cone-point",
            Self::BoundaryCorner => "boundary-corner",
        }
    }

    /// The model with fit tolerance `dp` and curve tolerance `ep`, unit of the data.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn model(self, dp: f64, ep: f64) -> Result<Box<dyn SingularityModel>, Error> {
        self.tuned(dp, ep, &ModelTuning::MEASURED)
    }

    /// The same, believed under other conditions.
    ///
    /// # Errors
    /// Those of [`ModelName::model`].
    pub fn tuned(
        self,
        dp: f64,
        ep: f64,
        tuning: &ModelTuning,
    ) -> Result<Box<dyn SingularityModel>, Error> {
        Ok(match self {
            Self::TwoPlanes => Box::new(TwoPlanes::new(dp, ep)?.tuned(tuning.two_planes)),
            Self::RefinedTwoPlanes => {
                let mut model = TwoPlanes::new(dp, ep)?.tuned(tuning.two_planes);
                model.refinement_rounds = REFINEMENT_ROUNDS;
                Box::new(model)
            }
            Self::Boundary => Box::new(Boundary::new(dp, ep)?.tuned(tuning.boundary)),
            Self::YJunction => Box::new(YJunction::new(dp, ep)?.tuned(tuning.y_junction)),
            Self::TriplePoint => Box::new(TriplePoint::new(dp, ep)?.tuned(tuning.triple_point)),
            Self::IsolatedCrossing => {
                Box::new(IsolatedCrossing::new(dp, ep)?.tuned(tuning.isolated_crossing))
            }
            Self::Curve => Box::new(BareCurve::new(dp, ep)?),
            Self::CurveThroughSheet => {
                Box::new(CurveThroughSheet::new(dp, ep)?.tuned(tuning.curve_and_sheet))
            }
            Self::CurveOnSheet => {
                Box::new(CurveOnSheet::new(dp, ep)?.tuned(tuning.curve_and_sheet))
            }
            Self::PinchPoint => Box::new(PinchPoint::new(dp, ep)?.tuned(tuning.pinch_point)),
            Self::Book => Box::new(Book::new(dp, ep)?.tuned(tuning.book)),
            Self::BookEnd => Box::new(BookEnd::new(dp, ep)?.tuned(tuning.book_end)),
            Self::ConePoint => Box::new(ConePoint::new(dp, ep)?.tuned(tuning.cone_point)),
            Self::BoundaryCorner => {
                Box::new(BoundaryCorner::new(dp, ep)?.tuned(tuning.boundary_corner))
            }
        })
    }
}

impl fmt::Display for ModelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for ModelName {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|m| m.name() == name)
            .ok_or_else(|| Error::Parameter {
                name: "models",
                value: name.into(),
                expected: format!("one of {}", Self::ALL.map(Self::name).join(", ")),
            })
    }
}
