//! Triangles of R^N that lie on top of each other.

use super::triangle::corners;
use crate::orthogonal::dot;
use crosscap_core::Mesh;

/// Every triangle's plane, as two orthonormal directions.
pub(super) struct Planes<'a> {
    mesh: &'a Mesh,
    /// Two directions a triangle, 2 N numbers.
    directions: Vec<f64>,
    /// N numbers a triangle.
    centroids: Vec<f64>,
}

impl<'a> Planes<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        let n = mesh.vertices.dimension();
        let count = mesh.complex.triangles.len();
        let mut directions = vec![0.0; 2 * n * count];
        let mut centroids = vec![0.0; n * count];
        for t in 0..count {
            let [a, b, c] = corners(mesh, t as u32);
            let (first, second) = directions[2 * n * t..2 * n * (t + 1)].split_at_mut(n);
            for k in 0..n {
                first[k] = b[k] - a[k];
                second[k] = c[k] - a[k];
                centroids[n * t + k] = (a[k] + b[k] + c[k]) / 3.0;
            }
            let length = dot(first, first).sqrt().max(f64::MIN_POSITIVE);
            first.iter_mut().for_each(|x| *x /= length);
            let along = dot(first, second);
            for k in 0..n {
                second[k] -= along * first[k];
            }
            let length = dot(second, second).sqrt().max(f64::MIN_POSITIVE);
            second.iter_mut().for_each(|x| *x /= length);
        }
        Self {
            mesh,
            directions,
            centroids,
        }
    }

    /// Whether the centroids of two triangles are at most `reach` apart.
    pub fn centroids_within(&self, s: u32, t: u32, reach: f64) -> bool {
        let n = self.mesh.vertices.dimension();
        let at = |t: u32| &self.centroids[n * t as usize..n * (t as usize + 1)];
        let mut sum = 0.0;
        let limit = reach * reach;
        for (a, b) in at(s).iter().zip(at(t)) {
            sum += (a - b) * (a - b);
            if sum > limit {
                return false;
            }
        }
        true
    }

    /// Whether the planes of two triangles make an angle below `angle` degrees in every
    /// direction, the projection of one to the plane of the other overlaps that by more than `depth`, and somewhere in the
    /// overlap the two are less than `offset` apart. Seen from both.
    ///
    /// What counts is how far apart they are where they overlap: two sheets that cross are near each other along their curve, and
    /// triangles beside it whose projections overlap need not be.
    pub fn stacked(&self, s: u32, t: u32, angle: f64, depth: f64, offset: f64) -> bool {
        let n = self.mesh.vertices.dimension();
        let plane =
            |t: u32| self.directions[2 * n * t as usize..2 * n * (t as usize + 1)].split_at(n);
        let ((p, q), (u, v)) = (plane(s), plane(t));
        // smallest singular value of the 2 x 2 matrix of inner products: cosine of the largest
        // principal angle
        let (a, b, c, d) = (dot(p, u), dot(p, v), dot(q, u), dot(q, v));
        let half = 0.5 * (a * a + b * b + c * c + d * d);
        let determinant = a * d - b * c;
        let least = half - (half * half - determinant * determinant).max(0.0).sqrt();
        let cosine = angle.to_radians().cos();
        if least <= cosine * cosine {
            return false;
        }
        self.over(s, t, depth, offset) || self.over(t, s, depth, offset)
    }

    /// Overlap of `t`, projected to the plane of `s`, with `s`.
    fn over(&self, s: u32, t: u32, depth: f64, offset: f64) -> bool {
        let n = self.mesh.vertices.dimension();
        let base = corners(self.mesh, s);
        let origin = base[0];
        let (e, f) = self.directions[2 * n * s as usize..2 * n * (s as usize + 1)].split_at(n);
        let flatten = |x: &[f64]| {
            let (mut along, mut across) = (0.0, 0.0);
            for k in 0..n {
                let w = x[k] - origin[k];
                along += w * e[k];
                across += w * f[k];
            }
            [along, across]
        };
        let other = corners(self.mesh, t);
        let lower = base.map(flatten);
        let upper = other.map(flatten);
        if overlap(lower, upper, depth) <= depth {
            return false;
        }
        let offsets = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let [x, y] = [upper[i], upper[j]];
                let whole: f64 = (0..n)
                    .map(|k| (other[i][k] - origin[k]) * (other[j][k] - origin[k]))
                    .sum();
                whole - x[0] * y[0] - x[1] * y[1]
            })
        });
        least_offset(lower, upper, &offsets) < offset * offset
    }
}

/// Least square of the distance of a triangle from a plane along the rim of what its projection `upper` has in common with the
/// triangle `lower` of that plane; `offsets` are the inner products of the offsets of its corners.
///
/// Inside of the rim the two would have to pass each other, which is told where triangles meet.
fn least_offset(lower: [[f64; 2]; 3], upper: [[f64; 2]; 3], offsets: &[[f64; 3]; 3]) -> f64 {
    let (corners, count) = common(upper, lower);
    let inner = |a: [f64; 3], b: [f64; 3]| -> f64 {
        (0..3)
            .map(|i| a[i] * (0..3).map(|j| offsets[i][j] * b[j]).sum::<f64>())
            .sum()
    };
    let mut least = f64::INFINITY;
    for k in 0..count {
        let [from, to] = [corners[k], corners[(k + 1) % count]].map(|p| shares(upper, p));
        let way = std::array::from_fn(|i| to[i] - from[i]);
        let (across, square) = (inner(from, way), inner(way, way));
        // Where on the side it is least; where the side does not leave the plane it is the same everywhere.
        let at = match square > 0.0 {
            true => (-across / square).clamp(0.0, 1.0),
            false => 0.0,
        };
        least = least.min(inner(from, from) + at * (2.0 * across + at * square));
    }
    least
}

