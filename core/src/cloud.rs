//! A finite set of points in R^N, checked once at the door.

use crate::{Error, Scalar};
use std::any::Any;
use std::sync::Arc;

/// `n` points of R^N, row after row in one block of memory.
///
/// Every coordinate is finite: the constructor refuses the rest, so nothing
/// behind it has to ask again. Clones share the block until one of them moves a point.
///
/// ```
/// use crosscap_core::PointCloud;
/// let cloud = PointCloud::new(3, vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0]).unwrap();
/// assert_eq!((cloud.len(), cloud.dimension()), (2, 3));
/// assert_eq!(cloud.squared_distance(0, 1), 1.0);
/// assert!(PointCloud::new(3, vec![0.0, f64::NAN, 0.0]).is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PointCloud<S> {
    dimension: usize,
    coordinates: Arc<Vec<S>>,
}

impl<S: Scalar> PointCloud<S> {
    /// Takes `n * dimension` coordinates in row order.
    ///
    /// # Errors
    /// [`Error::Shape`] when `dimension` is 0 or does not divide the number of
    /// coordinates, [`Error::NotFinite`] with row and column of the first NaN or infinity.
    pub fn new(dimension: usize, coordinates: Vec<S>) -> Result<Self, Error> {
        if dimension == 0 || !coordinates.len().is_multiple_of(dimension) {
            return Err(Error::Shape {
                found: format!("{} coordinates", coordinates.len()),
                expected: format!("a multiple of the dimension {dimension}, which is at least 1"),
            });
        }
        if let Some(at) = coordinates.iter().position(|c| !c.is_finite()) {
            return Err(Error::NotFinite {
                row: at / dimension,
                column: at % dimension,
            });
        }
        Ok(Self {
            dimension,
            coordinates: Arc::new(coordinates),
        })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dimension
    }

    /// Whether there is no point at all.
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// N, the dimension of the space that the points lie in.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The coordinates of point `index`, N of them.
    pub fn point(&self, index: usize) -> &[S] {
        &self.coordinates[index * self.dimension..(index + 1) * self.dimension]
    }

    /// Moves point `index`; coordinates that are not finite leave it where it is.
    ///
    /// # Panics
    /// When `place` has not N coordinates or there is no such point.
    pub fn set_point(&mut self, index: usize, place: &[S]) {
        if place.iter().all(|c| c.is_finite()) {
            let n = self.dimension;
            Arc::make_mut(&mut self.coordinates)[index * n..(index + 1) * n].copy_from_slice(place);
        }
    }

    /// All coordinates in row order.
    pub fn coordinates(&self) -> &[S] {
        &self.coordinates
    }

    /// The points one after the other.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[S]> {
        self.coordinates.chunks_exact(self.dimension)
    }

    /// Squared Euclidean distance of two points, summed in `f64`.
    pub fn squared_distance(&self, a: usize, b: usize) -> f64 {
        squared_distance(self.point(a), self.point(b))
    }

    /// The points with the given indices, in that order.
    pub fn select(&self, indices: &[usize]) -> Self {
        let mut coordinates = Vec::with_capacity(indices.len() * self.dimension);
        for &i in indices {
            coordinates.extend_from_slice(self.point(i));
        }
        Self {
            dimension: self.dimension,
            coordinates: Arc::new(coordinates),
        }
    }

    /// The same points with every coordinate in another scalar type; a clone where it is the same.
    pub fn cast<T: Scalar>(&self) -> PointCloud<T> {
        if let Some(same) = (self as &dyn Any).downcast_ref::<PointCloud<T>>() {
            return same.clone();
        }
        PointCloud {
            dimension: self.dimension,
            coordinates: Arc::new(self.coordinates.iter().map(|c| T::of(c.as_f64())).collect()),
        }
    }
}

/// Squared Euclidean distance of two coordinate rows of equal length, summed in `f64`.
///
/// Summed in four lanes, coordinate k in lane k mod 4: one sum after the other would wait for every addition.
#[inline]
pub fn squared_distance<S: Scalar>(a: &[S], b: &[S]) -> f64 {
    let square = |x: &S, y: &S| {
        let d = x.as_f64() - y.as_f64();
        d * d
    };
    let (a, last_a) = a.as_chunks::<4>();
    let (b, last_b) = b.as_chunks::<4>();
    let rest: f64 = last_a.iter().zip(last_b).map(|(x, y)| square(x, y)).sum();
    if a.is_empty() {
        return rest;
    }
    let mut lanes = [0.0; 4];
    for (x, y) in a.iter().zip(b) {
        for (k, lane) in lanes.iter_mut().enumerate() {
            *lane += square(&x[k], &y[k]);
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_infinity_with_its_place() {
        let error = PointCloud::new(2, vec![0.0_f32, 1.0, 2.0, f32::INFINITY]).unwrap_err();
        assert!(matches!(error, Error::NotFinite { row: 1, column: 1 }));
    }

    #[test]
    fn refuses_ragged_rows() {
        assert!(PointCloud::new(3, vec![0.0_f64; 4]).is_err());
        assert!(PointCloud::<f64>::new(0, vec![]).is_err());
    }

    #[test]
    fn squared_distances_count_every_coordinate() {
        for n in 0..12_u8 {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let b: Vec<f64> = (0..n).map(|k| 3.0 * f64::from(k) + 1.0).collect();
            let expected: u32 = (0..u32::from(n)).map(|k| (2 * k + 1) * (2 * k + 1)).sum();
            assert_eq!(squared_distance(&a, &b), f64::from(expected));
        }
    }

    #[test]
    fn selects_rows_in_the_order_asked_for() {
        let cloud = PointCloud::new(1, vec![0.0, 1.0, 2.0]).unwrap();
        assert_eq!(cloud.select(&[2, 0]).coordinates(), &[2.0, 0.0]);
    }
}
