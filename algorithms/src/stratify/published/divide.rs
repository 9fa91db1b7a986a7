//! Two planes through a neighborhood, which divide it.

use super::analysis::Published;
use crate::principal::PrincipalFrame;
use crate::singularity::PlanePair;
use crate::stratify::analysis::{Fitter, Scratch};
use crosscap_core::{Row, Scalar};
use nalgebra::Vector3;

/// Fewest points that a quadric of 9 degrees of freedom is fitted to.
const QUADRIC_POINTS: usize = 10;

/// A point of a neighborhood with its distances to the two planes.
pub(super) struct Divided {
    pub(super) row: Row,
    pub(super) planes: [f64; 2],
}

impl Divided {
    pub(super) fn on_curve(&self, ep: f64) -> bool {
        self.planes.iter().all(|&d| d < ep)
    }
}

impl Published {
    /// The points within `reach` of point `i`, nearest first, with their distances to the two
    /// planes fitted to the ball of eps; `None` where the fit is rejected.
    pub(super) fn divide<S: Scalar>(
        &self,
        fitter: &Fitter<'_, S>,
        i: Row,
        reach: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<Vec<Divided>> {
        let Scratch { near, local, .. } = scratch;
        fitter
            .space
            .oracle()
            .within(i.index(), S::of(reach.max(self.eps)), near);
        let fitted = near.partition_point(|x| x.distance < S::of(self.eps));
        if fitted < QUADRIC_POINTS {
            return None;
        }
        let frame = PrincipalFrame::of(fitter.cloud, near[..fitted].iter().map(|x| x.index));
        local.clear();
        for x in near.iter() {
            frame.project(fitter.cloud.point(x.index), 3, local);
        }
        let points = local.chunks_exact(3).map(Vector3::from_column_slice);
        let planes = PlanePair::direct(points.clone().take(fitted), self.eps).ok()?;
        let distances = |x: &Vector3<f64>| [0, 1].map(|k| planes.distance(k, x).abs());
        let sum: f64 = points
            .clone()
            .take(fitted)
            .map(|x| {
                let [a, b] = distances(&x);
                a.min(b).powi(2)
            })
            .sum();
        if (sum / fitted as f64).sqrt() > self.dp {
            return None;
        }
        Some(
            near.iter()
                .zip(points)
                .take_while(|(x, _)| x.distance < S::of(reach))
                .map(|(x, place)| Divided {
                    row: x.row(),
                    planes: distances(&place),
                })
                .collect(),
        )
    }
}
