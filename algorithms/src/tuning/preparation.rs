//! What decides how a cloud is looked at and put in order before anything is reconstructed from it.
//!
//! These numbers are apart from [`Tuning`](super::Tuning), since they are asked before there is a pipeline. Lengths are in the
//! local spacing of the points unless said otherwise. None of them was varied on its own: what they are reasoned from is
//! said with each, and what they do together is held by the tests of [`prepare`](crate::prepare) (clean samples of ten surfaces lose
//! nothing, noise has no outliers, points of a box are found).

use serde::Serialize;

/// All of them. [`PreparationTuning::MEASURED`] is what the program runs with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PreparationTuning {
    /// Directions that are noise alone.
    pub subspace: SubspaceTuning,
    /// Steps of the coordinates.
    pub resolution: ResolutionTuning,
    /// Points that lie on nothing.
    pub outliers: OutlierTuning,
    /// How far points scatter across the surface.
    pub noise: NoiseTuning,
    /// Points moved onto fits.
    pub projection: ProjectionTuning,
}

impl PreparationTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        subspace: SubspaceTuning::MEASURED,
        resolution: ResolutionTuning::MEASURED,
        outliers: OutlierTuning::MEASURED,
        noise: NoiseTuning::MEASURED,
        projection: ProjectionTuning::MEASURED,
    };
}

impl Default for PreparationTuning {
    fn default() -> Self {
        Self::MEASURED
    }
}

/// What decides whether a cloud lies in a subspace but for noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SubspaceTuning {
    /// Fewest directions of noise: the spread of so many variances tells noise from a shape that is small in them.
    pub least_rest: usize,
    /// Most coordinates: their covariance is taken apart in the cube of it.
    pub most_coordinates: usize,
    /// Most points that the covariance is taken of.
    pub points: usize,
    /// Fewest points for every coordinate.
    pub points_for_coordinate: usize,
    /// How far beyond the bounds of chance the variances of noise may spread, as a factor.
    pub spare: f64,
    /// Least variance of the shape in its narrowest direction, in those of the noise: with less that direction is no shape for sure.
    pub gap: f64,
    /// Distance from the subspace, in spacings, from which points are moved into it.
    pub least_scatter: f64,
}

impl SubspaceTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        least_rest: 5,
        most_coordinates: 600,
        points: 20_000,
        points_for_coordinate: 8,
        spare: 1.3,
        gap: 6.0,
        least_scatter: 0.1,
    };
}

/// What decides whether coordinates are rounded to a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResolutionTuning {
    /// Values of one coordinate are on a grid when their least gap is this many times what chance leaves
    /// between as many of them. The least of n gaps is exponential with mean range / n^2, so chance
    /// passes this once in e^40.
    pub beyond_chance: f64,
    /// How far a gap may be from a whole number of steps, as a share of a step: 32-bit numbers that
    /// stand for decimals are off by their own rounding.
    pub off_step: f64,
    /// Of the gaps, the share that must be whole numbers of steps.
    pub whole: f64,
    /// Steps of so many spacings and more make a lattice of the cloud.
    pub lattice: f64,
    /// Steps of so many spacings and more are noise that is seen.
    pub coarse: f64,
}

impl ResolutionTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        beyond_chance: 40.0,
        off_step: 0.05,
        whole: 0.99,
        lattice: 0.5,
        coarse: 0.05,
    };
}

