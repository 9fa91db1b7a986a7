//! Simplicial complexes of dimension 2 with marked curves, and meshes: complexes with places.

use crate::{Error, Landmark, PointCloud};
use serde::{Deserialize, Serialize};

/// An edge along a curve: a boundary, a double curve, a curve of another kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(from = "MarkedEdge")]
pub struct CurveEdge {
    /// Its ends, the smaller index first.
    pub ends: [u32; 2],
    /// How many cells meet in it, hence how many triangles it must have: 0 a curve that no
    /// surface touches, 1 a boundary, 3 a Y-junction, 4 a double curve.
    pub cells: u8,
}

impl CurveEdge {
    /// An edge with its ends in order.
    pub fn new(a: u32, b: u32, cells: u8) -> Self {
        Self {
            ends: [a.min(b), a.max(b)],
            cells,
        }
    }

    /// Its ends, where it is an edge of a waist: the vertices of a complex on landmarks are those landmarks.
    pub fn landmarks(&self) -> [Landmark; 2] {
        self.ends.map(Landmark::from)
    }
}

/// A curve edge as it is in a file.
#[derive(Deserialize)]
struct MarkedEdge {
    ends: [u32; 2],
    cells: u8,
}

impl From<MarkedEdge> for CurveEdge {
    fn from(edge: MarkedEdge) -> Self {
        Self::new(edge.ends[0], edge.ends[1], edge.cells)
    }
}

/// A finite simplicial complex of dimension at most 2 whose curves are marked.
///
/// Edges of triangles are implied. An edge that is not a curve edge is meant to have two triangles.
/// What is read from a file goes through [`Complex::new`].
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Complex {
    /// Number of vertices; vertices are `0..vertices`.
    pub vertices: usize,
    /// Triangles as triples of vertices, corners in increasing order, sorted.
    pub triangles: Vec<[u32; 3]>,
    /// Marked edges, sorted, each once.
    pub curve_edges: Vec<CurveEdge>,
}

/// A complex as it is in a file, before anything is known about it.
#[derive(Deserialize)]
struct Unchecked {
    vertices: usize,
    triangles: Vec<[u32; 3]>,
    curve_edges: Vec<CurveEdge>,
}

impl TryFrom<Unchecked> for Complex {
    type Error = Error;

    fn try_from(file: Unchecked) -> Result<Self, Error> {
        Self::new(file.vertices, file.triangles, file.curve_edges)
    }
}

impl Complex {
    /// Brings triangles and curve edges into their canonical order.
    ///
    /// # Errors
    /// [`Error::Index`] for a vertex out of range; [`Error::Shape`] for a triangle with a
    /// repeated corner, a triangle or a curve edge that is there twice.
    pub fn new(
        vertices: usize,
        mut triangles: Vec<[u32; 3]>,
        mut curve_edges: Vec<CurveEdge>,
    ) -> Result<Self, Error> {
        for t in &mut triangles {
            t.sort_unstable();
            if t[0] == t[1] || t[1] == t[2] {
                return Err(Error::Shape {
                    found: format!("triangle {t:?}"),
                    expected: "three different corners".into(),
                });
            }
        }
        triangles.sort_unstable();
        for e in &mut curve_edges {
            e.ends.sort_unstable();
            if e.ends[0] == e.ends[1] {
                return Err(Error::Shape {
                    found: format!("curve edge {:?}", e.ends),
                    expected: "two different ends".into(),
                });
            }
        }
        curve_edges.sort_unstable();
        let top = triangles
            .iter()
            .flatten()
            .chain(curve_edges.iter().flat_map(|e| &e.ends))
            .max();
        if let Some(&top) = top.filter(|&&v| v as usize >= vertices) {
            return Err(Error::Index {
                what: "vertex",
                index: top as usize,
                limit: vertices,
            });
        }
        if let Some(w) = triangles.windows(2).find(|w| w[0] == w[1]) {
            return Err(Error::Shape {
                found: format!("triangle {:?} twice", w[0]),
                expected: "each triangle once".into(),
            });
        }
        if let Some(w) = curve_edges.windows(2).find(|w| w[0].ends == w[1].ends) {
            return Err(Error::Shape {
                found: format!("curve edge {:?} twice", w[0].ends),
                expected: "each curve edge once".into(),
            });
        }
        Ok(Self {
            vertices,
            triangles,
            curve_edges,
        })
    }

