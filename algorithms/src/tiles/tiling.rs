//! How space is cut into tiles.

use crosscap_core::{PointCloud, Table};
use serde::{Deserialize, Serialize};

crosscap_core::id! {
    /// A tile, by its place among those of a tiling.
    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct TileId(u32);
}

/// Where a place belongs to more than one tile by rounding alone, all of them hold it.
const ROUNDING: f64 = 1e-9;

/// A box with sides parallel to the axes: what is at least `low` and less than `high` in every coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Bounds {
    /// All of space.
    fn everything(dimension: usize) -> Self {
        Self {
            low: vec![f64::NEG_INFINITY; dimension],
            high: vec![f64::INFINITY; dimension],
        }
    }

    /// Number of coordinates.
    pub fn dimension(&self) -> usize {
        self.low.len()
    }

    /// Whether a place is in the box.
    pub fn hold(&self, place: &[f64]) -> bool {
        let sides = self.low.iter().zip(&self.high);
        (sides.zip(place)).all(|((low, high), x)| low <= x && x < high)
    }

    /// Distance of a place from the box, 0 inside.
    pub fn distance(&self, place: &[f64]) -> f64 {
        let sides = self.low.iter().zip(&self.high);
        let beside = |((low, high), x): ((&f64, &f64), &f64)| (low - x).max(x - high).max(0.0);
        let squares = sides.zip(place).map(|side| beside(side).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Whether a place is in the box or at most `halo` away from it; one that is farther by rounding alone counts.
    pub fn reach(&self, place: &[f64], halo: f64) -> bool {
        self.distance(place) <= halo * (1.0 + ROUNDING)
    }
}

/// A cut across one coordinate, or what no cut goes through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Node {
    Tile(TileId),
    /// What is less than `at` in coordinate `axis` is in the node `below`, all else in the node `above`.
    Cut {
        axis: u32,
        at: f64,
        below: u32,
        above: u32,
    },
}

/// Space cut into boxes, each of which is a tile. Every place is in one of them.
///
/// The cuts are medians of a sample of the points, so that tiles have about as many points each, whatever their density.
///
/// ```
/// use crosscap_algorithms::tiles::{TileId, Tiling};
/// use crosscap_core::PointCloud;
/// let line = PointCloud::new(2, (0..8).flat_map(|k| [f64::from(k), 0.0]).collect())?;
/// let tiling = Tiling::new(&line, 2);
/// assert_eq!(tiling.bounds().len(), 2);
/// assert_ne!(tiling.tile_of(&[1.0, 5.0]), tiling.tile_of(&[6.0, 5.0]));
/// let mut near = Vec::new();
/// tiling.near(&[4.5, 0.0], 1.0, |tile| near.push(tile));
/// assert_eq!(near, [TileId::new(0), TileId::new(1)]); // half a unit from the cut at 4
/// # Ok::<(), crosscap_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tiling {
    nodes: Vec<Node>,
    bounds: Table<TileId, Bounds>,
}

/// A node that may be cut: its number, and positions in the sample.
struct Leaf {
    node: usize,
    bounds: Bounds,
    positions: Vec<usize>,
}

impl Tiling {
    /// A tiling with `tiles` tiles (at least one), or as many as a `sample` of the points can be cut into: the tile with
    /// most points is cut at the median of the coordinate in which it extends farthest, until there are enough.
    ///
    /// O(t s) for t tiles and a sample of s points.
    pub fn new(sample: &PointCloud<f64>, tiles: usize) -> Self {
        let whole = Leaf {
            node: 0,
            bounds: Bounds::everything(sample.dimension()),
            positions: (0..sample.len()).collect(),
        };
        let mut nodes = vec![Node::Tile(TileId::default())];
        let (mut open, mut done) = (vec![whole], Vec::new());
        while open.len() + done.len() < tiles.max(1) && !open.is_empty() {
            let fullest = (0..open.len()).fold(0, |best, k| {
                let more = open[k].positions.len() > open[best].positions.len();
                if more { k } else { best }
            });
            let leaf = open.swap_remove(fullest);
            match leaf.cut(sample, &mut nodes) {
                Ok(halves) => open.extend(halves),
                Err(whole) => done.push(whole),
            }
        }
        done.append(&mut open);
        done.sort_by_key(|leaf| leaf.node);
        let mut bounds = Table::default();
        for leaf in done {
            nodes[leaf.node] = Node::Tile(bounds.push(leaf.bounds));
        }
        Self { nodes, bounds }
    }

    /// The boxes of the tiles.
    pub fn bounds(&self) -> &Table<TileId, Bounds> {
        &self.bounds
    }

