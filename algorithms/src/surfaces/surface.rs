//! A sample surface, with everything that is known about it.

use super::curves::rim_curves;
use super::sampling::Sampling;
use super::{PaperExample, Piece, PointKind, SamplingLaw, TrueCurve, TruePoint, Truth};
use crosscap_core::{Error, PointCloud};

type Curves = Box<dyn Fn(usize) -> Vec<TrueCurve> + Send + Sync>;

/// A surface to draw samples from, with everything that is known about it.
///
/// ```
/// use crosscap_algorithms::surfaces::{SampleSurface, Sampling};
/// let surface = SampleSurface::find("two_spheres").unwrap();
/// let sample = surface.sample(&Sampling::new(1000, 1)).unwrap();
/// assert_eq!(sample.points.len(), 1000);
/// assert!(surface.distances(&sample.points).unwrap().iter().all(|&d| d < 1e-12));
/// assert_eq!(surface.truth().betti, [1, 0, 3]);
/// ```
pub struct SampleSurface {
    name: &'static str,
    aliases: &'static [&'static str],
    summary: &'static str,
    pieces: Vec<Box<dyn Piece>>,
    rims_are_boundary: bool,
    singular: Option<Curves>,
    triple_points: Vec<Vec<f64>>,
    points: Vec<TruePoint>,
    boundary_arcs: Option<Curves>,
    truth: Truth,
    paper: Option<PaperExample>,
    defaults: Sampling,
}

impl SampleSurface {
    /// Name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Other names.
    pub fn aliases(&self) -> &'static [&'static str] {
        self.aliases
    }

    /// One line on what it is.
    pub fn summary(&self) -> &'static str {
        self.summary
    }

    /// N, the number of coordinates of a point.
    pub fn ambient_dimension(&self) -> usize {
        self.pieces[0].ambient_dimension()
    }

    /// The pieces, in the order of the labels of a sample.
    pub fn pieces(&self) -> &[Box<dyn Piece>] {
        &self.pieces
    }

    /// Topology.
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// The paper's parameters and results, for its nine surfaces.
    pub fn paper(&self) -> Option<&PaperExample> {
        self.paper.as_ref()
    }

    /// A sampling that suits the surface (the paper's where it is one of the paper's), with `seed`.
    pub fn default_sampling(&self, seed: u64) -> Sampling {
        Sampling {
            seed,
            ..self.defaults
        }
    }

    /// Whether it ends in whole rims of its pieces, on which a sample can have points of its own. Where only
    /// parts of rims are boundary (a plate that stands on another) it cannot.
    pub fn has_boundary(&self) -> bool {
        self.rims_are_boundary
    }

    /// Area of all pieces; curves do not count.
    pub fn area(&self) -> f64 {
        self.pieces
            .iter()
            .filter(|p| p.dimension() == 2)
            .map(|p| p.area())
            .sum()
    }

    /// Distance of every point to the surface, in the unit of the surface.
    ///
    /// # Errors
    /// [`Error::Shape`] for points of another dimension.
    pub fn distances(&self, cloud: &PointCloud<f64>) -> Result<Vec<f64>, Error> {
        if cloud.dimension() != self.ambient_dimension() {
            return Err(Error::Shape {
                found: format!("points of R^{}", cloud.dimension()),
                expected: format!("points of R^{}", self.ambient_dimension()),
            });
        }
        let mut nearest = vec![f64::INFINITY; cloud.len()];
        for piece in &self.pieces {
            for (n, d) in nearest.iter_mut().zip(piece.distances(cloud)) {
                *n = n.min(d);
            }
        }
        Ok(nearest)
    }

    /// Double curves, junctions of other numbers of cells and creases, each as `count` points exactly on it; `None` where no closed form is
    /// at hand (Boy's surface), empty where there are none.
    pub fn singular_curves(&self, count: usize) -> Option<Vec<TrueCurve>> {
        match &self.singular {
            Some(curves) => Some(curves(count)),
            None if self.truth.curves() == 0 => Some(Vec::new()),
            None => None,
        }
    }

    /// Boundary curves, each as `count` points exactly on it, at equal steps of arc length.
    pub fn boundary_curves(&self, count: usize) -> Vec<TrueCurve> {
        if let Some(arcs) = &self.boundary_arcs {
            return arcs(count);
        }
        if !self.rims_are_boundary {
            return Vec::new();
        }
        self.pieces
            .iter()
            .flat_map(|p| rim_curves(p.as_ref(), count))
            .collect()
    }

    /// The places where three sheets cross.
    pub fn triple_points(&self) -> &[Vec<f64>] {
        &self.triple_points
    }

    /// The other places at which the surface is like nowhere near: pinch points, ends of curves, corners,
    /// apexes.
    pub fn points(&self) -> &[TruePoint] {
        &self.points
    }

    pub(super) fn new(
        name: &'static str,
        summary: &'static str,
        pieces: Vec<Box<dyn Piece>>,
        truth: Truth,
        count: usize,
    ) -> Self {
        Self {
            name,
            aliases: &[],
            summary,
            pieces,
            rims_are_boundary: truth.boundary_curves > 0,
            singular: None,
            triple_points: Vec::new(),
            points: Vec::new(),
            boundary_arcs: None,
            truth,
            paper: None,
            defaults: Sampling {
                boundary: truth.boundary_curves > 0,
                ..Sampling::new(count, 0)
            },
        }
    }

    pub(super) fn also(mut self, aliases: &'static [&'static str]) -> Self {
        self.aliases = aliases;
        self
    }

    pub(super) fn singular(
        mut self,
        curves: impl Fn(usize) -> Vec<TrueCurve> + Send + Sync + 'static,
    ) -> Self {
        self.singular = Some(Box::new(curves));
        self
    }

    pub(super) fn triple(mut self, points: Vec<Vec<f64>>) -> Self {
        self.triple_points = points;
        self
    }

    /// The places of one kind of point.
    pub(super) fn at(
        mut self,
        kind: PointKind,
        places: impl IntoIterator<Item = Vec<f64>>,
    ) -> Self {
        let points = places.into_iter().map(|place| TruePoint { kind, place });
        self.points.extend(points);
        self
    }

    /// Boundary curves, where they are not the rims of the pieces.
    pub(super) fn bounded_by(
        mut self,
        curves: impl Fn(usize) -> Vec<TrueCurve> + Send + Sync + 'static,
    ) -> Self {
        self.rims_are_boundary = false;
        self.defaults.boundary = false;
        self.boundary_arcs = Some(Box::new(curves));
        self
    }

    /// The paper's parameters and results.
    pub(super) fn paper_example(mut self, paper: PaperExample) -> Self {
        self.defaults.count = paper.count;
        self.defaults.thinning = paper.thinning;
        self.paper = Some(paper);
        self
    }

    /// How points are spread unless it is said otherwise.
    pub(super) fn law(mut self, law: SamplingLaw) -> Self {
        self.defaults.law = law;
        self
    }
}
