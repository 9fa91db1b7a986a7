//! Meshes in archives of NumPy arrays, `.npz`: the format that keeps everything.

use super::error::{Flaw, Parsed};
use super::mesh_parts::{Parts, RawCurve};
use super::mesh_sheet::Sheet;
use super::npz::Archive;
use super::{npy, npz};
use crosscap_core::CurveEdge;

/// What is found in an archive that holds no mesh, as [`super::FileError::Content`] says it.
pub const NO_TRIANGLES: &str = "no array triangles";

fn table<A: npy::Stored>(columns: usize, numbers: &[A]) -> Vec<u8> {
    npy::bytes(&[numbers.len() / columns, columns], numbers)
}

/// The bytes of the archive.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mesh = sheet.mesh;
    let flat = |edges: &[&CurveEdge]| -> Vec<i64> {
        edges.iter().flat_map(|e| e.ends.map(i64::from)).collect()
    };
    let cells = |edges: &[&CurveEdge]| -> Vec<u8> {
        let cells: Vec<i64> = edges.iter().map(|e| e.cells.into()).collect();
        npy::bytes(&[cells.len()], &cells)
    };
    let curves = |wanted: fn(u8) -> bool| -> Vec<&CurveEdge> {
        mesh.complex
            .curve_edges
            .iter()
            .filter(|e| wanted(e.cells))
            .collect()
    };
    let triangles: Vec<i64> = sheet
        .triangles
        .iter()
        .flatten()
        .map(|&v| v.into())
        .collect();
    let (singular, boundary, other) = (
        curves(|cells| cells >= 3),
        curves(|cells| cells == 1),
        curves(|cells| cells == 0 || cells == 2),
    );
    let mut arrays = vec![
        (
            "vertices",
            table(mesh.vertices.dimension(), mesh.vertices.coordinates()),
        ),
        ("triangles", table(3, &triangles)),
        ("singular_edges", table(2, &flat(&singular))),
        ("singular_cells", cells(&singular)),
        ("boundary_edges", table(2, &flat(&boundary))),
    ];
    if !other.is_empty() {
        arrays.push(("curve_edges", table(2, &flat(&other))));
        arrays.push(("curve_cells", cells(&other)));
    }
    arrays.push((
        "point_index",
        npy::bytes(&[mesh.point_index.len()], &mesh.point_index),
    ));
    if let Some(pieces) = sheet.pieces {
        arrays.push(("pieces", npy::bytes(&[pieces.len()], pieces)));
    }
    if sheet.given {
        arrays.push(("places", table(3, sheet.places.as_flattened())));
    }
    if !sheet.metadata.is_null() {
        let json = sheet.metadata.to_string().into_bytes();
        arrays.push(("metadata", npy::bytes(&[json.len()], &json)));
    }
    npz::bytes(&arrays)
}

/// Reads the archive. Only `vertices` and `triangles` must be there.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    let mut archive = Archive::open(bytes)?;
    let triangles = archive
        .integers("triangles", Some(3))?
        .ok_or_else(|| Flaw::new(NO_TRIANGLES, "one of shape [any, 3]"))?;
    let vertices = archive.array("vertices")?;
    let (_, dimension) = vertices.rows_columns().map_err(|f| f.within("vertices"))?;
    let mut curves: Option<Vec<RawCurve>> = None;
    for (edges, cells, fixed) in [
        ("singular_edges", Some("singular_cells"), None),
        ("boundary_edges", None, Some(1)),
        ("curve_edges", Some("curve_cells"), None),
    ] {
        let Some(ends) = archive.integers(edges, Some(2))? else {
            continue;
        };
        let ends = ends.as_chunks::<2>().0;
        let cells = match cells {
            Some(name) => archive.integers(name, None)?,
            None => None,
        };
        if let Some(cells) = &cells
            && cells.len() != ends.len()
        {
            return Err(Flaw::new(
                format!("{} counts of cells", cells.len()),
                format!("{}, one an edge", ends.len()),
            )
            .within(edges));
        }
        let curves = curves.get_or_insert_default();
        for (at, &ends) in ends.iter().enumerate() {
            curves.push((ends, cells.as_ref().map(|c| c[at]).or(fixed)));
        }
    }
    let metadata = match archive.integers("metadata", None)? {
        Some(json) => {
            let json: Vec<u8> = json.iter().map(|&b| b as u8).collect();
            serde_json::from_slice(&json).map_err(|e| {
                Flaw::new(format!("bad JSON ({e})"), "a JSON text").within("metadata")
            })?
        }
        None => serde_json::Value::Null,
    };
    Ok(Parts {
        dimension,
        coordinates: vertices.numbers.into_f64(),
        triangles: triangles.as_chunks::<3>().0.to_vec(),
        curves,
        point_index: archive.integers("point_index", None)?,
        pieces: archive.integers("pieces", None)?,
        metadata,
    })
}
