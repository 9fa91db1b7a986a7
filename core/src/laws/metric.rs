//! Laws of [`MetricSpace`].

use super::inputs::clouds;
use super::reference::rounding;
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, Settings};
use crate::{MetricSpace, PointCloud, Scalar};

const SUBJECT: &str = "MetricSpace";

/// Never NaN.
static NEVER_NAN: Law = Law {
    subject: SUBJECT,
    name: "never NaN",
    says: "every distance is a number; infinity says that no path joins the two points",
    look_for: "0/0 or the arc cosine of something above 1 where points coincide; the square root of \
               a difference that rounding made negative",
};

/// Identity.
static IDENTITY: Law = Law {
    subject: SUBJECT,
    name: "identity",
    says: "distance(a, a) == 0, exactly, and distances are at least 0",
    look_for: "an offset or a smoothing term inside a root; a cosine similarity instead of a \
               distance; a difference without its absolute value. Return 0 early when a == b",
};

/// Symmetry.
static SYMMETRY: Law = Law {
    subject: SUBJECT,
    name: "symmetry",
    says: "distance(a, b) == distance(b, a), to the bit",
    look_for: "a directed graph; sums that run in the order of the path (add in integers, or from \
               the smaller index); something that belongs to `a` alone, as its own bandwidth",
};

/// Triangle inequality.
static TRIANGLE: Law = Law {
    subject: SUBJECT,
    name: "triangle inequality",
    says: "distance(a, c) <= distance(a, b) + distance(b, c), within rounding",
    look_for: "squared distances whose root is missing; a power above 1; a minimum over several \
               metrics (the maximum and the sum of metrics are metrics); a similarity that was only \
               subtracted from 1",
};

/// Many at once.
static MANY: Law = Law {
    subject: SUBJECT,
    name: "many at once",
    says: "distances_to gives, in the order asked for, what distance gives, to the bit; the former \
           content of the buffer is dropped",
    look_for: "a search that stops before the last target, or sums in another order than the one \
               between two points; a missing `out.clear()`; targets asked for twice",
};

/// Places.
static PLACES: Law = Law {
    subject: SUBJECT,
    name: "places",
    says: "where places are named, there is one for every point, and a distance is the straight line between \
           the two, within rounding",
    look_for: "a metric that uses coordinates and measures otherwise, around a torus or along a surface: it must \
               not name them; places in another order or unit than the points",
};

pub(super) static ALL: [&Law; 6] = [&NEVER_NAN, &IDENTITY, &SYMMETRY, &TRIANGLE, &MANY, &PLACES];

/// Puts a metric through its laws, on all triples of clouds of 1 to 9 points in R^1 to R^5 with copies
/// and ties.
///
/// `build` makes the metric over the points that it is given (`cloud.cast()` for `f32`); it may
/// leave points out.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings, StraightLine};
/// laws::metric(&Settings::default(), |cloud| StraightLine(cloud.clone())).unwrap();
/// ```
pub fn metric<M: MetricSpace>(
    settings: &Settings,
    build: impl Fn(&PointCloud<f64>) -> M,
) -> Result<(), Failures> {
    laws(settings, &|cloud| Box::new(build(cloud)))
}

/// A metric over the points of a cloud.
type Build<'b, 'm, S> = dyn Fn(&PointCloud<f64>) -> Box<dyn MetricSpace<Scalar = S> + 'm> + 'b;

/// The laws themselves, compiled once a type of distances and not for every metric that is tested.
fn laws<S: Scalar>(settings: &Settings, build: &Build<'_, '_, S>) -> Result<(), Failures> {
    let tests: [(&'static Law, Test<'_, S>); 6] = [
        (&NEVER_NAN, |metric| {
            on_pairs(metric, |_, _, d, _| !d.is_nan())
        }),
        (&IDENTITY, |metric| {
            on_pairs(metric, |a, b, d, _| d >= 0.0 && (a != b || d == 0.0))
        }),
        (&SYMMETRY, |metric| {
            on_pairs(metric, |_, _, d, back| d.to_bits() == back.to_bits())
        }),
        (&TRIANGLE, no_detour_is_shorter),
        (&MANY, many_are_one_by_one),
        (&PLACES, places_are_straight),
    ];
    let mut found = Findings::new(settings, &ALL);
    let clouds = clouds(1..=5, 1..=9);
    for (law, test) in tests {
        found.put(law.holds(settings, &clouds, |cloud| test(&*build(cloud))));
    }
    found.end()
}

/// Whether a law holds on one cloud.
type Test<'m, S> = fn(&(dyn MetricSpace<Scalar = S> + 'm)) -> Outcome;

/// Whether something is true of every two points and their distance, there and back.
fn on_pairs<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    test: fn(usize, usize, f64, f64) -> bool,
) -> Outcome {
    let d = |a, b| metric.distance(a, b).as_f64();
    for a in 0..metric.len() {
        for b in 0..metric.len() {
            let (there, back) = (d(a, b), d(b, a));
            ensure!(
                test(a, b, there, back),
                "distance({a}, {b}) = {there}, distance({b}, {a}) = {back}"
            );
        }
    }
    Ok(())
}

