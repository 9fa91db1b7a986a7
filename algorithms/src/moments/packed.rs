//! Upper triangles of symmetric matrices, row after row.

/// Entries of the upper triangle of an `n * n` matrix.
pub(super) const fn length(n: usize) -> usize {
    n * (n + 1) / 2
}

/// `matrix += weight * v v^T`.
#[inline(always)]
pub(super) fn add_square(matrix: &mut [f64], v: &[f64], weight: f64) {
    let mut rest = matrix;
    for (i, x) in v.iter().enumerate() {
        let (row, below) = rest.split_at_mut(v.len() - i);
        let scaled = weight * x;
        for (m, y) in row.iter_mut().zip(&v[i..]) {
            *m += scaled * y;
        }
        rest = below;
    }
}

/// `matrix += weight * (other + count * v v^T)`.
#[inline(always)]
pub(super) fn add_shifted(matrix: &mut [f64], other: &[f64], v: &[f64], count: f64, weight: f64) {
    let mut at = 0;
    for (i, x) in v.iter().enumerate() {
        let width = v.len() - i;
        let scaled = count * x;
        let (row, from) = (&mut matrix[at..at + width], &other[at..at + width]);
        for ((m, o), y) in row.iter_mut().zip(from).zip(&v[i..]) {
            *m += weight * (o + scaled * y);
        }
        at += width;
    }
}

/// The full matrix in row order.
pub(super) fn unfold(matrix: &[f64], n: usize, out: &mut Vec<f64>) {
    out.clear();
    out.resize(n * n, 0.0);
    let mut at = 0;
    for i in 0..n {
        for j in i..n {
            out[i * n + j] = matrix[at];
            out[j * n + i] = matrix[at];
            at += 1;
        }
    }
}

/// Sum of the diagonal.
pub(super) fn trace(matrix: &[f64], n: usize) -> f64 {
    let mut at = 0;
    let mut sum = 0.0;
    for i in 0..n {
        sum += matrix[at];
        at += n - i;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_unfold_to_outer_products() {
        let mut packed = vec![0.0; length(3)];
        add_square(&mut packed, &[1.0, 2.0, 3.0], 2.0);
        let mut full = Vec::new();
        unfold(&packed, 3, &mut full);
        assert_eq!(full, [2.0, 4.0, 6.0, 4.0, 8.0, 12.0, 6.0, 12.0, 18.0]);
        assert_eq!(trace(&packed, 3), 28.0);
        let mut sum = packed.clone();
        add_shifted(&mut sum, &packed, &[0.0, 1.0, 0.0], 5.0, -1.0);
        unfold(&sum, 3, &mut full);
        assert_eq!(full, [0.0, 0.0, 0.0, 0.0, -5.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
