use super::*;
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::metric::{BruteForceOracle, Euclidean};
use crosscap_core::laws::{self, Settings, StraightLine};
use crosscap_core::{DimensionEstimator, PointCloud};
use proptest::prelude::*;

fn radii<S: Scalar>(policy: &dyn NeighborhoodPolicy<S>, cloud: &PointCloud<S>) -> Vec<f64> {
    let metric = Euclidean::new(cloud.clone());
    let oracle = BruteForceOracle::new(&metric);
    let space = Surroundings {
        oracle: &oracle,
        metric: &metric,
        cloud: Some(cloud),
        execute: &Serial,
    };
    PolicyOracle::new(policy, &space).unwrap().into_radii()
}

/// Points on a grid, so that there are ties and copies, in single and double precision.
fn grid() -> impl Strategy<Value = PointCloud<f64>> {
    (1_usize..4, 9_usize..40).prop_flat_map(|(n, count)| {
        prop::collection::vec(-3_i32..=3, n * count).prop_map(move |rows| {
            let rows = rows.into_iter().map(|x| f64::from(x) * 0.7);
            PointCloud::new(n, rows.collect()).unwrap()
        })
    })
}

fn holds_the_nearest<S: Scalar>(cloud: &PointCloud<S>, count: usize) -> Result<(), TestCaseError> {
    let oracle = BruteForceOracle::new(Euclidean::new(cloud.clone()));
    let radii = radii(&NearestCount::new(count).unwrap(), cloud);
    let (mut ball, mut nearest) = (vec![], vec![]);
    for (i, &radius) in radii.iter().enumerate() {
        oracle.within(i, S::of(radius), &mut ball);
        oracle.nearest(i, count + 1, &mut nearest);
        // All of the nearest, and nothing but ties with the last of them behind.
        prop_assert_eq!(&ball[..=count], &nearest[..]);
        // Grid distances that are equal differ by rounding.
        let last = nearest[count].distance.as_f64();
        let tie = |d: f64| (d - last).abs() <= 1e-5 * last;
        prop_assert!(ball[count + 1..].iter().all(|x| tie(x.distance.as_f64())));
    }
    Ok(())
}

proptest! {
    #[test]
    fn a_count_reaches_the_nearest_and_their_ties(cloud in grid(), count in 1_usize..8) {
        holds_the_nearest(&cloud, count)?;
        holds_the_nearest(&cloud.cast::<f32>(), count)?;
    }

    #[test]
    fn counted_radii_change_no_faster_than_distances(cloud in grid(), count in 1_usize..8) {
        let radii = radii(&NearestCount::new(count).unwrap(), &cloud);
        for a in 0..cloud.len() {
            for b in 0..a {
                let apart = cloud.squared_distance(a, b).sqrt();
                prop_assert!((radii[a] - radii[b]).abs() <= apart + 1e-9);
            }
        }
    }

    #[test]
    fn radii_grow_with_the_data_and_know_no_order(
        cloud in grid(), count in 2_usize..8, power in -8_i32..8, turn in 1_usize..9,
    ) {
        let scale = f64::from(power).exp2();
        let scaled = cloud.coordinates().iter().map(|x| x * scale).collect();
        let scaled = PointCloud::new(cloud.dimension(), scaled).unwrap();
        let n = cloud.len();
        let order: Vec<usize> = (0..n).map(|k| (k + turn) % n).collect();
        let turned = cloud.select(&order);
        let pca = PrincipalComponents::<f64>::new(0.05).unwrap();
        let flat = |eps| FlatRadius::new(eps, count, &pca as &dyn DimensionEstimator<Scalar = f64>).unwrap();
        let nearest = NearestCount::new(count).unwrap();
        let own = [radii(&flat(1.5), &cloud), radii(&nearest, &cloud)];
        let grown = [radii(&flat(1.5 * scale), &scaled), radii(&nearest, &scaled)];
        let moved = [radii(&flat(1.5), &turned), radii(&nearest, &turned)];
        for k in 0..2 {
            for i in 0..n {
                // Copies alone have the least radius there is, which knows no unit.
                let least = own[k][i] < 1e-30;
                prop_assert!(least || (own[k][i] * scale - grown[k][i]).abs() <= 1e-9 * grown[k][i]);
                let (a, b) = (moved[k][i], own[k][order[i]]);
                // Which of equally far points a thinned ball keeps may depend on the order.
                prop_assert!((a - b).abs() <= 1e-9 * b, "{} {}", a, b);
            }
        }
    }
}

