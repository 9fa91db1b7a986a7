//! Standard errors by leaving out groups of points.

use crate::surfaces::Random;

/// Groups that are left out in turn.
pub(super) const GROUPS: usize = 8;

/// The standard error of a statistic of ranks, from its values without the ranks of which one in [`GROUPS`] is left
/// out: `value` is told which to keep.
pub(super) fn error_by_ranks(mut value: impl FnMut(&dyn Fn(usize) -> bool) -> f64) -> f64 {
    let without: [f64; GROUPS] = std::array::from_fn(|g| value(&|rank| rank % GROUPS != g));
    standard_error(&without)
}

/// Random orders of the points of a whole cloud, whole and without each group, which are dealt out along the first order.
pub(super) struct Draws {
    orders: Vec<Vec<usize>>,
    group: Vec<usize>,
    /// How many orders serve where a group is left out.
    few: usize,
}

impl Draws {
    /// So many orders of `count` points, and how many of them serve where a group is left out.
    pub(super) fn new(seed: u64, count: usize, orders: usize, few: usize) -> Self {
        let orders: Vec<Vec<usize>> = (0..orders)
            .map(|k| Random::stream(seed, k as u64).permutation(count))
            .collect();
        let mut group = vec![0; count];
        for (rank, &i) in orders[0].iter().enumerate() {
            group[i] = rank % GROUPS;
        }
        Self { orders, group, few }
    }

    /// How many orders there are without group `g`; for [`GROUPS`], which leaves nothing out, all.
    pub(super) fn of(&self, g: usize) -> usize {
        if g < GROUPS {
            self.few
        } else {
            self.orders.len()
        }
    }

    /// The points without group `g`, in one of its orders.
    pub(super) fn points(&self, g: usize, order: usize) -> impl Iterator<Item = usize> {
        let all = self.orders[order].iter().copied();
        all.filter(move |&i| self.group[i] != g)
    }
}

/// Delete-a-group jackknife: the standard error of a statistic whose value without group `g` is
/// `values[g]`, `sqrt((G - 1) / G * sum (v_g - mean)^2)` (Efron & Tibshirani, *An Introduction to the
/// Bootstrap*, 1993, section 11.5). It is too large rather than too small for statistics of pairs.
pub(super) fn standard_error(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let spread: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    ((count - 1.0) / count * spread).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn every_point_is_left_out_once() {
        let draws = Draws::new(3, 50, 5, 2);
        let mut times = [0; 50];
        for g in 0..GROUPS {
            assert_eq!(draws.of(g), 2);
            let mut kept: Vec<usize> = draws.points(g, 1).collect();
            assert_ne!(kept, draws.points(g, 0).collect::<Vec<_>>());
            kept.sort_unstable();
            (0..50)
                .filter(|i| kept.binary_search(i).is_err())
                .for_each(|i| times[i] += 1);
        }
        assert_eq!(times, [1; 50]);
        assert_eq!(draws.of(GROUPS), 5);
        assert_eq!(draws.points(GROUPS, 4).count(), 50);
    }

    #[test]
    fn of_a_mean_it_is_the_usual_standard_error() {
        let data = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let total: f64 = data.iter().sum();
        let without: Vec<f64> = data.iter().map(|x| (total - x) / 7.0).collect();
        let mean = total / 8.0;
        let variance = data.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 7.0;
        let left = error_by_ranks(|kept| {
            let rest = (0..8).filter(|&k| kept(k)).map(|k| data[k]);
            rest.sum::<f64>() / 7.0
        });
        assert_relative_eq!(left, standard_error(&without), max_relative = 1e-12);
        assert_relative_eq!(
            standard_error(&without),
            (variance / 8.0).sqrt(),
            max_relative = 1e-12
        );
    }
}
