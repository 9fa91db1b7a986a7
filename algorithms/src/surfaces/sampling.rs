//! How a sample is drawn.

use super::SamplingLaw;
use crosscap_core::Error;

/// How to draw a sample. Same surface, same values, same points, on every platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Number of points drawn, before thinning.
    pub count: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// How points are spread.
    pub law: SamplingLaw,
    /// Minimal spacing to thin the points to, in the unit of the surface.
    pub thinning: Option<f64>,
    /// Whether to add points exactly on the boundary, where there is one, at the density of the
    /// rest: one each 0.9 sqrt(area / count after thinning) of arc length.
    pub boundary: bool,
    /// Standard deviation of normal noise added to every coordinate, 0 for none.
    pub noise: f64,
}

impl Sampling {
    /// `count` points, uniform by area, without noise, thinning or added boundary points.
    pub fn new(count: usize, seed: u64) -> Self {
        Self {
            count,
            seed,
            law: SamplingLaw::Area,
            thinning: None,
            boundary: false,
            noise: 0.0,
        }
    }

    /// # Errors
    /// [`Error::Parameter`] for what has no meaning.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.count == 0 {
            return Err(Error::Parameter {
                name: "count",
                value: "0".into(),
                expected: "at least 1 point".into(),
            });
        }
        if !(self.noise >= 0.0 && self.noise.is_finite()) {
            return Err(Error::Parameter {
                name: "noise",
                value: self.noise.to_string(),
                expected: "a finite number that is not negative".into(),
            });
        }
        Ok(())
    }
}
