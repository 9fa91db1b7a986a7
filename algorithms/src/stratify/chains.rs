//! Chains: landmarks along the curves, and the edges that join them.

use super::analysis::{Analysis, Analyzer, Role};
use super::cells::{Reference, references};
use super::waist::PointStratum;
use crosscap_core::{CurveEdge, Scalar, squared_distance};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Landmarks on points and curves, with the chains.
#[derive(Default)]
pub(super) struct Curves {
    /// Rows of the landmarks, points (corners) first.
    pub(super) rows: Vec<usize>,
    /// How many of them are points.
    pub(super) corners: usize,
    /// How many cells meet in the curve of each landmark, in the order of `rows`; 0 for points.
    cells: Vec<u8>,
    /// Chain edges between positions in `rows`.
    pub(super) edges: Vec<CurveEdge>,
    /// References of the corners, in the order of `rows`, where there is one.
    pub(super) corner_references: Vec<Reference>,
}

/// Spacing of the curve points that chains are laid over, as a share of dl.
pub(super) const NODE_SPACING: f64 = 0.125;
/// Curve points closer than this share of dl are one curve.
const REACH: f64 = 1.0;
/// The same where no surface is near that could carry another curve.
const BARE_REACH: f64 = 2.0;
/// Two ends of curves that point at each other are joined over a gap of at most this many dl between
/// their points, before landmarks are laid.
const BRIDGE: f64 = 2.0;
/// A chain that stops at nothing has a landmark at its end; the next one is this share of dl away.
const END_SEPARATION: f64 = 0.6;
/// A chain is joined to a corner, or two free ends to each other, over at most this many dl.
const JOIN: f64 = 3.0;
/// Separations along a curve that are tried, as multiples of dl: the closing gap of a
/// closed curve depends on it, and long edges are the bad ones.
const STRETCHES: usize = 16;
const STRETCH_STEP: f64 = 0.025;

/// Longest edge, landmarks and edges of a chain.
type Laid = (f64, Vec<usize>, Vec<(usize, usize)>);

impl Curves {
    pub(super) fn new<S: Scalar>(analyzer: &Analyzer<'_, S>, analysis: &Analysis, dl: f64) -> Self {
        let mut out = Self::default();
        let corners = thin(analyzer, analysis, dl, |r| r == Role::Corner);
        out.corner_references = references(analyzer, analysis, &corners);
        out.rows = corners;
        out.corners = out.rows.len();
        out.cells = vec![0; out.corners];
        for kind in [Role::Boundary, Role::Curve] {
            out.lay(analyzer, analysis, dl, kind);
        }
        out.join_free_ends(analysis, dl);
        out.edges.sort_unstable();
        out.edges.dedup_by_key(|e| e.ends);
        out
    }

    /// The corners that models call 0-strata.
    pub(super) fn points(&self) -> Vec<PointStratum> {
        self.corner_references
            .iter()
            .filter(|r| r.has_points())
            .filter_map(|r| {
                let landmark = self.rows[..self.corners].iter().position(|&c| c == r.row)?;
                let count = |d| r.fit.strata.iter().filter(|s| s.dimension == d).count();
                Some(PointStratum {
                    landmark: landmark as u32,
                    curves: count(1),
                    cells: count(2),
                })
            })
            .collect()
    }

