//! What can be wrong, by kind.

use serde::Serialize;

/// What can be wrong with a cloud, or with what it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaultKind {
    /// The surface bends more than its points can follow.
    Curvature,
    /// Flat parts of the surface meet at an angle, or it bends within two spacings of its points.
    Edge,
    /// A curve ends before something that it may be joined to.
    OpenEnd,
    /// Points scatter across the surface.
    Noise,
    /// Points fill a space of more than two dimensions.
    Dimension,
    /// Sheets meet in a way that no model claims: a pinch point, more sheets than any model has.
    Unclaimed,
    /// Two sheets touch without crossing, or come nearer to each other than their points tell.
    Touching,
    /// Neighborhoods hold too few points.
    TooFewPoints,
    /// Points that no part of the surface is near.
    Outliers,
    /// The points can be read in two ways.
    TwoReadings,
    /// One attempt passed after others had failed, and no other one confirmed it.
    Unconfirmed,
    /// The surface ends where nothing was found that ends.
    Ends,
    /// The mesh covers places that the points leave empty, more than chance explains.
    Gap,
    /// Two sheets of points are one in the mesh.
    Merged,
    /// Coordinates are rounded to a step that is not small against the spacing of the points.
    Precision,
    /// Nothing is seen in the points themselves: the landmarks or the charts failed.
    Unresolved,
}

impl FaultKind {
    /// Whether it speaks of all points together, and not of a place.
    pub(super) fn is_of_the_whole(self) -> bool {
        matches!(
            self,
            Self::TwoReadings | Self::Unconfirmed | Self::Precision
        )
    }

    /// What it is, in a few words.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Curvature => "the surface bends more than its points can follow",
            Self::Edge => "the mesh fails at an edge, or where the surface bends as sharply",
            Self::OpenEnd => "a curve ends before something that it may be joined to",
            Self::Noise => "points scatter across the surface",
            Self::Dimension => "the points fill a space of more than two dimensions",
            Self::Unclaimed => "sheets meet in a way that no model claims",
            Self::Touching => "two sheets touch without crossing",
            Self::TooFewPoints => "too few points",
            Self::Outliers => "points that no part of the surface is near",
            Self::TwoReadings => "the points do not decide",
            Self::Unconfirmed => "what was found was not found again",
            Self::Ends => "the mesh ends where nothing was found that ends",
            Self::Gap => "the mesh covers gaps of the points",
            Self::Merged => "two sheets of points are one in the mesh",
            Self::Precision => {
                "coordinates are rounded to a step that is not small against the spacing"
            }
            Self::Unresolved => "landmarks or charts failed where the points look sound",
        }
    }
}
