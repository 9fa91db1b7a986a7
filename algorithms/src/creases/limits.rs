//! The numbers by which creases are told.

use serde::Serialize;

/// When a seam of two faces is a crease. *Measured* together, on the samples that the guide names (`docs/src/creases.md`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CreaseLimits {
    /// Points a vertex that are looked at, at most: of a denser cloud an even part tells as much.
    pub points: usize,
    /// Points about a vertex that are enough to fit a sheet, from as many layers of triangles as hold them.
    pub enough: usize,
    /// Points that a sheet is fitted to at most.
    pub most: usize,
    /// Most layers of triangles.
    pub layers: usize,
    /// A neighborhood is regular where its quadratic sheet leaves at most this many times what a quarter of all
    /// neighborhoods leave less than: noise leaves the same everywhere, up to chance.
    pub regular: f64,
    /// What it may leave anyway, in median edges of the mesh.
    pub flat: f64,
    /// Widest angle between two sheets that is a crease, degrees: 180 is none.
    pub widest: f64,
    /// At a crease the surface turns by at least this many times what both sheets turn by within an edge beside it: a thin tube turns everywhere.
    pub bends: f64,
    /// Least share of the places along a seam that have such an angle.
    pub share: f64,
    /// A seam between corners that is no longer than this, in median edges of the mesh, is part of a corner.
    pub contact: f64,
    /// Fewest places of a crease.
    pub places: usize,
    /// Fewest vertices with regular neighborhoods that hang together and begin a face: next to a crease one or two are by chance.
    pub seeds: usize,
    /// Fewest vertices of a face.
    pub face: usize,
}

impl CreaseLimits {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        points: 24,
        enough: 40,
        most: 160,
        layers: 4,
        regular: 1.6,
        flat: 0.005,
        widest: 160.0,
        bends: 2.0,
        share: 0.6,
        contact: 1.6,
        places: 4,
        seeds: 3,
        face: 4,
    };
}
