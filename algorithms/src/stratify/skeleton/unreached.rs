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
        let mut pairs: Vec<(f64, bool, usize, usize)> = Vec::new();
        for (u, at) in unreached.iter().enumerate() {
            let row = skeleton.corner_rows()[at.corner];
            let fit = skeleton.corner_fit(at.branch.0);
            let side = side(ground, row, fit, at.branch.1);
            for (e, end) in ends.iter().enumerate() {
                let d = ground.distance(row, rows[end.node]);
                let on_another = (self.nodes.branches[end.node])
                    .is_some_and(|(k, l)| k == at.branch.0 && l != at.branch.1);
                let leads = || {
                    let way = ground.way(row, rows[end.node]);
                    let out = side.as_ref().is_none_or(|side| dot(side, &way) > 0.0);
                    let on = end.behind.map(|b| ground.way(rows[end.node], rows[b]));
                    out && on.is_none_or(|on| dot(&on, &way) > 0.0)
                };
                if d <= reach && !on_another && !self.is_stub(ground, row, end.part) && leads() {
                    // All boundaries of a point are as far from an end: those that know their side come first, as the others may take any.
                    pairs.push((d, side.is_none(), u, e));
                }
            }
        }
        pairs.sort_by(|x, y| {
            let rest = (x.1, x.2, x.3).cmp(&(y.1, y.2, y.3));
            x.0.total_cmp(&y.0).then(rest)
        });
        let (mut joined, mut taken) = (vec![false; unreached.len()], vec![false; ends.len()]);
        for (d, _, u, e) in pairs {
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
    own.map(|x| ground.way(corner, x.0))
        .reduce(|sum, way| sum.iter().zip(&way).map(|(a, b)| a + b).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stratify::skeleton::about_point::{AboutPoint, Found, Place};
    use crate::tuning::Tuning;
    use crosscap_core::Landmark;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    /// How far the fit about the point labels, in dl.
    const REACH: f64 = 1.5;

    /// Places a tenth of dl apart on a ray from the origin.
    fn ray(turns: f64, stretches: &[[f64; 2]]) -> Vec<Place> {
        let steps = stretches.iter().flat_map(|&[from, to]| {
            let count = ((to - from) / 0.1) as u32;
            (0..=count).map(move |k| from + 0.1 * f64::from(k))
        });
        let (sin, cos) = (FRAC_PI_2 * turns).sin_cos();
        steps.map(|r| [r * cos, r * sin]).collect()
    }

    /// How many boundaries the chains join to the point at the origin, whose fit counts one boundary for each of the
    /// given lists of places and labels those that are near; `others` are places of boundaries that it knows nothing of.
    fn joined(boundaries: &[Vec<Place>], others: &[Place], dl: f64) -> usize {
        let is_near = |place: &Place| place[0].hypot(place[1]) < REACH;
        let named = (boundaries.iter().enumerate()).flat_map(|(k, places)| {
            places.iter().map(move |&place| Found {
                place: place.map(|x| x * dl),
                label: is_near(&place).then_some(Label::new(1 + k)),
                cells: 1,
            })
        });
        let unnamed = others.iter().map(|&place| Found {
            place: place.map(|x| x * dl),
            label: None,
            cells: 1,
        });
        let found: Vec<Found> = named.chain(unnamed).collect();
        let count = boundaries.len();
        let about = AboutPoint::new(StratumKind::Boundary, &vec![1; count], &found, REACH * dl);
        let skeleton = about.ask(|analyzer, strata| Skeleton::lay(analyzer, strata, dl).unwrap());
        let ends = skeleton.edges().iter().flat_map(|e| e.landmarks());
        ends.filter(|&end| end == Landmark::new(0)).count()
    }

    #[test]
    fn a_boundary_ends_in_its_point_over_a_gap_or_a_stub() {
        let whole = ray(2.0, &[[0.2, 6.0]]);
        let one = |boundary: Vec<Place>| joined(&[whole.clone(), boundary], &[], 1.0);
        assert_eq!(one(ray(0.0, &[[0.2, 6.0]])), 2);
        // A gap that the labels of the fit do not reach over.
        assert_eq!(one(ray(0.0, &[[2.6, 6.0]])), 2);
        // Few points in the gap, too few for a landmark of their own; one is enough.
        assert_eq!(one(ray(0.0, &[[0.3, 0.8], [2.4, 6.0]])), 2);
        assert_eq!(one(ray(0.0, &[[0.6, 0.6], [2.4, 6.0]])), 2);
        // Farther away it is another boundary.
        assert_eq!(one(ray(0.0, &[[3.2, 6.0]])), 1);
        assert_eq!(one(ray(0.0, &[[0.3, 0.8], [3.2, 6.0]])), 1);
    }

    /// The other one has no points that say where it leaves the point, and would take either end.
    #[test]
    fn an_end_is_left_to_the_boundary_whose_stub_leads_there() {
        let bare = ray(2.36, &[[2.96, 6.96]]);
        let stub = ray(3.36, &[[0.3, 0.8], [2.89, 6.89]]);
        assert_eq!(joined(&[bare.clone(), stub.clone()], &[], 0.01), 2);
        assert_eq!(joined(&[stub, bare], &[], 0.01), 2);
    }

    #[test]
    fn other_boundaries_stay_as_they_are() {
        let whole = ray(2.0, &[[0.2, 6.0]]);
        // One that the fit does not count ends nearby.
        assert_eq!(
            joined(std::slice::from_ref(&whole), &ray(0.0, &[[2.0, 6.0]]), 1.0),
            1
        );
        // One that is counted leaves to the right, as its stub says: what ends above and to the left is another.
        let stub = ray(0.0, &[[0.3, 0.8]]);
        let left = ray(1.2, &[[2.5, 6.0]]);
        assert_eq!(joined(&[whole.clone(), stub], &left, 1.0), 1);
        // One that passes by does not come from the point.
        let past = |k: u32| [2.2 - 0.03 * f64::from(k), 0.1 * f64::from(k)];
        let past: Vec<Place> = (0..25).map(past).collect();
        assert_eq!(joined(&[whole, Vec::new()], &past, 1.0), 1);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Up to four boundaries at right angles, each with a gap at its point and with a stub or without one: those end
        /// in the point that begin no farther from it than chains are joined over.
        #[test]
        fn boundaries_are_joined_whose_gap_is_not_too_wide(
            arms in proptest::collection::vec((0.2..6.0f64, any::<bool>()), 1..=4),
            turn in 0.0..4.0f64,
            dl in 0.01..100.0f64,
        ) {
            let boundary = |(k, &(gap, stub)): (usize, &(f64, bool))| {
                let stub = (stub && gap > REACH).then_some([0.3, 0.8]);
                let stretches = stub.into_iter().chain([[gap, gap + 4.0]]);
                ray(turn + k as f64, &stretches.collect::<Vec<_>>())
            };
            let boundaries: Vec<Vec<Place>> = arms.iter().enumerate().map(boundary).collect();
            let limit = Tuning::MEASURED.skeleton.join;
            prop_assume!(arms.iter().all(|x| (x.0 - limit).abs() > 1e-6));
            let near = arms.iter().filter(|x| x.0 < limit).count();
            prop_assert_eq!(joined(&boundaries, &[], dl), near);
        }
    }
}
