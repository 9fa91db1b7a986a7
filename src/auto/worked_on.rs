//! Points without outliers, moved onto fits of their neighborhoods where they scatter: what is reconstructed, and what a
//! mesh is held against.

use crate::pipeline::{Outcome, Parameters, Pipeline, distinct_rows};
use crate::spaces::MetricName;
use crosscap_algorithms::certificate::{
    Certificate, CertificateOptions, CoverReport, Place, certify,
};
use crosscap_algorithms::creases::{CreaseLimits, Creases, creases};
use crosscap_algorithms::execute::Execute;
use crosscap_algorithms::prepare::{Preparation, PreparationSummary, Remedies, Subspace};
use crosscap_algorithms::tuning::PreparationTuning;
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, Mesh, PointCloud};

/// The points of an input as they are worked on.
#[derive(Clone)]
pub(super) struct WorkedOn {
    /// The points.
    pub(super) cloud: PointCloud<f64>,
    /// Row of the input of every point.
    rows: Vec<usize>,
    /// What `cloud` has coordinates of, where that is not the space of the input.
    subspace: Option<Subspace>,
    /// The same points where they were given.
    unmoved: PointCloud<f64>,
    /// How far the points scatter across the surface, root mean square, unit of the data; 0 where they stayed.
    noise: f64,
    /// What was found out about them, where that was asked.
    pub(super) summary: Option<PreparationSummary>,
    /// Whether anything was done about them.
    changed: bool,
}

impl WorkedOn {
    /// Whatever the points need; none where they are too few to tell, a dozen.
    pub(super) fn of(
        given: &PointCloud<f64>,
        tuning: &PreparationTuning,
        execute: &dyn Execute,
    ) -> Result<Option<Self>, Error> {
        let kept = distinct_rows(given);
        let distinct = given.select(&kept);
        let found = match Preparation::of(&distinct, Remedies::ALL, tuning, execute) {
            Ok(found) => found,
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            Err(_) => return Ok(None),
        };
        Ok(Some(Self {
            cloud: found.points(&distinct),
            unmoved: distinct.select(&found.kept),
            rows: found.kept.iter().map(|&k| kept[k]).collect(),
            noise: found.scatter(),
            subspace: found.subspace.clone(),
            summary: Some(found.summary().named(|row| kept[row])),
            changed: found.changes(),
        }))
    }

    /// The different points as they are, not looked at.
    pub(super) fn as_given(given: &PointCloud<f64>) -> Self {
        let rows = distinct_rows(given);
        let cloud = given.select(&rows);
        Self {
            unmoved: cloud.clone(),
            cloud,
            rows,
            subspace: None,
            noise: 0.0,
            summary: None,
            changed: false,
        }
    }

    /// The different points as they are, looked at.
    pub(super) fn unchanged(
        given: &PointCloud<f64>,
        tuning: &PreparationTuning,
    ) -> Result<Self, Error> {
        let plain = Self::as_given(given);
        let found = Preparation::of(&plain.cloud, Remedies::NONE, tuning, &Threads::new(1)?)?;
        Ok(Self {
            summary: Some(found.summary()),
            ..plain
        })
    }

    /// Whether anything was done about the points.
    pub(super) fn is_changed(&self) -> bool {
        self.changed
    }

    /// Whether all that was done is that they were moved, and they scatter by less than so many spacings.
    pub(super) fn scatters_below(&self, spacings: f64) -> bool {
        self.subspace.is_none()
            && self.summary.as_ref().is_some_and(|summary| {
                let slight = summary.noise_of_spacing.is_some_and(|n| n < spacings);
                summary.moved.is_some() && !summary.outliers_left_out && slight
            })
    }

    /// Rows of the input that they are, increasing.
    pub(super) fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// The same without some rows of the input.
    pub(super) fn without(self, rows: &[usize]) -> Self {
        let stays = |row: usize| !rows.contains(&row);
        let kept: Vec<usize> = (0..self.rows.len())
            .filter(|&at| stays(self.rows[at]))
            .collect();
        Self {
            cloud: self.cloud.select(&kept),
            unmoved: self.unmoved.select(&kept),
            rows: kept.iter().map(|&at| self.rows[at]).collect(),
            subspace: self.subspace,
            noise: self.noise,
            summary: self.summary.map(|summary| summary.without(rows)),
            changed: true,
        }
    }

    /// One reconstruction; rows are those of the input.
    pub(super) fn run(
        &self,
        parameters: &Parameters,
        make: &mut dyn FnMut(Parameters) -> Result<Pipeline, Error>,
    ) -> Result<Result<Outcome, Error>, Error> {
        let mut own = parameters.clone();
        let position = |row: &usize| self.rows.binary_search(row).ok();
        own.boundary = parameters.boundary.iter().filter_map(position).collect();
        Ok(match make(own)?.reconstruct(&self.cloud) {
            Ok(outcome) => Ok(self.in_input(outcome, parameters)),
            Err(error) => Err(self.named(error)),
        })
    }

