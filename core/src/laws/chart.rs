//! Laws of [`LocalChart`].

use super::inputs::{cloud, ranks};
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, Settings};
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
    let mut found = Findings::new(settings, &ALL);
    let drawn = |cloud: &PointCloud<f64>, dimension: usize| {
        let made = chart.chart(cloud.len(), &matrix(cloud), dimension);
        let made = made.map_err(|e| format!("refused: {e}"))?;
        let distances = distances(&made, cloud.len(), dimension)?;
        Ok::<_, String>((made, distances))
    };
    // Lattice distances make zeros and equal eigenvalues; others belong to no space.
    let entry = || prop_oneof![(0..=2_u8).prop_map(f64::from), 0.0..1.0_f64];
    let all_kinds = (0..=9_usize, 1..=3_usize, vec(entry(), 36));
    found.put(
        FINITE.holds(settings, &all_kinds, |(count, dimension, entries)| {
            let mut all = vec![0.0; count * count];
            let mut next = entries.iter().copied().cycle();
            for a in 0..*count {
                for b in 0..a {
                    let d = next.next().unwrap_or(0.0);
                    all[a * count + b] = d;
                    all[b * count + a] = d;
                }
            }
            let made = chart.chart(*count, &all, *dimension);
            let made = made.map_err(|e| format!("refused {all:?}: {e}"))?;
            distances(&made, *count, *dimension).map_err(|e| format!("{e}, from {all:?}"))?;
            Ok(())
        }),
    );
    let wrong = (2..=6_usize, 0..4_usize, any::<prop::sample::Index>());
    found.put(REFUSAL.holds(settings, &wrong, |(count, kind, at)| {
        let line: Vec<f64> = (0..*count).map(|k| k as f64).collect();
        let mut all = matrix(&cloud(1, &line, 1.0));
        let at = at.index(all.len());
        match kind {
            0 => drop(all.pop()),
            1 => all.push(0.0),
            2 => all[at] = f64::NAN,
            _ => all[at] = f64::INFINITY,
        }
        match chart.chart(*count, &all, 1) {
            Ok(_) => Err(format!(
                "{count} points with the distances {all:?} got a chart"
            )),
            Err(e) if !e.is_input() => Err(format!("'{e}' does not say that the input is bad")),
            Err(_) => Ok(()),
        }
    }));
    found.put(FLAT.holds(settings, &bent(), |bent| {
        let flat = bent.at(0.0);
        let (_, found) = drawn(&flat, bent.dimension)?;
        agree(&found, &matrix(&flat), CLOSE)
    }));
    found.put(DISTORTION.holds(settings, &bent(), |bent| {
        let flat = drawn(&bent.at(0.0), bent.dimension)?.0.distortion;
        ensure!(flat < 1e-6, "flat data have a distortion of {flat}");
        let mut before = flat.max(1e-6);
        for height in [0.05, 0.1, 0.2, 0.4] {
            let now = drawn(&bent.at(height), bent.dimension)?.0.distortion;
            ensure!(
                now > 1.1 * before,
                "at the height {height} the distortion is {now}, at the one before {before}"
            );
            before = now;
        }
        Ok(())
    }));
    let keys = vec(any::<u16>(), 40);
    found.put(MOTION.holds(
        settings,
        &(bent(), 0.0..0.4_f64, keys),
        |(bent, height, keys)| {
            let cloud = bent.at(*height);
            let (first, found) = drawn(&cloud, bent.dimension)?;
            let (again, _) = drawn(&cloud, bent.dimension)?;
            ensure!(first == again, "asked twice: {first:?}, then {again:?}");
            let mut order = vec![0];
            order.extend(ranks(&keys[..cloud.len() - 1]).iter().map(|k| k + 1));
            let (_, moved) = drawn(&cloud.select(&order), bent.dimension)?;
            let n = order.len();
            let expected: Vec<f64> = (0..n * n)
                .map(|k| found[order[k / n] * n + order[k % n]])
                .collect();
            agree(&moved, &expected, CLOSE).map_err(|e| format!("in the order {order:?} {e}"))
        },
    ));
    found.end()
}