/// Twice the signed area of a triangle of the plane.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Barycentric coordinates of a place in a triangle of the plane.
fn shares([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> [f64; 3] {
    let whole = area(a, b, c);
    [
        area(p, b, c) / whole,
        area(a, p, c) / whole,
        area(a, b, p) / whole,
    ]
}

/// Most corners that two triangles have in common.
const COMMON: usize = 6;

/// The corners of what two triangles of the plane have in common, in order, and their number (I. Sutherland, G. Hodgman,
/// Communications of the ACM 17, 1974).
fn common(a: [[f64; 2]; 3], b: [[f64; 2]; 3]) -> ([[f64; 2]; COMMON], usize) {
    let mut kept = [[0.0; 2]; COMMON];
    kept[..3].copy_from_slice(&a);
    let mut count = 3;
    let way = area(b[0], b[1], b[2]).signum();
    for k in 0..3 {
        let inside = |p: [f64; 2]| way * area(b[k], b[(k + 1) % 3], p);
        let before = kept;
        let last = count;
        count = 0;
        let mut keep = |p: [f64; 2]| {
            if count < COMMON {
                kept[count] = p;
                count += 1;
            }
        };
        for i in 0..last {
            let (from, to) = (before[i], before[(i + 1) % last]);
            let (d, e) = (inside(from), inside(to));
            if d >= 0.0 {
                keep(from);
            }
            if (d >= 0.0) != (e >= 0.0) {
                let at = d / (d - e);
                keep(std::array::from_fn(|k| from[k] + at * (to[k] - from[k])));
            }
        }
    }
    (kept, count)
}

/// How deep two triangles of the plane overlap: the shortest move that separates them, over the
/// normals of all six sides. Negative when they are apart; no more than `enough` where that is all
/// that the first few sides tell.
fn overlap(a: [[f64; 2]; 3], b: [[f64; 2]; 3], enough: f64) -> f64 {
    let mut least = f64::INFINITY;
    for triangle in [a, b] {
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            let normal = [from[1] - to[1], to[0] - from[0]];
            let square = normal[0] * normal[0] + normal[1] * normal[1];
            let length = square.sqrt().max(f64::MIN_POSITIVE);
            let span = |t: [[f64; 2]; 3]| {
                t.iter()
                    .map(|x| x[0] * normal[0] + x[1] * normal[1])
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |s, x| {
                        (s.0.min(x), s.1.max(x))
                    })
            };
            let (p, q) = (span(a), span(b));
            least = least.min((p.1.min(q.1) - p.0.max(q.0)) / length);
            if least <= enough {
                return least;
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_triangles_have_in_common() {
        let t = [[0., 0.], [1., 0.], [0., 1.]];
        let (corners, count) = common(t, t.map(|p: [f64; 2]| [p[0] + 0.5, p[1]]));
        let mut found = corners[..count].to_vec();
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(found, [[0.5, 0.0], [0.5, 0.5], [1.0, 0.0]]);
        assert_eq!(common(t, t.map(|p| [p[0] + 2.0, p[1]])).1, 0);
        // A hexagon: a triangle and the same upside down.
        let star = [[-1., 0.], [1., 0.], [0., 3.]];
        assert_eq!(common(star, star.map(|p| [p[0], 2.0 - p[1]])).1, COMMON);
    }

    /// Two sheets that cross at 20 degrees are stacked at their curve, and not where they have parted.
    #[test]
    fn offset_where_they_overlap() {
        let slope = 20.0_f64.to_radians().tan();
        let pair = |x: f64| {
            let lower = [[x, 0.], [x + 1., 0.], [x, 1.]];
            let height = |p: [f64; 2]| slope * p[0];
            let offsets = std::array::from_fn(|i| {
                std::array::from_fn(|j| height(lower[i]) * height(lower[j]))
            });
            least_offset(lower, lower, &offsets).sqrt()
        };
        assert!(pair(0.0) < 1e-12);
        assert!(pair(-0.5) < 1e-12);
        assert!((pair(2.0) - 2.0 * slope).abs() < 1e-9);
    }

    #[test]
    fn depth_of_overlap() {
        let t = [[0., 0.], [1., 0.], [0., 1.]];
        let moved = |x: f64| t.map(|p: [f64; 2]| [p[0] + x, p[1]]);
        let depth = 0.1 / 2.0_f64.sqrt();
        assert!((overlap(t, moved(0.9), 0.0) - depth).abs() < 1e-12);
        assert!(overlap(t, moved(0.9), 0.09) <= 0.09);
        assert!(overlap(t, moved(1.5), 0.0) < 0.0);
        assert!(overlap(t, t, 0.0) > 0.7);
    }
}
