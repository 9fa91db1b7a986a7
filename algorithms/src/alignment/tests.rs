use super::*;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

fn weighted_square(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    let each = a.chunks_exact(3).zip(b.chunks_exact(3)).zip(weights);
    each.map(|((p, q), w)| w * (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>())
        .sum()
}

fn coordinates(atoms: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-3.0..3.0f64, 3 * atoms)
}

fn moved(place: &[f64], turn: [f64; 3], by: [f64; 3]) -> Vec<f64> {
    let rotation = Rotation3::new(Vector3::from(turn));
    let all = place.chunks_exact(3);
    all.flat_map(|p| {
        let q = rotation * Vector3::new(p[0], p[1], p[2]) + Vector3::from(by);
        [q.x, q.y, q.z]
    })
    .collect()
}

fn places(flat: &[f64]) -> Vec<[f64; 3]> {
    flat.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// The three conditions, the nearest of many rotations, and the same for all rigid motions of a conformation.
    #[test]
    fn the_nearest_position_satisfies_eckart(
        (reference, place, weights) in (2usize..7).prop_flat_map(|extra| {
            let atoms = extra + 1;
            (coordinates(atoms), coordinates(atoms), prop::collection::vec(0.5..20.0f64, atoms))
        }),
        turn in prop::array::uniform3(-3.0..3.0f64),
        by in prop::array::uniform3(-9.0..9.0f64),
        others in prop::collection::vec(prop::array::uniform3(-3.0..3.0f64), 12),
    ) {
        let alignment = Alignment::new(&places(&reference), &weights);
        prop_assume!(alignment.is_ok());
        let alignment = alignment.unwrap();
        let found = alignment.align(&place);
        prop_assume!(found.margin > 1e-3);
        let again = alignment.align(&moved(&place, turn, by));
        for (x, y) in found.place.iter().zip(&again.place) {
            prop_assert!((x - y).abs() < 1e-9);
        }
        prop_assert!((found.margin - again.margin).abs() < 1e-9);
        prop_assert!((found.margin - alignment.margin(&found.place)).abs() < 1e-9);
        let centered = super::centered(&reference, &alignment.weights);
        for c in 0..3 {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            let atoms = centered.chunks_exact(3).zip(found.place.chunks_exact(3)).zip(&weights);
            let (mut sum, mut torque) = (0.0, 0.0);
            for ((r, p), w) in atoms {
                sum += w * p[c];
                torque += w * (r[i] * p[j] - r[j] * p[i]);
            }
            prop_assert!(sum.abs() < 1e-9 && torque.abs() < 1e-8);
        }
        let distance = weighted_square(&centered, &found.place, &weights);
        for turn in others {
            let other = moved(&found.place, turn, [0.0; 3]);
            prop_assert!(weighted_square(&centered, &other, &weights) >= distance - 1e-9);
        }
    }
}

#[test]
fn mirror_images_are_not_turned_into_each_other() {
    let reference = [[0., 0., 0.], [1., 0., 0.], [0., 1.5, 0.], [0., 0., 2.]];
    let alignment = Alignment::new(&reference, &[1.0; 4]).unwrap();
    let mirrored: Vec<f64> = reference.iter().flat_map(|p| [-p[0], p[1], p[2]]).collect();
    let found = alignment.align(&mirrored);
    let volume = |p: &[f64]| {
        let v = |a: usize| Vector3::new(p[3 * a] - p[0], p[3 * a + 1] - p[1], p[3 * a + 2] - p[2]);
        v(1).cross(&v(2)).dot(&v(3))
    };
    assert!((volume(&found.place) + 3.0).abs() < 1e-9);
}

#[test]
fn what_determines_no_rotation_is_refused() {
    let line: Vec<[f64; 3]> = (0..4).map(|k| [f64::from(k), 1.0, 1.0]).collect();
    let square = [[1., 1., 0.], [-1., 1., 0.], [-1., -1., 0.], [1., -1., 0.]];
    assert_eq!(
        Alignment::new(&line, &[1.0; 4]).unwrap_err(),
        AlignmentError::Reference
    );
    assert_eq!(
        Alignment::new(&[[f64::NAN; 3]; 4], &[1.0; 4]).unwrap_err(),
        AlignmentError::Reference
    );
    assert!(matches!(
        Alignment::new(&square, &[1.0, 0.0, 1.0, 1.0]),
        Err(AlignmentError::Weight { atom: 1, .. })
    ));
    assert!(matches!(
        Alignment::new(&square, &[1.0; 3]),
        Err(AlignmentError::Atoms { .. })
    ));
    let alignment = Alignment::new(&square, &[1.0; 4]).unwrap();
    let mut rows = square.as_flattened().to_vec();
    rows.extend(line.as_flattened());
    let cloud = PointCloud::new(12, rows).unwrap();
    let found = alignment.align_all(&cloud).unwrap_err();
    assert!(
        matches!(found, AlignmentError::Undetermined { row: 1, .. }),
        "{found}"
    );
    let short = PointCloud::new(9, vec![0.0; 9]).unwrap();
    assert!(matches!(
        alignment.align_all(&short),
        Err(AlignmentError::Atoms { .. })
    ));
}
