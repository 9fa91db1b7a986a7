//! A quadratic patch through the points of a sheet, and how far they are off it.

use crosscap_core::squared_distance;

/// Terms of a quadratic height.
pub(super) const TERMS: usize = 6;

/// The terms of a quadratic height at a place.
pub(super) fn terms([u, v]: [f64; 2]) -> [f64; TERMS] {
    [1.0, u, v, u * u, u * v, v * v]
}

/// Points that a patch is fitted to at most: picked at equal steps.
const FITTED: usize = 96;
/// Rounds of the power iteration for its plane; a surface is flat beside its neighborhood, so that few are enough.
const ROUNDS: usize = 5;

/// Points over a plane through a vertex, with what is left of their heights over a quadratic patch.
#[derive(Default)]
pub(super) struct Patch {
    /// Coordinates in the plane.
    pub flat: Vec<[f64; 2]>,
    /// Heights over the patch along the direction in which they vary most, in the order of `flat`.
    pub left: Vec<f64>,
    /// Root mean square of all that is left, with the degrees of freedom counted.
    pub scatter: f64,
    /// Distance of the vertex from the patch.
    pub offset: f64,
    /// Standard error of that distance, in units of the scatter.
    pub leverage: f64,
    rows: Vec<f64>,
    heights: Vec<f64>,
    axes: [Vec<f64>; 2],
    /// The terms of every coordinate of the height, where the plane is in units of `scale`.
    height: Vec<[f64; TERMS]>,
    scale: f64,
}

