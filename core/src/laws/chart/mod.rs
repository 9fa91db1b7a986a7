//! Laws of [`LocalChart`].

#[cfg(test)]
mod tests;

use super::inputs::{cloud, ranks};
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, LawBroken, Settings};
use crate::{Chart, LocalChart, PointCloud};
use proptest::collection::vec;
use proptest::prelude::*;

const SUBJECT: &str = "LocalChart";

/// Finite.
static FINITE: Law = Law {
    subject: SUBJECT,
    name: "finite",
    says: "finite distances, of any space and any number of points, give count * dimension finite \
           coordinates and a distortion between 0 and 1",
    look_for: "a division by a total that is 0 (copies of one point); the root of a negative \
               eigenvalue (distances that no flat space has); fewer points than coordinates",
};

/// Refusal.
static REFUSAL: Law = Law {
    subject: SUBJECT,
    name: "refusal",
    says: "distances that are not count * count long, or not finite, are refused as bad input",
    look_for: "a missing check at the door: an eigenvalue routine may return garbage on NaN",
};

/// Flat data.
static FLAT: Law = Law {
    subject: SUBJECT,
    name: "flat data",
    says: "distances of points of a flat space of the chart's dimension are reproduced within rounding",
    look_for: "distances that were not squared, or squared twice; centering of the rows alone; the \
               wrong eigenvectors, or the right ones without the root of their eigenvalue",
};

/// Distortion.
static DISTORTION: Law = Law {
    subject: SUBJECT,
    name: "distortion",
    says: "the distortion is 0 for flat data, and grows with the share of the squared distances that \
           is lost",
    look_for: "a constant; a distortion measured after a rescaling; the share that is kept instead of \
               the one that is lost",
};

/// Motion.
static MOTION: Law = Law {
    subject: SUBJECT,
    name: "motion",
    says: "a chart depends on the distances only: the same ones give the same chart, and, in another \
           order of the points behind the center, one with the same distances",
    look_for: "state kept from call to call, random starts without a fixed seed; points that serve as \
               anchors because of their index",
};

pub(super) static ALL: [&Law; 5] = [&FINITE, &REFUSAL, &FLAT, &DISTORTION, &MOTION];

/// A neighborhood that is bent out of flat space: a cross of axes and points between, each lifted and
/// its mirror image lowered, which makes the lost share grow with the height whatever the points.
#[derive(Clone, Debug)]
struct Bent {
    dimension: usize,
    /// `dimension` coordinates each, in -1..1, and the share of the height.
    points: Vec<Vec<f64>>,
    /// A length that all is multiplied with.
    scale: f64,
}

impl Bent {
    fn at(&self, height: f64) -> PointCloud<f64> {
        let d = self.dimension;
        let mut rows = vec![0.0; d + 1];
        for axis in 0..d {
            for sign in [1.0, -1.0, 1.0, -1.0] {
                let start = rows.len();
                rows.resize(start + d + 1, 0.0);
                rows[start + axis] = sign;
                rows[start + d] = if (rows.len() / (d + 1)).is_multiple_of(4) {
                    height
                } else {
                    -height
                };
            }
        }
        for point in &self.points {
            for side in [height, -height] {
                rows.extend(&point[..d]);
                rows.push(side * point[d]);
            }
        }
        cloud(d + 1, &rows, self.scale)
    }
}

fn bent() -> impl Strategy<Value = Bent> {
    (1..=3_usize, -6..=6_i32).prop_flat_map(|(dimension, exponent)| {
        vec(vec(-1.0..1.0_f64, dimension + 1), 0..12).prop_map(move |points| Bent {
            dimension,
            points,
            scale: 10_f64.powi(exponent),
        })
    })
}

/// The matrix of straight-line distances.
fn matrix(cloud: &PointCloud<f64>) -> Vec<f64> {
    let n = cloud.len();
    (0..n * n)
        .map(|k| cloud.squared_distance(k / n, k % n).sqrt())
        .collect()
}

/// Distances in a chart, which must be well formed.
fn distances(chart: &Chart, count: usize, dimension: usize) -> Result<Vec<f64>, String> {
    ensure!(
        chart.dimension == dimension && chart.coordinates.len() == count * dimension,
        "{} coordinates and dimension {} for {count} points in dimension {dimension}",
        chart.coordinates.len(),
        chart.dimension
    );
    let bad = chart.coordinates.iter().position(|x| !x.is_finite());
    ensure!(
        bad.is_none(),
        "coordinate {bad:?} is not finite: {:?}",
        chart.coordinates
    );
    ensure!(
        (0.0..=1.0).contains(&chart.distortion),
        "the distortion is {}",
        chart.distortion
    );
    let row = |k: usize| &chart.coordinates[k * dimension..(k + 1) * dimension];
    Ok((0..count * count)
        .map(|k| crate::squared_distance(row(k / count), row(k % count)).sqrt())
        .collect())
}

/// Whether distances agree within a share of the greatest.
fn agree(found: &[f64], expected: &[f64], tolerance: f64) -> Outcome {
    let count = found.len().isqrt();
    let greatest = expected.iter().fold(0.0, |m: f64, d| m.max(*d));
    for (k, (x, y)) in found.iter().zip(expected).enumerate() {
        ensure!(
            (x - y).abs() <= tolerance * greatest,
            "points {} and {} are at distance {y}, in the chart at {x}",
            k / count,
            k % count
        );
    }
    Ok(())
}

/// Distances are compared to this share of the greatest: eigenvectors of a matrix of squares carry
/// half of the digits.
const CLOSE: f64 = 1e-6;

