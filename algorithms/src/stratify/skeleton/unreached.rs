//! Boundaries that end in a point, and that no node leads to it from.

use super::Skeleton;
use super::ends::free_ends;
use super::graph::CurveGraph;
use super::ground::Ground;
use super::nodes::Branch;
use crate::orthogonal::dot;
use crate::stratify::atlas::Reference;
use crate::stratify::site::StratumKind;
use crosscap_core::{Label, Row, Scalar};

/// A boundary of a point that no node leads to it from.
struct Unreached {
    corner: usize,
    branch: Branch,
}

/// A free end of the nodes of a boundary.
struct FreeEnd {
    node: usize,
    /// Position of the part that it is the end of.
    part: usize,
    /// The node behind it that is farthest, `None` for a node by itself.
    behind: Option<usize>,
}

impl CurveGraph {
    /// Joins a point at which boundaries end to the free ends of boundaries about it, nearest pairs first, once for
    /// each boundary that the fit about the point counts and that no node leads to it from: where the points along a boundary leave a
    /// gap at its end. An end is joined where the way to the point goes on from it, and leaves the point on the
    /// side of the boundary, as far as its rows tell.
    ///
    /// O(c e) for c such boundaries and e free ends.
    pub(super) fn join_unreached<S: Scalar>(
        &mut self,
        skeleton: &Skeleton,
        ground: &Ground<'_, '_, S>,
    ) {
        let unreached = self.unreached_boundaries(skeleton);
        if self.nodes.kind != StratumKind::Boundary || unreached.is_empty() {
            return;
        }
        let ends = self.free_boundary_ends(ground);
        let rows = &self.nodes.rows;
        let reach = ground.tuning.join * ground.dl;
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (u, at) in unreached.iter().enumerate() {
            let row = skeleton.corner_rows()[at.corner];
            let fit = skeleton.corner_fit(at.branch.0);
            let side = side(ground, row, fit, at.branch.1);
            for (e, end) in ends.iter().enumerate() {
                let d = ground.distance(row, rows[end.node]);
                let on_another = (self.nodes.branches[end.node])
                    .is_some_and(|(k, l)| k == at.branch.0 && l != at.branch.1);
                let leads = || {
                    let way = way(ground, row, rows[end.node]);
                    let out = side.as_ref().is_none_or(|side| dot(side, &way) > 0.0);
                    let on = end
                        .behind
                        .map(|b| self::way(ground, rows[end.node], rows[b]));
                    out && on.is_none_or(|on| dot(&on, &way) > 0.0)
                };
                if d <= reach && !on_another && !self.is_stub(ground, row, end.part) && leads() {
                    pairs.push((d, u, e));
                }
            }
        }
        pairs.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        let (mut joined, mut taken) = (vec![false; unreached.len()], vec![false; ends.len()]);
        for (d, u, e) in pairs {
            if !joined[u] && !taken[e] {
                (joined[u], taken[e]) = (true, true);
                let (own, node) = (rows.len() + unreached[u].corner, ends[e].node);
                self.links[own].push((node, d));
                self.links[node].push((own, d));
            }
        }
    }

    /// The boundaries that fits about points count, and that no node leads to the point from.
    fn unreached_boundaries(&self, skeleton: &Skeleton) -> Vec<Unreached> {
        let mut out = Vec::new();
        for (corner, &row) in skeleton.corner_rows().iter().enumerate() {
            let fits = skeleton.corner_fits().enumerate();
            let Some((k, fit)) = fits.into_iter().find(|x| x.1.row == row) else {
                continue;
            };
            let reached = |l: Label| {
                let nodes = &self.links[self.first_corner() + corner];
                let mut branches = nodes.iter().map(|x| self.nodes.branches[x.0]);
                branches.any(|found| found == Some((k, l)))
            };
            let boundaries = (fit.fit.labels_of(1)).filter(|&l| fit.fit.cells_at(l) == Some(1));
            let none = boundaries.filter(|&l| fit.has_points() && !reached(l));
            out.extend(none.map(|l| Unreached {
                corner,
                branch: (k, l),
            }));
        }
        out
    }

    /// Free ends of boundaries.
    fn free_boundary_ends<S: Scalar>(&self, ground: &Ground<'_, '_, S>) -> Vec<FreeEnd> {
        let rows = &self.nodes.rows;
        let distance = |a: usize, b: usize| ground.distance(rows[a], rows[b]);
        let ends = self.parts.iter().enumerate().flat_map(|(part, members)| {
            let ends = free_ends(&self.links, members, self.first_corner(), distance);
            ends.into_iter().map(move |node| (part, node))
        });
        ends.map(|(part, node)| FreeEnd {
            node,
            part,
            behind: (self.links[node].iter())
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .map(|x| x.0),
        })
        .collect()
    }
}

/// The mean way from a point to the rows of one of its boundaries; `None` where there are none.
fn side<S: Scalar>(
    ground: &Ground<'_, '_, S>,
    corner: Row,
    fit: &Reference,
    label: Label,
) -> Option<Vec<f64>> {
    let own = fit.labels().iter().filter(|x| x.1 == label);
    own.map(|x| way(ground, corner, x.0))
        .reduce(|sum, way| sum.iter().zip(&way).map(|(a, b)| a + b).collect())
}

/// The way from the place of one row to that of another.
fn way<S: Scalar>(ground: &Ground<'_, '_, S>, from: Row, to: Row) -> Vec<f64> {
    let [from, to] = [from, to].map(|row| ground.places.point(row.index()));
    from.iter().zip(to).map(|(a, b)| b - a).collect()
}
