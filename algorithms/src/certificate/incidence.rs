//! Which triangles meet in which edge and in which vertex.

use crosscap_core::Complex;

/// Edges of a complex with their triangles and marks.
pub(super) struct Incidence {
    /// All edges, of triangles and of curves, sorted.
    pub edges: Vec<[u32; 2]>,
    /// For each edge the number of cells it is marked with, if it is a curve edge.
    pub cells: Vec<Option<u8>>,
    starts: Vec<u32>,
    triangles: Vec<u32>,
    vertex_starts: Vec<u32>,
    vertex_triangles: Vec<u32>,
}

impl Incidence {
    /// O(t log t). Indices must be in range.
    pub fn new(complex: &Complex) -> Self {
        // u32::MAX stands for "of a curve", and sorts after the triangles
        let mut all: Vec<([u32; 2], u32)> =
            Vec::with_capacity(3 * complex.triangles.len() + complex.curve_edges.len());
        for (t, corners) in complex.triangles.iter().enumerate() {
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                let (a, b) = (corners[i].min(corners[j]), corners[i].max(corners[j]));
                all.push(([a, b], t as u32));
            }
        }
        let mut marks: Vec<([u32; 2], u8)> = complex
            .curve_edges
            .iter()
            .map(|e| {
                let [a, b] = e.ends;
                ([a.min(b), a.max(b)], e.cells)
            })
            .collect();
        marks.sort_unstable();
        marks.dedup_by_key(|m| m.0);
        all.extend(marks.iter().map(|m| (m.0, u32::MAX)));
        all.sort_unstable();
        let (mut edges, mut cells, mut starts, mut triangles) = (vec![], vec![], vec![], vec![]);
        for (edge, t) in all {
            if edges.last() != Some(&edge) {
                edges.push(edge);
                cells.push(None);
                starts.push(triangles.len() as u32);
            }
            if t == u32::MAX {
                let k = marks.partition_point(|m| m.0 < edge);
                *cells.last_mut().expect("an edge was pushed") = Some(marks[k].1);
            } else {
                triangles.push(t);
            }
        }
        starts.push(triangles.len() as u32);

        let (vertex_starts, vertex_triangles) = by_vertex(complex);
        Self {
            edges,
            cells,
            starts,
            triangles,
            vertex_starts,
            vertex_triangles,
        }
    }

    /// Triangles at an edge, in increasing order.
    pub fn at_edge(&self, edge: usize) -> &[u32] {
        &self.triangles[self.starts[edge] as usize..self.starts[edge + 1] as usize]
    }

    /// The edges without triangles, which are on curves alone.
    pub fn bare_edges(&self) -> Vec<[u32; 2]> {
        (0..self.edges.len())
            .filter(|&e| self.at_edge(e).is_empty())
            .map(|e| self.edges[e])
            .collect()
    }

    /// The number of cells that an edge is marked with, `None` for an ordinary edge and for none.
    pub fn cells_at(&self, [a, b]: [u32; 2]) -> Option<u8> {
        let edge = self.edges.binary_search(&[a.min(b), a.max(b)]).ok()?;
        self.cells[edge]
    }

    /// Triangles at an edge that is on no curve; none at any other.
    pub fn at_ordinary_edge(&self, [a, b]: [u32; 2]) -> &[u32] {
        match self.edges.binary_search(&[a.min(b), a.max(b)]) {
            Ok(edge) if self.cells[edge].is_none() => self.at_edge(edge),
            _ => &[],
        }
    }

    /// Triangles at a vertex, in increasing order.
    pub fn at_vertex(&self, vertex: usize) -> &[u32] {
        &self.vertex_triangles
            [self.vertex_starts[vertex] as usize..self.vertex_starts[vertex + 1] as usize]
    }
}

/// The triangles at every vertex in increasing order, one vertex after the other, and where each vertex begins.
fn by_vertex(complex: &Complex) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; complex.vertices + 1];
    for &v in complex.triangles.iter().flatten() {
        starts[v as usize + 1] += 1;
    }
    for v in 0..complex.vertices {
        starts[v + 1] += starts[v];
    }
    let mut fill = starts.clone();
    let mut triangles = vec![0; 3 * complex.triangles.len()];
    for (t, corners) in complex.triangles.iter().enumerate() {
        for &v in corners {
            triangles[fill[v as usize] as usize] = t as u32;
            fill[v as usize] += 1;
        }
    }
    (starts, triangles)
}