    fn lay<S: Scalar>(
        &mut self,
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        dl: f64,
        kind: Role,
    ) {
        let places = &analysis.places;
        let distance =
            |a: usize, b: usize| squared_distance(places.point(a), places.point(b)).sqrt();
        let mut rows = thin(analyzer, analysis, NODE_SPACING * dl, |r| r == kind);
        let label = |row: usize| -> Option<(usize, u8)> {
            self.corner_references
                .iter()
                .enumerate()
                .filter_map(|(k, r)| Some((distance(r.row, row), k, r.label(row)?)))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .filter(|&(d, k, _)| d < self.corner_references[k].radius)
                .map(|(_, k, l)| (k, l))
        };
        // Next to a corner the points of a boundary are in the band of both sheets: which
        // branch they are on cannot be told, and the corner stands for them.
        rows.retain(|&row| {
            self.rows[..self.corners]
                .iter()
                .all(|&c| distance(c, row) > NODE_SPACING * dl)
                && label(row).is_none_or(|(k, l)| {
                    let corner = &self.corner_references[k];
                    match kind {
                        Role::Curve => !corner.is_point(l),
                        _ => corner.is_cell(l) || distance(corner.row, row) > dl,
                    }
                })
        });
        let mut labels: Vec<Option<(usize, u8)>> = rows.iter().map(|&row| label(row)).collect();
        if kind == Role::Curve {
            // Only 0-strata tell arcs apart. Where the bands of two arcs run together, the nearest point that is
            // on one arc alone decides.
            let on_arc: Vec<(usize, (usize, u8))> = rows
                .iter()
                .zip(&labels)
                .filter_map(|(&row, &found)| Some((row, found?)))
                .filter(|&(_, (k, l))| {
                    let corner = &self.corner_references[k];
                    corner.has_points() && corner.is_curve(l)
                })
                .collect();
            for (found, &row) in labels.iter_mut().zip(&rows) {
                *found = found.and_then(|(k, l)| {
                    let own = on_arc.iter().filter(|x| x.1.0 == k);
                    if self.corner_references[k].is_curve(l) {
                        return self.corner_references[k].has_points().then_some((k, l));
                    }
                    own.min_by(|a, b| distance(a.0, row).total_cmp(&distance(b.0, row)))
                        .map(|x| x.1)
                });
            }
        }
        let mut graph: Vec<Vec<(usize, f64)>> = vec![Vec::new(); rows.len()];
        let mut near = Vec::new();
        let mut at = vec![usize::MAX; analysis.roles.len()];
        for (k, &row) in rows.iter().enumerate() {
            at[row] = k;
        }
        let slack = 2.0
            * rows
                .iter()
                .map(|&r| analysis.offsets[r])
                .fold(0.0, f64::max);
        let parted = |k: usize, other: usize| {
            matches!((labels[k], labels[other]), (Some(a), Some(b)) if a.0 == b.0 && a.1 != b.1)
                || kind == Role::Curve
                    && (analysis.cells[rows[k]] == 0) != (analysis.cells[rows[other]] == 0)
        };
        for (k, &row) in rows.iter().enumerate() {
            let reach = if kind == Role::Curve && analysis.cells[row] == 0 {
                BARE_REACH * dl
            } else {
                REACH * dl
            };
            analyzer.oracle.within(row, S::of(reach + slack), &mut near);
            for x in &near {
                let other = at[x.index];
                if other == usize::MAX || other == k {
                    continue;
                }
                let d = distance(row, x.index);
                if d <= reach && !parted(k, other) {
                    graph[k].push((other, d));
                }
            }
        }
        let first_corner = rows.len();
        let mut parts = components(&graph, first_corner);
        let mut part = vec![usize::MAX; rows.len()];
        for (p, members) in parts.iter().enumerate() {
            members.iter().for_each(|&k| part[k] = p);
        }
        // Corners are nodes behind the others, each joined to the nearest node of every branch. A
        // part of a curve that does not reach farther than dl from the corner is none: it has no room for
        // a landmark, and would stand between the corner and its curve.
        for c in 0..self.corners {
            graph.push(Vec::new());
            let row = self.rows[c];
            let mut branches: Vec<(u8, usize, f64)> = Vec::new();
            let stub: Vec<bool> = parts
                .iter()
                .map(|members| members.iter().all(|&k| distance(row, rows[k]) < dl))
                .collect();
            let at_points = self
                .corner_references
                .iter()
                .any(|r| r.row == row && r.has_points());
            for (k, &other) in rows.iter().enumerate() {
                let d = distance(row, other);
                if d > JOIN * dl || stub[part[k]] {
                    continue;
                }
                let branch = match (kind, labels[k]) {
                    (Role::Boundary, Some((_, l))) => l,
                    (Role::Curve, Some((at, l))) if self.corner_references[at].row == row => l,
                    (Role::Boundary, None) => continue,
                    (Role::Curve, _) if at_points => continue,
                    _ => 0,
                };
                match branches.iter_mut().find(|b| b.0 == branch) {
                    Some(b) if d < b.2 => *b = (branch, k, d),
                    Some(_) => {}
                    None => branches.push((branch, k, d)),
                }
            }
            for (_, k, d) in branches {
                graph[first_corner + c].push((k, d));
                graph[k].push((first_corner + c, d));
            }
        }
        let bare = |k: usize| kind == Role::Curve && analysis.cells[rows[k]] == 0;
        // What is next to a bare curve says where it ends, and its points are joined over as much anyway.
        let ends: Vec<Vec<usize>> = parts
            .iter()
            .filter(|members| members.iter().all(|&k| !bare(k)))
            .map(|members| {
                free_ends(&graph, members, first_corner, |a, b| {
                    distance(rows[a], rows[b])
                })
            })
            .collect();
        let place = |k: usize| places.point(rows[k]);
        let bridges = bridges(&graph, &ends, place, BRIDGE * dl, parted);
        for &(a, b, d) in &bridges {
            graph[a].push((b, d));
            graph[b].push((a, d));
        }
        if !bridges.is_empty() {
            parts = components(&graph, first_corner);
        }
        for members in &parts {
            self.lay_component(analysis, dl, kind, &rows, &graph, members, first_corner);
        }
    }

