//! Neighborhoods in any metric space, by looking at every point.

use crosscap_core::{MetricSpace, Neighbor, NeighborhoodOracle, Scalar};

/// Neighborhoods in any [`MetricSpace`], by a scan over all points: the reference that every other
/// oracle must equal, and good enough for a few thousand points. `O(n)` distances a query.
///
/// Points at infinite distance are in no neighborhood, and come last among the nearest. A metric that
/// answers NaN breaks its law: here such points are in no neighborhood either, and behind all others among the
/// nearest, so that nothing panics before the metric can be named ([`CheckedMetric`](super::CheckedMetric)).
///
/// ```
/// use crosscap_algorithms::metric::{BruteForceOracle, GivenDistances};
/// use crosscap_core::NeighborhoodOracle;
/// let measured = GivenDistances::new(3, vec![0.0, 2.0, 1.0, 2.0, 0.0, 2.0, 1.0, 2.0, 0.0]).unwrap();
/// let mut found = Vec::new();
/// BruteForceOracle::new(measured).within(0, 2.0, &mut found);
/// assert_eq!(found.iter().map(|n| n.index).collect::<Vec<_>>(), [0, 2]);
/// ```
#[derive(Clone, Debug)]
pub struct BruteForceOracle<M> {
    metric: M,
    points: Vec<usize>,
}

impl<M: MetricSpace> BruteForceOracle<M> {
    /// Serves a metric space, given by value or by reference.
    pub fn new(metric: M) -> Self {
        Self {
            points: (0..metric.len()).collect(),
            metric,
        }
    }

    /// The metric that it serves.
    pub fn metric(&self) -> &M {
        &self.metric
    }

    fn all(&self, center: usize) -> impl Iterator<Item = Neighbor<M::Scalar>> + use<M> {
        // All at once, for metrics that know better than one after the other.
        let mut distances = Vec::with_capacity(self.points.len());
        self.metric
            .distances_to(center, &self.points, &mut distances);
        let numbered = distances.into_iter().enumerate();
        numbered.map(|(index, distance)| Neighbor { index, distance })
    }
}

impl<M: MetricSpace> NeighborhoodOracle for BruteForceOracle<M> {
    type Scalar = M::Scalar;

    fn len(&self) -> usize {
        self.metric.len()
    }

    fn within(&self, center: usize, radius: M::Scalar, out: &mut Vec<Neighbor<M::Scalar>>) {
        out.clear();
        out.extend(self.all(center).filter(|n| n.distance < radius));
        sort(out);
    }

    fn nearest(&self, center: usize, count: usize, out: &mut Vec<Neighbor<M::Scalar>>) {
        out.clear();
        out.extend(self.all(center));
        if count < out.len() {
            out.select_nth_unstable_by(count, before);
            out.truncate(count);
        }
        sort(out);
    }

    fn name(&self) -> &str {
        "scan"
    }
}

fn sort<S: Scalar>(neighbors: &mut [Neighbor<S>]) {
    neighbors.sort_unstable_by(before);
}

