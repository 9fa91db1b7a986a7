//! The tangent planes of a cloud: which points they say to be on one sheet, and how far it is along it.

use crate::execute::Execute;
use crate::metric::tangent_planes;
use crate::prepare::LocalSpacing;
use crate::tuning::TangentTuning;
use crosscap_core::{Error, NeighborhoodOracle, PointCloud};
use std::sync::Arc;

/// A plane at every point, that of the sheet that the point is on.
///
/// Where a surface bends sharply two sheets lie side by side, and the nearest points of a point are on both. Straight lines
/// from one to the other are no paths along the surface; the planes tell them apart from those that stay on a
/// sheet. And where the surface is smooth between two points, the planes at both say how long the way is along it.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
/// use crosscap_algorithms::tangents::TangentField;
/// use crosscap_algorithms::tuning::TangentTuning;
/// use crosscap_core::PointCloud;
/// // Two squares that meet in the second axis at 30 degrees: unit grids, side by side three units from it.
/// let grid = (0..300).map(|k| (0.5 + f64::from(k % 15), f64::from(k / 15)));
/// let (sine, cosine) = 30_f64.to_radians().sin_cos();
/// let rows = grid.flat_map(|(x, y)| [[x, y, 0.0], [x * cosine, y, x * sine]]);
/// let cloud = PointCloud::new(3, rows.flatten().collect())?;
/// let oracle = BruteForceOracle::new(Euclidean::new(cloud.clone()));
/// let field = TangentField::new(cloud.into(), &oracle, &TangentTuning::MEASURED, &Serial)?;
/// let row = |x: usize, y: usize, sheet: usize| 2 * (15 * y + x) + sheet;
/// assert!(field.joins(row(3, 9, 0), row(4, 9, 0)));
/// assert!(!field.joins(row(3, 9, 0), row(3, 9, 1)));
/// assert!(field.joins(row(0, 9, 0), row(0, 9, 1)));
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub struct TangentField {
    cloud: Arc<PointCloud<f64>>,
    /// An orthonormal basis at every point, 2 N numbers.
    bases: Vec<f64>,
    /// Spacing of the points at every point.
    spacing: LocalSpacing,
    tuning: TangentTuning,
}

impl TangentField {
    /// Fits the planes: see [`tangent_planes`].
    ///
    /// # Errors
    /// Those of [`tangent_planes`] and [`LocalSpacing::by`].
    pub fn new(
        cloud: Arc<PointCloud<f64>>,
        oracle: &dyn NeighborhoodOracle<Scalar = f64>,
        tuning: &TangentTuning,
        execute: &dyn Execute,
    ) -> Result<Self, Error> {
        let count = tuning.plane.min(cloud.len().saturating_sub(1));
        Ok(Self {
            bases: tangent_planes(&cloud, oracle, count, execute)?,
            cloud,
            spacing: LocalSpacing::by(oracle, execute)?,
            tuning: *tuning,
        })
    }

    fn basis(&self, row: usize) -> [&[f64]; 2] {
        let n = self.cloud.dimension();
        let (u, v) = self.bases[2 * n * row..2 * n * (row + 1)].split_at(n);
        [u, v]
    }

    /// Distance of the point `b` from the plane at the point `a`.
    fn height(&self, a: usize, b: usize) -> f64 {
        let (p, q) = (self.cloud.point(a), self.cloud.point(b));
        let [u, v] = self.basis(a);
        let (mut all, mut along, mut across) = (0.0, 0.0, 0.0);
        for (k, (p, q)) in p.iter().zip(q).enumerate() {
            let w = q - p;
            all += w * w;
            along += w * u[k];
            across += w * v[k];
        }
        f64::max(all - along * along - across * across, 0.0).sqrt()
    }

    /// Whether two points that are near each other are on one sheet: one of them is near the plane at the other. A point on a
    /// crease is on the sheets of both sides.
    pub fn joins(&self, a: usize, b: usize) -> bool {
        let spacing = 0.5 * (self.spacing.at(a) + self.spacing.at(b));
        let limit = self.tuning.thickness * spacing;
        self.height(a, b) <= limit || self.height(b, a) <= limit
    }

