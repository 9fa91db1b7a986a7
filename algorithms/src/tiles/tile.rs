//! The points of a tile and of its halo.

use super::gathered::Gathered;
use super::row::CloudRow;
use super::tiling::Bounds;
use crate::balls::BallTree;
use crate::landmarks::BARRED;
use crosscap_core::{Error, PointCloud, Row, Table, positive_length, squared_distance};

/// Squared distances that are summed in another order differ by less than this share.
pub(super) const ROUNDING: f64 = 1e-12;

/// The points in a box and all points at most a halo away from it, in the order of the cloud.
///
/// A tile knows everything about the surroundings of its own points up to the halo, and nothing beyond.
pub struct Tile {
    bounds: Bounds,
    halo: f64,
    points: PointCloud<f64>,
    rows: Table<Row, CloudRow>,
    /// Place of every point in a random order of the whole cloud, [`BARRED`] where it is in none.
    ranks: Table<Row, u32>,
    tree: BallTree,
}

impl Tile {
    /// The tile of a box: all `points` of the cloud up to `halo` away from it, the rows of the cloud that they are, in
    /// order, and their places in a random order of the cloud, [`BARRED`] for points that cannot be landmarks.
    ///
    /// # Errors
    /// [`Error::Shape`] for lists that do not belong together, or rows that are not in order;
    /// [`Error::Parameter`] for a halo that is no length.
    pub fn new(
        bounds: Bounds,
        halo: f64,
        points: PointCloud<f64>,
        rows: Vec<CloudRow>,
        ranks: Vec<u32>,
    ) -> Result<Self, Error> {
        let shape = |found: String, expected: String| Err(Error::Shape { found, expected });
        positive_length("halo", halo)?;
        let count = points.len();
        if [rows.len(), ranks.len()] != [count; 2] {
            let found = format!("{} rows and {} ranks", rows.len(), ranks.len());
            return shape(found, format!("{count} of each, as many as points"));
        }
        if let Some(at) = rows.windows(2).position(|pair| pair[0] >= pair[1]) {
            let found = format!("row {} before row {}", rows[at], rows[at + 1]);
            return shape(found, "rows in order, each once".into());
        }
        if points.dimension() != bounds.dimension() {
            let found = format!("points of R^{}", points.dimension());
            return shape(found, format!("R^{}", bounds.dimension()));
        }
        Ok(Self {
            tree: BallTree::new(points.dimension(), points.coordinates()),
            bounds,
            halo,
            points,
            rows: rows.into(),
            ranks: ranks.into(),
        })
    }

    /// Number of points, those of the halo among them.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// How far the points go beyond the box.
    pub fn halo(&self) -> f64 {
        self.halo
    }

    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    pub(super) fn points(&self) -> &PointCloud<f64> {
        &self.points
    }

    pub(super) fn tree(&self) -> &BallTree {
        &self.tree
    }

    pub(super) fn ids(&self) -> impl ExactSizeIterator<Item = Row> + use<> {
        self.rows.ids()
    }

    pub(super) fn place(&self, row: Row) -> &[f64] {
        self.points.point(row.index())
    }

    pub(super) fn cloud_row(&self, row: Row) -> CloudRow {
        self.rows[row]
    }

    pub(super) fn rank(&self, row: Row) -> u32 {
        self.ranks[row]
    }

    /// Whether a point cannot be a landmark.
    pub(super) fn is_barred(&self, row: Row) -> bool {
        self.ranks[row] == BARRED
    }

    /// The rows of the cloud that the points are, in order.
    pub(super) fn rows(&self) -> &[CloudRow] {
        self.rows.as_slice()
    }

    /// Gives the points other places in a random order.
    pub(super) fn rank_anew(&mut self, ranks: Table<Row, u32>) {
        self.ranks = ranks;
    }

    /// The row of the tile that is a row of the cloud; `None` where the tile does not have it. O(log n).
    pub(super) fn find(&self, row: CloudRow) -> Option<Row> {
        let at = self.rows.as_slice().binary_search(&row);
        at.ok().map(Row::new)
    }

    /// Whether a point is in the box.
    pub(super) fn owns(&self, row: Row) -> bool {
        self.bounds.hold(self.place(row))
    }

    /// Up to which distance all points about one are in the tile; negative where not even itself is sure to be.
    pub(super) fn known(&self, row: Row) -> f64 {
        self.halo - self.bounds.distance(self.place(row))
    }

    /// Visits the points closer to a place than `radius`: what the metric of straight lines says, to the last bit.
    pub(super) fn within(&self, place: &[f64], radius: f64, mut visit: impl FnMut(Row)) {
        let reach = radius * (1.0 + ROUNDING);
        self.tree.within(place, reach, |k, _| {
            let row = Row::from(k);
            if squared_distance(place, self.place(row)).sqrt() < radius {
                visit(row);
            }
        });
    }

    /// Some rows of the tile, for others.
    pub(super) fn gathered(&self, rows: impl IntoIterator<Item = Row>) -> Gathered {
        let rows: Vec<Row> = rows.into_iter().collect();
        let mut all = Gathered::with_room(self.points.dimension(), rows.len());
        for row in rows {
            all.push(self.cloud_row(row), self.place(row));
        }
        all
    }
}
