//! The points of a file on their way to the tiles of a scratch file.

use crate::files::{FileError, PointRows};
use crosscap_algorithms::landmarks::random_ranks;
use crosscap_algorithms::tiles::{TileId, Tiling};
use crosscap_core::Table;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Bytes of coordinates that are read at a time, and bytes that wait to be written, of all tiles together.
const AT_ONCE: usize = 4 << 20;
/// Fewest bytes that wait for one tile, so that the file is written in pieces and not number by number.
const LEAST_WAITING: usize = 4 << 10;
/// What the scratch file is called in messages.
pub(super) const SCRATCH: &str = "(scratch file)";
/// Bytes of a coordinate.
pub(super) const NUMBER: usize = size_of::<f64>();
/// Bytes of row and rank of a point.
const NAMES: usize = 2 * size_of::<u32>();

/// Bytes that are held while the points are divided among tiles: what is read and what waits, and the random order of all
/// points while it is made.
pub fn bytes_to_divide(points: usize, tiles: usize) -> u64 {
    let waiting = AT_ONCE.max(tiles * LEAST_WAITING);
    (3 * AT_ONCE + waiting) as u64 + 2 * size_of::<u32>() as u64 * points as u64
}

/// A part of the file.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    pub(super) at: u64,
    pub(super) bytes: usize,
}

/// Bytes of a point.
pub(super) fn record(dimension: usize) -> usize {
    NUMBER * dimension + NAMES
}

/// The points of a file but `copies`, rows in order, divided among tiles: the scratch file, and where the points of every tile are.
pub(super) fn divided(
    cloud: &PointRows,
    tiling: &Tiling,
    halo: f64,
    seed: u64,
    folder: &Path,
    copies: &[u32],
) -> Result<(File, Table<TileId, Vec<Extent>>), FileError> {
    let unwritten = |source| FileError::Write {
        path: folder.join(SCRATCH),
        source,
    };
    let mut divided = Divided::new(tiling, tempfile::tempfile_in(folder).map_err(unwritten)?);
    let ranks = random_ranks(cloud.len() - copies.len(), seed);
    let rows_at_once = (AT_ONCE / (NUMBER * cloud.dimension().max(1))).max(1);
    let mut copies = copies.iter().copied().peekable();
    let mut row: u32 = 0;
    for start in (0..cloud.len()).step_by(rows_at_once) {
        let rows = start..cloud.len().min(start + rows_at_once);
        let points = cloud.read(rows.clone())?;
        let mut written = Ok(());
        for (input, place) in rows.zip(points.iter()) {
            if copies.next_if_eq(&(input as u32)).is_some() {
                continue;
            }
            tiling.near(place, halo, |tile| {
                if written.is_ok() {
                    written = divided.push(tile, place, row, ranks[row as usize]);
                }
            });
            row += 1;
        }
        written.map_err(unwritten)?;
    }
    divided.end().map_err(unwritten)
}

/// Points on their way to the file.
struct Divided {
    file: File,
    at: u64,
    waiting: Table<TileId, Vec<u8>>,
    /// How many bytes wait for a tile before they are written.
    most: usize,
    extents: Table<TileId, Vec<Extent>>,
}

impl Divided {
    fn new(tiling: &Tiling, file: File) -> Self {
        let count = tiling.bounds().len();
        Self {
            file,
            at: 0,
            waiting: Table::filled(count, Vec::new()),
            most: (AT_ONCE / count.max(1)).max(LEAST_WAITING),
            extents: Table::filled(count, Vec::new()),
        }
    }

    fn push(&mut self, tile: TileId, place: &[f64], row: u32, rank: u32) -> std::io::Result<()> {
        let own = &mut self.waiting[tile];
        if own.capacity() == 0 {
            own.reserve_exact(self.most + record(place.len()));
        }
        place.iter().for_each(|x| own.extend(x.to_le_bytes()));
        own.extend(row.to_le_bytes());
        own.extend(rank.to_le_bytes());
        if own.len() >= self.most {
            return self.write(tile);
        }
        Ok(())
    }

    fn write(&mut self, tile: TileId) -> std::io::Result<()> {
        let own = &mut self.waiting[tile];
        self.file.write_all(own)?;
        let bytes = own.len();
        self.extents[tile].push(Extent { at: self.at, bytes });
        self.at += bytes as u64;
        own.clear();
        Ok(())
    }

    fn end(mut self) -> std::io::Result<(File, Table<TileId, Vec<Extent>>)> {
        let left: Vec<TileId> = self.waiting.ids().collect();
        for tile in left {
            if !self.waiting[tile].is_empty() {
                self.write(tile)?;
            }
        }
        Ok((self.file, self.extents))
    }
}
