//! From strata to the narrow waist: landmarks, their neighborhoods, distances.

use super::analysis::{Analysis, Analyzer};
use super::atlas::Reference;
use super::cells::{Contacts, Labels, Neighborhoods};
use super::curve_ends;
use super::distances::within_charts;
use super::landmarks;
use super::skeleton::Skeleton;
use super::strata::Strata;
use crate::space::Space;
use crosscap_core::{Error, LandmarkSelector, Link, Scalar, StratifiedLandmarks};
use serde::{Deserialize, Serialize};

/// Parameters of the stratification.
#[derive(Clone, Debug)]
pub struct StratifyOptions {
    /// Landmark separation dl, unit of the data.
    pub dl: f64,
    /// Radius of the charts (strict), unit of the data; 3 dl where the user says nothing.
    pub tri_eps: f64,
    /// Seed of the landmark selection.
    pub seed: u64,
}

impl StratifyOptions {
    fn check(&self) -> Result<(), Error> {
        for (name, value) in [("dl", self.dl), ("tri-eps", self.tri_eps)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::Parameter {
                    name,
                    value: value.to_string(),
                    expected: "a positive length".into(),
                });
            }
        }
        Ok(())
    }
}

/// What the stratification counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StratifyCounts {
    /// Landmarks.
    pub landmarks: usize,
    /// Landmarks on curves and points.
    pub curve_landmarks: usize,
    /// Landmarks that are points where curves end.
    pub corners: usize,
    /// Chain edges.
    pub curve_edges: usize,
    /// Edges of the neighbor graph that the labels cut.
    pub cut_edges: usize,
    /// Mean number of members of a neighborhood.
    pub mean_members: f64,
}

/// A landmark at a 0-stratum, with what meets there by the model that found it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointStratum {
    /// The landmark.
    pub landmark: u32,
    /// Number of curves that end there.
    pub curves: usize,
    /// Number of cells that have it at their rim.
    pub cells: usize,
    /// Its link, where the model knows it.
    pub link: Option<Link>,
}

/// The waist, and what ties it to the points.
#[derive(Clone, Debug)]
pub struct Stratification<S> {
    /// What the triangulator takes.
    pub waist: StratifiedLandmarks<S>,
    /// Row of the input that each landmark stands for.
    pub rows: Vec<usize>,
    /// The 0-strata that a model found.
    pub points: Vec<PointStratum>,
    /// Counts for the report.
    pub counts: StratifyCounts,
}

/// What says how far a chart reaches, and measures the distances in it.
#[derive(Clone, Copy)]
pub enum ChartSpace<'a, S: Scalar> {
    /// Straight lines between the places of the points, those on curves moved onto them.
    Places,
    /// A metric on the rows of the input.
    Metric(Space<'a, S>),
}

/// Makes waists of one cloud at one resolution: the first, and others with more landmarks.
///
/// A waist does not depend on those that were made before.
pub trait WaistProducer<S: Scalar> {
    /// Where every point is.
    fn strata(&self) -> &Strata;

    /// Whether landmarks may be added.
    fn takes_more(&self) -> bool {
        true
    }

    /// The waist, with the rows `extra` as landmarks whatever their separation.
    ///
    /// # Errors
    /// Those of the producer.
    fn waist(&self, extra: &[usize]) -> Result<Stratification<S>, Error>;
}

/// A cloud cut along its curves and points into cells.
///
/// Strata, skeleton and chosen landmarks are made once; [`waist`](WaistProducer::waist) describes the
/// surroundings of every landmark.
pub struct Cut<'a, 'p, S: Scalar> {
    analyzer: &'p Analyzer<'a, S>,
    strata: Strata,
    skeleton: Skeleton,
    labels: Labels,
    contacts: Contacts,
    chosen: Vec<usize>,
    charts: ChartSpace<'a, S>,
    options: StratifyOptions,
}

