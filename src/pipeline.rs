//! Placeholder of the pipeline: the signatures, over the parts as they are. To be replaced.

use crosscap_algorithms::certificate::{Certificate, CertificateOptions, certify};
use crosscap_algorithms::chart::ClassicalScaling;
use crosscap_algorithms::dimension::PrincipalComponents;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::homology::{Homology, homology};
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::pieces::{Pieces, PiecesError, pieces};
use crosscap_algorithms::predicate::PlanarPredicate;
use crosscap_algorithms::singularity::TwoPlanes;
use crosscap_algorithms::stratify::{AnalysisOptions, Analyzer, StratifyOptions, stratify};
use crosscap_algorithms::triangulate::{MinimumCircumradius, Triangulator};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_core::{Complex, CurveEdge, Error, Mesh, PointCloud, Scalar, SingularityModel};
use serde::Serialize;
use std::fmt;

/// Parameters.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Parameters {
    pub eps: f64,
    pub tri_eps: Option<f64>,
    pub dt: f64,
    pub dp: f64,
    pub ep: f64,
    pub dl: f64,
    pub seed: u64,
    pub surface: bool,
    pub boundary: Vec<usize>,
    pub method: Method,
    pub threads: Option<usize>,
}

/// Method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[allow(missing_docs)]
pub enum Method {
    Cells,
    Paper,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cells => "cells",
            Self::Paper => "paper",
        })
    }
}

/// Stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Stage {
    Neighborhoods,
    Landmarks,
    Triangulation,
    Homology,
    Certificate,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Neighborhoods => "neighborhoods",
            Self::Landmarks => "landmarks",
            Self::Triangulation => "triangulation",
            Self::Homology => "homology",
            Self::Certificate => "certificate",
        })
    }
}

fn distinct(cloud: &PointCloud<f64>) -> usize {
    let mut rows: Vec<Vec<u64>> = cloud
        .iter()
        .map(|p| p.iter().map(|x| x.to_bits()).collect())
        .collect();
    rows.sort_unstable();
    rows.dedup();
    rows.len()
}

/// Pipeline.
pub struct Pipeline {
    parameters: Parameters,
    on_stage: Box<dyn FnMut(Stage)>,
}

/// Outcome.
#[allow(missing_docs)]
pub struct Outcome {
    pub mesh: Mesh,
    pub homology: Homology,
    pub certificate: Certificate,
    pub pieces: Result<Pieces, PiecesError>,
    pub report: Report,
    pub failures: Vec<Error>,
}

/// Report.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Report {
    pub version: &'static str,
    pub parameters: Parameters,
    pub points: usize,
    pub dimension: usize,
    pub duplicates: usize,
}

impl Outcome {
    /// Whether it is.
    pub fn is_verified(&self) -> bool {
        self.failures.is_empty() && self.certificate.verdict().is_verified()
    }
}

#[allow(missing_docs)]
impl Pipeline {
    pub fn new(parameters: Parameters) -> Result<Self, Error> {
        Ok(Self {
            parameters,
            on_stage: Box::new(|_| {}),
        })
    }

    pub fn on_stage(mut self, f: impl FnMut(Stage) + 'static) -> Self {
        self.on_stage = Box::new(f);
        self
    }

    pub fn reconstruct<S: Scalar>(&mut self, cloud: &PointCloud<S>) -> Result<Outcome, Error> {
        let p = &self.parameters;
        let oracle = EuclideanOracle::new(cloud.clone())?;
        let estimator = PrincipalComponents::new(p.dt)?;
        let models: Vec<Box<dyn SingularityModel>> = vec![Box::new(TwoPlanes::new(p.dp, p.ep)?)];
        let analyzer = Analyzer {
            cloud,
            metric: &oracle,
            oracle: &oracle,
            estimator: &estimator,
            models: &models,
            execute: &Serial,
        };
        (self.on_stage)(Stage::Neighborhoods);
        let mut analysis = analyzer.analyze(&AnalysisOptions {
            eps: p.eps,
            surface: p.surface,
            boundary: p.boundary.clone(),
        })?;
        (self.on_stage)(Stage::Landmarks);
        let options = StratifyOptions {
            dl: p.dl,
            tri_eps: p.tri_eps.unwrap_or(3.0 * p.dl),
            seed: p.seed,
        };
        let st = stratify(
            &analyzer,
            &mut analysis,
            None,
            &RandomGreedy::new(),
            &options,
        )?;
        (self.on_stage)(Stage::Triangulation);
        let triangulator = Triangulator {
            chart: &ClassicalScaling,
            test: &PlanarPredicate,
            rule: &MinimumCircumradius,
            largest_circumradius: 4.0 * p.dl,
            repair: true,
        };
        let out = triangulator.triangulate(&st.waist)?;
        let failures: Vec<Error> = out
            .incomplete
            .iter()
            .map(|i| Error::Triangulation {
                reason: "an open star".into(),
                landmark: i.landmark as usize,
                point: Some(st.rows[i.landmark as usize]),
                parameter: "dl",
            })
            .collect();
        let mut used = vec![false; st.rows.len()];
        for &v in out.complex.triangles.iter().flatten() {
            used[v as usize] = true;
        }
        let kept: Vec<usize> = (0..used.len()).filter(|&v| used[v]).collect();
        let mut name = vec![0; used.len()];
        kept.iter()
            .enumerate()
            .for_each(|(k, &v)| name[v] = k as u32);
        let triangles = out.complex.triangles.iter();
        let triangles = triangles.map(|t| t.map(|v| name[v as usize])).collect();
        let curves = out.complex.curve_edges.iter();
        let curves = curves.filter(|e| e.ends.iter().all(|&v| used[v as usize]));
        let curves = curves
            .map(|e| CurveEdge::new(name[e.ends[0] as usize], name[e.ends[1] as usize], e.cells));
        let complex = Complex::new(kept.len(), triangles, curves.collect())?;
        let rows: Vec<usize> = kept.iter().map(|&v| st.rows[v]).collect();
        let index = rows.iter().map(|&r| r as i64).collect();
        let mesh = Mesh::new(complex, analysis.places.select(&rows), index)?;
        (self.on_stage)(Stage::Homology);
        let homology = homology(&mesh.complex)?;
        (self.on_stage)(Stage::Certificate);
        let wide = cloud.cast::<f64>();
        let certificate = certify(
            &mesh,
            &CertificateOptions {
                points: Some(&wide),
                landmark_separation: Some(p.dl),
                ..CertificateOptions::default()
            },
        );
        Ok(Outcome {
            pieces: pieces(&mesh),
            mesh,
            homology,
            certificate,
            report: Report {
                version: env!("CARGO_PKG_VERSION"),
                parameters: p.clone(),
                points: cloud.len(),
                dimension: cloud.dimension(),
                duplicates: cloud.len() - distinct(&wide),
            },
            failures,
        })
    }
}