    /// The tile that a place is in.
    pub fn tile_of(&self, place: &[f64]) -> TileId {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Tile(tile) => return tile,
                Node::Cut {
                    axis,
                    at,
                    below,
                    above,
                } => {
                    let next = if place[axis as usize] < at {
                        below
                    } else {
                        above
                    };
                    node = next as usize;
                }
            }
        }
    }

    /// Visits every tile whose box is at most `halo` away from a place, in order.
    pub fn near(&self, place: &[f64], halo: f64, mut visit: impl FnMut(TileId)) {
        let reach = halo * (1.0 + ROUNDING);
        let mut stack = vec![0_u32];
        let mut found = Vec::new();
        while let Some(node) = stack.pop() {
            match self.nodes[node as usize] {
                Node::Tile(tile) => {
                    if self.bounds[tile].reach(place, halo) {
                        found.push(tile);
                    }
                }
                Node::Cut {
                    axis,
                    at,
                    below,
                    above,
                } => {
                    let x = place[axis as usize];
                    if at - x <= reach {
                        stack.push(above);
                    }
                    if x - at <= reach {
                        stack.push(below);
                    }
                }
            }
        }
        found.sort_unstable();
        found.into_iter().for_each(&mut visit);
    }
}

impl Leaf {
    /// The two halves; itself where all of its points are at one place.
    fn cut(self, sample: &PointCloud<f64>, nodes: &mut Vec<Node>) -> Result<[Self; 2], Self> {
        let along = |axis: usize| self.positions.iter().map(move |&k| sample.point(k)[axis]);
        let extent = |axis: usize| {
            let (low, high) = along(axis).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(x), h.max(x))
            });
            high - low
        };
        let extents: Vec<f64> = (0..sample.dimension()).map(extent).collect();
        let widest = |best: usize, k: usize| if extents[k] > extents[best] { k } else { best };
        let axis = (0..extents.len()).fold(0, widest);
        if self.positions.is_empty() || extents[axis] <= 0.0 {
            return Err(self);
        }
        let mut values: Vec<f64> = along(axis).collect();
        values.sort_unstable_by(f64::total_cmp);
        let least = values[0];
        let half = values[values.len() / 2];
        // Something has to be below the cut.
        let at = match values.iter().find(|&&x| x > least) {
            Some(&next) if half <= least => next,
            _ => half,
        };
        let [below, above] = [nodes.len(), nodes.len() + 1];
        nodes.extend([Node::Tile(TileId::default()), Node::Tile(TileId::default())]);
        nodes[self.node] = Node::Cut {
            axis: axis as u32,
            at,
            below: below as u32,
            above: above as u32,
        };
        let (low, high) = (self.positions.into_iter()).partition(|&k| sample.point(k)[axis] < at);
        let mut halves = [(below, low), (above, high)].map(|(node, positions)| Self {
            node,
            bounds: self.bounds.clone(),
            positions,
        });
        halves[0].bounds.high[axis] = at;
        halves[1].bounds.low[axis] = at;
        Ok(halves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_place_is_in_one_tile_and_near_those_whose_box_is(
            sample in prop::collection::vec(-4..=4_i32, 3 * 40),
            places in prop::collection::vec(-6.0..6.0_f64, 3 * 10),
            tiles in 1_usize..20, halo in 0.0..3.0_f64,
        ) {
            let grid: Vec<f64> = sample.iter().map(|&x| f64::from(x)).collect();
            let sample = PointCloud::new(3, grid).unwrap();
            let tiling = Tiling::new(&sample, tiles);
            prop_assert!(tiling.bounds().len() <= tiles);
            let far_and_cut = places.chunks_exact(3).chain(sample.iter());
            for place in far_and_cut {
                let own: Vec<TileId> = (tiling.bounds().each()).filter(|b| b.1.hold(place)).map(|b| b.0).collect();
                prop_assert_eq!(&own, &[tiling.tile_of(place)]);
                let mut near = Vec::new();
                tiling.near(place, halo, |tile| near.push(tile));
                let expected: Vec<TileId> = (tiling.bounds().each())
                    .filter(|b| b.1.reach(place, halo)).map(|b| b.0).collect();
                prop_assert_eq!(near, expected);
            }
        }
    }

    #[test]
    fn points_at_one_place_are_one_tile() {
        let same = PointCloud::new(2, vec![1.5; 20]).unwrap();
        assert_eq!(Tiling::new(&same, 4).bounds().len(), 1);
        let nobody = PointCloud::new(2, vec![]).unwrap();
        assert_eq!(Tiling::new(&nobody, 4).bounds().len(), 1);
    }
}
