//! From landmarks back to rows of the input: the mesh, its special points, what failed.

use crosscap_algorithms::certificate::SpecialPoint;
use crosscap_algorithms::stratify::Stratification;
use crosscap_core::{Complex, CurveEdge, Error, Mesh, PointCloud, Triangulation};

/// The mesh of a triangulation: landmarks that were dropped leave no vertex.
pub(super) fn mesh_of(
    complex: &Complex,
    stratification: &Stratification<f64>,
    places: &PointCloud<f64>,
    rows: &[usize],
) -> Result<Mesh, Error> {
    let mut used = vec![false; complex.vertices];
    for &v in complex
        .triangles
        .iter()
        .flatten()
        .chain(complex.curve_edges.iter().flat_map(|e| &e.ends))
    {
        used[v as usize] = true;
    }
    let kept: Vec<u32> = (0..complex.vertices as u32)
        .filter(|&v| used[v as usize])
        .collect();
    let mut name = vec![0u32; complex.vertices];
    for (k, &v) in kept.iter().enumerate() {
        name[v as usize] = k as u32;
    }
    let triangles = complex
        .triangles
        .iter()
        .map(|t| t.map(|v| name[v as usize]))
        .collect();
    let edges = complex
        .curve_edges
        .iter()
        .map(|e| CurveEdge::new(name[e.ends[0] as usize], name[e.ends[1] as usize], e.cells))
        .collect();
    let landmark_rows: Vec<usize> = kept
        .iter()
        .map(|&v| stratification.rows[v as usize])
        .collect();
    Mesh::new(
        Complex::new(kept.len(), triangles, edges)?,
        places.select(&landmark_rows),
        landmark_rows.iter().map(|&r| rows[r] as i64).collect(),
    )
}

/// The vertices at points whose link the model knows.
pub(super) fn special_points(
    mesh: &Mesh,
    stratification: &Stratification<f64>,
    rows: &[usize],
) -> Vec<SpecialPoint> {
    (stratification.points.iter())
        .filter_map(|p| {
            let link = p.link.clone()?;
            let row = rows[stratification.rows[p.landmark as usize]] as i64;
            let vertex = mesh.point_index.iter().position(|&r| r == row)? as u32;
            Some(SpecialPoint { vertex, link })
        })
        .collect()
}

/// A broken law of a plug-in of the triangulation, with the row of the input instead of the landmark.
pub(super) fn at_input_row(error: Error, landmarks: &[usize], rows: &[usize]) -> Error {
    match error {
        Error::Law {
            plugin,
            law,
            point,
            detail,
        } => Error::Law {
            plugin,
            law,
            point: landmarks.get(point).map_or(point, |&row| rows[row]),
            detail,
        },
        other => other,
    }
}

/// The stars that stayed open, as errors.
pub(super) fn failures(
    triangulation: &Triangulation,
    stratification: &Stratification<f64>,
    rows: &[usize],
) -> Vec<Error> {
    triangulation
        .incomplete
        .iter()
        .map(|open| {
            let landmark = open.landmark as usize;
            let on_curve = stratification.waist.strata[landmark] < 2;
            Error::Triangulation {
                reason: if on_curve {
                    "a cell at a curve could not be filled".into()
                } else {
                    "a star could not be closed".into()
                },
                landmark,
                point: Some(rows[stratification.rows[landmark]]),
                parameter: if on_curve {
                    "ep, eps or dl"
                } else {
                    "dl or tri-eps"
                },
            }
        })
        .collect()
}
