//! What an analysis is asked for.

use crosscap_core::{Error, Radii, Row, Table, positive_length};

/// Parameters of the analysis.
#[derive(Clone, Debug)]
pub struct AnalysisOptions {
    /// Radius of the neighborhoods (strict), unit of the data.
    pub eps: f64,
    /// A radius for every point instead (strict), unit of the data: see
    /// [`NeighborhoodPolicy`](crate::neighborhood::NeighborhoodPolicy).
    pub radii: Option<Table<Row, f64>>,
    /// Take every point as 2-dimensional and look for no curve.
    pub surface: bool,
    /// Rows that lie on the boundary.
    pub boundary: Vec<Row>,
}

impl AnalysisOptions {
    /// Radius of the neighborhood of a row.
    pub(super) fn radius(&self, row: Row) -> f64 {
        self.radii.as_ref().map_or(self.eps, |radii| radii[row])
    }

    /// Radii of all neighborhoods.
    pub(super) fn all_radii(&self) -> Radii<'_> {
        match &self.radii {
            Some(radii) => Radii::Each(radii.as_slice()),
            None => Radii::Same(self.eps),
        }
    }

    pub(super) fn check(&self, points: usize) -> Result<(), Error> {
        positive_length("eps", self.eps)?;
        match &self.radii {
            Some(radii) if radii.len() != points => Err(Error::Shape {
                found: format!("{} radii", radii.len()),
                expected: format!("{points}, one a point"),
            }),
            _ => Ok(()),
        }
    }
}

/// For every row whether it is among those given as boundary.
///
/// # Errors
/// [`Error::Index`] for a row out of range.
pub(in crate::stratify) fn marked(rows: &[Row], points: usize) -> Result<Table<Row, bool>, Error> {
    let mut boundary = Table::filled(points, false);
    for &row in rows {
        *boundary.get_mut(row).ok_or(Error::Index {
            what: "boundary row",
            index: row.index(),
            limit: points,
        })? = true;
    }
    Ok(boundary)
}
