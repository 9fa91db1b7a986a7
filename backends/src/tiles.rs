//! Tiles of a cloud in a file, for one machine whose memory is smaller than the cloud.
//!
//! The points are read once, some at a time, and written tile by tile into one scratch file. A question is answered
//! tile by tile, as many of them side by side as there are threads. Nothing else of the cloud is in memory.

mod divide;

pub use divide::bytes_to_divide;

use crate::files::{FileError, PointRows};
use crosscap_algorithms::landmarks::random_ranks_but;
use crosscap_algorithms::tiles::{Answer, CloudRow, Question, Tile, TileId, Tiles, Tiling};
use crosscap_core::execute::{Execute, few};
use crosscap_core::{Error, PointCloud, Table};
use divide::{Extent, NUMBER, SCRATCH, divided, record};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// The tiles of a cloud in a scratch file.
///
/// The file has no name: it is gone when the process is, however that ends.
pub struct TilesOnDisk<'a> {
    scratch: Mutex<File>,
    tiling: Tiling,
    /// Where the points of every tile are.
    extents: Table<TileId, Vec<Extent>>,
    points: usize,
    dimension: usize,
    halo: f64,
    seed: u64,
    execute: &'a dyn Execute,
    /// Rows of the file that were left out, in order.
    copies: Vec<u32>,
}

impl<'a> TilesOnDisk<'a> {
    /// Divides the points of a file among the tiles of a tiling, with a halo; `seed` is that of the random order in which landmarks
    /// are chosen. Of points at one place the first is taken. The scratch file is made in `folder`, and is as large as the coordinates in 64 bits and eight bytes a
    /// point, times the tiles that a point lies in.
    ///
    /// # Errors
    /// Those of [`PointRows::read`]; [`FileError::Write`] and [`FileError::Read`] where the scratch file cannot be made, written or read.
    pub fn new(
        cloud: &PointRows,
        tiling: Tiling,
        halo: f64,
        seed: u64,
        folder: &Path,
        execute: &'a dyn Execute,
    ) -> Result<Self, FileError> {
        let (file, extents) = divided(cloud, &tiling, halo, seed, folder, &[])?;
        let mut tiles = Self {
            scratch: Mutex::new(file),
            tiling,
            extents,
            points: cloud.len(),
            dimension: cloud.dimension(),
            halo,
            seed,
            execute,
            copies: Vec::new(),
        };
        let copies = tiles.gather(&Question::Copies);
        let copies = copies.map_err(|error| FileError::Read {
            path: folder.join(SCRATCH),
            source: std::io::Error::other(error),
        })?;
        if !copies.is_empty() {
            // The random order is that of the points which stay.
            tiles.copies = copies.rows().iter().map(|row| row.index() as u32).collect();
            tiles.points -= tiles.copies.len();
            let (file, extents) = divided(cloud, &tiles.tiling, halo, seed, folder, &tiles.copies)?;
            (tiles.scratch, tiles.extents) = (Mutex::new(file), extents);
        }
        Ok(tiles)
    }

    /// Bytes of the scratch file.
    pub fn bytes(&self) -> u64 {
        let all = self.extents.iter().flatten();
        all.map(|extent| extent.bytes as u64).sum()
    }

    /// Points of the largest tile, those of its halo among them.
    pub fn largest(&self) -> usize {
        let bytes = |own: &Vec<Extent>| own.iter().map(|extent| extent.bytes).sum::<usize>();
        let largest = self.extents.iter().map(bytes).max();
        largest.unwrap_or(0) / record(self.dimension)
    }

    fn tile(&self, tile: TileId) -> Result<Tile, Error> {
        let own = &self.extents[tile];
        let count = own.iter().map(|extent| extent.bytes).sum::<usize>() / record(self.dimension);
        let mut coordinates = Vec::with_capacity(count * self.dimension);
        let (mut rows, mut ranks) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut bytes = Vec::new();
        for extent in own {
            self.fetch(*extent, &mut bytes)
                .map_err(|error| Error::Storage {
                    what: format!("tile {} from the scratch file", tile.index()),
                    reason: error.to_string(),
                })?;
            for record in bytes.chunks_exact(record(self.dimension)) {
                let (place, names) = record.split_at(NUMBER * self.dimension);
                let numbers = place.as_chunks::<NUMBER>().0;
                coordinates.extend(numbers.iter().map(|&x| f64::from_le_bytes(x)));
                let names = names.as_chunks::<4>().0;
                rows.push(CloudRow::from(u32::from_le_bytes(names[0])));
                ranks.push(u32::from_le_bytes(names[1]));
            }
        }
        let points = PointCloud::new(self.dimension, coordinates)?;
        let bounds = self.tiling.bounds()[tile].clone();
        Tile::new(bounds, self.halo, points, rows, ranks)
    }

    /// Writes other ranks into the records of a part of the file.
    fn rank_anew(&self, extent: Extent, ranks: &[u32], bytes: &mut Vec<u8>) -> std::io::Result<()> {
        self.fetch(extent, bytes)?;
        for record in bytes.chunks_exact_mut(record(self.dimension)) {
            let (row, rank) = record[NUMBER * self.dimension..].split_at_mut(size_of::<u32>());
            let row = row
                .iter()
                .rev()
                .fold(0, |row, &byte| row << 8 | usize::from(byte));
            rank.copy_from_slice(&ranks[row].to_le_bytes());
        }
        let mut file = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(extent.at))?;
        file.write_all(bytes)
    }

    fn fetch(&self, extent: Extent, bytes: &mut Vec<u8>) -> std::io::Result<()> {
        bytes.resize(extent.bytes, 0);
        let mut file = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(extent.at))?;
        file.read_exact(bytes)
    }
}