#[test]
fn an_oracle_with_a_policy_obeys_the_laws() {
    // To anybody who asks with a radius it is the oracle it was made from.
    struct Bound(BruteForceOracle<Euclidean<f64>>, Vec<f64>);
    impl NeighborhoodOracle for Bound {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn within(&self, center: usize, radius: f64, out: &mut Vec<crosscap_core::Neighbor<f64>>) {
            self.policy().within(center, radius, out);
        }
        fn nearest(
            &self,
            center: usize,
            count: usize,
            out: &mut Vec<crosscap_core::Neighbor<f64>>,
        ) {
            self.policy().nearest(center, count, out);
        }
    }
    impl Bound {
        fn policy(&self) -> PolicyOracle<'_, f64> {
            let space = Surroundings {
                oracle: &self.0,
                metric: self.0.metric(),
                cloud: None,
                execute: &Serial,
            };
            let policy = PolicyOracle::new(&ConstantRadius::new(0.5).unwrap(), &space).unwrap();
            assert_eq!(policy.radii(), self.1);
            policy
        }
    }
    laws::oracle(&Settings::default(), |cloud| {
        let oracle = BruteForceOracle::new(Euclidean::new(cloud.clone()));
        (
            StraightLine(cloud.clone()),
            Bound(oracle, vec![0.5; cloud.len()]),
        )
    })
    .unwrap();
}

#[test]
fn a_flat_neighborhood_keeps_its_size_and_a_fold_makes_it_small() {
    // Two halves of a plane folded to a right angle along the first axis.
    let rows = (0..1250).flat_map(|k| {
        let (x, y) = (f64::from(k % 25) * 0.1 - 1.2, f64::from(k / 25) * 0.1 - 2.5);
        [x, y.min(0.0), y.max(0.0)]
    });
    let cloud = PointCloud::new(3, rows.collect()).unwrap();
    let pca = PrincipalComponents::new(0.05).unwrap();
    let radii = radii(&FlatRadius::new(0.6, 10, &pca).unwrap(), &cloud);
    for (i, radius) in radii.iter().enumerate() {
        let to_fold = cloud.point(i)[1].abs().max(cloud.point(i)[2].abs());
        if to_fold > 0.6 {
            assert_eq!(*radius, 0.6, "point {i}");
        } else if to_fold < 0.05 {
            assert!(*radius < 0.35, "point {i}: {radius}");
        }
    }
}

#[test]
fn too_few_points_are_named() {
    let cloud = PointCloud::new(1, vec![0.0, 1.0, 2.0]).unwrap();
    let metric = Euclidean::new(cloud);
    let oracle = BruteForceOracle::new(&metric);
    let space = Surroundings {
        oracle: &oracle,
        metric: &metric,
        cloud: None,
        execute: &Serial,
    };
    let error = NearestCount::new(3).unwrap().radii(&space).unwrap_err();
    assert!(matches!(
        error,
        Error::SparseNeighborhood {
            found: 3,
            needed: 4,
            ..
        }
    ));
    struct Wrong(f64);
    impl NeighborhoodPolicy<f64> for Wrong {
        fn radii(&self, _: &Surroundings<'_, f64>) -> Result<Vec<f64>, Error> {
            Ok(vec![1.0, self.0, 1.0])
        }
        fn name(&self) -> &str {
            "wrong"
        }
    }
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = PolicyOracle::new(&Wrong(radius), &space)
            .map(|_| ())
            .unwrap_err();
        assert!(matches!(error, Error::Law { point: 1, .. }), "{error}");
    }
}
