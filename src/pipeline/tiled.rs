//! Meshes of a cloud that nobody holds as a whole: its tiles are asked.

use super::Parts;
use super::making::{Maker, Triangulated};
use super::mesh::Located;
use super::rows::InputRow;
use crosscap_algorithms::certificate::{
    Certificate, CertificateOptions, Excerpt, Place, SpecialPoint, certify, distances_to_mesh,
    evidence_places, evidence_rows,
};
use crosscap_algorithms::stratify::{Refinement, Stratification};
use crosscap_algorithms::tiles::{
    Answer, BehindQuestion, CellQuestion, CloudRow, Gathered, Question, Tiles,
};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{
    CellNeighborhood, Complex, Error, Landmark, LocalChart, Mesh, PointCloud, Row, SparseDistances,
    StratifiedLandmarks, Table, squared_distance,
};
use std::cell::RefCell;

/// Rounding of distances, so that what is nearly far counts as far.
const ROUNDING: f64 = 1e-9;

/// Makes meshes of a cloud in tiles. A [`Row`] is a row of the whole cloud.
pub(super) struct Tiled<'t> {
    parts: &'t Parts,
    tiles: &'t dyn Tiles,
    chart: &'t dyn LocalChart,
    /// The landmarks that were chosen, in their order.
    chosen: Gathered,
    /// All rows that were landmarks so far, in order.
    seen: RefCell<Gathered>,
}

impl<'t> Tiled<'t> {
    /// Makes meshes on the landmarks that were `chosen`, in their order.
    pub(super) fn new(
        parts: &'t Parts,
        tiles: &'t dyn Tiles,
        chart: &'t dyn LocalChart,
        chosen: Gathered,
    ) -> Self {
        Self {
            seen: RefCell::new(chosen.sorted()),
            chosen,
            parts,
            tiles,
            chart,
        }
    }
}

impl Located for Tiled<'_> {
    fn dimension(&self) -> usize {
        self.tiles.dimension()
    }

    fn add_place(&self, row: Row, out: &mut Vec<f64>) {
        let seen = self.seen.borrow();
        // Whoever asks got the row from a waist.
        if let Some(at) = seen.find(CloudRow::new(row.index())) {
            out.extend_from_slice(seen.place(at));
        }
    }

    fn input(&self, row: Row) -> InputRow {
        InputRow::new(self.tiles.input_row(CloudRow::new(row.index())))
    }
}

impl Maker for Tiled<'_> {
    fn parts(&self) -> &Parts {
        self.parts
    }

    fn chart(&self) -> &dyn LocalChart {
        self.chart
    }

    fn rows(&self) -> &dyn Located {
        self
    }

    fn waist(&self, extra: &[Row]) -> Result<Stratification<f64>, Error> {
        let landmarks = self.landmarks(extra)?;
        let parameters = &self.parts.parameters;
        let question = Question::Cells(CellQuestion {
            landmarks: landmarks.rows().to_vec(),
            dl: parameters.dl,
            tri_eps: parameters.chart_radius(),
            tuning: self.parts.tuning.cells.clone(),
        });
        let mut neighborhoods = Vec::new();
        for answer in self.tiles.ask(&question)? {
            if let Answer::Cells(own) = answer {
                neighborhoods.extend(own);
            }
        }
        neighborhoods.sort_by_key(CellNeighborhood::center);
        let distances = SparseDistances::within(landmarks.len(), &neighborhoods, |a, b| {
            squared_distance(landmarks.place(a.index()), landmarks.place(b.index())).sqrt()
        })?;
        let strata = Table::filled(landmarks.len(), 2);
        let waist = StratifiedLandmarks::new(strata, Vec::new(), neighborhoods, distances)?;
        let rows = landmarks.rows().iter().map(|row| Row::new(row.index()));
        let found = Stratification::new(waist, rows.collect());
        found.check("tiles", self.tiles.points())?;
        Ok(found)
    }

    fn rows_where_astray(
        &self,
        waist: &Stratification<f64>,
        complex: &Complex,
    ) -> Result<Vec<Row>, Error> {
        if waist.rows.len() == self.tiles.points() {
            return Ok(Vec::new());
        }
        // Middles alone depend on landmarks alone.
        let mut part = self.landmarks_of(waist);
        let middles = Part::new(&part, waist)?.with(self.parts, |r| r.middles(complex));
        part.extend(&self.tiles.nearest(&middles)?);
        let part = part.sorted();
        let near = Part::new(&part, waist)?;
        let stray = self.parts.tuning.refinement.stray * self.parts.parameters.dl;
        let astray = middles.chunks_exact(self.tiles.dimension());
        let astray: Vec<f64> = (astray.filter(|middle| !near.oracle.is_near(middle, stray)))
            .flatten()
            .copied()
            .collect();
        if astray.is_empty() {
            return Ok(Vec::new());
        }
        let radius = near.with(self.parts, |r| r.look()) * (1.0 + ROUNDING);
        let around = Question::Around {
            places: astray,
            radius,
        };
        let mut all = part.clone();
        all.extend(&self.tiles.gather(&around)?);
        let all = all.sorted();
        let added = Part::new(&all, waist)?.with(self.parts, |r| r.rows_where_astray(complex));
        Ok(in_cloud(&all, added))
    }

    fn rows_left_behind(&self, made: &Triangulated, mesh: &Mesh) -> Result<Vec<Row>, Error> {
        let tuning = &self.parts.tuning.refinement;
        let question = Question::Behind(BehindQuestion {
            vertices: mesh.vertices.coordinates().to_vec(),
            triangles: mesh.complex.triangles.clone(),
            far: tuning.behind * self.parts.parameters.dl * (1.0 - ROUNDING),
            company: tuning.company,
        });
        let mut all = self.landmarks_of(&made.waist);
        all.extend(&self.tiles.gather(&question)?);
        let all = all.sorted();
        let part = Part::new(&all, &made.waist)?;
        let heights = distances_to_mesh(mesh, &part.cloud);
        let added = part.with(self.parts, |r| r.rows_left_behind(&heights));
        Ok(in_cloud(&all, added))
    }

    fn certify(
        &self,
        mesh: &Mesh,
        special_points: &[SpecialPoint],
        made: &Triangulated,
    ) -> Result<Certificate, Error> {
        let (parts, points) = (self.parts, self.tiles.points());
        let dl = parts.parameters.dl;
        let options = CertificateOptions {
            landmark_separation: Some(dl),
            special_points,
            closed: true,
            limits: parts.limits(),
            ..CertificateOptions::default()
        };
        let picked: Vec<CloudRow> = (evidence_rows(points, &options.limits).into_iter())
            .map(CloudRow::new)
            .collect();
        let all = {
            let mut all = self.landmarks_of(&made.waist);
            all.extend(&self.tiles.rows(picked.clone())?);
            let places = evidence_places(mesh, dl, &options);
            all.extend(&self.tiles.nearest(&places)?);
            all.sorted()
        };
        let cloud = all.cloud()?;
        let looked_at: Vec<usize> = picked.iter().filter_map(|&row| all.find(row)).collect();
        let dropped = made.triangulation.dropped.iter();
        let dropped = dropped.map(|&k| CloudRow::new(made.waist.rows[k].index()));
        let dropped: Vec<usize> = dropped.filter_map(|row| all.find(row)).collect();
        let mut certificate = certify(
            mesh,
            &CertificateOptions {
                points: Some(&cloud),
                excerpt: Some(Excerpt {
                    of: points,
                    looked_at: &looked_at,
                }),
                unused_landmarks: &dropped,
                ..options
            },
        );
        let cover = certificate.cover.iter_mut();
        let violations = cover.flat_map(|report| &mut report.violations);
        for place in violations.flat_map(|violation| &mut violation.places) {
            if let Place::Point(row) = place {
                *row = self.tiles.input_row(all.rows()[*row]);
            }
        }
        Ok(certificate)
    }
}

