//! Chains that stop at nothing are joined.

use super::Skeleton;
use super::ground::Ground;
use crosscap_core::{CurveEdge, Landmark, Scalar, Table};

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
                if cells[a] == cells[b] && d <= reach && !joined {
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
}
