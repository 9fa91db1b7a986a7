//! Laws of [`Triangulator`].

use super::trial::{Outcome, ensure};
use super::{Failures, Findings, Law, Settings};
use crate::{
    CellNeighborhood, Landmark, PointCloud, SparseDistances, StratifiedLandmarks, Table,
    Triangulation, Triangulator,
};
use proptest::collection::vec;
use std::f64::consts::PI;

const SUBJECT: &str = "Triangulator";

/// An answer that can be used.
static ANSWER: Law = Law {
    subject: SUBJECT,
    name: "answer",
    says: "the complex is on the landmarks of the waist and has its curve edges; the corners of every triangle are \
           together in one neighborhood; what was dropped is a corner of nothing",
    look_for: "vertices that were renumbered; curve edges that were left out because no triangle has them; triangles \
               between neighborhoods; lists that are not in increasing order",
};

/// Reproducible.
static REPRODUCIBLE: Law = Law {
    subject: SUBJECT,
    name: "reproducible",
    says: "the same answer for the same waist",
    look_for: "the order of a hash map; a state that is kept from one call to the next; random numbers without a fixed \
               seed",
};

/// Scale.
static SCALE: Law = Law {
    subject: SUBJECT,
    name: "scale",
    says: "the same complex when all distances are multiplied by one number (powers of two, so that nothing is rounded)",
    look_for: "a length, an area or a tolerance in the unit of the data: make it a share of the edges at hand",
};

/// Told.
static TOLD: Law = Law {
    subject: SUBJECT,
    name: "told",
    says: "where no landmark was dropped and no star is called open, every landmark inside a cell has a closed star: its \
           link is one circle",
    look_for: "a star that was given up without a word; triangles that a repair removed and nobody put back; a star \
               that was closed twice, in two charts",
};

pub(super) static ALL: [&Law; 4] = [&ANSWER, &REPRODUCIBLE, &SCALE, &TOLD];

/// Landmarks spread over a round sphere, moved a little, by `jitter`: a waist without curves.
///
/// Neighborhoods reach 2.7 times the distance at which landmarks on a lattice of that density would stand.
fn sphere(jitter: &[[f64; 3]]) -> StratifiedLandmarks<f64> {
    let count = jitter.len();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let spacing = (4.0 * PI / count as f64).sqrt();
    let rows = jitter.iter().enumerate().flat_map(|(k, jitter)| {
        let z = 1.0 - (2 * k + 1) as f64 / count as f64;
        let (r, angle) = ((1.0 - z * z).sqrt(), golden * k as f64);
        let at = [r * angle.cos(), r * angle.sin(), z];
        let moved = [0, 1, 2].map(|i| at[i] + 0.15 * spacing * jitter[i]);
        let norm = moved.iter().map(|x| x * x).sum::<f64>().sqrt();
        moved.map(|x| x / norm)
    });
    let places = PointCloud::new(3, rows.collect()).expect("places on a sphere are finite");
    let apart = |a: Landmark, b: Landmark| {
        let square = places.squared_distance(a.index(), b.index());
        square.sqrt()
    };
    let neighborhoods: Vec<CellNeighborhood> = (0..count)
        .map(|center| {
            let center = Landmark::new(center);
            let near = |&other: &Landmark| apart(center, other) < 2.7 * spacing;
            let all = (0..count).map(Landmark::new);
            let mut members: Vec<Landmark> = all.filter(near).collect();
            members.sort_by(|&a, &b| {
                let order = apart(center, a).total_cmp(&apart(center, b));
                order.then(a.cmp(&b))
            });
            CellNeighborhood::new(center, members)
        })
        .collect();
    let distances =
        SparseDistances::within(count, &neighborhoods, apart).expect("members are landmarks");
    StratifiedLandmarks::new(Table::filled(count, 2), vec![], neighborhoods, distances)
        .expect("the distances are those of the neighborhoods")
}

/// The same waist with all distances multiplied by a number.
fn scaled(waist: &StratifiedLandmarks<f64>, factor: f64) -> StratifiedLandmarks<f64> {
    let apart = |a, b| factor * waist.distances().get(a, b).unwrap_or(f64::INFINITY);
    let (strata, near) = (waist.strata(), waist.neighborhoods());
    let distances =
        SparseDistances::within(strata.len(), near, apart).expect("members are landmarks");
    let edges = waist.curve_edges().to_vec();
    StratifiedLandmarks::new(strata.clone(), edges, near.to_vec(), distances)
        .expect("a waist by other distances is one")
}

