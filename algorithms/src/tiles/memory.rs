//! Tiles that are held by this process.

use super::question::{Answer, Question, Tiles};
use super::row::CloudRow;
use super::tile::Tile;
use super::tiling::{TileId, Tiling};
use crate::execute::{self, Execute};
use crate::landmarks::{random_ranks, random_ranks_but};
use crosscap_core::{Error, PointCloud, Table};
use std::sync::{PoisonError, RwLock};

/// The tiles of a cloud in memory, asked side by side.
pub struct TilesInMemory<'a> {
    tiles: RwLock<Vec<Tile>>,
    seed: u64,
    points: usize,
    dimension: usize,
    halo: f64,
    execute: &'a dyn Execute,
}

impl<'a> TilesInMemory<'a> {
    /// A cloud cut into tiles with a halo; `seed` is that of the random order in which landmarks are chosen.
    ///
    /// # Errors
    /// Those of [`Tile::new`].
    pub fn new(
        cloud: &PointCloud<f64>,
        tiling: &Tiling,
        halo: f64,
        seed: u64,
        execute: &'a dyn Execute,
    ) -> Result<Self, Error> {
        let mut members: Table<TileId, Vec<usize>> =
            Table::filled(tiling.bounds().len(), Vec::new());
        for (row, place) in cloud.iter().enumerate() {
            tiling.near(place, halo, |tile| members[tile].push(row));
        }
        let ranks = random_ranks(cloud.len(), seed);
        let tiles = (tiling.bounds().each().zip(members.iter())).map(|((_, bounds), rows)| {
            Tile::new(
                bounds.clone(),
                halo,
                cloud.select(rows),
                rows.iter().map(|&row| CloudRow::new(row)).collect(),
                rows.iter().map(|&row| ranks[row]).collect(),
            )
        });
        Ok(Self {
            tiles: RwLock::new(tiles.collect::<Result<_, _>>()?),
            seed,
            points: cloud.len(),
            dimension: cloud.dimension(),
            halo,
            execute,
        })
    }
}

impl Tiles for TilesInMemory<'_> {
    fn points(&self) -> usize {
        self.points
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn halo(&self) -> f64 {
        self.halo
    }

    fn bar(&self, rows: &[CloudRow]) -> Result<(), Error> {
        let barred: Vec<u32> = rows.iter().map(|row| row.index() as u32).collect();
        let ranks = random_ranks_but(self.points, &barred, self.seed);
        let mut tiles = self.tiles.write().unwrap_or_else(PoisonError::into_inner);
        for tile in tiles.iter_mut() {
            let own = tile.rows().iter().map(|row| ranks[row.index()]);
            let own = own.collect();
            tile.rank_anew(own);
        }
        Ok(())
    }

    fn ask(&self, question: &Question) -> Result<Vec<Answer>, Error> {
        let tiles = self.tiles.read().unwrap_or_else(PoisonError::into_inner);
        let answers = execute::few(self.execute, tiles.len(), |k| tiles[k].answer(question));
        answers.into_iter().collect()
    }
}
