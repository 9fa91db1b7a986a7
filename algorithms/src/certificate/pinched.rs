//! Sheets that come as near to each other as can be, since curves in which they meet lie between them.

use super::incidence::Incidence;
use crosscap_core::Mesh;

/// The triangles near a pinch point by the cell they are in, as far as the folds reach that lead to it.
///
/// Two sheets meet in the double curve at an angle that goes to zero: their triangles are nearer to each other than
/// stacked ones may be. Double curve and folds keep them apart.
pub(super) struct Pinched {
    /// Triangles whose corners are all near the point, sorted, with the name of the cell.
    cells: Vec<(u32, Option<u32>)>,
}

impl Pinched {
    /// The triangles about a vertex. O(t) for t triangles of the mesh.
    pub(super) fn new(mesh: &Mesh, incidence: &Incidence, vertex: u32) -> Self {
        let square = |v: u32| mesh.vertices.squared_distance(vertex as usize, v as usize);
        let folds = fold_ends(mesh, vertex);
        let reach = (folds.iter().map(|&v| square(v))).fold(f64::INFINITY, f64::min);
        let near = |v: u32| !folds.is_empty() && square(v) <= reach;
        let all = &mesh.complex.triangles;
        let inside = (0..all.len() as u32).filter(|&t| all[t as usize].iter().all(|&v| near(v)));
        let mut found = Self {
            cells: inside.map(|t| (t, None)).collect(),
        };
        for start in 0..found.cells.len() {
            found.name(mesh, incidence, start);
        }
        found
    }

    /// Names the cell of the triangle at a position, if it has no name.
    fn name(&mut self, mesh: &Mesh, incidence: &Incidence, start: usize) {
        let mut stack = vec![start];
        while let Some(k) = stack.pop() {
            if self.cells[k].1.is_some() {
                continue;
            }
            self.cells[k].1 = Some(start as u32);
            let [a, b, c] = mesh.complex.triangles[self.cells[k].0 as usize];
            for edge in [[a, b], [a, c], [b, c]] {
                let beside = incidence.at_ordinary_edge(edge).iter();
                stack.extend(beside.filter_map(|&t| self.position(t)));
            }
        }
    }

    fn position(&self, triangle: u32) -> Option<usize> {
        self.cells.binary_search_by_key(&triangle, |c| c.0).ok()
    }

    /// Whether both triangles are near the point and in different cells.
    pub(super) fn parts(&self, pair: [u32; 2]) -> bool {
        let cell = |t: u32| self.cells[self.position(t)?].1;
        matches!(pair.map(cell), [Some(a), Some(b)] if a != b)
    }
}

/// Where the chains of two cells that start at a vertex end; none for a vertex that the mesh does not have.
fn fold_ends(mesh: &Mesh, vertex: u32) -> Vec<u32> {
    let folds: Vec<[u32; 2]> = (mesh.complex.curve_edges.iter())
        .filter(|e| e.cells == 2)
        .map(|e| e.ends)
        .collect();
    let next = |v: u32| {
        let at = folds.iter().filter(move |e| e.contains(&v));
        at.map(move |e| if e[0] == v { e[1] } else { e[0] })
    };
    let mut ends = Vec::new();
    for start in next(vertex) {
        let (mut before, mut here) = (vertex, start);
        // A chain visits every edge at most once.
        for _ in 0..folds.len() {
            let Some(on) = next(here).find(|&v| v != before) else {
                break;
            };
            (before, here) = (here, on);
        }
        ends.push(here);
    }
    ends
}

/// Whether curve edges lie between two triangles of a vertex on every way around it: they are of cells that
/// meet there, at whatever angle, and what angle there may be is asked at the curve edges.
pub(super) fn parted(mesh: &Mesh, incidence: &Incidence, vertex: u32, pair: [u32; 2]) -> bool {
    let corners = |t: u32| mesh.complex.triangles[t as usize];
    let joined = |s: u32, t: u32| {
        let common = corners(s).into_iter();
        let mut common = common.filter(|v| *v != vertex && corners(t).contains(v));
        common
            .next()
            .is_some_and(|v| incidence.cells_at([vertex, v]).is_none())
    };
    let around = incidence.at_vertex(vertex as usize);
    let mut reached = vec![pair[0]];
    let mut at = 0;
    while at < reached.len() {
        let here = reached[at];
        at += 1;
        for &t in around {
            if !reached.contains(&t) && joined(here, t) {
                reached.push(t);
            }
        }
    }
    !reached.contains(&pair[1])
}
