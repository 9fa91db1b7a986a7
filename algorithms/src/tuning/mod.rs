//! The numbers that decide the method, one struct a stage.
//!
//! Lengths are shares of a parameter that the user sets (the radius eps of a neighborhood, the landmark
//! separation dl), so that none of them knows the unit of the data. What was measured is in the guide, chapter
//! on decisions; what is not said there to be measured was chosen once and never varied.

mod ends;
mod front;
mod models;
mod pages;
mod preparation;
mod tangents;

pub use ends::{
    BookEndTuning, BookTuning, BoundaryCornerTuning, CurveEndTuning, PinchPointTuning, RimTuning,
};
pub use front::FrontTuning;
pub use models::{
    BoundaryTuning, ConePointTuning, CurveAndSheetTuning, IsolatedCrossingTuning, ModelTuning,
    TriplePointTuning, TwoPlanesTuning, YJunctionTuning,
};
pub use pages::PagesTuning;

pub use preparation::{
    NoiseTuning, OutlierTuning, PreparationTuning, ProjectionTuning, ResolutionTuning,
    SubspaceTuning,
};

pub use tangents::TangentTuning;

use serde::{Deserialize, Serialize};

/// All of them. [`Tuning::MEASURED`] is what the program runs with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tuning {
    /// Which stratum every point is in.
    pub analysis: AnalysisTuning,
    /// Points in which curves end.
    pub ends: EndTuning,
    /// Landmarks and chains along the curves.
    pub skeleton: SkeletonTuning,
    /// Cells and the neighborhoods in them.
    pub cells: CellTuning,
    /// Stars that cannot be closed.
    pub front: FrontTuning,
    /// Landmarks added where triangles stray from the points.
    pub refinement: RefinementTuning,
    /// When the program's own models believe a fit.
    pub models: ModelTuning,
    /// Planes that tell which points are on one sheet, for metrics that ask: the graph is made before the stages.
    pub tangents: TangentTuning,
}

impl Tuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        analysis: AnalysisTuning::MEASURED,
        ends: EndTuning::MEASURED,
        skeleton: SkeletonTuning::MEASURED,
        cells: CellTuning::MEASURED,
        front: FrontTuning::MEASURED,
        refinement: RefinementTuning::MEASURED,
        models: ModelTuning::MEASURED,
        tangents: TangentTuning::MEASURED,
    };
}

impl Default for Tuning {
    fn default() -> Self {
        Self::MEASURED
    }
}

/// What decides which stratum a point is in. Shares are of the radius of the ball that is fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnalysisTuning {
    /// Fewest points of a neighborhood: a quadratic height has six coefficients.
    pub least_neighbors: usize,
    /// Most points that a model is fitted to: with more of them a fit takes longer and gets no better.
    pub most_fitted: usize,
    /// Factor by which a neighborhood shrinks when no model fits, because sheets bend too much in it.
    pub shrink: f64,
    /// How often it shrinks.
    pub shrinks: usize,
    /// Largest share of the residual of one sheet that a model with a curve may leave.
    pub gain: f64,
    /// One sheet is believed when its residual is below this share of the radius.
    pub flat: f64,
    /// Share of unexplained points from which the radius is declared unfit.
    pub unexplained_share: f64,
    /// A curve is looked for this close to its points where the dimension does not show it.
    pub beside: f64,
    /// A curve point this close to another one needs no look of its own beside it.
    pub beside_spacing: f64,
    /// Radius of the inner ball that says what its center is on where the whole ball, which may reach
    /// another stratum, is explained by no model of a curve.
    pub inner_ball: f64,
    /// A point farther than this from a curve bears no witness to it.
    pub witness_reach: f64,
    /// A point farther than this from a 0-stratum bears no witness to it.
    pub apex_reach: f64,
    /// Spacings of the centers of fits, in eps, one attempt after another for the points that are left over.
    /// At the end every one is the center of its own.
    pub fit_spacings: [f64; 2],
    /// A fit speaks for points this close to its center.
    pub speaks_for: f64,
    /// Points are labelled up to this many radii from a curve point, so that an edge across the limit of
    /// belief finds labels at both ends.
    pub label_margin: f64,
}

