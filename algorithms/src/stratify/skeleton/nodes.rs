//! The points of a kind of curve that chains are laid over, with what fits about corners say of them.

use super::Skeleton;
use super::ground::Ground;
use super::thin::thin;
use crate::orthogonal::dot;
use crate::stratify::atlas::Reference;
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
    /// together the nearest point that is on one arc alone decides.
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
                let own = || on_arc.iter().filter(|x| x.1.0 == k);
                if corner.is_cell(l) {
                    return arc_of_gap(ground, corner, row, own()).map(|arc| (k, arc));
                }
                nearest(ground, row, own()).map(|x| x.1)
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

/// The nearest of points on arcs to a row.
fn nearest<'o, S: Scalar>(
    ground: &Ground<'_, '_, S>,
    row: Row,
    on_arcs: impl Iterator<Item = &'o (Row, Branch)>,
) -> Option<&'o (Row, Branch)> {
    let far = |x: &(Row, Branch)| ground.distance(x.0, row);
    on_arcs.min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// The arc that a point fills a gap of, where the fit about a corner takes it for one of a cell: it is on the side of the corner that the arc is on,
/// and in as many cells. The nearest point on such an arc decides, if it is near: the point can be on another curve as well,
/// that the corner knows nothing of. Otherwise it is on the arc that begins behind it, beside the way there from the corner, or, where no arc
/// comes into question, on the only one that no point is on.
fn arc_of_gap<'o, S: Scalar>(
    ground: &Ground<'_, '_, S>,
    corner: &Reference,
    row: Row,
    on_arcs: impl Iterator<Item = &'o (Row, Branch)> + Clone,
) -> Option<Label> {
    let out = ground.way(corner.row, row);
    let cells = ground.strata.cells(row);
    let on_side = |x: &&(Row, Branch)| dot(&ground.way(corner.row, x.0), &out) > 0.0;
    let alike = (on_arcs.clone()).filter(|x| ground.strata.cells(x.0) == cells && on_side(x));
    let beside = nearest(ground, row, alike.clone());
    if let Some(x) = beside.filter(|x| ground.distance(x.0, row) < ground.dl) {
        return Some(x.1.1);
    }
    let mut arcs = (corner.fit.labels_of(1)).filter(|&arc| corner.fit.cells_at(arc) == Some(cells));
    if beside.is_none() {
        let mut bare = arcs.filter(|&arc| on_arcs.clone().all(|x| x.1.1 != arc));
        return bare.next().filter(|_| bare.next().is_none());
    }
    arcs.find(|&arc| {
        let first = nearest(ground, corner.row, alike.clone().filter(|x| x.1.1 == arc));
        first.is_some_and(|x| {
            let way = ground.way(corner.row, x.0);
            let share = dot(&way, &out) / dot(&way, &way);
            let off = dot(&out, &out) - share * share * dot(&way, &way);
            share < 1.0 && off < ground.dl * ground.dl
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stratify::skeleton::about_point::{AboutPoint, Found, Place};
    use proptest::prelude::*;

    const CELLS: [u8; 3] = [4, 2, 2];
    /// The ways of a pinch point's double curve and of its two folds.
    const ARCS: [Place; 3] = [[1.0, 0.0], [-0.6, 0.8], [-0.6, -0.8]];
    /// What the fit about the point calls the cell.
    const CELL: Label = Label::new(4);

    /// Points so far along an arc, in dl, that the fit about the point knows to be on it.
    fn on(arc: usize, steps: &[f64]) -> Vec<Found> {
        let found = |&step: &f64| Found {
            place: ARCS[arc].map(|x| step * x),
            label: Some(Label::new(1 + arc)),
            cells: CELLS[arc],
        };
        steps.iter().map(found).collect()
    }

    /// The arc that a point is taken to be on which the fit about a pinch point takes for one of a cell, beside the points found on arcs.
    fn arc(found: &[Vec<Found>], gap: Found, dl: f64) -> Option<usize> {
        let scaled = |x: Found| Found {
            place: x.place.map(|x| x * dl),
            ..x
        };
        let all: Vec<Found> = found
            .iter()
            .flatten()
            .copied()
            .chain([gap])
            .map(scaled)
            .collect();
        let about = AboutPoint::new(StratumKind::Curve, &CELLS, &all, 4.0 * dl);
        about.ask(|analyzer, strata| {
            let fitter = analyzer.fitter("").unwrap();
            let ground = Ground {
                fitter: &fitter,
                strata,
                places: strata.places().unwrap(),
                tuning: &analyzer.tuning.skeleton,
                dl,
            };
            let mut skeleton = Skeleton::default();
            skeleton.lay_points(&ground);
            let nodes = Nodes::of(&skeleton, &ground, StratumKind::Curve);
            let at = nodes
                .rows
                .iter()
                .position(|&row| row == Row::new(all.len()));
            nodes.branches[at.unwrap()].map(|x| x.1.index() - 1)
        })
    }

    /// A point on a curve of so many cells that the fit takes for one of a cell.
    fn gap(place: Place, cells: u8) -> Found {
        Found {
            place,
            label: Some(CELL),
            cells,
        }
    }

    #[test]
    fn a_gap_is_filled_in_the_arc_of_as_many_cells_on_its_side() {
        let all: Vec<Vec<Found>> = (0..3).map(|k| on(k, &[1.0, 1.5, 2.0])).collect();
        let at = |place, cells| arc(&all, gap(place, cells), 1.0);
        assert_eq!(at([0.6, 0.1], 4), Some(0));
        assert_eq!(at([-0.4, 0.5], 2), Some(1));
        assert_eq!(at([-0.4, -0.5], 2), Some(2));
        // The double curve is near, but a fold is none.
        assert_eq!(at([0.7, 0.35], 2), None);
        assert_eq!(at([-0.4, 0.5], 4), None);
        // Nothing is near but the point, and the fold goes on behind.
        let far = [all[0].clone(), on(1, &[3.0, 3.5]), on(2, &[0.5, 1.0])];
        assert_eq!(arc(&far, gap([-0.2, 0.9], 2), 1.0), Some(1));
        // Another curve, of which the fit knows nothing.
        assert_eq!(at([-0.6, 3.0], 2), None);
    }

    #[test]
    fn an_arc_without_points_is_that_of_the_point_that_fills_it() {
        let found = [on(0, &[0.8, 1.3]), on(2, &[0.5, 1.0, 1.5])];
        let at = |place, cells| arc(&found, gap(place, cells), 1.0);
        // Within dl of the other fold, across the point, and of the double curve.
        assert_eq!(at([-0.06, 0.38], 2), Some(1));
        assert_eq!(at([0.1, 0.6], 2), Some(1));
        assert_eq!(at([-0.45, -0.45], 2), Some(2));
        // Two arcs are without points: it may be on either.
        let double_curve = [on(0, &[0.8, 1.3])];
        assert_eq!(arc(&double_curve, gap([0.1, 0.6], 2), 1.0), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// A point that lies on an arc is on that arc, wherever along it points are known, or on none.
        #[test]
        fn a_gap_is_never_filled_in_another_arc(
            known in proptest::collection::vec(proptest::collection::vec(0.5..2.5f64, 0..6), 3),
            step in 0.3..2.5f64,
            own in 0usize..3,
            dl in 0.01..100.0f64,
        ) {
            let clear = |x: &f64| (x - step).abs() > 0.25;
            let known = known.iter().enumerate().map(|(k, steps)| {
                let steps: Vec<f64> = steps.iter().copied().filter(|x| k != own || clear(x)).collect();
                on(k, &steps)
            });
            let known: Vec<Vec<Found>> = known.collect();
            let found = arc(&known, gap(ARCS[own].map(|x| step * x), CELLS[own]), dl);
            prop_assert!(found.is_none_or(|arc| arc == own), "{found:?} for {own}");
        }
    }
}
