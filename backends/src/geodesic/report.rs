//! What there is to know about a graph before trusting paths in it.

use serde::Serialize;
use std::cmp::Reverse;
use thiserror::Error;

/// Edges shorter than this many spacings make paths zigzag, and so too long.
///
/// Measured on surfaces with the method of Martin & Watson: from three spacings on, geodesic
/// neighborhoods make a radius that is far too large harmless.
pub const LEAST_REACH: f64 = 3.0;

/// A piece of a graph that no edge joins to the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Component {
    /// Number of points in it.
    pub size: usize,
    /// Its smallest point.
    pub first: usize,
}

/// What there is to know about a neighbor graph before trusting its distances.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GraphReport {
    /// Number of points.
    pub points: usize,
    /// Number of edges, each counted once.
    pub edges: usize,
    /// Spacing of the points: the median distance to the nearest point that is not a copy, among
    /// those that have an edge to one.
    pub spacing: f64,
    /// How far edges reach: the radius of the rule, or the median length of the longest edge to one of the
    /// nearest points.
    pub reach: f64,
    /// The connected components, largest first, then by their smallest point.
    pub components: Vec<Component>,
}

/// Why geodesic distances over a graph may mislead.
#[derive(Clone, Debug, Error, PartialEq, Serialize)]
#[non_exhaustive]
pub enum GraphWarning {
    /// Points in different components are at infinite distance.
    #[error(
        "the neighbor graph falls into {count} components, the largest of {largest} points; \
         point {outside} is not in it: make the edges longer, unless the data are in pieces"
    )]
    Disconnected {
        /// Number of components.
        count: usize,
        /// Number of points of the largest.
        largest: usize,
        /// A point outside of the largest.
        outside: usize,
    },
    /// Edges are short against the spacing, so that paths zigzag and come out too long.
    #[error(
        "the edges of the neighbor graph reach {reach}, {ratio:.2} times the spacing {spacing} of \
         the points: use at least {LEAST_REACH} times, or distances come out too long"
    )]
    TooCoarse {
        /// How far edges reach.
        reach: f64,
        /// Spacing of the points.
        spacing: f64,
        /// The first divided by the second.
        ratio: f64,
    },
}

impl GraphReport {
    /// Whether every two points are joined by a path.
    pub fn is_connected(&self) -> bool {
        self.components.len() <= 1
    }

    /// What speaks against using the distances; empty when nothing does.
    pub fn warnings(&self) -> Vec<GraphWarning> {
        let mut warnings = Vec::new();
        if let [largest, outside, ..] = self.components[..] {
            warnings.push(GraphWarning::Disconnected {
                count: self.components.len(),
                largest: largest.size,
                outside: outside.first,
            });
        }
        let ratio = self.reach / self.spacing;
        if ratio < LEAST_REACH {
            warnings.push(GraphWarning::TooCoarse {
                reach: self.reach,
                spacing: self.spacing,
                ratio,
            });
        }
        warnings
    }
}

/// The components by the label of every point, largest first.
pub(super) fn census(label: &[u32]) -> Vec<Component> {
    let mut place = vec![usize::MAX; label.len()];
    let mut components: Vec<Component> = Vec::new();
    for (point, &l) in label.iter().enumerate() {
        let place = &mut place[l as usize];
        if *place == usize::MAX {
            *place = components.len();
            components.push(Component {
                size: 0,
                first: point,
            });
        }
        components[*place].size += 1;
    }
    components.sort_by_key(|c| (Reverse(c.size), c.first));
    components
}
