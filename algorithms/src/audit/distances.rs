//! Metrics.

use super::{SAMPLES, broken, slack, spread};
use crosscap_core::{Error, MetricSpace, Neighbor, NeighborhoodOracle, Scalar};

/// Of the points asked, every so many are compared with one far away as well: far distances may be costly.
const FAR: usize = 8;

/// Asks a metric about the neighbors of 64 points, and about 8 points far from one of these.
///
/// # Errors
/// [`Error::Shape`] when it has another number of points than the oracle, [`Error::Law`] for a distance
/// that is NaN or negative, for a distance of a point from itself other than 0, for two that differ by direction,
/// for one that is longer than a way around, and for one that is not the straight line between the places that the
/// metric names.
pub(crate) fn metric<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
) -> Result<(), Error> {
    let count = oracle.len();
    if metric.len() != count {
        return Err(Error::Shape {
            found: format!("metric {} on {} points", metric.name(), metric.len()),
            expected: format!("{count}, as many as there are"),
        });
    }
    let mut near: Vec<Neighbor<S>> = Vec::new();
    let mut points = Vec::new();
    for (k, center) in spread(count, SAMPLES).enumerate() {
        oracle.nearest(center, NEIGHBORS, &mut near);
        points.clear();
        points.push(center);
        let others: Vec<usize> = near
            .iter()
            .map(|x| x.index)
            .filter(|&i| i != center && i < count)
            .collect();
        // The nearest, one in the middle, the farthest.
        for at in [0, others.len() / 2, others.len().saturating_sub(1)] {
            points.extend(
                others
                    .get(at)
                    .filter(|i| !points.contains(i))
                    .copied()
                    .as_slice(),
            );
        }
        let far = (center + count / 2) % count;
        if k % (SAMPLES / FAR) == 0 && !points.contains(&far) {
            points.push(far);
        }
        among(metric, &points)?;
        straight(metric, &points)?;
    }
    Ok(())
}

/// Where a metric names places, its distances are those of the places.
fn straight<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    points: &[usize],
) -> Result<(), Error> {
    let Some(places) = metric.places() else {
        return Ok(());
    };
    let law = "places: every distance is that of a straight line between them";
    if places.len() != metric.len() {
        let detail = format!("{} places of {} points", places.len(), metric.len());
        return broken(metric.name(), law, points[0], detail);
    }
    for &other in &points[1..] {
        let told = metric.distance(points[0], other).as_f64();
        let line = places.squared_distance(points[0], other).sqrt();
        if (told - line).abs() > slack::<S>() * told.max(line) {
            let detail = format!("distance {told} to point {other}, {line} between the places");
            return broken(metric.name(), law, points[0], detail);
        }
    }
    Ok(())
}

/// Neighbors that triples are taken from.
const NEIGHBORS: usize = 24;

fn among<S: Scalar>(metric: &dyn MetricSpace<Scalar = S>, points: &[usize]) -> Result<(), Error> {
    let size = points.len();
    let mut table = vec![0.0; size * size];
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate() {
            table[i * size + j] = distance(metric, a, b)?.as_f64();
        }
    }
    let d = |i: usize, j: usize| table[i * size + j];
    for i in 0..size {
        if d(i, i) != 0.0 {
            let detail = format!("distance {} from itself", d(i, i));
            return broken(
                metric.name(),
                "identity: distance(a, a) == 0",
                points[i],
                detail,
            );
        }
        for j in 0..i {
            if d(i, j) != d(j, i) {
                let detail = format!(
                    "distance {} to point {}, {} back",
                    d(i, j),
                    points[j],
                    d(j, i)
                );
                return broken(
                    metric.name(),
                    "symmetry: distance(a, b) == distance(b, a)",
                    points[i],
                    detail,
                );
            }
        }
    }
    for i in 0..size {
        for j in 0..i {
            for k in (0..size).filter(|&k| k != i && k != j) {
                let around = d(i, k) + d(k, j);
                if d(i, j) > around * (1.0 + slack::<S>()) {
                    let detail = format!(
                        "distance {} to point {}, but only {around} by point {}",
                        d(i, j),
                        points[j],
                        points[k]
                    );
                    return broken(
                        metric.name(),
                        "triangle inequality: distance(a, c) <= distance(a, b) + distance(b, c)",
                        points[i],
                        detail,
                    );
                }
            }
        }
    }
    Ok(())
}

/// A distance that is a number and not negative.
///
/// # Errors
/// [`Error::Law`] for any other.
pub(crate) fn distance<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    a: usize,
    b: usize,
) -> Result<S, Error> {
    let d = metric.distance(a, b);
    if d >= S::zero() {
        return Ok(d);
    }
    Err(no_distance(metric.name(), a, b, d.as_f64()))
}

/// What is to be said of an answer that is no distance.
pub(crate) fn no_distance(metric: &str, a: usize, b: usize, answer: f64) -> Error {
    Error::Law {
        plugin: metric.into(),
        law: if answer.is_nan() {
            "never NaN"
        } else {
            "identity: distances are at least 0"
        },
        point: a,
        detail: format!("distance {answer} to point {b}"),
    }
}
