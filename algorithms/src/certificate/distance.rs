//! Distances of points and triangles in R^N, through inner products alone.

/// Inner product of `b - a` and `d - c`.
fn dot(a: &[f64], b: &[f64], c: &[f64], d: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .zip(c.iter().zip(d))
        .map(|((a, b), (c, d))| (b - a) * (d - c))
        .sum()
}

/// Inner products of the sides u, v of a triangle at its first corner and of w, which leads to a point.
#[derive(Clone, Copy)]
pub(super) struct Products {
    pub uu: f64,
    pub uv: f64,
    pub vv: f64,
    pub wu: f64,
    pub wv: f64,
    pub ww: f64,
}

impl Products {
    /// Those of the triangle `a`, `b`, `c`, with w from `from` to `p`.
    pub fn of(p: &[f64], from: &[f64], [a, b, c]: [&[f64]; 3]) -> Self {
        let (mut uu, mut uv, mut vv, mut wu, mut wv, mut ww) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for k in 0..p.len() {
            let (u, v, w) = (b[k] - a[k], c[k] - a[k], p[k] - from[k]);
            uu += u * u;
            uv += u * v;
            vv += v * v;
            wu += w * u;
            wv += w * v;
            ww += w * w;
        }
        Self {
            uu,
            uv,
            vv,
            wu,
            wv,
            ww,
        }
    }

    /// The square of the area of the parallelogram, where it is more than rounding.
    pub fn determinant(&self) -> Option<f64> {
        let determinant = self.uu * self.vv - self.uv * self.uv;
        (determinant > 1e-14 * self.uu * self.vv).then_some(determinant)
    }

    /// Shares of u and v at the foot of the point, with w from the first corner, where that is inside the triangle.
    pub fn inside(&self) -> Option<[f64; 2]> {
        let determinant = self.determinant()?;
        let s = self.vv * self.wu - self.uv * self.wv;
        let t = self.uu * self.wv - self.uv * self.wu;
        let inside = s >= 0.0 && t >= 0.0 && s + t <= determinant;
        inside.then(|| [s / determinant, t / determinant])
    }
}

/// Squared distance of `p` to the triangle `a`, `b`, `c`, which may be degenerate.
///
/// Rounding: about 1e-16 of the squared distance to `a`.
pub(super) fn point_triangle(p: &[f64], a: &[f64], b: &[f64], c: &[f64]) -> f64 {
    let products = Products::of(p, a, [a, b, c]);
    let Products {
        uu,
        uv,
        vv,
        wu,
        wv,
        ww,
    } = products;
    let squared = if let Some([s, t]) = products.inside() {
        ww - 2.0 * (s * wu + t * wv) + s * s * uu + 2.0 * s * t * uv + t * t * vv
    } else {
        let side = |along: f64, length: f64, from: f64| {
            let k = if length > 0.0 {
                (along / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            from - 2.0 * k * along + k * k * length
        };
        side(wu, uu, ww).min(side(wv, vv, ww)).min(side(
            wv - wu - uv + uu,
            uu - 2.0 * uv + vv,
            ww - 2.0 * wu + uu,
        ))
    };
    squared.max(0.0)
}

/// Squared distance of two triangles in any dimension.
///
/// The two nearest places lie inside a face of each, and are the nearest places of the affine
/// hulls of these faces: all 49 pairs of faces are tried.
pub(super) fn triangle_triangle(s: [&[f64]; 3], t: [&[f64]; 3]) -> f64 {
    let corners = [s[0], s[1], s[2], t[0], t[1], t[2]];
    // inner products relative to the first corner of `s`
    let mut gram = [[0.0; 6]; 6];
    for i in 1..6 {
        for j in 1..=i {
            gram[i][j] = dot(s[0], corners[i], s[0], corners[j]);
            gram[j][i] = gram[i][j];
        }
    }
    let mut best = f64::INFINITY;
    for first in 1..8_usize {
        for second in 1..8_usize {
            if let Some(d) = face_distance(&gram, first, second) {
                best = best.min(d);
            }
        }
    }
    best.max(0.0)
}

/// Squared distance of the affine hulls of two faces (bit masks of corners), if it is attained
/// inside both.
fn face_distance(gram: &[[f64; 6]; 6], first: usize, second: usize) -> Option<f64> {
    let a = first.trailing_zeros() as usize;
    let b = 3 + second.trailing_zeros() as usize;
    // directions as differences of corners; those of the second face enter negatively
    let mut directions = [(0_usize, 0_usize); 4];
    let mut count = 0;
    for i in a + 1..3 {
        if first >> i & 1 == 1 {
            directions[count] = (i, a);
            count += 1;
        }
    }
    let split = count;
    for j in b + 1..6 {
        if second >> (j - 3) & 1 == 1 {
            directions[count] = (b, j);
            count += 1;
        }
    }
    let inner = |(i, j): (usize, usize), (k, l): (usize, usize)| {
        gram[i][k] - gram[i][l] - gram[j][k] + gram[j][l]
    };
    let offset = (a, b);
    let mut matrix = [[0.0; 5]; 4];
    for i in 0..count {
        for j in 0..count {
            matrix[i][j] = inner(directions[i], directions[j]);
        }
        matrix[i][4] = -inner(directions[i], offset);
    }
    let right: [f64; 4] = std::array::from_fn(|i| matrix[i][4]);
    let x = solve(matrix, count)?;
    let weights_inside = |w: &[f64]| w.iter().all(|&w| w >= 0.0) && w.iter().sum::<f64>() <= 1.0;
    if !weights_inside(&x[..split]) || !weights_inside(&x[split..count]) {
        return None;
    }
    Some(inner(offset, offset) - (0..count).map(|i| x[i] * right[i]).sum::<f64>())
}

/// Gauss elimination of a symmetric positive system; nothing when it is singular (its minimum
/// is then attained on a smaller face as well).
fn solve(mut m: [[f64; 5]; 4], n: usize) -> Option<[f64; 4]> {
    let scale = (0..n).map(|i| m[i][i]).fold(0.0, f64::max);
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs()))?;
        if m[pivot][k].abs() <= 1e-13 * scale {
            return None;
        }
        m.swap(k, pivot);
        for i in k + 1..n {
            let f = m[i][k] / m[k][k];
            let above = m[k];
            for (x, y) in m[i].iter_mut().zip(above).skip(k) {
                *x -= f * y;
            }
        }
    }
    let mut x = [0.0; 4];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| m[k][j] * x[j]).sum();
        x[k] = (m[k][4] - known) / m[k][k];
    }
    Some(x)
}