    /// Landmarks and chain edges of one connected curve.
    #[allow(clippy::too_many_arguments)]
    fn lay_component(
        &mut self,
        analysis: &Analysis,
        dl: f64,
        kind: Role,
        rows: &[usize],
        graph: &[Vec<(usize, f64)>],
        component: &[usize],
        first_corner: usize,
    ) {
        let places = &analysis.places;
        let distance =
            |a: usize, b: usize| squared_distance(places.point(a), places.point(b)).sqrt();
        let anchors: Vec<usize> = (first_corner..graph.len())
            .filter(|&c| {
                graph[c]
                    .iter()
                    .any(|(k, _)| component.binary_search(k).is_ok())
            })
            .collect();
        let inside = |k: usize| component.binary_search(&k).is_ok();
        // A sweep from an end of the curve, or from anywhere on a closed one.
        let start = anchors.first().copied().unwrap_or_else(|| {
            let (order, _) = sweep(graph, &[component[0]], inside);
            order.last().map_or(component[0], |&(k, _)| k)
        });
        let (order, _) = sweep(graph, &[start], inside);
        let before = self.rows.len();
        // Where a bare curve ends it has a landmark.
        let bare = kind == Role::Curve && component.iter().all(|&k| analysis.cells[rows[k]] == 0);
        let ends: Vec<usize> = if bare {
            free_ends(graph, component, first_corner, |a, b| {
                distance(rows[a], rows[b])
            })
        } else {
            Vec::new()
        };
        let mut best: Option<Laid> = None;
        for stretch in 0..STRETCHES {
            let separation = dl * (1.0 + STRETCH_STEP * stretch as f64);
            let mut chosen: Vec<usize> = Vec::new();
            for &(k, _) in order.iter().filter(|&&(k, _)| k < first_corner) {
                let row = rows[k];
                let free = chosen
                    .iter()
                    .rev()
                    .all(|&c| distance(rows[c], row) >= separation)
                    && self.rows[..before].iter().all(|&r| distance(r, row) >= dl);
                if free {
                    chosen.push(k);
                }
            }
            for &end in &ends {
                chosen.retain(|&c| {
                    ends.contains(&c) || distance(rows[c], rows[end]) >= END_SEPARATION * separation
                });
                if !chosen.contains(&end) {
                    chosen.push(end);
                }
            }
            let sources: Vec<usize> = anchors.iter().chain(&chosen).copied().collect();
            let edges = adjacent(graph, &sources, |k| inside(k) || anchors.contains(&k));
            let row_of = |k: usize| {
                if k < first_corner {
                    rows[k]
                } else {
                    self.rows[k - first_corner]
                }
            };
            let edges = without_triangles(edges, |a, b| distance(row_of(a), row_of(b)));
            let longest = edges
                .iter()
                .map(|&(a, b)| distance(row_of(a), row_of(b)))
                .fold(0.0, f64::max);
            if best.as_ref().is_none_or(|b| longest < b.0 * (1.0 - 1e-12)) {
                best = Some((longest, chosen, edges));
            }
        }
        let Some((_, chosen, edges)) = best else {
            return;
        };
        let cells = match kind {
            Role::Boundary => 1,
            // What most points of the curve say.
            _ => {
                let mut votes = [0usize; 256];
                for &k in component {
                    votes[analysis.cells[rows[k]] as usize] += 1;
                }
                (0..=255).max_by_key(|&c| votes[c as usize]).unwrap_or(0)
            }
        };
        self.rows.extend(chosen.iter().map(|&k| rows[k]));
        self.cells.resize(self.rows.len(), cells);
        let position = |k: usize| {
            if k >= first_corner {
                k - first_corner
            } else {
                // Sources are corners or chosen, so it is there.
                before + chosen.iter().position(|&c| c == k).unwrap_or(0)
            }
        };
        for (a, b) in edges {
            self.edges.push(CurveEdge::new(
                position(a) as u32,
                position(b) as u32,
                cells,
            ));
        }
    }

