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
    /// direction, one of them has a corner less than `offset` off the plane of the other, and the
    /// projection to that plane overlaps the other by more than `depth`. Seen from both.
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
        let near = (0..3).any(|i| {
            let off: f64 = (0..n)
                .map(|k| {
                    let o = other[i][k] - origin[k] - upper[i][0] * e[k] - upper[i][1] * f[k];
                    o * o
                })
                .sum();
            off < offset * offset
        });
        near && overlap(lower, upper, depth) > depth
    }
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
