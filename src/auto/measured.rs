//! A mesh of any origin, held against the points as a run holds its own.

use super::alone::{self, ROUNDS};
use super::worked_on::WorkedOn;
use crate::spaces::MetricName;
use crosscap_algorithms::certificate::{Certificate, CertificateOptions};
use crosscap_algorithms::creases::Creases;
use crosscap_algorithms::prepare::PreparationSummary;
use crosscap_algorithms::tuning::{PreparationTuning, RefinementTuning};
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, Mesh, PointCloud};

/// How a mesh is held against points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measuring {
    /// Whether outliers are left out and noise is allowed for, as where parameters are left to the program.
    pub prepare: bool,
    /// The metric that the landmarks followed; the separation is the same everywhere where it is not known.
    pub metric: Option<MetricName>,
    /// Number of threads, 0 for all processors; the result does not depend on it.
    pub threads: usize,
}

impl Default for Measuring {
    fn default() -> Self {
        Self {
            prepare: true,
            metric: None,
            threads: 0,
        }
    }
}

/// A mesh held against points.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Measured {
    /// The verdict; points are named by their rows of the cloud that was given.
    pub certificate: Certificate,
    /// Where the surface bends sharply, as the points show.
    pub creases: Creases,
    /// What was done about outliers and noise; none where nothing was.
    pub preparation: Option<PreparationSummary>,
}

impl Measured {
    /// Holds a mesh against the points it was made from. Everything is found out from the points again: which are outliers,
    /// how much they scatter, and where the surface is then.
    ///
    /// A run leaves outliers out and moves points that scatter onto fits before it makes a mesh, and it judges the mesh so:
    /// what it says is held against the points as they were worked on, and its distances are measured where the points were
    /// given, four times the noise being allowed. A mesh judged by the raw points would be refused for being smoother than they are.
    /// `options` are those of [`certify`](crosscap_algorithms::certificate::certify) but for points, noise and the scale of the
    /// separation, which are set here. O(n log n) for n points, and what the certificate takes.
    ///
    /// ```
    /// use crosscap::auto::{Measured, Measuring};
    /// use crosscap::algorithms::certificate::CertificateOptions;
    /// use crosscap::prelude::*;
    /// let mut sampling = Sampling::new(2000, 1);
    /// sampling.noise = 0.03;
    /// let noisy = SampleSurface::find("sphere")?.sample(&sampling)?.points;
    /// let outcome = Parameters::auto().reconstruct(&noisy)?.outcome?;
    /// let options = CertificateOptions {
    ///     landmark_separation: Some(outcome.report.parameters.dl),
    ///     ..CertificateOptions::default()
    /// };
    /// let again = Measured::of(&outcome.mesh, &noisy, &options, &Measuring::default())?;
    /// assert!(again.certificate.verdict().is_verified());
    /// assert!(again.preparation.unwrap().moved.unwrap() > 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Shape`] for points of another dimension than the mesh has.
    pub fn of(
        mesh: &Mesh,
        points: &PointCloud<f64>,
        options: &CertificateOptions<'_>,
        measuring: &Measuring,
    ) -> Result<Self, Error> {
        let (found, expected) = (points.dimension(), mesh.vertices.dimension());
        if found != expected {
            return Err(Error::Shape {
                found: format!("points of R^{found}"),
                expected: format!("R^{expected}, as the mesh is in"),
            });
        }
        let threads = Threads::new(measuring.threads)?;
        let looked_at = match measuring.prepare {
            true => WorkedOn::of(points, &PreparationTuning::MEASURED, &threads)?,
            false => None,
        };
        // Of a dozen points nothing is left out, as in a run.
        let may_leave_out = looked_at.is_some();
        let mut worked_on = looked_at.unwrap_or_else(|| WorkedOn::as_given(points));
        let mut rounds = 0;
        loop {
            let (certificate, creases) =
                worked_on.certify(mesh, measuring.metric, options, &threads)?;
            let alone = match may_leave_out && rounds < ROUNDS {
                true => alone::rows(
                    &certificate,
                    mesh,
                    points,
                    Some(worked_on.rows()),
                    &RefinementTuning::MEASURED,
                ),
                false => Vec::new(),
            };
            if alone.is_empty() {
                let changed = worked_on.is_changed();
                return Ok(Self {
                    certificate,
                    creases,
                    preparation: worked_on.summary.filter(|_| changed),
                });
            }
            worked_on = worked_on.without(&alone);
            rounds += 1;
        }
    }
}
