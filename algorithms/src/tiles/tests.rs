use super::*;
use crate::execute::Serial;
use crate::landmarks::RandomGreedy;
use crate::metric::{BruteForceOracle, Euclidean};
use crate::surfaces::{Random, SampleSurface, Sampling};
use crate::tuning::CellTuning;
use crosscap_core::{CellNeighborhood, LandmarkSelector, PointCloud};
use proptest::prelude::*;

/// Points of a square in R^3 with a bump, some of them on a grid and some scattered.
fn bumpy(count: usize, seed: u64) -> PointCloud<f64> {
    let mut random = Random::new(seed);
    let mut rows = Vec::new();
    for k in 0..count {
        let (x, y) = if k % 3 == 0 {
            (
                f64::from(k as u32 % 20) / 20.0,
                f64::from(k as u32 / 20 % 20) / 20.0,
            )
        } else {
            (random.uniform(), random.uniform())
        };
        rows.extend([x, y, 0.3 * (4.0 * x).sin() * y]);
    }
    PointCloud::new(3, rows).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn landmarks_are_those_of_the_whole_cloud_whatever_the_tiles(
        count in 1_usize..500, tiles in 1_usize..12, share in 1.0..6.0_f64, dl in 0.05..0.4_f64, seed in any::<u64>(), barred in 0_usize..4,
    ) {
        let cloud = bumpy(count, seed);
        let whole = Euclidean::new(cloud.clone());
        let oracle = BruteForceOracle::new(&whole);
        // A third of the rows cannot be chosen, and some of these are landmarks already.
        let free: Vec<usize> = (0..count).filter(|row| row % 3 != barred).collect();
        let there: Vec<usize> = (0..count).filter(|row| row % 3 == barred && row % 5 == 0).collect();
        let expected = RandomGreedy::new().select(&oracle, &free, &there, dl, seed).unwrap();
        let tiling = Tiling::new(&cloud, tiles);
        let held = TilesInMemory::new(&cloud, &tiling, share * dl, seed, &Serial).unwrap();
        let rows: Vec<CloudRow> = (0..count).filter(|row| row % 3 == barred).map(CloudRow::new).collect();
        held.bar(&rows).unwrap();
        let taken = held.rows(there.into_iter().map(CloudRow::new).collect()).unwrap();
        let found = landmarks(&held, dl, &taken).unwrap();
        let rows: Vec<usize> = found.rows().iter().map(|row| row.index()).collect();
        prop_assert_eq!(rows, expected);
    }

    #[test]
    fn nearest_points_are_those_of_the_whole_cloud(
        count in 1_usize..200, tiles in 1_usize..9, seed in any::<u64>(),
        places in prop::collection::vec(-2.0..3.0_f64, 3 * 8),
    ) {
        let cloud = bumpy(count, seed);
        let held = TilesInMemory::new(&cloud, &Tiling::new(&cloud, tiles), 0.1, 0, &Serial).unwrap();
        let found = held.nearest(&places).unwrap();
        for place in places.chunks_exact(3) {
            let square = |row: usize| crosscap_core::squared_distance(place, cloud.point(row));
            let nearest = (0..count).min_by(|&a, &b| square(a).total_cmp(&square(b))).unwrap();
            prop_assert!(found.find(CloudRow::new(nearest)).is_some());
        }
        let around = Question::Around { places: places.clone(), radius: 1.2 };
        let found = held.gather(&around).unwrap();
        // Of so many that points are gone through instead.
        let many = Question::Around { places: places.repeat(200), radius: 1.2 };
        prop_assert_eq!(&held.gather(&many).unwrap(), &found);
        let near = |row: &usize| places.chunks_exact(3)
            .any(|place| crosscap_core::squared_distance(place, cloud.point(*row)).sqrt() < 1.2);
        let expected: Vec<usize> = (0..count).filter(near).collect();
        let rows: Vec<usize> = found.rows().iter().map(|row| row.index()).collect();
        prop_assert_eq!(rows, expected);
    }
}

#[test]
fn neighborhoods_are_the_same_whatever_the_tiles() {
    // Tight beside the separation: part of the charts are flooded.
    for (name, count, dl) in [("torus", 3000, 0.45), ("klein-r5", 4000, 0.5)] {
        let sample = SampleSurface::find(name)
            .unwrap()
            .sample(&Sampling::new(count, 3))
            .unwrap();
        let cloud = &sample.points;
        let reach = halo(dl, 3.0 * dl, &CellTuning::MEASURED);
        let told = |tiles: usize| {
            let tiling = Tiling::new(cloud, tiles);
            let held = TilesInMemory::new(cloud, &tiling, reach, 5, &Serial).unwrap();
            let chosen = landmarks(&held, dl, &Gathered::new(cloud.dimension())).unwrap();
            let question = Question::Cells(CellQuestion {
                landmarks: chosen.rows().to_vec(),
                elsewhere: Vec::new(),
                dl,
                tri_eps: 3.0 * dl,
                tuning: CellTuning::MEASURED,
            });
            let mut all = Vec::new();
            for answer in held.ask(&question).unwrap() {
                match answer {
                    Answer::Cells(cells, _) => all.extend(cells),
                    other => panic!("{other:?}"),
                }
            }
            all.sort_by_key(CellNeighborhood::center);
            assert_eq!(all.len(), chosen.len());
            all
        };
        let whole = told(1);
        assert_eq!(whole, told(2), "{name}");
        assert_eq!(whole, told(7), "{name}");
    }
}

#[test]
fn copies_are_found_and_a_halo_that_is_too_small_is_told() {
    let cloud =
        PointCloud::new(2, vec![0.0, 1.0, 5.0, 5.0, -0.0, 1.0, 5.0, 5.0, 5.0, 5.0]).unwrap();
    let held = TilesInMemory::new(&cloud, &Tiling::new(&cloud, 2), 0.5, 0, &Serial).unwrap();
    let copies = held.gather(&Question::Copies).unwrap();
    assert_eq!(copies.rows(), [2, 3, 4].map(CloudRow::new));
    let error = landmarks(&held, 0.6, &Gathered::new(2)).unwrap_err();
    assert!(error.to_string().contains("halo"), "{error}");
    assert!(held.rows(vec![CloudRow::new(7)]).is_err());
}
