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
    Answer, BehindQuestion, CellQuestion, CloudRow, Curves, Gathered, NearCurves, Question, Tiles,
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
    /// What is known of curves, where they were looked for.
    curves: Option<&'t Curves<'t>>,
    /// The landmarks that are there from the beginning, those on curves first, where they are in the cloud.
    first: Gathered,
    /// All rows that were landmarks so far, in order.
    seen: RefCell<Gathered>,
}

impl<'t> Tiled<'t> {
    /// Makes meshes on the landmarks that are there `first`, those on the `curves` before all others.
    pub(super) fn new(
        parts: &'t Parts,
        tiles: &'t dyn Tiles,
        chart: &'t dyn LocalChart,
        curves: Option<&'t Curves<'t>>,
        first: Gathered,
    ) -> Self {
        Self {
            seen: RefCell::new(first.sorted()),
            first,
            curves,
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
        let row = CloudRow::new(row.index());
        if let Some(moved) = self.moved(row) {
            return out.extend_from_slice(moved);
        }
        let seen = self.seen.borrow();
        // Whoever asks got the row from a waist.
        if let Some(at) = seen.find(row) {
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
        let mut near = self.near_curves(&landmarks);
        let mut neighborhoods = self.far_from_curves(&landmarks, &mut near)?;
        let of_curves = match self.curves {
            Some(curves) => curves.neighborhoods(landmarks.rows(), &near)?,
            None => NearCurves::default(),
        };
        neighborhoods.extend(of_curves.in_cells);
        neighborhoods.sort_by_key(CellNeighborhood::center);
        neighborhoods.extend(of_curves.at_curves);
        let place = |k: Landmark| {
            let moved = self.moved(landmarks.rows()[k.index()]);
            moved.unwrap_or(landmarks.place(k.index()))
        };
        let distances = SparseDistances::within(landmarks.len(), &neighborhoods, |a, b| {
            squared_distance(place(a), place(b)).sqrt()
        })?;
        let strata = match self.curves {
            Some(curves) => curves.dimensions(landmarks.len()),
            None => Table::filled(landmarks.len(), 2),
        };
        let chains = self.curves.map_or(&[][..], Curves::chains).to_vec();
        let waist = StratifiedLandmarks::new(strata, chains, neighborhoods, distances)?;
        let rows = landmarks.rows().iter().map(|row| Row::new(row.index()));
        let mut found = Stratification::new(waist, rows.collect());
        found.counts.cut_edges = of_curves.cut_edges;
        found.points = self.curves.map_or(Vec::new(), Curves::points);
        found.models = self.curves.map_or(&[][..], Curves::models).to_vec();
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
        let middles = self.part(&part, waist)?.with(self, |r| r.middles(complex));
        part.extend(&self.tiles.nearest(&middles)?);
        let part = part.sorted();
        let near = self.part(&part, waist)?;
        let stray = self.parts.tuning.refinement.stray * self.parts.parameters.dl;
        let astray = middles.chunks_exact(self.tiles.dimension());
        let astray: Vec<f64> = (astray.filter(|middle| !near.oracle.is_near(middle, stray)))
            .flatten()
            .copied()
            .collect();
        if astray.is_empty() {
            return Ok(Vec::new());
        }
        let radius = near.with(self, |r| r.look()) * (1.0 + ROUNDING);
        let around = Question::Around {
            places: astray,
            radius,
        };
        let mut all = part.clone();
        all.extend(&self.tiles.gather(&around)?);
        let all = all.sorted();
        let added = self
            .part(&all, waist)?
            .with(self, |r| r.rows_where_astray(complex));
        Ok(in_cloud(&all, added))
    }

    fn rows_left_behind(&self, made: &Triangulated, mesh: &Mesh) -> Result<Vec<Row>, Error> {
        let tuning = &self.parts.tuning.refinement;
        let question = Question::Behind(BehindQuestion {
            vertices: mesh.vertices.coordinates().to_vec(),
            triangles: mesh.complex.triangles.clone(),
            curve_edges: mesh.complex.curve_edges.clone(),
            far: tuning.behind * self.parts.parameters.dl * (1.0 - ROUNDING),
            company: tuning.company,
        });
        let mut all = self.landmarks_of(&made.waist);
        all.extend(&self.tiles.gather(&question)?);
        let all = all.sorted();
        let part = self.part(&all, &made.waist)?;
        let heights = distances_to_mesh(mesh, &part.cloud);
        let added = part.with(self, |r| r.rows_left_behind(&heights));
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
            closed: parts.is_closed(),
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
    /// Where a row of the cloud was moved to, if anything is known of it.
    fn moved(&self, row: CloudRow) -> Option<&[f64]> {
        self.curves?.place(row)
    }

    fn is_regular(&self, row: CloudRow) -> bool {
        self.curves.is_none_or(|curves| curves.is_regular(row))
    }

    /// Which landmarks curves are near: those on curves, and others whose charts they may reach.
    fn near_curves(&self, landmarks: &Gathered) -> Table<Landmark, bool> {
        let Some(curves) = self.curves else {
            return Table::filled(landmarks.len(), false);
        };
        let on_curves = curves.landmarks().len();
        let near = landmarks.each().enumerate();
        near.map(|(k, (_, place))| k < on_curves || curves.are_near(place, None))
            .collect()
    }

    /// The neighborhoods of landmarks that no curves are near, from their tiles; where a chart had to be so wide that one is, the landmark counts
    /// as `near`, too.
    fn far_from_curves(
        &self,
        landmarks: &Gathered,
        near: &mut Table<Landmark, bool>,
    ) -> Result<Vec<CellNeighborhood>, Error> {
        let parameters = &self.parts.parameters;
        let question = Question::Cells(CellQuestion {
            landmarks: landmarks.rows().to_vec(),
            elsewhere: near.ids().filter(|&k| near[k]).collect(),
            dl: parameters.dl,
            tri_eps: parameters.chart_radius(),
            tuning: self.parts.tuning.cells.clone(),
        });
        let mut found = Vec::new();
        for answer in self.tiles.ask(&question)? {
            let Answer::Cells(own, radii) = answer else {
                continue;
            };
            for (one, radius) in own.into_iter().zip(radii) {
                let place = landmarks.place(one.center().index());
                let curves = self.curves;
                if curves.is_some_and(|curves| curves.are_near(place, Some(radius))) {
                    near[one.center()] = true;
                } else {
                    found.push(one);
                }
            }
        }
        Ok(found)
    }

    /// The landmarks that are there first, and those of `extra` that were not, in their order.
    fn landmarks(&self, extra: &[Row]) -> Result<Gathered, Error> {
        let mut landmarks = self.first.clone();
        let first = self.first.sorted();
        let extra = extra.iter().map(|row| CloudRow::new(row.index()));
        let extra: Vec<CloudRow> = extra
            .filter(|&row| first.find(row).is_none() && self.is_regular(row))
            .collect();
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

    /// The points that the landmarks of a waist stand for, in the order of their rows.
    fn landmarks_of(&self, waist: &Stratification<f64>) -> Gathered {
        let seen = self.seen.borrow();
        let mut all = Gathered::new(self.tiles.dimension());
        let rows = waist.rows.iter().map(|row| CloudRow::new(row.index()));
        for at in rows.filter_map(|row| seen.find(row)) {
            all.push(seen.rows()[at], seen.place(at));
        }
        all.sorted()
    }

    /// A part of the cloud, in the order of its rows, the landmarks of a waist among them.
    fn part(&self, points: &Gathered, waist: &Stratification<f64>) -> Result<Part, Error> {
        let cloud = points.cloud()?;
        let mut places = cloud.clone();
        for (at, &row) in points.rows().iter().enumerate() {
            if let Some(moved) = self.moved(row) {
                places.set_point(at, moved);
            }
        }
        let rows = waist.rows.iter().filter_map(|row| {
            let at = points.find(CloudRow::new(row.index()));
            at.map(Row::new)
        });
        let regular = points.rows().iter().map(|&row| self.is_regular(row));
        Ok(Part {
            oracle: EuclideanOracle::new(cloud.clone())?,
            rows: rows.collect(),
            regular: regular.collect(),
            cloud,
            places,
        })
    }
}

/// A part of the cloud that says as much about some question as the whole. In it a [`Row`] is a row of the part.
struct Part {
    cloud: PointCloud<f64>,
    /// Where the points were moved to.
    places: PointCloud<f64>,
    oracle: EuclideanOracle<f64>,
    /// Rows of the landmarks.
    rows: Table<Landmark, Row>,
    /// Which rows are on no curve.
    regular: Table<Row, bool>,
}

impl Part {
    /// What a refinement beside these points says.
    fn with<T>(&self, tiled: &Tiled<'_>, ask: impl FnOnce(&Refinement<'_, f64>) -> T) -> T {
        ask(&Refinement {
            near: &self.oracle,
            places: Some(&self.places),
            may_add: &|row| self.regular[row],
            rows: &self.rows,
            dl: tiled.parts.parameters.dl,
            scale: None,
            tuning: &tiled.parts.tuning.refinement,
        })
    }
}

/// Rows of the cloud that rows of a part are.
fn in_cloud(part: &Gathered, rows: Vec<Row>) -> Vec<Row> {
    let rows = rows.into_iter();
    rows.map(|row| Row::new(part.rows()[row.index()].index()))
        .collect()
}
