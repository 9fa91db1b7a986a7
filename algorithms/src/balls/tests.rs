use super::*;
use crate::execute::Serial;
use crosscap_core::squared_distance;
use proptest::prelude::*;

proptest! {
    #[test]
    fn answers_equal_a_scan(
        width in 1_usize..5,
        // A small lattice, so that distances are equal and places coincide.
        lattice in prop::collection::vec(0_i32..6, 4..600),
        radius in 0.5_f64..4.0,
        count in 1_usize..16,
    ) {
        let n = lattice.len() / width;
        let places: Vec<f64> = lattice[..n * width].iter().map(|&x| f64::from(x)).collect();
        let tree = BallTree::new(width, &places);
        let square = |a: usize, b: usize| {
            squared_distance(&places[a * width..(a + 1) * width], &places[b * width..(b + 1) * width])
        };
        let found = tree.nearest_of_each(count, |i| i % 3 != 1, &Serial, |i, near| (i, near.to_vec()));
        let in_order: Vec<u32> = found.iter().map(|x| x.0).collect();
        let expected: Vec<u32> = tree.order().iter().copied().filter(|i| i % 3 != 1).collect();
        prop_assert_eq!(in_order, expected);
        for (i, mut near) in found {
            let farthest = near.last().copied();
            near.sort_unstable();
            prop_assert!(near.len() < count || farthest == near.last().copied());
            let near: Vec<(f64, u32)> = near.iter().map(|x| (x.square(), x.index())).collect();
            let i = i as usize;
            let mut all: Vec<(f64, u32)> =
                (0..n).filter(|&j| j != i).map(|j| (square(i, j), j as u32)).collect();
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            all.truncate(count);
            prop_assert_eq!(near, all);
        }
        for i in (0..n).step_by(7) {
            let mut inside = Vec::new();
            tree.within(&places[i * width..(i + 1) * width], radius, |j, _| inside.push(j as usize));
            inside.sort_unstable();
            let expected: Vec<usize> = (0..n).filter(|&j| square(i, j) < radius * radius).collect();
            prop_assert_eq!(inside, expected);
            for least in [0.0, 1.0] {
                let own = &places[i * width..(i + 1) * width];
                let found = tree.nearest(own, |square| square >= least);
                let expected = (0..n)
                    .map(|j| (square(i, j), j as u32))
                    .filter(|x| x.0 >= least)
                    .min_by(|a, b| a.partial_cmp(b).unwrap());
                prop_assert_eq!(found.map(|(j, d)| (d, j)), expected);
            }
            let first = (0..n).find(|&j| j % 5 == 2 && square(i, j) < radius * radius);
            let own = &places[i * width..(i + 1) * width];
            prop_assert_eq!(tree.any_within(own, radius, |j, _| j % 5 == 2), first.is_some());
        }
    }
}