/// Puts a triangulator through its laws, on waists of 12 to 70 landmarks of a round sphere that are spread not quite evenly.
///
/// Whether it closes stars at all is not judged here: one that gives up everywhere, and says so, passes.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// use crosscap_core::{
///     Complex, Error, Incomplete, StratifiedLandmarks, Triangulation, Triangulator,
/// };
/// /// Gives up everywhere.
/// struct Nothing;
/// impl Triangulator<f64> for Nothing {
///     fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
///         let count = waist.strata().len();
///         Ok(Triangulation {
///             complex: Complex::new(count, vec![], waist.curve_edges().to_vec())?,
///             dropped: vec![],
///             incomplete: waist.strata().ids().map(|landmark| Incomplete { landmark }).collect(),
///             counts: Default::default(),
///         })
///     }
///     fn name(&self) -> &str { "nothing" }
/// }
/// laws::triangulator(&Settings::default(), &Nothing).unwrap();
/// ```
pub fn triangulator(
    settings: &Settings,
    triangulator: &dyn Triangulator<f64>,
) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &ALL);
    let jitter = || vec([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], 12..=70);
    let put = |waist: &StratifiedLandmarks<f64>| {
        let answer = triangulator.triangulate(waist);
        answer.map_err(|e| format!("an error: {e}"))
    };
    found.put(ANSWER.holds(settings, &jitter(), |jitter| {
        let waist = sphere(jitter);
        let check = put(&waist)?.check(&waist, triangulator.name());
        check.map_err(|e| e.to_string())
    }));
    found.put(REPRODUCIBLE.holds(settings, &jitter(), |jitter| {
        let waist = sphere(jitter);
        let (first, second) = (put(&waist)?, put(&waist)?);
        ensure!(first == second, "asked twice: {first:?}, then {second:?}");
        Ok(())
    }));
    let inputs = (jitter(), -30..=30_i32);
    found.put(SCALE.holds(settings, &inputs, |(jitter, exponent)| {
        let waist = sphere(jitter);
        let factor = f64::from(*exponent).exp2();
        let (first, second) = (put(&waist)?, put(&scaled(&waist, factor))?);
        ensure!(
            first.complex == second.complex,
            "{:?}; scaled by {factor} {:?}",
            first.complex.triangles,
            second.complex.triangles
        );
        Ok(())
    }));
    found.put(TOLD.holds(settings, &jitter(), |jitter| {
        let waist = sphere(jitter);
        closed(&waist, &put(&waist)?)
    }));
    found.end()
}

/// Whether every landmark has a closed star, unless the triangulation says that something is missing.
fn closed(waist: &StratifiedLandmarks<f64>, found: &Triangulation) -> Outcome {
    if !(found.dropped.is_empty() && found.incomplete.is_empty()) {
        return Ok(());
    }
    for landmark in (0..).take(waist.strata().len()) {
        let star = found.complex.triangles.iter();
        let star = star.filter(|t| t.contains(&landmark));
        let sides: Vec<[u32; 2]> = star
            .map(|t| {
                let mut others = t.iter().copied().filter(|&v| v != landmark);
                [others.next().unwrap_or(0), others.next().unwrap_or(0)]
            })
            .collect();
        ensure!(
            is_circle(&sides),
            "nothing is called open, and the triangles at landmark {landmark} end in the edges {sides:?}"
        );
    }
    Ok(())
}

/// Whether edges make one circle.
fn is_circle(edges: &[[u32; 2]]) -> bool {
    let Some(&[start, mut at]) = edges.first() else {
        return false;
    };
    let mut left = edges[1..].to_vec();
    while at != start {
        let Some(next) = left.iter().position(|e| e.contains(&at)) else {
            return false;
        };
        let [a, b] = left.swap_remove(next);
        at = if a == at { b } else { a };
    }
    left.is_empty() && edges.len() > 2
}

#[cfg(test)]
mod tests {
    use super::super::twins::{each_is_caught, quick};
    use super::*;
    use crate::{Complex, Error, Incomplete, TriangulationCounts};
    use std::sync::atomic::{AtomicBool, Ordering};

    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Fault {
        None,
        /// A triangle across the sphere.
        Far,
        /// Another list at every second call.
        Turns,
        /// A triangle if its edges are shorter than 1.
        Length,
        /// Nothing is told.
        Silent,
    }

    /// Gives up everywhere, but for one triangle of the landmarks nearest to the first.
    struct Lazy(Fault, AtomicBool);

    impl Triangulator<f64> for Lazy {
        fn triangulate(&self, waist: &StratifiedLandmarks<f64>) -> Result<Triangulation, Error> {
            let count = waist.strata().len() as u32;
            let near = waist.neighborhoods()[0].members();
            let mut corners = [near[0], near[1], near[2]].map(u32::from);
            if self.0 == Fault::Far {
                corners = [0, 1, count - 1];
            }
            corners.sort_unstable();
            let long = waist.distances().get(near[0], near[1]) >= Some(1.0);
            let none = self.0 == Fault::Length && long;
            let again = self.1.fetch_not(Ordering::Relaxed) && self.0 == Fault::Turns;
            let open: Vec<Landmark> = match self.0 {
                Fault::Silent => vec![],
                _ => waist.strata().ids().skip(usize::from(again)).collect(),
            };
            let triangles = if none { vec![] } else { vec![corners] };
            Ok(Triangulation {
                complex: Complex::new(count as usize, triangles, vec![])?,
                dropped: vec![],
                incomplete: open
                    .into_iter()
                    .map(|landmark| Incomplete { landmark })
                    .collect(),
                counts: TriangulationCounts::default(),
            })
        }

        fn name(&self) -> &str {
            "lazy"
        }
    }

    #[test]
    fn each_fault_is_caught_by_its_law() {
        let put = |fault| triangulator(&quick(), &Lazy(fault, AtomicBool::new(false)));
        each_is_caught(
            put,
            Fault::None,
            &[
                (Fault::Far, &ANSWER),
                (Fault::Turns, &REPRODUCIBLE),
                (Fault::Length, &SCALE),
                (Fault::Silent, &TOLD),
            ],
        );
    }

    #[test]
    fn circles() {
        assert!(is_circle(&[[1, 2], [3, 1], [2, 3]]));
        assert!(!is_circle(&[[1, 2], [3, 2], [2, 3]]));
        assert!(!is_circle(&[[1, 2], [2, 3]]));
        assert!(!is_circle(&[]));
        let two = [[1, 2], [3, 1], [2, 3], [4, 5], [5, 6], [6, 4]];
        assert!(!is_circle(&two));
    }
}