    /// All edges, of triangles and of curves, sorted, each once. O(t log t).
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [a, c], [b, c]])
            .chain(self.curve_edges.iter().map(|e| e.ends))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Vertices minus edges plus triangles.
    pub fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edges().len() as i64 + self.triangles.len() as i64
    }
}

/// A complex whose vertices have places in R^N.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The combinatorics.
    pub complex: Complex,
    /// Places of the vertices, `complex.vertices` rows.
    pub vertices: PointCloud<f64>,
    /// For each vertex the row of the input it stands for, -1 for none. A vertex on a double
    /// curve is moved onto the curve, so its place may differ from that of its row.
    pub point_index: Vec<i64>,
}

impl Mesh {
    /// Puts a mesh together.
    ///
    /// # Errors
    /// [`Error::Shape`] when the numbers of vertices, places and rows differ.
    pub fn new(
        complex: Complex,
        vertices: PointCloud<f64>,
        point_index: Vec<i64>,
    ) -> Result<Self, Error> {
        if complex.vertices != vertices.len() || complex.vertices != point_index.len() {
            return Err(Error::Shape {
                found: format!("{} places and {} rows", vertices.len(), point_index.len()),
                expected: format!("{} of each, one a vertex", complex.vertices),
            });
        }
        Ok(Self {
            complex,
            vertices,
            point_index,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tetrahedron_boundary_has_six_edges() {
        let t = vec![[0, 1, 2], [3, 1, 0], [0, 2, 3], [1, 2, 3]];
        let c = Complex::new(4, t, vec![]).unwrap();
        assert_eq!(c.edges().len(), 6);
        assert_eq!(c.euler_characteristic(), 2);
        assert_eq!(c.triangles[1], [0, 1, 3]);
    }

    #[test]
    fn refuses_what_is_no_complex() {
        assert!(Complex::new(3, vec![[0, 1, 1]], vec![]).is_err());
        assert!(Complex::new(3, vec![[0, 1, 3]], vec![]).is_err());
        assert!(Complex::new(3, vec![[0, 1, 2], [2, 1, 0]], vec![]).is_err());
        assert!(Complex::new(3, vec![], vec![CurveEdge::new(1, 1, 1)]).is_err());
    }

    #[test]
    fn a_file_is_put_in_order_or_refused() {
        use serde_json::{Value, from_value, json, to_value};
        let edges = vec![CurveEdge::new(0, 1, 2)];
        let complex = Complex::new(4, vec![[0, 1, 2], [0, 1, 3]], edges).unwrap();
        let read = |change: fn(&mut Value)| {
            let mut file = to_value(&complex).unwrap();
            change(&mut file);
            from_value::<Complex>(file)
        };
        assert_eq!(read(|_| ()).unwrap(), complex);
        let turned = read(|f| {
            f["triangles"] = json!([[3, 0, 1], [2, 1, 0]]);
            f["curve_edges"][0]["ends"] = json!([1, 0]);
        });
        assert_eq!(turned.unwrap(), complex);
        let broken = read(|f| f["triangles"][1] = json!([0, 1, 4])).unwrap_err();
        assert!(broken.to_string().contains("vertex 4"), "{broken}");
        assert!(read(|f| f["triangles"][1] = json!([0, 1, 1])).is_err());
        assert!(read(|f| f["triangles"][1] = json!([0, 1, 2])).is_err());
        assert!(read(|f| f["curve_edges"][0]["ends"] = json!([2, 2])).is_err());
    }
}
