//! Meshes: homology, certificate, layouts, files, pages.

use crate::arrays::{Curves, MeshArrays, cloud, deduced, of_cloud, of_curves, of_mesh, tuples};
use crate::refusal::{bad_value, violation};
use crosscap::auto::{Measured, Measuring};
use crosscap::command::convert::places_for;
use crosscap::command::findings::Findings;
use crosscap::command::origin::{Asked, Origin};
use crosscap::command::{overlay, picture};
use crosscap_algorithms::certificate::{CertificateOptions, certify};
use crosscap_algorithms::homology::homology as homology_of;
use crosscap_algorithms::isomap::{IsomapOptions, isomap_places};
use crosscap_algorithms::pieces::pieces;
use crosscap_backends::files::{self, MeshExtras};
use crosscap_backends::picture as page_of;
use crosscap_core::{Error, Mesh, PointCloud};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The edges with another number of triangles than two, and these numbers.
#[pyfunction]
pub fn curves<'py>(
    py: Python<'py>,
    triangles: PyReadonlyArray2<'py, i64>,
) -> PyResult<Curves<'py>> {
    of_curves(py, &deduced(&tuples(&triangles)?))
}

/// Betti numbers over Q and Z/2, torsion, Euler characteristic: as JSON.
#[pyfunction]
pub fn homology(py: Python<'_>, mesh: MeshArrays<'_>) -> PyResult<String> {
    let mesh = mesh.mesh()?;
    let found = py.detach(|| homology_of(&mesh.complex));
    let found = found.map_err(|error| bad_value(&error))?;
    Ok(json!(found).to_string())
}

/// What whoever asks about a mesh knows, as Python hands it over: a dictionary.
fn asked(known: &Bound<'_, PyDict>) -> PyResult<Asked> {
    let known = known.as_any();
    Ok(Asked {
        dl: known.get_item("dl")?.extract()?,
        closed: known.get_item("closed")?.extract()?,
        prepare: known.get_item("prepare")?.extract()?,
        least_hole: known.get_item("least_hole")?.extract()?,
    })
}

/// What is known about a mesh, as JSON: what `crosscap check --json` prints, and the reasons. `metadata` is JSON that tells how
/// it was made.
#[pyfunction]
pub fn check(
    py: Python<'_>,
    mesh: MeshArrays<'_>,
    metadata: &str,
    points: Option<PyReadonlyArray2<'_, f64>>,
    known: &Bound<'_, PyDict>,
) -> PyResult<String> {
    let mesh = mesh.mesh()?;
    let metadata: Value = serde_json::from_str(metadata).map_err(|error| bad_value(&error))?;
    let origin = Origin::of(&metadata).map_err(|why| bad_value(&why))?;
    let points = points.as_ref().map(cloud).transpose()?;
    let asked = asked(known)?;
    let (options, measuring) = (origin.certificate(&asked), origin.measuring(&asked));
    let found = py.detach(|| checked(&mesh, points.as_ref(), &options, &measuring));
    let found = found.map_err(|error| bad_value(&error))?;
    Ok(found.to_string())
}

fn checked(
    mesh: &Mesh,
    points: Option<&PointCloud<f64>>,
    options: &CertificateOptions<'_>,
    measuring: &Measuring,
) -> Result<Value, Error> {
    let homology = homology_of(&mesh.complex)?;
    let (certificate, creases, preparation) = match points {
        None => (certify(mesh, options), None, None),
        Some(points) => {
            let found = Measured::of(mesh, points, options, measuring)?;
            (found.certificate, Some(found.creases), found.preparation)
        }
    };
    let pieces = pieces(mesh);
    let findings = Findings {
        mesh,
        homology: &homology,
        certificate: &certificate,
        pieces: &pieces,
        creases: creases.as_ref(),
        special_points: options.special_points,
    };
    let mut known = Value::Object(findings.json(certificate.verdict().is_verified()));
    if let Some(preparation) = preparation {
        known["preparation"] = json!(preparation);
    }
    known["reasons"] = certificate.violations().map(violation).collect();
    Ok(known)
}

/// Places of the vertices by Isomap over the mesh, the residual variance, the number of components.
#[pyfunction]
pub fn isomap<'py>(
    py: Python<'py>,
    mesh: MeshArrays<'py>,
    dimension: usize,
    landmarks: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let mesh = mesh.mesh()?;
    let found = py.detach(|| isomap_places(&mesh, dimension, &IsomapOptions { landmarks }));
    let found = found.map_err(|error| bad_value(&error))?;
    let all = PyDict::new(py);
    all.set_item("places", of_cloud(py, &found.places)?)?;
    all.set_item("residual_variance", found.residual_variance)?;
    all.set_item("components", found.components)?;
    Ok(all)
}

/// The page on which a mesh is turned, HTML.
#[pyfunction]
pub fn page(
    py: Python<'_>,
    mesh: MeshArrays<'_>,
    title: String,
    verdict: String,
    points: Option<PyReadonlyArray2<'_, f64>>,
) -> PyResult<String> {
    let mesh = mesh.mesh()?;
    let points = points.as_ref().map(cloud).transpose()?;
    py.detach(|| -> Result<String, Error> {
        let homology = homology_of(&mesh.complex)?;
        let certificate = certify(&mesh, &CertificateOptions::default());
        let pieces = pieces(&mesh);
        let findings = Findings {
            mesh: &mesh,
            homology: &homology,
            certificate: &certificate,
            pieces: &pieces,
            creases: None,
            special_points: &[],
        };
        let mut scene = picture::scene(&title, &findings, &verdict, None)?;
        if let Some(points) = &points {
            overlay::add_points(&mut scene, &mesh, points)?;
        }
        page_of::page(&scene)
    })
    .map_err(|error| bad_value(&error))
}

/// Reads a mesh from a file: its arrays, with `pieces` and `metadata` (JSON) where the file has them.
#[pyfunction]
pub fn read_mesh(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let file = py.detach(|| files::read_mesh(path));
    let file = file.map_err(|error| bad_value(&error))?;
    let all = of_mesh(py, &file.mesh)?;
    all.set_item("triangle_piece", file.extras.pieces)?;
    all.set_item("metadata", file.extras.metadata.to_string())?;
    Ok(all)
}

/// Writes a mesh; `metadata` is JSON.
#[pyfunction]
pub fn write_mesh(
    py: Python<'_>,
    path: PathBuf,
    mesh: MeshArrays<'_>,
    triangle_piece: Option<Vec<i64>>,
    metadata: &str,
) -> PyResult<()> {
    let mesh = mesh.mesh()?;
    let extras = MeshExtras {
        metadata: serde_json::from_str(metadata).map_err(|error| bad_value(&error))?,
        pieces: triangle_piece,
    };
    py.detach(|| -> Result<(), String> {
        let places = places_for(&path, &mesh, None).map_err(|e| e.to_string())?;
        let written = files::write_mesh(&path, &mesh, &extras, places.as_ref());
        written.map_err(|e| e.to_string())
    })
    .map_err(|error| bad_value(&error))
}
