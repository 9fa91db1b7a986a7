//! Whether two triangles of space meet outside their common vertices: exact.

use robust::{Coord, Coord3D, orient2d, orient3d};

/// Places of at most three coordinates, scaled by a power of two so that no product of three
/// of them leaves the range of `f64`; the scaling is exact, hence so are the answers.
pub(super) struct Places {
    places: Vec<Coord3D<f64>>,
}

impl Places {
    /// `rows` of one to three coordinates.
    pub fn new<'a>(rows: impl Iterator<Item = &'a [f64]>) -> Self {
        let mut places: Vec<Coord3D<f64>> = rows
            .map(|r| {
                let at = |k: usize| r.get(k).copied().unwrap_or(0.0);
                Coord3D {
                    x: at(0),
                    y: at(1),
                    z: at(2),
                }
            })
            .collect();
        let top = places
            .iter()
            .map(|p| p.x.abs().max(p.y.abs()).max(p.z.abs()))
            .fold(0.0, f64::max);
        if top > 0.0 && !(1e-30..1e30).contains(&top) {
            let factor = 2.0_f64.powi(-(top.log2().floor() as i32).clamp(-1000, 1000));
            for p in &mut places {
                p.x *= factor;
                p.y *= factor;
                p.z *= factor;
            }
        }
        Self { places }
    }

    /// Whether two triangles meet in more than their common vertices.
    ///
    /// With an edge in common the answer is `false`: what can be wrong then is a fold. With one
    /// vertex in common, whatever else they share reaches the side opposite of it in one of
    /// them, so these two sides are tried. Touching counts.
    pub fn meet(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        let shared = s.iter().filter(|v| t.contains(v)).count();
        let sides = |r: [u32; 3]| [[r[0], r[1]], [r[1], r[2]], [r[0], r[2]]];
        match shared {
            0 => {
                // sides of one plane strictly apart: the common case
                if self.beside(s, t) || self.beside(t, s) {
                    return false;
                }
                sides(s).iter().any(|&e| self.segment_meets(e, t))
                    || sides(t).iter().any(|&e| self.segment_meets(e, s))
            }
            1 => {
                let opposite = |r: [u32; 3], other: [u32; 3]| {
                    sides(r)
                        .into_iter()
                        .find(|e| !other.contains(&e[0]) && !other.contains(&e[1]))
                };
                opposite(s, t).is_some_and(|e| self.segment_meets(e, t))
                    || opposite(t, s).is_some_and(|e| self.segment_meets(e, s))
            }
            _ => false,
        }
    }

    fn at(&self, v: u32) -> Coord3D<f64> {
        self.places[v as usize]
    }

    fn side(&self, t: [u32; 3], p: u32) -> f64 {
        orient3d(self.at(t[0]), self.at(t[1]), self.at(t[2]), self.at(p))
    }

    /// Whether all of `s` lies strictly on one side of the plane of `t`.
    fn beside(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        let o = s.map(|p| self.side(t, p));
        o.iter().all(|&x| x > 0.0) || o.iter().all(|&x| x < 0.0)
    }

    /// Whether a closed segment meets a closed triangle.
    fn segment_meets(&self, [p, q]: [u32; 2], t: [u32; 3]) -> bool {
        let (at_p, at_q) = (self.side(t, p), self.side(t, q));
        if (at_p > 0.0 && at_q > 0.0) || (at_p < 0.0 && at_q < 0.0) {
            return false;
        }
        if at_p == 0.0 && at_q == 0.0 {
            return self.flat_meets(p, q, t);
        }
        let turn = |a: u32, b: u32| orient3d(self.at(p), self.at(q), self.at(a), self.at(b));
        let o = [turn(t[0], t[1]), turn(t[1], t[2]), turn(t[2], t[0])];
        o.iter().all(|&x| x >= 0.0) || o.iter().all(|&x| x <= 0.0)
    }

    /// The same in a common plane, seen along an axis in which the triangle keeps an area.
    fn flat_meets(&self, p: u32, q: u32, t: [u32; 3]) -> bool {
        for axis in 0..3 {
            let flat = |v: u32| {
                let c = self.at(v);
                match axis {
                    0 => Coord { x: c.y, y: c.z },
                    1 => Coord { x: c.z, y: c.x },
                    _ => Coord { x: c.x, y: c.y },
                }
            };
            let corners = t.map(flat);
            let turn = orient2d(corners[0], corners[1], corners[2]);
            if turn == 0.0 {
                continue;
            }
            let (p, q) = (flat(p), flat(q));
            let inside = |x: Coord<f64>| {
                (0..3).all(|k| orient2d(corners[k], corners[(k + 1) % 3], x) * turn.signum() >= 0.0)
            };
            return inside(p)
                || inside(q)
                || (0..3).any(|k| segments_meet(p, q, corners[k], corners[(k + 1) % 3]));
        }
        // a triangle without area is refused as such
        false
    }
}

