//! Which rows of the input are worked on: copies of a place say nothing.

use crosscap_algorithms::certificate::{Certificate, Place, ViolationKind};
use crosscap_core::{Error, PointCloud, Row, Table};

/// A row of the input, copies counted. A [`Row`] is one of those that are worked on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct InputRow(usize);

impl InputRow {
    /// The row of this number.
    pub(super) fn new(index: usize) -> Self {
        Self(index)
    }

    /// The number of the row.
    pub(super) fn index(self) -> usize {
        self.0
    }

    /// The number as meshes have it, where a vertex may stand for no row.
    pub(super) fn signed(self) -> i64 {
        self.0 as i64
    }
}

/// The rows of the input that are worked on.
pub(super) struct Rows {
    /// Their points.
    pub(super) cloud: PointCloud<f64>,
    /// Where they are in the input.
    pub(super) kept: Table<Row, InputRow>,
    /// Rows of the input that coincide with an earlier one.
    pub(super) duplicates: usize,
}

impl Rows {
    /// The first row of every place; all rows with `copies`, for a metric that knows them as they are.
    ///
    /// # Errors
    /// [`Error::Shape`] for points of fewer than two coordinates, or too few of them.
    pub(super) fn of(cloud: &PointCloud<f64>, copies: bool) -> Result<Self, Error> {
        if cloud.dimension() < 2 {
            return Err(Error::Shape {
                found: format!("points of R^{}", cloud.dimension()),
                expected: "at least 2 coordinates".into(),
            });
        }
        let kept = distinct_rows(cloud);
        let duplicates = cloud.len() - kept.len();
        let (cloud, kept) = if duplicates == 0 || copies {
            (cloud.clone(), (0..cloud.len()).collect())
        } else {
            (cloud.select(&kept), kept)
        };
        if cloud.len() < LEAST_POINTS {
            return Err(Error::Shape {
                found: format!("{} different points", cloud.len()),
                expected: format!("at least {LEAST_POINTS}"),
            });
        }
        Ok(Self {
            cloud,
            kept: kept.into_iter().map(InputRow).collect(),
            duplicates,
        })
    }

    /// Positions among the kept rows of rows of the `whole` input, or of the rows that they are copies of.
    ///
    /// # Errors
    /// [`Error::Index`] for a row that is not there.
    pub(super) fn positions(
        &self,
        whole: &PointCloud<f64>,
        boundary: &[usize],
    ) -> Result<Vec<Row>, Error> {
        boundary_rows(boundary, &self.kept, whole)
    }

    /// Numbers in the input of some of the kept rows.
    pub(super) fn in_input(&self, rows: impl Iterator<Item = Row>) -> Vec<usize> {
        rows.map(|row| self.kept[row].index()).collect()
    }

    /// The certificate with rows of the input for the points that it has seen.
    pub(super) fn named(&self, mut certificate: Certificate) -> Certificate {
        let cover = certificate.cover.iter_mut();
        let violations = cover.flat_map(|report| &mut report.violations);
        // Landmarks that are unused were named by the row from the start.
        let seen = violations.filter(|v| v.kind != ViolationKind::UnusedLandmarks);
        for place in seen.flat_map(|violation| &mut violation.places) {
            if let Place::Point(row) = place {
                let named = self.kept.get(Row::new(*row));
                *row = named.map_or(*row, |named| named.index());
            }
        }
        certificate
    }
}

/// Fewest different points that are worked on.
pub(super) const LEAST_POINTS: usize = 8;

/// A number for the place of a row, equal for equal places.
fn fingerprint(row: &[f64]) -> u64 {
    let mut sum = 0u64;
    for x in row {
        // Negative and positive zero are equal.
        sum = (sum.rotate_left(5) ^ (x + 0.0).to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        sum ^= sum >> 29;
    }
    sum
}

/// The first row of every place, in order.
pub(crate) fn distinct_rows(cloud: &PointCloud<f64>) -> Vec<usize> {
    let mut marks: Vec<(u64, u32)> = cloud
        .iter()
        .zip(0..)
        .map(|(row, i)| (fingerprint(row), i))
        .collect();
    marks.sort_unstable();
    let mut copy = vec![false; cloud.len()];
    for like in marks.chunk_by(|a, b| a.0 == b.0) {
        // Rows of one fingerprint are nearly always copies, a few at most.
        for (at, &(_, row)) in like.iter().enumerate() {
            copy[row as usize] = like[..at].iter().any(|&(_, first)| {
                !copy[first as usize] && cloud.point(first as usize) == cloud.point(row as usize)
            });
        }
    }
    (0..cloud.len()).filter(|&row| !copy[row]).collect()
}

/// The cloud with one row for every place.
pub(crate) fn distinct_points(cloud: &PointCloud<f64>) -> PointCloud<f64> {
    let kept = distinct_rows(cloud);
    if kept.len() == cloud.len() {
        cloud.clone()
    } else {
        cloud.select(&kept)
    }
}

/// Positions of the boundary rows, or of the rows that they are copies of, among the kept ones.
fn boundary_rows(
    boundary: &[usize],
    kept: &Table<Row, InputRow>,
    cloud: &PointCloud<f64>,
) -> Result<Vec<Row>, Error> {
    let mut out = Vec::with_capacity(boundary.len());
    let mut by_place: Vec<Row> = if boundary.is_empty() {
        Vec::new()
    } else {
        kept.ids().collect()
    };
    by_place.sort_by(|&a, &b| order_of_places(cloud, kept[a], kept[b]));
    for &row in boundary {
        if row >= cloud.len() {
            return Err(Error::Index {
                what: "boundary row",
                index: row,
                limit: cloud.len(),
            });
        }
        let at = by_place.binary_search_by(|&k| order_of_places(cloud, kept[k], InputRow(row)));
        out.extend(at.ok().map(|at| by_place[at]));
    }
    out.sort_unstable();
    out.dedup();
    Ok(out)
}

/// Lexicographic order of the coordinates of two rows; negative and positive zero are equal.
fn order_of_places(cloud: &PointCloud<f64>, a: InputRow, b: InputRow) -> std::cmp::Ordering {
    let pairs = cloud.point(a.0).iter().zip(cloud.point(b.0));
    pairs
        .map(|(x, y)| (x + 0.0).total_cmp(&(y + 0.0)))
        .find(|o| o.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}
