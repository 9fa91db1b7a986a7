//! Reconstruction from distances alone.

use crate::pipeline::{GivenSpace, Input, Outcome, Parameters, Pipeline};
use crate::spaces::Warning;
use crosscap_algorithms::metric::{BruteForceOracle, GivenDistances};
use crosscap_algorithms::scaling::{Scaled, picture_of_metric, scale_metric, scale_patches};
use crosscap_algorithms::space::Space;
use crosscap_backends::files::Distances;
use crosscap_backends::geodesic::{EdgeRule, GeodesicMetric};
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, Neighbor, NeighborhoodOracle, Row, SparseDistances};

/// Places that deviate at most this share of dl from the distances stand for the points.
const EXACT: f64 = 0.01;
/// Coordinates of places that are a picture.
const PICTURE: usize = 3;

impl Pipeline {
    /// Reconstructs a surface from the distances of its points.
    ///
    /// Distances of points of a Euclidean space give their coordinates back, up to a motion, and
    /// everything else follows as from coordinates. Other distances (geodesic ones, say) are taken
    /// as they are: neighborhoods, landmarks and charts come from them; curves cannot be looked
    /// for, so that [`Parameters::surface`] has to be set; and the levels of the certificate that
    /// need places are left out ([`Certificate::unchecked`]). Distances that a sparse matrix
    /// leaves out are then lengths of shortest paths.
    ///
    /// Metrics of [`Parameters::spaces`] other than the Euclidean one ask for coordinates.
    ///
    /// [`Certificate::unchecked`]: crosscap_algorithms::certificate::Certificate::unchecked
    ///
    /// # Errors
    /// Those of [`Pipeline::reconstruct`]; [`Error::Parameter`] where coordinates are needed and
    /// the distances have none.
    ///
    /// ```
    /// use crosscap::prelude::*;
    /// use crosscap::backends::files::Distances;
    /// let points = SampleSurface::find("sphere")?.sample(&Sampling::new(1500, 7))?.points;
    /// let n = points.len();
    /// let values = (0..n * n).map(|k| points.squared_distance(k / n, k % n).sqrt()).collect();
    /// let distances = Distances::Dense { count: n, values };
    /// let parameters = Parameters::new(0.6, 0.3).surface();
    /// let outcome = Pipeline::new(parameters)?.reconstruct_distances(&distances)?;
    /// assert!(outcome.is_verified());
    /// assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
    /// assert!(outcome.report.given.is_some_and(|given| given.exact && given.dimension == 3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn reconstruct_distances(&mut self, distances: &Distances) -> Result<Outcome, Error> {
        self.guarded(|pipeline| pipeline.of_distances(distances))
    }

    fn of_distances(&mut self, distances: &Distances) -> Result<Outcome, Error> {
        let threads = self.threads()?;
        match distances {
            Distances::Dense { count, values } => {
                let metric = GivenDistances::new(*count, values.clone())?;
                let oracle = BruteForceOracle::new(metric);
                let scaled = scale_metric(oracle.metric(), usize::MAX, &threads)?;
                if self.is_exact(&scaled) {
                    return self.with_coordinates(&scaled);
                }
                let picture = picture_of_metric(oracle.metric(), PICTURE)?;
                let space = Space::new(oracle.metric(), &oracle);
                self.without_coordinates(&picture, space, Vec::new())
            }
            Distances::Sparse(known) => {
                if let Ok(scaled) = scale_patches(known, &threads)
                    && self.is_exact(&scaled)
                {
                    return self.with_coordinates(&scaled);
                }
                let (metric, warnings) = paths(known, self.parameters(), &threads)?;
                let picture = picture_of_metric(&metric, PICTURE)?;
                let space = Space::of(&metric);
                self.without_coordinates(&picture, space, warnings)
            }
        }
    }

    fn is_exact(&self, scaled: &Scaled) -> bool {
        scaled.places.dimension() >= 2 && scaled.deviation <= EXACT * self.parameters().dl
    }

    fn with_coordinates(&mut self, scaled: &Scaled) -> Result<Outcome, Error> {
        let mut outcome = self.reconstruct(&scaled.places)?;
        outcome.report.given = Some(GivenSpace {
            dimension: scaled.places.dimension(),
            deviation: scaled.deviation,
            exact: true,
        });
        Ok(outcome)
    }

    fn without_coordinates(
        &mut self,
        picture: &Scaled,
        space: Space<'_, f64>,
        warnings: Vec<Warning>,
    ) -> Result<Outcome, Error> {
        let parameters = self.parameters();
        let needs = |name, value: String, expected: &str| Error::Parameter {
            name,
            value,
            expected: format!(
                "{expected}: these distances are not those of points in a Euclidean space \
                 (places found from them are off by up to {})",
                picture.deviation
            ),
        };
        if !parameters.spaces.are_usual() {
            let named = format!(
                "{} and {}",
                parameters.spaces.metric,
                parameters.spaces.charts()
            );
            return Err(needs(
                "metric",
                named,
                "the default, for distances that are given",
            ));
        }
        if !parameters.surface {
            let expected = "surface, since curves are looked for in coordinates";
            return Err(needs("surface", "not set".into(), expected));
        }
        if !parameters.boundary.is_empty() {
            let value = format!("{} rows", parameters.boundary.len());
            let expected = "none, since a boundary is laid in coordinates";
            return Err(needs("boundary", value, expected));
        }
        let places = crate::spaces::padded(&picture.places, 2)?;
        warnings.iter().for_each(|warning| self.warn(warning));
        let mut outcome = self.run(&Input {
            cloud: &places,
            given: Some(space),
        })?;
        outcome.report.given = Some(GivenSpace {
            dimension: picture.places.dimension(),
            deviation: picture.deviation,
            exact: false,
        });
        outcome.report.warnings.extend(warnings);
        Ok(outcome)
    }
}

