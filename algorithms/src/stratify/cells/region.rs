//! Where floods run.

use crate::balls::BallTree;
use crate::execute::{self, Execute};
use crosscap_core::{PointCloud, Row, Scalar};

/// Where floods run: some of the points, and a margin about them.
pub(super) struct Region {
    /// Rows of the region and the margin, in order.
    pub(super) rows: Vec<Row>,
    /// Whether a row of `rows` is in the region.
    pub(super) inside: Vec<bool>,
    /// Every row this close to one of the region is in `rows`.
    pub(super) margin: f64,
}

impl Region {
    /// All points.
    pub(super) fn everything(count: usize, margin: f64) -> Self {
        Self {
            rows: (0..count).map(Row::new).collect(),
            inside: vec![true; count],
            margin,
        }
    }

    /// The points whose place is within a radius of those of some rows, `(row, radius)` for each. `cloud` has the
    /// places as they were, `places` those that were moved onto curves.
    ///
    /// O(log c) for each point of the cloud and c rows.
    pub(super) fn about<S: Scalar>(
        cloud: &PointCloud<S>,
        places: &PointCloud<f64>,
        centers: &[(Row, f64)],
        margin: f64,
        execute: &dyn Execute,
    ) -> Self {
        let width = cloud.dimension();
        let mut about = Vec::with_capacity(centers.len() * width);
        for &(row, _) in centers {
            about.extend_from_slice(places.point(row.index()));
        }
        let tree = BallTree::new(width, &about);
        let widest = centers.iter().map(|c| c.1).fold(0.0, f64::max) + margin;
        let squares: Vec<[f64; 2]> = (centers.iter())
            .map(|c| [c.1 * c.1, (c.1 + margin) * (c.1 + margin)])
            .collect();
        let count = cloud.len();
        let found = execute::map(execute, count, Vec::new, |place, row| {
            place.clear();
            place.extend(cloud.point(row).iter().map(|x| x.as_f64()));
            let mut near = false;
            let inside = tree.any_within(place, widest, |c, square| {
                let [inner, outer] = squares[c as usize];
                near |= square < outer;
                square < inner
            });
            (near, inside)
        });
        let rows: Vec<Row> = (0..count)
            .filter(|&row| found[row].0)
            .map(Row::new)
            .collect();
        Self {
            inside: rows.iter().map(|&row| found[row.index()].1).collect(),
            rows,
            margin,
        }
    }
}
