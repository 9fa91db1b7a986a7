//! Cells: what a flood over the dense points reaches without crossing a curve.

use super::analysis::{Analysis, Analyzer, Role, Scratch};
use super::balls::BallTree;
use crate::execute;
use crosscap_core::{Decomposition, Scalar, squared_distance};

/// A point on a curve whose decomposition labels the points around it.
pub(super) struct Reference {
    /// Its row.
    pub(super) row: usize,
    /// Rows in its ball with their labels, by row.
    labels: Vec<(u32, u8)>,
    /// Radius of the fit.
    pub(super) radius: f64,
    /// The strata, without the labels.
    pub(super) fit: Decomposition,
}

impl Reference {
    pub(super) fn label(&self, row: usize) -> Option<u8> {
        let at = self
            .labels
            .binary_search_by_key(&(row as u32), |&(r, _)| r)
            .ok()?;
        Some(self.labels[at].1)
    }

    /// Whether `label` names a 0-stratum.
    pub(super) fn is_point(&self, label: u8) -> bool {
        self.fit.strata[label as usize].dimension == 0
    }

    /// Whether `label` names a curve.
    pub(super) fn is_curve(&self, label: u8) -> bool {
        self.fit.strata[label as usize].dimension == 1
    }

    /// Whether the model knows of 0-strata.
    pub(super) fn has_points(&self) -> bool {
        !self.fit.points.is_empty()
    }

    /// Whether `label` names a cell.
    pub(super) fn is_cell(&self, label: u8) -> bool {
        self.fit.strata[label as usize].dimension == 2
    }
}

/// Neighbors of a point in the graph that floods run on.
const GRAPH_NEIGHBORS: usize = 12;
/// Labels are believed up to this share of the radius of the fit.
const LABEL_REACH: f64 = 0.9;
/// No reference.
const NONE: u32 = u32::MAX;

/// The decompositions of the given rows (points on curves), in that order; those whose fit
/// fails are left out.
pub(super) fn references<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &Analysis,
    rows: &[usize],
) -> Vec<Reference> {
    execute::map(
        analyzer.execute,
        rows.len(),
        Scratch::default,
        |scratch, k| {
            let (mut fit, near, radius) = analyzer.decomposition(analysis, rows[k], scratch)?;
            let mut labels: Vec<(u32, u8)> = near
                .iter()
                .map(|&r| r as u32)
                .zip(std::mem::take(&mut fit.labels))
                .collect();
            labels.sort_unstable();
            Some(Reference {
                row: rows[k],
                labels,
                radius,
                fit,
            })
        },
    )
    .into_iter()
    .flatten()
    .collect()
}

/// Where floods run: some of the points, and a margin about them.
pub(super) struct Region {
    /// Rows of the region and the margin, in order.
    rows: Vec<u32>,
    /// Whether a row of `rows` is in the region.
    inside: Vec<bool>,
    /// Every row this close to one of the region is in `rows`.
    margin: f64,
}

impl Region {
    /// All points.
    pub(super) fn everything(count: usize, margin: f64) -> Self {
        Self {
            rows: (0..count as u32).collect(),
            inside: vec![true; count],
            margin,
        }
    }

    /// The points within a radius of some rows, `(row, radius)` for each.
    pub(super) fn about<S: Scalar>(
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        centers: &[(usize, f64)],
        margin: f64,
    ) -> Self {
        let found = execute::map_blocks(
            analyzer.execute,
            CENTERS_AT_ONCE,
            centers.len(),
            Vec::new,
            |near, c| {
                let (row, radius) = centers[c];
                // The oracle knows the points where they were before they were moved.
                let reach = radius + margin + analysis.offsets[row];
                analyzer.oracle.indices_within(row, S::of(reach), near);
                let origin = analysis.places.point(row);
                near.iter()
                    .map(|&x| {
                        let place = analysis.places.point(x as usize);
                        (x, squared_distance(origin, place) < radius * radius)
                    })
                    .collect::<Vec<(u32, bool)>>()
            },
        );
        let mut state = vec![0u8; analysis.roles.len()];
        for (row, inner) in found.into_iter().flatten() {
            state[row as usize] |= 1 + u8::from(inner);
        }
        let rows: Vec<u32> = (0..state.len() as u32)
            .filter(|&row| state[row as usize] > 0)
            .collect();
        Self {
            inside: rows.iter().map(|&row| state[row as usize] > 1).collect(),
            rows,
            margin,
        }
    }
}

/// Centers whose surroundings are looked up together.
const CENTERS_AT_ONCE: usize = 16;

/// The graph on the regular points of a region, cut along the curves.
pub(super) struct CellGraph {
    /// Node of every row, `NONE` outside of the region.
    node_of: Vec<u32>,
    /// Row of every node.
    rows: Vec<u32>,
    starts: Vec<usize>,
    targets: Vec<u32>,
    /// Edges cut.
    pub(super) cut: usize,
}

