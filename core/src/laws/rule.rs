//! Laws of [`TriangleRule`].

use super::trial::ensure;
use super::{Failures, Findings, Law, LawBroken, Settings};
use crate::TriangleRule;
use proptest::prelude::*;

const SUBJECT: &str = "TriangleRule";

/// Symmetry.
static SYMMETRY: Law = Law {
    subject: SUBJECT,
    name: "symmetry",
    says: "the same rank, within rounding, when the ends of the edge are exchanged",
    look_for: "a formula in which the two sides to the candidate play different parts, as the angle at \
               one end of the edge",
};

/// Scale.
static SCALE: Law = Law {
    subject: SUBJECT,
    name: "scale",
    says: "the order of two candidates does not change under uniform scaling",
    look_for: "lengths and areas added up; a threshold or a guard against division by 0 in the unit of \
               the data",
};

/// Degenerate.
static DEGENERATE: Law = Law {
    subject: SUBJECT,
    name: "degenerate",
    says: "a triangle without area ranks infinity, never NaN; one with an area of a thousandth of the \
           square of its edge, or more, ranks lower",
    look_for: "Heron's formula: negative under the root by rounding, or for sides that no triangle has; \
               0/0 for coinciding corners",
};

pub(super) static ALL: [&Law; 3] = [&SYMMETRY, &SCALE, &DEGENERATE];

/// A triangle on an edge from (0, 0) to (length, 0).
fn sides(length: f64, [x, y]: [f64; 2]) -> [f64; 3] {
    [length, x.hypot(y), (x - length).hypot(y)]
}

/// Puts a rule through its laws, on candidates up to three edges away, at scales from 1e-9 to 1e9.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::TriangleRule;
/// use crosscap_core::laws::{self, Settings};
/// /// The candidate of the smallest perimeter.
/// struct Perimeter;
/// impl TriangleRule for Perimeter {
///     fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
///         edge + a + b
///     }
///     fn name(&self) -> &str { "perimeter" }
/// }
/// let failures = laws::rule(&Settings::default(), &Perimeter).unwrap_err();
/// assert!(failures.broken().all(|b| b.law.name == "degenerate"));
/// ```
pub fn rule(settings: &Settings, rule: &impl TriangleRule) -> Result<(), Failures> {
    laws(settings, rule)
}

/// The laws themselves, compiled once and not for every rule that is tested.
fn laws(settings: &Settings, rule: &dyn TriangleRule) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &ALL);
    found.put(symmetry(settings, rule));
    found.put(scale(settings, rule));
    found.put(without_area(settings, rule));
    found.put(with_area(settings, rule));
    found.end()
}

/// Length of the edge before it is scaled.
fn edges() -> impl Strategy<Value = f64> {
    0.1..1.0_f64
}

/// A candidate on one side of the edge, at least a tenth above it.
fn candidates() -> impl Strategy<Value = [f64; 2]> {
    [-3.0..3.0_f64, 0.1..3.0_f64]
}

/// Whether two ranks differ by rounding alone.
fn near(x: f64, y: f64) -> bool {
    (x - y).abs() <= 1e-9 * (x.abs() + y.abs()) + 1e-12
}

fn symmetry(settings: &Settings, rule: &dyn TriangleRule) -> Result<(), LawBroken> {
    SYMMETRY.holds(settings, &(edges(), candidates()), |&(edge, place)| {
        let [e, a, b] = sides(edge, place);
        let (there, back) = (rule.rank(e, a, b), rule.rank(e, b, a));
        ensure!(
            there == back || near(there, back),
            "rank({e}, {a}, {b}) is {there}, rank({e}, {b}, {a}) is {back}"
        );
        Ok(())
    })
}

