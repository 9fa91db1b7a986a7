//! Laws of [`LandmarkSelector`].

use super::inputs::{clouds, ranks};
use super::reference::{Scan, StraightLine};
use super::trial::ensure;
use super::{Failures, Findings, Law, LawBroken, Settings};
use crate::{Error, LandmarkSelector, MetricSpace, PointCloud, Scalar};
use proptest::prelude::*;

const SUBJECT: &str = "LandmarkSelector";

/// Refusal.
static REFUSAL: Law = Law {
    subject: SUBJECT,
    name: "refusal",
    says: "a separation that is not positive is refused as a bad parameter",
    look_for: "a comparison that NaN passes: write !(separation > 0.0)",
};

/// Subset.
static SUBSET: Law = Law {
    subject: SUBJECT,
    name: "subset",
    says: "landmarks are candidates, each at most once",
    look_for: "neighbors that were taken without asking whether they are candidates; the positions of \
               candidates in their list instead of the candidates",
};

/// Separation.
static SEPARATION: Law = Law {
    subject: SUBJECT,
    name: "separation",
    says: "two chosen points, and a chosen one and one of `taken`, are at distance at least the \
           separation",
    look_for: "`taken` that is not looked at; copies of a point (distance 0); a grid of cells whose \
               neighbors are forgotten",
};

/// Covering.
static COVERING: Law = Law {
    subject: SUBJECT,
    name: "covering",
    says: "a candidate that was not chosen has a chosen point, or one of `taken`, at distance less than \
           the separation",
    look_for: "a candidate at exactly the separation (it is far enough, and nothing else covers it); \
               a loop that ends early; points blocked by something that was not chosen in the end",
};

/// Reproducible.
static REPRODUCIBLE: Law = Law {
    subject: SUBJECT,
    name: "reproducible",
    says: "the same answer for the same seed",
    look_for: "a random generator of the thread or the clock; the order of a hash map; state kept from \
               call to call",
};

pub(super) static ALL: [&Law; 5] = [&REFUSAL, &SUBSET, &SEPARATION, &COVERING, &REPRODUCIBLE];

/// What a selector is asked.
#[derive(Clone, Debug)]
struct Question {
    cloud: PointCloud<f64>,
    candidates: Vec<usize>,
    taken: Vec<usize>,
    separation: f64,
    seed: u64,
}

fn questions() -> impl Strategy<Value = Question> {
    let roles = prop::collection::vec((any::<u16>(), 0..5_u8), 30);
    // On the lattice, distances of exactly one or two steps.
    let separation = prop_oneof![Just(1.0), Just(2.0), 0.05..4.0_f64];
    (clouds(1..=3, 1..=30), roles, separation, any::<u64>()).prop_map(
        |(cloud, roles, separation, seed)| {
            let keys: Vec<u16> = roles[..cloud.len()].iter().map(|r| r.0).collect();
            let order = ranks(&keys);
            let with = |role: fn(u8) -> bool| {
                order
                    .iter()
                    .copied()
                    .filter(|&k| role(roles[k].1))
                    .collect()
            };
            Question {
                candidates: with(|r| r < 3),
                taken: with(|r| r == 4),
                cloud,
                separation: f64::from(separation as f32),
                seed,
            }
        },
    )
}

/// Puts a selector through its laws, on clouds of up to 30 points in R^1 to R^3 with copies, some of
/// them candidates, some taken, and distances that equal the separation.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// use crosscap_core::{Error, LandmarkSelector, NeighborhoodOracle};
/// /// Every candidate, in turn, that is far enough from those before it.
/// struct InTurn;
/// impl LandmarkSelector for InTurn {
///     type Scalar = f64;
///     fn select(
///         &self, oracle: &dyn NeighborhoodOracle<Scalar = f64>, candidates: &[usize], taken: &[usize],
///         separation: f64, _seed: u64,
///     ) -> Result<Vec<usize>, Error> {
///         if !(separation > 0.0) {
///             return Err(Error::Parameter {
///                 name: "dl", value: separation.to_string(), expected: "a positive length".into(),
///             });
///         }
///         let (mut chosen, mut near) = (vec![], vec![]);
///         for &c in candidates {
///             oracle.within(c, separation, &mut near);
///             if !near.iter().any(|n| taken.contains(&n.index) || chosen.contains(&n.index)) {
///                 chosen.push(c);
///             }
///         }
///         Ok(chosen)
///     }
///     fn name(&self) -> &str { "in turn" }
/// }
/// laws::selector(&Settings::default(), &InTurn).unwrap();
/// ```
pub fn selector<L: LandmarkSelector>(settings: &Settings, selector: &L) -> Result<(), Failures> {
    laws(settings, selector)
}

/// The laws themselves, compiled once a type of distances and not for every selector that is tested.
fn laws<S: Scalar>(
    settings: &Settings,
    selector: &dyn LandmarkSelector<Scalar = S>,
) -> Result<(), Failures> {
    let tried = Tried { settings, selector };
    let mut found = Findings::new(settings, &ALL);
    found.put(tried.refusal());
    found.put(tried.subset());
    found.put(tried.separation());
    found.put(tried.covering());
    found.put(tried.reproducible());
    found.end()
}

fn metric<S: Scalar>(question: &Question) -> StraightLine<S> {
    StraightLine(question.cloud.cast::<S>())
}

/// A selector that is put through its laws.
struct Tried<'t, S: Scalar> {
    settings: &'t Settings,
    selector: &'t dyn LandmarkSelector<Scalar = S>,
}