/// What decides whether a point is an outlier. The unit of lengths is the spacing of the surface next to the point: the second
/// smallest of the spacings of the point and its eight nearest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OutlierTuning {
    /// Neighbors that a point is judged by: 24 are a disc of radius 2.8 spacings of a surface.
    pub neighbors: usize,
    /// A point this near to the middle of its 16 nearest is among them, and is not looked at: the middle of so many
    /// scattered in a disc is 0.4 off, and an outlier is as far off as it lies from the sheet.
    pub central: f64,
    /// Distance from the sheet that counts: less is an edge or a tip, or harmless.
    pub least_distance: f64,
    /// The same in units of the noise, of the neighbors and usual in the cloud. A fit is known to no more than
    /// twice the noise at its rim, so that 8 is four standard deviations there and eight in the middle.
    pub least_deviations: f64,
    /// A neighbor with a spacing of its own this many times as large is not on a surface as dense as the densest near
    /// it. On straight boundaries it is 1.4 times as large.
    pub sparse: f64,
    /// A neighbor that is off the sheet by this share of the limit may be on another stratum.
    pub off: f64,
    /// So many points of a surface off the sheet are another one, when they are as near to the point as the radius.
    pub stratum: usize,
    /// That radius.
    pub stratum_radius: f64,
    /// A point nearer to the sheet than this needs fewer points: beside a crossing a second sheet has few, and an
    /// outlier there is hardly one.
    pub beside: f64,
    /// How many are enough there.
    pub stratum_beside: usize,
    /// The point and so many of the nearest off the sheet, or the two that there are, are a curve when they are in line.
    pub on_curve: usize,
    /// Least cosine of points in line: 0.95 is that of 18 degrees. Three are by chance once in 400 times.
    pub in_line: f64,
    /// A point this many times farther out, along the plane, than the farthest of its neighbors is alone.
    pub alone: f64,
    /// A point whose second nearest is farther is alone: next to a straight boundary chance leaves so large a half disc
    /// empty but for one point once in 10^7.
    pub empty: f64,
    /// Spacing of a point, in units of that of the cloud, from which it may be one of those that fill space.
    pub scattered: f64,
    /// Least mean crowding of such a point and its neighbors, between 0.25 of a surface and 0.39 of space. Of 25
    /// values it is known to 0.03 to 0.05.
    pub crowded: f64,
    /// Least distance of its neighbors from a sheet of their own, as a share of its extent: points in a ball have a
    /// third, those of a surface that bends a tenth.
    pub thick: f64,
    /// Rounds of looking again without those that were found: outliers far from the surface come into sight when
    /// nearer ones are gone.
    pub rounds: usize,
    /// Where more than this share would be outliers, the cloud is something else.
    pub most: f64,
}

impl OutlierTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        neighbors: 24,
        central: 0.8,
        least_distance: 1.0,
        least_deviations: 8.0,
        sparse: 2.0,
        off: 0.5,
        stratum: 3,
        stratum_radius: 3.0,
        beside: 1.75,
        stratum_beside: 2,
        on_curve: 3,
        in_line: 0.95,
        alone: 3.0,
        empty: 4.0,
        scattered: 2.5,
        crowded: 0.32,
        thick: 0.2,
        rounds: 8,
        most: 0.12,
    };
}

/// What decides how noise is read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NoiseTuning {
    /// Points of the fits, each size twice the one before.
    pub sizes: [usize; 5],
    /// Places at which noise is read.
    pub places: usize,
    /// What scatters less than this share of the extent of its neighborhood is a sheet: in a ball that is
    /// no larger than the noise it is half of the extent.
    pub thin: f64,
}

impl NoiseTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        sizes: [24, 48, 96, 192, 384],
        places: 400,
        thin: 0.3,
    };
}

/// What decides where points are moved onto fits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProjectionTuning {
    /// Noise, in spacings, from which points are moved: below, neighborhoods are flat enough.
    pub least_noise: f64,
    /// Fits reach this many times the noise: the tilt of a fit is known to the noise over its reach and the
    /// root of its points.
    pub reach: f64,
    /// Fewest points of a fit, where the cloud has enough: 64 leave 0.27 of the noise, 32 leave 0.38.
    pub usual_neighbors: usize,
    /// Most, as a share of the cloud.
    pub most_share: f64,
    /// Fewest points of a fit, whatever share of the cloud they are.
    pub least_neighbors: usize,
    /// Most at all.
    pub most_neighbors: usize,
    /// Noise, in spacings, from which a third round is made.
    pub loud: f64,
    /// Scatter, in units of the usual one of the round, that one sheet may leave: of 32 points it is known to 14 %.
    pub one_sheet: f64,
    /// Where two sheets explain no more than one does, the same limit, beyond which points stay where they are.
    pub unexplained: f64,
    /// Scatter that two sheets leave of that of one: cutting the noise of a single sheet in two leaves 0.6 of it.
    pub gain: f64,
    /// Least share of the points on either of two sheets.
    pub sheet_share: f64,
    /// Least sine of the angle at which two sheets cross.
    pub sine: f64,
    /// How far from where it was laid a pair of sheets explains points, in radii of its neighborhood.
    pub borrowed: f64,
}

impl ProjectionTuning {
    /// What the program runs with.
    pub const MEASURED: Self = Self {
        least_noise: 0.1,
        reach: 5.0,
        usual_neighbors: 64,
        most_share: 0.1,
        least_neighbors: 32,
        most_neighbors: 400,
        loud: 0.7,
        one_sheet: 1.6,
        unexplained: 2.5,
        gain: 0.55,
        sheet_share: 0.12,
        sine: 0.25,
        borrowed: 0.6,
    };
}