impl CellGraph {
    /// Union of the 12 nearest neighbors of every point of the region, curve points counted among
    /// them and then removed; an edge is cut when its ends carry different labels in the fit of
    /// the reference that is nearest to either.
    pub(super) fn new<S: Scalar>(
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        references: &[Reference],
        region: &Region,
    ) -> Self {
        let n = analysis.roles.len();
        let places = &analysis.places;
        let mut nearest = vec![NONE; n];
        let mut closest = vec![f64::INFINITY; n];
        for (k, reference) in references.iter().enumerate() {
            let reach = (LABEL_REACH * reference.radius).powi(2);
            let origin = places.point(reference.row);
            for &(row, _) in &reference.labels {
                let row = row as usize;
                let d = squared_distance(origin, places.point(row));
                if d < reach && d < closest[row] {
                    closest[row] = d;
                    nearest[row] = k as u32;
                }
            }
        }
        let regular = |row: u32| analysis.roles[row as usize] == Role::Regular;
        let mut node_of = vec![NONE; n];
        let mut rows = Vec::new();
        for (&row, &inside) in region.rows.iter().zip(&region.inside) {
            if inside && regular(row) {
                node_of[row as usize] = rows.len() as u32;
                rows.push(row);
            }
        }
        let width = analyzer.cloud.dimension();
        let mut coordinates = Vec::with_capacity(region.rows.len() * width);
        for &row in &region.rows {
            coordinates.extend(
                analyzer
                    .cloud
                    .point(row as usize)
                    .iter()
                    .map(|x| x.as_f64()),
            );
        }
        let tree = BallTree::new(width, &coordinates);
        drop(coordinates);
        let is_node = |k: u32| node_of[region.rows[k as usize] as usize] != NONE;
        let mut lists = tree.nearest_of_each(GRAPH_NEIGHBORS, is_node, analyzer.execute);
        drop(tree);
        // Where neighbors are farther than the margin there may be nearer ones beyond it.
        let mut near = Vec::new();
        for list in &mut lists {
            let last = list.near.last().map_or(f64::INFINITY, |x| x.0);
            let full = list.near.len() == GRAPH_NEIGHBORS;
            let row = region.rows[list.index as usize];
            list.index = row;
            if full && last <= region.margin * region.margin {
                for x in &mut list.near {
                    x.1 = region.rows[x.1 as usize];
                }
            } else {
                analyzer
                    .oracle
                    .nearest(row as usize, GRAPH_NEIGHBORS + 1, &mut near);
                list.near.clear();
                list.near.extend(
                    near.iter()
                        .filter(|x| x.index != row as usize)
                        .map(|x| (x.distance.as_f64(), x.index as u32)),
                );
            }
        }
        let mut cut = 0;
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(lists.len() * GRAPH_NEIGHBORS * 2);
        for list in &lists {
            let a = node_of[list.index as usize];
            for &(_, row) in &list.near {
                let b = node_of[row as usize];
                if b == NONE {
                    continue;
                }
                if separated(
                    list.index as usize,
                    row as usize,
                    references,
                    &nearest,
                    &closest,
                ) {
                    cut += 1;
                } else {
                    edges.push((a, b));
                    edges.push((b, a));
                }
            }
        }
        drop(lists);
        let (starts, targets) = compressed(rows.len(), &edges);
        Self {
            node_of,
            rows,
            starts,
            targets,
            cut,
        }
    }

    fn around(&self, node: usize) -> &[u32] {
        &self.targets[self.starts[node]..self.starts[node + 1]]
    }
}

/// The targets of directed edges by source, each once, with where those of a source start.
fn compressed(count: usize, edges: &[(u32, u32)]) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0usize; count + 1];
    for &(a, _) in edges {
        starts[a as usize + 1] += 1;
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut all = vec![0u32; edges.len()];
    for &(a, b) in edges {
        all[next[a as usize]] = b;
        next[a as usize] += 1;
    }
    let mut kept = 0;
    let mut from = 0;
    for k in 0..count {
        let until = starts[k + 1];
        all[from..until].sort_unstable();
        starts[k] = kept;
        for at in from..until {
            if at == from || all[at] != all[at - 1] {
                all[kept] = all[at];
                kept += 1;
            }
        }
        from = until;
    }
    starts[count] = kept;
    all.truncate(kept);
    all.shrink_to_fit();
    (starts, all)
}

/// Whether the labels put `i` and `j` into different strata, or onto the curve itself.
fn separated(
    i: usize,
    j: usize,
    references: &[Reference],
    nearest: &[u32],
    closest: &[f64],
) -> bool {
    let mut order = [(closest[i], nearest[i]), (closest[j], nearest[j])];
    if order[1].0 < order[0].0 {
        order.swap(0, 1);
    }
    for (_, k) in order {
        if k == NONE {
            continue;
        }
        let reference = &references[k as usize];
        if let (Some(a), Some(b)) = (reference.label(i), reference.label(j)) {
            return a != b || !reference.is_cell(a);
        }
    }
    false
}

/// A flood with its memory of what was reached, reusable.
#[derive(Default)]
pub(super) struct Flood {
    stamp: Vec<u32>,
    round: u32,
    nodes: Vec<u32>,
    /// Rows reached, in the order of the flood.
    pub(super) reached: Vec<u32>,
}

impl Flood {
    /// Everything that paths from the rows `from` reach without leaving the rows that are `inside`.
    pub(super) fn run(&mut self, graph: &CellGraph, from: &[u32], inside: impl Fn(usize) -> bool) {
        if self.stamp.len() != graph.rows.len() {
            self.stamp = vec![0; graph.rows.len()];
            self.round = 0;
        }
        self.round += 1;
        self.nodes.clear();
        for &row in from {
            let node = graph.node_of[row as usize];
            if node != NONE && self.stamp[node as usize] != self.round && inside(row as usize) {
                self.stamp[node as usize] = self.round;
                self.nodes.push(node);
            }
        }
        let mut at = 0;
        while at < self.nodes.len() {
            for &other in graph.around(self.nodes[at] as usize) {
                if self.stamp[other as usize] != self.round {
                    self.stamp[other as usize] = self.round;
                    if inside(graph.rows[other as usize] as usize) {
                        self.nodes.push(other);
                    }
                }
            }
            at += 1;
        }
        self.reached.clear();
        self.reached
            .extend(self.nodes.iter().map(|&node| graph.rows[node as usize]));
    }
}
