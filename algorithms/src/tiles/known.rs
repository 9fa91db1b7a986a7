//! Neighborhoods in a tile, as far as it can know them.

use super::tile::Tile;
use crosscap_core::{Error, Neighbor, NeighborhoodOracle, Row, squared_distance};
use std::sync::OnceLock;

/// Nearest neighbors among the points of a tile, as far as it can know them.
pub(super) struct UpToHalo<'a> {
    tile: &'a Tile,
    /// The first question that it could not answer.
    short: OnceLock<Error>,
}

impl<'a> UpToHalo<'a> {
    /// The neighborhoods in a tile.
    pub(super) fn new(tile: &'a Tile) -> Self {
        Self {
            tile,
            short: OnceLock::new(),
        }
    }

    /// Whether all nearest neighbors that were asked for are known.
    ///
    /// # Errors
    /// [`Error::SparseNeighborhood`] for a point whose are not.
    pub(super) fn sufficed(self) -> Result<(), Error> {
        self.short.into_inner().map_or(Ok(()), Err)
    }
}

impl NeighborhoodOracle for UpToHalo<'_> {
    type Scalar = f64;

    fn len(&self) -> usize {
        self.tile.len()
    }

    fn within(&self, center: usize, radius: f64, out: &mut Vec<Neighbor<f64>>) {
        out.clear();
        let place = self.tile.place(Row::new(center));
        self.tile.within(place, radius, |row| {
            out.push(Neighbor {
                index: row.index(),
                distance: squared_distance(place, self.tile.place(row)).sqrt(),
            });
        });
        out.sort_by(|a, b| {
            a.distance
                .total_cmp(&b.distance)
                .then(a.index.cmp(&b.index))
        });
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<f64>>) {
        let row = Row::new(center);
        let known = self.tile.known(row);
        self.within(center, known.max(0.0), out);
        if out.len() < count {
            let _ = self.short.set(Error::SparseNeighborhood {
                point: self.tile.cloud_row(row).index(),
                found: out.len(),
                needed: count,
                parameter: "dl",
            });
        }
        out.truncate(count);
    }

    fn name(&self) -> &str {
        "tile"
    }
}
