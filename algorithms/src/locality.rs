//! Work on all points in an order in which those that come one after the other are near each other.

use crate::execute::{self, Execute};
use crosscap_core::{PointCloud, Scalar};

/// Axes that a curve is laid through.
const AXES: usize = 3;
/// Bits of a place on each of them: three times as many fit into a key.
const BITS: u32 = 21;

/// What `work` makes of every point below `count`, by row; `scratch` makes a workspace for one thread after another.
///
/// Where there are coordinates, points that are near each other are worked on one after the other: most work begins with the
/// neighbors of a point, and they are in the cache when they are those of the point before.
pub(crate) fn map<S: Scalar, T: Send + Sync, C>(
    execute: &dyn Execute,
    places: Option<&PointCloud<S>>,
    count: usize,
    scratch: impl Fn() -> C + Sync,
    work: impl Fn(&mut C, usize) -> T + Sync,
) -> Vec<T> {
    let Some(places) = places.filter(|places| places.len() == count) else {
        return execute::map(execute, count, scratch, work);
    };
    let order = along_curve(places);
    let found = execute::map(execute, count, scratch, |own, k| {
        work(own, order[k] as usize)
    });
    let mut by_row: Vec<Option<T>> = (0..count).map(|_| None).collect();
    for (row, result) in order.into_iter().zip(found) {
        by_row[row as usize] = Some(result);
    }
    by_row.into_iter().flatten().collect()
}

/// The rows along the Z-order curve (Morton, 1966) through the boxes of a grid on the axes along which the points spread
/// widest; within a box by row.
///
/// The order of a file is often none. O(n log n).
fn along_curve<S: Scalar>(places: &PointCloud<S>) -> Vec<u32> {
    let axes = widest(places);
    let key = |row: usize| -> u64 {
        let place = places.point(row);
        let mut key = 0;
        for (k, axis) in axes.iter().enumerate() {
            let cell = (place[axis.index].as_f64() - axis.low) * axis.scale;
            key |= spread(cell as u64) << k;
        }
        key
    };
    let mut rows: Vec<(u64, u32)> = (0..places.len()).map(|i| (key(i), i as u32)).collect();
    rows.sort_unstable();
    rows.into_iter().map(|(_, row)| row).collect()
}

struct Axis {
    index: usize,
    low: f64,
    range: f64,
    /// Boxes for a unit of length.
    scale: f64,
}

/// The axes along which the points spread widest, widest first.
fn widest<S: Scalar>(places: &PointCloud<S>) -> Vec<Axis> {
    let axis = |index: usize| {
        let along = (0..places.len()).map(|i| places.point(i)[index].as_f64());
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let range = high - low;
        let cells = f64::from((1_u32 << BITS) - 1);
        let scale = if range > 0.0 { cells / range } else { 0.0 };
        Axis {
            index,
            low,
            range,
            scale,
        }
    };
    let mut axes: Vec<Axis> = (0..places.dimension()).map(axis).collect();
    axes.sort_by(|a, b| b.range.total_cmp(&a.range).then(a.index.cmp(&b.index)));
    axes.truncate(AXES);
    axes
}

/// The lowest [`BITS`] bits of a number, each at three times its position.
fn spread(cell: u64) -> u64 {
    let mut x = cell & ((1 << BITS) - 1);
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bits_are_spread_to_every_third() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread(u64::MAX), 0x1249_2492_4924_9249);
    }

    proptest! {
        #[test]
        fn every_row_comes_once(
            width in 1_usize..5,
            numbers in prop::collection::vec(prop_oneof![Just(0.0), -1e300..1e300, -1.0..1.0], 0..120),
        ) {
            let count = numbers.len() / width;
            let cloud = PointCloud::new(width, numbers[..count * width].to_vec()).unwrap();
            let mut rows = along_curve(&cloud);
            rows.sort_unstable();
            prop_assert_eq!(rows, (0..count as u32).collect::<Vec<_>>());
        }
    }

    #[test]
    fn steps_along_the_curve_are_short() {
        // A grid in an order that jumps about.
        let cells = (0..4096_u32).map(|k| k * 2053 % 4096);
        let numbers: Vec<f64> = cells
            .flat_map(|k| [f64::from(k / 64), f64::from(k % 64)])
            .collect();
        let cloud = PointCloud::new(2, numbers).unwrap();
        let mean = |rows: &[u32]| {
            let steps = rows
                .windows(2)
                .map(|w| cloud.squared_distance(w[0] as usize, w[1] as usize).sqrt());
            steps.sum::<f64>() / (rows.len() - 1) as f64
        };
        let (file, curve) = ((0..4096).collect::<Vec<u32>>(), along_curve(&cloud));
        assert!(mean(&curve) < 2.0 && mean(&file) > 20.0);
    }
}
