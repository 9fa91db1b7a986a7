//! What can be wrong with a mesh, level by level.

use serde::Serialize;
use std::fmt;

/// Levels of validity, from the plainest to the one that needs the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// The arrays are those of a simplicial complex with distinct places.
    Indices,
    /// Every edge has the number of triangles that its stratum allows.
    Edges,
    /// Every vertex has a neighborhood of an admissible kind.
    Links,
    /// Triangles meet in common faces only.
    Geometry,
    /// Mesh and points are near each other, both ways.
    Cover,
    /// The mesh says no more than the points, in units of their spacing.
    Faithful,
    /// Triangles are not needles.
    Quality,
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Indices => "indices",
            Self::Edges => "edges",
            Self::Links => "links",
            Self::Geometry => "geometry",
            Self::Cover => "cover",
            Self::Faithful => "faithful",
            Self::Quality => "quality",
        })
    }
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ViolationKind {
    /// An option of the certificate itself has no meaning.
    Options,
    /// Number of vertices and number of places differ.
    Shape,
    /// There is no triangle.
    NoTriangles,
    /// A triangle or a curve edge names a vertex that does not exist.
    IndexOutOfRange,
    /// A triangle or a curve edge names a vertex twice.
    RepeatedCorner,
    /// A triangle is there twice.
    RepeatedTriangle,
    /// A curve edge is there twice.
    RepeatedCurveEdge,
    /// A vertex belongs to no triangle and no curve edge.
    IsolatedVertex,
    /// Two vertices at the same place.
    CoincidentVertices,
    /// An unmarked edge with one triangle: a hole, or a boundary that nobody declared.
    UndeclaredBoundary,
    /// An unmarked edge with three or more triangles.
    UndeclaredCurve,
    /// A curve edge whose number of triangles differs from its number of cells.
    WrongCount,
    /// A boundary edge on a surface that is known to be closed.
    BoundaryOfClosed,
    /// A boundary of so few edges that it is a missing triangle or two rather than a boundary.
    SmallHole,
    /// A link that is none of the admissible kinds.
    InadmissibleLink,
    /// A disconnected link where no crossing point was declared.
    SplitLink,
    /// A figure-eight link where no pinch point was declared.
    Pinch,
    /// A declared special point whose link is of another kind.
    SpecialPoint,
    /// A triangle without area.
    ZeroArea,
    /// Two triangles folded onto each other over an ordinary edge.
    Fold,
    /// Two edges of a curve without triangles lie on each other.
    BareFold,
    /// Two of the triangles at a curve edge lie on each other.
    CurveFold,
    /// Two triangles without a common edge lie on top of each other.
    Stacked,
    /// Two triangles meet outside their common faces (dimension up to 3, exact).
    SelfIntersection,
    /// Two triangles without a common vertex touch (dimension above 3).
    NearCrossing,
    /// So many triangles overlap that the pairs were not all looked at.
    Entangled,
    /// Points of the input that no part of the mesh is near: a hole.
    UncoveredPoints,
    /// Parts of the mesh that no point of the input is near.
    MeshFarFromPoints,
    /// The points next to a triangle lie far off its plane.
    MeshOffPoints,
    /// Landmarks that were selected and are not in the mesh.
    UnusedLandmarks,
    /// An empty region of the points that the mesh covers, and that chance does not explain: a hole, a slit
    /// or a cut.
    BridgedGap,
    /// A stretch of a curve without points that chance does not explain: there are two curves, or the curve ends before
    /// what the mesh joins it to.
    BareStretch,
    /// The end of a curve that points at something so near that chance may have left out the points before a joint: the curve
    /// may end there or be joined to it.
    UndecidedEnd,
    /// Two sheets of points, one over the other, that the mesh takes for one.
    MergedSheets,
    /// Vertices off the points of a sheet at them.
    VertexOffPoints,
    /// Two parts of the mesh that no edge joins, and whose points are as near to each other as points of one sheet: they may have a point
    /// or a curve in common.
    TouchingParts,
    /// A triangle with an angle of nearly zero.
    NeedleTriangle,
}

impl ViolationKind {
    /// The level that finds it.
    pub fn level(self) -> Level {
        use ViolationKind::*;
        match self {
            Options | Shape | NoTriangles | IndexOutOfRange | RepeatedCorner | RepeatedTriangle
            | RepeatedCurveEdge | IsolatedVertex | CoincidentVertices => Level::Indices,
            UndeclaredBoundary | UndeclaredCurve | WrongCount | BoundaryOfClosed | SmallHole => {
                Level::Edges
            }
            InadmissibleLink | SplitLink | Pinch | SpecialPoint => Level::Links,
            ZeroArea | Fold | BareFold | CurveFold | Stacked | SelfIntersection | NearCrossing
            | Entangled => Level::Geometry,
            UncoveredPoints | MeshFarFromPoints | MeshOffPoints | UnusedLandmarks => Level::Cover,
            BridgedGap | BareStretch | UndecidedEnd | MergedSheets | VertexOffPoints
            | TouchingParts => Level::Faithful,
            NeedleTriangle => Level::Quality,
        }
    }

