//! Smith normal form of sparse integer matrices.

use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_traits::{One, Signed, Zero};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The nonzero invariant factors of an integer matrix.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Invariants {
    /// How many of them are 1.
    pub ones: usize,
    /// The others with their multiplicities; each divides the one before it.
    chain: Vec<(BigUint, usize)>,
}

impl Invariants {
    /// Adds a 1 by 1 block with the nonzero entry `x`.
    ///
    /// Z/a + Z/b = Z/lcm + Z/gcd: going down the chain, `x` lifts one copy of every factor to
    /// the least common multiple and goes on as the greatest common divisor.
    pub fn insert(&mut self, mut x: BigUint) {
        let mut at = 0;
        while at < self.chain.len() && !x.is_one() {
            let (value, copies) = &mut self.chain[at];
            let common = value.gcd(&x);
            if common == x {
                // x divides this factor, which stays.
                at += 1;
                continue;
            }
            let multiple = value.lcm(&x);
            if multiple != *value {
                *copies -= 1;
                if *copies == 0 {
                    self.chain.remove(at);
                }
                match at.checked_sub(1).map(|above| &mut self.chain[above]) {
                    Some((above, copies)) if *above == multiple => *copies += 1,
                    _ => {
                        self.chain.insert(at, (multiple, 1));
                        at += 1;
                    }
                }
            }
            x = common;
        }
        if x.is_one() {
            self.ones += 1;
            return;
        }
        match self.chain.last_mut() {
            Some((last, copies)) if *last == x => *copies += 1,
            _ => self.chain.push((x, 1)),
        }
    }

    /// Number of nonzero invariant factors: the rank over the rational numbers.
    pub fn rank(&self) -> usize {
        self.ones + self.chain.iter().map(|(_, copies)| copies).sum::<usize>()
    }

    /// The factors above 1, each dividing the next.
    pub fn torsion(&self) -> Vec<BigUint> {
        let runs = self.chain.iter().rev();
        runs.flat_map(|(value, copies)| std::iter::repeat_n(value.clone(), *copies))
            .collect()
    }
}

/// A row of a sparse matrix: columns increasing, entries not 0.
pub(crate) type Row = Vec<(u32, i64)>;

/// Invariant factors of the matrix with the given rows.
///
/// First pivots on entries +-1 with little fill, shortest row first, in machine integers with
/// checked arithmetic: with a unit pivot the rest of the matrix is replaced by its Schur
/// complement, which changes no invariant factor but one 1. What is left, mostly nothing, is
/// cut into blocks that share no column, and each is made diagonal in arbitrary precision.
pub(crate) fn invariants(columns: usize, mut rows: Vec<Row>) -> Invariants {
    let mut result = Invariants::default();
    eliminate_units(columns, &mut rows, &mut result);
    rows.retain(|row| !row.is_empty());
    for block in blocks(columns, &rows) {
        diagonalize(block, &mut result);
    }
    result
}

fn eliminate_units(columns: usize, rows: &mut [Row], result: &mut Invariants) {
    // Rows that have, or once had, an entry in the column.
    let mut holders: Vec<Vec<u32>> = vec![Vec::new(); columns];
    let mut queue = BinaryHeap::with_capacity(rows.len());
    for (r, row) in rows.iter().enumerate() {
        for &(c, _) in row {
            holders[c as usize].push(r as u32);
        }
        queue.push(Reverse((row.len(), r as u32)));
    }
    let mut changed: Vec<(u32, Row)> = Vec::new();
    while let Some(Reverse((length, r))) = queue.pop() {
        let row = &rows[r as usize];
        if length == 0 || row.len() != length {
            continue;
        }
        let units = row.iter().filter(|&&(_, x)| x.abs() == 1);
        let Some(&(column, unit)) = units.min_by_key(|&&(c, _)| (holders[c as usize].len(), c))
        else {
            continue;
        };
        let others = &mut holders[column as usize];
        others.sort_unstable();
        others.dedup();
        changed.clear();
        let mut fits = true;
        for &other in others.iter().filter(|&&other| other != r) {
            let target = &rows[other as usize];
            if let Ok(at) = target.binary_search_by_key(&column, |&(c, _)| c) {
                match subtract(target, row, target[at].1.checked_mul(unit)) {
                    Some(new) => changed.push((other, new)),
                    None => {
                        fits = false;
                        break;
                    }
                }
            }
        }
        if !fits {
            // Left to arbitrary precision.
            continue;
        }
        for (other, new) in changed.drain(..) {
            let old = std::mem::replace(&mut rows[other as usize], new);
            let new = &rows[other as usize];
            for &(c, _) in new {
                if old.binary_search_by_key(&c, |&(c, _)| c).is_err() {
                    holders[c as usize].push(other);
                }
            }
            queue.push(Reverse((new.len(), other)));
        }
        holders[column as usize] = Vec::new();
        rows[r as usize] = Row::new();
        result.ones += 1;
    }
}

