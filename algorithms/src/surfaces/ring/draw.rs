//! Conformations drawn near-uniformly by area.

use super::chart::Scratch;
use super::conformations::RingConformations;
use super::error::RingError;
use super::net::{DISC, Net};
use crate::surfaces::Random;
use crosscap_core::{Error, PointCloud};
use std::f64::consts::TAU;

/// Conformations drawn by [`RingConformations::sample`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RingSample {
    /// The conformations, 3 coordinates an atom (x, y, z of atom 0, of atom 1, ..), in random order.
    pub points: PointCloud<f64>,
    /// For each the smooth piece of the surface it lies on, the larger piece first.
    pub pieces: Vec<u32>,
    /// Area of each piece, an estimate with an error of about a percent.
    pub areas: Vec<f64>,
    /// Number of charts the sample was drawn from.
    pub charts: usize,
    /// Share of the draws that were given up because the solver did not settle (beside the double curves).
    pub given_up: f64,
    /// How clearly the alignment is determined, the least over the charts: see
    /// [`RingConformations::alignment_margin`].
    pub margin: f64,
}

/// Separation of the centers of charts, in units of the mean bond length (0.07 Angstrom for cyclo-octane).
pub(super) const SEPARATION: f64 = 0.046;
/// Largest share of draws that may be given up.
const GIVEN_UP: f64 = 0.01;

impl RingConformations {
    /// Draws `count` conformations, near-uniform by area, also beside the double curves.
    ///
    /// The surface is covered by charts, each on one sheet, whose centers are a net: from random
    /// conformations charts spread over what is not covered yet. Then points are drawn in the tangent disc of every chart,
    /// lifted to the surface, and accepted with probability 1 / (number of charts of the same sheet whose disc holds
    /// the place). What remains is the variation of the area element within a chart, below 1 %.
    ///
    /// The same seed gives the same points on one platform; on another the eigenvectors behind the charts may
    /// differ in their last digits.
    ///
    /// O(count) after some 10,000 charts.
    ///
    /// # Errors
    /// [`RingError::Input`] when `count` is 0; [`RingError::NotClosed`] when no conformation with these lengths and
    /// angles is found; [`RingError::Dependent`], [`RingError::Unaligned`], [`RingError::TooBent`] when those that
    /// are found are no surface, or none that can be aligned or charted.
    pub fn sample(&self, count: usize, seed: u64) -> Result<RingSample, RingError> {
        if count == 0 {
            return Err(RingError::Input(Error::Parameter {
                name: "count",
                value: "0".into(),
                expected: "at least 1 conformation".into(),
            }));
        }
        let n = self.dimension();
        let separation = SEPARATION * self.fixed.scale;
        let net = Net::spread(self, separation, &mut Random::stream(seed, 0))?;
        let radius = DISC * separation;
        let sheets = net.sheets();
        let mut random = Random::stream(seed, 1);
        let mut scratch = Scratch::new(self);
        let mut coordinates = Vec::with_capacity(count * n);
        let mut labels: Vec<u32> = Vec::with_capacity(count);
        let mut weight = vec![0.0; sheets.pieces];
        let (mut draws, mut failures) = (0usize, 0usize);
        // Draws from a disc of full size.
        let mut per_chart = 0usize;
        let size: f64 = net.charts.iter().map(|c| c.scale * c.scale).sum();
        let expected = (3.0 * count as f64 / size) as usize + 1;
        while labels.len() < count {
            // Whole rounds: every chart gives as many draws as its disc is large.
            let round = expected
                .min(8)
                .max(if per_chart == 0 { expected / 2 } else { 1 });
            per_chart += round;
            for (k, chart) in net.charts.iter().enumerate() {
                // In proportion to the area of the disc, rounded up as often as its fraction says.
                let share = round as f64 * chart.scale * chart.scale;
                let more = chart.scale < 1.0 && random.uniform() < share.fract();
                for _ in 0..share as usize + usize::from(more) {
                    draws += 1;
                    let reach = radius * chart.scale * random.uniform().sqrt();
                    let (s, c) = libm::sincos(random.between(0.0, TAU));
                    if !chart.lift(self, [reach * c, reach * s], &mut scratch) {
                        failures += 1;
                        continue;
                    }
                    let holds = |&&other: &&u32| {
                        let other = &net.charts[other as usize];
                        let [a, b] = other.coordinates(&scratch.place);
                        a * a + b * b < (radius * other.scale).powi(2)
                    };
                    let cover = 1 + sheets.beside[k].iter().filter(holds).count();
                    let acceptance = 1.0 / cover as f64;
                    weight[sheets.piece[k] as usize] += acceptance;
                    if random.uniform() < acceptance {
                        coordinates.extend_from_slice(&scratch.place);
                        labels.push(sheets.piece[k]);
                    }
                }
            }
            let given_up = failures as f64 / draws as f64;
            if given_up > GIVEN_UP {
                return Err(RingError::TooBent { given_up });
            }
        }
        let disc = 0.5 * TAU * radius * radius;
        let areas = weight.iter().map(|w| w * disc / per_chart as f64).collect();
        let mut order = random.permutation(labels.len());
        order.truncate(count);
        Ok(RingSample {
            points: PointCloud::new(n, coordinates)?.select(&order),
            pieces: order.iter().map(|&k| labels[k]).collect(),
            areas,
            charts: net.charts.len(),
            given_up: failures as f64 / draws as f64,
            margin: net.margin,
        })
    }
}
