//! The waist of the published method.

use super::analysis::Published;
use crate::execute;
use crate::stratify::analysis::{Analysis, Analyzer, Fitter, Scratch};
use crate::stratify::charts::ChartSpace;
use crate::stratify::distances::{lengths, pairs};
use crate::stratify::producer::WaistProducer;
use crate::stratify::site::StratumKind;
use crate::stratify::strata::Strata;
use crate::stratify::stratification::Stratification;
use crosscap_core::{
    CellNeighborhood, CurveEdge, Error, Landmark, LandmarkSelector, LocalChart, Neighbor, Row,
    Scalar, SparseDistances, StratifiedLandmarks, Table,
};

/// Makes the waist of a cloud by the published method.
pub struct PublishedCut<'a, 'p, S: Scalar> {
    method: Published,
    analyzer: &'p Analyzer<'a, S>,
    analysis: &'p Analysis,
    strata: Strata,
    charts: ChartSpace<'a, S>,
    selector: &'p dyn LandmarkSelector<Scalar = S>,
    chart: &'p dyn LocalChart,
}

impl Published {
    /// The producer of a waist (the paper's section 2.2). `analysis` is that of [`Self::analyze`] with the
    /// same parameters; `charts` measures distances inside the neighborhoods.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is not positive, [`Error::Shape`] for an analysis of another
    /// number of points.
    pub fn cut<'a, 'p, S: Scalar>(
        &self,
        analyzer: &'p Analyzer<'a, S>,
        analysis: &'p Analysis,
        charts: ChartSpace<'a, S>,
        selector: &'p dyn LandmarkSelector<Scalar = S>,
        chart: &'p dyn LocalChart,
    ) -> Result<PublishedCut<'a, 'p, S>, Error> {
        self.check()?;
        PublishedCut::new(self.clone(), analyzer, analysis, charts, (selector, chart))
    }
}

impl<'a, 'p, S: Scalar> PublishedCut<'a, 'p, S> {
    fn new(
        method: Published,
        analyzer: &'p Analyzer<'a, S>,
        analysis: &'p Analysis,
        charts: ChartSpace<'a, S>,
        (selector, chart): (&'p dyn LandmarkSelector<Scalar = S>, &'p dyn LocalChart),
    ) -> Result<Self, Error> {
        let n = analyzer.space.len();
        if analysis.sites.len() != n {
            return Err(Error::Shape {
                found: format!("an analysis of {} points", analysis.sites.len()),
                expected: format!("{n} points, as in the cloud"),
            });
        }
        Ok(Self {
            // Nothing is moved, and no gap is filled.
            strata: Strata::as_found(analysis, analyzer.space.places()),
            method,
            analyzer,
            analysis,
            charts,
            selector,
            chart,
        })
    }

    /// Whether a point was said to be on the boundary.
    fn is_given(&self, row: Row) -> bool {
        let kind = self.strata.kind(row);
        matches!(kind, Some(StratumKind::Boundary | StratumKind::Point))
    }

    /// Rows of the landmarks, those on curves first, and how many these are.
    fn landmarks(&self) -> Result<(Table<Landmark, Row>, usize), Error> {
        let Published { dl, seed, .. } = self.method;
        let oracle = self.analyzer.space.oracle();
        let (others, on_curves): (Vec<usize>, Vec<usize>) =
            (0..self.strata.len()).partition(|&i| self.strata.is_regular(Row::new(i)));
        let mut rows = self.selector.select(oracle, &on_curves, &[], dl, seed)?;
        let count = rows.len();
        rows.extend(self.selector.select(oracle, &others, &rows, dl, seed)?);
        Ok((rows.into_iter().map(Row::new).collect(), count))
    }

    /// The members of every neighborhood, the center first.
    fn neighborhoods(
        &self,
        rows: &Table<Landmark, Row>,
        on_curves: usize,
    ) -> Result<Vec<Vec<Landmark>>, Error> {
        let mut landmark_at: Table<Row, Option<Landmark>> = Table::filled(self.strata.len(), None);
        for (k, &row) in rows.each() {
            landmark_at[row] = Some(k);
        }
        let fitter = match self.method.surface {
            true => None,
            false => Some(self.analyzer.fitter("since planes are fitted in them")?),
        };
        let of = |scratch: &mut Scratch<S>, k: usize| {
            let center = Landmark::new(k);
            let own = rows[center];
            let near = if k < on_curves {
                self.along_curve(fitter.as_ref(), own, scratch)
            } else {
                self.in_sheet(fitter.as_ref(), own, scratch)
            };
            let others = near.into_iter().filter(|&row| row != own);
            std::iter::once(center)
                .chain(others.filter_map(|row| landmark_at[row]))
                .collect()
        };
        let execute = self.analyzer.execute;
        Ok(execute::map(execute, rows.len(), Scratch::default, of))
    }

    /// Distances within all neighborhoods.
    fn distances(
        &self,
        rows: &Table<Landmark, Row>,
        all: &[Vec<Landmark>],
    ) -> Result<SparseDistances<S>, Error> {
        let space = self.charts.space().unwrap_or(&self.analyzer.space);
        let pairs = pairs(all.iter().map(|members| &members[..]));
        let lengths = lengths(
            self.analyzer.execute,
            space.metric(),
            self.charts.planes(),
            rows,
            &pairs,
        )?;
        let entries = pairs.iter().zip(&lengths).map(|(&(a, b), &d)| (a, b, d));
        SparseDistances::new(rows.len(), entries)
    }

