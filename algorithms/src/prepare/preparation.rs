//! All that is found out about a cloud, and what is done about it.

use super::{LocalSpacing, Noise, Outliers, Projection, Resolution, Subspace};
use crate::execute::Execute;
use crate::tuning::PreparationTuning;
use crosscap_core::{Error, PointCloud, Scalar};
use serde::Serialize;
use std::fmt;

/// What may be done about a cloud.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Remedies {
    /// Leave outliers out.
    pub outliers: bool,
    /// Move points into the subspace that holds them but for noise, and onto fits where they are noisy.
    pub projection: bool,
}

impl Remedies {
    /// Whatever the cloud needs.
    pub const ALL: Self = Self {
        outliers: true,
        projection: true,
    };
    /// Nothing: the cloud is only looked at.
    pub const NONE: Self = Self {
        outliers: false,
        projection: false,
    };
}

/// A cloud, looked at and put in order.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::prepare::{Preparation, Remedies};
/// use crosscap_algorithms::surfaces::{SampleSurface, Sampling};
/// use crosscap_algorithms::tuning::PreparationTuning;
/// let mut sampling = Sampling::new(2000, 1);
/// sampling.noise = 0.03;
/// let noisy = SampleSurface::find("sphere")?.sample(&sampling)?.points;
/// let found = Preparation::of(&noisy, Remedies::ALL, &PreparationTuning::MEASURED, &Serial)?;
/// assert!(found.outliers.is_empty());
/// assert!((found.noise.unwrap().deviation - 0.03).abs() < 0.005);
/// assert!(found.projection.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Preparation {
    /// The subspace that the points were moved into, where all other directions are noise; everything else is said of the points in it.
    pub subspace: Option<Subspace>,
    /// Spacing of the points that are kept.
    pub spacing: LocalSpacing,
    /// Resolution of their coordinates.
    pub resolution: Resolution,
    /// Outliers, rows of the cloud that was given.
    pub outliers: Outliers,
    /// Whether they were left out.
    pub left_out: bool,
    /// Rows of the cloud that was given that are kept, increasing.
    pub kept: Vec<usize>,
    /// Noise of the points that are kept; none where no surface is seen, or nothing is normal to it.
    pub noise: Option<Noise>,
    /// The kept points moved onto fits, where there is enough noise and that was allowed.
    pub projection: Option<Projection>,
    /// The numbers that decided.
    pub tuning: PreparationTuning,
}

