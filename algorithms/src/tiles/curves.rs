//! What the curves of a cloud in tiles are, told from an excerpt.

use super::excerpt::Excerpt;
use super::gathered::Gathered;
use super::row::CloudRow;
use crate::balls::BallTree;
use crate::stratify::{Cut, ModelCounts, PointStratum, StratifyOptions};
use crate::tuning::CellTuning;
use crosscap_core::{CellNeighborhood, CurveEdge, Error, Landmark, Row, Table};

/// The curves of a cloud, laid in an excerpt of it, and what is about them.
pub struct Curves<'c> {
    excerpt: &'c Excerpt,
    cut: &'c Cut<'c, 'c, f64>,
    /// Places that a chart without curves does not reach.
    marked: BallTree,
    /// Radius of charts that are not widened.
    radius: f64,
    /// How much farther than a chart a curve is looked for.
    gap: f64,
    dl: f64,
}

/// Neighborhoods of landmarks near curves.
#[derive(Clone, Debug, Default)]
pub struct NearCurves {
    /// Those of landmarks in cells.
    pub in_cells: Vec<CellNeighborhood>,
    /// Those of landmarks on curves, one a cell.
    pub at_curves: Vec<CellNeighborhood>,
    /// Edges of the graph that were cut.
    pub cut_edges: usize,
}

impl<'c> Curves<'c> {
    /// The curves of a `cut` of an excerpt, made with these options.
    pub fn new(
        excerpt: &'c Excerpt,
        cut: &'c Cut<'c, 'c, f64>,
        options: &StratifyOptions,
        tuning: &CellTuning,
    ) -> Self {
        let StratifyOptions { dl, tri_eps, .. } = *options;
        let mut places: Vec<f64> = Vec::new();
        for row in cut.marked() {
            places.extend_from_slice(excerpt.cloud().point(row.index()));
            if cut.place(row) != excerpt.cloud().point(row.index()) {
                places.extend_from_slice(cut.place(row));
            }
        }
        Self {
            marked: BallTree::new(excerpt.cloud().dimension(), &places),
            radius: tri_eps,
            gap: tuning.curve_gap * dl,
            excerpt,
            cut,
            dl,
        }
    }

    fn gathered(&self, rows: impl Iterator<Item = Row>, moved: bool) -> Gathered {
        let mut all = Gathered::new(self.excerpt.cloud().dimension());
        for row in rows {
            let place = match moved {
                true => self.cut.place(row),
                false => self.excerpt.cloud().point(row.index()),
            };
            all.push(self.excerpt.in_cloud(row), place);
        }
        all
    }

    /// The landmarks on points and curves, points first, where they were moved to.
    pub fn landmarks(&self) -> Gathered {
        self.gathered(self.cut.on_curves().iter().copied(), true)
    }

    /// The chains between them.
    pub fn chains(&self) -> &[CurveEdge] {
        self.cut.chains()
    }

    /// Dimensions of the strata of so many landmarks, those on points and curves first.
    pub fn dimensions(&self, landmarks: usize) -> Table<Landmark, u8> {
        self.cut.dimensions(landmarks)
    }

    /// The landmarks in cells that are next to ends of curves.
    pub fn innermost(&self) -> Gathered {
        self.gathered(self.cut.innermost().into_iter(), false)
    }

    /// The points that others keep their separation from: those that landmarks on points and curves stand for, and those next to ends of
    /// curves.
    pub fn taken(&self) -> Gathered {
        let mut all = self.gathered(self.cut.on_curves().iter().copied(), false);
        all.extend(&self.innermost());
        all
    }

    /// Rows that cannot be chosen as landmarks, in order.
    pub fn barred(&self) -> Vec<CloudRow> {
        let rows = self.cut.barred().into_iter();
        rows.map(|row| self.excerpt.in_cloud(row)).collect()
    }

    /// What became of the models that were asked about the ends of curves.
    pub fn models(&self) -> &[ModelCounts] {
        self.cut.models()
    }

    /// The points that models call 0-strata.
    pub fn points(&self) -> Vec<PointStratum> {
        self.cut.points()
    }

    /// Whether a row of the cloud is on no curve.
    pub fn is_regular(&self, row: CloudRow) -> bool {
        self.excerpt
            .find(row)
            .is_none_or(|row| self.cut.is_regular(row))
    }

    /// Where a row of the cloud was moved to, if it was looked at.
    pub fn place(&self, row: CloudRow) -> Option<&[f64]> {
        Some(self.cut.place(self.excerpt.find(row)?))
    }

    /// Whether curves come near a chart of this radius about a landmark, or of the usual one, so that its neighborhoods are [cut](Self::neighborhoods) here
    /// and not in its tile.
    pub fn are_near(&self, landmark: &[f64], radius: Option<f64>) -> bool {
        let reach = radius.unwrap_or(self.radius) + self.gap;
        (self.marked).any_within(landmark, reach * (1.0 + 1e-9), |_, _| true)
    }

    /// The neighborhoods of landmarks that curves are near. Of all `landmarks`, those on points and curves first, `near` says which these are.
    ///
    /// # Errors
    /// Those of the graph that cells are cut in.
    pub fn neighborhoods(
        &self,
        landmarks: &[CloudRow],
        near: &Table<Landmark, bool>,
    ) -> Result<NearCurves, Error> {
        let mut known: Vec<Landmark> = Vec::new();
        let mut rows: Table<Landmark, Row> = Table::default();
        let mut wanted: Table<Landmark, bool> = Table::default();
        for (k, &row) in landmarks.iter().enumerate() {
            let k = Landmark::new(k);
            let Some(row) = self.excerpt.find(row) else {
                // It is no farther than a chart from a point that is known to the curves.
                let missing = self.radius + self.gap;
                self.excerpt.lacks(if near[k] { missing } else { 0.0 });
                continue;
            };
            known.push(k);
            rows.push(row);
            wanted.push(near[k]);
        }
        let on_curves = self.cut.on_curves().len();
        let (found, radii, cut_edges) = self.cut.neighborhoods_among(&rows, &wanted)?;
        for (one, radius) in found.iter().zip(radii) {
            // The nearest neighbors of what is in a chart are within a separation of it, or were asked for.
            let (row, moved) = (rows[one.center()], self.cut.moved(rows[one.center()]));
            self.excerpt.needs(row, radius + self.dl + moved);
        }
        let name = |k: Landmark| known[k.index()];
        let named = found.into_iter().map(|one| {
            let members = one.members().iter().copied().map(name);
            CellNeighborhood::new(name(one.center()), members)
        });
        let (in_cells, at_curves) = named.partition(|one| one.center().index() >= on_curves);
        Ok(NearCurves {
            in_cells,
            at_curves,
            cut_edges,
        })
    }
}
