//! The nearest neighbors of many points of a space at once.

use super::Space;
use crate::balls::BallTree;
use crate::execute::{self, Execute};
use crosscap_core::{Error, Neighbor, Row, Scalar};

/// Neighbors of a point in the graph that cells are flooded in.
pub(crate) const GRAPH_NEIGHBORS: usize = 12;

/// The nearest others of each of some rows of a space, by its metric.
pub(crate) struct NearestOfEach<'a, S: Scalar> {
    space: &'a Space<'a, S>,
    rows: &'a [Row],
    /// Every row of the space this close to one that is wanted is among `rows`.
    margin: f64,
    /// A tree over the rows, where the metric is the straight line.
    tree: Option<BallTree>,
}

impl<'a, S: Scalar> NearestOfEach<'a, S> {
    /// Prepares the search for neighbors of `rows`; those within `margin` of a row that will be wanted
    /// must be among them.
    pub(crate) fn new(space: &'a Space<'a, S>, rows: &'a [Row], margin: f64) -> Self {
        let tree = space.metric().places().map(|places| {
            let mut coordinates = Vec::with_capacity(rows.len() * places.dimension());
            for &row in rows {
                coordinates.extend(places.point(row.index()).iter().map(|x| x.as_f64()));
            }
            BallTree::new(places.dimension(), &coordinates)
        });
        Self {
            space,
            rows,
            margin,
            tree,
        }
    }

    /// Positions in `rows`, those of rows that are near to each other near to each other where the
    /// space knows how.
    pub(crate) fn order(&self) -> Vec<u32> {
        match &self.tree {
            Some(tree) => tree.order().to_vec(),
            None => (0..self.rows.len() as u32).collect(),
        }
    }

    /// What `each` makes of every wanted row and its [`GRAPH_NEIGHBORS`] nearest others, in no order, one
    /// after another as [`order`](Self::order) has them. `wanted` takes positions in `rows`.
    ///
    /// O(log n) a row where the metric is the straight line, else a query of the oracle.
    ///
    /// # Errors
    /// [`Error::Law`] for a distance that is no number, put to the metric.
    pub(crate) fn each<T: Send + Sync>(
        &self,
        wanted: &(dyn Fn(u32) -> bool + Sync),
        execute: &dyn Execute,
        each: impl Fn(Row, &[Row]) -> T + Sync,
    ) -> Result<Vec<T>, Error> {
        let Some(tree) = &self.tree else {
            let wanted: Vec<u32> = (self.order().into_iter().filter(|&k| wanted(k))).collect();
            let found = execute::map(execute, wanted.len(), Vec::new, |near, k| {
                let row = self.rows[wanted[k] as usize];
                let others = self.by_oracle(row, near)?;
                Ok::<T, Box<Error>>(each(row, &others))
            });
            return found.into_iter().map(|x| x.map_err(|e| *e)).collect();
        };
        let reach = self.margin * self.margin;
        let found = tree.nearest_of_each(GRAPH_NEIGHBORS, wanted, execute, |at, near| {
            let row = self.rows[at as usize];
            // Where neighbors are farther than the margin there may be nearer ones beyond it.
            let last = near.last().map_or(f64::INFINITY, |x| x.square());
            if near.len() == GRAPH_NEIGHBORS && last <= reach {
                let mut others = [Row::default(); GRAPH_NEIGHBORS];
                for (other, x) in others.iter_mut().zip(near) {
                    *other = self.rows[x.index() as usize];
                }
                return Ok(each(row, &others));
            }
            let others = self.by_oracle(row, &mut Vec::new())?;
            Ok::<T, Box<Error>>(each(row, &others))
        });
        found.into_iter().map(|x| x.map_err(|e| *e)).collect()
    }

    /// The nearest others of a row, by the oracle.
    fn by_oracle(&self, row: Row, near: &mut Vec<Neighbor<S>>) -> Result<Vec<Row>, Box<Error>> {
        let oracle = self.space.oracle();
        oracle.nearest(row.index(), GRAPH_NEIGHBORS + 1, near);
        self.space.sound(row.index(), near)?;
        let others = near.iter().map(Neighbor::row);
        Ok((others.filter(|&x| x != row))
            .take(GRAPH_NEIGHBORS)
            .collect())
    }
}
