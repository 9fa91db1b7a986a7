//! Neighbors in their order: by distance, then by index.

use crosscap_core::{Neighbor, Scalar};
use std::cell::RefCell;

/// Distance, then index, as one number: the bits of nonnegative numbers are in their order.
pub(super) fn rank<S: Scalar>(neighbor: &Neighbor<S>) -> u128 {
    u128::from(neighbor.distance.as_f64().to_bits()) << 64 | neighbor.index as u128
}

/// Sorts by distance, then index. On a surface the number of neighbors grows with the square of
/// the distance, so buckets of equal squared width hold about one each: several times faster
/// than comparing (a query's time goes mostly here otherwise), and never worse than it.
pub(super) fn sort<S: Scalar>(neighbors: &mut [Neighbor<S>]) {
    thread_local! {
        static SCRATCH: RefCell<(Vec<u32>, Vec<u128>)> = const { RefCell::new((vec![], vec![])) };
    }
    let count = neighbors.len();
    let square = |n: &Neighbor<S>| n.distance.as_f64() * n.distance.as_f64();
    let most = neighbors.iter().map(square).fold(0.0, f64::max);
    let per_square = (count as f64 - 1.0) / most;
    if count < 48 || !(per_square > 0.0 && per_square.is_finite()) {
        return neighbors.sort_unstable_by_key(rank);
    }
    let bucket = |n: &Neighbor<S>| ((square(n) * per_square) as usize).min(count - 1);
    SCRATCH.with_borrow_mut(|(ends, ranks)| {
        ends.clear();
        ends.resize(count, 0);
        ranks.clear();
        ranks.resize(count, 0);
        neighbors.iter().for_each(|n| ends[bucket(n)] += 1);
        let mut before = 0;
        for end in ends.iter_mut() {
            before += std::mem::replace(end, before);
        }
        // Each start moves to the end of its bucket while the bucket fills.
        for n in neighbors.iter() {
            let end = &mut ends[bucket(n)];
            ranks[*end as usize] = rank(n);
            *end += 1;
        }
        let mut start = 0;
        for &end in ends.iter() {
            if end - start > 1 {
                ranks[start as usize..end as usize].sort_unstable();
            }
            start = end;
        }
        for (n, rank) in neighbors.iter_mut().zip(ranks) {
            n.distance = S::of(f64::from_bits((*rank >> 64) as u64));
            n.index = *rank as u64 as usize;
        }
    });
}
