//! The graph of the points of a kind of curve, with the corners behind them.

use super::Skeleton;
use super::ends::{bridges, free_ends};
use super::ground::Ground;
use super::nodes::Nodes;
use super::sweep::components;
use crate::stratify::site::StratumKind;
use crosscap_core::{Label, Row, Scalar, Table};
use std::collections::BTreeMap;

/// Nodes and corners, joined where a curve goes from one to the other.
pub(super) struct CurveGraph {
    pub(super) nodes: Nodes,
    /// For every node, then every corner, those joined to it with their distances.
    pub(super) links: Vec<Vec<(usize, f64)>>,
    /// The connected parts, corners left out, each in order.
    pub(super) parts: Vec<Vec<usize>>,
    /// Corners that a curve does not reach although the fit about them says so, once for each such curve.
    pub(super) unreached: Vec<Row>,
}

impl CurveGraph {
    pub(super) fn new<S: Scalar>(
        skeleton: &Skeleton,
        ground: &Ground<'_, '_, S>,
        nodes: Nodes,
    ) -> Self {
        let mut links = near_nodes(ground, &nodes);
        part_bare(ground, &nodes, &mut links);
        let mut out = Self {
            parts: components(&links, nodes.rows.len()),
            nodes,
            links,
            unreached: Vec::new(),
        };
        out.join_corners(skeleton, ground);
        if out.bridge(ground) {
            // What was too short to end at a corner may go on beyond a gap.
            out.leave_corners();
            out.join_corners(skeleton, ground);
        }
        out.join_unreached(skeleton, ground);
        out
    }

    /// The number of the first corner.
    pub(super) fn first_corner(&self) -> usize {
        self.nodes.rows.len()
    }

    /// Joins each corner to the nearest node of every branch, one without a surface only where points lead there. A part of a curve that does not reach
    /// farther than dl from the corner is none: it has no room for a landmark, and would stand between
    /// the corner and its curve.
    fn join_corners<S: Scalar>(&mut self, skeleton: &Skeleton, ground: &Ground<'_, '_, S>) {
        let rows = &self.nodes.rows;
        let mut part = vec![usize::MAX; rows.len()];
        for (p, members) in self.parts.iter().enumerate() {
            members.iter().for_each(|&k| part[k] = p);
        }
        let reach = ground.tuning.join * ground.dl;
        for &corner in skeleton.corner_rows() {
            let stub: Vec<bool> = (0..self.parts.len())
                .map(|part| self.is_stub(ground, corner, part))
                .collect();
            let mut branches: Vec<(Label, usize, f64)> = Vec::new();
            for (k, &row) in rows.iter().enumerate() {
                let d = ground.distance(corner, row);
                if d > reach || stub[part[k]] {
                    continue;
                }
                let Some(branch) = self.branch(skeleton, corner, k) else {
                    continue;
                };
                match branches.iter_mut().find(|b| b.0 == branch) {
                    Some(b) if d < b.2 => *b = (branch, k, d),
                    Some(_) => {}
                    None => branches.push((branch, k, d)),
                }
            }
            let own = self.links.len();
            self.links.push(Vec::new());
            for (_, k, d) in branches {
                if self.nodes.is_bare(ground, k) && !ground.is_followed(corner, rows[k], 1) {
                    self.unreached.push(corner);
                    continue;
                }
                self.links[own].push((k, d));
                self.links[k].push((own, d));
            }
        }
    }

    /// Whether a part does not reach farther than dl from a corner.
    pub(super) fn is_stub<S: Scalar>(
        &self,
        ground: &Ground<'_, '_, S>,
        corner: Row,
        part: usize,
    ) -> bool {
        let near = |&k: &usize| ground.distance(corner, self.nodes.rows[k]) < ground.dl;
        self.parts[part].iter().all(near)
    }

    /// Takes the corners away.
    fn leave_corners(&mut self) {
        let first_corner = self.first_corner();
        self.links.truncate(first_corner);
        for links in &mut self.links {
            links.retain(|x| x.0 < first_corner);
        }
        self.unreached.clear();
    }

    /// The branch of a corner that a node is on; `None` for a node that is on none. Where the fit about the corner tells no
    /// branches apart, all are one.
    fn branch(&self, skeleton: &Skeleton, corner: Row, node: usize) -> Option<Label> {
        let at_point = || {
            skeleton
                .corner_fits()
                .any(|r| r.row == corner && r.has_points())
        };
        match (self.nodes.kind, self.nodes.branches[node]) {
            (StratumKind::Boundary, found) => found.map(|(_, l)| l),
            (_, Some((at, l))) if skeleton.corner_fit(at).row == corner => Some(l),
            _ if at_point() => None,
            _ => Some(Label::default()),
        }
    }

