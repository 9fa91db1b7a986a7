//! What paths through the graph reach.

use super::Node;
use super::graph::CellGraph;
use crosscap_core::{Row, Table};

/// A flood with its memory of what was reached, reusable.
#[derive(Default)]
pub(super) struct Flood {
    stamp: Table<Node, u32>,
    round: u32,
    nodes: Vec<Node>,
    /// Rows reached, in the order of the flood.
    pub(super) reached: Vec<Row>,
}

impl Flood {
    /// Everything that paths from the rows `from` reach without leaving the nodes that are `inside`.
    pub(super) fn run(&mut self, graph: &CellGraph, from: &[Row], inside: impl Fn(Node) -> bool) {
        if self.stamp.len() != graph.rows.len() {
            self.stamp = Table::filled(graph.rows.len(), 0);
            self.round = 0;
        }
        self.round += 1;
        self.nodes.clear();
        for &row in from {
            let node = graph.node_of[row];
            if node != Node::NONE && self.stamp[node] != self.round && inside(node) {
                self.stamp[node] = self.round;
                self.nodes.push(node);
            }
        }
        let mut at = 0;
        while at < self.nodes.len() {
            for &other in graph.around(self.nodes[at]) {
                if self.stamp[other] != self.round {
                    self.stamp[other] = self.round;
                    if inside(other) {
                        self.nodes.push(other);
                    }
                }
            }
            at += 1;
        }
        self.reached.clear();
        self.reached
            .extend(self.nodes.iter().map(|&node| graph.rows[node]));
    }
}
