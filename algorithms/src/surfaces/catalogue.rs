//! The catalogue of sample surfaces.

use super::curves::{
    DoubleBubble, circle_of_spheres, equilateral_centers, henneberg_arcs, klein_circle, rim_curves,
    roman_segments, torus_sphere_circles, torus_through_torus, triple_points_of_three_spheres,
};
use super::sample::draw;
use super::singular::singular_surfaces;
use super::{
    BoySurface, CurveKind, Cylinder, Henneberg, KleinFigureEight, MoebiusStrip, PaperExample,
    Piece, PieceTruth, PointKind, ProjectivePlane, Rectangle, Ring, RomanSurface, Sample, Sampling,
    SamplingLaw, Segment, SphereCap, SwissRoll, Torus, TrueCurve, TruePoint, Truth, TwoHoledTorus,
};
use crosscap_core::{Error, PointCloud};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

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
    /// The surface of the given name or alias; letters' case and the difference of `-` and `_` do not matter.
    ///
    /// # Errors
    /// [`Error::Parameter`] that lists the names there are.
    pub fn find(name: &str) -> Result<Self, Error> {
        let plain = |s: &str| s.to_ascii_lowercase().replace('-', "_");
        let wanted = plain(name);
        let mut all = catalogue();
        let at = all
            .iter()
            .position(|s| plain(s.name) == wanted || s.aliases.iter().any(|a| plain(a) == wanted));
        match at {
            Some(at) => Ok(all.swap_remove(at)),
            None => Err(Error::Parameter {
                name: "surface",
                value: name.into(),
                expected: format!(
                    "one of {}",
                    all.iter().map(|s| s.name).collect::<Vec<_>>().join(", ")
                ),
            }),
        }
    }

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

    /// Draws a sample. O(count) for the drawing, see [`super::thin`] for the thinning.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a count of 0, a spacing that is not positive, a noise that is negative
    /// or not finite.
    pub fn sample(&self, sampling: &Sampling) -> Result<Sample, Error> {
        draw(self, sampling)
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

    fn paper_example(mut self, paper: PaperExample) -> Self {
        self.defaults.count = paper.count;
        self.defaults.thinning = paper.thinning;
        self.paper = Some(paper);
        self
    }

    fn law(mut self, law: SamplingLaw) -> Self {
        self.defaults.law = law;
        self
    }
}

pub(super) const SPHERE: PieceTruth = kind("sphere", true, 2, 0);
const TORUS: PieceTruth = kind("torus", true, 0, 0);
pub(super) const DISC: PieceTruth = kind("disc", true, 1, 1);
pub(super) const ANNULUS: PieceTruth = kind("annulus", true, 0, 2);
const KLEIN: PieceTruth = kind("klein bottle", false, 0, 0);
const GENUS_2: PieceTruth = kind("double torus", true, -2, 0);
const MOEBIUS: PieceTruth = kind("moebius strip", false, 0, 1);
pub(super) const SEGMENT: PieceTruth = kind("segment", true, 1, 0);
pub(super) const PROJECTIVE: PieceTruth = kind("projective plane", false, 1, 0);

const fn kind(name: &'static str, orientable: bool, euler: i64, boundaries: usize) -> PieceTruth {
    PieceTruth {
        name,
        orientable,
        euler,
        boundaries,
    }
}

/// Truth of a surface without torsion or singular strata.
pub(super) const fn plain(
    betti: [usize; 3],
    pieces: &'static [PieceTruth],
    boundary_curves: usize,
) -> Truth {
    Truth {
        betti,
        betti_mod_2: betti,
        torsion: &[],
        pieces,
        double_curves: 0,
        junction_curves: 0,
        boundary_curves,
        triple_points: 0,
        isolated_crossings: 0,
        pinch_points: 0,
        books: 0,
        creases: 0,
    }
}

pub(super) const fn crossing(
    betti: [usize; 3],
    pieces: &'static [PieceTruth],
    double_curves: usize,
) -> Truth {
    Truth {
        double_curves,
        ..plain(betti, pieces, 0)
    }
}

const UNPRINTED: PaperExample = PaperExample {
    count: 0,
    thinning: None,
    count_after_thinning: None,
    epsilon: 0.0,
    triangulation_epsilon: None,
    dimension_tolerance: None,
    fit_tolerance: None,
    curve_tolerance: None,
    landmark_separation: 0.0,
    surface: false,
    boundary_given: false,
    landmarks: 0,
    mean_neighbors: 0,
    betti: [0; 3],
    seconds: [0.0; 2],
};

