//! From strata to the narrow waist: landmarks, their neighborhoods, distances.

use super::analysis::{Analysis, Analyzer, ModelCounts};
use super::atlas::Reference;
use super::cells::{Contacts, Found, Labels, Neighborhoods};
use super::charts::ChartSpace;
use super::curve_ends;
use super::distances::{Asked, within_charts};
use super::landmarks;
use super::producer::WaistProducer;
use super::skeleton::Skeleton;
use super::strata::Strata;
use super::stratification::{PointStratum, Stratification};
use crosscap_core::{
    CellNeighborhood, Error, Landmark, LandmarkSelector, PointCloud, Row, Scalar,
    StratifiedLandmarks, Table, positive_length,
};
use std::sync::{Mutex, PoisonError};

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
        positive_length("dl", self.dl)?;
        positive_length("tri-eps", self.tri_eps).map(drop)
    }
}

/// A cloud cut along its curves and points into cells.
///
/// Strata, skeleton and chosen landmarks are made once; [`waist`](WaistProducer::waist) describes the
/// surroundings of every landmark.
pub struct Cut<'a, 'p, S: Scalar> {
    pub(super) analyzer: &'p Analyzer<'a, S>,
    pub(super) strata: Strata,
    pub(super) skeleton: Skeleton,
    labels: Labels,
    pub(super) contacts: Contacts,
    chosen: Vec<Row>,
    charts: ChartSpace<'a, S>,
    pub(super) options: StratifyOptions,
    models: Vec<ModelCounts>,
    /// What the last waist asked for.
    asked: Mutex<Asked<S>>,
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
        let mut cut = Self::laid(analyzer, analysis, charts, options)?;
        cut.chosen = landmarks::choose(
            analyzer,
            &cut.strata,
            &cut.skeleton,
            selector,
            options.dl,
            options.seed,
        )?;
        Ok(cut)
    }

    /// The same without landmarks in cells, which somebody else chooses.
    ///
    /// # Errors
    /// Those of [`new`](Self::new) but the selector's.
    pub fn laid(
        analyzer: &'p Analyzer<'a, S>,
        analysis: &Analysis,
        charts: ChartSpace<'a, S>,
        options: &StratifyOptions,
    ) -> Result<Self, Error> {
        options.check()?;
        // The analysis has looked at its own space.
        let own = &analyzer.space;
        if let Some(space) = charts.space().filter(|space| !space.is_same_as(own)) {
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
        let models = curve_ends::explain(analyzer, analysis, &mut strata)?;
        let skeleton = Skeleton::lay(analyzer, &strata, dl)?;
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
            chosen: Vec::new(),
            charts,
            options: options.clone(),
            models,
            asked: Mutex::default(),
        })
    }

    /// A surface without curves, given its landmarks.
    ///
    /// # Errors
    /// [`Error::Parameter`] for lengths that are not positive.
    pub(crate) fn among(
        analyzer: &'p Analyzer<'a, S>,
        charts: ChartSpace<'a, S>,
        landmarks: Vec<Row>,
        options: &StratifyOptions,
    ) -> Result<Self, Error> {
        options.check()?;
        let space = &analyzer.space;
        let strata = Strata::as_found(&Analysis::of_surface(space.len()), space.places());
        let skeleton = Skeleton::default();
        let (tuning, dl) = (&analyzer.tuning.cells, options.dl);
        let places = strata.places();
        let labels = Labels::new(
            strata.len(),
            places,
            &[],
            tuning.label_reach,
            analyzer.execute,
        );
        Ok(Self {
            contacts: Contacts::new(space, &strata, &skeleton, tuning, dl),
            analyzer,
            strata,
            labels,
            skeleton,
            chosen: landmarks,
            charts,
            options: options.clone(),
            models: Vec::new(),
            asked: Mutex::default(),
        })
    }

    /// The neighborhoods of some of the landmarks of a surface without curves, and how wide their charts are.
    ///
    /// # Errors
    /// [`Error::Law`] for what a plug-in breaks.
    pub(crate) fn neighborhoods(
        &self,
        wanted: &Table<Landmark, bool>,
    ) -> Result<(Vec<CellNeighborhood>, Vec<f64>), Error> {
        let rows = self.rows(&[]);
        let found = self.around(&rows).find(&|k| wanted[k])?;
        Ok((found.neighborhoods, found.radii))
    }

    /// What the neighborhoods of landmarks are found from.
    pub(super) fn around<'n>(&'n self, rows: &'n Table<Landmark, Row>) -> Neighborhoods<'n, 'a, S> {
        Neighborhoods {
            analyzer: self.analyzer,
            strata: &self.strata,
            skeleton: &self.skeleton,
            labels: &self.labels,
            contacts: &self.contacts,
            charts: self.charts,
            rows,
            reach: self.options.tri_eps,
            dl: self.options.dl,
        }
    }

    /// Rows of the landmarks: the skeleton's, the chosen ones, and those of `extra` that are regular.
    fn rows(&self, extra: &[Row]) -> Table<Landmark, Row> {
        let mut rows = self.skeleton.rows().clone();
        rows.extend(self.chosen.iter().copied());
        let mut free: Table<Row, bool> = Table::filled(self.strata.len(), true);
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
    fn may_add(&self, row: Row) -> bool {
        row.index() < self.strata.len() && self.strata.is_regular(row)
    }

    fn places(&self) -> Option<&PointCloud<f64>> {
        self.strata.places()
    }

    fn waist(&self, extra: &[Row]) -> Result<Stratification<S>, Error> {
        let rows = self.rows(extra);
        let strata = self.dimensions(rows.len());
        let Found {
            neighborhoods,
            cut_edges,
            ..
        } = self.around(&rows).find(&|_| true)?;
        let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        let distances = within_charts(
            self.analyzer,
            &self.strata,
            &self.charts,
            &rows,
            &neighborhoods,
            &mut asked,
        )?;
        drop(asked);
        let edges = self.skeleton.edges().to_vec();
        let waist = StratifiedLandmarks::new(strata, edges, neighborhoods, distances)?;
        let mut out = Stratification::new(waist, rows);
        out.counts.cut_edges = cut_edges;
        out.points = self.points();
        out.models = self.models.clone();
        Ok(out)
    }
}

impl<S: Scalar> Cut<'_, '_, S> {
    /// Dimensions of the strata that so many landmarks are on, those of the skeleton first.
    pub(crate) fn dimensions(&self, landmarks: usize) -> Table<Landmark, u8> {
        let mut strata = Table::filled(landmarks, 2);
        strata.as_mut_slice()[..self.skeleton.rows().len()].fill(1);
        strata.as_mut_slice()[..self.skeleton.corners()].fill(0);
        strata
    }

    /// What became of the models that were asked about the ends of curves.
    pub(crate) fn models(&self) -> &[ModelCounts] {
        &self.models
    }

    /// The points that models call 0-strata.
    pub(crate) fn points(&self) -> Vec<PointStratum> {
        (self.skeleton).points(&self.strata, self.analyzer.models)
    }
}
