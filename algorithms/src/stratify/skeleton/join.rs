//! Chains that stop at nothing are joined.

use super::Skeleton;
use super::ground::Ground;
use crate::orthogonal::dot;
use crosscap_core::{CurveEdge, Landmark, Scalar, Table};

/// Cosine of the sharpest turn of a curve without a surface where a gap of its points is joined over: one sharper than 135 degrees
/// goes back along the curve, from one end of a segment to the other.
const SHARPEST: f64 = -std::f64::consts::FRAC_1_SQRT_2;

impl Skeleton {
    /// Joins ends of chains that stop at nothing, and landmarks of curves that no chain reached, nearest
    /// pairs first: where the points of a curve have a gap.
    pub(super) fn join_free_ends<S: Scalar>(&mut self, ground: &Ground<'_, '_, S>) {
        let mut degree: Table<Landmark, u32> = Table::filled(self.rows.len(), 0);
        for end in self.edges.iter().flat_map(CurveEdge::landmarks) {
            degree[end] += 1;
        }
        let cells = &self.cells;
        // Curves of two cells are folds, which fade out.
        let free: Vec<Landmark> = (self.rows.ids().skip(self.corners))
            .filter(|&k| degree[k] < 2 && cells[k] != 2)
            .collect();
        let reach = ground.tuning.join * ground.dl;
        let mut pairs = Vec::new();
        for (x, &a) in free.iter().enumerate() {
            for &b in &free[..x] {
                let joined = self.edges.iter().any(|e| e.landmarks() == [b, a]);
                let d = ground.distance(self.rows[a], self.rows[b]);
                let goes_on = || {
                    cells[a] > 0
                        || ground.is_followed(self.rows[a], self.rows[b], self.rows.len())
                            && !self.turns_back(ground, a, b)
                            && !self.turns_back(ground, b, a)
                };
                if cells[a] == cells[b] && d <= reach && !joined && goes_on() {
                    pairs.push((d, b, a));
                }
            }
        }
        pairs.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        for (_, a, b) in pairs {
            if degree[a] < 2 && degree[b] < 2 {
                degree[a] += 1;
                degree[b] += 1;
                let edge = CurveEdge::new(a.into(), b.into(), cells[a]);
                self.edges.push(edge);
            }
        }
    }

    /// Whether the way from the end of a chain to another landmark goes back along the chain.
    fn turns_back<S: Scalar>(
        &self,
        ground: &Ground<'_, '_, S>,
        end: Landmark,
        to: Landmark,
    ) -> bool {
        let place = |k: Landmark| ground.places.point(self.rows[k].index());
        let mut before = self.edges.iter().filter_map(|edge| match edge.landmarks() {
            [a, b] if b == end => Some(a),
            [a, b] if a == end => Some(b),
            _ => None,
        });
        before.any(|back| cosine([place(back), place(end), place(to)]) < SHARPEST)
    }
}

/// Cosine of the angle between the ways from the first place to the second and from there to the third; 1 where one has no
/// length.
fn cosine([from, at, to]: [&[f64]; 3]) -> f64 {
    let way = |p: &[f64], q: &[f64]| -> Vec<f64> { p.iter().zip(q).map(|(x, y)| y - x).collect() };
    let (first, second) = (way(from, at), way(at, to));
    let lengths = (dot(&first, &first) * dot(&second, &second)).sqrt();
    if lengths > 0.0 {
        dot(&first, &second) / lengths
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_goes_on_round_a_triangle_and_not_back_along_a_segment() {
        let places = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()], [0.1, 0.01]];
        let turn = |k: [usize; 3]| cosine(k.map(|k| &places[k][..]));
        assert!((turn([0, 1, 2]) + 0.5).abs() < 1e-12 && turn([0, 1, 2]) > SHARPEST);
        assert!(turn([0, 1, 3]) < SHARPEST);
        assert_eq!(turn([0, 0, 1]), 1.0);
    }
}
