//! The points that are near a tile of a triangle, handed down from the tile that it is a part of.

use crosscap_core::squared_distance;

/// Spare in distances, so that rounding drops no point.
pub(super) const SPARE: f64 = 1.0 + 1e-9;

/// Points near the tiles of one triangle after the other.
///
/// A triangle asks the tree once; each of its tiles then looks only at what was near the tile that it is a part of: a few
/// points where the tile is small. Tiles have to be visited from the whole to its parts, each with all of its own before the next.
#[derive(Default)]
pub(super) struct Nearby {
    places: Vec<f64>,
    /// For every depth the points near the tile of the depth before.
    lists: Vec<Vec<u32>>,
}

impl Nearby {
    /// Begins with a triangle, near which there are no points so far.
    pub fn begin(&mut self) {
        self.places.clear();
        if self.lists.is_empty() {
            self.lists.push(Vec::new());
        }
        self.lists[0].clear();
    }

    /// Takes in a point near the triangle.
    pub fn add(&mut self, place: &[f64]) {
        let all = &mut self.lists[0];
        all.push(all.len() as u32);
        self.places.extend_from_slice(place);
    }

    /// Distance from the middle of a tile to the nearest point, infinite where none is closer than `reach`; its parts are
    /// handed what is.
    pub fn look(&mut self, depth: usize, middle: &[f64], reach: f64) -> f64 {
        if self.lists.len() < depth + 2 {
            self.lists.push(Vec::new());
        }
        let (above, own) = self.lists.split_at_mut(depth + 1);
        let own = &mut own[0];
        own.clear();
        let (limit, width) = ((reach * SPARE).powi(2), middle.len());
        let mut least = f64::INFINITY;
        for &point in &above[depth] {
            let place = &self.places[point as usize * width..][..width];
            let square = squared_distance(place, middle);
            if square < limit {
                own.push(point);
                least = least.min(square);
            }
        }
        least.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tiles::{Cut, Shape};
    use super::*;
    use proptest::prelude::*;

    fn places(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<[f64; 3]>> {
        prop::collection::vec(prop::array::uniform3(-1.0..1.0), count)
    }

    proptest! {
        /// Every tile learns what a look at all points tells.
        #[test]
        fn tiles_see_all_points_near_them(
            corners in prop::array::uniform3(prop::array::uniform3(-1.0..1.0)),
            points in places(0..60),
            reach in 0.05..1.0,
        ) {
            let shape = Shape::new([&corners[0], &corners[1], &corners[2]]);
            let mut place = vec![0.0; 3];
            let mut nearby = Nearby::default();
            // What was near another triangle is forgotten.
            nearby.begin();
            nearby.add(&[0.0; 3]);
            nearby.look(0, &[0.0; 3], 1.0);
            nearby.begin();
            for point in &points {
                nearby.add(point);
            }
            let mut agree = true;
            shape.cut(&mut place, &mut |tile, middle| {
                let wide = reach + shape.radius * tile.scale();
                let squares = points.iter().map(|p| squared_distance(p, middle));
                let nearest = squares.fold(f64::INFINITY, f64::min).sqrt();
                let seen = nearby.look(tile.depth(), middle, wide);
                agree &= seen == nearest || seen.is_infinite() && nearest >= wide;
                if tile.depth() < 3 { Cut::Further } else { Cut::Leave }
            });
            prop_assert!(agree);
        }
    }
}