/// Shortest paths over the distances that are known.
fn paths(
    known: &SparseDistances<f64, Row>,
    parameters: &Parameters,
    threads: &Threads,
) -> Result<(GeodesicMetric<f64>, Vec<Warning>), Error> {
    let edges = KnownDistances(known);
    let reach = (0..known.len()).map(|i| edges.reach(i)).fold(0.0, f64::max);
    if reach == 0.0 {
        return Err(Error::Shape {
            found: "a sparse matrix without a positive distance".into(),
            expected: "the distances of near points".into(),
        });
    }
    let rule = EdgeRule::Within(reach * (1.0 + 1e-12));
    let metric = threads.install(|| GeodesicMetric::new(&edges, rule))?;
    let radius = parameters.chart_radius();
    let short = (0..known.len()).find(|&i| edges.reach(i) < radius);
    let mut warnings: Vec<Warning> = Vec::new();
    if let Some(point) = short {
        warnings.push(Warning::Range {
            point,
            known: edges.reach(point),
            radius,
        });
    }
    warnings.extend(metric.report().warnings().into_iter().map(Warning::Graph));
    Ok((metric, warnings))
}

/// The known distances as a graph: what is not known is not near.
pub(crate) struct KnownDistances<'a>(pub(crate) &'a SparseDistances<f64, Row>);

impl KnownDistances<'_> {
    fn reach(&self, point: usize) -> f64 {
        self.0.row(Row::new(point)).map(|x| x.1).fold(0.0, f64::max)
    }

    fn all(&self, center: usize, out: &mut Vec<Neighbor<f64>>) {
        out.clear();
        out.push(Neighbor {
            index: center,
            distance: 0.0,
        });
        out.extend(self.0.row(Row::new(center)).map(|(j, distance)| Neighbor {
            index: j.index(),
            distance,
        }));
        out.sort_by(|a, b| {
            a.distance
                .total_cmp(&b.distance)
                .then(a.index.cmp(&b.index))
        });
    }
}

impl NeighborhoodOracle for KnownDistances<'_> {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.0.len()
    }

    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        self.all(center, out);
        out.retain(|x| x.distance < radius);
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        self.all(center, out);
        out.truncate(count);
    }
}
