//! What is around a landmark in a cell.

use crate::{Error, Landmark};
use serde::{Deserialize, Serialize};

/// What lies around one landmark inside one cell.
///
/// A landmark on a 2-stratum has one; a landmark on a curve has one for each cell that meets there.
///
/// # Invariants
/// The center is the first of the members, which is so by construction, and is checked when a file is read. Further ones,
/// which it takes a whole waist to see, [`StratifiedLandmarks::new`](crate::StratifiedLandmarks::new) checks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct CellNeighborhood {
    center: Landmark,
    members: Vec<Landmark>,
}

impl CellNeighborhood {
    /// The neighborhood of a landmark with these others, by increasing distance: the landmarks of the cell near it, and
    /// those on the curves at the rim of the cell. The center may be among them, and comes first in any case.
    ///
    /// ```
    /// use crosscap_core::{CellNeighborhood, Landmark};
    /// let near = CellNeighborhood::new(Landmark::new(2), [2, 5, 0].map(Landmark::new));
    /// assert_eq!(near.members(), [2, 5, 0].map(Landmark::new));
    /// ```
    pub fn new(center: Landmark, others: impl IntoIterator<Item = Landmark>) -> Self {
        let others = others.into_iter().filter(|&other| other != center);
        Self {
            center,
            members: std::iter::once(center).chain(others).collect(),
        }
    }

    /// The landmark that it is about.
    pub fn center(&self) -> Landmark {
        self.center
    }

    /// The center, then the others by increasing distance.
    pub fn members(&self) -> &[Landmark] {
        &self.members
    }
}

/// A neighborhood as it is in a file, before anything is known about it.
#[derive(Deserialize)]
struct Unchecked {
    center: Landmark,
    members: Vec<Landmark>,
}

impl TryFrom<Unchecked> for CellNeighborhood {
    type Error = Error;

    fn try_from(file: Unchecked) -> Result<Self, Error> {
        let Unchecked { center, members } = file;
        if members.first() == Some(&center) {
            return Ok(Self { center, members });
        }
        let first = members.first().map(|m| m.index());
        Err(Error::Shape {
            found: format!("a neighborhood of {center} that starts with {first:?}"),
            expected: "the center first".into(),
        })
    }
}
