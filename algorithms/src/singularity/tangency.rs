//! Two sheets that touch without crossing.

use super::patch::{PATCH_POINTS, QuadraticPatch};
use crate::principal::PrincipalFrame;
use crosscap_core::{Neighbor, NeighborhoodOracle, PointCloud, Scalar};
use nalgebra::{Matrix2, SymmetricEigen, Vector2, Vector3};

/// Points that are looked at: a hundred a sheet.
const POINTS: usize = 200;
/// Neighborhoods that are looked at, each nearer to the place than the one before.
const STEPS: usize = 4;
/// Rounds in which points change sheets.
const ROUNDS: usize = 15;
/// Farthest that a neighborhood that decides is centered from the place, in its radii.
const CENTERED: f64 = 0.3;
/// Least share of the points that is on either sheet; 0.3 and more where one of a plate and a cylinder was half as dense.
const SHARE: f64 = 0.2;
/// Most that two sheets leave of what one sheet leaves of the points, as a share: 0.007 and less at spheres, plates and cylinders that touch, 0.1 and more where
/// sheets cross at 20 degrees and above, at creases, in noise and where one sheet bends.
const LEFT: f64 = 0.08;
/// Least that one sheet leaves, in spacings; below it there is one sheet. It was 0.14 where a sphere touches a cylinder from inside.
const LEAST: f64 = 0.05;
/// Widest gap between sheets that touch, in spacings; less cannot be told from none.
const GAP: f64 = 0.2;
/// Curvature of the gap along the flatter direction, as a share of that along the other, below which the sheets touch along a curve.
const FLAT: f64 = 0.1;

/// A place where two sheets touch without crossing, in a point or along a curve.
///
/// Over one plane both sheets are the graphs of functions, and where they touch the difference of the two, the gap between the sheets, begins with its
/// second order: it vanishes at the place and grows to all sides. Where sheets cross, the difference changes its sign, and no two functions of
/// second order of which one is above the other describe the points. So the two nearest such functions are fitted, one to the points
/// above a sheet between them and one to those below, and it is asked what they leave of the points, and where and how fast the gap grows.
///
/// Moving, turning, mirroring and scaling the points changes nothing but the place and the lengths.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tangency {
    /// The place, unit of the data.
    pub place: Vec<f64>,
    /// The row that is nearest to it of those that were looked at.
    pub row: usize,
    /// Spacing of the points on a sheet, unit of the data.
    pub spacing: f64,
    /// Second derivatives of the gap along its two principal directions, the smaller first, one over the unit of the data. Next to
    /// none along a curve in which the sheets touch.
    pub curvatures: [f64; 2],
}

impl Tangency {
    /// The place near a row where two sheets touch, if the 200 points nearest to it show two sheets whose gap closes there.
    ///
    /// O(N^3 + k N^2) for each of four neighborhoods of k points in R^N at most.
    pub fn near<S: Scalar>(
        cloud: &PointCloud<S>,
        oracle: &dyn NeighborhoodOracle<Scalar = S>,
        row: usize,
    ) -> Option<Self> {
        let mut near: Vec<Neighbor<S>> = Vec::new();
        let mut center = row;
        for _ in 0..STEPS {
            oracle.nearest(center, POINTS, &mut near);
            let (found, off, closes) = Self::of(cloud, center, &near)?;
            // Farther away terms of third order say as much of the gap.
            if off <= CENTERED {
                return closes.then_some(found);
            }
            if found.row == center {
                return None;
            }
            center = found.row;
        }
        None
    }

    /// What the points nearest to a row show, how far the place is from the row, in radii of the neighborhood, and whether the gap closes there; none
    /// where they are not those of two sheets whose gap is least in one place or along a curve.
    fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        center: usize,
        near: &[Neighbor<S>],
    ) -> Option<(Self, f64, bool)> {
        let radius = near.last()?.distance.as_f64();
        if cloud.dimension() < 3 || near.len() < POINTS || radius <= 0.0 {
            return None;
        }
        let frame = PrincipalFrame::of(cloud, near.iter().map(|x| x.index));
        let local = |point: &[S]| {
            let mut place = Vec::with_capacity(3);
            frame.project(point, 3, &mut place);
            Vector3::from_column_slice(&place)
        };
        let middle = local(cloud.point(center)).xy();
        let over = |x: Vector3<f64>| (x - middle.push(0.0)) / radius;
        let points: Vec<Vector3<f64>> = (near.iter())
            .map(|x| over(local(cloud.point(x.index))))
            .collect();
        let across = frame.variances.iter().skip(3).sum::<f64>() / (radius * radius);
        let spacing = (std::f64::consts::TAU / points.len() as f64).sqrt();
        let graphs = Graphs::of(&points)?;
        let fits = (graphs.left.powi(2) + across).sqrt() <= LEFT * graphs.one
            && graphs.one >= LEAST * spacing;
        let gap = graphs.gap();
        if !fits || !gap.opens() {
            return None;
        }
        // Beyond the neighborhood its second order says only which way.
        let at = gap.lowest / gap.lowest.norm().max(1.0);
        let place = at.push(graphs.height(at));
        let nearest = (near.iter().zip(&points))
            .min_by(|a, b| (a.1 - place).norm().total_cmp(&(b.1 - place).norm()))?;
        let lifted = frame.lift_vector((place * radius + middle.push(0.0)).as_slice());
        let found = Self {
            place: lifted.iter().zip(&frame.mean).map(|(x, m)| x + m).collect(),
            row: nearest.0.index,
            spacing: spacing * radius,
            curvatures: gap.curvatures.map(|x| x / radius),
        };
        Some((found, gap.lowest.norm(), gap.closes(spacing)))
    }

    /// The distance from the place beyond which the sheets are farther apart than `gap`, unit of the data; none where they touch along a curve.
    pub fn apart(&self, gap: f64) -> Option<f64> {
        let [flatter, steeper] = self.curvatures;
        (flatter > FLAT * steeper).then(|| (2.0 * gap / flatter).sqrt())
    }
}

