//! From waists to a mesh with a verdict, and again with more landmarks where that is what it lacks.

use super::mesh::{at_input_row, mesh_of, special_points};
use super::prepared::Prepared;
use super::progress::Progress;
use super::{Parts, Stage};
use crate::spaces::MetricName;
use crosscap_algorithms::certificate::{
    Certificate, CertificateOptions, SpecialPoint, ViolationKind, certify, certify_by_distances,
    distances_to_mesh,
};
use crosscap_algorithms::homology::{Homology, homology};
use crosscap_algorithms::pieces::{Pieces, PiecesError, pieces};
use crosscap_algorithms::stratify::{Refinement, Stratification, WaistProducer};
use crosscap_core::{Error, LocalChart, Mesh, PointCloud, Row, Triangulation};

/// What meshes of one cloud are made from.
pub(super) struct Making<'m> {
    pub(super) parts: &'m Parts,
    pub(super) prepared: &'m Prepared<'m>,
    pub(super) producer: &'m dyn WaistProducer<f64>,
    pub(super) chart: &'m dyn LocalChart,
    /// Where vertices are drawn: the places of the points, those on curves moved onto them.
    pub(super) places: &'m PointCloud<f64>,
}

/// A waist and what was made of it.
pub(super) struct Triangulated {
    pub(super) waist: Stratification<f64>,
    pub(super) triangulation: Triangulation,
    /// Rows of the landmarks that were added.
    pub(super) added: Vec<Row>,
}

/// A mesh and what is known of it.
pub(super) struct Judged {
    pub(super) mesh: Mesh,
    pub(super) special_points: Vec<SpecialPoint>,
    pub(super) homology: Homology,
    pub(super) pieces: Result<Pieces, PiecesError>,
    pub(super) certificate: Certificate,
}

impl Judged {
    /// How many places the verdict complains about.
    fn complaints(&self) -> usize {
        self.certificate.violations().map(|v| v.count).sum()
    }
}

impl Making<'_> {
    /// A mesh with its verdict. Where the verdict is that points are left behind, some of them become landmarks and the
    /// mesh is made again. Of all that are made that with the fewest places to complain about counts.
    ///
    /// # Errors
    /// Those of the waist and of the triangulator.
    pub(super) fn mesh(
        &self,
        progress: &mut Progress<'_>,
    ) -> Result<(Triangulated, Judged), Error> {
        let mut made = self.triangulated(Vec::new(), progress)?;
        let mut judged = self.judged(&made, progress)?;
        let mut behind = self.left_behind(&made, &judged);
        let mut added = made.added.clone();
        for _ in 0..self.parts.tuning.refinement.mends {
            if behind.is_empty() {
                break;
            }
            added.append(&mut behind);
            progress.enter(Stage::Landmarks);
            let again = self.triangulated(added, progress)?;
            let verdict = self.judged(&again, progress)?;
            behind = self.left_behind(&again, &verdict);
            added = again.added.clone();
            if verdict.complaints() < judged.complaints() {
                (made, judged) = (again, verdict);
            }
        }
        Ok((made, judged))
    }

    /// Triangulates a waist with the landmarks `extra`, and others with more of them where triangles stray from
    /// the points.
    fn triangulated(
        &self,
        mut extra: Vec<Row>,
        progress: &mut Progress<'_>,
    ) -> Result<Triangulated, Error> {
        let mut round = 0;
        loop {
            let waist = self.producer.waist(&extra)?;
            waist.check(self.parts.stratifier.name(), self.prepared.rows.cloud.len())?;
            progress.enter(Stage::Triangulation);
            let triangulation = (self.parts)
                .triangulated(&waist.waist, self.chart)
                .map_err(|error| at_input_row(error, &waist.rows, &self.prepared.rows.kept))?;
            let mut added = Vec::new();
            if round < self.parts.tuning.refinement.rounds
                && self.takes_more(&waist, &triangulation)
            {
                added = self
                    .refinement(&waist)
                    .rows_where_astray(&triangulation.complex);
            }
            if added.is_empty() {
                return Ok(Triangulated {
                    waist,
                    triangulation,
                    added: extra,
                });
            }
            extra.extend(added);
            round += 1;
            progress.enter(Stage::Landmarks);
        }
    }

    /// Whether more landmarks may help: what cannot be triangulated is not mended by them.
    fn takes_more(&self, waist: &Stratification<f64>, triangulation: &Triangulation) -> bool {
        let open = triangulation.incomplete.len() as f64;
        open <= self.parts.tuning.refinement.open_share * waist.rows.len() as f64
    }

    fn refinement<'r>(&'r self, waist: &'r Stratification<f64>) -> Refinement<'r, f64> {
        Refinement {
            near: &self.prepared.engines.euclidean,
            producer: self.producer,
            rows: &waist.rows,
            dl: self.parts.parameters.dl,
            scale: self.prepared.engines.scale(),
            tuning: &self.parts.tuning.refinement,
        }
    }

    /// Rows that should be landmarks as well, where the verdict on a mesh is that points are far from it.
    fn left_behind(&self, made: &Triangulated, judged: &Judged) -> Vec<Row> {
        let uncovered = (judged.certificate.violations())
            .any(|violation| violation.kind == ViolationKind::UncoveredPoints);
        if !uncovered || !self.takes_more(&made.waist, &made.triangulation) {
            return Vec::new();
        }
        let heights = distances_to_mesh(&judged.mesh, &self.prepared.engines.cloud);
        self.refinement(&made.waist).rows_left_behind(&heights)
    }

    /// The mesh of a triangulation, its homology and pieces, and the verdict.
    fn judged(&self, made: &Triangulated, progress: &mut Progress<'_>) -> Result<Judged, Error> {
        progress.enter(Stage::Homology);
        let complex = &made.triangulation.complex;
        let mesh = mesh_of(complex, &made.waist, self.places, &self.prepared.rows.kept)?;
        let homology = homology(&mesh.complex)?;
        let pieces = pieces(&mesh);
        progress.enter(Stage::Certificate);
        let special_points = special_points(&mesh, &made.waist, &self.prepared.rows.kept);
        Ok(Judged {
            certificate: self.certify(&mesh, &special_points, made),
            special_points,
            mesh,
            homology,
            pieces,
        })
    }

    fn certify(
        &self,
        mesh: &Mesh,
        special_points: &[SpecialPoint],
        made: &Triangulated,
    ) -> Certificate {
        let Self {
            parts, prepared, ..
        } = self;
        let dropped = made.triangulation.dropped.iter();
        let dropped = dropped.map(|&k| made.waist.rows[k]);
        let options = CertificateOptions {
            points: Some(&prepared.engines.cloud),
            landmark_separation: Some(parts.parameters.dl),
            separation_scale: prepared.engines.scale(),
            unused_landmarks: &prepared.rows.in_input(dropped),
            special_points,
            closed: parts.parameters.boundary.is_empty()
                && !parts.models.all().iter().any(|m| m.finds_boundary()),
            faithful: parts.parameters.spaces.metric != MetricName::Lifted,
            limits: parts.limits.clone(),
            ..CertificateOptions::default()
        };
        match &prepared.given {
            None => prepared.rows.named(certify(mesh, &options)),
            Some(space) => certify_by_distances(mesh, space.metric(), space.oracle(), &options),
        }
    }
}
