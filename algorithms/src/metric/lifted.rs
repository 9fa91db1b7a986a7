//! Position and tangent plane together.

use std::sync::Arc;

use crosscap_core::{Error, MetricSpace, PointCloud, Scalar};

/// How far a tangent basis may be from orthonormal.
const ORTHONORMAL: f64 = 1e-5;
/// Largest dimension of a tangent plane.
const MOST_DIMENSIONS: usize = 8;

/// Distances between points with a tangent plane each:
///
/// ```text
/// d(x, y)^2 = |x - y|^2 + w^2 |P_x - P_y|_F^2 / 2
/// ```
///
/// with `P_x` the orthogonal projection onto the tangent plane at `x`. Two sheets that cross are
/// close in space and far apart here, so that a neighborhood keeps to its sheet. The second term
/// is `w^2` times the sum of the squared sines of the principal angles between the planes: `w` has
/// the unit of the data, and is the distance at which two planes at a right angle in one direction
/// are held apart in one place. It depends on the plane, not on the basis that describes it.
///
/// `O(N + N d^2)` a distance with planes of dimension `d`.
///
/// ```
/// use crosscap_algorithms::metric::Lifted;
/// use crosscap_core::{MetricSpace, PointCloud};
/// // One place, on the plane z = 0 and on the plane y = 0.
/// let cloud = PointCloud::new(3, vec![0.0; 6]).unwrap();
/// let bases = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, /**/ 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
/// let lifted = Lifted::new(cloud, 2, bases, 0.5).unwrap();
/// assert_eq!(lifted.distance(0, 1), 0.5);
/// ```
#[derive(Clone, Debug)]
pub struct Lifted<S> {
    cloud: Arc<PointCloud<S>>,
    plane_dimension: usize,
    bases: Vec<S>,
    weight: f64,
}

impl<S: Scalar> Lifted<S> {
    /// Takes a cloud of `n` points in R^N, for every point `plane_dimension` orthonormal vectors of
    /// N numbers each (`n * plane_dimension * N` numbers in that order), and the weight `w`.
    ///
    /// # Errors
    /// [`Error::Shape`] when the number of basis coordinates does not fit, [`Error::NotFinite`]
    /// (row: the point, column: the place in its basis), [`Error::Parameter`] when the weight is
    /// negative, not finite or too large to be squared, when the planes have more dimensions than the space or than 8, or for the
    /// first basis that is further than 1e-5 from orthonormal.
    pub fn new(
        cloud: impl Into<Arc<PointCloud<S>>>,
        plane_dimension: usize,
        bases: Vec<S>,
        weight: f64,
    ) -> Result<Self, Error> {
        let cloud = cloud.into();
        let space = cloud.dimension();
        let most = space.min(MOST_DIMENSIONS);
        if plane_dimension > most {
            return Err(Error::Parameter {
                name: "plane dimension",
                value: plane_dimension.to_string(),
                expected: format!("at most {most} in R^{space}"),
            });
        }
        if !(weight >= 0.0 && (weight * weight).is_finite()) {
            return Err(Error::Parameter {
                name: "weight",
                value: weight.to_string(),
                expected: "at least 0, and so small that its square is finite".into(),
            });
        }
        let each = plane_dimension * space;
        if bases.len() != cloud.len() * each {
            return Err(Error::Shape {
                found: format!("{} basis coordinates", bases.len()),
                expected: format!(
                    "{} points x {plane_dimension} vectors x {space} coordinates",
                    cloud.len()
                ),
            });
        }
        if let Some(at) = bases.iter().position(|x| !x.is_finite()) {
            return Err(Error::NotFinite {
                row: at / each,
                column: at % each,
            });
        }
        let lifted = Self {
            cloud,
            plane_dimension,
            bases,
            weight,
        };
        lifted.bases_are_orthonormal()?;
        Ok(lifted)
    }