    /// What it means, in a few words.
    pub fn meaning(self) -> &'static str {
        use ViolationKind::*;
        match self {
            Options => "options of the certificate without a meaning",
            Shape => "numbers of vertices, places and dimensions that do not fit together",
            NoTriangles => "no triangle at all",
            IndexOutOfRange => "vertex indices out of range",
            RepeatedCorner => "triangles or curve edges that name a vertex twice",
            RepeatedTriangle => "triangles that are there more than once",
            RepeatedCurveEdge => "curve edges that are there more than once",
            IsolatedVertex => "vertices without triangle or curve edge",
            CoincidentVertices => "vertices at the place of another vertex",
            UndeclaredBoundary => "ordinary edges with one triangle",
            UndeclaredCurve => "ordinary edges with three or more triangles",
            WrongCount => "curve edges with another number of triangles than of cells",
            BoundaryOfClosed => "boundary edges on a closed surface",
            SmallHole => "boundaries too short to be resolved",
            InadmissibleLink => "vertices with an inadmissible link",
            SplitLink => "vertices with an undeclared disconnected link",
            Pinch => "vertices with an undeclared figure-eight link",
            SpecialPoint => "declared special points with another link",
            ZeroArea => "triangles without area",
            Fold => "ordinary edges with a fold",
            BareFold => "vertices where a curve turns back on itself",
            CurveFold => "curve edges with two triangles on each other",
            Stacked => "pairs of stacked triangles",
            SelfIntersection => "pairs of triangles that cross",
            NearCrossing => "pairs of triangles without a common vertex that touch",
            Entangled => "triangles that overlap too many others to look at all pairs",
            UncoveredPoints => "input points far from the mesh",
            MeshFarFromPoints => "places of the mesh far from every input point",
            MeshOffPoints => "triangles off the input points next to them",
            UnusedLandmarks => "landmarks not in the mesh",
            BridgedGap => "gaps of the points that the mesh covers",
            BareStretch => "edges of curves where the points leave a gap",
            UndecidedEnd => "ends of curves that may be joined to what is ahead of them",
            MergedSheets => "vertices where two sheets of points are one in the mesh",
            VertexOffPoints => "vertices off the points around them",
            TouchingParts => "places where parts of the mesh touch by their points",
            NeedleTriangle => "triangles with an angle of nearly zero",
        }
    }

    /// Which parameter to change. Longer than a screen, as it is one table.
    pub fn advice(self) -> &'static str {
        use ViolationKind::*;
        match self {
            Options => "correct the options: lengths and limits are positive and finite",
            Shape => "give one place a vertex, and points of the same dimension as the mesh",
            NoTriangles => {
                "decrease the landmark separation dl, or increase the triangulation radius"
            }
            IndexOutOfRange | RepeatedCorner | RepeatedTriangle | RepeatedCurveEdge => {
                "correct the file or the program that wrote the arrays"
            }
            IsolatedVertex => {
                "increase the triangulation radius, or leave the landmark out of the mesh"
            }
            CoincidentVertices => {
                "remove repeated points, or increase the landmark separation dl on the curves"
            }
            UndeclaredBoundary => {
                "increase the triangulation radius to at least 3 dl, or give the boundary points"
            }
            UndeclaredCurve => {
                "decrease the curve tolerance eps_p or the dimension tolerance dt, so that the \
                 curve is found as one"
            }
            WrongCount => {
                "increase the triangulation radius, or move the curve tolerance eps_p: cells at \
                 the curve are incomplete or mixed"
            }
            BoundaryOfClosed => {
                "increase the triangulation radius, or decrease dl; drop the option if the \
                 surface does have a boundary"
            }
            SmallHole => {
                "increase the triangulation radius to close the hole, or decrease dl to resolve it"
            }
            InadmissibleLink | SplitLink | Pinch => {
                "decrease dl or the neighborhood radius eps, or move the curve tolerance eps_p"
            }
            SpecialPoint => "decrease dl around the special point, or do not declare it",
            ZeroArea | NeedleTriangle => {
                "increase dl relative to the noise, or remove nearly repeated points"
            }
            BareFold => "decrease dl: the curve has too few landmarks to show where it goes",
            Fold | CurveFold | Stacked => {
                "decrease the triangulation radius or dl: a chart folds, or two sheets are closer \
                 than the landmarks can tell apart"
            }
            SelfIntersection | NearCrossing => {
                "decrease dl, or increase the curve tolerance eps_p: a crossing was not found as \
                 a double curve"
            }
            Entangled => "decrease the triangulation radius: edges are far longer than dl",
            UncoveredPoints => {
                "increase the triangulation radius, or remove outliers from the points"
            }
            MeshFarFromPoints => {
                "decrease the triangulation radius or dl: triangles bridge empty space; \
                 increase dl where a curve without triangles has a hole in its points"
            }
            MeshOffPoints => {
                "decrease the triangulation radius or dl: triangles bridge empty space"
            }
            BridgedGap => "decrease dl, so that the mesh leaves the gap open",
            BareStretch => {
                "decrease dl and eps, so that the mesh leaves the gap open; or give more points of the curve"
            }
            UndecidedEnd => {
                "give more points of the curve at its end: it may stop there, or go on to what is ahead"
            }
            MergedSheets => "decrease dl and eps below the distance of the sheets",
            TouchingParts => {
                "let all models compete (the parts may have a point or a curve in common), or give more points there"
            }
            VertexOffPoints => "decrease dl or eps: the sheets bend within a neighborhood",
            UnusedLandmarks => "increase the triangulation radius, or decrease the noise",
        }
    }
}
