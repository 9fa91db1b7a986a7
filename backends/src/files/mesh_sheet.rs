//! A mesh as it is written: checked, wound and given places.

use super::error::{Flaw, Parsed};
use super::mesh_parts::MeshExtras;
use crosscap_algorithms::pieces::wound_triangles;
use crosscap_core::{Complex, Mesh, PointCloud};
use serde_json::Value;

/// A mesh that was checked and given places, as the writers take it.
pub(crate) struct Sheet<'a> {
    pub(crate) mesh: &'a Mesh,
    /// The triangles of the complex in their order, wound.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Places in R^3, one a vertex.
    pub(crate) places: Vec<[f64; 3]>,
    /// Whether the caller gave the places.
    pub(crate) given: bool,
    pub(crate) pieces: Option<&'a [i64]>,
    pub(crate) metadata: &'a Value,
}

impl<'a> Sheet<'a> {
    /// The mesh with places in R^3 to show it with; any dimension does where the format keeps all coordinates.
    pub(crate) fn new(
        mesh: &'a Mesh,
        extras: &'a MeshExtras,
        places: Option<&PointCloud<f64>>,
        any_dimension: bool,
    ) -> Parsed<Self> {
        one_of_each(mesh)?;
        let triangles = wound_triangles(mesh)
            .map_err(|e| Flaw::new(format!("no mesh ({e})"), "a mesh").within("complex"))?;
        if let Some(pieces) = &extras.pieces
            && pieces.len() != triangles.len()
        {
            return Err(Flaw::new(
                format!("{} labels", pieces.len()),
                format!("{}, one a triangle", triangles.len()),
            )
            .within("pieces"));
        }
        let shown = shown(mesh, places, any_dimension)?;
        let places = shown
            .iter()
            .map(|p| std::array::from_fn(|k| p.get(k).copied().unwrap_or(0.0)))
            .collect();
        Ok(Self {
            mesh,
            triangles,
            places,
            given: !std::ptr::eq(shown, &mesh.vertices),
            pieces: extras.pieces.as_deref(),
            metadata: &extras.metadata,
        })
    }
}

/// Refuses a mesh that is none, or has not one place and one row a vertex.
fn one_of_each(mesh: &Mesh) -> Parsed<()> {
    let complex = &mesh.complex;
    let count = complex.vertices;
    Complex::new(
        count,
        complex.triangles.clone(),
        complex.curve_edges.clone(),
    )
    .map_err(|e| Flaw::new(format!("no mesh ({e})"), "a mesh").within("complex"))?;
    if mesh.vertices.len() != count || mesh.point_index.len() != count {
        return Err(Flaw::new(
            format!(
                "{} places and {} rows",
                mesh.vertices.len(),
                mesh.point_index.len()
            ),
            format!("{count} of each, one a vertex"),
        )
        .within("vertices"));
    }
    Ok(())
}

/// The places to write: those that are given, else those of the mesh where the format can hold them.
fn shown<'a>(
    mesh: &'a Mesh,
    places: Option<&'a PointCloud<f64>>,
    any_dimension: bool,
) -> Parsed<&'a PointCloud<f64>> {
    let count = mesh.complex.vertices;
    match places {
        Some(places) if places.len() == count && places.dimension() == 3 => Ok(places),
        Some(places) => Err(Flaw::new(
            format!("{} places in R^{}", places.len(), places.dimension()),
            format!("{count} in R^3, one a vertex"),
        )
        .within("places")),
        None if any_dimension || mesh.vertices.dimension() == 3 => Ok(&mesh.vertices),
        None => Err(Flaw::new(
            format!("a mesh in R^{}", mesh.vertices.dimension()),
            "places in R^3, which this format holds: give some (a projection), or write \
             .npz or .vtu",
        )),
    }
}
