//! Conformations drawn near-uniformly by area.

use super::chart::Scratch;
use super::conformations::RingConformations;
use super::error::RingError;
use super::net::{DISC, Net, Sheets};
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
        let separation = SEPARATION * self.fixed.scale;
        let net = Net::spread(self, separation, &mut Random::stream(seed, 0))?;
        let radius = DISC * separation;
        let mut drawing = Drawing::new(self, &net, radius, Random::stream(seed, 1));
        // Draws from a disc of full size.
        let mut per_chart = 0usize;
        let size: f64 = net.charts.iter().map(|c| c.scale * c.scale).sum();
        let expected = (3.0 * count as f64 / size) as usize + 1;
        while drawing.labels.len() < count {
            let round = expected
                .min(8)
                .max(if per_chart == 0 { expected / 2 } else { 1 });
            per_chart += round;
            drawing.round(round);
            let given_up = drawing.given_up();
            if given_up > GIVEN_UP {
                return Err(RingError::TooBent { given_up });
            }
        }
        let disc = 0.5 * TAU * radius * radius;
        let area = |w: &f64| w * disc / per_chart as f64;
        let mut order = drawing.random.permutation(drawing.labels.len());
        order.truncate(count);
        Ok(RingSample {
            areas: drawing.weight.iter().map(area).collect(),
            given_up: drawing.given_up(),
            pieces: order.iter().map(|&k| drawing.labels[k]).collect(),
            points: PointCloud::new(self.dimension(), drawing.coordinates)?.select(&order),
            charts: net.charts.len(),
            margin: net.margin,
        })
    }
}

/// Draws from the discs of all charts.
struct Drawing<'a> {
    ring: &'a RingConformations,
    net: &'a Net,
    sheets: Sheets,
    /// Of the disc of a chart of full size.
    radius: f64,
    random: Random,
    scratch: Scratch,
    /// Of what was accepted.
    coordinates: Vec<f64>,
    /// The piece of each that was accepted.
    labels: Vec<u32>,
    /// Sum of the probabilities of acceptance, by piece.
    weight: Vec<f64>,
    draws: usize,
    failures: usize,
}

impl<'a> Drawing<'a> {
    fn new(ring: &'a RingConformations, net: &'a Net, radius: f64, random: Random) -> Self {
        let sheets = net.sheets();
        Self {
            ring,
            net,
            radius,
            random,
            scratch: Scratch::new(ring),
            coordinates: Vec::new(),
            labels: Vec::new(),
            weight: vec![0.0; sheets.pieces],
            sheets,
            draws: 0,
            failures: 0,
        }
    }

    /// Share of the draws that were given up.
    fn given_up(&self) -> f64 {
        self.failures as f64 / self.draws as f64
    }

    /// A whole round: every chart gives as many draws as its disc is large, `draws` those of full size.
    fn round(&mut self, draws: usize) {
        for (k, chart) in self.net.charts.iter().enumerate() {
            // In proportion to the area of the disc, rounded up as often as its fraction says.
            let share = draws as f64 * chart.scale * chart.scale;
            let more = chart.scale < 1.0 && self.random.uniform() < share.fract();
            for _ in 0..share as usize + usize::from(more) {
                self.draw(k);
            }
        }
    }

    /// One place in the disc of a chart, lifted to the surface, which is accepted or not.
    fn draw(&mut self, k: usize) {
        let chart = &self.net.charts[k];
        self.draws += 1;
        let reach = self.radius * chart.scale * self.random.uniform().sqrt();
        let (s, c) = libm::sincos(self.random.between(0.0, TAU));
        if !chart.lift(self.ring, [reach * c, reach * s], &mut self.scratch) {
            self.failures += 1;
            return;
        }
        let holds = |&&other: &&u32| {
            let other = &self.net.charts[other as usize];
            let [a, b] = other.coordinates(&self.scratch.place);
            a * a + b * b < (self.radius * other.scale).powi(2)
        };
        let cover = 1 + self.sheets.beside[k].iter().filter(holds).count();
        let acceptance = 1.0 / cover as f64;
        self.weight[self.sheets.piece[k] as usize] += acceptance;
        if self.random.uniform() < acceptance {
            self.coordinates.extend_from_slice(&self.scratch.place);
            self.labels.push(self.sheets.piece[k]);
        }
    }
}