#[cfg(test)]
mod tests {
    use super::super::twins::{each_is_caught, quick};
    use super::*;
    use crate::Error;
    use nalgebra::{DMatrix, SymmetricEigen};
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[derive(Clone, Copy, PartialEq)]
    enum Fault {
        None,
        Overflowing,
        Open,
        NotSquared,
        NeverDistorted,
        Kept,
        Anchored,
        Remembering,
    }

    struct Twin(Fault, AtomicUsize);

    /// Leading eigenvectors of the centered inner products.
    fn scaled(count: usize, distances: &[f64], dimension: usize, power: i32) -> Chart {
        let square = |i: usize, j: usize| distances[i * count + j].powi(power);
        let mean = |i: usize| (0..count).map(|j| square(i, j)).sum::<f64>() / count as f64;
        let means: Vec<f64> = (0..count).map(mean).collect();
        let total = means.iter().sum::<f64>() / count.max(1) as f64;
        let gram = DMatrix::from_fn(count, count, |i, j| {
            -0.5 * (square(i, j) - means[i] - means[j] + total)
        });
        let trace = gram.trace();
        let mut coordinates = vec![0.0; count * dimension];
        let mut kept = 0.0;
        if count > 0 {
            let eigen = SymmetricEigen::new(gram);
            let mut order: Vec<usize> = (0..count).collect();
            order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
            for (k, &column) in order.iter().take(dimension).enumerate() {
                let value = eigen.eigenvalues[column].max(0.0);
                kept += value;
                for i in 0..count {
                    coordinates[i * dimension + k] = value.sqrt() * eigen.eigenvectors[(i, column)];
                }
            }
        }
        let lost = if trace > 0.0 { 1.0 - kept / trace } else { 0.0 };
        Chart {
            dimension,
            coordinates,
            distortion: lost.clamp(0.0, 1.0),
        }
    }

    impl LocalChart for Twin {
        fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
            let sound = distances.len() == count * count && distances.iter().all(|d| d.is_finite());
            if !sound {
                if self.0 == Fault::Open {
                    return Ok(scaled(0, &[], dimension, 2));
                }
                return Err(Error::Shape {
                    found: format!("{} distances", distances.len()),
                    expected: format!("{count} x {count} finite ones"),
                });
            }
            let mut chart = scaled(count, distances, dimension, 2);
            match self.0 {
                Fault::None | Fault::Open => {}
                Fault::Overflowing => {
                    let greatest = distances.iter().fold(0.0, |m: f64, d| m.max(*d));
                    chart
                        .coordinates
                        .iter_mut()
                        .for_each(|x| *x = *x / greatest * greatest);
                }
                Fault::NotSquared => chart = scaled(count, distances, dimension, 1),
                Fault::NeverDistorted => chart.distortion = 0.0,
                Fault::Kept => chart.distortion = 1.0 - chart.distortion,
                Fault::Anchored => {
                    // Off by what is lost, in the last point.
                    if let Some(last) = chart.coordinates.last_mut() {
                        *last *= 1.0 + chart.distortion;
                    }
                }
                Fault::Remembering => {
                    let calls = self.1.fetch_add(1, Ordering::Relaxed);
                    let turned = if calls.is_multiple_of(2) { 1.0 } else { -1.0 };
                    chart.coordinates.iter_mut().for_each(|x| *x *= turned);
                }
            }
            Ok(chart)
        }
        fn name(&self) -> &str {
            "twin"
        }
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let put = |fault| chart(&quick(), &Twin(fault, AtomicUsize::new(0)));
        let faults: &[(Fault, &Law)] = &[
            (Fault::Overflowing, &FINITE),
            (Fault::Open, &REFUSAL),
            (Fault::NotSquared, &FLAT),
            (Fault::NeverDistorted, &DISTORTION),
            (Fault::Kept, &DISTORTION),
            (Fault::Anchored, &MOTION),
            (Fault::Remembering, &MOTION),
        ];
        each_is_caught(put, Fault::None, faults);
    }
}