impl AnalysisTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        least_neighbors: 8,
        most_fitted: 256,
        shrink: 0.75,
        shrinks: 4,
        gain: 0.5,
        flat: 0.06,
        unexplained_share: 0.05,
        beside: 0.5,
        beside_spacing: 0.25,
        inner_ball: 0.5,
        witness_reach: 0.4,
        apex_reach: 0.5,
        fit_spacings: [0.3, 0.12],
        speaks_for: 0.42,
        label_margin: 1.4,
    };
}

/// What decides where double curves end. Shares are of the radius of the analysis unless said otherwise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EndTuning {
    /// A point of a curve is an end when the middle of the curve within the radius is off by more than this;
    /// it is 0.5 at the end of a straight curve, and 0 inside.
    pub shift: f64,
    /// Radii of the balls in which a model is asked, one after another until it answers. The last is smaller than the first: where a
    /// surface is narrow, wide balls hold corners and curves that no model of an end knows.
    pub radii: [f64; 6],
    /// How far behind the outermost point of a curve another one is that balls are laid about as well, in eps. Where a plate of 12
    /// spacings stood through another, its ends were 0.5 eps inside, and the ball about the outermost point held the rim of the other one.
    pub behind: f64,
    /// Widest ball, where a model asks for a wider one.
    pub widest: f64,
    /// A model that needs a wider ball gets one wider by this factor than it asks for.
    pub spare: f64,
    /// A ball whose center is farther than this share of its radius from the point that it shows is laid anew
    /// about that point.
    pub off_center: f64,
    /// How often a ball is laid anew.
    pub attempts: usize,
    /// Gaps of the curves about an end that are wider than this are filled by the points beside them.
    pub gap: f64,
    /// How far the labels of a region reach beyond it, in eps: farther than the edges of the graph that cells are flooded in.
    /// Without, no fit knew both ends of an edge across the cut between two regions, or across a strip between
    /// them, and the four cells were one there.
    pub overlap: f64,
    /// Farthest of the innermost landmarks of the cells about an end, in dl: with those of a random choice
    /// the triangle between two curves was often that of two cells.
    pub innermost: f64,
    /// Spacing of the points of a boundary that a corner is looked for about.
    pub corner_spacing: f64,
    /// Radii of the balls in which a corner of a boundary is looked for, one after another: the evidence grows with their area.
    pub corner_radii: [f64; 2],
    /// How far from a corner its model says where the boundary is: balls of the analysis that reach the corner round it.
    pub corner_reach: f64,
    /// A boundary breaks off at a point when the middle of its points within the radius is off by more than this; it is 0.5 at the
    /// end of a straight one, and 0 inside, but for chance.
    pub breaks_off: f64,
    /// How far ahead of such a point the boundary is looked for in smaller balls.
    pub continues: f64,
    /// Radii of the balls in which it is looked for. In balls of 0.42 and 0.32 there are some 20 and 12 points, and a boundary strayed into
    /// the sheet at chance gaps of Henneberg's surface.
    pub continued_in: [f64; 2],
}

impl EndTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        shift: 0.3,
        radii: [1.0, 1.4, 2.0, 2.8, 4.0, 0.7],
        behind: 0.5,
        widest: 5.0,
        spare: 1.08,
        off_center: 0.15,
        attempts: 5,
        gap: 0.1,
        overlap: 0.4,
        innermost: 1.2,
        corner_spacing: 0.5,
        corner_radii: [2.0, 2.8],
        corner_reach: 1.5,
        breaks_off: 0.3,
        continues: 0.5,
        continued_in: [0.75, 0.56],
    };
}

