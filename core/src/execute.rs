//! Running independent jobs, in one thread or many, with the same result.
//!
//! Methods that answer for a whole cloud at once are given an [`Execute`] by whoever knows how many threads there
//! are, so that a plug-in uses them all and starts none.

use std::ops::Range;
use std::sync::OnceLock;

/// Runs independent jobs. What runs them (this thread, a pool) is a backend's business; the
/// result must not depend on it.
pub trait Execute: Sync {
    /// Calls `job` for ranges that together cover `0..count` once, in any order, possibly at the same time.
    fn ranges(&self, count: usize, job: &(dyn Fn(Range<usize>) + Sync));
}

/// This thread alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl Execute for Serial {
    fn ranges(&self, count: usize, job: &(dyn Fn(Range<usize>) + Sync)) {
        job(0..count);
    }
}

/// Points a job takes at a time: enough to drown the cost of a job, few enough to share out.
const BLOCK: usize = 256;

/// The results of `work(scratch, i)` for every `i` below `count`, in order, whoever did the work; `scratch` makes a
/// workspace for one thread after another.
///
/// ```
/// use crosscap_core::execute::{Serial, map};
/// assert_eq!(map(&Serial, 4, || 0, |_, i| i * i), [0, 1, 4, 9]);
/// ```
pub fn map<T: Send + Sync, C>(
    execute: &dyn Execute,
    count: usize,
    scratch: impl Fn() -> C + Sync,
    work: impl Fn(&mut C, usize) -> T + Sync,
) -> Vec<T> {
    map_blocks(execute, BLOCK, count, scratch, work)
}

/// The same as [`map`] with `block` items to a job, for items that are themselves much work.
pub fn map_blocks<T: Send + Sync, C>(
    execute: &dyn Execute,
    block: usize,
    count: usize,
    scratch: impl Fn() -> C + Sync,
    work: impl Fn(&mut C, usize) -> T + Sync,
) -> Vec<T> {
    let blocks: Vec<OnceLock<Vec<T>>> = (0..count.div_ceil(block))
        .map(|_| OnceLock::new())
        .collect();
    execute.ranges(blocks.len(), &|range| {
        let mut own = scratch();
        for b in range {
            let items = (b * block..((b + 1) * block).min(count)).map(|i| work(&mut own, i));
            // A block is given out once, so setting it cannot fail.
            let _ = blocks[b].set(items.collect());
        }
    });
    blocks
        .into_iter()
        .flat_map(|b| b.into_inner().unwrap_or_default())
        .collect()
}

/// The results of `work(i)` for every `i` below `count`, in order, one job each: for few jobs that are long.
pub fn few<T: Send + Sync>(
    execute: &dyn Execute,
    count: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let slots: Vec<OnceLock<T>> = (0..count).map(|_| OnceLock::new()).collect();
    execute.ranges(count, &|range| {
        for i in range {
            // An index is given out once, so setting it cannot fail.
            let _ = slots[i].set(work(i));
        }
    });
    slots.into_iter().filter_map(OnceLock::into_inner).collect()
}
