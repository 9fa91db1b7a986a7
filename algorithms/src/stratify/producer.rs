//! What makes waists of one cloud.

use super::stratification::Stratification;
use crosscap_core::{Error, PointCloud, Row, Scalar};

/// Makes waists of one cloud at one resolution: the first, and others with more landmarks.
///
/// # Why it has this shape
/// Triangles show where landmarks are missing, so a waist is asked for more than once; what is the same
/// every time (strata, curves, the landmarks that were chosen) belongs into the producer, what depends on the landmarks
/// into [`waist`](Self::waist). Coordinates are not in a waist, but a mesh has them: the
/// producer says where the rows lie that its landmarks stand for.
///
/// # Laws
/// - *answer*: a waist that passes [`Stratification::check`];
/// - *extra*: a row of `extra` that [may be added](Self::may_add) is a landmark;
/// - *independence*: a waist does not depend on those that were made before.
pub trait WaistProducer<S: Scalar> {
    /// The waist, with the rows `extra` as landmarks whatever their separation, those that may not be added left out.
    ///
    /// # Errors
    /// Those of the producer.
    fn waist(&self, extra: &[Row]) -> Result<Stratification<S>, Error>;

    /// Whether a row may be a landmark beside those that were chosen. As it stands none may, and where triangles stray from
    /// the points they stay as they are.
    fn may_add(&self, _row: Row) -> bool {
        false
    }

    /// Places of all rows, where some of them were moved; `None` where every row is at its point.
    fn places(&self) -> Option<&PointCloud<f64>> {
        None
    }
}