impl Patch {
    /// Fits the patch to `points`, as seen from `origin`; `false` where they are too few or on a line.
    pub fn fit<'p>(
        &mut self,
        origin: &[f64],
        points: impl ExactSizeIterator<Item = &'p [f64]>,
    ) -> bool {
        let n = origin.len();
        let count = points.len();
        if count < 2 * TERMS {
            return false;
        }
        let step = count.div_ceil(FITTED);
        self.rows.clear();
        for row in points.step_by(step) {
            self.rows.extend(row.iter().zip(origin).map(|(x, o)| x - o));
        }
        if !self.plane(n) {
            return false;
        }
        self.flatten(n);
        self.solve(n)
    }

    /// The place of the patch over a place of its plane, from the origin.
    pub fn place(&self, at: [f64; 2]) -> Vec<f64> {
        let [u, v] = at;
        let terms = terms(at.map(|x| x / self.scale));
        let height = |c: &[f64; TERMS]| (0..TERMS).map(|i| terms[i] * c[i]).sum::<f64>();
        let flat = self.axes[0].iter().zip(&self.axes[1]);
        flat.zip(&self.height)
            .map(|((a, b), c)| u * a + v * b + height(c))
            .collect()
    }

    /// How much its height bends: the root of the sum of the squares of all second derivatives, 1.4 / r for a sphere of radius r.
    pub fn bend(&self) -> f64 {
        let square = |c: &[f64; TERMS]| 4.0 * (c[3] * c[3] + c[5] * c[5]) + 2.0 * c[4] * c[4];
        let sum: f64 = self.height.iter().map(square).sum();
        sum.sqrt() / (self.scale * self.scale)
    }

    /// The square of the difference of its principal curvatures, that of all coordinates of the height added up: 0 for a sphere, 1 / r^2
    /// for a cylinder of radius r, 4 / r^2 for a saddle of curvatures 1 / r and -1 / r.
    pub fn twist(&self) -> f64 {
        let square = |c: &[f64; TERMS]| 4.0 * (c[3] - c[5]).powi(2) + 4.0 * c[4] * c[4];
        self.height.iter().map(square).sum::<f64>() / self.scale.powi(4)
    }

    /// The plane of largest spread, about the mean of the points.
    fn plane(&mut self, n: usize) -> bool {
        let count = self.rows.len() / n;
        let mut mean = vec![0.0; n];
        for row in self.rows.chunks_exact(n) {
            mean.iter_mut()
                .zip(row)
                .for_each(|(m, x)| *m += x / count as f64);
        }
        let far = |from: &[f64]| {
            let rows = self.rows.chunks_exact(n);
            let best =
                rows.max_by(|a, b| squared_distance(a, from).total_cmp(&squared_distance(b, from)));
            best.map_or_else(Vec::new, <[f64]>::to_vec)
        };
        let first = far(&mean);
        let mut axes = [vec![0.0; n], vec![0.0; n]];
        axes[0]
            .iter_mut()
            .zip(first.iter().zip(&mean))
            .for_each(|(a, (x, m))| *a = x - m);
        // any other direction: the row that is furthest from the line
        let along: f64 = axes[0].iter().map(|a| a * a).sum();
        if along <= 0.0 {
            return false;
        }
        let mut most = -1.0;
        for row in self.rows.chunks_exact(n) {
            let k: f64 = (0..n).map(|i| (row[i] - mean[i]) * axes[0][i]).sum::<f64>() / along;
            let off: f64 = (0..n)
                .map(|i| (row[i] - mean[i] - k * axes[0][i]).powi(2))
                .sum();
            if off > most {
                most = off;
                axes[1] = row.iter().zip(&mean).map(|(x, m)| x - m).collect();
            }
        }
        if !orthonormal(&mut axes) {
            return false;
        }
        for _ in 0..ROUNDS {
            let mut next = [vec![0.0; n], vec![0.0; n]];
            for row in self.rows.chunks_exact(n) {
                for (axis, image) in axes.iter().zip(&mut next) {
                    let k: f64 = (0..n).map(|i| (row[i] - mean[i]) * axis[i]).sum();
                    (0..n).for_each(|i| image[i] += k * (row[i] - mean[i]));
                }
            }
            if !orthonormal(&mut next) {
                return false;
            }
            axes = next;
        }
        self.axes = axes;
        true
    }

    /// Coordinates in the plane and heights over it, both from the vertex.
    fn flatten(&mut self, n: usize) {
        self.flat.clear();
        self.heights.clear();
        for row in self.rows.chunks_exact(n) {
            let along = |axis: &[f64]| row.iter().zip(axis).map(|(x, a)| x * a).sum::<f64>();
            let [u, v] = [along(&self.axes[0]), along(&self.axes[1])];
            self.flat.push([u, v]);
            let off = (0..n).map(|i| row[i] - u * self.axes[0][i] - v * self.axes[1][i]);
            self.heights.extend(off);
        }
    }

    /// Least squares for all coordinates of the heights at once.
    fn solve(&mut self, n: usize) -> bool {
        let scale = self
            .flat
            .iter()
            .map(|p| p[0].hypot(p[1]))
            .fold(0.0, f64::max);
        if scale <= 0.0 {
            return false;
        }
        let terms = |p: &[f64; 2]| terms(p.map(|x| x / scale));
        let mut normal = [[0.0; TERMS]; TERMS];
        let mut right = vec![[0.0; TERMS]; n + 1];
        for (p, h) in self.flat.iter().zip(self.heights.chunks_exact(n)) {
            let x = terms(p);
            for (i, (line, own)) in normal.iter_mut().zip(x).enumerate() {
                line.iter_mut()
                    .zip(x)
                    .for_each(|(a, other)| *a += own * other);
                for (sum, h) in right.iter_mut().zip(h) {
                    sum[i] += own * h;
                }
            }
        }
        // the first column of the inverse: the leverage of the vertex
        right[n][0] = 1.0;
        let Some(lower) = cholesky(normal) else {
            return false;
        };
        for column in &mut right {
            substitute(&lower, column);
        }
        self.leverage = right[n][0].max(0.0).sqrt();
        self.offset = right[..n].iter().map(|c| c[0] * c[0]).sum::<f64>().sqrt();
        let mut sum = 0.0;
        for (p, h) in self.flat.iter().zip(self.heights.chunks_exact_mut(n)) {
            let x = terms(p);
            for (h, c) in h.iter_mut().zip(&right) {
                *h -= (0..TERMS).map(|i| x[i] * c[i]).sum::<f64>();
                sum += *h * *h;
            }
        }
        self.scatter = (sum / (self.flat.len() - TERMS) as f64).sqrt();
        right.truncate(n);
        (self.height, self.scale) = (right, scale);
        self.project(n);
        true
    }

    /// What is left, along the direction in which it varies most.
    fn project(&mut self, n: usize) {
        let far = self.heights.chunks_exact(n).max_by(|a, b| {
            let size = |h: &[f64]| h.iter().map(|x| x * x).sum::<f64>();
            size(a).total_cmp(&size(b))
        });
        let mut axis = far.map_or_else(|| vec![0.0; n], <[f64]>::to_vec);
        for _ in 0..ROUNDS {
            let mut next = vec![0.0; n];
            for h in self.heights.chunks_exact(n) {
                let k: f64 = h.iter().zip(&axis).map(|(h, a)| h * a).sum();
                next.iter_mut().zip(h).for_each(|(x, h)| *x += k * h);
            }
            let size = next.iter().map(|x| x * x).sum::<f64>().sqrt();
            if size <= 0.0 {
                break;
            }
            next.iter_mut().for_each(|x| *x /= size);
            axis = next;
        }
        self.left.clear();
        let along = |h: &[f64]| h.iter().zip(&axis).map(|(h, a)| h * a).sum::<f64>();
        self.left.extend(self.heights.chunks_exact(n).map(along));
    }
}

