//! The preprocessing of Martin & Watson (2011) to the letter, for comparison.
//!
//! What the paper does not say is decided here as follows.
//! - A neighborhood of dimension 0, 1 or more than 3, or of dimension 3 whose fit is rejected, stays
//!   undivided: B0 is empty and B1 is all of it.
//! - A fit is rejected when the planes are not real, when there are fewer than 10 points (the quadric
//!   has 9 degrees of freedom), or when the *root* mean squared distance to the nearer plane exceeds dp.
//! - Where the triangulation has a radius of its own, planes are fitted to the ball of eps and
//!   divide the larger ball; which points are on curves is decided with eps alone.
//! - A landmark on a curve is laid out in its own B0 where that holds it, otherwise in the B0 of the
//!   nearest point whose B0 holds it. It is joined to the nearest landmark on either side in the
//!   chart, unless an edge leads to that side already. A side without landmarks stays free.
//! - A given boundary point counts as a curve point, its B0 is the boundary points in its ball,
//!   and an edge between two boundary landmarks bounds one cell. Any other curve edge bounds four.

mod divide;
#[cfg(test)]
mod tests;
mod waist;

pub use waist::PublishedCut;

use super::analysis::{Analysis, Analyzer, Fitter, Scratch, marked};
use super::charts::ChartSpace;
use super::producer::WaistProducer;
use super::site::{FitUsed, On, Site, StratumKind};
use super::stratifier::{Ground, Stratifier};
use crosscap_core::{Error, LandmarkSelector, LocalChart, Radii, Row, Scalar, Table};

/// Parameters of the published method, lengths in the unit of the data.
///
/// [`analyze`](Self::analyze) finds the points on curves, [`cut`](Self::cut) makes the producer of a waist,
/// which draws landmarks and describes their surroundings; triangulate with
/// [`Rules::PAPER`](crate::triangulate::Rules::PAPER),
/// [`MinimumCircumradius`](crate::triangulate::MinimumCircumradius) and without repair.
///
/// ```
/// use crosscap_algorithms::chart::ClassicalScaling;
/// use crosscap_algorithms::dimension::PrincipalComponents;
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::landmarks::RandomGreedy;
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
/// use crosscap_algorithms::space::Space;
/// use crosscap_algorithms::stratify::{
///     Analyzer, ChartSpace, Published, Tuning, WaistProducer,
/// };
/// use crosscap_core::PointCloud;
/// let grid = (0..100).flat_map(|k| [f64::from(k % 10), f64::from(k / 10), 0.0]);
/// let cloud = PointCloud::new(3, grid.collect())?;
/// let metric = Euclidean::new(cloud.clone());
/// let oracle = BruteForceOracle::new(&metric);
/// let estimator = PrincipalComponents::new(0.05)?;
/// let analyzer = Analyzer {
///     space: Space::new(&metric, &oracle), estimator: &estimator,
///     models: &[], execute: &Serial, tuning: &Tuning::MEASURED,
/// };
/// let method = Published {
///     eps: 3.0, tri_eps: 3.0, dp: 0.1, ep: 0.1, dl: 1.5, seed: 1, surface: false, boundary: vec![],
/// };
/// let analysis = method.analyze(&analyzer)?;
/// let selector = RandomGreedy::new();
/// let cut = method.cut(&analyzer, &analysis, ChartSpace::Places, &selector, &ClassicalScaling)?;
/// assert_eq!(cut.waist(&[])?.counts.curve_landmarks, 0);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Published {
    /// Radius of the neighborhoods of dimension estimate and fit (strict).
    pub eps: f64,
    /// Radius of the neighborhoods that are triangulated (strict); eps in all but one of the
    /// paper's examples.
    pub tri_eps: f64,
    /// Largest root mean squared distance of a neighborhood to its planes.
    pub dp: f64,
    /// A point closer than this to both planes is on the curve (strict).
    pub ep: f64,
    /// Landmark separation.
    pub dl: f64,
    /// Seed of the landmark selection.
    pub seed: u64,
    /// Take every point as 2-dimensional and look for no curve.
    pub surface: bool,
    /// Rows that lie on the boundary.
    pub boundary: Vec<Row>,
}