/// Whether two closed segments of the plane meet.
fn segments_meet(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>, d: Coord<f64>) -> bool {
    let sign = |x: f64| (x > 0.0) as i8 - (x < 0.0) as i8;
    let (o1, o2) = (sign(orient2d(a, b, c)), sign(orient2d(a, b, d)));
    let (o3, o4) = (sign(orient2d(c, d, a)), sign(orient2d(c, d, b)));
    if o1 != o2 && o3 != o4 {
        return true;
    }
    let within = |p: Coord<f64>, q: Coord<f64>, x: Coord<f64>| {
        x.x >= p.x.min(q.x) && x.x <= p.x.max(q.x) && x.y >= p.y.min(q.y) && x.y <= p.y.max(q.y)
    };
    (o1 == 0 && within(a, b, c))
        || (o2 == 0 && within(a, b, d))
        || (o3 == 0 && within(c, d, a))
        || (o4 == 0 && within(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meets(rows: &[[f64; 3]], s: [u32; 3], t: [u32; 3]) -> bool {
        let ways = Places::new(rows.iter().map(|r| &r[..]));
        let answer = ways.meet(s, t);
        assert_eq!(answer, ways.meet(t, s));
        answer
    }

    const BASE: [[f64; 3]; 3] = [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]];

    fn against(other: [[f64; 3]; 3]) -> bool {
        let rows: Vec<[f64; 3]> = BASE.iter().chain(&other).copied().collect();
        meets(&rows, [0, 1, 2], [3, 4, 5])
    }

    #[test]
    fn disjoint_touching_and_crossing() {
        assert!(against([[1., 1., -1.], [1., 1., 1.], [9., 9., 1.]]));
        assert!(!against([[1., 1., 0.5], [1., 2., 1.], [9., 9., 1.]]));
        assert!(
            against([[1., 1., 0.], [1., 2., 1.], [2., 1., 1.]]),
            "corner on face"
        );
        assert!(
            !against([[3., 3., -1.], [3., 3., 1.], [9., 9., 1.]]),
            "beyond the side"
        );
        assert!(
            against([[1., 1., 0.], [2., 1., 0.], [1., 2., 0.]]),
            "inside, same plane"
        );
        assert!(
            !against([[5., 5., 0.], [6., 5., 0.], [5., 6., 0.]]),
            "same plane, apart"
        );
        assert!(
            against([[-1., -1., 0.], [9., -1., 0.], [-1., 9., 0.]]),
            "contains it"
        );
    }

    #[test]
    fn one_common_vertex() {
        let mut rows: Vec<[f64; 3]> = BASE.to_vec();
        rows.extend([
            [1., 2., 1.],
            [2., 1., -1.],
            [-3., -1., 2.],
            [-1., -3., 2.],
            [1., 1., 0.],
            [9., 9., 3.],
        ]);
        assert!(
            meets(&rows, [0, 1, 2], [0, 3, 4]),
            "pierces through the common corner"
        );
        assert!(!meets(&rows, [0, 1, 2], [0, 5, 6]));
        assert!(
            meets(&rows, [0, 1, 2], [0, 7, 8]),
            "a side inside the other"
        );
        assert!(
            !meets(&rows, [0, 1, 2], [0, 1, 3]),
            "a common edge is a matter of folds"
        );
    }

    #[test]
    fn scale_does_not_matter() {
        for scale in [1e-120, 1e120] {
            let other = [[1., 1., -1.], [1., 1., 1.], [9., 9., 1.]];
            let rows: Vec<[f64; 3]> = BASE
                .iter()
                .chain(&other)
                .map(|r| r.map(|x| x * scale))
                .collect();
            assert!(meets(&rows, [0, 1, 2], [3, 4, 5]));
        }
    }
}