fn scale(settings: &Settings, rule: &dyn TriangleRule) -> Result<(), LawBroken> {
    let inputs = (edges(), candidates(), candidates(), -30..=30_i32);
    SCALE.holds(settings, &inputs, |&(edge, first, second, exponent)| {
        let factor = f64::from(exponent).exp2();
        let rank = |place, factor: f64| {
            let [e, a, b] = sides(edge, place).map(|s| s * factor);
            rule.rank(e, a, b)
        };
        let (p, q) = (rank(first, 1.0), rank(second, 1.0));
        let (r, s) = (rank(first, factor), rank(second, factor));
        ensure!(
            near(p, q) || (p < q) == (r < s) && (p > q) == (r > s),
            "ranks {p} and {q}; scaled by {factor} they are {r} and {s}"
        );
        Ok(())
    })
}

fn without_area(settings: &Settings, rule: &dyn TriangleRule) -> Result<(), LawBroken> {
    // Lengths that are exact in binary: in line, coinciding, and such as no triangle has.
    let step = || (0..=16_u8).prop_map(|k| f64::from(k) / 8.0);
    let inputs = (step(), step(), step(), 0..3_usize, -30..=30_i32);
    DEGENERATE.holds(settings, &inputs, |&(a, b, excess, turn, exponent)| {
        let factor = f64::from(exponent).exp2();
        let mut flat = [a + b + excess, a, b].map(|s| s * factor);
        flat.rotate_left(turn);
        let [e, a, b] = flat;
        let rank = rule.rank(e, a, b);
        ensure!(
            rank == f64::INFINITY,
            "rank({e}, {a}, {b}) of a triangle without area is {rank}"
        );
        Ok(())
    })
}

fn with_area(settings: &Settings, rule: &dyn TriangleRule) -> Result<(), LawBroken> {
    let thin = [-1.0..2.0_f64, 0.002..2.0_f64];
    DEGENERATE.holds(settings, &(edges(), thin), |(edge, place)| {
        let [e, a, b] = sides(*edge, place.map(|x| x * edge));
        let rank = rule.rank(e, a, b);
        ensure!(
            rank < f64::INFINITY,
            "rank({e}, {a}, {b}) of a triangle with an area is {rank}"
        );
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::super::twins::{catches, quick};
    use super::*;

    struct Rank(fn(f64, f64, f64) -> f64);

    impl TriangleRule for Rank {
        fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
            (self.0)(edge, a, b)
        }
        fn name(&self) -> &str {
            "rank"
        }
    }

    fn area(e: f64, a: f64, b: f64) -> f64 {
        let s = (e + a + b) / 2.0;
        (s * (s - e) * (s - a) * (s - b)).max(0.0).sqrt()
    }

    /// Perimeter, without flat triangles.
    fn perimeter(e: f64, a: f64, b: f64) -> f64 {
        if area(e, a, b) > 1e-6 * e * e {
            e + a + b
        } else {
            f64::INFINITY
        }
    }

    fn put(rank: fn(f64, f64, f64) -> f64) -> Result<(), Failures> {
        rule(&quick(), &Rank(rank))
    }

    #[test]
    fn a_perimeter_passes() {
        put(perimeter).unwrap();
    }

    #[test]
    fn one_sided_ranks_are_caught() {
        catches(put(|e, a, b| perimeter(e, a, b) + a), &SYMMETRY);
    }

    #[test]
    fn mixed_units_are_caught() {
        catches(
            put(|e, a, b| perimeter(e, a, b) - 2.0 * area(e, a, b)),
            &SCALE,
        );
    }

    #[test]
    fn a_nan_for_flat_triangles_is_caught() {
        let bare = |e: f64, a: f64, b: f64| {
            let s = (e + a + b) / 2.0;
            e * a * b / (4.0 * (s * (s - e) * (s - a) * (s - b)).sqrt())
        };
        catches(put(bare), &DEGENERATE);
    }

    #[test]
    fn a_rule_that_takes_nothing_is_caught() {
        catches(put(|_, _, _| f64::INFINITY), &DEGENERATE);
    }
}