/// By distance, ties by index; what is no number comes last.
fn before<S: Scalar>(a: &Neighbor<S>, b: &Neighbor<S>) -> std::cmp::Ordering {
    let [x, y] = [a, b].map(|n| n.distance.as_f64().abs());
    x.total_cmp(&y).then(a.index.cmp(&b.index))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::{Euclidean, GivenDistances, Lifted};
    use super::*;
    use approx::AbsDiffEq;
    use crosscap_core::PointCloud;
    use proptest::prelude::*;

    /// The laws of a metric space, on every triple.
    fn obeys_the_laws<M: MetricSpace>(metric: &M) -> Result<(), TestCaseError> {
        let d = |a, b| metric.distance(a, b).as_f64();
        for a in 0..metric.len() {
            prop_assert_eq!(d(a, a), 0.0);
            for b in 0..metric.len() {
                prop_assert_eq!(d(a, b).to_bits(), d(b, a).to_bits(), "symmetry {} {}", a, b);
                prop_assert!(d(a, b) >= 0.0);
                for c in 0..metric.len() {
                    let rounding =
                        4.0 * <M::Scalar as AbsDiffEq>::default_epsilon().as_f64() * d(a, c);
                    prop_assert!(d(a, c) <= d(a, b) + d(b, c) + rounding, "{} {} {}", a, b, c);
                }
            }
        }
        Ok(())
    }

    fn rows(n: usize, width: usize) -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(-1.0_f64..1.0, n * width)
    }

    /// Gram-Schmidt on rows; `None` where they are nearly dependent.
    fn orthonormal(vectors: &[f64], n: usize) -> Option<Vec<f64>> {
        let mut basis: Vec<Vec<f64>> = vec![];
        for v in vectors.chunks(n) {
            let mut v = v.to_vec();
            for _ in 0..2 {
                for b in &basis {
                    let p: f64 = v.iter().zip(b).map(|(x, y)| x * y).sum();
                    v.iter_mut().zip(b).for_each(|(x, y)| *x -= p * y);
                }
            }
            let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm < 1e-3 {
                return None;
            }
            v.iter_mut().for_each(|x| *x /= norm);
            basis.push(v);
        }
        Some(basis.concat())
    }

    fn lifted_case() -> impl Strategy<Value = (usize, usize, Vec<f64>, Vec<f64>, f64)> {
        (3_usize..6, 1_usize..=2, 2_usize..9).prop_flat_map(|(n, d, count)| {
            (
                Just(n),
                Just(d),
                rows(count, n),
                rows(count * d, n),
                0.0_f64..3.0,
            )
        })
    }

    proptest! {
        #[test]
        fn metrics_obey_the_laws((n, d, points, spans, weight) in lifted_case()) {
            let cloud = Arc::new(PointCloud::new(n, points).unwrap());
            obeys_the_laws(&Euclidean::new(cloud.clone()))?;
            obeys_the_laws(&Euclidean::new(cloud.cast::<f32>()))?;
            let bases: Option<Vec<_>> = spans.chunks(n * d).map(|s| orthonormal(s, n)).collect();
            if let Some(bases) = bases {
                let lifted = Lifted::new(cloud, d, bases.concat(), weight).unwrap();
                obeys_the_laws(&lifted)?;
                let k = lifted.len();
                let matrix = (0..k * k).map(|i| lifted.distance(i / k, i % k)).collect();
                let given = GivenDistances::new(k, matrix).unwrap();
                obeys_the_laws(&given)?;
                // An oracle sees the metric and nothing else.
                let (mut found, mut expected) = (vec![], vec![]);
                for center in 0..k {
                    BruteForceOracle::new(&given).within(center, 1.0, &mut found);
                    BruteForceOracle::new(&lifted).within(center, 1.0, &mut expected);
                    prop_assert_eq!(&found, &expected);
                    prop_assert!(found.iter().all(|n| n.distance < 1.0));
                    BruteForceOracle::new(&given).nearest(center, found.len(), &mut expected);
                    prop_assert_eq!(&found, &expected);
                }
            }
        }

        #[test]
        fn lifting_is_the_distance_of_projections((n, d, points, spans, weight) in lifted_case()) {
            let bases: Option<Vec<_>> = spans.chunks(n * d).map(|s| orthonormal(s, n)).collect();
            let Some(bases) = bases else { return Ok(()) };
            let projection = |basis: &[f64]| {
                let mut p = vec![0.0; n * n];
                for v in basis.chunks(n) {
                    for i in 0..n {
                        for j in 0..n {
                            p[i * n + j] += v[i] * v[j];
                        }
                    }
                }
                p
            };
            let cloud = PointCloud::new(n, points).unwrap();
            let lifted = Lifted::new(cloud.clone(), d, bases.concat(), weight).unwrap();
            for (a, b) in [(0, 1), (1, 0)] {
                let (p, q) = (projection(&bases[a]), projection(&bases[b]));
                let turned: f64 = p.iter().zip(&q).map(|(x, y)| (x - y).powi(2)).sum();
                let expected = cloud.squared_distance(a, b) + weight * weight * turned / 2.0;
                approx::assert_relative_eq!(
                    lifted.distance(a, b), expected.sqrt(), max_relative = 1e-12
                );
            }
            // The same planes in other bases: nothing changes.
            if d == 2 {
                let (sin, cos) = 0.7_f64.sin_cos();
                let turned = bases.iter().flat_map(|basis| {
                    let (u, v) = basis.split_at(n);
                    let mix = |a: f64, b: f64| u.iter().zip(v).map(move |(x, y)| a * x + b * y);
                    mix(cos, sin).chain(mix(-sin, cos)).collect::<Vec<_>>()
                });
                let other = Lifted::new(cloud, d, turned.collect(), weight).unwrap();
                approx::assert_relative_eq!(
                    lifted.distance(0, 1), other.distance(0, 1), max_relative = 1e-12
                );
            }
        }

        #[test]
        fn nearest_takes_the_smaller_index_on_ties(c in prop::collection::vec(-2_i32..=2, 1..20), count in 0_usize..22) {
            let n = c.len();
            let line = PointCloud::new(1, c.iter().map(|&x| f64::from(x)).collect()).unwrap();
            let mut expected: Vec<(i32, usize)> = (0..n).map(|i| ((c[i] - c[0]).abs(), i)).collect();
            expected.sort();
            expected.truncate(count);
            let mut found = vec![];
            BruteForceOracle::new(Euclidean::new(line)).nearest(0, count, &mut found);
            let found: Vec<_> = found.iter().map(|n| (n.distance as i32, n.index)).collect();
            prop_assert_eq!(found, expected);
        }
    }

    /// A sort that meets NaN may panic where the order contradicts itself: it takes some dozens of points.
    #[test]
    fn nan_comes_last_and_panics_nowhere() {
        struct Short(Euclidean<f64>);
        impl MetricSpace for Short {
            type Scalar = f64;
            fn len(&self) -> usize {
                self.0.len()
            }
            fn distance(&self, a: usize, b: usize) -> f64 {
                let d = self.0.distance(a, b);
                if d > 20.0 { -f64::NAN } else { d }
            }
            fn name(&self) -> &str {
                "short"
            }
        }
        let places = (0..200).map(|k| f64::from(k * 37 % 200)).collect();
        let oracle =
            BruteForceOracle::new(Short(Euclidean::new(PointCloud::new(1, places).unwrap())));
        let mut found = vec![];
        for center in 0..200 {
            oracle.nearest(center, 200, &mut found);
            let numbers = found.partition_point(|n| !n.distance.is_nan());
            assert!(found[..numbers].is_sorted_by_key(|n| n.distance));
            assert!(found[numbers..].iter().all(|n| n.distance.is_nan()));
            assert!(found[numbers..].is_sorted_by_key(|n| n.index));
            oracle.within(center, f64::INFINITY, &mut found);
            assert_eq!(found.len(), numbers);
        }
    }

    #[test]
    fn bad_tangent_planes_are_refused() {
        let cloud = || PointCloud::new(2, vec![0.0, 0.0, 1.0, 0.0]).unwrap();
        let error = |d, bases: Vec<f64>, w| Lifted::new(cloud(), d, bases, w).unwrap_err();
        let good = vec![1.0, 0.0, 0.0, 1.0];
        assert!(error(1, good[..2].to_vec(), 1.0).is_input());
        assert!(
            error(3, good.clone(), 1.0)
                .to_string()
                .contains("at most 2")
        );
        assert!(
            error(1, good.clone(), f64::NAN)
                .to_string()
                .contains("weight")
        );
        assert!(error(1, good.clone(), -1.0).to_string().contains("weight"));
        // Its square times 0 would be no number.
        assert!(error(1, good.clone(), 1e200).to_string().contains("weight"));
        assert!(
            error(1, vec![1.0, 0.0, 0.5, 0.5], 1.0)
                .to_string()
                .contains("point 1")
        );
        assert!(
            error(1, vec![1.0, f64::NAN, 0.0, 1.0], 1.0)
                .to_string()
                .contains("row 0")
        );
        assert!(Lifted::new(cloud(), 1, good, 1.0).is_ok());
    }
}
