//! What somebody knows about the holes of a surface.

use super::discs::Gap;
use serde::Serialize;
use std::fmt;

/// Gaps of the points that the mesh covers because somebody knows that the surface does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Covered {
    /// Width of the narrowest hole that the surface may have, in local spacings.
    pub least_hole: f64,
    /// How many places there are in the middle of a gap that is narrower and no chance. One gap may be found several times, as
    /// a disc and as chains of tiles.
    pub gaps: usize,
    /// Width of the widest of them, in local spacings; 0 without any.
    pub widest: f64,
}

impl Covered {
    /// Parts gaps that are no chance in those that may be holes, and the others.
    pub(super) fn split(gaps: Vec<&Gap>, least_hole: f64) -> (Vec<&Gap>, Self) {
        let (holes, narrow): (Vec<&Gap>, Vec<&Gap>) =
            gaps.into_iter().partition(|gap| gap.width >= least_hole);
        let covered = Self {
            least_hole,
            gaps: places(&narrow).len(),
            widest: narrow.iter().fold(0.0, |most, gap| gap.width.max(most)),
        };
        (holes, covered)
    }
}

/// The triangles that gaps are in the middle of, each once.
pub(super) fn places(gaps: &[&Gap]) -> Vec<u32> {
    let mut triangles: Vec<u32> = gaps.iter().map(|gap| gap.triangle).collect();
    triangles.sort_unstable();
    triangles.dedup();
    triangles
}

impl fmt::Display for Covered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            least_hole, gaps, ..
        } = self;
        write!(
            f,
            "given that no hole is narrower than {least_hole} spacings: "
        )?;
        match gaps {
            0 => f.write_str("no gap needed that"),
            1 => write!(f, "1 gap is covered, {:.1} wide", self.widest),
            _ => write!(f, "{gaps} gaps are covered, up to {:.1} wide", self.widest),
        }
    }
}