impl<'a, 'p, S: Scalar> Cut<'a, 'p, S> {
    /// Lays the skeleton and chooses landmarks.
    ///
    /// `charts` gives the extent of the neighborhoods and the distances inside them.
    ///
    /// # Errors
    /// [`Error::Parameter`] for lengths that are not positive, [`Error::Shape`] for charts in places where
    /// there are none, [`Error::Law`] for what a plug-in breaks; those of the selector.
    pub fn new(
        analyzer: &'p Analyzer<'a, S>,
        analysis: &Analysis,
        charts: ChartSpace<'a, S>,
        selector: &dyn LandmarkSelector<Scalar = S>,
        options: &StratifyOptions,
    ) -> Result<Self, Error> {
        options.check()?;
        if let ChartSpace::Metric(space) = &charts {
            space.audit_metric()?;
        }
        let Analyzer {
            space,
            tuning,
            execute,
            ..
        } = analyzer;
        let dl = options.dl;
        let gap = 2.0 * tuning.skeleton.node_spacing * dl;
        let mut strata = Strata::of(analysis, space.places(), gap, dl);
        curve_ends::explain(analyzer, &mut strata)?;
        let skeleton = Skeleton::lay(analyzer, &strata, dl)?;
        let chosen = landmarks::choose(analyzer, &strata, &skeleton, selector, dl, options.seed)?;
        let fits: Vec<&Reference> = skeleton.labelling().collect();
        let reach = tuning.cells.label_reach;
        let labels = Labels::new(strata.len(), strata.places(), &fits, reach, *execute);
        let contacts = Contacts::new(space, &strata, &skeleton, &tuning.cells, dl);
        Ok(Self {
            analyzer,
            strata,
            labels,
            contacts,
            skeleton,
            chosen,
            charts,
            options: options.clone(),
        })
    }

    /// Rows of the landmarks: the skeleton's, the chosen ones, and those of `extra` that are regular.
    fn rows(&self, extra: &[usize]) -> Vec<usize> {
        let mut rows = self.skeleton.rows().to_vec();
        rows.extend(&self.chosen);
        let mut free = vec![true; self.strata.len()];
        self.chosen.iter().for_each(|&row| free[row] = false);
        for &row in extra {
            if row < self.strata.len() && self.strata.is_regular(row) && free[row] {
                rows.push(row);
            }
        }
        rows
    }
}

impl<S: Scalar> WaistProducer<S> for Cut<'_, '_, S> {
    fn strata(&self) -> &Strata {
        &self.strata
    }

    fn waist(&self, extra: &[usize]) -> Result<Stratification<S>, Error> {
        let rows = self.rows(extra);
        let on_curves = self.skeleton.rows().len();
        let mut strata = vec![2u8; rows.len()];
        strata[..on_curves].fill(1);
        strata[..self.skeleton.corners()].fill(0);
        let (neighborhoods, cut_edges) = Neighborhoods {
            analyzer: self.analyzer,
            strata: &self.strata,
            skeleton: &self.skeleton,
            labels: &self.labels,
            contacts: &self.contacts,
            charts: self.charts,
            rows: &rows,
            reach: self.options.tri_eps,
            dl: self.options.dl,
        }
        .find()?;
        let distances = within_charts(
            self.analyzer,
            &self.strata,
            &self.charts,
            &rows,
            &neighborhoods,
        )?;
        let members: usize = neighborhoods.iter().map(|x| x.members.len()).sum();
        Ok(Stratification {
            counts: StratifyCounts {
                landmarks: rows.len(),
                curve_landmarks: on_curves,
                corners: self.skeleton.corners(),
                curve_edges: self.skeleton.edges().len(),
                cut_edges,
                mean_members: members as f64 / neighborhoods.len().max(1) as f64,
            },
            waist: StratifiedLandmarks {
                strata,
                curve_edges: self.skeleton.edges().to_vec(),
                neighborhoods,
                distances,
            },
            points: (self.skeleton).points(&self.strata, self.analyzer.models),
            rows,
        })
    }
}
