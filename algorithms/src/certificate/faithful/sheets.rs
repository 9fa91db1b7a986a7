//! Sheets of points that the mesh takes for one, and vertices off their points.

use super::patch::Patch;
use super::search::Search;
use super::wings::Wings;
use crosscap_core::PointCloud;
use serde::Serialize;

/// Vertices that are looked at, at equal steps where there are more.
const LOOKED_AT: usize = 30_000;
/// Least number of points of a sheet, and least share of those that are looked at together.
const FEWEST: usize = 5;
const LEAST_SHARE: f64 = 0.08;
/// Least gap between sheets, in local spacings: below it rounding and bending are no less likely.
const LEAST_GAP: f64 = 0.05;
/// Least share of the points of the smaller sheet whose nearest point along the surface is one of the other: sheets lie
/// over each other, while the two sides of a step lie side by side.
const MIXED: f64 = 0.2;
/// A gap is this many times the scatter of the heights on its two sides, root mean square.
const CLEAR: f64 = 2.5;

/// Two sheets of points that are one in the mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Merged {
    /// Distance between them, in local spacings.
    pub apart: f64,
    /// The same, unit of the data.
    pub distance: f64,
    /// Probability that one sheet shows such a gap in its heights anywhere.
    pub p: f64,
    /// Vertex in the middle.
    pub vertex: u32,
}

/// A vertex that is off the points around it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Offset {
    /// Distance of the vertex to a quadratic patch through the points of a sheet at it, in local spacings.
    pub away: f64,
    /// What is allowed, in local spacings.
    pub allowed: f64,
    /// The vertex.
    pub vertex: u32,
}

/// What the sheets about the vertices say.
#[derive(Default)]
pub(super) struct Found {
    /// The least likely gaps in heights, least likely first.
    pub merged: Vec<Merged>,
    /// The worst offsets beyond what is allowed, worst first; the largest of all when none is.
    pub off: Vec<Offset>,
    /// Median scatter of the points about their patches, in local spacings.
    pub scatter: f64,
}

/// Looks at the sheets of all vertices.
pub(super) fn look(
    search: &Search<'_>,
    points: &PointCloud<f64>,
    level: f64,
    offset: f64,
) -> Found {
    let mesh = search.mesh;
    let mut wings = Wings::new(mesh, search.incidence, &search.standing);
    let mut patch = Patch::default();
    let mut found = Found::default();
    let mut scatters = Vec::new();
    let step = mesh.complex.vertices.div_ceil(LOOKED_AT).max(1);
    let tests = mesh.complex.vertices.div_ceil(step) as f64;
    let mut largest: Option<Offset> = None;
    let mut least: Option<Merged> = None;
    for v in (0..mesh.complex.vertices as u32).step_by(step) {
        let density = search.ground.density[v as usize];
        if density <= 0.0 {
            continue;
        }
        let spacing = 1.0 / density.sqrt();
        wings.at(v, |feet| {
            let rows = feet
                .iter()
                .map(|&k| points.point(search.feet.rows[k as usize] as usize));
            if !patch.fit(mesh.vertices.point(v as usize), rows) {
                return;
            }
            scatters.push(patch.scatter / spacing);
            let here = Offset {
                away: patch.offset / spacing,
                allowed: offset + 4.0 * patch.scatter / spacing * (1.0 + patch.leverage),
                vertex: v,
            };
            let beyond = |o: &Offset| o.away - o.allowed;
            if beyond(&here) > 0.0 {
                found.off.push(here);
            } else if largest.as_ref().is_none_or(|l| here.away > l.away) {
                largest = Some(here);
            }
            if let Some((gap, p)) = merged(&patch, spacing, tests) {
                let here = Merged {
                    apart: gap / spacing,
                    distance: gap,
                    p,
                    vertex: v,
                };
                if p < level {
                    found.merged.push(here);
                } else if least.as_ref().is_none_or(|l| p < l.p) {
                    least = Some(here);
                }
            }
        });
    }
    found.scatter = crate::certificate::quality::median(scatters);
    found
        .merged
        .sort_by(|a, b| a.p.total_cmp(&b.p).then(a.vertex.cmp(&b.vertex)));
    found.off.sort_by(|a, b| {
        let beyond = |o: &Offset| o.away - o.allowed;
        beyond(b)
            .total_cmp(&beyond(a))
            .then(a.vertex.cmp(&b.vertex))
    });
    if found.merged.is_empty() {
        found.merged.extend(least);
    }
    if found.off.is_empty() {
        found.off.extend(largest);
    }
    found
}

/// The largest inner gap of the heights of a patch, and how likely one of `tests` sheets shows one like it.
fn merged(patch: &Patch, spacing: f64, tests: f64) -> Option<(f64, f64)> {
    let count = patch.left.len();
    if count < 4 * FEWEST {
        return None;
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_unstable_by(|&a, &b| patch.left[a].total_cmp(&patch.left[b]).then(a.cmp(&b)));
    let height = |k: usize| patch.left[order[k]];
    let range = height(count - 1) - height(0);
    let fewest = FEWEST.max((LEAST_SHARE * count as f64).ceil() as usize);
    let (mut gap, mut cut) = (0.0, 0);
    for k in fewest..=count - fewest {
        let here = height(k) - height(k - 1);
        if here > gap {
            (gap, cut) = (here, k);
        }
    }
    let large = gap > LEAST_GAP * spacing && gap > CLEAR * scatter_of_sides(patch, &order, cut);
    if !large || !mixed(patch, &order, cut) {
        return None;
    }
    let share = gap / range;
    let p = tests * count as f64 * (1.0 - share).powi(count as i32 - 2);
    Some((gap, p.min(1.0)))
}

/// Root mean square of the heights about the mean of their side.
fn scatter_of_sides(patch: &Patch, order: &[usize], cut: usize) -> f64 {
    let mut sum = 0.0;
    for side in [&order[..cut], &order[cut..]] {
        let mean = side.iter().map(|&k| patch.left[k]).sum::<f64>() / side.len() as f64;
        sum += side
            .iter()
            .map(|&k| (patch.left[k] - mean).powi(2))
            .sum::<f64>();
    }
    (sum / order.len() as f64).sqrt()
}

/// Whether the points of the two sides lie among each other along the surface.
fn mixed(patch: &Patch, order: &[usize], cut: usize) -> bool {
    let (low, high) = order.split_at(cut);
    let (few, many) = if low.len() < high.len() {
        (low, high)
    } else {
        (high, low)
    };
    let square = |a: usize, b: usize| {
        let ([u, v], [s, t]) = (patch.flat[a], patch.flat[b]);
        (u - s).powi(2) + (v - t).powi(2)
    };
    let nearest = |k: usize, among: &[usize]| {
        let others = among.iter().filter(|&&other| other != k);
        others
            .map(|&other| square(k, other))
            .fold(f64::INFINITY, f64::min)
    };
    let across = few
        .iter()
        .filter(|&&k| nearest(k, many) < nearest(k, few))
        .count();
    across as f64 >= MIXED * few.len() as f64
}
