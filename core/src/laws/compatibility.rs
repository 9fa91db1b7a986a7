//! Laws of [`CompatibilityTest`].

use super::inputs::{LatticePair, area, lattice_pairs};
use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, LawBroken, Settings};
use crate::{CompatibilityTest, Meeting};
use proptest::prelude::*;

const SUBJECT: &str = "CompatibilityTest";

/// Symmetry.
static SYMMETRY: Law = Law {
    subject: SUBJECT,
    name: "symmetry",
    says: "meeting(a, b) == meeting(b, a)",
    look_for: "corners of one asked against the other and not the other way round",
};

/// Motion.
static MOTION: Law = Law {
    subject: SUBJECT,
    name: "motion",
    says: "the same answer after a rigid motion of the chart",
    look_for: "bounding boxes that decide more than 'certainly apart'; an orientation that is taken \
               for granted; slopes instead of determinants",
};

/// Scale.
static SCALE: Law = Law {
    subject: SUBJECT,
    name: "scale",
    says: "the same answer after uniform scaling of the chart",
    look_for: "an absolute tolerance, also that of a solver: bring the pair to unit size first",
};

/// Reference.
static REFERENCE: Law = Law {
    subject: SUBJECT,
    name: "reference",
    says: "the answer of the linear program (6) of Martin & Watson (2011), for triangles that are not \
           flat: disjoint, in a common face alone, or anything else (overlap)",
    look_for: "a corner on a side (a T-junction is an overlap); triangles that share a corner and lie \
               in one another there; the same triangle twice (a common face); sides that cross while \
               no corner is inside",
};

/// Agreement.
static AGREEMENT: Law = Law {
    subject: SUBJECT,
    name: "agreement",
    says: "compatible(a, b) is meeting(a, b) != Overlap",
    look_for: "a quick `compatible` of one's own that decides otherwise",
};

pub(super) static ALL: [&Law; 5] = [&SYMMETRY, &MOTION, &SCALE, &REFERENCE, &AGREEMENT];

/// How two lattice triangles meet, in integers, without rounding.
///
/// The relation is that of the linear program (6): with shared corners, whatever the triangles have
/// in common beyond the hull of these is an overlap.
pub fn reference_meeting(pair: &LatticePair) -> Meeting {
    let [a, b] = [pair.a, pair.b].map(|t| {
        if area(t[0], t[1], t[2]) < 0 {
            [t[0], t[2], t[1]]
        } else {
            t
        }
    });
    let shared: Vec<[i32; 2]> = a.iter().copied().filter(|p| b.contains(p)).collect();
    let other = |t: [[i32; 2]; 3]| t.into_iter().filter(|p| !shared.contains(p));
    let clean = match shared[..] {
        [] => {
            // Convex polygons without a common point have a side with the other strictly beyond.
            let beyond = |t: [[i32; 2]; 3], o: [[i32; 2]; 3]| {
                (0..3).any(|i| o.iter().all(|&p| area(t[i], t[(i + 1) % 3], p) < 0))
            };
            if beyond(a, b) || beyond(b, a) {
                return Meeting::Disjoint;
            }
            false
        }
        // At a common corner they look like two angles: no arm of one lies in the other.
        [apex] => {
            let within = |t: [[i32; 2]; 3], p: [i32; 2]| {
                let at = t.iter().position(|&c| c == apex).unwrap_or(0);
                let (u, v) = (t[(at + 1) % 3], t[(at + 2) % 3]);
                area(apex, u, p) >= 0 && area(apex, p, v) >= 0
            };
            !other(a).any(|p| within(b, p)) && !other(b).any(|p| within(a, p))
        }
        // Third corners on opposite sides of the common side.
        [p, q] => {
            let side = |t| other(t).map(|r| area(p, q, r).signum()).sum::<i64>();
            side(a) * side(b) < 0
        }
        _ => true,
    };
    if clean {
        Meeting::CommonFace
    } else {
        Meeting::Overlap
    }
}

/// Whether no three of the corners are in line, so that rounding decides nothing.
fn clear(pair: &LatticePair) -> bool {
    let mut corners: Vec<[i32; 2]> = pair.a.iter().chain(&pair.b).copied().collect();
    corners.sort_unstable();
    corners.dedup();
    (0..corners.len())
        .all(|i| (0..i).all(|j| (0..j).all(|k| area(corners[i], corners[j], corners[k]) != 0)))
}

