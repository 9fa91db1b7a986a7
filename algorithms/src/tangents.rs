//! The tangent planes of a cloud, and which points they say to be on one sheet.

use crate::execute::Execute;
use crate::metric::tangent_planes;
use crate::prepare::LocalSpacing;
use crate::tuning::TangentTuning;
use crosscap_core::{Error, NeighborhoodOracle, PointCloud};

/// A plane at every point, that of the sheet that the point is on.
///
/// Where a surface bends sharply two sheets lie side by side, and the nearest points of a point are on both. Straight lines
/// from one to the other are no paths along the surface; the planes tell them apart from those that stay on a
/// sheet.
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
/// let field = TangentField::new(&cloud, &oracle, &TangentTuning::MEASURED, &Serial)?;
/// let row = |x: usize, y: usize, sheet: usize| 2 * (15 * y + x) + sheet;
/// assert!(field.joins(row(3, 9, 0), row(4, 9, 0)));
/// assert!(!field.joins(row(3, 9, 0), row(3, 9, 1)));
/// assert!(field.joins(row(0, 9, 0), row(0, 9, 1)));
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub struct TangentField<'c> {
    cloud: &'c PointCloud<f64>,
    /// An orthonormal basis at every point, 2 N numbers.
    bases: Vec<f64>,
    /// Spacing of the points at every point.
    spacing: LocalSpacing,
    tuning: TangentTuning,
}

impl<'c> TangentField<'c> {
    /// Fits the planes: see [`tangent_planes`].
    ///
    /// # Errors
    /// Those of [`tangent_planes`] and [`LocalSpacing::by`].
    pub fn new(
        cloud: &'c PointCloud<f64>,
        oracle: &dyn NeighborhoodOracle<Scalar = f64>,
        tuning: &TangentTuning,
        execute: &dyn Execute,
    ) -> Result<Self, Error> {
        let count = tuning.plane.min(cloud.len().saturating_sub(1));
        Ok(Self {
            cloud,
            bases: tangent_planes(cloud, oracle, count, execute)?,
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
}