impl Published {
    fn check(&self) -> Result<(), Error> {
        let lengths = [
            ("eps", self.eps),
            ("tri-eps", self.tri_eps),
            ("dp", self.dp),
            ("ep", self.ep),
            ("dl", self.dl),
        ];
        for (name, value) in lengths {
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

    /// Dimension of every neighborhood and the union of all B0 (the paper's sections 2.1, 2.2.1).
    /// No point is moved; the models of `analyzer` are not asked.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is not positive, [`Error::Index`] for a boundary row out
    /// of range, those of the dimension estimator.
    ///
    /// O(n k N^2) for k points in a neighborhood.
    pub fn analyze<S: Scalar>(&self, analyzer: &Analyzer<'_, S>) -> Result<Analysis, Error> {
        self.check()?;
        let n = analyzer.space.len();
        let boundary = marked(&self.boundary, n)?;
        let mut out = Analysis::of_boundary(&boundary);
        if self.surface {
            return Ok(out);
        }
        let fitter = analyzer.fitter("since planes are fitted in them")?;
        let balls = fitter.dimensions(Radii::Same(self.eps))?;
        let found = analyzer
            .space
            .map(analyzer.execute, Scratch::default, |scratch, i| {
                (balls[i].dimension == 3)
                    .then(|| self.singular_part(&fitter, Row::new(i), scratch))
                    .flatten()
            });
        let mut on_curve: Table<Row, bool> = Table::filled(n, false);
        let mut total = 0usize;
        for ((row, ball), curve) in boundary.ids().zip(&balls).zip(found) {
            let dimension = ball.dimension as u8;
            out.dimensions[row] = dimension;
            total += ball.neighbors as usize;
            match curve {
                Some(rows) => rows.iter().for_each(|&r| on_curve[r] = true),
                None if dimension != 2 => out.unexplained.push(row),
                None => {}
            }
        }
        out.mean_neighbors = total as f64 / n.max(1) as f64;
        for row in on_curve.ids().filter(|&row| on_curve[row]) {
            let kind = match boundary[row] {
                true => StratumKind::Point,
                false => StratumKind::Curve,
            };
            out.sites[row] = Site::On(Box::new(self.on(kind)));
        }
        Ok(out)
    }

    /// A point on a curve of two sheets: it stays where it is, and four cells meet there.
    fn on(&self, kind: StratumKind) -> On {
        On {
            kind,
            place: None,
            moved: 0.0,
            fit: Some(FitUsed {
                model: 0,
                radius: self.eps,
            }),
            cells: 4,
        }
    }

    /// The B0 of a neighborhood, where it can be divided.
    fn singular_part<S: Scalar>(
        &self,
        fitter: &Fitter<'_, S>,
        i: Row,
        scratch: &mut Scratch<S>,
    ) -> Option<Vec<Row>> {
        let parts = self.divide(fitter, i, self.eps, scratch)?;
        let on_curve = parts.iter().filter(|p| p.on_curve(self.ep));
        Some(on_curve.map(|p| p.row).collect())
    }

    /// The producer of a waist (the paper's section 2.2). `analysis` is that of [`Self::analyze`] with the
    /// same parameters; `charts` measures distances inside the neighborhoods.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is not positive, [`Error::Shape`] for an analysis of another
    /// number of points.
    pub fn cut<'a, 'p, S: Scalar>(
        &self,
        analyzer: &'p Analyzer<'a, S>,
        analysis: &'p Analysis,
        charts: ChartSpace<'a, S>,
        selector: &'p dyn LandmarkSelector<Scalar = S>,
        chart: &'p dyn LocalChart,
    ) -> Result<PublishedCut<'a, 'p, S>, Error> {
        self.check()?;
        PublishedCut::new(self.clone(), analyzer, analysis, charts, (selector, chart))
    }
}

/// The published method as a [`Stratifier`], with the parameters of the ground. Models are not asked.
#[derive(Clone, Copy, Debug, Default)]
pub struct PublishedMethod;

impl PublishedMethod {
    fn of<S: Scalar>(ground: &Ground<'_, S>) -> Published {
        Published {
            eps: ground.analysis.eps,
            tri_eps: ground.options.tri_eps,
            dp: ground.dp,
            ep: ground.ep,
            dl: ground.options.dl,
            seed: ground.options.seed,
            surface: ground.analysis.surface,
            boundary: ground.analysis.boundary.clone(),
        }
    }
}

impl<S: Scalar> Stratifier<S> for PublishedMethod {
    fn analyze(&self, ground: &Ground<'_, S>) -> Result<Analysis, Error> {
        Self::of(ground).analyze(&ground.analyzer)
    }

    fn cut<'p>(
        &'p self,
        ground: &'p Ground<'p, S>,
        analysis: &'p Analysis,
    ) -> Result<Box<dyn WaistProducer<S> + 'p>, Error> {
        let Ground {
            analyzer,
            charts,
            selector,
            chart,
            ..
        } = ground;
        let method = Self::of(ground);
        let cut = method.cut(analyzer, analysis, *charts, *selector, *chart)?;
        Ok(Box::new(cut))
    }

    fn name(&self) -> &str {
        "paper"
    }
}
