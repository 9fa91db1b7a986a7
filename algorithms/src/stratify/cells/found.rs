//! Neighborhoods that were found.

use crosscap_core::{CellNeighborhood, Landmark};

/// The others in a neighborhood.
#[derive(Default)]
pub(super) struct Members {
    pub(super) landmarks: Vec<Landmark>,
    /// Radius of the chart that they were found in.
    pub(super) radius: f64,
}

/// Neighborhoods, those of landmarks in cells first.
pub(in crate::stratify) struct Found {
    pub(in crate::stratify) neighborhoods: Vec<CellNeighborhood>,
    /// Radius of the chart of each, which is wider than asked for where that held few landmarks.
    pub(in crate::stratify) radii: Vec<f64>,
    /// How many edges of the graph were cut.
    pub(in crate::stratify) cut_edges: usize,
}

impl Found {
    /// None yet, in a graph of which so many edges were cut.
    pub(super) fn of(cut_edges: usize) -> Self {
        Self {
            neighborhoods: Vec::new(),
            radii: Vec::new(),
            cut_edges,
        }
    }

    /// Takes the neighborhood of a landmark.
    pub(super) fn take(&mut self, center: Landmark, others: Members) {
        self.radii.push(others.radius);
        self.neighborhoods
            .push(CellNeighborhood::new(center, others.landmarks));
    }
}