/// An example in which the paper takes every point as 2-dimensional.
const fn manifold(
    count: usize,
    epsilon: f64,
    landmark_separation: f64,
    landmarks: usize,
    mean_neighbors: usize,
    betti: [usize; 3],
    seconds: [f64; 2],
) -> PaperExample {
    PaperExample {
        count,
        epsilon,
        landmark_separation,
        landmarks,
        mean_neighbors,
        betti,
        seconds,
        surface: true,
        ..UNPRINTED
    }
}

/// Every sample surface: the paper's nine first, in the paper's order.
pub fn catalogue() -> Vec<SampleSurface> {
    let mut all = paper_surfaces();
    all.extend(further_surfaces());
    all.extend(singular_surfaces());
    all
}

fn paper_surfaces() -> Vec<SampleSurface> {
    let vertical = [0.0, 0.0, 1.0];
    let half = SQRT_2 / 2.0;
    let twin = [[-half, 0.0, 0.0], [half, 0.0, 0.0]];
    vec![
        SampleSurface::new(
            "sphere",
            "the unit sphere",
            vec![Box::new(SphereCap::sphere("sphere", [0.0; 3], 1.0))],
            plain([1, 0, 1], &[SPHERE], 0),
            0,
        )
        .paper_example(manifold(10_000, 0.4, 0.1, 886, 36, [1, 0, 1], [1.7, 368.2])),
        SampleSurface::new(
            "torus",
            "a torus, tube and hole of radius 1",
            vec![Box::new(Torus::new("torus", [0.0; 3], vertical, 2.0, 1.0))],
            plain([1, 2, 1], &[TORUS], 0),
            0,
        )
        .paper_example(manifold(10_000, 1.0, 0.3, 667, 28, [1, 2, 1], [1.1, 220.5])),
        SampleSurface::new(
            "double_torus",
            "a surface of genus 2, two tori side by side smoothly joined",
            vec![Box::new(TwoHoledTorus)],
            plain([1, 4, 1], &[GENUS_2], 0),
            0,
        )
        .also(&["genus_2", "two_holed_torus"])
        .paper_example(manifold(20_000, 1.2, 0.3, 813, 26, [1, 4, 1], [3.7, 263.1])),
        SampleSurface::new(
            "moebius",
            "the Moebius strip",
            vec![Box::new(MoebiusStrip)],
            plain([1, 1, 0], &[MOEBIUS], 1),
            0,
        )
        .also(&["mobius", "moebius_strip"])
        .paper_example(PaperExample {
            boundary_given: true,
            ..manifold(10_000, 0.4, 0.1, 416, 23, [1, 1, 0], [0.9, 123.7])
        }),
        SampleSurface::new(
            "klein_r5",
            "the Klein bottle embedded in R^5",
            vec![Box::new(KleinFigureEight::embedded())],
            Truth {
                betti_mod_2: [1, 2, 1],
                torsion: &[2],
                ..plain([1, 1, 0], &[KLEIN], 0)
            },
            0,
        )
        .also(&["klein_fig8_r5", "klein_embedded"])
        .paper_example(manifold(
            10_000,
            1.0,
            0.25,
            1940,
            33,
            [1, 1, 0],
            [3.8, 778.0],
        )),
        SampleSurface::new(
            "rp2_r6",
            "the real projective plane embedded in R^6",
            vec![Box::new(ProjectivePlane)],
            Truth {
                betti_mod_2: [1, 1, 1],
                torsion: &[2],
                ..plain([1, 0, 0], &[PROJECTIVE], 0)
            },
            0,
        )
        .also(&["rp2", "projective_plane"])
        .paper_example(manifold(
            100_000,
            0.35,
            0.1,
            753,
            35,
            [1, 0, 0],
            [11.7, 302.0],
        )),
        SampleSurface::new(
            "two_spheres",
            "two unit spheres that cross at a right angle",
            twin.iter()
                .zip(["left sphere", "right sphere"])
                .map(|(&c, name)| Box::new(SphereCap::sphere(name, c, 1.0)) as Box<dyn Piece>)
                .collect(),
            crossing([1, 0, 3], &[SPHERE, SPHERE], 1),
            0,
        )
        .singular(move |m| vec![circle_of_spheres(CurveKind::Double, twin, [1.0; 2], m)])
        .paper_example(PaperExample {
            count: 200_000,
            thinning: Some(0.01),
            count_after_thinning: Some(83_646),
            epsilon: 0.25,
            dimension_tolerance: Some(0.05),
            fit_tolerance: Some(0.05),
            curve_tolerance: Some(0.05),
            landmark_separation: 0.1,
            landmarks: 1588,
            mean_neighbors: 13,
            betti: [1, 0, 3],
            seconds: [446.4, 344.4],
            ..UNPRINTED
        }),
        SampleSurface::new(
            "klein_immersion",
            "the figure-8 Klein bottle immersed in R^3",
            vec![Box::new(KleinFigureEight::immersed())],
            crossing([1, 2, 1], &[KLEIN], 1),
            0,
        )
        .also(&["klein_fig8_r3", "klein_r3"])
        .singular(klein_circle)
        .law(SamplingLaw::Parameters)
        .paper_example(PaperExample {
            count: 100_000,
            thinning: Some(0.025),
            count_after_thinning: Some(61_440),
            epsilon: 0.2,
            triangulation_epsilon: Some(0.4),
            dimension_tolerance: Some(0.075),
            fit_tolerance: Some(0.05),
            curve_tolerance: Some(0.025),
            landmark_separation: 0.15,
            landmarks: 4566,
            mean_neighbors: 14,
            betti: [1, 2, 1],
            seconds: [295.7, 1183.3],
            ..UNPRINTED
        }),
        SampleSurface::new(
            "henneberg",
            "a ring of Henneberg's minimal surface",
            vec![Box::new(Henneberg)],
            Truth {
                boundary_curves: 2,
                ..crossing([1, 5, 0], &[ANNULUS], 4)
            },
            0,
        )
        .singular(henneberg_arcs)
        .paper_example(PaperExample {
            count: 100_000,
            thinning: Some(0.25),
            count_after_thinning: Some(13_637),
            epsilon: 4.0,
            dimension_tolerance: Some(0.05),
            fit_tolerance: Some(1.0),
            curve_tolerance: Some(0.25),
            landmark_separation: 0.75,
            boundary_given: true,
            landmarks: 1463,
            mean_neighbors: 39,
            betti: [1, 5, 0],
            seconds: [40.9, 723.4],
            ..UNPRINTED
        }),
    ]
}

