//! What paths through the graph reach.

use super::NONE;
use super::graph::CellGraph;

/// A flood with its memory of what was reached, reusable.
#[derive(Default)]
pub(super) struct Flood {
    stamp: Vec<u32>,
    round: u32,
    nodes: Vec<u32>,
    /// Rows reached, in the order of the flood.
    pub(super) reached: Vec<u32>,
}

impl Flood {
    /// Everything that paths from the rows `from` reach without leaving the nodes that are `inside`.
    pub(super) fn run(&mut self, graph: &CellGraph, from: &[u32], inside: impl Fn(usize) -> bool) {
        if self.stamp.len() != graph.rows.len() {
            self.stamp = vec![0; graph.rows.len()];
            self.round = 0;
        }
        self.round += 1;
        self.nodes.clear();
        for &row in from {
            let node = graph.node_of[row as usize];
            if node != NONE && self.stamp[node as usize] != self.round && inside(node as usize) {
                self.stamp[node as usize] = self.round;
                self.nodes.push(node);
            }
        }
        let mut at = 0;
        while at < self.nodes.len() {
            for &other in graph.around(self.nodes[at] as usize) {
                if self.stamp[other as usize] != self.round {
                    self.stamp[other as usize] = self.round;
                    if inside(other as usize) {
                        self.nodes.push(other);
                    }
                }
            }
            at += 1;
        }
        self.reached.clear();
        self.reached
            .extend(self.nodes.iter().map(|&node| graph.rows[node as usize]));
    }
}
