//! Searches for shortest paths.

use petgraph::Directed;
use petgraph::csr::Csr;
use std::cell::RefCell;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The length in units of what no path reaches.
pub(super) const UNREACHED: u64 = u64::MAX;

thread_local! {
    /// The two searches of a thread: one for each end.
    pub(super) static SCRATCH: RefCell<[Search; 2]> = RefCell::default();
}

/// A search from one point (Dijkstra 1959), with memory that is not cleared between searches: a
/// number is valid when its stamp is that of the search.
#[derive(Default)]
pub(super) struct Search {
    epoch: u32,
    stamps: Vec<u32>,
    wanted: Vec<u32>,
    units: Vec<u64>,
    queue: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Search {
    pub fn start(&mut self, len: usize, source: usize) {
        if self.stamps.len() < len {
            self.stamps.resize(len, 0);
            self.wanted.resize(len, 0);
            self.units.resize(len, 0);
        }
        if self.epoch == u32::MAX {
            self.stamps.fill(0);
            self.wanted.fill(0);
            self.epoch = 0;
        }
        self.epoch += 1;
        self.queue.clear();
        self.reach(source as u32, 0);
    }

    /// Length of the shortest path found so far; final for points that are settled.
    pub fn units(&self, point: usize) -> u64 {
        if self.stamps[point] == self.epoch {
            self.units[point]
        } else {
            UNREACHED
        }
    }

    /// Marks a point as a target; `false` when it is one already.
    pub fn want(&mut self, point: usize) -> bool {
        std::mem::replace(&mut self.wanted[point], self.epoch) != self.epoch
    }

    pub fn is_wanted(&self, point: usize) -> bool {
        self.wanted[point] == self.epoch
    }

    pub fn reach(&mut self, point: u32, units: u64) {
        if units < self.units(point as usize) {
            self.stamps[point as usize] = self.epoch;
            self.units[point as usize] = units;
            self.queue.push(Reverse((units, point)));
        }
    }

    /// Drops queue entries that a shorter path has overtaken.
    pub fn top(&mut self) -> Option<u64> {
        while let Some(&Reverse((units, point))) = self.queue.peek() {
            if units == self.units[point as usize] {
                return Some(units);
            }
            self.queue.pop();
        }
        None
    }

    /// Settles the nearest point that is not settled yet, in order of (distance, index), and
    /// reaches out from it as far as `most`.
    pub fn settle(&mut self, graph: &Csr<(), u64, Directed, u32>, most: u64) -> Option<(u64, u32)> {
        self.top()?;
        let Reverse((units, point)) = self.queue.pop()?;
        let edges = graph.edges_slice(point);
        for (&end, &length) in graph.neighbors_slice(point).iter().zip(edges) {
            let there = units + length;
            if there <= most {
                self.reach(end, there);
            }
        }
        Some((units, point))
    }
}
