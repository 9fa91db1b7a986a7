//! Classical scaling of a few points, the rest by their distances to these.

use super::{Scaled, significant};
use crate::execute::{self, Execute};
use crosscap_core::{Error, MetricSpace, PointCloud, Scalar};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Points that are scaled: spread as far as possible, so that they span what the others do.
const PIVOTS: usize = 192;

/// Classical scaling of at most 192 points that are spread out, with all others placed by
/// their distances to these (de Silva and Tenenbaum, "Sparse multidimensional scaling using landmark
/// points", 2004). Places have as many coordinates as eigenvalues stand out of the rounding, at
/// most `most` of them, at least 1.
///
/// The deviation is over all pairs. `O(n^2 m + 192^3)` for places in R^m.
///
/// # Errors
/// [`Error::Shape`] for no point; [`Error::NotFinite`] for points at infinite distance.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::metric::Euclidean;
/// use crosscap_algorithms::scaling::scale_metric;
/// use crosscap_core::PointCloud;
/// let rows = (0..300).flat_map(|k| [f64::from(k % 7), f64::from(k % 11), f64::from(k % 13)]);
/// let metric = Euclidean::new(PointCloud::new(3, rows.collect())?);
/// let scaled = scale_metric(&metric, 8, &Serial)?;
/// assert_eq!(scaled.places.dimension(), 3);
/// assert!(scaled.deviation < 1e-9);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub fn scale_metric<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    most: usize,
    execute: &dyn Execute,
) -> Result<Scaled, Error> {
    let (pivots, squares) = spread(metric)?;
    let places = placed(&pivots, &squares, metric.len(), most)?;
    let n = metric.len();
    let all: Vec<usize> = (0..n).collect();
    let worst = execute::map(execute, n, Vec::new, |row, i| {
        metric.distances_to(i, &all[..i], row);
        (row.iter().enumerate())
            .map(|(j, d)| (d.as_f64() - places.squared_distance(i, j).sqrt()).abs())
            .fold(0.0, f64::max)
    });
    Ok(Scaled {
        deviation: worst.into_iter().fold(0.0, f64::max),
        places,
    })
}

/// The same for distances that are not those of points, where all of them would cost too much: a
/// picture in R^`dimension` or less. The deviation is over the distances to the pivots.
///
/// # Errors
/// As [`scale_metric`].
pub fn picture_of_metric<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
    dimension: usize,
) -> Result<Scaled, Error> {
    let (pivots, squares) = spread(metric)?;
    let n = metric.len();
    let places = placed(&pivots, &squares, n, dimension)?;
    let differences = (squares.chunks_exact(n).zip(&pivots)).flat_map(|(row, &p)| {
        let places = &places;
        let pairs = row.iter().enumerate();
        pairs.map(move |(j, s)| (s.sqrt() - places.squared_distance(p, j).sqrt()).abs())
    });
    Ok(Scaled {
        deviation: differences.fold(0.0, f64::max),
        places,
    })
}

fn placed(
    pivots: &[usize],
    squares: &[f64],
    n: usize,
    most: usize,
) -> Result<PointCloud<f64>, Error> {
    let frame = PivotFrame::new(pivots, squares, n, most);
    let width = frame.width();
    let mut places = vec![0.0; n * width];
    let mut to_pivots = vec![0.0; pivots.len()];
    for (i, place) in places.chunks_exact_mut(width).enumerate() {
        for (d, row) in to_pivots.iter_mut().zip(squares.chunks_exact(n)) {
            *d = row[i];
        }
        frame.place(&to_pivots, place);
    }
    PointCloud::new(width, places)
}

/// Points each of which is farthest from those before, and their squared distances to all points.
fn spread<S: Scalar>(
    metric: &dyn MetricSpace<Scalar = S>,
) -> Result<(Vec<usize>, Vec<f64>), Error> {
    let n = metric.len();
    if n == 0 {
        return Err(Error::Shape {
            found: "no point".into(),
            expected: "at least 1".into(),
        });
    }
    let all: Vec<usize> = (0..n).collect();
    let mut pivots = Vec::new();
    let mut squares = Vec::new();
    let mut nearest = vec![f64::INFINITY; n];
    let mut row = Vec::new();
    let mut next = 0;
    while pivots.len() < PIVOTS.min(n) {
        metric.distances_to(next, &all, &mut row);
        if let Some(column) = row.iter().position(|d| !d.is_finite()) {
            return Err(Error::NotFinite { row: next, column });
        }
        pivots.push(next);
        squares.extend(row.iter().map(|d| d.as_f64() * d.as_f64()));
        for (near, d) in nearest.iter_mut().zip(&row) {
            *near = near.min(d.as_f64());
        }
        let far = (0..n).max_by(|&a, &b| nearest[a].total_cmp(&nearest[b]).then(b.cmp(&a)));
        match far {
            Some(far) if nearest[far] > 0.0 => next = far,
            _ => break,
        }
    }
    Ok((pivots, squares))
}

/// What places a point by its distances to the pivots.
pub(super) struct PivotFrame {
    /// Leading eigenvectors over the roots of their eigenvalues, one a row.
    axes: Vec<DVector<f64>>,
    /// Mean squared distance of each pivot to the others.
    means: Vec<f64>,
    /// Eigenvalues of these axes.
    pub(super) eigenvalues: Vec<f64>,
}

impl PivotFrame {
    /// `squares` has a row of `n` squared distances for each pivot.
    fn new(pivots: &[usize], squares: &[f64], n: usize, most: usize) -> Self {
        let square = |a: usize, b: usize| squares[a * n + pivots[b]];
        Self::of(pivots.len(), most, square)
    }

    /// Classical scaling of `count` points by their squared distances.
    pub(super) fn of(count: usize, most: usize, square: impl Fn(usize, usize) -> f64) -> Self {
        let mut gram = DMatrix::<f64>::from_fn(count, count, square);
        let means: Vec<f64> = (0..count).map(|i| gram.row(i).mean()).collect();
        let mean = means.iter().sum::<f64>() / count as f64;
        for i in 0..count {
            for j in 0..count {
                gram[(i, j)] = -0.5 * (gram[(i, j)] - means[i] - means[j] + mean);
            }
        }
        let eigen = SymmetricEigen::new(gram);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let values: Vec<f64> = order.iter().map(|&k| eigen.eigenvalues[k]).collect();
        let kept = significant(&values).min(most.max(1));
        Self {
            axes: (order.iter().take(kept).zip(&values))
                .map(|(&k, &value)| {
                    let root = value.max(0.0).sqrt();
                    let scale = if root > 0.0 { 1.0 / root } else { 0.0 };
                    eigen.eigenvectors.column(k) * scale
                })
                .collect(),
            eigenvalues: values[..kept].to_vec(),
            means,
        }
    }

    pub(super) fn width(&self) -> usize {
        self.axes.len()
    }

    /// Place of a point by its squared distances to the pivots.
    pub(super) fn place(&self, squares: &[f64], place: &mut [f64]) {
        for (x, axis) in place.iter_mut().zip(&self.axes) {
            let pairs = squares.iter().zip(&self.means).zip(axis.iter());
            *x = 0.5 * pairs.map(|((s, mean), a)| (mean - s) * a).sum::<f64>();
        }
    }
}
