//! Balls of the space with the coordinates that models are fitted in.

use super::analyzer::Analyzer;
use super::ledger::{Ledger, ModelCounts};
use crate::audit::Faults;
use crate::execute::Execute;
use crate::principal::PrincipalFrame;
use crate::space::Space;
use crate::tuning::Tuning;
use crosscap_core::{
    DimensionEstimator, LocalPoints, Neighbor, PointCloud, Row, Scalar, SingularityModel,
};
use std::ops::Range;

/// An [`Analyzer`] on a space that has coordinates. Everything that fits a model goes through it.
pub(in crate::stratify) struct Fitter<'a, S: Scalar> {
    pub(in crate::stratify) space: Space<'a, S>,
    pub(in crate::stratify) cloud: &'a PointCloud<S>,
    pub(super) estimator: &'a dyn DimensionEstimator<Scalar = S>,
    pub(in crate::stratify) models: &'a [Box<dyn SingularityModel>],
    pub(in crate::stratify) execute: &'a dyn Execute,
    pub(in crate::stratify) tuning: &'a Tuning,
    /// What models returned that cannot be used.
    pub(in crate::stratify) faults: Faults,
    pub(super) ledger: Ledger,
}

/// Buffers of one thread.
pub(in crate::stratify) struct Scratch<S> {
    pub(in crate::stratify) near: Vec<Neighbor<S>>,
    rest: Vec<Neighbor<S>>,
    pub(in crate::stratify) local: Vec<f64>,
}

impl<S> Default for Scratch<S> {
    fn default() -> Self {
        Self {
            near: Vec::new(),
            rest: Vec::new(),
            local: Vec::new(),
        }
    }
}

/// A ball with its frame.
pub(in crate::stratify) struct View {
    pub(super) frame: PrincipalFrame,
    /// Position of the center, which is among those that are fitted.
    pub(super) center: usize,
    /// How many points are fitted.
    pub(super) fitted: usize,
    /// Points in the ball.
    pub(super) within: usize,
    pub(super) radius: f64,
    /// Points that were found, those behind the fitted ones included; whoever adds rows adds them
    /// behind these.
    pub(super) found: usize,
    /// Whether nobody needs the labels of the points behind the fitted ones.
    pub(super) lean: bool,
}

impl View {
    /// The points that a model does not get.
    fn spared(&self, model: &dyn SingularityModel) -> Range<usize> {
        if self.lean && !model.looks_behind() {
            self.fitted..self.found
        } else {
            self.found..self.found
        }
    }

    /// Positions, among the points that a model gets, of `count` rows that were added.
    pub(super) fn added(&self, model: &dyn SingularityModel, count: usize) -> Range<usize> {
        let first = self.found - self.spared(model).len();
        first..first + count
    }
}

impl<'a, S: Scalar> Fitter<'a, S> {
    pub(super) fn new(analyzer: &Analyzer<'a, S>, cloud: &'a PointCloud<S>) -> Self {
        Self {
            space: analyzer.space,
            cloud,
            estimator: analyzer.estimator,
            models: analyzer.models,
            execute: analyzer.execute,
            tuning: analyzer.tuning,
            faults: Faults::default(),
            ledger: Ledger::new(analyzer.models.len()),
        }
    }

    /// What became of every model so far.
    pub(in crate::stratify) fn counts(&self) -> Vec<ModelCounts> {
        self.ledger.counts(self.models)
    }

    /// Whether a model knows of curves that no surface touches.
    pub(super) fn knows_bare_curves(&self) -> bool {
        self.models.iter().any(|m| m.applies_to(1))
    }

    /// The rows closer to one than `radius`, nearest first.
    pub(in crate::stratify) fn around(&self, row: Row, radius: f64, near: &mut Vec<Row>) {
        let mut found = Vec::new();
        self.space
            .oracle()
            .within(row.index(), S::of(radius), &mut found);
        near.clear();
        near.extend(found.iter().map(Neighbor::row));
    }

    /// Squared distance of two rows in the metric of the analysis.
    pub(super) fn square(&self, a: Row, b: Row) -> f64 {
        self.space.square(a.index(), b.index())
    }

    /// The ball of radius `reach` around `i` in the frame of the ball of `radius`.
    ///
    /// The rows that are fitted come first: all of the smaller ball, or every few of it by
    /// distance, since a fit does not get better for more than a few hundred points.
    pub(super) fn view(
        &self,
        i: Row,
        radius: f64,
        reach: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<View> {
        let most = self.tuning.analysis.most_fitted;
        self.view_of(i, [radius, reach], most, scratch)
    }

    /// The same, with at most so many rows that are fitted.
    pub(super) fn view_of(
        &self,
        i: Row,
        [radius, reach]: [f64; 2],
        most: usize,
        scratch: &mut Scratch<S>,
    ) -> Option<View> {
        let Scratch { near, rest, .. } = scratch;
        self.space.oracle().within(i.index(), S::of(reach), near);
        // Neighbors come sorted by distance.
        let within = near.partition_point(|x| x.distance < S::of(radius));
        let stride = within.div_ceil(most);
        let mut fitted = within;
        if stride > 1 {
            rest.clear();
            fitted = 0;
            for k in 0..near.len() {
                let x = near[k];
                if k < within && (k % stride == 0 || x.row() == i) {
                    near[fitted] = x;
                    fitted += 1;
                } else {
                    rest.push(x);
                }
            }
            near.truncate(fitted);
            near.extend_from_slice(rest);
        }
        let rows = near[..fitted].iter().map(|x| x.index);
        Some(View {
            frame: PrincipalFrame::of(self.cloud, rows),
            center: near[..fitted].iter().position(|x| x.row() == i)?,
            fitted,
            within,
            radius,
            found: near.len(),
            lean: false,
        })
    }

    /// The points of a view in the coordinates that a model works in.
    pub(super) fn local<'s>(
        &self,
        view: &View,
        model: &dyn SingularityModel,
        scratch: &'s mut Scratch<S>,
    ) -> LocalPoints<'s> {
        let dimension = model.local_dimension();
        let spared = view.spared(model);
        scratch.local.clear();
        for x in scratch.near[..spared.start]
            .iter()
            .chain(&scratch.near[spared.end..])
        {
            let place = self.cloud.point(x.index);
            view.frame.project(place, dimension, &mut scratch.local);
        }
        LocalPoints {
            dimension,
            coordinates: &scratch.local,
            fitted: view.fitted,
            center: view.center,
            middle: view.center,
            radius: view.radius,
        }
    }
}