/// Puts a chart through its laws: on flat and bent neighborhoods of dimension 1 to 3, at scales from
/// 1e-6 to 1e6, and on symmetric matrices of any kind.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```no_run
/// # use crosscap_core::{Chart, Error, LocalChart};
/// # struct MyChart;
/// # impl LocalChart for MyChart {
/// #     fn chart(&self, _: usize, _: &[f64], _: usize) -> Result<Chart, Error> { todo!() }
/// #     fn name(&self) -> &str { "mine" }
/// # }
/// use crosscap_core::laws::{self, Settings};
/// laws::chart(&Settings::default(), &MyChart).unwrap();
/// ```
pub fn chart(settings: &Settings, chart: &impl LocalChart) -> Result<(), Failures> {
    laws(settings, chart)
}

/// The laws themselves, compiled once and not for every chart that is tested.
fn laws(settings: &Settings, chart: &dyn LocalChart) -> Result<(), Failures> {
    let tried = Tried { settings, chart };
    let mut found = Findings::new(settings, &ALL);
    found.put(tried.finite());
    found.put(tried.refusal());
    found.put(tried.flat());
    found.put(tried.distortion());
    found.put(tried.motion());
    found.end()
}

/// A chart that is put through its laws.
struct Tried<'t> {
    settings: &'t Settings,
    chart: &'t dyn LocalChart,
}

impl Tried<'_> {
    /// The chart of a cloud, and the distances in it.
    fn drawn(
        &self,
        cloud: &PointCloud<f64>,
        dimension: usize,
    ) -> Result<(Chart, Vec<f64>), String> {
        let made = self.chart.chart(cloud.len(), &matrix(cloud), dimension);
        let made = made.map_err(|e| format!("refused: {e}"))?;
        let distances = distances(&made, cloud.len(), dimension)?;
        Ok((made, distances))
    }

    fn finite(&self) -> Result<(), LawBroken> {
        // Lattice distances make zeros and equal eigenvalues; others belong to no space.
        let entry = prop_oneof![(0..=2_u8).prop_map(f64::from), 0.0..1.0_f64];
        let all_kinds = (0..=9_usize, 1..=3_usize, vec(entry, 36));
        FINITE.holds(self.settings, &all_kinds, |(count, dimension, entries)| {
            let all = symmetric(*count, entries);
            let made = self.chart.chart(*count, &all, *dimension);
            let made = made.map_err(|e| format!("refused {all:?}: {e}"))?;
            distances(&made, *count, *dimension).map_err(|e| format!("{e}, from {all:?}"))?;
            Ok(())
        })
    }

    fn refusal(&self) -> Result<(), LawBroken> {
        let wrong = (2..=6_usize, 0..4_usize, any::<prop::sample::Index>());
        REFUSAL.holds(self.settings, &wrong, |(count, kind, at)| {
            let line: Vec<f64> = (0..*count).map(|k| k as f64).collect();
            let mut all = matrix(&cloud(1, &line, 1.0));
            let at = at.index(all.len());
            match kind {
                0 => drop(all.pop()),
                1 => all.push(0.0),
                2 => all[at] = f64::NAN,
                _ => all[at] = f64::INFINITY,
            }
            match self.chart.chart(*count, &all, 1) {
                Ok(_) => Err(format!(
                    "{count} points with the distances {all:?} got a chart"
                )),
                Err(e) if !e.is_input() => Err(format!("'{e}' does not say that the input is bad")),
                Err(_) => Ok(()),
            }
        })
    }

    fn flat(&self) -> Result<(), LawBroken> {
        FLAT.holds(self.settings, &bent(), |bent| {
            let flat = bent.at(0.0);
            let (_, found) = self.drawn(&flat, bent.dimension)?;
            agree(&found, &matrix(&flat), CLOSE)
        })
    }

    fn distortion(&self) -> Result<(), LawBroken> {
        DISTORTION.holds(self.settings, &bent(), |bent| {
            let at = |height| {
                Ok::<_, String>(self.drawn(&bent.at(height), bent.dimension)?.0.distortion)
            };
            let flat = at(0.0)?;
            ensure!(flat < 1e-6, "flat data have a distortion of {flat}");
            let mut before = flat.max(1e-6);
            for height in [0.05, 0.1, 0.2, 0.4] {
                let now = at(height)?;
                ensure!(
                    now > 1.1 * before,
                    "at the height {height} the distortion is {now}, at the one before {before}"
                );
                before = now;
            }
            Ok(())
        })
    }

    fn motion(&self) -> Result<(), LawBroken> {
        let inputs = (bent(), 0.0..0.4_f64, vec(any::<u16>(), 40));
        MOTION.holds(self.settings, &inputs, |(bent, height, keys)| {
            let cloud = bent.at(*height);
            let (first, found) = self.drawn(&cloud, bent.dimension)?;
            let (again, _) = self.drawn(&cloud, bent.dimension)?;
            ensure!(first == again, "asked twice: {first:?}, then {again:?}");
            let mut order = vec![0];
            order.extend(ranks(&keys[..cloud.len() - 1]).iter().map(|k| k + 1));
            let (_, moved) = self.drawn(&cloud.select(&order), bent.dimension)?;
            let n = order.len();
            let expected: Vec<f64> = (0..n * n)
                .map(|k| found[order[k / n] * n + order[k % n]])
                .collect();
            agree(&moved, &expected, CLOSE).map_err(|e| format!("in the order {order:?} {e}"))
        })
    }
}

/// A matrix with these entries below the diagonal, from the beginning again where there are too few.
fn symmetric(count: usize, entries: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; count * count];
    let mut next = entries.iter().copied().cycle();
    for a in 0..count {
        for b in 0..a {
            let d = next.next().unwrap_or(0.0);
            all[a * count + b] = d;
            all[b * count + a] = d;
        }
    }
    all
}