/// Puts a compatibility test through its laws, on pairs of lattice triangles that share, touch, cross
/// and contain; moved exactly (quarter turns, mirror images, whole shifts) and, where no three corners
/// are in line, anyhow.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```no_run
/// # use crosscap_core::{ChartTriangle, CompatibilityTest, Meeting};
/// # struct MyTest;
/// # impl CompatibilityTest for MyTest {
/// #     fn meeting(&self, _: &ChartTriangle, _: &ChartTriangle) -> Meeting { todo!() }
/// #     fn name(&self) -> &str { "mine" }
/// # }
/// use crosscap_core::laws::{self, Settings};
/// laws::compatibility(&Settings::default(), &MyTest).unwrap();
/// ```
pub fn compatibility(settings: &Settings, test: &impl CompatibilityTest) -> Result<(), Failures> {
    laws(settings, test)
}

/// The laws themselves, compiled once and not for every test that is tested.
fn laws(settings: &Settings, test: &dyn CompatibilityTest) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &ALL);
    found.put(symmetry(settings, test));
    found.put(motion(settings, test));
    found.put(scale(settings, test));
    found.put(reference(settings, test));
    found.put(agreement(settings, test));
    found.end()
}

fn symmetry(settings: &Settings, test: &dyn CompatibilityTest) -> Result<(), LawBroken> {
    SYMMETRY.holds(settings, &lattice_pairs(), |pair| {
        let [a, b] = pair.triangles(|p| p);
        let (there, back) = (test.meeting(&a, &b), test.meeting(&b, &a));
        ensure!(
            there == back,
            "meeting(a, b) is {there:?}, meeting(b, a) is {back:?}"
        );
        Ok(())
    })
}

/// Whether two triangles meet as before when all corners have been moved to another `place`.
fn unchanged(
    test: &dyn CompatibilityTest,
    pair: &LatticePair,
    by: &str,
    place: impl Fn([f64; 2]) -> [f64; 2],
) -> Outcome {
    let [a, b] = pair.triangles(|p| p);
    let [c, d] = pair.triangles(place);
    let (before, after) = (test.meeting(&a, &b), test.meeting(&c, &d));
    ensure!(
        before == after,
        "{before:?} became {after:?} by {by}: {:?}, {:?}",
        c.places,
        d.places
    );
    Ok(())
}

fn motion(settings: &Settings, test: &dyn CompatibilityTest) -> Result<(), LawBroken> {
    let shifts = [-20..=20_i32, -20..=20_i32];
    let motions = (0..4_u8, any::<bool>(), shifts, 0.0..std::f64::consts::TAU);
    let moved = (lattice_pairs(), motions);
    MOTION.holds(settings, &moved, |(pair, motion)| {
        let (quarters, mirrored, shift, angle) = motion;
        let shift = shift.map(f64::from);
        unchanged(test, pair, "quarter turns and a shift", |[x, y]| {
            let x = if *mirrored { -x } else { x };
            let [x, y] = (0..*quarters).fold([x, y], |[x, y], _| [-y, x]);
            [x + shift[0], y + shift[1]]
        })?;
        if !clear(pair) {
            return Ok(());
        }
        let (sin, cos) = angle.sin_cos();
        unchanged(test, pair, "a rotation and a shift", |[x, y]| {
            [
                cos * x - sin * y + shift[0] / 7.0,
                sin * x + cos * y + shift[1] / 7.0,
            ]
        })
    })
}

fn scale(settings: &Settings, test: &dyn CompatibilityTest) -> Result<(), LawBroken> {
    let scaled = (lattice_pairs(), -40..=40_i32);
    SCALE.holds(settings, &scaled, |(pair, exponent)| {
        let factor = f64::from(*exponent).exp2();
        unchanged(test, pair, "scaling", |p| p.map(|x| x * factor))
    })
}

fn reference(settings: &Settings, test: &dyn CompatibilityTest) -> Result<(), LawBroken> {
    REFERENCE.holds(settings, &lattice_pairs(), |pair| {
        let [a, b] = pair.triangles(|p| p);
        let (found, expected) = (test.meeting(&a, &b), reference_meeting(pair));
        ensure!(
            found == expected,
            "meeting(a, b) is {found:?}, expected {expected:?}"
        );
        Ok(())
    })
}

