//! What is told of creases.

use serde::Serialize;

/// The angle between the two faces at a crease, degrees: 0 where they lie on each other, 180 where they continue each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CreaseAngle {
    /// Least along the crease.
    pub min: f64,
    /// In the middle of all places along it.
    pub median: f64,
    /// Largest along it.
    pub max: f64,
}

/// Where a crease ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum CreaseEnd {
    /// In a corner, by its place in [`Creases::corners`].
    Corner(u32),
    /// Where the surface ends.
    Boundary,
    /// On a curve in which sheets cross or meet, or where the points do not tell.
    Elsewhere,
}

/// A curve along which a sheet bends sharply.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Crease {
    /// Closed, or an arc.
    pub circle: bool,
    /// The faces on its sides; twice the same where a face meets itself.
    pub faces: [u32; 2],
    /// The angle between them.
    pub angle: CreaseAngle,
    /// Length, unit of the data.
    pub length: f64,
    /// For an arc, where it ends: at its first and at its last place.
    pub ends: Option<[CreaseEnd; 2]>,
    /// Places on it, in order, where the sheets of its sides meet.
    pub places: Vec<Vec<f64>>,
}

/// A point in which three creases or more meet.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Corner {
    /// Its place, unit of the data, about as exact as landmarks are apart.
    pub place: Vec<f64>,
    /// How many creases end there; one that ends there twice counts twice.
    pub creases: usize,
}

/// The creases of a surface with the faces between them and the corners in which they meet. `Display` counts them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Creases {
    /// Number of parts of the surface that creases bound, and curves in which sheets cross or meet.
    pub faces: usize,
    /// The creases, circles first.
    pub creases: Vec<Crease>,
    /// The corners.
    pub corners: Vec<Corner>,
    /// Radius below which a bend is not told from a crease, unit of the data: two edges of the mesh.
    pub resolution: f64,
    /// For each vertex of the mesh its face; none on curves in which sheets cross or meet.
    #[serde(skip)]
    pub vertex_face: Vec<Option<u32>>,
}

impl Creases {
    /// Every place that is told, to be told in other coordinates.
    pub fn places_mut(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let along = self
            .creases
            .iter_mut()
            .flat_map(|crease| &mut crease.places);
        along.chain(self.corners.iter_mut().map(|corner| &mut corner.place))
    }
}
