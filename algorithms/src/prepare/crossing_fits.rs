//! Pairs of crossing sheets, for points about the places where they were laid as well.

use super::crossing_sheets::CrossingSheets;
use crate::balls::BallTree;
use crosscap_core::PointCloud;

/// The pairs of sheets that were laid about points of a cloud.
///
/// Where the second sheet only grazes a neighborhood, no pair can be laid through it: too few of its points are on that sheet. A
/// pair that was laid nearby, where both sheets have their share, says what is there.
pub(super) struct CrossingFits {
    fits: Vec<CrossingSheets>,
    /// The points that they were laid about.
    tree: BallTree,
}

impl CrossingFits {
    /// The pairs of the rows that have one.
    pub(super) fn of(
        cloud: &PointCloud<f64>,
        found: impl IntoIterator<Item = (usize, CrossingSheets)>,
    ) -> Self {
        let mut places = Vec::new();
        let mut fits = Vec::new();
        for (row, sheets) in found {
            places.extend_from_slice(cloud.point(row));
            fits.push(sheets);
        }
        let tree = BallTree::new(cloud.dimension(), &places);
        Self { fits, tree }
    }

    /// A point moved onto the nearer sheet of the pair that was laid nearest to it, where that is no farther than `reach`
    /// radii of that pair's neighborhood.
    pub(super) fn projected(&self, x: &[f64], reach: f64) -> Option<Vec<f64>> {
        if self.fits.is_empty() {
            return None;
        }
        let (fit, square) = self.tree.nearest(x, |_| true)?;
        let fit = &self.fits[fit as usize];
        (square.sqrt() <= reach * fit.radius()).then(|| fit.projected(x))
    }
}
