//! What there is to see.

use crosscap_core::{Complex, Error, PointCloud};

/// What meets in a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CurveKind {
    /// Four cells: two sheets cross.
    Double,
    /// One cell: a boundary.
    Boundary,
    /// Three cells, or more than four: the surface branches.
    Triple,
    /// No cell: a curve that no surface touches.
    Bare,
}

impl CurveKind {
    /// All kinds, in the order in which they are listed and drawn.
    pub const ALL: [Self; 4] = [Self::Double, Self::Boundary, Self::Triple, Self::Bare];

    /// The kind of a curve edge in which `cells` cells meet; `None` for 2, an edge inside the surface.
    pub fn of_cells(cells: u8) -> Option<Self> {
        match cells {
            0 => Some(Self::Bare),
            1 => Some(Self::Boundary),
            2 => None,
            4 => Some(Self::Double),
            _ => Some(Self::Triple),
        }
    }

    /// Its name in the plural, as the legend gives it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "double curves",
            Self::Boundary => "boundary curves",
            Self::Triple => "branching curves",
            Self::Bare => "bare curves",
        }
    }
}

/// Edges that are drawn as a curve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Curve {
    /// What meets in them.
    pub kind: CurveKind,
    /// The edges as pairs of vertices, in any order.
    pub edges: Vec<[u32; 2]>,
}

/// One way to put the vertices into three dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Its name, as the reader chooses it: "Isomap", "principal axes", "x, y, z".
    pub name: String,
    /// The place of every vertex. Units do not matter: a picture is fitted to its frame.
    pub places: Vec<[f32; 3]>,
    /// Sample points to be shown with the mesh, in the same coordinates; may be empty. A
    /// page carries 16 bytes for each.
    pub points: Vec<[f32; 3]>,
}

impl Layout {
    /// The layout that takes the coordinates with indices `axes` for x, y and z, of vertices
    /// and, where given, of sample points. An index beyond the dimension of the vertices gives 0,
    /// so a plane or a line can be shown too.
    ///
    /// Places are taken relative to the middle of the vertices and divided by the
    /// largest extent before they are rounded to `f32`: neither a far origin nor a huge or tiny unit costs accuracy.
    ///
    /// # Errors
    /// [`Error::Shape`] when vertices and points differ in dimension.
    pub fn coordinates(
        name: impl Into<String>,
        vertices: &PointCloud<f64>,
        points: Option<&PointCloud<f64>>,
        axes: [usize; 3],
    ) -> Result<Self, Error> {
        if let Some(p) = points.filter(|p| p.dimension() != vertices.dimension()) {
            return Err(Error::Shape {
                found: format!("points of dimension {}", p.dimension()),
                expected: format!("dimension {}, that of the vertices", vertices.dimension()),
            });
        }
        let pick = |row: &[f64]| axes.map(|a| row.get(a).copied().unwrap_or(0.0));
        let frame = Frame::of(vertices.iter().map(pick))
            .or_else(|| Frame::of(points.into_iter().flat_map(|p| p.iter().map(pick))))
            .unwrap_or_default();
        // A sample point far outside of the mesh must not become an infinity.
        let place = |row: &[f64]| frame.place(pick(row)).map(|c| c.clamp(-1e6, 1e6) as f32);
        Ok(Self {
            name: name.into(),
            places: vertices.iter().map(place).collect(),
            points: points.map_or_else(Vec::new, |p| p.iter().map(place).collect()),
        })
    }
}

/// A number at every vertex, at every sample point, or both, by which a page can color them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneScalar {
    /// Its name, as the reader chooses it: "height", "dimension".
    pub name: String,
    /// Its values at the vertices, NaN where there is none; empty when vertices have none at all.
    pub vertices: Vec<f32>,
    /// Its values at the sample points, likewise.
    pub points: Vec<f32>,
}

/// A place that a reader should look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The layout that it is shown in.
    pub layout: usize,
    /// Where, in the coordinates of this layout.
    pub place: [f32; 3],
    /// What is to be said about it; any text.
    pub text: String,
}

/// What there is to see, for [`super::page`] and [`super::still`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Heading; any text.
    pub title: String,
    /// Facts for the table on the page (Betti numbers, verdict, parameters): name and value, any text.
    pub facts: Vec<(String, String)>,
    /// Ways to put the vertices into three dimensions, at least one; the first one is shown
    /// first, and a still image shows it unless told otherwise. All have the same number of places.
    pub layouts: Vec<Layout>,
    /// Triangles as triples of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its piece, an index into `piece_names`.
    pub triangle_piece: Vec<u32>,
    /// Names of the pieces: "sphere", "Klein bottle".
    pub piece_names: Vec<String>,
    /// Curves, drawn in this order.
    pub curves: Vec<Curve>,
    /// Numbers by which vertices and sample points can be colored.
    pub scalars: Vec<SceneScalar>,
    /// For each vertex the row of the input that it stands for, -1 for none; empty when nothing is known.
    pub vertex_rows: Vec<i32>,
    /// For each sample point its row of the input; empty when all rows are shown.
    pub point_rows: Vec<u32>,
    /// Places to look at.
    pub marks: Vec<Mark>,
}

impl Scene {
    /// The scene of a complex as one piece called "surface", its marked edges as curves. Facts
    /// and pieces can be filled in afterwards.
    pub fn new(title: impl Into<String>, complex: &Complex, layouts: Vec<Layout>) -> Self {
        let curves = CurveKind::ALL
            .into_iter()
            .filter_map(|kind| {
                let edges: Vec<[u32; 2]> = complex
                    .curve_edges
                    .iter()
                    .filter(|e| CurveKind::of_cells(e.cells) == Some(kind))
                    .map(|e| e.ends)
                    .collect();
                (!edges.is_empty()).then_some(Curve { kind, edges })
            })
            .collect();
        Self {
            title: title.into(),
            facts: Vec::new(),
            layouts,
            triangles: complex.triangles.clone(),
            triangle_piece: vec![0; complex.triangles.len()],
            piece_names: vec!["surface".into()],
            curves,
            ..Self::default()
        }
    }