    fn bases_are_orthonormal(&self) -> Result<(), Error> {
        for point in 0..self.cloud.len() {
            for i in 0..self.plane_dimension {
                for j in 0..=i {
                    let product = dot(self.vector(point, i), self.vector(point, j));
                    let expected = if i == j { 1.0 } else { 0.0 };
                    let error = (product - expected).abs();
                    if error > ORTHONORMAL || error.is_nan() {
                        return Err(Error::Parameter {
                            name: "tangent basis",
                            value: format!(
                                "{product} as the product of vectors {j} and {i} at point {point}"
                            ),
                            expected: format!("{expected} (an orthonormal basis)"),
                        });
                    }
                }
            }
        }
        Ok(())
    }

    /// The same space as points of R^(N + N(N+1)/2), whose straight-line distances are the lifted
    /// ones within rounding: first the N coordinates of the cloud, then the entries of the
    /// projection on and above its diagonal, times `w` off the diagonal and `w / sqrt 2` on it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] when the weight is so large that an entry overflows.
    ///
    /// ```
    /// use crosscap_algorithms::metric::Lifted;
    /// use crosscap_core::{MetricSpace, PointCloud};
    /// let cloud = PointCloud::new(2, vec![0.0, 0.0, 3.0, 0.0]).unwrap();
    /// let lifted = Lifted::new(cloud, 1, vec![1.0, 0.0, 0.0, 1.0], 4.0).unwrap();
    /// assert_eq!(lifted.distance(0, 1), 5.0);
    /// assert!((lifted.coordinates().unwrap().squared_distance(0, 1) - 25.0).abs() < 1e-12);
    /// ```
    pub fn coordinates(&self) -> Result<PointCloud<S>, Error> {
        let n = self.cloud.dimension();
        let width = n + n * (n + 1) / 2;
        let mut rows = Vec::with_capacity(self.cloud.len() * width);
        for point in 0..self.cloud.len() {
            rows.extend_from_slice(self.cloud.point(point));
            for a in 0..n {
                for b in a..n {
                    let entry: f64 = (0..self.plane_dimension)
                        .map(|i| self.vector(point, i))
                        .map(|v| v[a].as_f64() * v[b].as_f64())
                        .sum();
                    let scale = if a == b {
                        std::f64::consts::FRAC_1_SQRT_2
                    } else {
                        1.0
                    };
                    rows.push(S::of(self.weight * scale * entry));
                }
            }
        }
        PointCloud::new(width, rows)
    }

    fn vector(&self, point: usize, i: usize) -> &[S] {
        let space = self.cloud.dimension();
        let start = (point * self.plane_dimension + i) * space;
        &self.bases[start..start + space]
    }

    /// `|P_x - P_y|_F^2 / 2`: the sum of the squared sines of the principal angles.
    ///
    /// The part of each basis vector that leaves the other plane is measured directly: the textbook
    /// formula `d - |U^T V|_F^2` loses half of the digits where the planes are nearly the same.
    fn squared_sines(&self, a: usize, b: usize) -> f64 {
        (self.leaving(a, b) + self.leaving(b, a)) / 2.0
    }

    fn leaving(&self, from: usize, plane: usize) -> f64 {
        let d = self.plane_dimension;
        let mut total = 0.0;
        let mut products = [0.0; MOST_DIMENSIONS];
        for i in 0..d {
            let vector = self.vector(from, i);
            for (j, p) in products[..d].iter_mut().enumerate() {
                *p = dot(vector, self.vector(plane, j));
            }
            for (k, x) in vector.iter().enumerate() {
                let inside: f64 = (0..d)
                    .map(|j| products[j] * self.vector(plane, j)[k].as_f64())
                    .sum();
                total += (x.as_f64() - inside).powi(2);
            }
        }
        total
    }
}

fn dot<S: Scalar>(a: &[S], b: &[S]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x.as_f64() * y.as_f64()).sum()
}

impl<S: Scalar> MetricSpace for Lifted<S> {
    type Scalar = S;

    fn len(&self) -> usize {
        self.cloud.len()
    }

    fn distance(&self, a: usize, b: usize) -> S {
        if a == b {
            return S::zero();
        }
        let turned = self.weight * self.weight * self.squared_sines(a, b);
        S::of((self.cloud.squared_distance(a, b) + turned).sqrt())
    }

    fn name(&self) -> &str {
        "lifted by tangent planes"
    }
}
