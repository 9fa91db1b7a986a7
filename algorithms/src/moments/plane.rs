//! A plane that follows the leading directions of one scatter after the other.

/// Rounds of subspace iteration for the plane, and those from the plane of the node before.
const COLD_ROUNDS: usize = 6;
const WARM_ROUNDS: usize = 1;

/// A plane through the origin.
#[derive(Default)]
pub(super) struct Plane {
    /// Two orthonormal directions, one after the other; empty when there are none yet.
    directions: Vec<f64>,
    image: Vec<f64>,
}

impl Plane {
    /// The next scatter is followed from the start.
    pub(super) fn forget(&mut self) {
        self.directions.clear();
    }

    #[inline(always)]
    fn pair(&self) -> (&[f64], &[f64]) {
        self.directions.split_at(self.directions.len() / 2)
    }

    /// Turns the plane towards the leading directions of a scatter in `n` coordinates; `false` where it has no two.
    #[inline(always)]
    pub(super) fn follow(&mut self, scatter: &[f64], n: usize) -> bool {
        let rounds = if self.directions.len() == 2 * n {
            WARM_ROUNDS
        } else {
            self.directions.clear();
            // A fixed start that leans on no direction.
            self.directions
                .extend((0..2 * n).map(|k| (1.7 * k as f64 + 0.3).cos()));
            COLD_ROUNDS
        };
        for _ in 0..rounds {
            self.image.clear();
            self.image.resize(2 * n, 0.0);
            for (v, out) in self
                .directions
                .chunks_exact(n)
                .zip(self.image.chunks_exact_mut(n))
            {
                multiply(scatter, v, out);
            }
            std::mem::swap(&mut self.directions, &mut self.image);
            let (v, w) = self.directions.split_at_mut(n);
            if !(unit(v) && {
                let along: f64 = v.iter().zip(&*w).map(|(a, b)| a * b).sum();
                w.iter_mut().zip(&*v).for_each(|(b, a)| *b -= along * a);
                unit(w)
            }) {
                self.directions.clear();
                return false;
            }
        }
        // A nearly parallel pair is not orthogonal to the last bit after one pass.
        let (v, w) = self.directions.split_at_mut(n);
        let along: f64 = v.iter().zip(&*w).map(|(a, b)| a * b).sum();
        w.iter_mut().zip(&*v).for_each(|(b, a)| *b -= along * a);
        unit(w)
    }

    /// Trace within the plane.
    #[inline(always)]
    pub(super) fn trace_within(&self, products: &[f64]) -> f64 {
        let (v, w) = self.pair();
        form(products, v, v) + form(products, w, w)
    }

    /// The smaller eigenvalue of the compression to the plane.
    #[inline(always)]
    pub(super) fn second(&self, products: &[f64]) -> f64 {
        let (v, w) = self.pair();
        let (a, b, c) = (
            form(products, v, v),
            form(products, v, w),
            form(products, w, w),
        );
        0.5 * (a + c) - (0.25 * (a - c) * (a - c) + b * b).sqrt()
    }
}

/// `out += matrix v`.
#[inline(always)]
fn multiply(matrix: &[f64], v: &[f64], out: &mut [f64]) {
    let n = v.len();
    let mut at = 0;
    for i in 0..n {
        let row = &matrix[at..at + n - i];
        let mut sum = row[0] * v[i];
        for ((p, y), o) in row[1..].iter().zip(&v[i + 1..]).zip(&mut out[i + 1..]) {
            sum += p * y;
            *o += p * v[i];
        }
        out[i] += sum;
        at += n - i;
    }
}

/// Makes `v` a unit vector, `false` where it is none.
#[inline(always)]
fn unit(v: &mut [f64]) -> bool {
    let square: f64 = v.iter().map(|x| x * x).sum();
    if !(square > 1e-280 && square < 1e280) {
        return false;
    }
    let inverse = 1.0 / square.sqrt();
    v.iter_mut().for_each(|x| *x *= inverse);
    true
}

/// `v^T matrix w`.
#[inline(always)]
fn form(matrix: &[f64], v: &[f64], w: &[f64]) -> f64 {
    let n = v.len();
    let mut at = 0;
    let mut sum = 0.0;
    for i in 0..n {
        let row = &matrix[at..at + n - i];
        let (mut along, mut across) = (row[0] * w[i], 0.0);
        for ((p, x), y) in row[1..].iter().zip(&v[i + 1..]).zip(&w[i + 1..]) {
            along += p * y;
            across += p * x;
        }
        sum += v[i] * along + w[i] * across;
        at += n - i;
    }
    sum
}
