//! Which points stand on which triangle.

use super::footprints::Footprints;

/// The footprints of every triangle, one after another.
pub(super) struct Standing {
    starts: Vec<u32>,
    feet: Vec<u32>,
}

impl Standing {
    /// Those of the first `count` items, which are triangles.
    pub fn new(count: usize, feet: &Footprints) -> Self {
        let on = |item: u32| (item as usize) < count;
        let mut starts = vec![0_u32; count + 1];
        for &item in feet.items.iter().filter(|&&i| on(i)) {
            starts[item as usize + 1] += 1;
        }
        for t in 0..count {
            starts[t + 1] += starts[t];
        }
        let mut fill = starts.clone();
        let mut order = vec![0; starts[count] as usize];
        for (k, &item) in feet.items.iter().enumerate().filter(|i| on(*i.1)) {
            order[fill[item as usize] as usize] = k as u32;
            fill[item as usize] += 1;
        }
        Self {
            starts,
            feet: order,
        }
    }

    /// Those of a triangle, by their numbers.
    pub fn on(&self, triangle: u32) -> &[u32] {
        let t = triangle as usize;
        &self.feet[self.starts[t] as usize..self.starts[t + 1] as usize]
    }
}