/// Axis vectors `a` and `b` of R^`n`.
pub(super) fn axes(n: usize, a: usize, b: usize) -> [Vec<f64>; 2] {
    [a, b].map(|axis| (0..n).map(|k| if k == axis { 1.0 } else { 0.0 }).collect())
}

fn further_surfaces() -> Vec<SampleSurface> {
    let vertical = [0.0, 0.0, 1.0];
    let centers = equilateral_centers();
    let bubble = DoubleBubble::new(1.0, 0.8);
    let wide = Torus::new("wide torus", [0.0; 3], vertical, 2.0, 1.0);
    let thin = Torus::new("thin torus", [4.0, 0.0, 0.0], [0.0, 1.0, 0.0], 2.0, 0.5);
    let pole = |k: usize| [bubble.centers[k], 0.0, 0.0];
    vec![
        SampleSurface::new(
            "three_spheres",
            "three unit spheres, centers one unit apart, with two triple points",
            centers
                .iter()
                .zip(["first sphere", "second sphere", "third sphere"])
                .map(|(&c, name)| Box::new(SphereCap::sphere(name, c, 1.0)) as Box<dyn Piece>)
                .collect(),
            Truth {
                triple_points: 2,
                ..crossing([1, 0, 7], &[SPHERE, SPHERE, SPHERE], 3)
            },
            60_000,
        )
        .triple(triple_points_of_three_spheres())
        .singular(move |m| {
            [(0, 1), (0, 2), (1, 2)]
                .map(|(a, b)| {
                    circle_of_spheres(CurveKind::Double, [centers[a], centers[b]], [1.0; 2], m)
                })
                .into()
        }),
        SampleSurface::new(
            "double_bubble",
            "the standard double bubble, radii 1 and 0.8: three caps that meet at 120 degrees",
            vec![
                Box::new(SphereCap::cap("large cap", pole(0), bubble.radii[0], [-1.0, 0.0, 0.0], bubble.angles[0])),
                Box::new(SphereCap::cap("small cap", pole(1), bubble.radii[1], [1.0, 0.0, 0.0], bubble.angles[1])),
                Box::new(SphereCap::cap("film", pole(2), bubble.radii[2], [-1.0, 0.0, 0.0], bubble.angles[2])),
            ],
            Truth {
                junction_curves: 1,
                ..plain([1, 0, 2], &[DISC, DISC, DISC], 0)
            },
            40_000,
        )
        .singular(move |m| bubble.junction(m)),
        SampleSurface::new(
            "planes_r4",
            "two unit discs in R^4 that cross in one point",
            vec![
                Box::new(Ring::new("first disc", vec![0.0; 4], axes(4, 0, 1), [0.0, 1.0])),
                Box::new(Ring::new("second disc", vec![0.0; 4], axes(4, 2, 3), [0.0, 1.0])),
            ],
            Truth {
                isolated_crossings: 1,
                ..plain([1, 0, 0], &[DISC, DISC], 2)
            },
            10_000,
        ),
        SampleSurface::new(
            "line_disc",
            "a segment through the middle of a unit disc",
            vec![
                Box::new(Ring::new("disc", vec![0.0; 3], axes(3, 0, 1), [0.0, 1.0])),
                Box::new(Segment::new("segment", [vec![0.0, 0.0, -1.0], vec![0.0, 0.0, 1.0]])),
            ],
            Truth {
                isolated_crossings: 1,
                ..plain([1, 0, 0], &[DISC, SEGMENT], 1)
            },
            5_000,
        ),
        SampleSurface::new(
            "hemisphere",
            "half of the unit sphere",
            vec![Box::new(SphereCap::cap("hemisphere", [0.0; 3], 1.0, vertical, FRAC_PI_2))],
            plain([1, 0, 0], &[DISC], 1),
            5_000,
        ),
        SampleSurface::new(
            "annulus",
            "a flat ring of radii 0.5 and 1",
            vec![Box::new(Ring::new("annulus", vec![0.0; 3], axes(3, 0, 1), [0.5, 1.0]))],
            plain([1, 1, 0], &[ANNULUS], 2),
            5_000,
        ),
        SampleSurface::new(
            "torus_sphere",
            "a torus that runs through a sphere",
            vec![
                Box::new(Torus::new("torus", [0.0; 3], vertical, 2.0, 1.0)),
                Box::new(SphereCap::sphere("sphere", [2.0, 0.0, 0.0], 1.6)),
            ],
            crossing([1, 2, 3], &[TORUS, SPHERE], 2),
            120_000,
        )
        .singular(|m| torus_sphere_circles(2.0, 1.0, 1.6, m)),
        SampleSurface::new(
            "two_tori",
            "a thin torus that runs once through the tube of a wide one",
            vec![Box::new(wide.clone()), Box::new(thin.clone())],
            crossing([1, 4, 3], &[TORUS, TORUS], 2),
            150_000,
        )
        // The thin core enters at (2, 0, 0), where its angle is that of the direction -x.
        .singular(move |m| torus_through_torus(&wide, &thin, angle_of_minus_x(&thin), FRAC_PI_2, m)),
        SampleSurface::new(
            "swiss_roll",
            "a strip wound in a spiral",
            vec![Box::new(SwissRoll::new(0.1, [1.5 * PI, 4.5 * PI], 10.0))],
            plain([1, 0, 0], &[DISC], 1),
            10_000,
        ),
        SampleSurface::new(
            "square",
            "a flat square of side 2",
            vec![Box::new(Rectangle::new("square", vec![0.0; 3], axes(3, 0, 1)))],
            plain([1, 0, 0], &[DISC], 1),
            5_000,
        ),
        SampleSurface::new(
            "cylinder",
            "a cylinder of radius 1 and height 2",
            vec![Box::new(Cylinder::new("cylinder", 1.0, 1.0))],
            plain([1, 1, 0], &[ANNULUS], 2),
            10_000,
        ),
        SampleSurface::new(
            "boy_surface",
            "Boy's surface: the projective plane immersed with one triple point",
            vec![Box::new(BoySurface)],
            Truth {
                triple_points: 1,
                ..crossing([1, 0, 1], &[PROJECTIVE], 1)
            },
            100_000,
        )
        .also(&["boy"])
        .triple(vec![vec![0.0; 3]]),
        SampleSurface::new(
            "roman",
            "Steiner's Roman surface: the projective plane with three double segments and six pinch points",
            vec![Box::new(RomanSurface)],
            Truth {
                triple_points: 1,
                pinch_points: 6,
                ..crossing([1, 0, 4], &[PROJECTIVE], 3)
            },
            50_000,
        )
        .also(&["roman_surface", "steiner"])
        .triple(vec![vec![0.0; 3]])
        .at(PointKind::Pinch, (0..6).map(|k| {
            (0..3).map(|axis| if axis == k / 2 { k as f64 % 2.0 - 0.5 } else { 0.0 }).collect()
        }))
        .singular(roman_segments),
    ]
}

/// Angle about its axis at which a torus reaches farthest towards -x.
fn angle_of_minus_x(torus: &Torus) -> f64 {
    (0..4)
        .map(|k| f64::from(k) * FRAC_PI_2)
        .min_by(|&a, &b| {
            let x = |t: f64| super::place_at(torus, [t, 0.0])[0];
            x(a).total_cmp(&x(b))
        })
        .unwrap_or(0.0)
}
