//! The points of a kind of curve that chains are laid over, with what fits about corners say of them.

use super::Skeleton;
use super::ground::Ground;
use super::thin::thin;
use crate::stratify::site::StratumKind;
use crosscap_core::{Label, Row, Scalar};

/// The branch of a curve at a corner: the position of the fit about the corner, and its label.
pub(super) type Branch = (usize, Label);

/// Thinned points of a kind of curve.
pub(super) struct Nodes {
    pub(super) kind: StratumKind,
    pub(super) rows: Vec<Row>,
    /// The branch that each is on, where a fit about a corner tells.
    pub(super) branches: Vec<Option<Branch>>,
}

impl Nodes {
    /// The points of a kind of curve that are on one curve alone.
    pub(super) fn of<S: Scalar>(
        skeleton: &Skeleton,
        ground: &Ground<'_, '_, S>,
        kind: StratumKind,
    ) -> Self {
        let spacing = ground.tuning.node_spacing * ground.dl;
        let mut rows = thin(ground, spacing, kind);
        // Next to a corner the points of a boundary are in the band of both sheets: which
        // branch they are on cannot be told, and the corner stands for them.
        rows.retain(|&row| {
            let corners = skeleton.corner_rows();
            corners.iter().all(|&c| ground.distance(c, row) > spacing)
                && label(skeleton, ground, row).is_none_or(|(k, l)| {
                    let corner = skeleton.corner_fit(k);
                    match kind {
                        StratumKind::Curve => !corner.is_point(l),
                        // A fit with a point knows the boundaries that end in it.
                        _ if corner.has_points() && corner.is_curve(l) => true,
                        _ => corner.is_cell(l) || ground.distance(corner.row, row) > ground.dl,
                    }
                })
        });
        let labels = rows
            .iter()
            .map(|&row| label(skeleton, ground, row))
            .collect();
        let mut nodes = Self {
            kind,
            rows,
            branches: labels,
        };
        nodes.keep_arcs(skeleton, ground);
        nodes
    }

    /// 0-strata tell arcs apart, and where a boundary was given the cells at a corner do. Where the bands of two arcs run
    /// together, or a point of a cell fills a gap of one, the nearest point that is on one arc alone decides, if it is near: a point of a
    /// cell can be on another curve as well, that the corner knows nothing of.
    fn keep_arcs<S: Scalar>(&mut self, skeleton: &Skeleton, ground: &Ground<'_, '_, S>) {
        let on_arc: Vec<(Row, Branch)> = (self.rows.iter().zip(&self.branches))
            .filter_map(|(&row, &found)| Some((row, found?)))
            .filter(|&(_, (k, l))| {
                let corner = skeleton.corner_fit(k);
                corner.has_points() && corner.is_curve(l)
            })
            .collect();
        let by_cells = self.kind == StratumKind::Boundary;
        for (found, &row) in self.branches.iter_mut().zip(&self.rows) {
            *found = found.and_then(|(k, l)| {
                let corner = skeleton.corner_fit(k);
                if !corner.has_points() {
                    return by_cells.then_some((k, l));
                }
                if corner.is_curve(l) {
                    return Some((k, l));
                }
                let far = |x: &(Row, Branch)| ground.distance(x.0, row);
                let own = on_arc.iter().filter(|x| x.1.0 == k);
                let nearest = own.min_by(|a, b| far(a).total_cmp(&far(b)));
                nearest
                    .filter(|x| !corner.is_cell(l) || far(x) < ground.dl)
                    .map(|x| x.1)
            });
        }
    }

    /// Whether the curve of a node has no surface at it.
    pub(super) fn is_bare<S: Scalar>(&self, ground: &Ground<'_, '_, S>, k: usize) -> bool {
        self.kind == StratumKind::Curve && ground.strata.cells(self.rows[k]) == 0
    }

    /// Whether the curve of a node is a fold, which may fade out.
    pub(super) fn is_fold<S: Scalar>(&self, ground: &Ground<'_, '_, S>, k: usize) -> bool {
        self.kind == StratumKind::Curve && ground.strata.cells(self.rows[k]) == 2
    }

    /// Whether two nodes are known to be on different curves.
    pub(super) fn parted<S: Scalar>(&self, ground: &Ground<'_, '_, S>, a: usize, b: usize) -> bool {
        matches!((self.branches[a], self.branches[b]), (Some(x), Some(y)) if x.0 == y.0 && x.1 != y.1)
            || self.is_bare(ground, a) != self.is_bare(ground, b)
    }
}

/// What the nearest fit about a corner that knows a row says of it.
fn label<S: Scalar>(skeleton: &Skeleton, ground: &Ground<'_, '_, S>, row: Row) -> Option<Branch> {
    skeleton
        .corner_fits()
        .enumerate()
        .filter_map(|(k, r)| Some((ground.distance(r.row, row), k, r.label(row)?)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|&(d, k, _)| d < skeleton.corner_fit(k).radius)
        .map(|(_, k, l)| (k, l))
}