    /// Joins ends of chains that stop at nothing, and landmarks of curves that no chain reached, nearest
    /// pairs first: where the points of a curve have a gap.
    fn join_free_ends(&mut self, analysis: &Analysis, dl: f64) {
        let mut degree = vec![0u32; self.rows.len()];
        for end in self.edges.iter().flat_map(|e| e.ends) {
            degree[end as usize] += 1;
        }
        let cells = std::mem::take(&mut self.cells);
        let free: Vec<usize> = (self.corners..self.rows.len())
            .filter(|&k| degree[k] < 2)
            .collect();
        let mut pairs = Vec::new();
        for (x, &a) in free.iter().enumerate() {
            for &b in &free[..x] {
                let joined = self.edges.iter().any(|e| e.ends == [b as u32, a as u32]);
                let d = analysis
                    .places
                    .squared_distance(self.rows[a], self.rows[b])
                    .sqrt();
                if cells[a] == cells[b] && d <= JOIN * dl && !joined {
                    pairs.push((d, b, a));
                }
            }
        }
        pairs.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        for (_, a, b) in pairs {
            if degree[a] < 2 && degree[b] < 2 {
                degree[a] += 1;
                degree[b] += 1;
                self.edges
                    .push(CurveEdge::new(a as u32, b as u32, cells[a]));
            }
        }
    }
}

/// Rows of the given role, those moved least first, with pairwise distance at least `spacing`.
fn thin<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &Analysis,
    spacing: f64,
    role: impl Fn(Role) -> bool,
) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..analysis.roles.len())
        .filter(|&i| role(analysis.roles[i]))
        .collect();
    rows.sort_by(|&a, &b| {
        analysis.offsets[a]
            .total_cmp(&analysis.offsets[b])
            .then(a.cmp(&b))
    });
    let slack = rows
        .iter()
        .map(|&r| analysis.offsets[r])
        .fold(0.0, f64::max);
    let mut blocked = vec![false; analysis.roles.len()];
    let mut near = Vec::new();
    let mut kept = Vec::new();
    for row in rows {
        if blocked[row] {
            continue;
        }
        kept.push(row);
        analyzer.oracle.within(
            row,
            S::of(spacing + slack + analysis.offsets[row]),
            &mut near,
        );
        for x in &near {
            if role(analysis.roles[x.index])
                && analysis.places.squared_distance(row, x.index) < spacing * spacing
            {
                blocked[x.index] = true;
            }
        }
    }
    kept
}

/// More rows on curves whose decompositions label their surroundings: `spacing` apart from each
/// other and from `known`.
pub(super) fn more_references<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &Analysis,
    spacing: f64,
    known: &[usize],
) -> Vec<Reference> {
    let rows: Vec<usize> = thin(analyzer, analysis, spacing, |r| r == Role::Curve)
        .into_iter()
        .filter(|r| !known.contains(r))
        .collect();
    references(analyzer, analysis, &rows)
}

/// The connected parts of a graph without its corners, each in order of its nodes.
fn components(graph: &[Vec<(usize, f64)>], first_corner: usize) -> Vec<Vec<usize>> {
    let mut seen = vec![false; first_corner];
    let mut parts = Vec::new();
    for start in 0..first_corner {
        if !seen[start] {
            parts.push(component(graph, start, first_corner, &mut seen));
        }
    }
    parts
}

