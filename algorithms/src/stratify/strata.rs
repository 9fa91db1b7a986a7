//! The strata as the points show them, gaps filled: what chains are laid on and cells are cut along.

use super::analysis::Analysis;
use super::curve_ends::EndRegion;
use super::site::{On, Site, StratumKind, Witness};
use crate::balls::BallTree;
use crosscap_core::{PointCloud, Row, Scalar, Table, squared_distance};

/// Where every point is, with the places that points on curves are moved to. Made once from an
/// [`Analysis`] and a resolution; what is at the ends of curves is entered then, and nothing changes after that.
#[derive(Clone, Debug)]
pub struct Strata {
    sites: Table<Row, Site>,
    places: Option<PointCloud<f64>>,
    /// Points at which curves end inside a sheet, with what is about them.
    regions: Vec<EndRegion>,
}

impl Strata {
    /// The strata of an analysis.
    ///
    /// A band of curve points that is narrower than the spacing of the data leaves gaps in the curve:
    /// where it has no point within `spacing`, the point that bears witness to it from nearest by is
    /// moved onto it. In the same way points at 0-strata that none is within `apart` of. `cloud` has
    /// the coordinates, where there are any; without, nothing is on a curve.
    pub(super) fn of<S: Scalar>(
        analysis: &Analysis,
        cloud: Option<&PointCloud<S>>,
        spacing: f64,
        apart: f64,
    ) -> Self {
        let mut out = Self::as_found(analysis, cloud);
        let Some(places) = &mut out.places else {
            return out;
        };
        let mut filling = Filling {
            sites: &mut out.sites,
            places,
        };
        filling.points(&analysis.apexes, apart);
        filling.curves(&analysis.witnesses, spacing);
        out
    }

    /// The strata of an analysis as they were found.
    pub(super) fn as_found<S: Scalar>(analysis: &Analysis, cloud: Option<&PointCloud<S>>) -> Self {
        let mut places = cloud.map(PointCloud::cast);
        if let Some(places) = &mut places {
            for (row, site) in analysis.sites.each() {
                if let Some(place) = site.on().and_then(|on| on.place.as_deref()) {
                    places.set_point(row.index(), place);
                }
            }
        }
        Self {
            sites: analysis.sites.clone(),
            places,
            regions: Vec::new(),
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.sites.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.sites.is_empty()
    }

    /// Where every point is.
    pub fn sites(&self) -> &Table<Row, Site> {
        &self.sites
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = Row> + use<> {
        self.sites.ids()
    }

    /// The kind of stratum that a point is on, `None` inside a cell.
    pub fn kind(&self, row: Row) -> Option<StratumKind> {
        self.sites[row].kind()
    }

    /// Whether a point is inside a cell.
    pub fn is_regular(&self, row: Row) -> bool {
        self.sites[row].on().is_none()
    }

    /// Places of all points, those on curves moved onto them; `None` where the space has no coordinates.
    pub fn places(&self) -> Option<&PointCloud<f64>> {
        self.places.as_ref()
    }

    /// How far a point was moved; 0 inside a cell.
    pub fn moved(&self, row: Row) -> f64 {
        self.sites[row].on().map_or(0.0, |on| on.moved)
    }

    /// Radius of the fit that put a point on a curve or point, where there is one.
    pub(super) fn radius(&self, row: Row) -> Option<f64> {
        self.sites[row].on()?.fit.map(|fit| fit.radius)
    }

    /// The points at which curves end inside a sheet, with what is about them.
    pub(super) fn regions(&self) -> &[EndRegion] {
        &self.regions
    }

    /// Takes a point at which a curve ends.
    pub(super) fn add_region(&mut self, region: EndRegion) {
        self.regions.push(region);
    }

    /// Puts a row on a stratum, or back inside a cell, to its place in the cloud.
    pub(super) fn enter<S: Scalar>(&mut self, cloud: &PointCloud<S>, row: Row, on: Option<On>) {
        if let Some(places) = &mut self.places {
            match on.as_ref().and_then(|on| on.place.as_deref()) {
                Some(place) => places.set_point(row.index(), place),
                None => {
                    let own: Vec<f64> = cloud
                        .point(row.index())
                        .iter()
                        .map(|x| x.as_f64())
                        .collect();
                    places.set_point(row.index(), &own);
                }
            }
        }
        self.sites[row] = on.map_or(Site::Regular, |on| Site::On(Box::new(on)));
    }

    /// How many cells meet at a point; 0 inside a cell.
    pub(super) fn cells(&self, row: Row) -> u8 {
        self.sites[row].on().map_or(0, |on| on.cells)
    }
}

/// Strata while their gaps are filled.
struct Filling<'a> {
    sites: &'a mut Table<Row, Site>,
    places: &'a mut PointCloud<f64>,
}

impl Filling<'_> {
    fn enter(&mut self, witness: &Witness) {
        self.places.set_point(witness.row.index(), witness.place());
        self.sites[witness.row] = Site::On(Box::new(witness.on.clone()));
    }

    fn distance(&self, row: Row, place: &[f64]) -> f64 {
        squared_distance(self.places.point(row.index()), place)
    }

    fn points(&mut self, apexes: &[Witness], apart: f64) {
        let rows = self.sites.ids();
        let mut points: Vec<Row> = rows
            .filter(|&i| self.sites[i].kind() == Some(StratumKind::Point))
            .collect();
        for w in nearest_first(apexes) {
            let near = |&r: &Row| self.distance(r, w.place()) < apart * apart;
            if !points.iter().any(near) {
                self.enter(w);
                points.push(w.row);
            }
        }
    }

    fn curves(&mut self, witnesses: &[Witness], spacing: f64) {
        // Witnesses are many, and those that fill anything few.
        let rows = self.sites.ids();
        let there: Vec<Row> = rows.filter(|&i| self.sites[i].on().is_some()).collect();
        let mut places = Vec::with_capacity(there.len() * self.places.dimension());
        for &row in &there {
            places.extend_from_slice(self.places.point(row.index()));
        }
        let tree = BallTree::new(self.places.dimension(), &places);
        let mut added: Vec<Row> = Vec::new();
        for w in nearest_first(witnesses) {
            if self.sites[w.row].on().is_some() {
                continue;
            }
            let counts = |row: Row| {
                let kind = self.sites[row].kind();
                kind == Some(w.on.kind) || kind == Some(StratumKind::Point)
            };
            let close = |row: Row| self.distance(row, w.place()) < spacing * spacing;
            let mut covered = added.iter().any(|&row| counts(row) && close(row));
            if !covered {
                tree.within(w.place(), spacing, |k, _| {
                    covered |= counts(there[k as usize])
                });
            }
            if !covered {
                self.enter(w);
                added.push(w.row);
            }
        }
    }
}

/// Witnesses in the order of their distance from what they bear witness to.
fn nearest_first(witnesses: &[Witness]) -> Vec<&Witness> {
    let mut all: Vec<&Witness> = witnesses.iter().collect();
    let key = |w: &Witness| (w.on.moved, w.row);
    all.sort_by(|a, b| {
        let ((x, i), (y, j)) = (key(a), key(b));
        x.total_cmp(&y).then(i.cmp(&j))
    });
    all
}
