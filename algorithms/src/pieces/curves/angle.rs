//! The angle at which sheets meet along a curve.

use crate::pieces::CrossingAngle;

/// Angles along a curve, weighted by length.
pub(super) struct AngleSum {
    sum: f64,
    total: f64,
    least: f64,
    most: f64,
}

impl Default for AngleSum {
    fn default() -> Self {
        Self {
            sum: 0.0,
            total: 0.0,
            least: f64::INFINITY,
            most: f64::NEG_INFINITY,
        }
    }
}

impl AngleSum {
    pub fn add(&mut self, length: f64, cosine: f64) {
        let degrees = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        self.sum += length * degrees;
        self.total += length;
        self.least = self.least.min(degrees);
        self.most = self.most.max(degrees);
    }

    pub fn result(&self) -> Option<CrossingAngle> {
        (self.total > 0.0).then(|| CrossingAngle {
            // Rounding must not carry it past equal angles.
            mean: (self.sum / self.total).clamp(self.least, self.most),
            min: self.least,
            max: self.most,
        })
    }
}
