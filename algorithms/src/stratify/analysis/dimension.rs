//! Local dimensions, as an estimator tells them.

use super::fitter::{Fitter, View};
use crate::audit;
use crate::principal::PrincipalFrame;
use crosscap_core::{BallDimension, Balls, Error, Neighbor, Neighborhood, Radii, Row, Scalar};

impl<S: Scalar> Fitter<'_, S> {
    /// Number of points and dimension of the balls of the analysis, one a point, as the estimator tells them for all
    /// of them together.
    pub(in crate::stratify) fn dimensions(
        &self,
        radii: Radii<'_>,
    ) -> Result<Vec<BallDimension>, Error> {
        let balls = Balls {
            metric: self.space.metric(),
            oracle: self.space.oracle(),
            cloud: Some(self.cloud),
            radii,
            least: self.tuning.analysis.least_neighbors,
        };
        let mut found = self.estimator.estimate_all(&balls, self.execute)?;
        audit::dimensions(self.estimator, &balls, &found)?;
        // A value above the dimension of the space is an error of chance.
        let most = self.cloud.dimension().min(u8::MAX.into()) as u32;
        for ball in &mut found {
            ball.dimension = ball.dimension.min(most);
        }
        Ok(found)
    }

    /// What the estimator says of the points `near` around `i`.
    fn estimate(&self, i: Row, radius: f64, near: &[Neighbor<S>]) -> Result<usize, Error> {
        let estimator = self.estimator;
        let estimate = estimator.estimate(&Neighborhood {
            center: i.index(),
            radius,
            neighbors: near,
            metric: self.space.metric(),
            cloud: Some(self.cloud),
        })?;
        let space = self.cloud.dimension();
        audit::dimension(estimator.name(), i.index(), &estimate, near.len(), space)
    }

    /// The dimension of a ball that is smaller than that of the analysis, by the same estimator; `None` where it
    /// has too few points for an answer.
    pub(super) fn dimension_of(&self, i: Row, view: &View) -> Option<usize> {
        self.dimension_by(i, view.radius, &view.frame, view.fitted)
    }

    /// The same for the inner part of a ball, of which `near` has the points that are fitted.
    pub(super) fn inner_dimension(
        &self,
        i: Row,
        radius: f64,
        near: &[Neighbor<S>],
    ) -> Option<usize> {
        let inner = near.iter().filter(|x| x.distance < S::of(radius));
        let rows = inner.map(|x| x.index);
        let count = rows.clone().count();
        self.dimension_by(i, radius, &PrincipalFrame::of(self.cloud, rows), count)
    }

    fn dimension_by(
        &self,
        i: Row,
        radius: f64,
        frame: &PrincipalFrame,
        points: usize,
    ) -> Option<usize> {
        let estimator = self.estimator;
        if let Some(estimate) = estimator.of_variances(&frame.variances) {
            return Some(estimate.dimension);
        }
        if points == 0 {
            return None;
        }
        let mut near = Vec::new();
        self.space
            .oracle()
            .within(i.index(), S::of(radius), &mut near);
        match self.estimate(i, radius, &near) {
            Ok(dimension) => Some(dimension),
            Err(fault @ Error::Law { .. }) => {
                self.faults.add(i.index(), fault);
                None
            }
            Err(_) => None,
        }
    }
}
