//! The surface with its crossings taken apart.

use super::gluing::{FREE, Gluing};
use super::{Piece, PiecesError, Surface, straightness};
use crate::homology::bare_edges;
use crate::homology::sides::runs_backward;
use crate::homology::signed_union::{Joined, SignedUnion};
use crate::orthogonal::dot;
use crosscap_core::{Complex, CurveEdge, Mesh};

/// Local sheets and pieces of a glued surface.
pub(super) struct Normalization {
    /// For each corner the vertex of the normalization that it is.
    pub sheet: Vec<u32>,
    /// For each vertex of the normalization the vertex of the mesh that it stands for.
    pub original_vertex: Vec<u32>,
    /// For each vertex of the normalization whether it lies on the boundary.
    pub rim: Vec<bool>,
    /// For each triangle its piece.
    pub triangle_piece: Vec<u32>,
    pub pieces: Vec<Piece>,
    /// Curve edges without a triangle.
    pub bare: Vec<[u32; 2]>,
}

impl Normalization {
    /// A vertex of the normalization is a class of corners that hang together at a vertex
    /// through glued sides: one local sheet.
    pub fn new(gluing: &Gluing<'_>) -> Self {
        let complex = &gluing.mesh.complex;
        let triangles = complex.triangles.len();
        let mut corners = SignedUnion::new(3 * triangles);
        let mut regions = SignedUnion::new(triangles);
        let mut twisted = Vec::new();
        for s in 0..3 * triangles as u32 {
            let t = gluing.partner[s as usize];
            if t == FREE || t < s {
                continue;
            }
            for v in gluing.sides.edges[gluing.edge_of[s as usize] as usize] {
                corners.join(gluing.corner(s, v), gluing.corner(t, v), false);
            }
            let opposite = runs_backward(s) == runs_backward(t);
            if regions.join(s / 3, t / 3, opposite) == Joined::Contradiction {
                twisted.push(s / 3);
            }
        }

        let bare = bare_edges(complex, &gluing.sides);
        // Sheets by their vertex and first corner; the bare part of a vertex comes last.
        let vertex_of = |c: u32| complex.triangles[c as usize / 3][c as usize % 3];
        let mut names: Vec<(u32, u32)> = (0..3 * triangles as u32)
            .filter(|&c| corners.find(c).0 == c)
            .map(|c| (vertex_of(c), c))
            .collect();
        let mut alone = vec![true; complex.vertices];
        names.iter().for_each(|&(v, _)| alone[v as usize] = false);
        bare.iter()
            .flatten()
            .for_each(|&v| alone[v as usize] = true);
        let bare_vertices = (0..complex.vertices).filter(|&v| alone[v]);
        names.extend(bare_vertices.map(|v| (v as u32, u32::MAX)));
        names.sort_unstable();
        let mut sheet = vec![0; 3 * triangles];
        for (k, &(_, corner)) in names.iter().enumerate() {
            if corner != u32::MAX {
                sheet[corner as usize] = k as u32;
            }
        }
        for c in 0..3 * triangles as u32 {
            sheet[c as usize] = sheet[corners.find(c).0 as usize];
        }
        let bare_name = |v: u32| names.partition_point(|n| *n < (v, u32::MAX)) as u32;
        let bare = bare.iter().map(|ends| ends.map(bare_name)).collect();

        let mut result = Self {
            sheet,
            original_vertex: names.iter().map(|n| n.0).collect(),
            rim: vec![false; names.len()],
            triangle_piece: vec![0; triangles],
            pieces: Vec::new(),
            bare,
        };
        result.classify(gluing, &mut regions, &twisted);
        result
    }

    /// Both ends of a side, as vertices of the normalization in the order of the edge's ends.
    pub fn ends(&self, gluing: &Gluing<'_>, side: u32) -> [u32; 2] {
        let edge = gluing.sides.edges[gluing.edge_of[side as usize] as usize];
        edge.map(|v| self.sheet[gluing.corner(side, v) as usize])
    }

