//! Cells: what a flood over the dense points reaches without crossing a curve.

use super::analysis::{Analysis, Analyzer, Role, Scratch};
use crate::execute;
use crosscap_core::{Decomposition, Scalar, squared_distance};

/// A point on a curve whose decomposition labels the points around it.
pub(super) struct Reference {
    /// Its row.
    pub(super) row: usize,
    /// Rows in its ball with their labels, by row.
    labels: Vec<(u32, u8)>,
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
            let (mut fit, near) = analyzer.decomposition(analysis, rows[k], scratch)?;
            let mut labels: Vec<(u32, u8)> = near
                .iter()
                .map(|&r| r as u32)
                .zip(std::mem::take(&mut fit.labels))
                .collect();
            labels.sort_unstable();
            Some(Reference {
                row: rows[k],
                labels,
                fit,
            })
        },
    )
    .into_iter()
    .flatten()
    .collect()
}

/// The graph on the regular points, cut along the curves.
pub(super) struct CellGraph {
    starts: Vec<usize>,
    targets: Vec<u32>,
    /// Edges cut.
    pub(super) cut: usize,
}

impl CellGraph {
    /// Union of the 12 nearest neighbors of every point, curve points counted among them and
    /// then removed; an edge is cut when its ends carry different labels in the fit of the
    /// reference that is nearest to either.
    pub(super) fn new<S: Scalar>(
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        references: &[Reference],
    ) -> Self {
        let n = analysis.roles.len();
        let places = &analysis.places;
        let mut nearest = vec![NONE; n];
        let mut closest = vec![f64::INFINITY; n];
        for (k, reference) in references.iter().enumerate() {
            let reach = (LABEL_REACH * analysis.radii[reference.row]).powi(2);
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
        let rows = execute::map(analyzer.execute, n, Vec::new, |near, i| {
            if analysis.roles[i] != Role::Regular {
                return Vec::new();
            }
            analyzer.oracle.nearest(i, GRAPH_NEIGHBORS + 1, near);
            near.iter()
                .map(|x| x.index)
                .filter(|&j| j != i && analysis.roles[j] == Role::Regular)
                .collect::<Vec<usize>>()
        });
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(n * GRAPH_NEIGHBORS * 2);
        let mut cut = 0;
        for (i, row) in rows.iter().enumerate() {
            for &j in row {
                if separated(i, j, references, &nearest, &closest) {
                    cut += 1;
                } else {
                    edges.push((i as u32, j as u32));
                    edges.push((j as u32, i as u32));
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let mut starts = vec![0usize; n + 1];
        for &(a, _) in &edges {
            starts[a as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        Self {
            starts,
            targets: edges.into_iter().map(|(_, b)| b).collect(),
            cut,
        }
    }

    fn around(&self, i: usize) -> &[u32] {
        &self.targets[self.starts[i]..self.starts[i + 1]]
    }
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
pub(super) struct Flood {
    stamp: Vec<u32>,
    round: u32,
    /// Rows reached, in the order of the flood.
    pub(super) reached: Vec<u32>,
}

impl Flood {
    pub(super) fn new(n: usize) -> Self {
        Self {
            stamp: vec![0; n],
            round: 0,
            reached: Vec::new(),
        }
    }

    /// Everything that paths from `from` reach without leaving the ball of `radius` about `origin`.
    pub(super) fn run(
        &mut self,
        graph: &CellGraph,
        from: impl Iterator<Item = u32>,
        inside: impl Fn(usize) -> bool,
    ) {
        self.round += 1;
        self.reached.clear();
        for i in from {
            if self.stamp[i as usize] != self.round && inside(i as usize) {
                self.stamp[i as usize] = self.round;
                self.reached.push(i);
            }
        }
        let mut at = 0;
        while at < self.reached.len() {
            let i = self.reached[at] as usize;
            at += 1;
            for &j in graph.around(i) {
                if self.stamp[j as usize] != self.round && inside(j as usize) {
                    self.stamp[j as usize] = self.round;
                    self.reached.push(j);
                }
            }
        }
    }
}
