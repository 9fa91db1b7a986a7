//! Landmarks next to the end of a curve.

use super::EndRegion;
use crate::stratify::strata::Strata;
use crosscap_core::Row;

/// The regular row nearest to the point of every region in each of its cells, at most `within` from it, but as
/// clear of the curves as can be: without a landmark there the triangle between two curves would be that of
/// several cells.
pub(in crate::stratify) fn innermost(strata: &Strata, within: f64) -> Vec<Row> {
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let mut out = Vec::new();
    // Where there is one cell alone, no triangle is that of several.
    let several = |region: &&EndRegion| region.fit.labels_of(2).count() > 1;
    for region in strata.regions().iter().filter(several) {
        let on_curves: Vec<Row> = region.rows().filter(|&r| !strata.is_regular(r)).collect();
        let clear = |row: Row| {
            let squares = on_curves.iter();
            let squares = squares.map(|c| places.squared_distance(row.index(), c.index()));
            squares.fold(f64::INFINITY, f64::min)
        };
        for label in region.fit.labels_of(2) {
            let own = region.labels.iter().filter(|x| x.1 == label);
            let near = own.map(|x| x.0).filter(|&row| {
                strata.is_regular(row) && region.distance(places.point(row.index())) < within
            });
            let best = near.max_by(|&a, &b| clear(a).total_cmp(&clear(b)).then(b.cmp(&a)));
            out.extend(best);
        }
    }
    out
}