/// `target - factor * row`, `None` on overflow.
fn subtract(target: &Row, row: &Row, factor: Option<i64>) -> Option<Row> {
    let factor = factor?;
    let mut new = Row::with_capacity(target.len() + row.len());
    let (mut i, mut j) = (0, 0);
    while i < target.len() || j < row.len() {
        let left = target.get(i).map_or(u64::MAX, |&(c, _)| u64::from(c));
        let right = row.get(j).map_or(u64::MAX, |&(c, _)| u64::from(c));
        let column = left.min(right) as u32;
        let mut value = 0i64;
        if left <= right {
            value = target[i].1;
            i += 1;
        }
        if right <= left {
            value = value.checked_sub(row[j].1.checked_mul(factor)?)?;
            j += 1;
        }
        // The absolute value is taken later.
        if value == i64::MIN {
            return None;
        }
        if value != 0 {
            new.push((column, value));
        }
    }
    Some(new)
}

/// Cuts the matrix into blocks that share no column, each dense.
fn blocks(columns: usize, rows: &[Row]) -> Vec<Vec<Vec<BigInt>>> {
    let mut sets = super::signed_union::SignedUnion::new(columns);
    for row in rows {
        for pair in row.windows(2) {
            sets.join(pair[0].0, pair[1].0, false);
        }
    }
    let mut members: Vec<(u32, u32)> = (0..rows.len())
        .map(|r| (sets.find(rows[r][0].0).0, r as u32))
        .collect();
    members.sort_unstable();
    let chunks = members.chunk_by(|x, y| x.0 == y.0);
    chunks
        .map(|chunk| {
            let rows = || chunk.iter().map(|&(_, r)| &rows[r as usize]);
            let mut used: Vec<u32> = rows().flatten().map(|&(c, _)| c).collect();
            used.sort_unstable();
            used.dedup();
            rows()
                .map(|row| {
                    let mut dense = vec![BigInt::zero(); used.len()];
                    for &(c, x) in row {
                        if let Ok(at) = used.binary_search(&c) {
                            dense[at] = BigInt::from(x);
                        }
                    }
                    dense
                })
                .collect()
        })
        .collect()
}

