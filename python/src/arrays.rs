//! Arrays of NumPy from and to the types of Crosscap.

use crate::refusal::bad_value;
use crosscap_core::{Complex, CurveEdge, DimensionEstimate, Error, Mesh, PointCloud};
use numpy::PyUntypedArrayMethods;
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The rows of an array as points.
pub fn cloud(points: &PyReadonlyArray2<'_, f64>) -> PyResult<PointCloud<f64>> {
    let width = points.shape()[1];
    PointCloud::new(width, points.as_slice()?.to_vec()).map_err(|error| bad_value(&error))
}

/// An array with rows of `width` numbers; takes the memory over.
pub fn rows<T: Element>(
    py: Python<'_>,
    width: usize,
    flat: Vec<T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = flat.len() / width.max(1);
    PyArray1::from_vec(py, flat).reshape([count, width])
}

/// Points as an array.
pub fn of_cloud<'py>(
    py: Python<'py>,
    cloud: &PointCloud<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    rows(py, cloud.dimension(), cloud.coordinates().to_vec())
}

/// The arrays of a mesh, as Python hands them over.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct MeshArrays<'py> {
    vertices: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
    curve_edges: PyReadonlyArray2<'py, i64>,
    curve_cells: PyReadonlyArray1<'py, i64>,
    point_index: PyReadonlyArray1<'py, i64>,
}

impl MeshArrays<'_> {
    /// The mesh.
    pub fn mesh(&self) -> PyResult<Mesh> {
        let vertices = cloud(&self.vertices)?;
        let triangles = tuples::<3>(&self.triangles)?;
        let edges = curve_edges(&self.curve_edges, &self.curve_cells)?;
        let point_index = self.point_index.as_slice()?.to_vec();
        let mesh = Complex::new(vertices.len(), triangles, edges)
            .and_then(|complex| Mesh::new(complex, vertices, point_index));
        mesh.map_err(|error| bad_value(&error))
    }
}

/// Rows of `K` vertices.
pub fn tuples<const K: usize>(array: &PyReadonlyArray2<'_, i64>) -> PyResult<Vec<[u32; K]>> {
    let flat: Result<Vec<u32>, _> = array.as_slice()?.iter().map(|&v| v.try_into()).collect();
    let flat = flat.map_err(|_| PyValueError::new_err("an index of a vertex is negative"))?;
    if array.shape()[1] != K {
        let found = array.shape()[1];
        let wrong = format!("found rows of {found} indices, expected {K}");
        return Err(PyValueError::new_err(wrong));
    }
    Ok(flat.as_chunks().0.to_vec())
}

fn curve_edges(
    edges: &PyReadonlyArray2<'_, i64>,
    cells: &PyReadonlyArray1<'_, i64>,
) -> PyResult<Vec<CurveEdge>> {
    let edges = tuples::<2>(edges)?;
    let cells = cells.as_slice()?;
    if cells.len() != edges.len() {
        return Err(bad_value(&Error::Shape {
            found: format!("{} numbers of cells", cells.len()),
            expected: format!("{}, one for each curve edge", edges.len()),
        }));
    }
    let edge = |(&[a, b], &cells): (&[u32; 2], &i64)| -> PyResult<CurveEdge> {
        let cells = u8::try_from(cells)
            .map_err(|_| PyValueError::new_err("a number of cells is not in 0 to 255"))?;
        Ok(CurveEdge::new(a, b, cells))
    };
    edges.iter().zip(cells).map(edge).collect()
}

/// The edges with another number of triangles than two.
pub fn deduced(triangles: &[[u32; 3]]) -> Vec<CurveEdge> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [a, c]];
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(sides).collect();
    edges.iter_mut().for_each(|edge| edge.sort_unstable());
    edges.sort_unstable();
    let alike = edges.chunk_by(|a, b| a == b).filter(|same| same.len() != 2);
    alike
        .map(|same| {
            let cells = u8::try_from(same.len()).unwrap_or(u8::MAX);
            CurveEdge::new(same[0][0], same[0][1], cells)
        })
        .collect()
}

/// Curve edges and how many triangles meet in each.
pub type Curves<'py> = (Bound<'py, PyArray2<i64>>, Bound<'py, PyArray1<i64>>);

/// Curve edges, for Python.
pub fn of_curves<'py>(py: Python<'py>, edges: &[CurveEdge]) -> PyResult<Curves<'py>> {
    let ends = edges.iter().flat_map(|edge| edge.ends);
    let cells = edges.iter().map(|edge| edge.cells.into()).collect();
    Ok((
        rows(py, 2, ends.map(i64::from).collect())?,
        PyArray1::from_vec(py, cells),
    ))
}

/// The arrays of a mesh, for Python.
pub fn of_mesh<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyDict>> {
    let corners = mesh.complex.triangles.iter().flatten();
    let arrays = PyDict::new(py);
    arrays.set_item("vertices", of_cloud(py, &mesh.vertices)?)?;
    arrays.set_item(
        "triangles",
        rows(py, 3, corners.map(|&v| i64::from(v)).collect())?,
    )?;
    let (edges, cells) = of_curves(py, &mesh.complex.curve_edges)?;
    arrays.set_item("curve_edges", edges)?;
    arrays.set_item("curve_cells", cells)?;
    let point_index = mesh.point_index.clone();
    arrays.set_item("point_index", PyArray1::from_vec(py, point_index))?;
    Ok(arrays)
}

/// Dimension, value before rounding and confidence at every point; -1 and NaN where there are none.
pub fn of_estimates<'py>(
    py: Python<'py>,
    found: &[Option<DimensionEstimate>],
) -> PyResult<Bound<'py, PyDict>> {
    let whole = found
        .iter()
        .map(|e| e.as_ref().map_or(-1, |e| e.dimension as i64));
    let value = found
        .iter()
        .map(|e| e.as_ref().map_or(f64::NAN, |e| e.value));
    let sure = found
        .iter()
        .map(|e| e.as_ref().map_or(f64::NAN, |e| e.confidence));
    let all = PyDict::new(py);
    all.set_item("dimension", PyArray1::<i64>::from_vec(py, whole.collect()))?;
    all.set_item("value", PyArray1::<f64>::from_vec(py, value.collect()))?;
    all.set_item("confidence", PyArray1::<f64>::from_vec(py, sure.collect()))?;
    Ok(all)
}