    /// How far it is along the surface from one point to another, given the length of a path through the points, unit of the data; `None`
    /// where the planes do not tell.
    ///
    /// A path through scattered points goes to and fro, and is some percent too long. The cubic whose ends are the two points
    /// and whose tangents there are the chord laid into the two planes is as long as the geodesic up to the fourth order of
    /// the chord c: with m and n the parts of the chord's unit vector across the planes, c (1 + (2 m² + 2 n² - m·n) / 30). It is
    /// told where it can be believed, that is where the chord leaves neither plane steeply and the path is hardly longer: around a
    /// hole, a crease or another sheet the path says what there is to say.
    ///
    /// Not a metric, as the triangle inequality may fail by as much as the two kinds of lengths differ. The same, to the bit, in both
    /// directions. `O(N)`.
    ///
    /// ```
    /// # use crosscap_algorithms::{execute::Serial, metric::{BruteForceOracle, Euclidean}, tangents::TangentField, tuning::TangentTuning};
    /// # use crosscap_core::PointCloud;
    /// // On a cylinder of radius 1 two points are 0.6 apart around it, 0.591 in a straight line, and a path through others is longer.
    /// let grid = (0..400).map(|k| (f64::from(k % 20) * 0.1, f64::from(k / 20) * 0.1));
    /// let rows = grid.flat_map(|(angle, z)| [angle.cos(), angle.sin(), z]);
    /// let cloud = PointCloud::new(3, rows.collect())?;
    /// let oracle = BruteForceOracle::new(Euclidean::new(cloud.clone()));
    /// let field = TangentField::new(cloud.into(), &oracle, &TangentTuning::MEASURED, &Serial)?;
    /// let (a, b) = (20 * 10 + 5, 20 * 10 + 11);
    /// assert!((field.length(a, b, 0.63).unwrap() - 0.6).abs() < 1e-3);
    /// // A path that is much longer goes around something.
    /// assert_eq!(field.length(a, b, 1.2), None);
    /// # Ok::<(), crosscap_core::Error>(())
    /// ```
    pub fn length(&self, a: usize, b: usize, path: f64) -> Option<f64> {
        let (a, b) = (a.min(b), a.max(b));
        let (p, q) = (self.cloud.point(a), self.cloud.point(b));
        let square: f64 = p.iter().zip(q).map(|(p, q)| (q - p) * (q - p)).sum();
        if square <= 0.0 {
            return None;
        }
        let along = |e: &[f64]| {
            let products = p.iter().zip(q).zip(e).map(|((p, q), e)| (q - p) * e);
            products.sum::<f64>() / square.sqrt()
        };
        let [first, second] = [self.basis(a), self.basis(b)];
        let [x, y] = [first.map(along), second.map(along)];
        let across = |x: [f64; 2]| f64::max(1.0 - x[0] * x[0] - x[1] * x[1], 0.0);
        let dot = |e: &[f64], f: &[f64]| e.iter().zip(f).map(|(e, f)| e * f).sum::<f64>();
        let [m, n] = [across(x), across(y)];
        let mut both = m + n - 1.0;
        for (e, x) in first.iter().zip(x) {
            both += second
                .iter()
                .zip(y)
                .map(|(f, y)| x * y * dot(e, f))
                .sum::<f64>();
        }
        let length = square.sqrt() * (1.0 + (2.0 * m + 2.0 * n - both) / 30.0);
        let steepest = self.tuning.steepest * self.tuning.steepest;
        let believed = m.max(n) < steepest && path <= self.tuning.longer * length;
        believed.then_some(length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::surfaces::{SampleSurface, Sampling};

    #[test]
    fn lengths_on_a_sphere_are_those_of_arcs() {
        let surface = SampleSurface::find("sphere").unwrap();
        let cloud = surface.sample(&Sampling::new(1500, 5)).unwrap().points;
        let oracle = BruteForceOracle::new(Euclidean::new(cloud.clone()));
        let tuning = TangentTuning::MEASURED;
        let field = TangentField::new(cloud.clone().into(), &oracle, &tuning, &Serial).unwrap();
        let (mut errors, mut asked) = (Vec::new(), 0);
        for a in (0..1500).step_by(7) {
            for b in (0..1500).step_by(11).filter(|&b| b != a) {
                let arc = 2.0 * (0.5 * cloud.squared_distance(a, b).sqrt()).min(1.0).asin();
                // As much too long as paths are.
                let length = field.length(a, b, 1.06 * arc);
                assert_eq!(length, field.length(b, a, 1.06 * arc));
                // A chord leaves the tangent planes at its ends by half of the angle of the arc.
                if arc > 2.0 {
                    assert_eq!(length, None, "{arc}");
                } else if arc < 0.8 {
                    asked += 1;
                    errors.extend(length.map(|length| (length / arc - 1.0).abs()));
                }
            }
        }
        errors.sort_unstable_by(f64::total_cmp);
        // The others are at points whose plane is off.
        assert!(
            asked > 1000 && 5 * errors.len() > 4 * asked,
            "{} of {asked}",
            errors.len()
        );
        let [usual, nearly_all] = [0.5, 0.95].map(|q| errors[(q * errors.len() as f64) as usize]);
        assert!(usual < 0.005 && nearly_all < 0.02, "{usual} {nearly_all}");
    }
}
