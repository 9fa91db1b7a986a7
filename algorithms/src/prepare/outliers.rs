//! Points that lie on nothing: off the sheet of their neighbors, and alone there.

use super::LocalSpacing;
use super::sheet_fit::SheetFit;
use crate::balls::{BallTree, Near};
use crate::execute::Execute;
use crosscap_core::{PointCloud, Scalar, squared_distance};

/// Neighbors that a point is judged by: a disc of radius 2.8 spacings of a surface.
const NEIGHBORS: usize = 24;
/// The unit of the lengths below is the spacing of the surface next to a point, `LocalSpacing::low`. A point this
/// near to the middle of its 16 nearest is among them: the middle of so many scattered in a disc is 0.4 off,
/// and an outlier is as far off as it lies from the sheet.
const CENTRAL: f64 = 0.8;
/// Distance from the sheet that counts: less is an edge or a tip, or harmless.
const LEAST_DISTANCE: f64 = 1.0;
/// The same in units of the noise, of the neighbors and usual in the cloud. A fit is known to no more than
/// twice the noise at its rim, so that this is four standard deviations there and eight in the middle.
const LEAST_DEVIATIONS: f64 = 8.0;
/// A neighbor with a larger spacing of its own is not on a surface as dense as the densest near it. On
/// straight boundaries it is 1.4 times as large.
const SPARSE: f64 = 2.0;
/// A neighbor that is off the sheet by this share of the limit may be on another stratum.
const OFF: f64 = 0.5;
/// So many points of a surface off the sheet are another one, when they are as near to the point as the radius.
const STRATUM: usize = 3;
const STRATUM_RADIUS: f64 = 3.0;
/// Two are enough for a point nearer to the sheet than this: beside a crossing a second sheet has few points, and
/// an outlier there is hardly one.
const BESIDE: f64 = 1.75;
const STRATUM_BESIDE: usize = 2;
/// The point and the three nearest off the sheet, or the two that there are, are a curve when they are in
/// line: cosine of 18 degrees. Three are by chance once in 400 times.
const ON_CURVE: usize = 3;
const IN_LINE: f64 = 0.95;
/// A point this many times farther out, along the plane, than the farthest of its neighbors is alone.
const ALONE: f64 = 3.0;
/// Rounds of weighting points by how far they are from the sheet.
const WEIGHTINGS: usize = 4;
/// Weights end at this many times the scale of the residuals (Beaton & Tukey 1974: 95 % efficiency).
const TUKEY: f64 = 4.685;
/// The scale of a normal distribution over its median absolute value.
const MEDIAN_TO_SCALE: f64 = 1.4826;
/// Rounds of looking again without those that were found: outliers far from the surface come into sight when
/// nearer ones are gone.
const ROUNDS: usize = 8;
/// Where more than this share would be outliers, the cloud is something else.
const MOST: f64 = 0.12;

/// The outliers of a cloud.
///
/// A sheet (quadratic, weighted so that points off it do not bend it) is laid through those of the 24 nearest of
/// a point that lie as densely as a surface, without the point. It is an outlier when it is farther from the sheet
/// than a spacing of the surface and than eight times the noise, unless points near it are off the sheet with
/// it: a second sheet, a crease, a boundary or a curve is no outlier. Points that are no farther from
/// the middle of their neighbors than scattered points are not looked at.
///
/// What is found is taken away and the rest looked at again, until nothing more is found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outliers {
    /// Rows, increasing.
    pub rows: Vec<usize>,
    /// Distance of each from the sheet of its neighbors, in spacings of the surface there.
    pub distances: Vec<f64>,
}

