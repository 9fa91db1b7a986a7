//! Dimensions of balls, tile by tile.

use super::question::{BallQuestion, BallsOfTile};
use super::tile::Tile;
use crate::execute::Serial;
use crate::moments::MomentTree;
use crosscap_core::{Error, Row};

/// The balls of the points in the box. Those about points of the halo are cut, and looked at only as far as they are in a ball of the box.
///
/// # Errors
/// Those of [`MomentTree::settled_dimensions`].
pub(super) fn of_tile(tile: &Tile, question: &BallQuestion) -> Result<BallsOfTile, Error> {
    let eps = question.eps;
    let near: Vec<usize> = (tile.ids())
        .filter(|&row| tile.bounds().reach(tile.place(row), eps))
        .map(Row::index)
        .collect();
    let mut found = BallsOfTile::default();
    let mut centers: Vec<Row> = Vec::new();
    let part = tile.points().select(&near);
    let tree = MomentTree::with(&part, &Serial)?;
    let balls = tree.settled_dimensions(eps, question.dt, &Serial)?;
    // A value above the dimension of the space is an error of chance.
    let most = part.dimension().min(u8::MAX.into()) as u32;
    for (row, ball) in near.into_iter().map(Row::new).zip(balls) {
        if !tile.owns(row) {
            continue;
        }
        if (ball.neighbors as usize) < question.least && found.sparse.is_none() {
            found.sparse = Some((tile.cloud_row(row), ball.neighbors));
        }
        found.neighbors += u64::from(ball.neighbors);
        let dimension = ball.dimension.min(most);
        if dimension != 2 {
            centers.push(row);
            found.balls.push([ball.neighbors, dimension]);
        }
    }
    found.centers = tile.gathered(centers);
    Ok(found)
}