impl<S: Scalar> Tried<'_, S> {
    fn select(&self, q: &Question, separation: f64) -> Result<Vec<usize>, Error> {
        let oracle = Scan(metric(q));
        (self.selector).select(&oracle, &q.candidates, &q.taken, separation, q.seed)
    }

    fn chosen(&self, q: &Question) -> Result<Vec<usize>, String> {
        (self.select(q, q.separation)).map_err(|e| format!("refused: {e}"))
    }

    fn refusal(&self) -> Result<(), LawBroken> {
        let bad = prop_oneof![Just(0.0), Just(-1.0), Just(f64::NAN)];
        let asked = (questions(), bad);
        REFUSAL.holds(self.settings, &asked, |(question, separation)| {
            match self.select(question, *separation) {
                Err(Error::Parameter { .. }) => Ok(()),
                other => Err(format!("the separation {separation} gave {other:?}")),
            }
        })
    }

    fn subset(&self) -> Result<(), LawBroken> {
        SUBSET.holds(self.settings, &questions(), |question| {
            let chosen = self.chosen(question)?;
            for (k, c) in chosen.iter().enumerate() {
                ensure!(
                    question.candidates.contains(c),
                    "point {c} is no candidate, chosen are {chosen:?}"
                );
                ensure!(!chosen[..k].contains(c), "point {c} twice in {chosen:?}");
            }
            Ok(())
        })
    }

    fn separation(&self) -> Result<(), LawBroken> {
        SEPARATION.holds(self.settings, &questions(), |question| {
            let (metric, chosen) = (metric::<S>(question), self.chosen(question)?);
            for (k, &a) in chosen.iter().enumerate() {
                for &b in chosen[..k].iter().chain(&question.taken) {
                    let d = metric.distance(a, b).as_f64();
                    ensure!(
                        d >= question.separation,
                        "points {a} and {b} are at distance {d}"
                    );
                }
            }
            Ok(())
        })
    }

    fn covering(&self) -> Result<(), LawBroken> {
        COVERING.holds(self.settings, &questions(), |question| {
            let (metric, chosen) = (metric::<S>(question), self.chosen(question)?);
            for &c in &question.candidates {
                let centers = chosen.iter().chain(&question.taken);
                let nearest = centers
                    .map(|&l| metric.distance(c, l).as_f64())
                    .fold(f64::INFINITY, f64::min);
                ensure!(
                    chosen.contains(&c) || nearest < question.separation,
                    "candidate {c} is at distance {nearest} from {chosen:?} and those taken"
                );
            }
            Ok(())
        })
    }

    fn reproducible(&self) -> Result<(), LawBroken> {
        REPRODUCIBLE.holds(self.settings, &questions(), |question| {
            let (first, again) = (self.chosen(question)?, self.chosen(question)?);
            ensure!(first == again, "asked twice: {first:?}, then {again:?}");
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::twins::{each_is_caught, quick};
    use super::*;
    use crate::NeighborhoodOracle;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[derive(Clone, Copy, PartialEq)]
    enum Fault {
        None,
        AnySeparation,
        Positions,
        TakenForgotten,
        Inclusive,
        FirstOnly,
        Remembering,
    }

    struct Twin(Fault, AtomicUsize);

    impl LandmarkSelector for Twin {
        type Scalar = f32;
        fn select(
            &self,
            oracle: &dyn NeighborhoodOracle<Scalar = f32>,
            candidates: &[usize],
            taken: &[usize],
            separation: f64,
            _seed: u64,
        ) -> Result<Vec<usize>, Error> {
            // NaN passes the comparison that one writes first.
            let refused = match self.0 {
                Fault::AnySeparation => separation <= 0.0,
                _ => separation.is_nan() || separation <= 0.0,
            };
            if refused {
                return Err(Error::Parameter {
                    name: "dl",
                    value: separation.to_string(),
                    expected: "a positive length".into(),
                });
            }
            let mut order = candidates.to_vec();
            let calls = self.1.fetch_add(1, Ordering::Relaxed);
            if self.0 == Fault::Remembering && calls % 2 == 1 {
                order.reverse();
            }
            let (mut chosen, mut near) = (vec![], vec![]);
            for &c in &order {
                let reach = separation as f32;
                let reach = if self.0 == Fault::Inclusive {
                    reach.next_up()
                } else {
                    reach
                };
                oracle.within(c, reach, &mut near);
                let blocked = |i| {
                    chosen.contains(&i) || self.0 != Fault::TakenForgotten && taken.contains(&i)
                };
                if !near.iter().any(|n| blocked(n.index)) {
                    chosen.push(c);
                }
            }
            match self.0 {
                Fault::Positions => chosen = (0..chosen.len()).collect(),
                Fault::FirstOnly => chosen.truncate(1),
                _ => {}
            }
            Ok(chosen)
        }
        fn name(&self) -> &str {
            "twin"
        }
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let put = |fault| selector(&quick(), &Twin(fault, AtomicUsize::new(0)));
        let faults: &[(Fault, &Law)] = &[
            (Fault::AnySeparation, &REFUSAL),
            (Fault::Positions, &SUBSET),
            (Fault::TakenForgotten, &SEPARATION),
            (Fault::Inclusive, &COVERING),
            (Fault::FirstOnly, &COVERING),
            (Fault::Remembering, &REPRODUCIBLE),
        ];
        each_is_caught(put, Fault::None, faults);
    }
}
