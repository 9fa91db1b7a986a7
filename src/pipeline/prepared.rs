//! What comes in, looked over and made ready for the stages.

use super::rows::Rows;
use super::{Parameters, Parts};
use crate::engines::Engines;
use crosscap_algorithms::space::Space;
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, MetricSpace, PointCloud, Row};

/// What a reconstruction is made of.
pub(crate) struct Input<'i> {
    /// The points. Of distances that were given a picture, which vertices are drawn in and nothing else.
    pub(crate) cloud: &'i PointCloud<f64>,
    /// Distances that were given.
    pub(crate) given: Option<Space<'i, f64>>,
}

/// A cloud ready for the stages, with what serves its metrics.
pub(super) struct Prepared<'g> {
    pub(super) rows: Rows,
    pub(super) boundary: Vec<Row>,
    pub(super) engines: Engines,
    pub(super) given: Option<Space<'g, f64>>,
}

impl Parts {
    /// Looks the input over, and builds what serves its metrics.
    pub(super) fn prepare<'g>(
        &self,
        input: &Input<'g>,
        threads: &Threads,
    ) -> Result<Prepared<'g>, Error> {
        let customs = [&self.analysis_metric, &self.chart_metric];
        for custom in customs.into_iter().flatten() {
            let count = custom.metric().len();
            if count != input.cloud.len() {
                return Err(Error::Shape {
                    found: format!("a metric on {count} points"),
                    expected: format!("{}, as many as there are", input.cloud.len()),
                });
            }
        }
        // A metric knows the rows as they are, copies included; so does an oracle.
        let copies = input.given.is_some()
            || self.oracle.is_some()
            || customs.iter().any(|custom| custom.is_some());
        let rows = Rows::of(input.cloud, copies)?;
        let Parameters {
            boundary,
            spaces,
            eps,
            ..
        } = &self.parameters;
        let (tangents, kept) = (&self.tuning.tangents, &self.kept);
        Ok(Prepared {
            boundary: rows.positions(input.cloud, boundary)?,
            engines: Engines::new(spaces, *eps, &rows.cloud, tangents, kept, threads)?,
            rows,
            given: input.given,
        })
    }
}