/// Makes a dense matrix diagonal by row and column operations and inserts the diagonal. The
/// pivot is the entry of smallest absolute value, which keeps entries from growing.
pub(crate) fn diagonalize(mut a: Vec<Vec<BigInt>>, result: &mut Invariants) {
    let rows = a.len();
    let columns = a.first().map_or(0, Vec::len);
    for k in 0..rows.min(columns) {
        loop {
            let places = (k..rows).flat_map(|i| (k..columns).map(move |j| (i, j)));
            let Some((i, j)) = places
                .filter(|&(i, j)| !a[i][j].is_zero())
                .min_by(|&(i, j), &(m, n)| a[i][j].magnitude().cmp(a[m][n].magnitude()))
            else {
                return;
            };
            a.swap(k, i);
            if j != k {
                for row in &mut a[k..] {
                    row.swap(k, j);
                }
            }
            let mut clean = true;
            let (upper, lower) = a.split_at_mut(k + 1);
            let pivot_row = &upper[k];
            for row in lower {
                let quotient = row[k].div_floor(&pivot_row[k]);
                if !quotient.is_zero() {
                    for j in k..columns {
                        row[j] -= &quotient * &pivot_row[j];
                    }
                }
                clean &= row[k].is_zero();
            }
            if !clean {
                continue;
            }
            // The column is clear, so column operations touch the pivot row alone.
            let pivot = a[k][k].clone();
            for entry in &mut a[k][k + 1..] {
                *entry = entry.mod_floor(&pivot);
                clean &= entry.is_zero();
            }
            if clean {
                result.insert(pivot.abs().magnitude().clone());
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn numbers(of: &[u64]) -> Vec<BigUint> {
        of.iter().map(|&x| BigUint::from(x)).collect()
    }

    #[test]
    fn diagonals_combine() {
        let mut all = Invariants::default();
        for x in [4u64, 6, 2, 15, 1, 2, 2] {
            all.insert(x.into());
        }
        // Prime by prime: 2: 4,2,2,2,2; 3: 3,3; 5: 5.
        assert_eq!(all.torsion(), numbers(&[2, 2, 2, 6, 60]));
        assert_eq!((all.ones, all.rank()), (2, 7));
    }

    /// Determinantal divisors: the k-th is the greatest common divisor of all k by k minors,
    /// and its quotient by the one before is the k-th invariant factor. Slow, and nothing in
    /// common with elimination.
    fn by_minors(a: &[Vec<i64>]) -> Vec<BigUint> {
        fn determinant(a: &[Vec<i64>], rows: &[usize], columns: &[usize]) -> BigInt {
            let Some((&first, rest)) = rows.split_first() else {
                return BigInt::one();
            };
            let mut sum = BigInt::zero();
            for (k, &c) in columns.iter().enumerate() {
                let mut others = columns.to_vec();
                others.remove(k);
                let term = BigInt::from(a[first][c]) * determinant(a, rest, &others);
                if k % 2 == 0 { sum += term } else { sum -= term }
            }
            sum
        }
        fn subsets(n: usize, k: usize) -> Vec<Vec<usize>> {
            (0u32..1 << n)
                .filter(|m| m.count_ones() as usize == k)
                .map(|m| (0..n).filter(|i| m >> i & 1 == 1).collect())
                .collect()
        }
        let (m, n) = (a.len(), a[0].len());
        let mut factors = Vec::new();
        let mut previous = BigInt::one();
        for k in 1..=m.min(n) {
            let mut divisor = BigInt::zero();
            for rows in subsets(m, k) {
                for columns in subsets(n, k) {
                    divisor = divisor.gcd(&determinant(a, &rows, &columns));
                }
            }
            if divisor.is_zero() {
                break;
            }
            factors.push((&divisor / &previous).magnitude().clone());
            previous = divisor;
        }
        factors
    }

    proptest! {
        #[test]
        fn agrees_with_determinantal_divisors(
            a in (1usize..5, 1usize..5).prop_flat_map(|(m, n)|
                prop::collection::vec(prop::collection::vec(-4i64..5, n), m))
        ) {
            let rows = a
                .iter()
                .map(|row| {
                    let entries = row.iter().enumerate().filter(|&(_, &x)| x != 0);
                    entries.map(|(c, &x)| (c as u32, x)).collect()
                })
                .collect();
            let found = invariants(a[0].len(), rows);
            let expected = by_minors(&a);
            prop_assert_eq!(found.rank(), expected.len());
            let above_one: Vec<_> = expected.into_iter().filter(|x| !x.is_one()).collect();
            prop_assert_eq!(found.torsion(), above_one);
        }
    }

    #[test]
    fn entries_beyond_machine_integers() {
        // The determinant is near the square of i64::MAX, and the gcd of the entries is 1.
        let big = i64::MAX;
        let rows = vec![vec![(0, 1), (1, big)], vec![(0, big), (1, -1)]];
        let found = invariants(2, rows);
        let big = BigUint::from(big as u64);
        assert_eq!(found.ones, 1);
        assert_eq!(found.torsion(), vec![&big * &big + BigUint::one()]);
    }

    #[test]
    fn many_equal_blocks() {
        let rows = (0..20_000).map(|c| vec![(c, 2)]).collect();
        let found = invariants(20_000, rows);
        assert_eq!(found.rank(), 20_000);
        assert_eq!(found.torsion().len(), 20_000);
    }
}
