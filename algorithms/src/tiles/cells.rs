//! Neighborhoods of landmarks, tile by tile, where no curves are near.

use super::known::UpToHalo;
use super::question::CellQuestion;
use super::tile::{ROUNDING, Tile};
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::metric::Euclidean;
use crate::space::Space;
use crate::stratify::{Analyzer, ChartSpace, Cut, StratifyOptions};
use crate::tuning::{CellTuning, Tuning};
use crosscap_core::{CellNeighborhood, Error, Landmark, Row, Table};

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
    let oracle = UpToHalo::new(tile);
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
    oracle.sufficed()?;
    let name = |k: Landmark| known[k.index()];
    let named = found.into_iter().map(|one| {
        let members = one.members().iter().copied().map(name);
        CellNeighborhood::new(name(one.center()), members)
    });
    Ok((named.collect(), radii))
}
