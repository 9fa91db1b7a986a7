//! Neighborhoods of landmarks, tile by tile, where no curves are near.

use super::question::CellQuestion;
use super::tile::{ROUNDING, Tile};
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::metric::Euclidean;
use crate::space::Space;
use crate::stratify::{Analyzer, ChartSpace, Cut, StratifyOptions};
use crate::tuning::{CellTuning, Tuning};
use crosscap_core::{
    CellNeighborhood, Error, Landmark, Neighbor, NeighborhoodOracle, Row, Table, squared_distance,
};
use std::sync::OnceLock;

/// How far from a landmark the points lie that its neighborhood depends on: a chart as far as it may be widened, and the
/// nearest neighbors of what is in it, which are within a separation.
pub(super) fn halo(dl: f64, tri_eps: f64, tuning: &CellTuning) -> f64 {
    let widest = tri_eps * tuning.widening.powi(tuning.widenings as i32);
    (widest + dl) * (1.0 + ROUNDING)
}

/// The neighborhoods of the landmarks in the box but for those that are cut elsewhere, and how wide their charts are.
///
/// # Errors
/// [`Error::SparseNeighborhood`] where so few points are near one that its nearest neighbors may be beyond the halo.
pub(super) fn neighborhoods(
    tile: &Tile,
    question: &CellQuestion,
) -> Result<(Vec<CellNeighborhood>, Vec<f64>), Error> {
    // Landmarks that are not in the tile are too far away to matter. Those that are keep their order, which breaks ties.
    let mut known: Vec<Landmark> = Vec::new();
    let mut rows: Vec<Row> = Vec::new();
    for (k, &row) in question.landmarks.iter().enumerate() {
        if let Some(row) = tile.find(row) {
            known.push(Landmark::new(k));
            rows.push(row);
        }
    }
    let wanted = |k: &Landmark| question.elsewhere.binary_search(k).is_err();
    let own = rows.iter().zip(&known);
    let own: Table<Landmark, bool> = own.map(|(&row, k)| tile.owns(row) && wanted(k)).collect();
    if !own.iter().any(|&own| own) {
        return Ok(Default::default());
    }
    let metric = Euclidean::new(tile.points().clone());
    let oracle = UpToHalo {
        tile,
        short: OnceLock::new(),
    };
    // Asked of nothing: there are no curves to look for.
    let estimator = PrincipalComponents::new(0.5)?;
    let tuning = &Tuning {
        cells: question.tuning.clone(),
        ..Tuning::MEASURED
    };
    let analyzer = Analyzer {
        space: Space::new(&metric, &oracle),
        estimator: &estimator,
        models: &[],
        execute: &Serial,
        tuning,
    };
    let options = StratifyOptions {
        dl: question.dl,
        tri_eps: question.tri_eps,
        seed: 0,
    };
    let cut = Cut::among(&analyzer, ChartSpace::Places, rows, &options)?;
    let (found, radii) = cut.neighborhoods(&own)?;
    if let Some(short) = oracle.short.into_inner() {
        return Err(short);
    }
    let name = |k: Landmark| known[k.index()];
    let named = found.into_iter().map(|one| {
        let members = one.members().iter().copied().map(name);
        CellNeighborhood::new(name(one.center()), members)
    });
    Ok((named.collect(), radii))
}

/// Nearest neighbors among the points of a tile, as far as it can know them.
struct UpToHalo<'a> {
    tile: &'a Tile,
    /// The first question that it could not answer.
    short: OnceLock<Error>,
}

impl NeighborhoodOracle for UpToHalo<'_> {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.tile.len()
    }

    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        out.clear();
        let place = self.tile.place(Row::new(center));
        self.tile.within(place, radius, |row| {
            out.push(Neighbor {
                index: row.index(),
                distance: squared_distance(place, self.tile.place(row)).sqrt(),
            });
        });
        out.sort_by(|a, b| {
            a.distance
                .total_cmp(&b.distance)
                .then(a.index.cmp(&b.index))
        });
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        let row = Row::new(center);
        let known = self.tile.known(row);
        self.within(center, known.max(0.0), out);
        if out.len() < count {
            let _ = self.short.set(Error::SparseNeighborhood {
                point: self.tile.cloud_row(row).index(),
                found: out.len(),
                needed: count,
                parameter: "dl",
            });
        }
        out.truncate(count);
    }

    fn name(&self) -> &str {
        "tile"
    }
}