impl Preparation {
    /// Looks at a cloud without copies of points, and does what `remedies` allow. A clean cloud keeps all its points
    /// where they are. O(n log n) distances.
    ///
    /// # Errors
    /// [`Error::Shape`] for fewer than 17 points.
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        remedies: Remedies,
        tuning: &PreparationTuning,
        execute: &dyn Execute,
    ) -> Result<Self, Error> {
        let Held { moved, mut spacing } = held(cloud, remedies, tuning, execute)?;
        let cloud = moved.as_ref().map_or(cloud, |moved| &moved.1);
        let outliers = Outliers::of(cloud, &spacing, &tuning.outliers, execute);
        let left_out = remedies.outliers && !outliers.is_empty();
        let (kept, rest) = if left_out {
            let kept: Vec<usize> = (0..cloud.len())
                .filter(|row| outliers.rows.binary_search(row).is_err())
                .collect();
            let rest = cloud.select(&kept);
            spacing = LocalSpacing::of(&rest, execute)?;
            (kept, rest)
        } else {
            ((0..cloud.len()).collect(), cloud.clone())
        };
        let noise = Noise::of(&rest, &tuning.noise, execute);
        let loud = noise
            .filter(|n| remedies.projection && n.of_spacing() >= tuning.projection.least_noise);
        Ok(Self {
            resolution: Resolution::of(&rest, &spacing, &tuning.resolution),
            projection: loud
                .map(|noise| Projection::of(&rest, &noise, &tuning.projection, execute)),
            subspace: moved.map(|moved| moved.0),
            spacing,
            outliers,
            left_out,
            kept,
            noise,
            tuning: tuning.clone(),
        })
    }

    /// The points to work with: those that are kept, moved where they were moved, in the coordinates of the
    /// [subspace](Self::subspace) where there is one.
    pub fn points<S: Scalar>(&self, cloud: &PointCloud<S>) -> PointCloud<f64> {
        match &self.projection {
            Some(projection) => projection.cloud.clone(),
            None => {
                let kept = match self.kept.len() == cloud.len() {
                    true => cloud.cast(),
                    false => cloud.select(&self.kept).cast(),
                };
                match &self.subspace {
                    Some(subspace) => subspace.project(&kept),
                    None => kept,
                }
            }
        }
    }

    /// Whether anything was done about the cloud.
    pub fn changes(&self) -> bool {
        self.left_out || self.projection.is_some() || self.subspace.is_some()
    }

    /// Root mean square of how far the points that were moved scatter across the surface, unit of the data; 0 where none were.
    pub fn scatter(&self) -> f64 {
        let aside = self.subspace.as_ref().map_or(0.0, Subspace::scatter);
        let across = match (&self.projection, &self.noise) {
            (Some(_), Some(noise)) => noise.deviation,
            _ => 0.0,
        };
        aside.hypot(across)
    }

    /// The figures, for reports.
    pub fn summary(&self) -> PreparationSummary {
        PreparationSummary {
            spacing: self.spacing.median(),
            variation: self.spacing.variation(),
            evenness: self.spacing.evenness(),
            step: self.resolution.step,
            subspace: self.subspace.as_ref().map(|s| (s.dimension(), s.deviation)),
            outliers: self.outliers.rows.clone(),
            outliers_left_out: self.left_out,
            noise: self.noise.map(|n| n.deviation),
            noise_of_spacing: self.noise.map(|n| n.of_spacing()),
            moved: self.projection.as_ref().map(|p| p.moved),
            unexplained: self.projection.as_ref().map_or(0, |p| p.unexplained),
            tuning: self.tuning.clone(),
        }
    }
}

/// A cloud in the subspace that holds it, if it was moved there.
struct Held<S: Scalar> {
    moved: Option<(Subspace, PointCloud<S>)>,
    spacing: LocalSpacing,
}

/// The spacing of a cloud, and where it scatters out of a subspace by enough the points in it.
fn held<S: Scalar>(
    cloud: &PointCloud<S>,
    remedies: Remedies,
    tuning: &PreparationTuning,
    execute: &dyn Execute,
) -> Result<Held<S>, Error> {
    let allowed = remedies.projection.then_some(&tuning.subspace);
    if let Some(subspace) = allowed.and_then(|tuning| Subspace::of(cloud, tuning)) {
        let moved = subspace.project(cloud);
        let spacing = LocalSpacing::of(&moved, execute)?;
        if subspace.scatter() >= tuning.subspace.least_scatter * spacing.median() {
            return Ok(Held {
                moved: Some((subspace, moved)),
                spacing,
            });
        }
    }
    Ok(Held {
        moved: None,
        spacing: LocalSpacing::of(cloud, execute)?,
    })
}

/// What was found out about a cloud, and what was done about it, in figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PreparationSummary {
    /// Median spacing of the points, unit of the data.
    pub spacing: f64,
    /// How much the spacing varies: see [`LocalSpacing::variation`].
    pub variation: f64,
    /// How evenly points lie: see [`LocalSpacing::evenness`].
    pub evenness: f64,
    /// Step of the coordinates, unit of the data.
    pub step: f64,
    /// Dimension of the subspace that the points were moved into, and their standard deviation in each direction out of it, unit
    /// of the data; none where they stayed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subspace: Option<(usize, f64)>,
    /// Rows of outliers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub outliers: Vec<usize>,
    /// Whether they were left out.
    pub outliers_left_out: bool,
    /// Standard deviation of the points across the surface, unit of the data; none where no surface is seen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// The same in units of the spacing along the surface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_of_spacing: Option<f64>,
    /// Root mean square of how far points were moved onto fits, unit of the data; none where they stayed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moved: Option<f64>,
    /// Points that no fit explained, and that stayed where others were moved.
    pub unexplained: usize,
    /// The numbers that decided.
    pub tuning: PreparationTuning,
}