/// Two sheets over a plane, one above the other.
struct Graphs {
    upper: QuadraticPatch,
    lower: QuadraticPatch,
    /// Root mean squared height over one sheet.
    one: f64,
    /// The same over the nearer of the two.
    left: f64,
}

impl Graphs {
    /// The two sheets nearest to points over the plane of the first two axes, in a ball of radius 1.
    fn of(points: &[Vector3<f64>]) -> Option<Self> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut sheet = QuadraticPatch::plane(Vector3::zeros(), axes);
        let count = points.len() as f64;
        let least = PATCH_POINTS.max((SHARE * count) as usize);
        if !sheet.fit(points.iter().copied(), 1.0) {
            return None;
        }
        let heights = points.iter().map(|x| sheet.height(x).0);
        let one = (heights.map(|h| h * h).sum::<f64>() / count).sqrt();
        let mut above: Vec<bool> = points.iter().map(|x| sheet.height(x).0 > 0.0).collect();
        let (mut upper, mut lower) = (sheet.clone(), sheet);
        for _ in 0..ROUNDS {
            for (is_upper, sheet) in [(true, &mut upper), (false, &mut lower)] {
                let own = points.iter().zip(&above).filter(|x| *x.1 == is_upper);
                if own.clone().count() < least || !sheet.fit(own.map(|x| *x.0), 1.0) {
                    return None;
                }
            }
            let nearer = |x: &Vector3<f64>| upper.height(x).0.abs() < lower.height(x).0.abs();
            let next: Vec<bool> = points.iter().map(nearer).collect();
            if next == above {
                break;
            }
            above = next;
        }
        let off = (points.iter()).map(|x| upper.height(x).0.abs().min(lower.height(x).0.abs()));
        Some(Self {
            left: (off.map(|h| h * h).sum::<f64>() / count).sqrt(),
            one,
            upper,
            lower,
        })
    }

    /// The gap between the sheets.
    fn gap(&self) -> Gap {
        let (upper, lower) = (self.upper.coefficients(), self.lower.coefficients());
        let [c, x, y, xx, xy, yy] = std::array::from_fn(|k| upper[k] - lower[k]);
        let half = Matrix2::new(xx, xy / 2.0, xy / 2.0, yy);
        let eigen = SymmetricEigen::new(half);
        let slopes = eigen.eigenvectors.transpose() * Vector2::new(x, y);
        let steepest = eigen.eigenvalues.max();
        let mut gap = Gap {
            least: c,
            lowest: Vector2::zeros(),
            slope: 0.0,
            curvatures: [eigen.eigenvalues.min(), steepest].map(|x| 2.0 * x),
        };
        for k in 0..2 {
            let (curvature, slope) = (eigen.eigenvalues[k], slopes[k]);
            if curvature > FLAT * steepest {
                let step = -slope / (2.0 * curvature);
                gap.least += slope * step / 2.0;
                gap.lowest += eigen.eigenvectors.column(k) * step;
            } else {
                gap.slope = slope.abs();
            }
        }
        gap
    }

    /// Mean height of the two sheets.
    fn height(&self, at: Vector2<f64>) -> f64 {
        let foot = at.push(0.0);
        // A point of the plane is below the sheet by the height of the sheet.
        -(self.upper.height(&foot).0 + self.lower.height(&foot).0) / 2.0
    }
}

/// The gap between two sheets, of second order.
struct Gap {
    /// Its least value.
    least: f64,
    /// Where that is: of the places along a curve in which it does not change, the one nearest to the origin.
    lowest: Vector2<f64>,
    /// How fast it grows along a direction in which it is not curved.
    slope: f64,
    /// Its second derivatives, the smaller first.
    curvatures: [f64; 2],
}

impl Gap {
    /// Whether it has a least value and grows from there.
    fn opens(&self) -> bool {
        let [flatter, steeper] = self.curvatures;
        steeper > 0.0 && flatter >= -FLAT * steeper
    }

    /// Whether its least value is none, as far as the points tell, along all of a curve if it is one.
    fn closes(&self, spacing: f64) -> bool {
        self.least.abs() <= GAP * spacing && self.slope <= GAP * spacing
    }
}

#[cfg(test)]
mod tests;
