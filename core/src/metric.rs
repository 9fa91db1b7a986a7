//! Distances between the points of a finite set.

use crate::{PointCloud, Scalar};

/// A finite metric space: points are the integers `0..len()`.
///
/// # Why it has this shape
/// The method needs nothing of a space but the distances of points it was given, so that is all the trait asks:
/// one required method that takes two indices. Indices, and not coordinates, because a measured matrix, a graph
/// or a torus has none that would mean anything. Distances, and not their squares, because only distances of
/// every kind of space satisfy the triangle inequality that the search for neighbors and the covering by
/// landmarks rely on. `distances_to` has a default and exists because a search through a graph finds many
/// distances for the price of one. There is no error to return: a metric has an answer for every pair, and one
/// that has none has a fault, which is found where its answers are used.
///
/// # Laws
/// For all points `a`, `b`, `c`:
/// - *identity*: `distance(a, a) == 0` and distances are at least 0;
/// - *symmetry*: `distance(a, b) == distance(b, a)`, to the bit;
/// - *triangle inequality*: `distance(a, c) <= distance(a, b) + distance(b, c)` within rounding;
/// - *never NaN*; infinity says that no path joins the two points;
/// - *many at once*: [`MetricSpace::distances_to`] gives what `distance` gives, to the bit;
/// - *places*: where [`MetricSpace::places`] names coordinates, every distance is that of a straight
///   line between them, within rounding.
///
/// Distances are in the unit of the data. An implementation over coordinates need
/// not be a norm: a graph distance, a distance on a torus or a measured matrix serve as well.
pub trait MetricSpace: Sync {
    /// Type that distances are given in.
    type Scalar: Scalar;

    /// Number of points.
    fn len(&self) -> usize;

    /// Whether there is no point.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Distance of two points.
    ///
    /// # Panics
    /// May panic when an index is not below [`MetricSpace::len`].
    fn distance(&self, a: usize, b: usize) -> Self::Scalar;

    /// Writes the distance from `from` to each of `to` into `out`, in their order; the former
    /// content of `out` is dropped. One `distance` each unless an implementation knows better: a
    /// search through a graph finds them all at once.
    ///
    /// # Panics
    /// May panic when an index is not below [`MetricSpace::len`].
    fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<Self::Scalar>) {
        out.clear();
        out.extend(to.iter().map(|&point| self.distance(from, point)));
    }

    /// Coordinates of the points, where the metric is the straight line between them; `None`, as it
    /// stands, for every other metric.
    ///
    /// Search trees over coordinates answer for such a metric without asking it. A metric that *uses*
    /// coordinates but measures otherwise, along a surface or around a torus, must not name them.
    fn places(&self) -> Option<&PointCloud<Self::Scalar>> {
        None
    }

    /// Short name for reports.
    fn name(&self) -> &str;
}

impl<M: MetricSpace + ?Sized> MetricSpace for &M {
    type Scalar = M::Scalar;
    fn len(&self) -> usize {
        (**self).len()
    }
    fn distance(&self, a: usize, b: usize) -> Self::Scalar {
        (**self).distance(a, b)
    }
    fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<Self::Scalar>) {
        (**self).distances_to(from, to, out);
    }
    fn places(&self) -> Option<&PointCloud<Self::Scalar>> {
        (**self).places()
    }
    fn name(&self) -> &str {
        (**self).name()
    }
}

impl<M: MetricSpace + ?Sized> MetricSpace for Box<M> {
    type Scalar = M::Scalar;
    fn len(&self) -> usize {
        (**self).len()
    }
    fn distance(&self, a: usize, b: usize) -> Self::Scalar {
        (**self).distance(a, b)
    }
    fn distances_to(&self, from: usize, to: &[usize], out: &mut Vec<Self::Scalar>) {
        (**self).distances_to(from, to, out);
    }
    fn places(&self) -> Option<&PointCloud<Self::Scalar>> {
        (**self).places()
    }
    fn name(&self) -> &str {
        (**self).name()
    }
}