impl Tiled<'_> {
    /// The landmarks that were chosen, and those of `extra` that were not, in their order.
    fn landmarks(&self, extra: &[Row]) -> Result<Gathered, Error> {
        let mut landmarks = self.chosen.clone();
        let chosen = self.chosen.sorted();
        let extra = extra.iter().map(|row| CloudRow::new(row.index()));
        let extra: Vec<CloudRow> = extra.filter(|&row| chosen.find(row).is_none()).collect();
        if extra.is_empty() {
            return Ok(landmarks);
        }
        let mut sorted = extra.clone();
        sorted.sort_unstable();
        let found = self.tiles.rows(sorted)?;
        for row in extra {
            if let Some(at) = found.find(row) {
                landmarks.push(row, found.place(at));
            }
        }
        self.seen.borrow_mut().extend(&found);
        let seen = self.seen.borrow().sorted();
        self.seen.replace(seen);
        Ok(landmarks)
    }

    /// The landmarks of a waist, in the order of their rows.
    fn landmarks_of(&self, waist: &Stratification<f64>) -> Gathered {
        let mut all = Gathered::new(self.tiles.dimension());
        let mut place = Vec::new();
        for &row in &waist.rows {
            place.clear();
            self.add_place(row, &mut place);
            all.push(CloudRow::new(row.index()), &place);
        }
        all.sorted()
    }
}

/// A part of the cloud that says as much about some question as the whole. In it a [`Row`] is a row of the part.
struct Part {
    cloud: PointCloud<f64>,
    oracle: EuclideanOracle<f64>,
    rows: Table<Landmark, Row>,
}

impl Part {
    /// Points in the order of their rows, the landmarks of a waist among them.
    fn new(points: &Gathered, waist: &Stratification<f64>) -> Result<Self, Error> {
        let cloud = points.cloud()?;
        let rows = waist.rows.iter().filter_map(|row| {
            let at = points.find(CloudRow::new(row.index()));
            at.map(Row::new)
        });
        Ok(Self {
            oracle: EuclideanOracle::new(cloud.clone())?,
            rows: rows.collect(),
            cloud,
        })
    }

    /// What a refinement beside these points says.
    fn with<T>(&self, parts: &Parts, ask: impl FnOnce(&Refinement<'_, f64>) -> T) -> T {
        ask(&Refinement {
            near: &self.oracle,
            places: Some(&self.cloud),
            may_add: &|_| true,
            rows: &self.rows,
            dl: parts.parameters.dl,
            scale: None,
            tuning: &parts.tuning.refinement,
        })
    }
}

/// Rows of the cloud that rows of a part are.
fn in_cloud(part: &Gathered, rows: Vec<Row>) -> Vec<Row> {
    let rows = rows.into_iter();
    rows.map(|row| Row::new(part.rows()[row.index()].index()))
        .collect()
}