    /// Counts vertices, edges, triangles and boundary circles of every piece.
    fn classify(&mut self, gluing: &Gluing<'_>, regions: &mut SignedUnion, twisted: &[u32]) {
        let triangles = self.triangle_piece.len();
        let mut count = 0;
        for t in 0..triangles {
            let (first, _) = regions.find(t as u32);
            // The representative is the smallest member, so it has its number already.
            self.triangle_piece[t] = if first as usize == t {
                count += 1;
                count - 1
            } else {
                self.triangle_piece[first as usize]
            };
        }
        let mut tallies = vec![Tally::default(); count as usize];
        let mut piece_of_sheet = vec![u32::MAX; self.original_vertex.len()];
        for (c, &v) in self.sheet.iter().enumerate() {
            piece_of_sheet[v as usize] = self.triangle_piece[c / 3];
        }
        for &p in piece_of_sheet.iter().filter(|&&p| p != u32::MAX) {
            tallies[p as usize].vertices += 1;
        }
        // A sheet at the boundary has two free sides, so boundary components are circles.
        let mut circles = SignedUnion::new(self.original_vertex.len());
        for s in 0..3 * triangles as u32 {
            let tally = &mut tallies[self.triangle_piece[s as usize / 3] as usize];
            let t = gluing.partner[s as usize];
            if t == FREE || s < t {
                tally.edges += 1;
            }
            if t == FREE {
                let [a, b] = self.ends(gluing, s);
                for v in [a, b] {
                    if !std::mem::replace(&mut self.rim[v as usize], true) {
                        tally.circles += 1;
                    }
                }
                if circles.join(a, b, false) == Joined::New {
                    tally.circles -= 1;
                }
            }
        }
        for (t, &p) in self.triangle_piece.iter().enumerate() {
            tallies[p as usize].triangles += 1;
            tallies[p as usize].area += area(gluing.mesh, t);
        }
        for &t in twisted {
            tallies[self.triangle_piece[t as usize] as usize].twisted = true;
        }
        self.pieces = tallies.iter().map(Tally::piece).collect();
    }

    /// The normalization as a mesh, and for each of its triangles the original one.
    pub fn mesh(&self, gluing: &Gluing<'_>) -> Result<(Mesh, Vec<u32>), PiecesError> {
        let original = gluing.mesh;
        let mut order: Vec<([u32; 3], u32)> = self
            .sheet
            .chunks_exact(3)
            .enumerate()
            .map(|(t, c)| ([c[0], c[1], c[2]], t as u32))
            .collect();
        // Names grow with the original ones, so corners are in order already.
        order.sort_unstable();
        let mut curves: Vec<CurveEdge> = self
            .bare
            .iter()
            .map(|&[a, b]| CurveEdge::new(a, b, 0))
            .collect();
        let mut here: Vec<([u32; 2], bool)> = Vec::new();
        for e in 0..gluing.sides.edges.len() {
            let at = gluing.sides.at(e);
            if at.len() == 2 {
                continue;
            }
            here.clear();
            let glued = |s: u32| gluing.partner[s as usize] != FREE;
            here.extend(at.iter().map(|&s| (self.ends(gluing, s), glued(s))));
            here.sort_unstable();
            for same in here.chunk_by(|x, y| x.0 == y.0) {
                // Two sheets over one edge that hang together at both its ends are one edge of
                // four triangles: a simplicial complex cannot tell them apart.
                if same.len() != 2 || !same[0].1 {
                    let [a, b] = same[0].0;
                    let cells = u8::try_from(same.len()).unwrap_or(u8::MAX);
                    curves.push(CurveEdge::new(a, b, cells));
                }
            }
        }
        let complex = Complex::new(
            self.original_vertex.len(),
            order.iter().map(|o| o.0).collect(),
            curves,
        )?;
        let rows: Vec<usize> = self.original_vertex.iter().map(|&v| v as usize).collect();
        let point_index = rows.iter().map(|&v| original.point_index[v]).collect();
        let mesh = Mesh::new(complex, original.vertices.select(&rows), point_index)?;
        Ok((mesh, order.iter().map(|o| o.1).collect()))
    }
}

/// Area of a triangle of the mesh, by Gram-Schmidt so that it never is NaN for a thin one.
fn area(mesh: &Mesh, t: usize) -> f64 {
    let [a, b, c] = mesh.complex.triangles[t].map(|v| mesh.vertices.point(v as usize));
    let to = |q: &[f64]| -> Vec<f64> { a.iter().zip(q).map(|(x, y)| y - x).collect() };
    let Some((base, length)) = straightness::unit(to(b)) else {
        return 0.0;
    };
    let mut height = to(c);
    let forward = dot(&height, &base);
    height
        .iter_mut()
        .zip(&base)
        .for_each(|(x, u)| *x -= forward * u);
    straightness::unit(height).map_or(0.0, |(_, height)| length * height / 2.0)
}

#[derive(Clone, Default)]
struct Tally {
    vertices: usize,
    edges: usize,
    triangles: usize,
    circles: i64,
    area: f64,
    twisted: bool,
}

impl Tally {
    fn piece(&self) -> Piece {
        let euler = self.vertices as i64 - self.edges as i64 + self.triangles as i64;
        let surface = Surface::from_euler(!self.twisted, euler, self.circles.unsigned_abs());
        Piece {
            name: surface.to_string(),
            surface,
            euler,
            vertices: self.vertices,
            edges: self.edges,
            triangles: self.triangles,
            area: self.area,
        }
    }
}
