//! Graphs of curve points: connected parts, and what paths reach first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// For every node those joined to it, with their distances.
pub(super) type Graph = [Vec<(usize, f64)>];

/// The connected parts of a graph without its corners, each in order of its nodes.
pub(super) fn components(graph: &Graph, first_corner: usize) -> Vec<Vec<usize>> {
    let mut seen = vec![false; first_corner];
    let mut parts = Vec::new();
    for start in 0..first_corner {
        if !seen[start] {
            parts.push(component(graph, start, first_corner, &mut seen));
        }
    }
    parts
}

fn component(graph: &Graph, start: usize, first_corner: usize, seen: &mut [bool]) -> Vec<usize> {
    let mut out = vec![start];
    seen[start] = true;
    let mut at = 0;
    while at < out.len() {
        for &(k, _) in &graph[out[at]] {
            if k < first_corner && !seen[k] {
                seen[k] = true;
                out.push(k);
            }
        }
        at += 1;
    }
    out.sort_unstable();
    out
}

/// Nodes in order of their path length from `sources`, and the source each belongs to.
pub(super) fn sweep(
    graph: &Graph,
    sources: &[usize],
    inside: impl Fn(usize) -> bool,
) -> (Vec<(usize, f64)>, Vec<usize>) {
    let mut owner = vec![usize::MAX; graph.len()];
    let mut heap = BinaryHeap::new();
    // Path lengths as integers order like the numbers themselves: both are non-negative.
    for &s in sources {
        heap.push(Reverse((0f64.to_bits(), s, s)));
    }
    let mut order = Vec::new();
    while let Some(Reverse((bits, node, source))) = heap.pop() {
        if owner[node] != usize::MAX {
            continue;
        }
        owner[node] = source;
        let length = f64::from_bits(bits);
        order.push((node, length));
        for &(next, d) in &graph[node] {
            if owner[next] == usize::MAX && inside(next) {
                heap.push(Reverse(((length + d).to_bits(), next, source)));
            }
        }
    }
    (order, owner)
}

/// Pairs of sources whose geodesic Voronoi cells touch.
pub(super) fn adjacent(
    graph: &Graph,
    sources: &[usize],
    inside: impl Fn(usize) -> bool,
) -> Vec<(usize, usize)> {
    let (_, owner) = sweep(graph, sources, inside);
    let mut edges = Vec::new();
    for (a, row) in graph.iter().enumerate() {
        for &(b, _) in row {
            let (p, q) = (owner[a], owner[b]);
            if p < q && q != usize::MAX {
                edges.push((p, q));
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Drops the longest edge of every triangle: a chain is a path, a triangle a shortcut.
pub(super) fn without_triangles(
    mut edges: Vec<(usize, usize)>,
    length: impl Fn(usize, usize) -> f64,
) -> Vec<(usize, usize)> {
    edges.sort_by(|&(a, b), &(c, d)| {
        length(a, b)
            .total_cmp(&length(c, d))
            .then((a, b).cmp(&(c, d)))
    });
    let mut kept: Vec<(usize, usize)> = Vec::new();
    for (a, b) in edges {
        let around = |v: usize| -> Vec<usize> {
            kept.iter()
                .filter_map(|&(p, q)| {
                    if p == v {
                        Some(q)
                    } else if q == v {
                        Some(p)
                    } else {
                        None
                    }
                })
                .collect()
        };
        let other = around(b);
        if !around(a).iter().any(|x| other.contains(x)) {
            kept.push((a, b));
        }
    }
    kept
}
