//! What a cut of a part of a cloud says for the whole.

use super::landmarks;
use super::waist::Cut;
use crosscap_core::{CellNeighborhood, CurveEdge, Error, Landmark, Row, Scalar, Table};

impl<S: Scalar> Cut<'_, '_, S> {
    /// Rows of the landmarks on points and curves, points first.
    pub(crate) fn on_curves(&self) -> &[Row] {
        self.skeleton.rows().as_slice()
    }

    /// The chains between these.
    pub(crate) fn chains(&self) -> &[CurveEdge] {
        self.skeleton.edges()
    }

    /// Rows of landmarks next to the ends of curves, which come before those that are chosen.
    pub(crate) fn innermost(&self) -> Vec<Row> {
        landmarks::innermost(self.analyzer, &self.strata, self.options.dl)
    }

    /// Rows that cannot be chosen as landmarks, in order.
    pub(crate) fn barred(&self) -> Vec<Row> {
        let all = landmarks::barred(self.analyzer, &self.strata, &self.skeleton);
        all.ids().filter(|&row| all[row]).collect()
    }

    /// Rows that something is said of: they are on curves, touch them, or are known to a fit that labels points.
    /// A neighborhood whose chart holds none of them is that of a surface without curves.
    pub(crate) fn marked(&self) -> Vec<Row> {
        let mut marked: Table<Row, bool> = Table::filled(self.strata.len(), false);
        for row in self.strata.rows() {
            marked[row] = !self.strata.is_regular(row);
        }
        let fits = self.skeleton.labelling().flat_map(|fit| fit.labels());
        fits.for_each(|&(row, _)| marked[row] = true);
        let regions = self.strata.regions().iter();
        for (row, _) in regions.flat_map(|region| region.known()) {
            marked[row] = true;
        }
        self.contacts.rows().for_each(|row| marked[row] = true);
        marked.ids().filter(|&row| marked[row]).collect()
    }

    /// Whether a row is inside a cell.
    pub(crate) fn is_regular(&self, row: Row) -> bool {
        self.strata.is_regular(row)
    }

    /// How far a row was moved.
    pub(crate) fn moved(&self, row: Row) -> f64 {
        self.strata.moved(row)
    }

    /// The neighborhoods of those landmarks that are `wanted`, in cells first and then at curves, how wide their charts are, and how many edges
    /// were cut. Landmarks stand for `rows`, those of the skeleton first.
    ///
    /// # Errors
    /// [`Error::Law`] for what a plug-in breaks.
    pub(crate) fn neighborhoods_among(
        &self,
        rows: &Table<Landmark, Row>,
        wanted: &Table<Landmark, bool>,
    ) -> Result<(Vec<CellNeighborhood>, Vec<f64>, usize), Error> {
        let found = self.around(rows).find(&|k| wanted[k])?;
        Ok((found.neighborhoods, found.radii, found.cut_edges))
    }
}

impl Cut<'_, '_, f64> {
    /// Where a row was moved to.
    pub(crate) fn place(&self, row: Row) -> &[f64] {
        let places = self.strata.places().or(self.analyzer.space.places());
        places.map_or(&[], |places| places.point(row.index()))
    }
}
