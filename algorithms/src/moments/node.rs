//! A node of the tree.

/// A run of points.
pub(super) struct Node {
    pub(super) start: u32,
    pub(super) end: u32,
    /// The second child; the first one is the next node. 0 for a leaf.
    pub(super) right: u32,
    /// Largest distance of a point from the mean.
    pub(super) radius: f64,
}

impl Node {
    /// A leaf, for now.
    pub(super) fn of(start: u32, count: usize) -> Self {
        Self {
            start,
            end: start + count as u32,
            right: 0,
            radius: 0.0,
        }
    }

    pub(super) fn count(&self) -> usize {
        (self.end - self.start) as usize
    }

    pub(super) fn is_leaf(&self) -> bool {
        self.right == 0
    }
}