/// Whether the line through the centroids already shows that two triangles are further apart
/// than `reach`.
pub(super) fn separated(s: [&[f64]; 3], t: [&[f64]; 3], reach: f64) -> bool {
    let n = s[0].len();
    let mut low = [0.0; 3];
    let mut high = [0.0; 3];
    let mut length = 0.0;
    for k in 0..n {
        let d = (t[0][k] + t[1][k] + t[2][k] - s[0][k] - s[1][k] - s[2][k]) / 3.0;
        length += d * d;
        for i in 0..3 {
            // relative to one corner, against cancellation far from the origin
            low[i] += d * (s[i][k] - s[0][k]);
            high[i] += d * (t[i][k] - s[0][k]);
        }
    }
    let gap = high.iter().copied().fold(f64::INFINITY, f64::min)
        - low.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    gap > reach * length.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Nearest pair on a fine barycentric grid: an upper bound that is nearly attained.
    fn by_grid(s: [&[f64]; 3], t: [&[f64]; 3], m: usize) -> f64 {
        let mut best = f64::INFINITY;
        for i in 0..=m {
            for j in 0..=m - i {
                let (x, y) = (i as f64 / m as f64, j as f64 / m as f64);
                let p: Vec<f64> = (0..s[0].len())
                    .map(|k| s[0][k] * (1.0 - x - y) + s[1][k] * x + s[2][k] * y)
                    .collect();
                best = best.min(point_triangle(&p, t[0], t[1], t[2]));
            }
        }
        best
    }

    proptest! {
        #[test]
        fn agrees_with_a_grid(c in proptest::collection::vec(-1.0..1.0_f64, 24)) {
            let r: Vec<&[f64]> = c.chunks(4).collect();
            let (s, t) = ([r[0], r[1], r[2]], [r[3], r[4], r[5]]);
            let exact = triangle_triangle(s, t).sqrt();
            let grid = by_grid(s, t, 60).sqrt();
            prop_assert!(exact <= grid + 1e-7);
            prop_assert!(grid <= exact + 0.1, "{grid} against {exact}");
            prop_assert!(!separated(s, t, exact + 1e-7));
        }
    }

    #[test]
    fn planes_of_r4_meet_in_one_point() {
        let s: [&[f64]; 3] = [&[-1., -1., 0., 0.], &[2., 0., 0., 0.], &[0., 2., 0., 0.]];
        let t: [&[f64]; 3] = [&[0., 0., -1., -1.], &[0., 0., 2., 0.], &[0., 0., 0., 2.]];
        assert!(triangle_triangle(s, t) < 1e-24);
        let up: [&[f64]; 3] = [&[5., 0., -1., -1.], &[5., 0., 2., 0.], &[5., 0., 0., 2.]];
        assert!((triangle_triangle(s, up) - 9.0).abs() < 1e-12);
    }

    #[test]
    fn degenerate_triangle_is_a_segment() {
        let d = point_triangle(&[0.5, 2.0], &[0.0, 0.0], &[1.0, 0.0], &[1.0, 0.0]);
        assert!((d - 4.0).abs() < 1e-12);
    }
}
