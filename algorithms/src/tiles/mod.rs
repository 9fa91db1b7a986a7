//! A cloud in pieces: what can be told of a part of it from that part and its surroundings.
//!
//! Space is cut into boxes ([`Tiling`]). A [`Tile`] is what is in a box, with all points up to a halo away from it, in the
//! order of the cloud. It answers a [`Question`] about its own points exactly as the whole cloud would: what is
//! asked depends on points no farther than the halo, distances are computed from the same coordinates by the same operations, and
//! ties are broken by rows. Nothing depends on where the cuts are.
//!
//! | question | depends on points up to |
//! | --- | --- |
//! | which points are landmarks, given some that are ([`landmarks`] asks until all are known) | dl |
//! | which balls are not 2-dimensional, and what models see in those that are | eps |
//! | the neighborhoods of landmarks that no curve is near | the widest chart and dl |
//! | the nearest point of a place | the halo; whoever is farther from all points is asked about again, by all tiles |
//!
//! A tile keeps nothing between questions, and whoever has the tiles is [`Tiles`]: this process ([`TilesInMemory`]), or workers that may
//! die and be replaced. Curves are not told tile by tile: fits are made in an order that all candidates decide together, and curves are laid over all
//! points on them. They depend on the points about balls that are not 2-dimensional alone, which are gathered in one place: an [`Excerpt`], in which
//! [`Curves`] are what they are in the whole cloud.

mod answer;
mod balls;
mod cells;
mod choice;
mod curves;
mod excerpt;
mod gathered;
mod greedy;
mod known;
mod memory;
mod question;
mod row;
mod tile;
mod tiling;

#[cfg(test)]
mod tests;

pub use answer::halo;
pub use choice::landmarks;
pub use curves::{Curves, NearCurves};
pub use excerpt::{Candidates, Excerpt, WatchedOracle};
pub use gathered::Gathered;
pub use memory::TilesInMemory;
pub use question::{
    Answer, BallQuestion, BallsOfTile, BehindQuestion, CellQuestion, LookQuestion, Question, Tiles,
};
pub use row::CloudRow;
pub use tile::Tile;
pub use tiling::{Bounds, TileId, Tiling};
