//! Distances along the edges of a mesh.

use crosscap_core::Mesh;
use petgraph::unionfind::UnionFind;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The edge graph of a mesh in compressed rows, edges as long as they are in R^N.
///
/// Rows of its own rather than a `petgraph` graph: its Dijkstra answers in a hash map, and
/// some hundred sources into flat rows of distances are the whole cost of Isomap.
pub(super) struct EdgeGraph {
    starts: Vec<u32>,
    ends: Vec<u32>,
    lengths: Vec<f64>,
}

/// A vertex waiting in the queue, nearest first, ties by index.
#[derive(PartialEq)]
struct Waiting {
    distance: f64,
    vertex: u32,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .distance
            .total_cmp(&self.distance)
            .then(other.vertex.cmp(&self.vertex))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Buffers of one search, kept from source to source.
#[derive(Default)]
pub(super) struct Search(BinaryHeap<Waiting>);

impl EdgeGraph {
    /// The graph of all edges of triangles and curves, lengths divided by `scale`.
    pub(super) fn of(mesh: &Mesh, scale: f64) -> Self {
        let edges = mesh.complex.edges();
        let mut starts = vec![0u32; mesh.complex.vertices + 1];
        for e in &edges {
            for &v in e {
                starts[v as usize + 1] += 1;
            }
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut ends = vec![0u32; edges.len() * 2];
        let mut lengths = vec![0.0; edges.len() * 2];
        for &[a, b] in &edges {
            let (p, q) = (
                mesh.vertices.point(a as usize),
                mesh.vertices.point(b as usize),
            );
            let length = p
                .iter()
                .zip(q)
                .map(|(x, y)| (x / scale - y / scale).powi(2))
                .sum::<f64>()
                .sqrt();
            for (from, to) in [(a, b), (b, a)] {
                let at = fill[from as usize] as usize;
                ends[at] = to;
                lengths[at] = length;
                fill[from as usize] += 1;
            }
        }
        Self {
            starts,
            ends,
            lengths,
        }
    }

    /// Connected components, each with its vertices in increasing order, by their first vertex.
    pub(super) fn components(&self) -> Vec<Vec<u32>> {
        let count = self.starts.len() - 1;
        let mut union = UnionFind::<u32>::new(count);
        for v in 0..count {
            for &w in &self.ends[self.row(v)] {
                union.union(v as u32, w);
            }
        }
        let mut name = vec![u32::MAX; count];
        let mut components: Vec<Vec<u32>> = Vec::new();
        for v in 0..count as u32 {
            let root = union.find(v) as usize;
            if name[root] == u32::MAX {
                name[root] = components.len() as u32;
                components.push(Vec::new());
            }
            components[name[root] as usize].push(v);
        }
        components
    }

    /// Writes the distance of every vertex from `source` into `distances`, infinity where
    /// there is no way. O(e log v).
    pub(super) fn distances_from(&self, source: u32, distances: &mut [f64], search: &mut Search) {
        distances.fill(f64::INFINITY);
        distances[source as usize] = 0.0;
        let queue = &mut search.0;
        queue.clear();
        queue.push(Waiting {
            distance: 0.0,
            vertex: source,
        });
        while let Some(Waiting { distance, vertex }) = queue.pop() {
            if distance > distances[vertex as usize] {
                continue;
            }
            for at in self.row(vertex as usize) {
                let (next, through) = (self.ends[at], distance + self.lengths[at]);
                if through < distances[next as usize] {
                    distances[next as usize] = through;
                    queue.push(Waiting {
                        distance: through,
                        vertex: next,
                    });
                }
            }
        }
    }

    fn row(&self, vertex: usize) -> std::ops::Range<usize> {
        self.starts[vertex] as usize..self.starts[vertex + 1] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::{Complex, CurveEdge, PointCloud};
    use petgraph::{algo::dijkstra, graph::NodeIndex, graph::UnGraph};
    use proptest::prelude::*;

    fn path_and_island() -> Mesh {
        let complex = Complex::new(
            4,
            vec![],
            vec![CurveEdge::new(0, 1, 0), CurveEdge::new(1, 2, 0)],
        )
        .unwrap();
        let places = PointCloud::new(1, vec![0.0, 1.0, 3.0, 9.0]).unwrap();
        Mesh::new(complex, places, vec![-1; 4]).unwrap()
    }

    #[test]
    fn goes_along_edges_and_knows_what_it_cannot_reach() {
        let graph = EdgeGraph::of(&path_and_island(), 1.0);
        let mut d = vec![0.0; 4];
        graph.distances_from(0, &mut d, &mut Search::default());
        assert_eq!(d, [0.0, 1.0, 3.0, f64::INFINITY]);
        assert_eq!(graph.components(), vec![vec![0, 1, 2], vec![3]]);
    }

    proptest! {
        #[test]
        fn agrees_with_petgraph(
            places in prop::collection::vec(-1.0..1.0f64, 3 * 30),
            pairs in prop::collection::btree_set((0u32..30, 0u32..30), 1..90),
        ) {
            let edges: std::collections::BTreeSet<_> = pairs
                .into_iter()
                .filter(|(a, b)| a != b)
                .map(|(a, b)| CurveEdge::new(a, b, 0))
                .collect();
            let complex = Complex::new(30, vec![], edges.into_iter().collect()).unwrap();
            let mesh =
                Mesh::new(complex, PointCloud::new(3, places).unwrap(), vec![-1; 30]).unwrap();
            let mut reference = UnGraph::<(), f64>::default();
            for _ in 0..30 {
                reference.add_node(());
            }
            for e in &mesh.complex.curve_edges {
                let [a, b] = e.ends.map(|v| v as usize);
                reference.add_edge(
                    NodeIndex::new(a),
                    NodeIndex::new(b),
                    mesh.vertices.squared_distance(a, b).sqrt(),
                );
            }
            let expected = dijkstra(&reference, NodeIndex::new(0), None, |e| *e.weight());
            let mut found = vec![0.0; 30];
            EdgeGraph::of(&mesh, 1.0).distances_from(0, &mut found, &mut Search::default());
            for (v, &d) in found.iter().enumerate() {
                match expected.get(&NodeIndex::new(v)) {
                    Some(&e) => prop_assert!((d - e).abs() < 1e-12),
                    None => prop_assert!(d.is_infinite()),
                }
            }
        }
    }
}