/// Gram-Schmidt of two vectors; `false` when they are on a line.
fn orthonormal(axes: &mut [Vec<f64>; 2]) -> bool {
    let [first, second] = axes;
    let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (long, before) = (size(first), size(second));
    if !(long > 0.0 && long.is_finite()) {
        return false;
    }
    first.iter_mut().for_each(|x| *x /= long);
    let along: f64 = first.iter().zip(&*second).map(|(a, b)| a * b).sum();
    second
        .iter_mut()
        .zip(&*first)
        .for_each(|(x, a)| *x -= along * a);
    let long = size(second);
    if long.is_nan() || long <= 1e-9 * before {
        return false;
    }
    second.iter_mut().for_each(|x| *x /= long);
    true
}

/// The lower factor of a positive matrix.
fn cholesky(mut a: [[f64; TERMS]; TERMS]) -> Option<[[f64; TERMS]; TERMS]> {
    for j in 0..TERMS {
        let pivot = a[j][j] - (0..j).map(|k| a[j][k] * a[j][k]).sum::<f64>();
        if pivot.is_nan() || pivot <= 1e-10 * a[j][j] {
            return None;
        }
        a[j][j] = pivot.sqrt();
        for i in j + 1..TERMS {
            let sum: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            a[i][j] = (a[i][j] - sum) / a[j][j];
        }
    }
    Some(a)
}

/// Solves with a lower factor and its transpose.
fn substitute(lower: &[[f64; TERMS]; TERMS], x: &mut [f64; TERMS]) {
    for i in 0..TERMS {
        let sum: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    for i in (0..TERMS).rev() {
        let sum: f64 = (i + 1..TERMS).map(|k| lower[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paraboloid_is_fitted_exactly_and_the_vertex_is_as_far_as_it_is() {
        let rows: Vec<[f64; 4]> = (0..49)
            .map(|k| {
                let (u, v) = (f64::from(k % 7) / 3.0 - 1.0, f64::from(k / 7) / 3.0 - 1.0);
                [u, v, 0.3 * u * u - 0.1 * u * v, 0.2 * v * v]
            })
            .collect();
        let mut patch = Patch::default();
        assert!(patch.fit(&[0.0, 0.0, 0.3, -0.4], rows.iter().map(|r| &r[..])));
        assert!(patch.scatter < 0.05, "{}", patch.scatter);
        assert!((patch.offset - 0.5).abs() < 0.05, "{}", patch.offset);
        let over = patch.place([0.1, 0.2]);
        let at = [over[0], over[1], over[2] + 0.3, over[3] - 0.4];
        let [u, v] = [at[0], at[1]];
        assert!((at[2] - (0.3 * u * u - 0.1 * u * v)).abs() < 0.05, "{at:?}");
        assert!((at[3] - 0.2 * v * v).abs() < 0.05, "{at:?}");
        assert!((patch.bend() - 0.735).abs() < 0.1, "{}", patch.bend());
        // 0.6, 0 and -0.1 in the first coordinate, 0, 0.4 and 0 in the second
        assert!((patch.twist() - 0.56).abs() < 0.1, "{}", patch.twist());
        let line: Vec<[f64; 3]> = (0..30).map(|k| [f64::from(k), 0.0, 0.0]).collect();
        assert!(!patch.fit(&[0.0; 3], line.iter().map(|r| &r[..])));
        assert!(!patch.fit(&[0.0; 3], line[..5].iter().map(|r| &r[..])));
    }
}
