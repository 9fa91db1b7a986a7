//! Moebius strip and the figure-8 Klein bottle: one-sided surfaces made by a half twist.

use super::{Jet, Piece, RimSegment};
use std::f64::consts::TAU;

/// The Moebius strip (paper, section 4): radius 1 plus r/2 cos(t/2), height r/2 sin(t/2), |r| <= 1.
/// Parameters: t, r.
#[derive(Clone, Copy, Debug)]
pub struct MoebiusStrip;

impl Piece for MoebiusStrip {
    fn name(&self) -> &'static str {
        "strip"
    }
    fn ambient_dimension(&self) -> usize {
        3
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, TAU], [-1.0, 1.0]]
    }
    fn ends(&self) -> [bool; 2] {
        [false, true]
    }
    fn map(&self, [t, r]: [Jet; 2], place: &mut [Jet]) {
        let ((s, c), (sh, ch)) = (t.sin_cos(), (t * 0.5).sin_cos());
        let reach = r * ch * 0.5 + 1.0;
        place.copy_from_slice(&[reach * c, reach * s, r * sh * 0.5]);
    }
    fn area_element_bound(&self) -> f64 {
        // The tangents are orthogonal, of lengths 1/2 and sqrt(r^2/16 + (1 + r/2 cos(t/2))^2).
        0.5 * (1.0f64 / 16.0 + 2.25).sqrt() * (1.0 + 1e-12)
    }
    /// One rim: twice around, first along r = -1, then along r = 1.
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        vec![
            [-1.0, 1.0]
                .map(|r| RimSegment {
                    from: [0.0, r],
                    to: [TAU, r],
                })
                .into(),
        ]
    }
}

/// The figure-8 Klein bottle (paper, section 4): a figure 8 that turns by half a turn on its way
/// around. In R^3 immersed with a double circle of radius 3; in R^5, with (sin t, cos r)
/// appended, embedded. Parameters: t around, r along the figure 8.
#[derive(Clone, Copy, Debug)]
pub struct KleinFigureEight {
    embedded: bool,
}

impl KleinFigureEight {
    /// The immersion in R^3.
    pub fn immersed() -> Self {
        Self { embedded: false }
    }

    /// The embedding in R^5.
    pub fn embedded() -> Self {
        Self { embedded: true }
    }
}

impl Piece for KleinFigureEight {
    fn name(&self) -> &'static str {
        "klein bottle"
    }
    fn ambient_dimension(&self) -> usize {
        if self.embedded { 5 } else { 3 }
    }
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, TAU]; 2]
    }
    fn ends(&self) -> [bool; 2] {
        [false; 2]
    }
    fn map(&self, [t, r]: [Jet; 2], place: &mut [Jet]) {
        let ((s, c), (sh, ch)) = (t.sin_cos(), (t * 0.5).sin_cos());
        let (sr, cr) = r.sin_cos();
        let double = sr * cr * 2.0;
        let reach = ch * sr - sh * double + 3.0;
        place[..3].copy_from_slice(&[reach * c, reach * s, sh * sr + ch * double]);
        if self.embedded {
            place[3] = s;
            place[4] = cr;
        }
    }
    fn area_element_bound(&self) -> f64 {
        // (w, z), the turned figure 8, has length at most 5/4 and r-derivative at most sqrt(5);
        // its t-derivative is half of it, a quarter turn away. Along the way around the speed is 3 + w <= 17/4.
        let along: f64 = 4.25 * 4.25;
        if self.embedded {
            // Product of the two speeds.
            (5.0 * (along + 25.0 / 64.0 + 1.0)).sqrt()
        } else {
            // EG - F^2 = (3 + w)^2 (w_r^2 + z_r^2) + (sin 2r / 4 + sin 4r / 2)^2.
            (5.0 * along + 0.5625).sqrt()
        }
    }
}