    /// Joins ends that point at each other over a gap of the points, and says whether there are any.
    fn bridge<S: Scalar>(&mut self, ground: &Ground<'_, '_, S>) -> bool {
        let rows = &self.nodes.rows;
        let first_corner = rows.len();
        let distance = |a: usize, b: usize| ground.distance(rows[a], rows[b]);
        // A fold ends where the sheet is flat. What is next to a bare curve says where it ends, and its points
        // are joined over as much anyway.
        let ends: Vec<Vec<usize>> = (self.parts.iter())
            .filter(|members| {
                let stops =
                    |&k: &usize| !self.nodes.is_bare(ground, k) && !self.nodes.is_fold(ground, k);
                members.iter().all(stops)
            })
            .map(|members| free_ends(&self.links, members, first_corner, distance))
            .collect();
        let place = |k: usize| ground.places.point(rows[k].index());
        let parted = |a: usize, b: usize| self.nodes.parted(ground, a, b);
        let reach = ground.tuning.bridge * ground.dl;
        let bridges = bridges(&self.links, &ends, place, reach, parted);
        for &(a, b, d) in &bridges {
            self.links[a].push((b, d));
            self.links[b].push((a, d));
        }
        if bridges.is_empty() {
            return false;
        }
        self.parts = components(&self.links, first_corner);
        true
    }
}

/// For every node the nodes that are near it on the same curve.
fn near_nodes<S: Scalar>(ground: &Ground<'_, '_, S>, nodes: &Nodes) -> Vec<Vec<(usize, f64)>> {
    let Ground {
        strata, tuning, dl, ..
    } = *ground;
    let rows = &nodes.rows;
    let mut at: Table<Row, Option<usize>> = Table::filled(strata.len(), None);
    for (k, &row) in rows.iter().enumerate() {
        at[row] = Some(k);
    }
    let slack = 2.0 * rows.iter().map(|&r| strata.moved(r)).fold(0.0, f64::max);
    let mut links: Vec<Vec<(usize, f64)>> = vec![Vec::new(); rows.len()];
    let mut near = Vec::new();
    for (k, &row) in rows.iter().enumerate() {
        // Folds are told apart by their labels.
        let reach = if nodes.is_bare(ground, k) || nodes.is_fold(ground, k) {
            tuning.bare_reach * dl
        } else {
            tuning.reach * dl
        };
        ground.fitter.around(row, reach + slack, &mut near);
        for &x in &near {
            let Some(other) = at[x].filter(|&other| other != k) else {
                continue;
            };
            let d = ground.distance(row, x);
            if d <= reach && !nodes.parted(ground, k, other) {
                links[k].push((other, d));
            }
        }
    }
    links
}

/// Parts curves without a surface where no points lead from one node to the next: of the links that are longer than what is
/// joined over in any case, those between parts that hang together by shorter ones are taken away, unless the shortest of them is
/// followed by points. O(links log links), and a look at the points for each pair of such parts.
fn part_bare<S: Scalar>(
    ground: &Ground<'_, '_, S>,
    nodes: &Nodes,
    links: &mut [Vec<(usize, f64)>],
) {
    let short = ground.tuning.bare_gap * ground.dl;
    let is_long = |a: usize, d: f64| d > short && nodes.is_bare(ground, a);
    let kept = |a: usize| {
        links[a]
            .iter()
            .copied()
            .filter(move |&(_, d)| !is_long(a, d))
    };
    let near: Vec<Vec<(usize, f64)>> = (0..links.len()).map(|a| kept(a).collect()).collect();
    let mut part = vec![0; links.len()];
    for (p, members) in components(&near, links.len()).iter().enumerate() {
        members.iter().for_each(|&k| part[k] = p);
    }
    let mut shortest: BTreeMap<[usize; 2], (f64, usize, usize)> = BTreeMap::new();
    for (a, row) in links.iter().enumerate() {
        for &(b, d) in row.iter().filter(|&&(b, _)| part[a] < part[b]) {
            let best = shortest.entry([part[a], part[b]]).or_insert((d, a, b));
            if d < best.0 {
                *best = (d, a, b);
            }
        }
    }
    shortest.retain(|_, &mut (d, a, b)| {
        let [from, to] = [a, b].map(|k| nodes.rows[k]);
        is_long(a, d) && !ground.is_followed(from, to, links.len())
    });
    let pair = |a: usize, b: usize| [part[a].min(part[b]), part[a].max(part[b])];
    for (a, row) in links.iter_mut().enumerate() {
        row.retain(|&(b, _)| !shortest.contains_key(&pair(a, b)));
    }
}
