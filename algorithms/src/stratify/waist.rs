//! From strata to the narrow waist: landmarks, their neighborhoods, distances.

use super::analysis::{Analysis, Analyzer};
use super::atlas::Reference;
use super::cells::{Contacts, Labels, Neighborhoods};
use super::distances::within_charts;
use super::landmarks;
use super::skeleton::Skeleton;
use super::strata::Strata;
use crate::space::Space;
use crosscap_core::{Error, LandmarkSelector, Link, PointCloud, Scalar, StratifiedLandmarks};
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
#[non_exhaustive]
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

impl<S: Scalar> Stratification<S> {
    /// A waist and the rows that its landmarks stand for, counted.
    pub fn new(waist: StratifiedLandmarks<S>, rows: Vec<usize>) -> Self {
        let members: usize = waist.neighborhoods.iter().map(|x| x.members.len()).sum();
        let of = |least: u8| waist.strata.iter().filter(|&&d| d <= least).count();
        Self {
            counts: StratifyCounts {
                landmarks: rows.len(),
                curve_landmarks: of(1),
                corners: of(0),
                curve_edges: waist.curve_edges.len(),
                cut_edges: 0,
                mean_members: members as f64 / waist.neighborhoods.len().max(1) as f64,
            },
            waist,
            rows,
            points: Vec::new(),
        }
    }

    /// Whether this can be what a producer of waists named `plugin` makes of so many `points`: every landmark stands for a
    /// row of its own, and strata of dimension 0 are at landmarks. What the waist itself must satisfy,
    /// [`StratifiedLandmarks::check`] says.
    ///
    /// # Errors
    /// [`Error::Law`] for the first landmark of which it is not true.
    pub fn check(&self, plugin: &str, points: usize) -> Result<(), Error> {
        let broken = |landmark: usize, detail: String| {
            Err(Error::Law {
                plugin: plugin.into(),
                law: "answer: every landmark stands for a row of its own, and points are at landmarks",
                point: landmark,
                detail,
            })
        };
        let count = self.waist.strata.len();
        if self.rows.len() != count {
            let detail = format!("{} rows for {count} landmarks", self.rows.len());
            return broken(0, detail);
        }
        let mut seen = vec![false; points];
        for (k, &row) in self.rows.iter().enumerate() {
            match seen.get_mut(row) {
                Some(taken) if !*taken => *taken = true,
                Some(_) => return broken(k, format!("row {row} has a landmark already")),
                None => return broken(k, format!("row {row} of {points}")),
            }
        }
        let stray = self.points.iter().find(|p| {
            let stratum = self.waist.strata.get(p.landmark as usize);
            stratum != Some(&0)
        });
        match stray {
            Some(p) => {
                let k = p.landmark as usize;
                broken(
                    k,
                    format!("a point at landmark {k} of {count}, which is none"),
                )
            }
            None => Ok(()),
        }
    }
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
/// # Why it has this shape
/// Triangles show where landmarks are missing, so a waist is asked for more than once; what is the same
/// every time (strata, curves, the landmarks that were chosen) belongs into the producer, what depends on the landmarks
/// into [`waist`](Self::waist). Coordinates are not in a waist, but a mesh has them: the
/// producer says where the rows lie that its landmarks stand for.
///
/// # Laws
/// - *answer*: a waist that passes [`Stratification::check`];
/// - *extra*: a row of `extra` that [may be added](Self::may_add) is a landmark;
/// - *independence*: a waist does not depend on those that were made before.
pub trait WaistProducer<S: Scalar> {
    /// The waist, with the rows `extra` as landmarks whatever their separation, those that may not be added left out.
    ///
    /// # Errors
    /// Those of the producer.
    fn waist(&self, extra: &[usize]) -> Result<Stratification<S>, Error>;

    /// Whether a row may be a landmark beside those that were chosen. As it stands none may, and where triangles stray from
    /// the points they stay as they are.
    fn may_add(&self, _row: usize) -> bool {
        false
    }

    /// Places of all rows, where some of them were moved; `None` where every row is at its point.
    fn places(&self) -> Option<&PointCloud<f64>> {
        None
    }
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
        let strata = Strata::of(analysis, space.places(), gap, dl);
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
            if self.may_add(row) && free[row] {
                rows.push(row);
            }
        }
        rows
    }
}

impl<S: Scalar> WaistProducer<S> for Cut<'_, '_, S> {
    fn may_add(&self, row: usize) -> bool {
        row < self.strata.len() && self.strata.is_regular(row)
    }

    fn places(&self) -> Option<&PointCloud<f64>> {
        self.strata.places()
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
        let waist = StratifiedLandmarks {
            strata,
            curve_edges: self.skeleton.edges().to_vec(),
            neighborhoods,
            distances,
        };
        let mut out = Stratification::new(waist, rows);
        out.counts.cut_edges = cut_edges;
        out.points = (self.skeleton).points(&self.strata, self.analyzer.models);
        Ok(out)
    }
}
