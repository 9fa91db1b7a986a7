//! Cells: what a flood over the dense points reaches without crossing a curve.

use super::analysis::{Analysis, Analyzer, Role, Scratch};
use crate::balls::BallTree;
use crate::execute::{self, Execute};
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
/// References that a job takes at a time.
const REFERENCES_AT_ONCE: usize = 8;
/// No reference.
const NONE: u32 = u32::MAX;

/// The decompositions of the given rows (points on curves), in that order; those whose fit
/// fails are left out.
pub(super) fn references<S: Scalar>(
    analyzer: &Analyzer<'_, S>,
    analysis: &Analysis,
    rows: &[usize],
) -> Vec<Reference> {
    execute::map_blocks(
        analyzer.execute,
        REFERENCES_AT_ONCE,
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
    ///
    /// O(log c) for each point of the cloud and c rows.
    pub(super) fn about<S: Scalar>(
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        centers: &[(usize, f64)],
        margin: f64,
    ) -> Self {
        let width = analyzer.cloud.dimension();
        let mut places = Vec::with_capacity(centers.len() * width);
        for &(row, _) in centers {
            places.extend_from_slice(analysis.places.point(row));
        }
        let tree = BallTree::new(width, &places);
        let widest = centers.iter().map(|c| c.1).fold(0.0, f64::max) + margin;
        let squares: Vec<[f64; 2]> = (centers.iter())
            .map(|c| [c.1 * c.1, (c.1 + margin) * (c.1 + margin)])
            .collect();
        let count = analysis.roles.len();
        let found = execute::map(analyzer.execute, count, Vec::new, |place, row| {
            place.clear();
            place.extend(analyzer.cloud.point(row).iter().map(|x| x.as_f64()));
            let mut near = false;
            let inside = tree.any_within(place, widest, |c, square| {
                let [inner, outer] = squares[c as usize];
                near |= square < outer;
                square < inner
            });
            (near, inside)
        });
        let rows: Vec<u32> = (0..count as u32)
            .filter(|&row| found[row as usize].0)
            .collect();
        Self {
            inside: rows.iter().map(|&row| found[row as usize].1).collect(),
            rows,
            margin,
        }
    }
}

/// The graph on the regular points of a region, cut along the curves.
///
/// Nodes that are near to each other have near numbers, and their places lie together.
pub(super) struct CellGraph {
    /// Node of every row, `NONE` outside of the region.
    node_of: Vec<u32>,
    /// Row of every node.
    rows: Vec<u32>,
    /// Place of every node.
    width: usize,
    places: Vec<f64>,
    starts: Vec<usize>,
    targets: Vec<u32>,
    /// Edges cut.
    pub(super) cut: usize,
}

/// The nodes next to one, `NONE` where there are fewer, and how many edges the labels cut there.
struct Links {
    targets: [u32; GRAPH_NEIGHBORS],
    cut: usize,
}

/// What labels the points: for every row the reference that is nearest, how far it is, and the label.
struct Labels<'a> {
    references: &'a [Reference],
    nearest: Vec<u32>,
    closest: Vec<f64>,
    own: Vec<u8>,
}

impl<'a> Labels<'a> {
    fn new(analysis: &Analysis, references: &'a [Reference], execute: &dyn Execute) -> Self {
        let n = analysis.roles.len();
        let places = &analysis.places;
        let mut labels = Self {
            references,
            nearest: vec![NONE; n],
            closest: vec![f64::INFINITY; n],
            own: vec![0; n],
        };
        let distances = execute::map_blocks(
            execute,
            REFERENCES_AT_ONCE,
            references.len(),
            || (),
            |(), k| -> Vec<f64> {
                let origin = places.point(references[k].row);
                let rows = references[k].labels.iter().map(|x| x.0 as usize);
                rows.map(|row| squared_distance(origin, places.point(row)))
                    .collect()
            },
        );
        for (k, (reference, distances)) in references.iter().zip(distances).enumerate() {
            let reach = (LABEL_REACH * reference.radius).powi(2);
            for (&(row, label), d) in reference.labels.iter().zip(distances) {
                let row = row as usize;
                if d < reach && d < labels.closest[row] {
                    labels.closest[row] = d;
                    labels.nearest[row] = k as u32;
                    labels.own[row] = label;
                }
            }
        }
        labels
    }