impl Outliers {
    /// Looks at all points of a cloud, whose spacing is given. None are reported where it would be more than 12 % of
    /// all, as that is another kind of cloud. O(n log n) distances.
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        spacing: &LocalSpacing,
        execute: &dyn Execute,
    ) -> Self {
        let whole = cloud.cast::<f64>();
        let mut kept: Vec<usize> = (0..cloud.len()).collect();
        let mut found: Vec<(usize, f64)> = Vec::new();
        let mut rest = whole.clone();
        let mut own = None;
        for _ in 0..ROUNDS {
            let new = round(&rest, own.as_ref().unwrap_or(spacing), execute);
            if new.is_empty() {
                break;
            }
            let mut out = vec![false; kept.len()];
            new.iter().for_each(|x| out[x.0] = true);
            found.extend(new.iter().map(|&(at, distance)| (kept[at], distance)));
            if found.len() as f64 > MOST * cloud.len() as f64 {
                return Self::default();
            }
            kept = (kept.iter().zip(&out).filter(|x| !x.1))
                .map(|x| *x.0)
                .collect();
            rest = whole.select(&kept);
            own = LocalSpacing::of(&rest, execute).ok();
            if own.is_none() {
                break;
            }
        }
        found.sort_unstable_by_key(|x| x.0);
        Self {
            rows: found.iter().map(|x| x.0).collect(),
            distances: found.iter().map(|x| x.1).collect(),
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// The outliers among the points of a cloud, with their distances.
fn round(
    cloud: &PointCloud<f64>,
    spacing: &LocalSpacing,
    execute: &dyn Execute,
) -> Vec<(usize, f64)> {
    let suspect = |at: usize| spacing.off_center(at) > CENTRAL * spacing.low(at);
    if cloud.len() <= NEIGHBORS || !(0..cloud.len()).any(suspect) {
        return Vec::new();
    }
    let tree = BallTree::new(cloud.dimension(), cloud.coordinates());
    let judged = tree.nearest_of_each(
        NEIGHBORS,
        |at| suspect(at as usize),
        execute,
        |at, near| {
            let judgement = Judge::new(cloud, spacing).judge(at as usize, near)?;
            Some((at as usize, judgement))
        },
    );
    let judged: Vec<(usize, Judgement)> = judged.into_iter().flatten().collect();
    // The noise of a place read from 24 points is now and then far too small.
    let mut scales: Vec<f64> = judged.iter().map(|x| x.1.scale).collect();
    scales.sort_unstable_by(f64::total_cmp);
    let usual = scales.get(scales.len() / 2).copied().unwrap_or(0.0);
    let limit = LEAST_DISTANCE.max(LEAST_DEVIATIONS * usual);
    (judged.into_iter())
        .filter(|(_, x)| x.alone || x.unsupported && x.distance > limit)
        .map(|(at, x)| (at, x.distance))
        .collect()
}

/// What the neighbors say of a point, lengths in spacings of the surface.
struct Judgement {
    distance: f64,
    /// Noise of the neighbors.
    scale: f64,
    /// Whether it is off the sheet, and nothing else is near it.
    unsupported: bool,
    /// Whether it is away from all of them.
    alone: bool,
}

struct Judge<'a> {
    cloud: &'a PointCloud<f64>,
    spacing: &'a LocalSpacing,
    fit: SheetFit,
    offset: Vec<f64>,
}

/// The neighbors of a point, nearest first, and the sheet's distances from them.
struct Around {
    points: Vec<f64>,
    /// Whether each lies as densely as a surface.
    dense: Vec<bool>,
    distances: Vec<f64>,
}

impl<'a> Judge<'a> {
    fn new(cloud: &'a PointCloud<f64>, spacing: &'a LocalSpacing) -> Self {
        Self {
            cloud,
            spacing,
            fit: SheetFit::new(cloud.dimension()),
            offset: Vec::new(),
        }
    }

    /// Lays the sheet, and returns the scale of the distances of the dense neighbors from it.
    fn lay(&mut self, around: &mut Around) -> Option<f64> {
        let n = self.cloud.dimension();
        let mut weights: Vec<f64> = (around.dense.iter())
            .map(|&dense| if dense { 1.0 } else { 0.0 })
            .collect();
        let mut scale = 0.0;
        for _ in 0..WEIGHTINGS {
            if !self.fit.fit(&around.points, &weights) {
                return None;
            }
            around.distances.clear();
            for x in around.points.chunks_exact(n) {
                let d = self.fit.distance(x, f64::INFINITY, &mut self.offset);
                around.distances.push(d);
            }
            let dense = || (around.distances.iter().zip(&around.dense)).filter(|x| *x.1);
            let mut sorted: Vec<f64> = dense().map(|x| *x.0).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            scale = MEDIAN_TO_SCALE * sorted[sorted.len() / 2];
            if scale <= 0.0 {
                break;
            }
            for (w, (d, dense)) in
                (weights.iter_mut()).zip(around.distances.iter().zip(&around.dense))
            {
                let u = d / (TUKEY * scale);
                *w = if *dense {
                    (1.0 - u * u).max(0.0).powi(2)
                } else {
                    0.0
                };
            }
        }
        Some(scale)
    }

    /// `None` where there is no sheet.
    fn judge(&mut self, at: usize, near: &[Near]) -> Option<Judgement> {
        let unit = self.spacing.low(at);
        if near.len() < NEIGHBORS || unit <= 0.0 {
            return None;
        }
        let mut near: Vec<Near> = near.to_vec();
        near.sort_unstable();
        let n = self.cloud.dimension();
        let mut around = Around {
            points: Vec::with_capacity(near.len() * n),
            dense: Vec::with_capacity(near.len()),
            distances: Vec::with_capacity(near.len()),
        };
        for x in &near {
            let row = x.index() as usize;
            around.points.extend_from_slice(self.cloud.point(row));
            around.dense.push(self.spacing.raw(row) <= SPARSE * unit);
        }
        let scale = self.lay(&mut around)?;
        let own = self.cloud.point(at);
        let mut reach = 0.0_f64;
        for (x, dense) in around.points.chunks_exact(n).zip(&around.dense) {
            if *dense {
                reach = reach.max(self.fit.out(x, &mut self.offset));
            }
        }
        let distance = self.fit.distance(own, 1.5 * reach, &mut self.offset);
        let limit = (LEAST_DISTANCE * unit).max(LEAST_DEVIATIONS * scale);
        Some(Judgement {
            distance: distance / unit,
            scale: scale / unit,
            unsupported: distance > limit && !around.supports(own, distance, limit, unit),
            alone: self.fit.out(own, &mut self.offset) > ALONE * reach,
        })
    }
}

impl Around {
    /// Whether points off the sheet make a stratum that `own`, at the given distance from the sheet, is on.
    fn supports(&self, own: &[f64], distance: f64, limit: f64, unit: f64) -> bool {
        let rows = self.points.chunks_exact(own.len()).zip(&self.dense);
        let off: Vec<(&[f64], bool)> = (rows.zip(&self.distances))
            .filter(|x| *x.1 > OFF * limit)
            .map(|((x, dense), _)| (x, *dense))
            .collect();
        let beside = distance < BESIDE * unit;
        let (radius, needed) = if beside {
            (f64::INFINITY, STRATUM_BESIDE)
        } else {
            (STRATUM_RADIUS * unit, STRATUM)
        };
        let dense = (off.iter())
            .filter(|x| x.1 && squared_distance(x.0, own) < radius * radius)
            .count();
        let nearest = &off[..off.len().min(ON_CURVE)];
        let line = nearest.len() >= 2
            && (nearest.windows(2)).all(|pair| in_line(own, pair[0].0, pair[1].0));
        line || dense >= needed
    }
}

/// Whether two points are in line with `own`, on one side or on both.
fn in_line(own: &[f64], a: &[f64], b: &[f64]) -> bool {
    let product: f64 = (own.iter().zip(a.iter().zip(b)))
        .map(|(o, (a, b))| (a - o) * (b - o))
        .sum();
    product.abs() > IN_LINE * (squared_distance(own, a) * squared_distance(own, b)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{Random, RigidMotion, SampleSurface, Sampling, scaled};

    fn outliers(cloud: &PointCloud<f64>) -> Outliers {
        let spacing = LocalSpacing::of(cloud, &Serial).unwrap();
        Outliers::of(cloud, &spacing, &Serial)
    }

    fn sample(name: &str, sampling: &Sampling) -> PointCloud<f64> {
        let surface = SampleSurface::find(name).unwrap();
        surface.sample(sampling).unwrap().points
    }

    /// The cloud with `count` points uniform in its bounding box behind it.
    fn with_box(cloud: &PointCloud<f64>, count: usize, seed: u64) -> PointCloud<f64> {
        let n = cloud.dimension();
        let mut low = vec![f64::INFINITY; n];
        let mut high = vec![f64::NEG_INFINITY; n];
        for row in cloud.iter() {
            for k in 0..n {
                low[k] = low[k].min(row[k]);
                high[k] = high[k].max(row[k]);
            }
        }
        let mut random = Random::new(seed);
        let mut rows = cloud.coordinates().to_vec();
        for _ in 0..count {
            rows.extend((0..n).map(|k| random.between(low[k], high[k])));
        }
        PointCloud::new(n, rows).unwrap()
    }

    #[test]
    fn clean_samples_lose_nothing() {
        // Closed, crossing, with a boundary, with three sheets, with curves, pinched, in R^5.
        for name in [
            "torus",
            "two_spheres",
            "three_spheres",
            "moebius",
            "square",
            "double_bubble",
            "line_disc",
            "roman",
            "boy_surface",
            "klein_r5",
        ] {
            let cloud = sample(name, &Sampling::new(4000, 1));
            let found = outliers(&cloud);
            assert!(found.is_empty(), "{name}: {found:?}");
        }
    }

    #[test]
    fn noise_has_tails_but_no_outliers() {
        let even = |noise: f64| Sampling {
            noise,
            ..Sampling::new(4000, 2)
        };
        for name in ["sphere", "two_spheres", "hemisphere"] {
            for noise in [0.005, 0.02, 0.06] {
                let found = outliers(&sample(name, &even(noise)));
                assert!(found.len() < 2, "{name} {noise}: {found:?}");
            }
        }
    }

    #[test]
    fn points_of_the_box_are_found() {
        for (name, share, seed) in [
            ("torus", 0.01, 1),
            ("two_spheres", 0.05, 2),
            ("moebius", 0.05, 3),
        ] {
            let clean = sample(name, &Sampling::new(4000, seed));
            let count = (share * 4000.0) as usize;
            let cloud = with_box(&clean, count, seed);
            let found = outliers(&cloud);
            let own: Vec<usize> = found.rows.iter().copied().filter(|&r| r < 4000).collect();
            assert!(own.len() <= 1, "{name}: points of the surface {own:?}");
            // Those that are left lie about as near to the surface as its points to each other.
            let spacing = LocalSpacing::of(&clean, &Serial).unwrap();
            let left: Vec<usize> = (4000..4000 + count)
                .filter(|r| found.rows.binary_search(r).is_err())
                .filter(|&r| {
                    let near = clean.iter().map(|x| squared_distance(x, cloud.point(r)));
                    near.fold(f64::INFINITY, f64::min).sqrt() > 2.0 * spacing.median()
                })
                .collect();
            // A few are kept by others that happen to be in line with them.
            assert!(left.len() * 100 <= count, "{name}: left {left:?}");
            assert!(found.len() > count / 2);
        }
    }

    #[test]
    fn a_far_point_is_found_wherever_the_cloud_is() {
        let clean = sample("torus", &Sampling::new(3000, 1));
        let mut rows = clean.coordinates().to_vec();
        rows.extend([100.0, 3.0, -50.0]);
        let cloud = PointCloud::new(3, rows).unwrap();
        let moved = RigidMotion::random(3, 5.0, 1).apply(&cloud).unwrap();
        for cloud in [&cloud, &moved, &scaled(&moved, 1e-7).unwrap()] {
            let found = outliers(cloud);
            assert_eq!(found.rows, [3000]);
            assert!(found.distances[0] > 500.0);
        }
    }
}
