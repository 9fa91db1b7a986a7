//! The distances inside a neighborhood.

use crosscap_core::{Error, Neighborhood, Scalar};

/// Most points whose pairs are looked at; a larger neighborhood is thinned evenly by distance from
/// its center, so that its extent stays. A set of them fits into a `u128`.
const MOST: usize = 128;

/// Points of a neighborhood with all distances between them, in the order of their distance from
/// the center.
pub(super) struct Pairs {
    /// Number of points.
    pub(super) count: usize,
    /// Distances from the center.
    pub(super) radii: Vec<f64>,
    /// Radius of the ball that holds them.
    pub(super) reach: f64,
    distances: Vec<f64>,
}

impl Pairs {
    /// The pairs of a neighborhood of at least `least` points. O(min(k, 128)^2).
    ///
    /// # Errors
    /// [`Error::SparseNeighborhood`] for fewer.
    pub(super) fn of<S: Scalar>(near: &Neighborhood<'_, S>, least: usize) -> Result<Self, Error> {
        let all = near.neighbors.len();
        if all < least {
            return Err(Error::SparseNeighborhood {
                point: near.center,
                found: all,
                needed: least,
                parameter: "eps",
            });
        }
        let count = all.min(MOST);
        let chosen: Vec<_> = (0..count)
            .map(|k| near.neighbors[k * all / count])
            .collect();
        let mut distances = vec![0.0; count * count];
        for a in 0..count {
            for b in 0..a {
                let d = near
                    .metric
                    .distance(chosen[a].index, chosen[b].index)
                    .as_f64();
                distances[a * count + b] = d;
                distances[b * count + a] = d;
            }
        }
        Ok(Self {
            count,
            radii: chosen.iter().map(|x| x.distance.as_f64()).collect(),
            reach: reach(near),
            distances,
        })
    }

    /// Distances of point `a` from all, itself included.
    pub(super) fn row(&self, a: usize) -> &[f64] {
        &self.distances[a * self.count..(a + 1) * self.count]
    }
}

/// Radius of a neighborhood: as drawn, or the distance of the farthest of the k nearest.
pub(super) fn reach<S: Scalar>(near: &Neighborhood<'_, S>) -> f64 {
    if near.radius.is_finite() {
        near.radius
    } else {
        near.neighbors.last().map_or(0.0, |x| x.distance.as_f64())
    }
}