    /// The outcome with rows of the input, its mesh measured against the points where they were given.
    fn in_input(&self, mut outcome: Outcome, parameters: &Parameters) -> Outcome {
        if let Some(subspace) = &self.subspace {
            lift(subspace, &mut outcome);
        }
        if self.noise > 0.0 {
            // Where it cannot be told, the separation is the same everywhere, which is stricter where points are sparse.
            let scale = parameters.spaces.metric.separation_scale(&self.cloud);
            let scale = scale.ok().flatten();
            let options = CertificateOptions {
                landmark_separation: Some(parameters.dl),
                separation_scale: scale.as_deref(),
                ..CertificateOptions::default()
            };
            self.measure_where_given(&outcome.mesh, &options, &mut outcome.certificate);
        }
        for index in &mut outcome.mesh.point_index {
            if let Some(&row) = usize::try_from(*index).ok().and_then(|k| self.rows.get(k)) {
                *index = row as i64;
            }
        }
        self.name(&mut outcome.certificate);
        let failures = std::mem::take(&mut outcome.failures);
        outcome.failures = failures.into_iter().map(|e| self.named(e)).collect();
        outcome.report.parameters = parameters.clone();
        outcome
    }

    /// The verdict on a mesh in the space of the input, and its creases; rows and places are those of the input.
    ///
    /// What a mesh says is held against the points as they are worked on, how far it is from them is measured where they were
    /// given, with the noise allowed for. `metric` is the one that landmarks followed, where it is known.
    pub(super) fn certify(
        &self,
        mesh: &Mesh,
        metric: Option<MetricName>,
        options: &CertificateOptions<'_>,
        execute: &dyn Execute,
    ) -> Result<(Certificate, Creases), Error> {
        let projected = self.subspace.as_ref().map(|subspace| Mesh {
            vertices: subspace.project(&mesh.vertices),
            ..mesh.clone()
        });
        let worked_on = projected.as_ref().unwrap_or(mesh);
        let scale = match metric {
            Some(metric) => metric.separation_scale(&self.cloud)?,
            None => None,
        };
        let options = CertificateOptions {
            points: Some(&self.cloud),
            separation_scale: scale.as_deref(),
            ..options.clone()
        };
        let mut certificate = certify(worked_on, &options);
        let mut creases = creases(worked_on, &self.cloud, &CreaseLimits::MEASURED, execute)?;
        if let Some(subspace) = &self.subspace {
            let places = certificate.places_mut().chain(creases.places_mut());
            places.for_each(|place| *place = subspace.lift(place));
        }
        if self.noise > 0.0 {
            self.measure_where_given(mesh, &options, &mut certificate);
        }
        self.name(&mut certificate);
        Ok((certificate, creases))
    }

    /// Replaces the distances between a mesh and the points as they are worked on by those where they were given. What is
    /// wrong with the former stays wrong.
    fn measure_where_given(
        &self,
        mesh: &Mesh,
        options: &CertificateOptions<'_>,
        certificate: &mut Certificate,
    ) {
        let options = CertificateOptions {
            points: Some(&self.unmoved),
            noise: self.noise,
            faithful: false,
            ..options.clone()
        };
        let sound = |report: &CoverReport| report.violations.is_empty();
        if certificate.cover.as_ref().is_some_and(sound) {
            certificate.cover = certify(mesh, &options).cover;
        }
    }

    /// Names points by their rows of the input.
    fn name(&self, certificate: &mut Certificate) {
        let cover = certificate.cover.iter_mut();
        let found = cover.flat_map(|report| &mut report.violations);
        for place in found.flat_map(|violation| &mut violation.places) {
            if let Place::Point(row) = place {
                *row = self.row(*row);
            }
        }
    }

    fn row(&self, position: usize) -> usize {
        self.rows.get(position).copied().unwrap_or(position)
    }

    /// The error with the row of the input.
    fn named(&self, mut error: Error) -> Error {
        match &mut error {
            Error::SparseNeighborhood { point, .. }
            | Error::Dimension { point, .. }
            | Error::Law { point, .. }
            | Error::Triangulation {
                point: Some(point), ..
            } => *point = self.row(*point),
            _ => {}
        }
        error
    }
}

/// Mesh and certificate with the places in R^N of those in a subspace.
fn lift(subspace: &Subspace, outcome: &mut Outcome) {
    let places = outcome.mesh.vertices.iter();
    let numbers: Vec<f64> = places.flat_map(|place| subspace.lift(place)).collect();
    let count = outcome.mesh.vertices.len();
    if let Ok(vertices) = PointCloud::new(numbers.len() / count.max(1), numbers) {
        outcome.report.dimension = vertices.dimension();
        outcome.mesh.vertices = vertices;
    }
    let creases = outcome.creases.iter_mut().flat_map(Creases::places_mut);
    for place in outcome.certificate.places_mut().chain(creases) {
        *place = subspace.lift(place);
    }
}