/// The ends of a part of a curve that stop at nothing: no corner is joined to them, and all that is near
/// them is on one side. None on a closed curve; a single node is one end.
fn free_ends(
    graph: &[Vec<(usize, f64)>],
    part: &[usize],
    first_corner: usize,
    distance: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    let inside = |k: usize| part.binary_search(&k).is_ok();
    let farthest = |from: usize| sweep(graph, &[from], inside).0.last().map_or(from, |x| x.0);
    let one = farthest(part[0]);
    let other = farthest(one);
    let mut ends = vec![one, other];
    ends.dedup();
    ends.retain(|&end| {
        let around = &graph[end];
        let far = around.iter().map(|x| x.1).fold(0.0, f64::max);
        around.iter().all(|&(k, _)| k < first_corner)
            && around
                .iter()
                .enumerate()
                .all(|(x, &(a, _))| around[..x].iter().all(|&(b, _)| distance(a, b) <= far))
    });
    ends
}

/// Pairs of free ends that go on where the other stops, at most `limit` apart, nearest first and each end
/// once: where the points of a curve have a gap. A part of a single node takes two.
fn bridges<'p>(
    graph: &[Vec<(usize, f64)>],
    ends: &[Vec<usize>],
    place: impl Fn(usize) -> &'p [f64],
    limit: f64,
    parted: impl Fn(usize, usize) -> bool,
) -> Vec<(usize, usize, f64)> {
    // Whether `to` is ahead of the end of a curve.
    let ahead = |end: usize, to: usize| {
        let back = graph[end].iter().max_by(|a, b| a.1.total_cmp(&b.1));
        back.is_none_or(|&(back, _)| {
            let [p, q, r] = [back, end, to].map(&place);
            (0..p.len())
                .map(|i| (q[i] - p[i]) * (r[i] - q[i]))
                .sum::<f64>()
                > 0.0
        })
    };
    let mut free: Vec<usize> = ends.iter().flatten().copied().collect();
    free.sort_unstable();
    let mut pairs = Vec::new();
    for (x, &a) in free.iter().enumerate() {
        for &b in &free[..x] {
            let d = squared_distance(place(a), place(b)).sqrt();
            let joined = graph[a].iter().any(|&(k, _)| k == b);
            if d <= limit && !joined && !parted(a, b) && ahead(a, b) && ahead(b, a) {
                pairs.push((d, b, a));
            }
        }
    }
    pairs.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut slots: Vec<usize> = free
        .iter()
        .map(|&k| if graph[k].is_empty() { 2 } else { 1 })
        .collect();
    let mut out = Vec::new();
    for (d, a, b) in pairs {
        let at = [a, b].map(|k| free.binary_search(&k).unwrap_or(0));
        if at.iter().all(|&i| slots[i] > 0) {
            at.iter().for_each(|&i| slots[i] -= 1);
            out.push((a, b, d));
        }
    }
    out
}

fn component(
    graph: &[Vec<(usize, f64)>],
    start: usize,
    first_corner: usize,
    seen: &mut [bool],
) -> Vec<usize> {
    let mut out = vec![start];
    seen[start] = true;
    let mut at = 0;
    while at < out.len() {
        for &(k, _) in &graph[out[at]] {
            if k < first_corner && !seen[k] {
                seen[k] = true;
                out.push(k);
            }
        }
        at += 1;
    }
    out.sort_unstable();
    out
}

/// Nodes in order of their path length from `sources`, and the source each belongs to.
fn sweep(
    graph: &[Vec<(usize, f64)>],
    sources: &[usize],
    inside: impl Fn(usize) -> bool,
) -> (Vec<(usize, f64)>, Vec<usize>) {
    let mut owner = vec![usize::MAX; graph.len()];
    let mut heap = BinaryHeap::new();
    // Path lengths as integers order like the numbers themselves: both are non-negative.
    for &s in sources {
        heap.push(Reverse((0f64.to_bits(), s, s)));
    }
    let mut order = Vec::new();
    while let Some(Reverse((bits, node, source))) = heap.pop() {
        if owner[node] != usize::MAX {
            continue;
        }
        owner[node] = source;
        let length = f64::from_bits(bits);
        order.push((node, length));
        for &(next, d) in &graph[node] {
            if owner[next] == usize::MAX && inside(next) {
                heap.push(Reverse(((length + d).to_bits(), next, source)));
            }
        }
    }
    (order, owner)
}

