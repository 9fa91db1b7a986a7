//! What went wrong in an attempt, as far as it decides what to change.

use super::moves::Move;
use crate::pipeline::Outcome;
use crosscap_algorithms::certificate::{Level, Violation, ViolationKind};
use crosscap_core::Error;

/// What went wrong, the most telling first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symptom {
    /// A neighborhood holds too few points.
    Sparse,
    /// Neighborhoods that are neither flat nor explained by a model.
    Unexplained,
    /// What was taken for a curve is none, or is not resolved.
    Curves,
    /// Charts fold, or two sheets are mixed.
    Folds,
    /// Where the points end the mesh has too few edges to follow them: a hole with a short rim, an edge across the mouth of one.
    Coarse,
    /// Edges of the mesh end where nothing was found to end.
    Ends,
    /// Stars stay open, and what was taken for a closed surface has gaps.
    Torn,
    /// Stars stay open on what was taken for one surface that may end.
    Frayed,
    /// Stars stay open.
    Open,
    /// The mesh, or a curve of its own, covers gaps of the points, or a curve has too few landmarks.
    Gaps,
    /// Two sheets of points are one in the mesh.
    Merged,
    /// Points are left behind by a mesh with curves.
    Behind,
    /// Mesh and points are not near each other.
    Cover,
}

/// Points on curves from which on open cells are blamed on the curves.
const SOME: usize = 1;

impl Symptom {
    /// What went wrong in an attempt that failed.
    pub(super) fn of(outcome: &Result<Outcome, Error>) -> Self {
        let outcome = match outcome {
            Ok(outcome) => outcome,
            Err(Error::SparseNeighborhood { .. }) => return Self::Sparse,
            Err(Error::Dimension { .. }) => return Self::Unexplained,
            Err(_) => return Self::Open,
        };
        let found = |test: &dyn Fn(&Violation) -> bool| outcome.certificate.violations().any(test);
        let at_curves = found(&|v| {
            use ViolationKind::*;
            matches!(v.kind, WrongCount | UndeclaredCurve | CurveFold)
                || v.kind.level() == Level::Links
        });
        if outcome.report.curve_points >= SOME && (at_curves || !outcome.failures.is_empty()) {
            Self::Curves
        } else if !outcome.failures.is_empty()
            && outcome.report.parameters.is_closed()
            && found(&|v| v.kind == ViolationKind::BridgedGap)
        {
            Self::Torn
        } else if found(&|v| v.kind.level() == Level::Geometry && v.kind != ViolationKind::BareFold)
        {
            Self::Folds
        } else if !outcome.failures.is_empty() {
            let assumed = &outcome.report.parameters;
            if assumed.surface && !assumed.is_closed() {
                Self::Frayed
            } else {
                Self::Open
            }
        } else if Self::is_coarse(outcome) {
            Self::Coarse
        } else if found(&|v| v.kind.level() == Level::Edges) {
            Self::Ends
        } else if found(&|v| {
            use ViolationKind::*;
            matches!(v.kind, BridgedGap | BareStretch | BareFold)
        }) {
            Self::Gaps
        } else if found(&|v| v.kind == ViolationKind::MergedSheets) {
            Self::Merged
        } else if outcome.report.curve_points >= SOME
            && found(&|v| {
                use ViolationKind::*;
                matches!(v.kind, UncoveredPoints | UnusedLandmarks)
            })
        {
            Self::Behind
        } else {
            // Vertices off their points are badly placed landmarks, too.
            Self::Cover
        }
    }

    /// Whether all that is wrong is where the mesh ends, or a gap of the points.
    fn is_coarse(outcome: &Outcome) -> bool {
        use ViolationKind::*;
        let certificate = &outcome.certificate;
        let ends = (outcome.mesh.complex.curve_edges.iter()).any(|edge| edge.cells == 1);
        let at_ends = |v: &Violation| match v.kind {
            SmallHole => true,
            MeshFarFromPoints => ends,
            _ => false,
        };
        certificate.violations().any(at_ends)
            && (certificate.violations()).all(|v| at_ends(v) || v.kind == BridgedGap)
    }

    /// What is worth trying, in order. Of 756 clouds around one feature, 500 to 1500 points each, smaller neighborhoods passed at
    /// 71 of 219 attempts, one closed surface at 36 of 260, charts that unfold at 5 of 114, other landmarks by themselves at 17 of
    /// 60 the first time and never again. What scatter of the points across the surface can be why of is asked of larger neighborhoods first.
    pub(super) fn moves(self) -> &'static [Move] {
        use Move::*;
        match self {
            Self::Sparse => &[Spaced, Larger, Local, Closed, Ending],
            Self::Unexplained => &[Widened, Spaced, Closed, Ending, Smaller, Local],
            Self::Curves => &[
                Widened, Spaced, Smaller, Closed, Ending, Local, Finer, Unfolded,
            ],
            Self::Folds | Self::Open => &[
                Widened, Spaced, Creased, Smaller, Closed, Unfolded, Ending, Local, Finer,
            ],
            // Gaps that are no chance speak against a closed surface, whatever else is wrong.
            Self::Torn => &[
                Widened, Ending, Spaced, Creased, Smaller, Unfolded, Local, Finer,
            ],
            // What is left open is more often near the end, which a smaller neighborhood sees better, than at a crease.
            Self::Frayed => &[
                Widened, Spaced, Smaller, Creased, Closed, Unfolded, Local, Finer,
            ],
            Self::Coarse => &[Opened, Smaller, Ending, Finer, Spaced, Closed, Unfolded],
            Self::Ends => &[Widened, Ending, Spaced, Smaller, Closed, Unfolded],
            // A gap stays open where landmarks are nearer to each other than it is wide, if the mesh may end there.
            Self::Gaps => &[Opened, Smaller, Ending, Finer, Spaced],
            // Paths along the surface do not lead from one sheet to the other.
            Self::Merged => &[Closed, Ending, Finer, Unfolded, Smaller],
            // In a smaller neighborhood there is less beside the curve that its end could be taken for.
            Self::Behind => &[
                Widened, Smaller, Spaced, Closed, Finer, Ending, Unfolded, Local,
            ],
            Self::Cover => &[
                Widened, Spaced, Smaller, Closed, Finer, Ending, Unfolded, Local,
            ],
        }
    }
}