    /// The points of B1 or B2, whichever holds point `i`, nearest first.
    fn in_sheet(
        &self,
        fitter: Option<&Fitter<'_, S>>,
        i: Row,
        scratch: &mut Scratch<S>,
    ) -> Vec<Row> {
        let divided = fitter.filter(|_| self.analysis.dimensions[i] == 3);
        if let Some(fitter) = divided {
            let parts = self.method.divide(fitter, i, self.method.tri_eps, scratch);
            let own = parts.iter().flatten().find(|p| p.row == i);
            if let (Some(parts), Some(own)) = (&parts, own) {
                let [a, b] = own.planes;
                let (near, far) = if a <= b { (0, 1) } else { (1, 0) };
                return parts
                    .iter()
                    .filter(|p| p.planes[near] <= p.planes[far] || p.on_curve(self.method.ep))
                    .map(|p| p.row)
                    .collect();
            }
        }
        self.ball(i, scratch)
    }

    /// The points of the B0 in which point `i` of a curve is laid out, nearest to the center of that
    /// B0 first.
    fn along_curve(
        &self,
        fitter: Option<&Fitter<'_, S>>,
        i: Row,
        scratch: &mut Scratch<S>,
    ) -> Vec<Row> {
        if self.is_given(i) {
            let mut rows = self.ball(i, scratch);
            rows.retain(|&r| self.is_given(r));
            return rows;
        }
        let Some(fitter) = fitter else {
            return Vec::new();
        };
        let oracle = self.analyzer.space.oracle();
        oracle.within(i.index(), S::of(self.method.eps), &mut scratch.near);
        let centers: Vec<Row> = scratch
            .near
            .iter()
            .map(Neighbor::row)
            .filter(|&j| self.analysis.dimensions[j] == 3)
            .collect();
        for j in centers {
            let reach = self.method.tri_eps.max(self.method.eps);
            let Some(mut parts) = self.method.divide(fitter, j, reach, scratch) else {
                continue;
            };
            parts.retain(|p| p.on_curve(self.method.ep));
            if parts.iter().any(|p| p.row == i) {
                return parts.into_iter().map(|p| p.row).collect();
            }
        }
        Vec::new()
    }

    /// The points within tri_eps of point `i`, nearest first.
    fn ball(&self, i: Row, scratch: &mut Scratch<S>) -> Vec<Row> {
        let oracle = self.analyzer.space.oracle();
        oracle.within(i.index(), S::of(self.method.tri_eps), &mut scratch.near);
        scratch.near.iter().map(Neighbor::row).collect()
    }
}

impl<S: Scalar> WaistProducer<S> for PublishedCut<'_, '_, S> {
    /// The method knows no other landmarks than those that are drawn: `extra` is left out.
    fn waist(&self, _extra: &[Row]) -> Result<Stratification<S>, Error> {
        let (rows, on_curves) = self.landmarks()?;
        let all = self.neighborhoods(&rows, on_curves)?;
        let distances = self.distances(&rows, &all)?;
        let edges = curve_edges(&all[..on_curves], &distances, self.chart)?;
        let curve_edges: Vec<CurveEdge> = (edges.into_iter())
            .map(|(a, b)| {
                let bounds = [a, b].iter().all(|&k| self.is_given(rows[k]));
                CurveEdge::new(a.into(), b.into(), if bounds { 1 } else { 4 })
            })
            .collect();
        let mut strata = Table::filled(rows.len(), 2);
        strata.as_mut_slice()[..on_curves].fill(1);
        let neighborhoods: Vec<CellNeighborhood> = (all.into_iter().skip(on_curves))
            .map(|members| CellNeighborhood::new(members[0], members))
            .collect();
        let waist = StratifiedLandmarks::new(strata, curve_edges, neighborhoods, distances)?;
        Ok(Stratification::new(waist, rows))
    }
}

/// Joins every curve landmark to its neighbors in its 1-D chart, one landmark after another; pairs in
/// increasing order. The center is the first of each neighborhood.
fn curve_edges<S: Scalar>(
    neighborhoods: &[Vec<Landmark>],
    distances: &SparseDistances<S>,
    chart: &dyn LocalChart,
) -> Result<Vec<(Landmark, Landmark)>, Error> {
    let mut joined: Table<Landmark, Vec<Landmark>> = Table::filled(neighborhoods.len(), Vec::new());
    for (center, members) in joined.ids().zip(neighborhoods) {
        let count = members.len();
        if count < 2 {
            continue;
        }
        let mut matrix = vec![0.0; count * count];
        for i in 0..count {
            for j in 0..i {
                let d = distances
                    .get(members[i], members[j])
                    .map_or(f64::INFINITY, Scalar::as_f64);
                matrix[i * count + j] = d;
                matrix[j * count + i] = d;
            }
        }
        let places = chart.chart(count, &matrix, 1)?.coordinates;
        if places.len() != count || places.iter().any(|x| !x.is_finite()) {
            return Err(Error::Law {
                plugin: chart.name().into(),
                law: "finite distances give finite coordinates",
                point: center.index(),
                detail: format!("{} coordinates for {count} points", places.len()),
            });
        }
        for side in [-1.0, 1.0] {
            let ahead = |k: usize| side * (places[k] - places[0]);
            let beyond = || (1..count).filter(|&k| ahead(k) > 0.0);
            if beyond().any(|k| joined[center].contains(&members[k])) {
                continue;
            }
            let next = beyond().min_by(|&a, &b| ahead(a).total_cmp(&ahead(b)).then(a.cmp(&b)));
            if let Some(k) = next {
                joined[center].push(members[k]);
                joined[members[k]].push(center);
            }
        }
    }
    let mut edges: Vec<(Landmark, Landmark)> = joined
        .each()
        .flat_map(|(a, ends)| ends.iter().map(move |&b| (a, b)))
        .filter(|&(a, b)| a < b)
        .collect();
    edges.sort_unstable();
    edges.dedup();
    Ok(edges)
}
