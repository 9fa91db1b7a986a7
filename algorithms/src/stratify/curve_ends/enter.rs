//! Entering what a model says about the end of a curve.

use super::part::Answer;
use super::region::EndRegion;
use crate::stratify::site::{On, StratumKind};
use crate::stratify::strata::Strata;
use crate::tuning::EndTuning;
use crosscap_core::{PointCloud, Row, Scalar, squared_distance};

/// Puts the rows of a region where the model says that they are.
pub(super) fn enter<S: Scalar>(
    strata: &mut Strata,
    cloud: &PointCloud<S>,
    answer: Answer,
    tuning: &EndTuning,
) {
    let Answer {
        region,
        settled,
        eps,
    } = answer;
    let mut beside: Vec<(Row, On)> = Vec::new();
    let mut at_point = false;
    for row in settled {
        at_point |= (row.on.as_ref()).is_some_and(|on| on.kind == StratumKind::Point);
        strata.enter(cloud, row.row, row.on);
        beside.extend(row.beside.map(|on| (row.row, on)));
    }
    fill_gaps(strata, cloud, &region, beside, tuning.gap * eps);
    if !at_point {
        stand_in(strata, cloud, &region);
    }
    strata.add_region(region);
}

/// The nearest row stands for the point.
fn stand_in<S: Scalar>(strata: &mut Strata, cloud: &PointCloud<S>, region: &EndRegion) {
    let far = |row: Row| region.far(cloud, row);
    let nearest = (region.rows()).min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
    if let Some(row) = nearest {
        let on = On {
            kind: StratumKind::Point,
            place: Some(region.place.clone().into()),
            moved: far(row),
            fit: Some(region.used),
            cells: 0,
        };
        strata.enter(cloud, row, Some(on));
    }
}

/// Moves points beside the curves of a region onto them where they have gaps.
fn fill_gaps<S: Scalar>(
    strata: &mut Strata,
    cloud: &PointCloud<S>,
    region: &EndRegion,
    mut beside: Vec<(Row, On)>,
    gap: f64,
) {
    beside.sort_by(|a, b| a.1.moved.total_cmp(&b.1.moved).then(a.0.cmp(&b.0)));
    let place_of = |row: Row| {
        let on = strata.sites()[row].on()?;
        let curve = on.kind != StratumKind::Point;
        Some((on.cells, on.place.clone()?)).filter(|_| curve)
    };
    let mut there: Vec<(u8, Box<[f64]>)> = region.rows().filter_map(place_of).collect();
    for (row, on) in beside {
        let Some(place) = on.place.clone() else {
            continue;
        };
        let covered =
            |x: &(u8, Box<[f64]>)| x.0 == on.cells && squared_distance(&x.1, &place) < gap * gap;
        if region.distance(&place) > gap && !there.iter().any(covered) {
            there.push((on.cells, place));
            strata.enter(cloud, row, Some(on));
        }
    }
}