    /// Whether `i` and `j` are in different strata, or on the curve itself, by the reference that is
    /// nearest to either and knows both.
    fn separated(&self, i: usize, j: usize) -> bool {
        let (first, second) = if self.closest[j] < self.closest[i] {
            (j, i)
        } else {
            (i, j)
        };
        for (from, to) in [(first, second), (second, first)] {
            let k = self.nearest[from];
            if k == NONE {
                continue;
            }
            let reference = &self.references[k as usize];
            let label = if self.nearest[to] == k {
                Some(self.own[to])
            } else {
                reference.label(to)
            };
            if let Some(label) = label {
                return label != self.own[from] || !reference.is_cell(label);
            }
        }
        false
    }
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
        let labels = Labels::new(analysis, references, analyzer.execute);
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
        let is_node = |k: u32| {
            let row = region.rows[k as usize] as usize;
            region.inside[k as usize] && analysis.roles[row] == Role::Regular
        };
        let mut node_of = vec![NONE; analysis.roles.len()];
        let mut rows = Vec::new();
        for &k in tree.order().iter().filter(|&&k| is_node(k)) {
            let row = region.rows[k as usize];
            node_of[row as usize] = rows.len() as u32;
            rows.push(row);
        }
        let all_links = tree.nearest_of_each(
            GRAPH_NEIGHBORS,
            is_node,
            analyzer.execute,
            |index, near| -> Links {
                let from = region.rows[index as usize] as usize;
                let mut links = Links {
                    targets: [NONE; GRAPH_NEIGHBORS],
                    cut: 0,
                };
                let mut add = |k: usize, to: usize| {
                    let node = node_of[to];
                    if node != NONE && labels.separated(from, to) {
                        links.cut += 1;
                    } else {
                        links.targets[k] = node;
                    }
                };
                // Where neighbors are farther than the margin there may be nearer ones beyond it.
                let last = near.last().map_or(f64::INFINITY, |x| x.square());
                if near.len() == GRAPH_NEIGHBORS && last <= region.margin * region.margin {
                    for (k, x) in near.iter().enumerate() {
                        add(k, region.rows[x.index() as usize] as usize);
                    }
                } else {
                    let mut near = Vec::new();
                    analyzer
                        .oracle
                        .nearest(from, GRAPH_NEIGHBORS + 1, &mut near);
                    let others = near.iter().filter(|x| x.index != from);
                    for (k, x) in others.take(GRAPH_NEIGHBORS).enumerate() {
                        add(k, x.index);
                    }
                }
                links
            },
        );
        drop(tree);
        let mut places = Vec::with_capacity(rows.len() * width);
        for &row in &rows {
            places.extend_from_slice(analysis.places.point(row as usize));
        }
        let (starts, targets) = compressed(&all_links);
        Self {
            node_of,
            rows,
            width,
            places,
            starts,
            targets,
            cut: all_links.iter().map(|links| links.cut).sum(),
        }
    }

    fn around(&self, node: usize) -> &[u32] {
        &self.targets[self.starts[node]..self.starts[node + 1]]
    }

    /// Row of a node.
    pub(super) fn row(&self, node: usize) -> usize {
        self.rows[node] as usize
    }

    /// Place of a node.
    pub(super) fn place(&self, node: usize) -> &[f64] {
        &self.places[node * self.width..(node + 1) * self.width]
    }
}

/// The nodes that are linked to each, from either side and each once, with where those of a node start.
fn compressed(links: &[Links]) -> (Vec<usize>, Vec<u32>) {
    let count = links.len();
    // Bit k: the k-th target has no link back.
    let one_sided: Vec<u16> = (0_u32..)
        .zip(links)
        .map(|(a, own)| {
            let bits = own.targets.iter().enumerate().map(|(k, &b)| {
                let back = b == NONE || links[b as usize].targets.contains(&a);
                u16::from(!back) << k
            });
            bits.sum()
        })
        .collect();
    let pairs = || {
        (0_u32..)
            .zip(links.iter().zip(&one_sided))
            .flat_map(|(a, (own, &one_sided))| {
                let targets = own.targets.iter().enumerate().filter(|x| *x.1 != NONE);
                targets.map(move |(k, &b)| (a, b, one_sided >> k & 1 == 1))
            })
    };
    let mut starts = vec![0usize; count + 1];
    for (a, b, one_sided) in pairs() {
        starts[a as usize + 1] += 1;
        starts[b as usize + 1] += usize::from(one_sided);
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut all = vec![0u32; starts[count]];
    for (a, b, one_sided) in pairs() {
        all[next[a as usize]] = b;
        next[a as usize] += 1;
        if one_sided {
            all[next[b as usize]] = a;
            next[b as usize] += 1;
        }
    }
    (starts, all)
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
    /// Everything that paths from the rows `from` reach without leaving the nodes that are `inside`.
    pub(super) fn run(&mut self, graph: &CellGraph, from: &[u32], inside: impl Fn(usize) -> bool) {
        if self.stamp.len() != graph.rows.len() {
            self.stamp = vec![0; graph.rows.len()];
            self.round = 0;
        }
        self.round += 1;
        self.nodes.clear();
        for &row in from {
            let node = graph.node_of[row as usize];
            if node != NONE && self.stamp[node as usize] != self.round && inside(node as usize) {
                self.stamp[node as usize] = self.round;
                self.nodes.push(node);
            }
        }
        let mut at = 0;
        while at < self.nodes.len() {
            for &other in graph.around(self.nodes[at] as usize) {
                if self.stamp[other as usize] != self.round {
                    self.stamp[other as usize] = self.round;
                    if inside(other as usize) {
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
