//! From landmarks back to rows of the input: the mesh, its special points, what failed.

use super::rows::InputRow;
use crosscap_algorithms::certificate::SpecialPoint;
use crosscap_algorithms::stratify::Stratification;
use crosscap_core::{
    Complex, CurveEdge, Error, Landmark, Mesh, PointCloud, Row, Table, Triangulation,
};

/// What is known of the rows that landmarks stand for.
pub(super) trait Located {
    /// Number of coordinates.
    fn dimension(&self) -> usize;

    /// Adds the coordinates of where a row is drawn.
    fn add_place(&self, row: Row, out: &mut Vec<f64>);

    /// Its number in the input.
    fn input(&self, row: Row) -> InputRow;
}

/// All rows that are worked on.
pub(super) struct AllRows<'a> {
    /// Where they are drawn.
    pub(super) places: &'a PointCloud<f64>,
    /// Their numbers in the input.
    pub(super) kept: &'a Table<Row, InputRow>,
}

impl Located for AllRows<'_> {
    fn dimension(&self) -> usize {
        self.places.dimension()
    }

    fn add_place(&self, row: Row, out: &mut Vec<f64>) {
        out.extend_from_slice(self.places.point(row.index()));
    }

    fn input(&self, row: Row) -> InputRow {
        self.kept[row]
    }
}

/// The mesh of a triangulation: landmarks that were dropped leave no vertex.
pub(super) fn mesh_of(
    complex: &Complex,
    stratification: &Stratification<f64>,
    rows: &dyn Located,
) -> Result<Mesh, Error> {
    let mut used: Table<Landmark, bool> = Table::filled(complex.vertices, false);
    let corners = complex.triangles.iter().flatten();
    for &k in corners.chain(complex.curve_edges.iter().flat_map(|e| &e.ends)) {
        used[Landmark::from(k)] = true;
    }
    let kept: Vec<Landmark> = used.ids().filter(|&k| used[k]).collect();
    // Vertices of the mesh by landmark.
    let mut vertices: Table<Landmark, u32> = Table::filled(complex.vertices, 0);
    for (vertex, &k) in (0..).zip(&kept) {
        vertices[k] = vertex;
    }
    let vertex = |k: u32| vertices[Landmark::from(k)];
    let triangles = complex.triangles.iter().map(|t| t.map(vertex)).collect();
    let edges = complex.curve_edges.iter();
    let edges = edges.map(|e| CurveEdge::new(vertex(e.ends[0]), vertex(e.ends[1]), e.cells));
    let own: Vec<Row> = kept.iter().map(|&k| stratification.rows[k]).collect();
    let mut places = Vec::with_capacity(own.len() * rows.dimension());
    own.iter().for_each(|&row| rows.add_place(row, &mut places));
    Mesh::new(
        Complex::new(kept.len(), triangles, edges.collect())?,
        PointCloud::new(rows.dimension(), places)?,
        own.iter().map(|&row| rows.input(row).signed()).collect(),
    )
}

/// The vertices at points whose link the model knows.
pub(super) fn special_points(
    mesh: &Mesh,
    stratification: &Stratification<f64>,
    rows: &dyn Located,
) -> Vec<SpecialPoint> {
    (stratification.points.iter())
        .filter_map(|p| {
            let link = p.link.clone()?;
            let row = rows.input(stratification.rows[p.landmark]).signed();
            let vertex = mesh.point_index.iter().position(|&r| r == row)? as u32;
            Some(SpecialPoint { vertex, link })
        })
        .collect()
}

/// A broken law of a plug-in of the triangulation, with the row of the input instead of the landmark.
pub(super) fn at_input_row(
    error: Error,
    landmarks: &Table<Landmark, Row>,
    rows: &dyn Located,
) -> Error {
    match error {
        Error::Law {
            plugin,
            law,
            point,
            detail,
        } => Error::Law {
            plugin,
            law,
            point: landmarks
                .get(Landmark::new(point))
                .map_or(point, |&row| rows.input(row).index()),
            detail,
        },
        other => other,
    }
}

/// The stars that stayed open, as errors.
pub(super) fn failures(
    triangulation: &Triangulation,
    stratification: &Stratification<f64>,
    rows: &dyn Located,
) -> Vec<Error> {
    triangulation
        .incomplete
        .iter()
        .map(|open| {
            let landmark = open.landmark;
            let on_curve = stratification.waist.strata()[landmark] < 2;
            Error::Triangulation {
                reason: if on_curve {
                    "a cell at a curve could not be filled".into()
                } else {
                    "a star could not be closed".into()
                },
                landmark: landmark.index(),
                point: Some(rows.input(stratification.rows[landmark]).index()),
                parameter: if on_curve {
                    "ep, eps or dl"
                } else {
                    "dl or tri-eps"
                },
            }
        })
        .collect()
}