fn agreement(settings: &Settings, test: &dyn CompatibilityTest) -> Result<(), LawBroken> {
    AGREEMENT.holds(settings, &lattice_pairs(), |pair| {
        let [a, b] = pair.triangles(|p| p);
        let (compatible, meeting) = (test.compatible(&a, &b), test.meeting(&a, &b));
        ensure!(
            compatible == (meeting != Meeting::Overlap),
            "compatible(a, b) is {compatible}, meeting(a, b) is {meeting:?}"
        );
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::super::twins::{each_is_caught, quick};
    use super::*;
    use crate::ChartTriangle;

    #[derive(Clone, Copy, PartialEq)]
    enum Fault {
        None,
        OneWay,
        Quadrant,
        Tolerance,
        TouchingAllowed,
        OwnShortcut,
    }

    struct Twin(Fault);

    impl CompatibilityTest for Twin {
        /// By the signs of determinants in floating point: exact on the lattice.
        fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
            let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
                (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
            };
            let tolerance = if self.0 == Fault::Tolerance {
                1e-9
            } else {
                0.0
            };
            let touching = self.0 == Fault::TouchingAllowed;
            let shares = a.corners.iter().filter(|c| b.corners.contains(c)).count();
            // The line of a side of one with all that is not shared of the other strictly beyond.
            let parted = |a: &ChartTriangle, b: &ChartTriangle| {
                (0..3).any(|i| {
                    let (p, q) = (a.places[i], a.places[(i + 1) % 3]);
                    let inside = turn(p, q, a.places[(i + 2) % 3]).signum();
                    (0..3).all(|k| {
                        let at = turn(p, q, b.places[k]) * inside;
                        let on = [i, (i + 1) % 3]
                            .iter()
                            .any(|&e| a.corners[e] == b.corners[k]);
                        on || at < -tolerance || touching && at <= 0.0
                    })
                })
            };
            // No arm of one at the common corner lies in the angle of the other.
            let spread = |a: &ChartTriangle, b: &ChartTriangle| {
                let at = (0..3).find(|&i| b.corners.contains(&a.corners[i])).unwrap();
                let (apex, u, v) = (a.places[at], a.places[(at + 1) % 3], a.places[(at + 2) % 3]);
                let way = turn(apex, u, v).signum();
                !b.places.iter().any(|&p| {
                    p != apex && turn(apex, u, p) * way >= 0.0 && turn(apex, p, v) * way >= 0.0
                })
            };
            let apart = |a, b| {
                if shares == 1 {
                    spread(a, b)
                } else {
                    parted(a, b)
                }
            };
            let clear = match (shares, self.0) {
                (1, _) => apart(a, b) && apart(b, a),
                (_, Fault::OneWay) => apart(a, b),
                _ => apart(a, b) || apart(b, a),
            };
            let misplaced = self.0 == Fault::Quadrant && a.places.iter().any(|p| p[0] < 0.0);
            if shares == 3 {
                Meeting::CommonFace
            } else if misplaced || !clear {
                Meeting::Overlap
            } else if shares > 0 {
                Meeting::CommonFace
            } else {
                Meeting::Disjoint
            }
        }
        fn compatible(&self, a: &ChartTriangle, b: &ChartTriangle) -> bool {
            let meeting = self.meeting(a, b);
            match self.0 {
                Fault::OwnShortcut => meeting == Meeting::Disjoint,
                _ => meeting != Meeting::Overlap,
            }
        }
        fn name(&self) -> &str {
            "twin"
        }
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let settings = Settings {
            cases: 1000,
            ..quick()
        };
        let put = |fault| compatibility(&settings, &Twin(fault));
        let faults: &[(Fault, &Law)] = &[
            (Fault::OneWay, &SYMMETRY),
            (Fault::Quadrant, &MOTION),
            (Fault::Tolerance, &SCALE),
            (Fault::TouchingAllowed, &REFERENCE),
            (Fault::OwnShortcut, &AGREEMENT),
        ];
        each_is_caught(put, Fault::None, faults);
    }
}