impl PreparationSummary {
    /// The same with rows by other names: those of the cloud that the one looked at was taken from.
    pub fn named(mut self, name: impl Fn(usize) -> usize) -> Self {
        self.outliers.iter_mut().for_each(|row| *row = name(*row));
        self
    }

    /// The same with more rows left out.
    pub fn without(mut self, rows: &[usize]) -> Self {
        if !self.outliers_left_out {
            self.outliers.clear();
        }
        self.outliers.extend(rows);
        self.outliers.sort_unstable();
        self.outliers.dedup();
        self.outliers_left_out = !self.outliers.is_empty();
        self
    }
}

/// Rows that are named one by one.
const NAMED: usize = 5;

impl fmt::Display for PreparationSummary {
    /// A line for each thing that was done; nothing for a clean cloud.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((dimension, deviation)) = self.subspace {
            writeln!(
                f,
                "points moved into the {dimension}-dimensional subspace that holds them: every direction out of it is noise of {deviation:.3e}"
            )?;
        }
        if self.outliers_left_out {
            let named: Vec<String> = (self.outliers.iter().take(NAMED))
                .map(usize::to_string)
                .collect();
            let more = if self.outliers.len() > NAMED {
                ", ..."
            } else {
                ""
            };
            let plural = if self.outliers.len() == 1 { "" } else { "s" };
            let count = self.outliers.len();
            let named = named.join(", ");
            writeln!(
                f,
                "left out {count} outlier{plural} (row{plural} {named}{more})"
            )?;
        }
        if let (Some(moved), Some(noise)) = (self.moved, self.noise) {
            let spacings = self.noise_of_spacing.unwrap_or(0.0);
            writeln!(
                f,
                "points moved onto fits of their neighborhoods, {moved:.3e} (root mean square): they scatter across \
                 the surface by {noise:.3e}, {spacings:.2} of their spacing"
            )?;
            if self.unexplained > 0 {
                writeln!(
                    f,
                    "{} points stayed, as no fit explains them",
                    self.unexplained
                )?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{SampleSurface, Sampling};

    fn sample(name: &str, noise: f64) -> PointCloud<f64> {
        let sampling = Sampling {
            noise,
            ..Sampling::new(3000, 6)
        };
        let surface = SampleSurface::find(name).unwrap();
        surface.sample(&sampling).unwrap().points
    }

    #[test]
    fn a_clean_cloud_stays_as_it_is() {
        for name in ["torus", "two_spheres", "annulus"] {
            let cloud = sample(name, 0.0);
            let found =
                Preparation::of(&cloud, Remedies::ALL, &PreparationTuning::MEASURED, &Serial)
                    .unwrap();
            assert!(
                found.points(&cloud) == cloud,
                "{name}: {:?}",
                found.summary()
            );
            assert_eq!(found.summary().to_string(), "");
        }
    }

    #[test]
    fn what_was_done_is_said() {
        let mut rows = sample("torus", 0.04).coordinates().to_vec();
        rows.extend([0.0, 0.0, 9.0]);
        let cloud = PointCloud::new(3, rows).unwrap();
        let found =
            Preparation::of(&cloud, Remedies::ALL, &PreparationTuning::MEASURED, &Serial).unwrap();
        assert_eq!(found.outliers.rows, [3000]);
        assert_eq!(found.points(&cloud).len(), 3000);
        let said = found.summary().to_string();
        assert!(said.contains("left out 1 outlier (row 3000)"), "{said}");
        assert!(said.contains("moved onto fits"), "{said}");
        let only = Preparation::of(
            &cloud,
            Remedies::NONE,
            &PreparationTuning::MEASURED,
            &Serial,
        )
        .unwrap();
        assert_eq!(only.outliers.rows, [3000]);
        assert!(only.points(&cloud) == cloud);
        assert!(!only.summary().outliers_left_out);
        // What was seen and stayed is not among those that are left out later.
        let later = only.summary().named(|row| row + 10).without(&[7, 3, 7]);
        assert_eq!(later.outliers, [3, 7]);
        assert!(
            later
                .to_string()
                .contains("left out 2 outliers (rows 3, 7)")
        );
    }
}
