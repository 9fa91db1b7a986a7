//! The points on curves, as the published method finds them.

use crate::stratify::analysis::{Analysis, Analyzer, Fitter, Scratch, marked};
use crate::stratify::site::{FitUsed, On, Site, StratumKind};
use crosscap_core::{Error, Radii, Row, Scalar, Table, positive_length};

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
    pub(super) fn check(&self) -> Result<(), Error> {
        let lengths = [
            ("eps", self.eps),
            ("tri-eps", self.tri_eps),
            ("dp", self.dp),
            ("ep", self.ep),
            ("dl", self.dl),
        ];
        lengths
            .into_iter()
            .try_for_each(|(name, value)| positive_length(name, value).map(drop))
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
}
