//! Leading directions of a symmetric matrix by subspace iteration.

use super::decide::LEADING;
use nalgebra::{SMatrix, SymmetricEigen};

const COLD_ROUNDS: usize = 8;
const WARM_ROUNDS: usize = 2;

/// Orthonormal directions, the first ones near those of largest variance.
#[derive(Default)]
pub(super) struct Directions {
    /// `m * n` in row order.
    pub(super) rows: Vec<f64>,
    image: Vec<f64>,
    warm: bool,
}

impl Directions {
    /// Forgets where the last search ended.
    pub(super) fn forget(&mut self) {
        self.warm = false;
    }

    /// The first `m` coordinate axes.
    pub(super) fn reset(&mut self, m: usize, n: usize) {
        self.rows.clear();
        self.rows.resize(m * n, 0.0);
        for i in 0..m {
            self.rows[i * n + i] = 1.0;
        }
    }

    /// Turns them towards the leading directions of the `n * n` matrix `dense`. They come out
    /// orthonormal whatever it holds, as long as it is finite.
    pub(super) fn follow(&mut self, dense: &[f64], m: usize, n: usize) {
        if !self.warm || self.rows.len() != m * n {
            self.reset(m, n);
            // A fixed start that leans on no direction.
            for (k, x) in self.rows.iter_mut().enumerate() {
                *x += 0.1 * (1.7 * k as f64 + 0.3).cos();
            }
        }
        let rounds = if self.warm { WARM_ROUNDS } else { COLD_ROUNDS };
        for _ in 0..rounds {
            self.multiply(dense, n);
            std::mem::swap(&mut self.image, &mut self.rows);
            self.orthonormalize(n);
        }
        self.warm = true;
        self.sort(dense, m, n);
    }

    /// Writes the symmetric `dense` times every direction to `image`.
    fn multiply(&mut self, dense: &[f64], n: usize) {
        self.image.clear();
        self.image.resize(self.rows.len(), 0.0);
        for (v, out) in self
            .rows
            .chunks_exact(n)
            .zip(self.image.chunks_exact_mut(n))
        {
            for (row, x) in dense.chunks_exact(n).zip(v) {
                for (o, a) in out.iter_mut().zip(row) {
                    *o += a * x;
                }
            }
        }
    }

    fn orthonormalize(&mut self, n: usize) {
        let m = self.rows.len() / n;
        let mut spare = 0;
        for i in 0..m {
            let (done, rest) = self.rows.split_at_mut(i * n);
            let v = &mut rest[..n];
            loop {
                let before = norm(v);
                for _ in 0..2 {
                    for w in done.chunks_exact(n) {
                        let along: f64 = w.iter().zip(&*v).map(|(a, b)| a * b).sum();
                        v.iter_mut().zip(w).for_each(|(x, y)| *x -= along * y);
                    }
                }
                let after = norm(v);
                if after > 1e-10 * before && after > 0.0 {
                    v.iter_mut().for_each(|x| *x /= after);
                    // What was small before holds rounding along the others.
                    for w in done.chunks_exact(n) {
                        let along: f64 = w.iter().zip(&*v).map(|(a, b)| a * b).sum();
                        v.iter_mut().zip(w).for_each(|(x, y)| *x -= along * y);
                    }
                    let length = norm(v);
                    v.iter_mut().for_each(|x| *x /= length);
                    break;
                }
                // Nothing new: some coordinate axis is not in the span of fewer than n directions.
                v.fill(0.0);
                v[spare % n] = 1.0;
                spare += 1;
            }
        }
    }

    /// Turns them within their span, to falling variance.
    fn sort(&mut self, dense: &[f64], m: usize, n: usize) {
        self.multiply(dense, n);
        let (rows, image) = (&self.rows, &self.image);
        let ritz = SMatrix::<f64, LEADING, LEADING>::from_fn(|i, j| {
            if i >= m || j >= m {
                return 0.0;
            }
            rows[i * n..(i + 1) * n]
                .iter()
                .zip(&image[j * n..])
                .map(|(a, b)| a * b)
                .sum()
        });
        let eigen = SymmetricEigen::new(0.5 * (ritz + ritz.transpose()));
        let mut order: Vec<usize> = (0..LEADING).collect();
        // The columns that only pad the matrix have no part in the directions.
        let own = |k: usize| eigen.eigenvectors.column(k).rows(0, m).norm_squared() > 0.5;
        order.retain(|&k| own(k));
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        if order.len() != m {
            return;
        }
        self.image.clear();
        for &k in &order {
            for x in 0..n {
                self.image.push(
                    (0..m)
                        .map(|i| eigen.eigenvectors[(i, k)] * self.rows[i * n + x])
                        .sum(),
                );
            }
        }
        std::mem::swap(&mut self.image, &mut self.rows);
        self.orthonormalize(n);
    }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orthonormal_and_leading_whatever_the_matrix() {
        for n in [4, 5, 6, 9, 20] {
            let m = n.min(LEADING);
            for kind in 0..3 {
                let mut dense = vec![0.0; n * n];
                for i in 0..n {
                    dense[i * n + i] = match kind {
                        0 => 0.0,
                        1 => {
                            if i == n - 1 {
                                1.0
                            } else {
                                0.0
                            }
                        }
                        _ => 0.3_f64.powi(((i * 7) % n) as i32),
                    };
                }
                let mut directions = Directions::default();
                for _ in 0..2 {
                    directions.follow(&dense, m, n);
                    for i in 0..m {
                        for j in 0..m {
                            let product: f64 = (0..n)
                                .map(|k| directions.rows[i * n + k] * directions.rows[j * n + k])
                                .sum();
                            assert!(
                                (product - f64::from(u8::from(i == j))).abs() < 1e-14,
                                "{n} {kind} {i} {j} {product}"
                            );
                        }
                    }
                    let along: f64 = (0..n)
                        .map(|k| dense[k * n + k] * directions.rows[k].powi(2))
                        .sum();
                    let largest = (0..n).map(|k| dense[k * n + k]).fold(0.0, f64::max);
                    assert!(along > 0.99 * largest || kind == 0, "{n} {kind} {along}");
                }
            }
        }
    }
}