/// Pairs of sources whose geodesic Voronoi cells touch.
fn adjacent(
    graph: &[Vec<(usize, f64)>],
    sources: &[usize],
    inside: impl Fn(usize) -> bool,
) -> Vec<(usize, usize)> {
    let (_, owner) = sweep(graph, sources, inside);
    let mut edges = Vec::new();
    for (a, row) in graph.iter().enumerate() {
        for &(b, _) in row {
            let (p, q) = (owner[a], owner[b]);
            if p < q && q != usize::MAX {
                edges.push((p, q));
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Drops the longest edge of every triangle: a chain is a path, a triangle a shortcut.
fn without_triangles(
    mut edges: Vec<(usize, usize)>,
    length: impl Fn(usize, usize) -> f64,
) -> Vec<(usize, usize)> {
    edges.sort_by(|&(a, b), &(c, d)| {
        length(a, b)
            .total_cmp(&length(c, d))
            .then((a, b).cmp(&(c, d)))
    });
    let mut kept: Vec<(usize, usize)> = Vec::new();
    for (a, b) in edges {
        let around = |v: usize| -> Vec<usize> {
            kept.iter()
                .filter_map(|&(p, q)| {
                    if p == v {
                        Some(q)
                    } else if q == v {
                        Some(p)
                    } else {
                        None
                    }
                })
                .collect()
        };
        let other = around(b);
        if !around(a).iter().any(|x| other.contains(x)) {
            kept.push((a, b));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes within `reach` of each other joined.
    fn graph(places: &[[f64; 2]], reach: f64) -> Vec<Vec<(usize, f64)>> {
        let far = |a: usize, b: usize| squared_distance(&places[a], &places[b]).sqrt();
        (0..places.len())
            .map(|a| {
                let near = (0..places.len()).filter(|&b| b != a && far(a, b) <= reach);
                near.map(|b| (b, far(a, b))).collect()
            })
            .collect()
    }

    fn found(places: &[[f64; 2]]) -> Vec<[usize; 2]> {
        let graph = graph(places, 1.0);
        let distance = |a: usize, b: usize| squared_distance(&places[a], &places[b]).sqrt();
        let ends: Vec<Vec<usize>> = components(&graph, places.len())
            .iter()
            .map(|part| free_ends(&graph, part, places.len(), distance))
            .collect();
        let found = bridges(&graph, &ends, |k| &places[k][..], BRIDGE, |_, _| false);
        found.iter().map(|&(a, b, _)| [a, b]).collect()
    }

    fn circle(turns: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
        turns
            .map(|t| std::f64::consts::TAU * t)
            .map(|t| [5.0 * t.cos(), 5.0 * t.sin()])
            .collect()
    }

    #[test]
    fn a_closed_curve_is_closed_over_a_gap_of_its_points() {
        let steps = |k: usize| k as f64 / 100.0;
        assert_eq!(found(&circle((0..100).map(steps))), [] as [[usize; 2]; 0]);
        assert_eq!(found(&circle((0..97).map(steps))), [[0, 96]]);
        assert_eq!(found(&circle((0..92).map(steps))), [] as [[usize; 2]; 0]);
        let two_gaps: Vec<_> = circle((0..97).filter(|k| !(40..43).contains(k)).map(steps));
        assert_eq!(found(&two_gaps), [[39, 40], [0, 93]]);
    }

    #[test]
    fn ends_side_by_side_are_not_joined() {
        let side = |y: f64| (0..20).map(move |k| [0.25 * f64::from(k), y]);
        let places: Vec<_> = side(0.0).chain(side(1.4)).collect();
        assert_eq!(found(&places), [] as [[usize; 2]; 0]);
    }

    #[test]
    fn a_bare_curve_ends_on_both_sides() {
        let places: Vec<_> = (0..20).map(|k| [0.25 * f64::from(k), 0.0]).collect();
        let graph = graph(&places, 2.0);
        let part: Vec<usize> = (0..20).collect();
        let distance = |a: usize, b: usize| squared_distance(&places[a], &places[b]).sqrt();
        let mut ends = free_ends(&graph, &part, 20, distance);
        ends.sort_unstable();
        assert_eq!(ends, [0, 19]);
    }
}
