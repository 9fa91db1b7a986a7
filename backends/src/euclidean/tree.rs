//! Search trees of several dimensions behind one type.
//!
//! Nothing here depends on the number type of a cloud, and so all trees are compiled once, here, and not again in every crate and
//! test that has an oracle: they were a third of what the facade crate compiles.

use crosscap_core::Error;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use std::num::NonZero;

/// The tree has at most this many dimensions.
pub(super) const MOST_AXES: usize = 8;

/// A kd-tree whose dimension is no longer in its type. Places are padded to [`MOST_AXES`].
pub(super) trait Tree: Send + Sync {
    /// Visits the points at squared distance at most `squared_radius`, with that distance.
    fn within(
        &self,
        place: &[f64; MOST_AXES],
        squared_radius: f64,
        visit: &mut dyn FnMut(u32, f64),
    );
    /// Visits `count` points nearest in the tree, in any order.
    fn nearest(&self, place: &[f64; MOST_AXES], count: usize, visit: &mut dyn FnMut(u32));
}

struct Planted<const K: usize>(ImmutableKdTree<f64, K>);

fn lead<const K: usize>(place: &[f64; MOST_AXES]) -> [f64; K] {
    std::array::from_fn(|k| place[k])
}

impl<const K: usize> Tree for Planted<K> {
    fn within(
        &self,
        place: &[f64; MOST_AXES],
        squared_radius: f64,
        visit: &mut dyn FnMut(u32, f64),
    ) {
        (self.0.query(&lead(place)))
            .within::<SquaredEuclidean<f64>>(squared_radius)
            .unsorted()
            .visit(|found| visit(found.item, found.distance));
    }

    fn nearest(&self, place: &[f64; MOST_AXES], count: usize, visit: &mut dyn FnMut(u32)) {
        let Some(count) = NonZero::new(count) else {
            return;
        };
        let found = (self.0.query(&lead(place)))
            .nearest_n::<SquaredEuclidean<f64>>(count)
            .execute();
        found.into_iter().for_each(|found| visit(found.item));
    }
}

/// For the empty cloud.
struct Bare;

impl Tree for Bare {
    fn within(&self, _: &[f64; MOST_AXES], _: f64, _: &mut dyn FnMut(u32, f64)) {}
    fn nearest(&self, _: &[f64; MOST_AXES], _: usize, _: &mut dyn FnMut(u32)) {}
}

/// The tree over places of `dimension` coordinates each, one after the other.
///
/// # Errors
/// [`Error::Shape`] where kiddo refuses them: coordinates that are not finite.
pub(super) fn plant(dimension: usize, places: &[f64]) -> Result<Box<dyn Tree>, Error> {
    if places.is_empty() {
        return Ok(Box::new(Bare));
    }
    match dimension {
        1 => plant_in::<1>(places),
        2 => plant_in::<2>(places),
        3 => plant_in::<3>(places),
        4 => plant_in::<4>(places),
        5 => plant_in::<5>(places),
        6 => plant_in::<6>(places),
        7 => plant_in::<7>(places),
        _ => plant_in::<MOST_AXES>(places),
    }
}

fn plant_in<const K: usize>(places: &[f64]) -> Result<Box<dyn Tree>, Error> {
    let (places, _) = places.as_chunks::<K>();
    let tree = ImmutableKdTree::new_from_slice(places).map_err(|error| Error::Shape {
        found: format!("a cloud that the kd-tree refuses ({error})"),
        expected: "finite coordinates".into(),
    })?;
    Ok(Box::new(Planted(tree)))
}
