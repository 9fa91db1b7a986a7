//! Betti numbers over a prime field by direct elimination of the boundary matrices.

use super::prime::{is_prime, power, product};
use super::sides::check_order;
use super::{BettiError, NotPrime};
use crosscap_core::Complex;

/// Betti numbers over Z/p from the ranks of both boundary matrices, eliminated modulo p.
///
/// It shares no reduction with [`super::homology`] and exists to be compared with it: column
/// by column, every column loses its last entry to the earlier column that ends in the same
/// row. Exact, O(t) columns, with fill that is harmless for thousands of triangles and not for
/// millions; [`super::Homology::betti_mod`] has no such limit.
///
/// # Errors
/// [`BettiError::NotPrime`]; [`BettiError::Complex`] for a complex that [`Complex::new`] did
/// not make.
///
/// ```
/// use crosscap_algorithms::homology::betti_by_elimination;
/// use crosscap_core::Complex;
/// let sphere = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
/// let sphere = Complex::new(4, sphere, vec![]).unwrap();
/// assert_eq!(betti_by_elimination(&sphere, 7).unwrap(), [1, 0, 1]);
/// assert!(betti_by_elimination(&sphere, 9).is_err());
/// ```
pub fn betti_by_elimination(complex: &Complex, p: u64) -> Result<[usize; 3], BettiError> {
    if !is_prime(p) {
        return Err(NotPrime(p).into());
    }
    check_order(complex)?;
    let edges = complex.edges();
    let first: Vec<Column> = edges
        .iter()
        .map(|&[a, b]| vec![(a, p - 1), (b, 1)])
        .collect();
    let row_of = |a: u32, b: u32| edges.partition_point(|e| *e < [a, b]) as u32;
    let second: Vec<Column> = complex
        .triangles
        .iter()
        .map(|&[a, b, c]| vec![(row_of(a, b), 1), (row_of(a, c), p - 1), (row_of(b, c), 1)])
        .collect();
    let first = rank(complex.vertices, first, p);
    let second = rank(edges.len(), second, p);
    Ok([
        complex.vertices - first,
        edges.len() - first - second,
        complex.triangles.len() - second,
    ])
}

/// Entries of a column: rows increasing, values in `1..p`.
type Column = Vec<(u32, u64)>;

fn rank(rows: usize, columns: Vec<Column>, p: u64) -> usize {
    // For each row the reduced column that ends in it, scaled to end in 1.
    let mut ending: Vec<Option<Column>> = vec![None; rows];
    let mut rank = 0;
    for mut column in columns {
        while let Some(&(row, value)) = column.last() {
            let Some(pivot) = &ending[row as usize] else {
                let inverse = power(value, p - 2, p);
                for entry in &mut column {
                    entry.1 = product(entry.1, inverse, p);
                }
                ending[row as usize] = Some(column);
                rank += 1;
                break;
            };
            column = combine(&column, pivot, p - value, p);
        }
    }
    rank
}

/// `a + factor * b` modulo `p`.
fn combine(a: &Column, b: &Column, factor: u64, p: u64) -> Column {
    let mut sum = Column::with_capacity(a.len() + b.len());
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let left = a.get(i).map_or(u64::MAX, |&(row, _)| u64::from(row));
        let right = b.get(j).map_or(u64::MAX, |&(row, _)| u64::from(row));
        let mut value = 0u128;
        if left <= right {
            value += u128::from(a[i].1);
            i += 1;
        }
        if right <= left {
            value += u128::from(product(b[j].1, factor, p));
            j += 1;
        }
        let value = (value % u128::from(p)) as u64;
        if value != 0 {
            sum.push((left.min(right) as u32, value));
        }
    }
    sum
}
