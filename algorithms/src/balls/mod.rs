//! A tree of balls over places of R^N: what is near a place, the nearest of one and of many at once.

mod nearest;
mod tree;

#[cfg(test)]
mod tests;

pub(crate) use nearest::Near;
pub(crate) use tree::BallTree;
