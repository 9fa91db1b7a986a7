//! Points of a stratum, thinned out.

use super::ground::Ground;
use crate::stratify::site::StratumKind;
use crosscap_core::{Row, Scalar, Table};

/// Rows on strata of the given kind, those moved least first, with pairwise distance at least `spacing`.
pub(super) fn thin<S: Scalar>(
    ground: &Ground<'_, '_, S>,
    spacing: f64,
    kind: StratumKind,
) -> Vec<Row> {
    let Ground { strata, places, .. } = *ground;
    let on = |row: Row| strata.kind(row) == Some(kind);
    let mut rows: Vec<Row> = strata.rows().filter(|&i| on(i)).collect();
    rows.sort_by(|&a, &b| {
        let (x, y) = (strata.moved(a), strata.moved(b));
        x.total_cmp(&y).then(a.cmp(&b))
    });
    let slack = rows.iter().map(|&r| strata.moved(r)).fold(0.0, f64::max);
    let mut blocked: Table<Row, bool> = Table::filled(strata.len(), false);
    let mut near = Vec::new();
    let mut kept = Vec::new();
    for row in rows {
        if blocked[row] {
            continue;
        }
        kept.push(row);
        let reach = spacing + slack + strata.moved(row);
        ground.fitter.around(row, reach, &mut near);
        for &x in &near {
            if on(x) && places.squared_distance(row.index(), x.index()) < spacing * spacing {
                blocked[x] = true;
            }
        }
    }
    kept
}