/// What decides where landmarks and chains lie along curves. Shares are of dl.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SkeletonTuning {
    /// Spacing of the curve points that chains are laid over. A gap in a curve that is twice as wide is
    /// filled by the points that bear witness to the curve.
    pub node_spacing: f64,
    /// Curve points closer than this are one curve.
    pub reach: f64,
    /// The same where no surface is near that could carry another curve.
    pub bare_reach: f64,
    /// Two ends of curves that point at each other are joined over a gap of at most this between
    /// their points, before landmarks are laid.
    pub bridge: f64,
    /// A chain that stops at nothing has a landmark at its end; the next one is this far away.
    pub end_separation: f64,
    /// A chain is joined to a corner, or two free ends to each other, over at most this.
    pub join: f64,
    /// A curve without a surface is joined to a corner or to another end over no longer stretch without points than this, unless
    /// chance explains it.
    pub bare_gap: f64,
    /// Probability of such a stretch, beside the spacings of the curve, below which chance does not.
    pub bare_chance: f64,
    /// Points this far from the straight way between two places lead along it.
    pub beside_way: f64,
    /// How many separations along a curve are tried: the closing gap of a closed curve depends on the
    /// separation, and long edges are the bad ones.
    pub stretches: usize,
    /// By how much each of them is larger than the one before.
    pub stretch_step: f64,
    /// Spacing of the fits that label points, as a share of the least radius of a fit.
    pub label_spacing: f64,
}

impl SkeletonTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        node_spacing: 0.125,
        reach: 1.0,
        bare_reach: 2.0,
        bridge: 2.0,
        end_separation: 0.6,
        join: 3.0,
        bare_gap: 1.0,
        bare_chance: 1e-3,
        beside_way: 0.5,
        stretches: 16,
        stretch_step: 0.025,
        label_spacing: 0.2,
    };
}

/// What decides which landmarks are in the neighborhood of which. Shares are of dl unless said otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellTuning {
    /// Labels are believed up to this share of the radius of the fit.
    pub label_reach: f64,
    /// Points of a cell nearest to a curve landmark, half of which a flood must reach for the landmark to
    /// be at its rim.
    pub contacts: usize,
    /// A cell whose points begin farther than this from a curve landmark does not touch it.
    pub contact_reach: f64,
    /// Every point of a curve has a landmark or a labelling fit within this.
    pub curve_gap: f64,
    /// Landmarks are on one sheet where a quadratic height follows them this closely: sheets that
    /// are nearer to each other than that share no landmarks' spacing could tell apart.
    pub flat: f64,
    /// Fewest members of a neighborhood. Where landmarks are sparse a chart of the usual radius misses
    /// triangles that it has to keep clear of: charts with fewer members are widened.
    pub least_members: usize,
    /// Factor by which they are widened.
    pub widening: f64,
    /// How often.
    pub widenings: usize,
}

impl CellTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        label_reach: 0.9,
        contacts: 6,
        contact_reach: 2.0,
        curve_gap: 0.7,
        flat: 0.1,
        least_members: 14,
        widening: 1.25,
        widenings: 2,
    };
}

/// What decides where landmarks are added. Shares are of dl.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RefinementTuning {
    /// A triangle whose middle strays farther than this from the surface gets another landmark.
    pub stray: f64,
    /// A landmark that is added keeps at least this distance to the others.
    pub separation: f64,
    /// The surface is looked for up to this far from the middle of a triangle.
    pub look: f64,
    /// Factor by which the ball in which it is looked for grows.
    pub growth: f64,
    /// Rounds of refinement.
    pub rounds: usize,
    /// Share of landmarks whose star stayed open above which more landmarks are no remedy.
    pub open_share: f64,
    /// A point farther than this from the mesh is left behind: at a right-angled edge, whose middle no landmark is
    /// near, triangles pass half of a separation below.
    pub behind: f64,
    /// Nearest points of one that is left behind, half of which are at least half as far from the mesh: an outlier
    /// has no such company.
    pub company: usize,
    /// Share of its distance from the mesh within which the same half may be instead: at a tip, where the mesh is soon
    /// reached, a point is alone so far from it. The nearest points of an outlier are on the mesh.
    pub nearer: f64,
    /// Rounds of landmarks at points that are left behind.
    pub mends: usize,
}

impl RefinementTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        stray: 0.4,
        separation: 0.4,
        look: 8.0,
        growth: 1.5,
        rounds: 4,
        open_share: 0.01,
        behind: 0.6,
        company: 4,
        nearer: 0.75,
        mends: 3,
    };
}
