//! One piece of a surface: a parametrized patch that can be measured, sampled and approached.

use super::nearest::{Patch, nearest_distances};
use super::{Jet, Random, area_element};
use crosscap_core::PointCloud;

/// How points are spread over a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplingLaw {
    /// Uniform by area: equal areas hold equally many points, on average.
    #[default]
    Area,
    /// Uniform over the rectangle of parameters, which the paper does for its figure-8 Klein bottle.
    Parameters,
}

/// A straight way through the rectangle of parameters, along a rim of the patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RimSegment {
    /// Where it starts.
    pub from: [f64; 2],
    /// Where it ends; the next segment of the same rim starts at the same *place*.
    pub to: [f64; 2],
}

/// Points drawn from a piece.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// Coordinates in row order.
    pub coordinates: Vec<f64>,
    /// Parameters of each point.
    pub parameters: Vec<[f64; 2]>,
}

/// A patch of a surface (or, with [`Piece::dimension`] 1, a curve), parametrized over a rectangle.
///
/// One formula, [`Piece::map`], gives places, tangents, area and distance; a piece overrides
/// whatever it knows in closed form.
pub trait Piece: Send + Sync {
    /// Name, unique within a surface.
    fn name(&self) -> &'static str;

    /// N, the number of coordinates of a place.
    fn ambient_dimension(&self) -> usize;

    /// 2 for a patch of a surface, 1 for a curve (whose second parameter has no effect).
    fn dimension(&self) -> u8 {
        2
    }

    /// The rectangle of parameters: lower and upper end of the first, then of the second.
    fn domain(&self) -> [[f64; 2]; 2];

    /// For each parameter whether the patch ends at the ends of its range. Where it does not, the
    /// range is a seam, and [`Piece::map`] continues the same surface beyond it.
    fn ends(&self) -> [bool; 2];

    /// Writes the place at the given parameters into `place`, N coordinates.
    fn map(&self, parameters: [Jet; 2], place: &mut [Jet]);

    /// Whether the parameters, inside the domain, have a place on the patch: `false` for patches
    /// that do not fill their rectangle.
    fn holds(&self, _parameters: [f64; 2]) -> bool {
        true
    }

    /// An upper bound of the area element over the domain, for sampling by rejection.
    fn area_element_bound(&self) -> f64;

    /// The curves in which the patch ends, each a closed way.
    fn rims(&self) -> Vec<Vec<RimSegment>> {
        Vec::new()
    }

    /// Area (length for a curve): Gauss-Legendre quadrature of the area element, 24 x 24 panels of
    /// 6 x 6 nodes.
    fn area(&self) -> f64 {
        let mut place = vec![Jet::default(); self.ambient_dimension()];
        let [first, second] = self.domain().map(quadrature_nodes);
        let mut sum = 0.0;
        for &(u, weight) in &first {
            for &(v, other) in &second {
                self.map([Jet::first(u), Jet::second(v)], &mut place);
                sum += weight * other * area_element(&place);
            }
        }
        sum
    }

    /// Draws parameters and the probability with which to accept them, so that what is accepted
    /// is uniform by area. `place` receives the place.
    fn propose(&self, random: &mut Random, place: &mut [Jet]) -> ([f64; 2], f64) {
        let at = self.domain().map(|[low, high]| random.between(low, high));
        if !self.holds(at) {
            return (at, 0.0);
        }
        self.map([Jet::first(at[0]), Jet::second(at[1])], place);
        (at, area_element(place) / self.area_element_bound())
    }

    /// Draws `count` points by `law`.
    fn draw(&self, count: usize, law: SamplingLaw, random: &mut Random) -> Drawn {
        let mut drawn = Drawn::default();
        let mut place = vec![Jet::default(); self.ambient_dimension()];
        while drawn.parameters.len() < count {
            let at = match law {
                SamplingLaw::Area => {
                    let (at, acceptance) = self.propose(random, &mut place);
                    debug_assert!(
                        acceptance <= 1.0 + 1e-12,
                        "{}: {acceptance} at {at:?}",
                        self.name()
                    );
                    if acceptance < 1.0 && random.uniform() >= acceptance {
                        continue;
                    }
                    at
                }
                SamplingLaw::Parameters => {
                    let at = self.domain().map(|[low, high]| random.between(low, high));
                    if !self.holds(at) {
                        continue;
                    }
                    self.map(at.map(Jet::constant), &mut place);
                    at
                }
            };
            drawn.parameters.push(at);
            drawn.coordinates.extend(place.iter().map(|j| j.value));
        }
        drawn
    }

    /// Distance of a place to the piece, where there is a closed form.
    fn closed_form_distance(&self, _place: &[f64]) -> Option<f64> {
        None
    }

    /// Distance of every point of `cloud` to the piece: the closed form, or Levenberg-Marquardt
    /// iterations from every local minimum over a grid of parameters.
    fn distances(&self, cloud: &PointCloud<f64>) -> Vec<f64> {
        let closed: Option<Vec<f64>> = cloud.iter().map(|p| self.closed_form_distance(p)).collect();
        closed.unwrap_or_else(|| {
            let patch = Patch {
                dimension: self.ambient_dimension(),
                domain: self.domain(),
                ends: self.ends(),
                map: &|parameters, place| self.map(parameters, place),
            };
            nearest_distances(&patch, cloud)
        })
    }
}

/// The place at given parameters.
pub fn place_at<P: Piece + ?Sized>(piece: &P, parameters: [f64; 2]) -> Vec<f64> {
    let mut place = vec![Jet::default(); piece.ambient_dimension()];
    piece.map(parameters.map(Jet::constant), &mut place);
    place.iter().map(|j| j.value).collect()
}

/// Nodes and weights of the composite 6-point Gauss-Legendre rule on a range, 24 panels.
fn quadrature_nodes([low, high]: [f64; 2]) -> Vec<(f64, f64)> {
    // Abramowitz and Stegun, table 25.4.
    const NODES: [(f64, f64); 3] = [
        (0.238_619_186_083_196_9, 0.467_913_934_572_691_05),
        (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
        (0.932_469_514_203_152, 0.171_324_492_379_170_35),
    ];
    const PANELS: usize = 24;
    let half = (high - low) / (2 * PANELS) as f64;
    (0..PANELS)
        .flat_map(|panel| {
            let middle = low + (2 * panel + 1) as f64 * half;
            NODES.into_iter().flat_map(move |(node, weight)| {
                [
                    (middle - half * node, half * weight),
                    (middle + half * node, half * weight),
                ]
            })
        })
        .collect()
}
