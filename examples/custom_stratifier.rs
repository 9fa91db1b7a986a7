//! A way of one's own from a cloud to the waist: charts of the nearest landmarks instead of charts of one radius.

use crosscap::algorithms::stratify::{Analysis, Ground, Stratification, Stratifier, WaistProducer};
use crosscap::core::{
    CellNeighborhood, Error, Landmark, MetricSpace, Row, SparseDistances, StratifiedLandmarks,
    Table,
};
use crosscap::prelude::*;

/// Charts of so many landmarks, on surfaces without curves: they grow where points are thin.
struct NearestLandmarks(usize);

impl Stratifier<f64> for NearestLandmarks {
    /// Every point is inside a cell: no dimension is estimated, no model asked.
    fn analyze(&self, ground: &Ground<'_, f64>) -> Result<Analysis, Error> {
        Ok(Analysis::of_surface(ground.analyzer.space.len()))
    }

    fn cut<'p>(
        &'p self,
        ground: &'p Ground<'p, f64>,
        _analysis: &'p Analysis,
    ) -> Result<Box<dyn WaistProducer<f64> + 'p>, Error> {
        let space = ground.analyzer.space;
        let all: Vec<usize> = (0..space.len()).collect();
        let (dl, seed) = (ground.options.dl, ground.options.seed);
        let rows = (ground.selector).select(space.oracle(), &all, &[], dl, seed)?;
        Ok(Box::new(Charts {
            size: self.0,
            metric: space.metric(),
            rows: rows.into_iter().map(Row::new).collect(),
        }))
    }

    fn name(&self) -> &str {
        "nearest-landmarks"
    }
}

/// The landmarks that were chosen.
struct Charts<'p> {
    size: usize,
    metric: &'p dyn MetricSpace<Scalar = f64>,
    rows: Table<Landmark, Row>,
}

impl WaistProducer<f64> for Charts<'_> {
    /// Landmarks that are asked for behind those that were chosen.
    fn waist(&self, extra: &[Row]) -> Result<Stratification<f64>, Error> {
        let mut rows = self.rows.clone();
        rows.extend(extra.iter().copied().filter(|&row| self.may_add(row)));
        let apart =
            |a: Landmark, b: Landmark| self.metric.distance(rows[a].index(), rows[b].index());
        let around = |center: Landmark| {
            let mut members: Vec<Landmark> = rows.ids().collect();
            // The center itself comes first, at distance 0.
            members.sort_by(|&a, &b| {
                let order = apart(center, a).total_cmp(&apart(center, b));
                order.then(a.cmp(&b))
            });
            members.truncate(self.size);
            CellNeighborhood::new(center, members)
        };
        let neighborhoods: Vec<CellNeighborhood> = rows.ids().map(around).collect();
        let distances = SparseDistances::within(rows.len(), &neighborhoods, apart)?;
        let strata = Table::filled(rows.len(), 2);
        let waist = StratifiedLandmarks::new(strata, Vec::new(), neighborhoods, distances)?;
        Ok(Stratification::new(waist, rows))
    }

    fn may_add(&self, row: Row) -> bool {
        row.index() < self.metric.len() && !self.rows.contains(&row)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sphere = SampleSurface::find("sphere")?;
    let points = sphere.sample(&Sampling::new(4000, 7))?.points;
    let outcome = Pipeline::new(Parameters::new(0.4, 0.2))?
        .stratifier(Box::new(NearestLandmarks(28)))
        .reconstruct(&points)?;
    println!(
        "{}: {} landmarks, {:.1} members a chart, Betti numbers {:?}, verified: {}",
        outcome.report.plugins.stratifier,
        outcome.report.landmarks.landmarks,
        outcome.report.landmarks.mean_members,
        outcome.homology.betti_rational,
        outcome.is_verified()
    );
    Ok(())
}
