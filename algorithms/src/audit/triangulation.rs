//! The plug-ins of the triangulation: they answer millions of questions and cannot fail, so a fault is
//! remembered here and asked for after every star.

use super::broken;
use crosscap_core::{
    Chart, ChartTriangle, CompatibilityTest, Error, Landmark, LocalChart, Meeting, TriangleRule,
};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

/// One answer in so many is asked for a second time, the other way round.
const EVERY: u32 = 16;

/// The fault that was found, and where the triangulation is.
#[derive(Default)]
pub(crate) struct Watch {
    fault: OnceLock<Error>,
    at: AtomicUsize,
}

impl Watch {
    /// The landmark whose star is closed next.
    pub(crate) fn enter(&self, landmark: Landmark) {
        self.at.store(landmark.index(), Ordering::Relaxed);
    }

    /// # Errors
    /// The first fault.
    pub(crate) fn none(&self) -> Result<(), Error> {
        self.fault.get().map_or(Ok(()), |e| Err(e.clone()))
    }

    fn report(&self, plugin: &str, law: &'static str, detail: String) {
        let point = self.at.load(Ordering::Relaxed);
        if let Err(error) = broken::<()>(plugin, law, point, detail) {
            // A later fault does not matter.
            let _ = self.fault.set(error);
        }
    }
}

/// Whether this is the one answer in so many.
fn turn(calls: &AtomicU32) -> bool {
    calls.fetch_add(1, Ordering::Relaxed).is_multiple_of(EVERY)
}

/// A chart whose answers are checked: finite coordinates, as many as asked for, and a distortion that is a share.
pub(crate) struct AuditedChart<'a> {
    pub(crate) chart: &'a dyn LocalChart,
    pub(crate) watch: &'a Watch,
}

impl LocalChart for AuditedChart<'_> {
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
        let found = self.chart.chart(count, distances, dimension)?;
        let point = self.watch.at.load(Ordering::Relaxed);
        let law = "finite: finite distances give finite coordinates, count * dimension of them";
        if found.coordinates.len() != count * dimension || found.dimension != dimension {
            let detail = format!(
                "{} coordinates in dimension {} for {count} points in dimension {dimension}",
                found.coordinates.len(),
                found.dimension
            );
            return broken(self.name(), law, point, detail);
        }
        if let Some(k) = found.coordinates.iter().position(|c| !c.is_finite()) {
            let detail = format!("{} for member {}", found.coordinates[k], k / dimension);
            return broken(self.name(), law, point, detail);
        }
        if !(0.0..=1.0).contains(&found.distortion) {
            let law = "distortion: a share, 0 for flat data and at most 1";
            return broken(self.name(), law, point, format!("{}", found.distortion));
        }
        Ok(found)
    }

    fn name(&self) -> &str {
        self.chart.name()
    }
}

/// A compatibility test that is asked the other way round now and then.
pub(crate) struct AuditedTest<'a> {
    pub(crate) test: &'a dyn CompatibilityTest,
    pub(crate) watch: &'a Watch,
    pub(crate) calls: AtomicU32,
}

impl CompatibilityTest for AuditedTest<'_> {
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
        let found = self.test.meeting(a, b);
        if turn(&self.calls) {
            let back = self.test.meeting(b, a);
            if back != found {
                let detail = format!("{found:?} of {a:?} and {b:?}, {back:?} the other way round");
                let law = "symmetry: meeting(a, b) == meeting(b, a)";
                self.watch.report(self.test.name(), law, detail);
            }
        }
        found
    }

    fn compatible(&self, a: &ChartTriangle, b: &ChartTriangle) -> bool {
        let found = self.test.compatible(a, b);
        // Two that may not stand together are few, and decide what is built.
        if (!found || turn(&self.calls)) && self.test.compatible(b, a) != found {
            let detail = format!(
                "{found} for {a:?} and {b:?}, {} the other way round",
                !found
            );
            let law = "symmetry: compatible(a, b) == compatible(b, a)";
            self.watch.report(self.test.name(), law, detail);
        }
        found
    }

    fn name(&self) -> &str {
        self.test.name()
    }
}

