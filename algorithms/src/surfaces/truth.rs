//! What is known about a sample surface beforehand.

use crosscap_core::PointCloud;

/// What a piece is, as an abstract surface before it is immersed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PieceTruth {
    /// Its usual name.
    pub name: &'static str,
    /// Whether it has two sides to tell apart.
    pub orientable: bool,
    /// Euler characteristic.
    pub euler: i64,
    /// Number of boundary circles.
    pub boundaries: usize,
}

/// Topology of a sample surface, as a subset of R^N (self-crossings identified).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Truth {
    /// Betti numbers over the rational numbers.
    pub betti: [usize; 3],
    /// Betti numbers over the field of two elements.
    pub betti_mod_2: [usize; 3],
    /// Torsion coefficients of the first homology group over the integers.
    pub torsion: &'static [u64],
    /// The pieces, in the order of the labels of a sample.
    pub pieces: &'static [PieceTruth],
    /// Double curves (four cells meet): circles, or arcs that end on a boundary or in a pinch point.
    pub double_curves: usize,
    /// Curves where three cells meet.
    pub junction_curves: usize,
    /// Boundary circles of the immersed surface.
    pub boundary_curves: usize,
    /// Points where three sheets cross.
    pub triple_points: usize,
    /// Points where two sheets, or a sheet and a curve, meet and nothing else near them does.
    pub isolated_crossings: usize,
    /// Points where the surface is no immersion.
    pub pinch_points: usize,
    /// Curves where five or more cells meet.
    pub books: usize,
    /// Curves along which a sheet bends sharply.
    pub creases: usize,
}

impl Truth {
    /// Number of curves that are no boundary.
    pub(super) const fn curves(&self) -> usize {
        self.double_curves + self.junction_curves + self.books + self.creases
    }
}

/// Parameters of one of the paper's examples and what the paper printed for it (its sections 4 and 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperExample {
    /// Number of points drawn (before thinning).
    pub count: usize,
    /// Minimal spacing that the points were thinned to.
    pub thinning: Option<f64>,
    /// Number of points after thinning, as printed.
    pub count_after_thinning: Option<usize>,
    /// Radius of a neighborhood, eps.
    pub epsilon: f64,
    /// Radius for the triangulation, where it is another one.
    pub triangulation_epsilon: Option<f64>,
    /// Tolerance of the dimension estimate, dt.
    pub dimension_tolerance: Option<f64>,
    /// Tolerance of the two-plane fit, dp.
    pub fit_tolerance: Option<f64>,
    /// Tolerance of the double curve, eps_p.
    pub curve_tolerance: Option<f64>,
    /// Separation of the landmarks, dl. For the immersed Klein bottle it is not printed; 0.15 fits the
    /// printed numbers of landmarks and neighbors.
    pub landmark_separation: f64,
    /// Whether every point is taken as 2-dimensional.
    pub surface: bool,
    /// Whether the boundary points are given.
    pub boundary_given: bool,
    /// Number of landmarks, as printed.
    pub landmarks: usize,
    /// Mean number of landmarks in a neighborhood, as printed.
    pub mean_neighbors: usize,
    /// Betti numbers over the rational numbers, as printed.
    pub betti: [usize; 3],
    /// Seconds of preprocessing and of reconstruction, as printed (MATLAB, 2.26 GHz Xeon).
    pub seconds: [f64; 2],
}

/// What kind of curve a true curve is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// Two sheets cross: four cells meet.
    Double,
    /// Three cells meet.
    Junction,
    /// The surface ends: one cell.
    Boundary,
    /// A sheet bends sharply: two cells meet.
    Crease,
    /// Five or more cells meet.
    Book {
        /// Number of cells.
        cells: u8,
    },
}

impl CurveKind {
    /// Number of cells that meet in the curve.
    pub const fn cells(self) -> u8 {
        match self {
            Self::Boundary => 1,
            Self::Crease => 2,
            Self::Junction => 3,
            Self::Double => 4,
            Self::Book { cells } => cells,
        }
    }
}

/// What kind of point a true point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointKind {
    /// A double curve ends inside a sheet: the surface is no immersion there.
    Pinch,
    /// A curve of four or another number of cells ends where all its cells have a boundary.
    CurveEnd,
    /// The curve in which a sheet stands on another one ends inside that one.
    SideSheetEnd,
    /// Four curves of three cells each meet, and six cells.
    QuadrupleJunction,
    /// Three or more creases meet.
    Corner,
    /// The boundary turns by an angle.
    BoundaryCorner,
    /// A crease ends at the boundary.
    CreaseEnd,
    /// The tip of a cone: a sheet without a tangent plane.
    Apex,
    /// Two sheets, or a sheet and a curve, have this point alone in common.
    Isolated,
}

/// A point of the true surface at which it is like nowhere near.
#[derive(Clone, Debug, PartialEq)]
pub struct TruePoint {
    /// Its kind.
    pub kind: PointKind,
    /// Its place.
    pub place: Vec<f64>,
}

/// A curve of the true surface as a line of points on it.
#[derive(Clone, Debug, PartialEq)]
pub struct TrueCurve {
    /// Its kind.
    pub kind: CurveKind,
    /// Whether the last point is followed by the first.
    pub closed: bool,
    /// Points exactly on the curve, in order; the first is not repeated at the end.
    pub points: PointCloud<f64>,
}

pub(super) const SPHERE: PieceTruth = kind("sphere", true, 2, 0);
pub(super) const TORUS: PieceTruth = kind("torus", true, 0, 0);
pub(super) const DISC: PieceTruth = kind("disc", true, 1, 1);
pub(super) const ANNULUS: PieceTruth = kind("annulus", true, 0, 2);
pub(super) const KLEIN: PieceTruth = kind("klein bottle", false, 0, 0);
pub(super) const GENUS_2: PieceTruth = kind("double torus", true, -2, 0);
pub(super) const MOEBIUS: PieceTruth = kind("moebius strip", false, 0, 1);
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

/// Truth of closed pieces that cross in so many double curves.
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