    /// Whether everything fits together.
    ///
    /// # Errors
    /// [`Error::Shape`] when there is no layout, two layouts differ in their number of places, or
    /// triangles and their pieces, or vertices or points and their rows or scalars, differ in number; [`Error::Index`] for a
    /// vertex, piece or layout out of range; [`Error::NotFinite`] for a place with a NaN or an infinity.
    pub fn check(&self) -> Result<(), Error> {
        let Some(first) = self.layouts.first() else {
            return Err(Error::Shape {
                found: "no layout".into(),
                expected: "at least one way to put the vertices into three dimensions".into(),
            });
        };
        let count = first.places.len();
        for layout in &self.layouts {
            if layout.places.len() != count {
                return Err(Error::Shape {
                    found: format!("{} places in layout {:?}", layout.places.len(), layout.name),
                    expected: format!("{count}, as in layout {:?}", first.name),
                });
            }
            for list in [&layout.places, &layout.points] {
                for (row, place) in list.iter().enumerate() {
                    if let Some(column) = place.iter().position(|c| !c.is_finite()) {
                        return Err(Error::NotFinite { row, column });
                    }
                }
            }
        }
        if self.triangle_piece.len() != self.triangles.len() {
            return Err(Error::Shape {
                found: format!("{} pieces of triangles", self.triangle_piece.len()),
                expected: format!("{}, one a triangle", self.triangles.len()),
            });
        }
        self.check_rows(count)?;
        let limit = self.piece_names.len();
        if let Some(&p) = self.triangle_piece.iter().find(|&&p| p as usize >= limit) {
            return Err(Error::Index {
                what: "piece",
                index: p as usize,
                limit,
            });
        }
        let corners = self.triangles.iter().flatten();
        let ends = self.curves.iter().flat_map(|c| c.edges.iter().flatten());
        match corners.chain(ends).find(|&&v| v as usize >= count) {
            Some(&v) => Err(Error::Index {
                what: "vertex",
                index: v as usize,
                limit: count,
            }),
            None => Ok(()),
        }
    }

    /// Whether rows, scalars and marks fit to the vertices, the points and the layouts.
    fn check_rows(&self, count: usize) -> Result<(), Error> {
        let points = self.layouts.iter().map(|l| l.points.len()).max();
        let points = points.unwrap_or(0);
        let rows = [
            ("rows of vertices", self.vertex_rows.len(), count),
            ("rows of points", self.point_rows.len(), points),
        ];
        let scalars = self.scalars.iter().flat_map(|s| {
            [
                ("scalars of vertices", s.vertices.len(), count),
                ("scalars of points", s.points.len(), points),
            ]
        });
        for (what, found, expected) in rows.into_iter().chain(scalars) {
            if found != 0 && found != expected {
                return Err(Error::Shape {
                    found: format!("{found} {what}"),
                    expected: format!("{expected}, or none"),
                });
            }
        }
        for mark in &self.marks {
            if mark.layout >= self.layouts.len() {
                return Err(Error::Index {
                    what: "layout",
                    index: mark.layout,
                    limit: self.layouts.len(),
                });
            }
            if let Some(column) = mark.place.iter().position(|c| !c.is_finite()) {
                return Err(Error::NotFinite { row: 0, column });
            }
        }
        Ok(())
    }

    /// Which of `count` vertices are drawn: those of triangles and curves, or all when there are none.
    pub(super) fn used(&self, count: usize) -> Vec<bool> {
        let mut used = vec![self.is_bare(); count];
        let ends = self.curves.iter().flat_map(|c| c.edges.iter().flatten());
        for &v in self.triangles.iter().flatten().chain(ends) {
            used[v as usize] = true;
        }
        used
    }

    /// Whether there are only vertices and points.
    pub(super) fn is_bare(&self) -> bool {
        self.triangles.is_empty() && self.curves.iter().all(|c| c.edges.is_empty())
    }

    /// Edges of triangles, sorted, each once.
    pub(super) fn edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Edges of all curves, sorted, each once.
    pub(super) fn curve_edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self
            .curves
            .iter()
            .flat_map(|c| c.edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}

/// The frame that a picture is fitted to: a middle and a size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    middle: [f64; 3],
    half: f64,
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            middle: [0.0; 3],
            half: 1.0,
        }
    }
}

impl Frame {
    /// Around the given finite places; `None` when there are none.
    pub(super) fn of(places: impl Iterator<Item = [f64; 3]>) -> Option<Self> {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for place in places {
            for axis in 0..3 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        }
        if low[0] > high[0] {
            return None;
        }
        // Halves first: the sum of two numbers near the end of the range is infinite.
        let half = (0..3)
            .map(|a| high[a] / 2.0 - low[a] / 2.0)
            .fold(0.0, f64::max);
        Some(Self {
            middle: std::array::from_fn(|a| low[a] / 2.0 + high[a] / 2.0),
            half: if half > 0.0 { half } else { 1.0 },
        })
    }

    /// Its middle.
    pub(super) fn middle(&self) -> [f64; 3] {
        self.middle
    }

    /// Half of its longest side, above 0.
    pub(super) fn half(&self) -> f64 {
        self.half
    }

    /// A place relative to the frame: the box around everything reaches from -1 to 1 along its longest side.
    pub(super) fn place(&self, place: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (place[a] / self.half) - (self.middle[a] / self.half))
    }
}

#[cfg(test)]
mod tests;