/// Two triangles on the corners of which little can be said but how they meet: apart, at a corner, along a side, across
/// each other with a common corner and without.
const KNOWN: [([[f64; 2]; 3], [u32; 3], Meeting); 5] = [
    (
        [[3.0, 3.0], [4.0, 3.0], [3.0, 4.0]],
        [3, 4, 5],
        Meeting::Disjoint,
    ),
    (
        [[0.0, 0.0], [-1.0, -0.1], [-0.2, -1.0]],
        [0, 3, 4],
        Meeting::CommonFace,
    ),
    (
        [[1.0, 0.0], [0.0, 1.0], [1.1, 1.2]],
        [1, 2, 3],
        Meeting::CommonFace,
    ),
    (
        [[0.0, 0.0], [1.1, 0.2], [0.3, 1.3]],
        [0, 3, 4],
        Meeting::Overlap,
    ),
    (
        [[0.2, 0.3], [1.4, 0.4], [0.3, 1.2]],
        [3, 4, 5],
        Meeting::Overlap,
    ),
];

/// Asks a test about triangles of known position, of about the size of those at hand, both ways round.
///
/// # Errors
/// [`Error::Law`] for a wrong answer.
pub(crate) fn known_pairs(test: &dyn CompatibilityTest, size: f64) -> Result<(), Error> {
    let scaled = |places: [[f64; 2]; 3]| places.map(|p| p.map(|c| c * size));
    let a = ChartTriangle {
        corners: [0, 1, 2].map(Landmark::new),
        places: scaled([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    };
    for (places, corners, expected) in KNOWN {
        let b = ChartTriangle {
            corners: corners.map(Landmark::from),
            places: scaled(places),
        };
        let found = [test.meeting(&a, &b), test.meeting(&b, &a)];
        let allowed = [test.compatible(&a, &b), test.compatible(&b, &a)];
        if found[0] != found[1] || allowed[0] != allowed[1] {
            let detail = format!(
                "{found:?}, compatible {allowed:?}, for {a:?} and {b:?} and the other way round"
            );
            return broken(
                test.name(),
                "symmetry: meeting(a, b) == meeting(b, a)",
                0,
                detail,
            );
        }
        if found[0] != expected || allowed[0] != (expected != Meeting::Overlap) {
            let detail = format!("{:?} for {a:?} and {b:?}, expected {expected:?}", found[0]);
            return broken(
                test.name(),
                "reference: the answer of the linear program",
                0,
                detail,
            );
        }
    }
    Ok(())
}

/// A triangle rule whose ranks are checked.
pub(crate) struct AuditedRule<'a> {
    pub(crate) rule: &'a dyn TriangleRule,
    pub(crate) watch: &'a Watch,
    pub(crate) calls: AtomicU32,
}

impl TriangleRule for AuditedRule<'_> {
    fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
        let rank = self.rule.rank(edge, a, b);
        let name = self.rule.name();
        if rank.is_nan() {
            let detail = format!("NaN for sides {edge}, {a}, {b}");
            self.watch.report(name, "degenerate: never NaN", detail);
        } else if turn(&self.calls) {
            let back = self.rule.rank(edge, b, a);
            // Infinities are equal to themselves.
            if rank != back && (rank - back).abs() > 1e-9 * (rank.abs() + back.abs()) + 1e-12 {
                let detail = format!(
                    "{rank} for sides {edge}, {a}, {b}, {back} with the last two exchanged"
                );
                let law = "symmetry: the same rank when the ends of the edge are exchanged";
                self.watch.report(name, law, detail);
            }
            let flat = self.rule.rank(edge, 0.5 * edge, 0.5 * edge);
            if flat != f64::INFINITY {
                let half = 0.5 * edge;
                let detail = format!("{flat} for sides {edge}, {half}, {half}");
                let law = "degenerate: a triangle without area ranks last (infinity)";
                self.watch.report(name, law, detail);
            }
        }
        rank
    }

    fn name(&self) -> &str {
        self.rule.name()
    }
}
