//! Orthogonal projection to the principal axes.

use super::{Embedding, check_dimension};
use crosscap_core::{Error, PointCloud};
use nalgebra::{DMatrix, SymmetricEigen};

/// Projects a cloud orthogonally to its leading principal axes (principal component analysis).
///
/// Places are centered at the mean of the cloud and in its unit. When the cloud has fewer
/// dimensions than asked for, the remaining coordinates are 0. The sign of an axis is fixed
/// by the point furthest along it, which gets a positive coordinate: the same cloud gives the same picture.
///
/// # Errors
/// [`Error::Parameter`] when `dimension` is 0; [`Error::NotFinite`] when the projection leaves the range of `f64`.
///
/// # Complexity
/// O(n m N + m^3) with m the smaller of the number of points n and their dimension N.
///
/// ```
/// use crosscap_algorithms::isomap::principal_places;
/// use crosscap_core::PointCloud;
/// let line = PointCloud::new(2, vec![0.0, 0.0, 3.0, 4.0, 6.0, 8.0]).unwrap();
/// let e = principal_places(&line, 1).unwrap();
/// assert!((e.places.point(0)[0].abs() - 5.0).abs() < 1e-12);
/// assert!(e.residual_variance < 1e-12);
/// ```
pub fn principal_places(cloud: &PointCloud<f64>, dimension: usize) -> Result<Embedding, Error> {
    check_dimension(dimension)?;
    let (count, width) = (cloud.len(), cloud.dimension());
    // Divided by the largest coordinate first: squares of coordinates near 1e200 overflow.
    let scale = cloud
        .coordinates()
        .iter()
        .fold(0.0_f64, |m, c| m.max(c.abs()));
    if count == 0 || scale == 0.0 {
        return Ok(Embedding {
            places: PointCloud::new(dimension, vec![0.0; count * dimension])?,
            residual_variance: 0.0,
            components: 1,
        });
    }
    let mut rows =
        DMatrix::from_row_iterator(count, width, cloud.coordinates().iter().map(|c| c / scale));
    for mut column in rows.column_iter_mut() {
        let mean = column.mean();
        column.add_scalar_mut(-mean);
    }
    let (coordinates, kept, total) = project(&rows, dimension);
    let coordinates = coordinates.iter().map(|c| c * scale).collect();
    Ok(Embedding {
        places: PointCloud::new(dimension, coordinates)?,
        residual_variance: if total > 0.0 {
            (1.0 - kept / total).clamp(0.0, 1.0)
        } else {
            0.0
        },
        components: 1,
    })
}

/// Coordinates of centered `rows` along their leading axes in row order, the energy (sum of
/// squares) of those coordinates, and that of the rows.
fn project(rows: &DMatrix<f64>, dimension: usize) -> (Vec<f64>, f64, f64) {
    let (count, width) = rows.shape();
    let total = rows.norm_squared();
    let kept_axes = dimension.min(width).min(count);
    let mut coordinates = vec![0.0; count * dimension];
    // The smaller of scatter and Gram matrix has the same leading spectrum.
    let wide = width > count;
    let eigen = SymmetricEigen::new(if wide {
        rows * rows.transpose()
    } else {
        rows.transpose() * rows
    });
    for (axis, at) in descending(eigen.eigenvalues.as_slice())
        .into_iter()
        .take(kept_axes)
        .enumerate()
    {
        let vector = eigen.eigenvectors.column(at);
        let along = if wide {
            vector * eigen.eigenvalues[at].max(0.0).sqrt()
        } else {
            rows * vector
        };
        for (row, &c) in along.iter().enumerate() {
            coordinates[row * dimension + axis] = c;
        }
    }
    fix_signs(&mut coordinates, dimension);
    let kept = coordinates.iter().map(|c| c * c).sum();
    (coordinates, kept, total)
}

/// Indices of `values` from the largest to the smallest, ties by index.
pub(super) fn descending(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]).then(a.cmp(&b)));
    order
}

/// Turns axes around so that the entry of largest magnitude in each column is positive. Among
/// entries that are equal within rounding the first one decides.
pub(super) fn fix_signs(coordinates: &mut [f64], dimension: usize) {
    for axis in 0..dimension {
        let column = || coordinates.iter().skip(axis).step_by(dimension);
        let top = column().fold(0.0_f64, |m, c| m.max(c.abs()));
        let first = column().find(|c| c.abs() >= top * (1.0 - 1e-9));
        if first.is_some_and(|&c| c < 0.0) {
            for c in coordinates.iter_mut().skip(axis).step_by(dimension) {
                *c = -*c;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn pads_with_zeros_what_the_cloud_does_not_have() {
        let cloud = PointCloud::new(1, vec![1.0, 3.0]).unwrap();
        let e = principal_places(&cloud, 3).unwrap();
        assert_eq!(e.places.point(0), &[1.0, 0.0, 0.0]);
        assert_eq!(e.places.point(1), &[-1.0, 0.0, 0.0]);
    }

    #[test]
    fn huge_and_equal_points_are_no_trouble() {
        let cloud = PointCloud::new(2, vec![1e300, 0.0, -1e300, 0.0]).unwrap();
        let e = principal_places(&cloud, 2).unwrap();
        assert!((e.places.point(0)[0] / 1e300 - 1.0).abs() < 1e-12);
        let cloud = PointCloud::new(2, vec![5.0; 8]).unwrap();
        let e = principal_places(&cloud, 2).unwrap();
        assert!(e.places.coordinates().iter().all(|&c| c == 0.0));
        assert_eq!(e.residual_variance, 0.0);
        assert!(
            principal_places(&PointCloud::new(2, vec![]).unwrap(), 3)
                .unwrap()
                .places
                .is_empty()
        );
        assert!(principal_places(&cloud, 0).is_err());
    }

    proptest! {
        #[test]
        fn space_of_full_dimension_is_kept_up_to_motion(
            (width, values) in (1usize..9).prop_flat_map(|width| {
                (Just(width), prop::collection::vec(-10.0..10.0f64, width * 6))
            })
        ) {
            let cloud = PointCloud::new(width, values).unwrap();
            let e = principal_places(&cloud, width).unwrap();
            for a in 0..cloud.len() {
                for b in 0..a {
                    let error = cloud.squared_distance(a, b) - e.places.squared_distance(a, b);
                    prop_assert!(error.abs() < 1e-8, "{error}");
                }
            }
            prop_assert!(e.residual_variance < 1e-9);
        }

        #[test]
        fn a_projection_never_lengthens_and_axes_fall(
            values in prop::collection::vec(-10.0..10.0f64, 5 * 20)
        ) {
            let cloud = PointCloud::new(5, values).unwrap();
            let e = principal_places(&cloud, 3).unwrap();
            for a in 0..cloud.len() {
                for b in 0..a {
                    prop_assert!(
                        e.places.squared_distance(a, b) <= cloud.squared_distance(a, b) + 1e-9
                    );
                }
            }
            let energy = |axis: usize| e.places.iter().map(|p| p[axis] * p[axis]).sum::<f64>();
            prop_assert!(energy(0) >= energy(1) - 1e-9 && energy(1) >= energy(2) - 1e-9);
        }
    }
}