impl Tiles for TilesOnDisk<'_> {
    fn points(&self) -> usize {
        self.points
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn halo(&self) -> f64 {
        self.halo
    }

    fn input_row(&self, row: CloudRow) -> usize {
        // Before the copy at `k` in the list so many points stay as its row says, less k.
        let (mut low, mut high) = (0, self.copies.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.copies[middle] as usize - middle <= row.index() {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        row.index() + low
    }

    fn left_out(&self) -> usize {
        self.copies.len()
    }

    fn bar(&self, rows: &[CloudRow]) -> Result<(), Error> {
        let barred: Vec<u32> = rows.iter().map(|row| row.index() as u32).collect();
        let ranks = random_ranks_but(self.points, &barred, self.seed);
        let mut bytes = Vec::new();
        for &extent in self.extents.iter().flatten() {
            self.rank_anew(extent, &ranks, &mut bytes)
                .map_err(|error| Error::Storage {
                    what: "a random order into the scratch file".into(),
                    reason: error.to_string(),
                })?;
        }
        Ok(())
    }

    fn ask(&self, question: &Question) -> Result<Vec<Answer>, Error> {
        let answers = few(self.execute, self.extents.len(), |k| {
            self.tile(TileId::new(k))?.answer(question)
        });
        let answers: Result<Vec<Answer>, Error> = answers.into_iter().collect();
        answers.map_err(|mut error| {
            if let Error::SparseNeighborhood { point, .. } = &mut error {
                *point = self.input_row(CloudRow::new(*point));
            }
            error
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::write_points;
    use crosscap_algorithms::surfaces::Random;
    use crosscap_algorithms::tiles::TilesInMemory;
    use crosscap_core::execute::Serial;

    #[test]
    fn answers_are_those_of_tiles_in_memory() {
        let mut random = Random::new(3);
        let numbers: Vec<f64> = (0..3 * 20_000).map(|_| random.uniform()).collect();
        let cloud = PointCloud::new(3, numbers).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.npy");
        write_points(&path, &cloud).unwrap();
        let rows = PointRows::open(&path).unwrap();
        let (tiling, halo, seed) = (Tiling::new(&cloud, 5), 0.1, 9);
        let memory = TilesInMemory::new(&cloud, &tiling, halo, seed, &Serial).unwrap();
        let disk = TilesOnDisk::new(&rows, tiling, halo, seed, folder.path(), &Serial).unwrap();
        let taken = crosscap_algorithms::tiles::Gathered::new(3);
        let separation = 0.09;
        for question in [
            Question::Landmarks { separation, taken },
            Question::Rows((10..400).map(CloudRow::new).collect()),
        ] {
            assert_eq!(disk.ask(&question).unwrap(), memory.ask(&question).unwrap());
        }
        // Ranked anew without some rows, which leaves all else as it is.
        let barred: Vec<CloudRow> = (0..6_000).map(|k| CloudRow::new(3 * k)).collect();
        let taken = memory
            .rows(vec![CloudRow::new(0), CloudRow::new(7_000)])
            .unwrap();
        memory.bar(&barred).unwrap();
        disk.bar(&barred).unwrap();
        let question = Question::Landmarks { separation, taken };
        let anew = disk.ask(&question).unwrap();
        assert_eq!(anew, memory.ask(&question).unwrap());
        for answer in anew {
            let Answer::Landmarks { chosen, .. } = answer else {
                panic!("{answer:?}")
            };
            assert!(chosen.rows().iter().all(|row| !barred.contains(row)));
        }
        let least = 20_000 / 5 * record(3) as u64;
        assert!(disk.bytes() > 5 * least && disk.bytes() < 15 * least);
        assert!(disk.largest() > 20_000 / 5);
        assert_eq!((disk.left_out(), disk.input_row(CloudRow::new(7))), (0, 7));
        // The scratch file has no name.
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
    #[test]
    fn copies_are_left_out_and_rows_are_those_of_the_file() {
        let mut random = Random::new(5);
        let distinct: Vec<[f64; 2]> = (0..300)
            .map(|_| [random.uniform(), random.uniform()])
            .collect();
        // Copies stand anywhere, first, behind each other, last.
        let mut rows = distinct.clone();
        for (at, of) in [(0, 7), (1, 7), (50, 9), (120, 9), (304, 0)] {
            rows.insert(at, distinct[of]);
        }
        let input = PointCloud::new(2, rows.concat()).unwrap();
        let first = |row: usize| (0..row).all(|other| rows[other] != rows[row]);
        let kept: Vec<usize> = (0..rows.len()).filter(|&row| first(row)).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.npy");
        write_points(&path, &input).unwrap();
        let file = PointRows::open(&path).unwrap();
        let tiling = Tiling::new(&input, 3);
        let disk = TilesOnDisk::new(&file, tiling.clone(), 0.2, 1, folder.path(), &Serial).unwrap();
        assert_eq!((disk.points(), disk.left_out()), (300, 5));
        let named: Vec<usize> = (0..300)
            .map(|row| disk.input_row(CloudRow::new(row)))
            .collect();
        assert_eq!(named, kept);
        let kept = input.select(&kept);
        let memory = TilesInMemory::new(&kept, &tiling, 0.2, 1, &Serial).unwrap();
        let taken = crosscap_algorithms::tiles::Gathered::new(2);
        let question = Question::Landmarks {
            separation: 0.1,
            taken,
        };
        assert_eq!(disk.ask(&question).unwrap(), memory.ask(&question).unwrap());
    }
}
