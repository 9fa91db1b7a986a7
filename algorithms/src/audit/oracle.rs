//! Neighborhood oracles.

use super::{SAMPLES, broken, distance, slack, spread};
use crosscap_core::{Error, MetricSpace, Neighbor, NeighborhoodOracle, Scalar};

/// Neighbors asked for.
const NEIGHBORS: usize = 12;

/// Asks an oracle for the neighborhoods of 64 points, and compares its answers with each other and
/// with the metric.
///
/// # Errors
/// [`Error::Law`] for an index out of range, a distance that is not finite or not below the radius, an
/// order that is not by distance and index, a neighborhood without its center, points within the
/// distance of the farthest of the nearest that are not among these, a distance that is not the metric's.
pub(crate) fn oracle<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    metric: &dyn MetricSpace<Scalar = S>,
    eps: f64,
) -> Result<(), Error> {
    let count = oracle.len();
    if metric.len() != count {
        return Err(Error::Shape {
            found: format!("metric {} on {} points", metric.name(), metric.len()),
            expected: format!("{count}, as many as the oracle has"),
        });
    }
    let (mut near, mut nearest) = (Vec::new(), Vec::new());
    for center in spread(count, SAMPLES) {
        oracle.within(center, S::of(eps), &mut near);
        within_is_strict(oracle.name(), metric, center, eps, &near)?;
        oracle.nearest(center, NEIGHBORS, &mut nearest);
        nearest_are_within(oracle, metric, center, &nearest, &mut near)?;
        distances_are_those_of(metric, oracle.name(), center, &nearest)?;
    }
    Ok(())
}

/// Whether `near` can be the points closer to `center` than `eps`.
fn within_is_strict<S: Scalar>(
    plugin: &str,
    metric: &dyn MetricSpace<Scalar = S>,
    center: usize,
    eps: f64,
    near: &[Neighbor<S>],
) -> Result<(), Error> {
    listed(plugin, center, near, metric)?;
    if let Some(x) = near.iter().find(|x| x.distance >= S::of(eps)) {
        let detail = format!(
            "point {} at distance {}, radius {eps}",
            x.index,
            x.distance.as_f64()
        );
        return broken(
            plugin,
            "strictness: within takes points at distance < radius",
            center,
            detail,
        );
    }
    if !near.iter().any(|x| x.index == center) {
        let detail = format!("{} points, not the center", near.len());
        return broken(
            plugin,
            "strictness: the center is among the points within",
            center,
            detail,
        );
    }
    Ok(())
}

/// Whether `nearest` are as many as were asked for, and all that is nearer than the last of them is among them, in the same order.
fn nearest_are_within<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    metric: &dyn MetricSpace<Scalar = S>,
    center: usize,
    nearest: &[Neighbor<S>],
    near: &mut Vec<Neighbor<S>>,
) -> Result<(), Error> {
    let plugin = oracle.name();
    listed(plugin, center, nearest, metric)?;
    if nearest.len() != NEIGHBORS.min(oracle.len()) {
        let detail = format!("{} points of the {NEIGHBORS} nearest", nearest.len());
        return broken(plugin, "equals brute force", center, detail);
    }
    let last = nearest.last().map_or(S::zero(), |x| x.distance);
    let before = nearest.partition_point(|x| x.distance < last);
    oracle.within(center, last, near);
    let names = |all: &[Neighbor<S>]| all.iter().map(|x| x.index).collect::<Vec<_>>();
    if last > S::zero() && names(near) != names(&nearest[..before]) {
        let detail = format!(
            "{} points within {}, {before} by the query for the nearest",
            near.len(),
            last.as_f64()
        );
        return broken(plugin, "equals brute force", center, detail);
    }
    Ok(())
}

/// Whether two of the distances that an oracle tells, that of the second and that of the last point, are the metric's.
fn distances_are_those_of<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    plugin: &str,
    center: usize,
    nearest: &[Neighbor<S>],
) -> Result<(), Error> {
    for x in [nearest.get(1), nearest.last()].into_iter().flatten() {
        let told = x.distance.as_f64();
        let true_one = distance(metric, center, x.index)?.as_f64();
        // Infinite ones are equal, and their difference is no number.
        if told != true_one && (told - true_one).abs() > slack::<S>() * told.max(true_one) {
            let detail = format!(
                "distance {told} to point {}, {true_one} by the metric {}",
                x.index,
                metric.name()
            );
            return broken(plugin, "equals brute force", center, detail);
        }
    }
    Ok(())
}

fn listed<S: Scalar>(
    plugin: &str,
    center: usize,
    found: &[Neighbor<S>],
    metric: &dyn MetricSpace<Scalar = S>,
) -> Result<(), Error> {
    let count = metric.len();
    for x in found {
        if x.index >= count {
            let detail = format!("point {} of {count}", x.index);
            return broken(plugin, "equals brute force", center, detail);
        }
        if !x.distance.is_finite() || x.distance < S::zero() {
            // An oracle that wraps a metric hands on what the metric says; infinity is a distance.
            if distance(metric, center, x.index)? == x.distance {
                continue;
            }
            let detail = format!("distance {} to point {}", x.distance.as_f64(), x.index);
            return broken(plugin, "equals brute force", center, detail);
        }
    }
    for pair in found.windows(2) {
        let key = |x: &Neighbor<S>| (x.distance.as_f64(), x.index);
        if key(&pair[0]) >= key(&pair[1]) {
            let detail = format!("point {} before point {}", pair[0].index, pair[1].index);
            return broken(
                plugin,
                "order: sorted by distance, ties by index",
                center,
                detail,
            );
        }
    }
    Ok(())
}
