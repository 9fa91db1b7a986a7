//! What is around a landmark in a cell.

use crate::Landmark;
use serde::{Deserialize, Serialize};

/// What lies around one landmark inside one cell.
///
/// A landmark on a 2-stratum has one; a landmark on a curve has one for each cell that meets there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellNeighborhood {
    /// The landmark.
    pub center: Landmark,
    /// The landmarks of the cell near it, and those on the curves at the rim of the cell;
    /// the center is the first, then by increasing distance.
    pub members: Vec<Landmark>,
}
