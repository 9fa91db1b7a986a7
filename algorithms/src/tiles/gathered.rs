//! Points that were taken out of tiles.

use super::row::CloudRow;
use crosscap_core::{Error, PointCloud};
use serde::{Deserialize, Serialize};

/// Some points of the cloud, each with its row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gathered {
    width: usize,
    rows: Vec<CloudRow>,
    coordinates: Vec<f64>,
}

impl Gathered {
    /// None yet, of R^`width`.
    pub fn new(width: usize) -> Self {
        Self {
            width,
            ..Self::default()
        }
    }

    /// None yet, with room for so many.
    pub(super) fn with_room(width: usize, points: usize) -> Self {
        Self {
            width,
            rows: Vec::with_capacity(points),
            coordinates: Vec::with_capacity(width * points),
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Rows of the cloud.
    pub fn rows(&self) -> &[CloudRow] {
        &self.rows
    }

    /// The place of the point at `index`.
    pub fn place(&self, index: usize) -> &[f64] {
        &self.coordinates[index * self.width..(index + 1) * self.width]
    }

    /// The points, each with its row.
    pub fn each(&self) -> impl Iterator<Item = (CloudRow, &[f64])> {
        (0..self.len()).map(|k| (self.rows[k], self.place(k)))
    }

    /// Takes a point.
    pub fn push(&mut self, row: CloudRow, place: &[f64]) {
        self.rows.push(row);
        self.coordinates.extend_from_slice(place);
    }

    /// Takes those of another.
    pub fn extend(&mut self, other: &Self) {
        self.rows.extend_from_slice(&other.rows);
        self.coordinates.extend_from_slice(&other.coordinates);
    }

    /// The points in the order of their rows, each once.
    pub fn sorted(&self) -> Self {
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_unstable_by_key(|&k| self.rows[k]);
        order.dedup_by_key(|k| self.rows[*k]);
        let mut out = Self::with_room(self.width, order.len());
        for k in order {
            out.push(self.rows[k], self.place(k));
        }
        out
    }

    /// Where a row is, if the points are in order. O(log n).
    pub fn find(&self, row: CloudRow) -> Option<usize> {
        self.rows.binary_search(&row).ok()
    }

    /// The points as a cloud.
    ///
    /// # Errors
    /// Those of [`PointCloud::new`].
    pub fn cloud(&self) -> Result<PointCloud<f64>, Error> {
        PointCloud::new(self.width, self.coordinates.clone())
    }

    /// The rows, and the points as a cloud that has their coordinates.
    ///
    /// # Errors
    /// Those of [`PointCloud::new`].
    pub(super) fn into_cloud(self) -> Result<(Vec<CloudRow>, PointCloud<f64>), Error> {
        Ok((self.rows, PointCloud::new(self.width, self.coordinates)?))
    }

    /// All coordinates, point after point.
    pub fn coordinates(&self) -> &[f64] {
        &self.coordinates
    }
}

/// What is told of a row that no tile has.
pub fn lost(row: CloudRow) -> Error {
    Error::Shape {
        found: format!("no tile with row {}", row.index()),
        expected: "every point of the cloud in the tile whose box holds it".into(),
    }
}