fn no_detour_is_shorter<S: Scalar>(metric: &dyn MetricSpace<Scalar = S>) -> Outcome {
    let n = metric.len();
    let all: Vec<f64> = (0..n * n)
        .map(|k| metric.distance(k / n, k % n).as_f64())
        .collect();
    let d = |a: usize, b: usize| all[a * n + b];
    // A few roundings a coordinate in each of the three.
    let slack = 64.0 * rounding::<S>();
    for a in 0..n {
        for b in 0..n {
            for c in a + 1..n {
                let round = d(a, b) + d(b, c);
                ensure!(
                    d(a, c) <= round * (1.0 + slack),
                    "distance({a}, {c}) = {}, yet through {b} it is {} + {} = {round}",
                    d(a, c),
                    d(a, b),
                    d(b, c)
                );
            }
        }
    }
    Ok(())
}

fn many_are_one_by_one<S: Scalar>(metric: &dyn MetricSpace<Scalar = S>) -> Outcome {
    let n = metric.len();
    // Backwards, and the first one twice.
    let to: Vec<usize> = (0..n).rev().chain(n.checked_sub(1)).collect();
    let mut out = vec![S::of(-1.0)];
    for from in 0..n {
        metric.distances_to(from, &to, &mut out);
        let alone: Vec<f64> = (to.iter().map(|&b| metric.distance(from, b).as_f64())).collect();
        let many: Vec<f64> = out.iter().map(|d| d.as_f64()).collect();
        ensure!(
            many == alone,
            "distances_to({from}, {to:?}) = {many:?}, one by one {alone:?}"
        );
    }
    Ok(())
}

fn places_are_straight<S: Scalar>(metric: &dyn MetricSpace<Scalar = S>) -> Outcome {
    let (n, slack) = (metric.len(), 64.0 * rounding::<S>());
    let Some(places) = metric.places() else {
        return Ok(());
    };
    ensure!(places.len() == n, "{} places for {n} points", places.len());
    for a in 0..n {
        for b in 0..n {
            let d = metric.distance(a, b).as_f64();
            let straight = places.squared_distance(a, b).sqrt();
            ensure!(
                (d - straight).abs() <= slack * straight,
                "distance({a}, {b}) = {d}, the straight line between their places is {straight}"
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::StraightLine;
    use super::super::twins::{catches, quick};
    use super::*;

    /// Straight-line distances, spoiled.
    struct Spoiled(StraightLine<f64>, fn(usize, usize, f64) -> f64);

    impl MetricSpace for Spoiled {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn distance(&self, a: usize, b: usize) -> f64 {
            self.1(a, b, self.0.distance(a, b))
        }
        fn name(&self) -> &str {
            "spoiled"
        }
    }

    fn put(spoil: fn(usize, usize, f64) -> f64) -> Result<(), Failures> {
        metric(&quick(), |cloud| {
            Spoiled(StraightLine(cloud.clone()), spoil)
        })
    }

    #[test]
    fn sound_metrics_pass() {
        put(|_, _, d| d).unwrap();
        put(|_, _, d| if d < 2.0 { d } else { f64::INFINITY }).unwrap_err();
        put(|a, b, _| if a == b { 0.0 } else { f64::INFINITY }).unwrap();
        metric(&quick(), |cloud| StraightLine(cloud.cast::<f32>())).unwrap();
    }

    #[test]
    fn a_nan_is_caught() {
        let broken = put(|a, b, d| if a != b && d == 0.0 { f64::NAN } else { d });
        catches(broken, &NEVER_NAN);
    }

    #[test]
    fn an_offset_is_caught() {
        catches(put(|_, _, d| (d * d + 1e-18).sqrt()), &IDENTITY);
    }

    #[test]
    fn a_negative_distance_is_caught() {
        catches(put(|_, _, d| if d > 1.0 { 1.0 - d } else { d }), &IDENTITY);
    }

    #[test]
    fn a_last_bit_of_asymmetry_is_caught() {
        catches(
            put(|a, b, d| if a < b { d.next_up() } else { d }),
            &SYMMETRY,
        );
    }

    /// Straight-line distances whose many at once are those of a matrix in single precision.
    struct Halved(StraightLine<f64>);

    impl MetricSpace for Halved {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn distance(&self, a: usize, b: usize) -> f64 {
            self.0.distance(a, b)
        }
        fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<f64>) {
            out.clear();
            out.extend(to.iter().map(|&b| f64::from(self.distance(from, b) as f32)));
        }
        fn name(&self) -> &str {
            "halved"
        }
    }

    #[test]
    fn many_distances_in_another_precision_are_caught() {
        let broken = metric(&quick(), |cloud| Halved(StraightLine(cloud.clone())));
        catches(broken, &MANY);
    }

    /// A line of length 4 that closes to a circle, by the coordinates that it is unrolled in.
    struct Rolled(PointCloud<f64>);

    impl MetricSpace for Rolled {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn distance(&self, a: usize, b: usize) -> f64 {
            let d = (self.0.point(a)[0] - self.0.point(b)[0]).abs() % 4.0;
            d.min(4.0 - d)
        }
        fn places(&self) -> Option<&PointCloud<f64>> {
            Some(&self.0)
        }
        fn name(&self) -> &str {
            "rolled"
        }
    }

    #[test]
    fn places_of_another_metric_are_caught() {
        // Multiples of an eighth: the remainder is exact.
        let build = |cloud: &PointCloud<f64>| {
            let first = |row: &[f64]| (8.0 * row[0]).round() / 8.0;
            Rolled(PointCloud::new(1, cloud.iter().map(first).collect()).unwrap())
        };
        catches(metric(&quick(), build), &PLACES);
    }

    #[test]
    fn squares_are_caught() {
        let broken = catches(put(|_, _, d| d * d), &TRIANGLE);
        assert!(broken.found.contains("yet through"), "{broken}");
    }
}
