//! A sheet through points of R^N: quadratic heights over their principal plane.

use crate::orthogonal::dot;
use nalgebra::{SMatrix, SVector};

/// Coefficients of a quadratic height: 1, a, b, a^2, a b, b^2.
pub(super) const TERMS: usize = 6;
/// Fewest points that are fitted: twice the coefficients.
pub(super) const LEAST_POINTS: usize = 2 * TERMS;
/// Steps of the search for the principal plane, each of which shrinks what lies outside it by the
/// ratio of the third to the second variance.
const STEPS: usize = 40;
/// A plane that turns by less in a step is found (square of the sine; heights have a slope of their own).
const STILL: f64 = 1e-14;
/// Share of the trace that is added to the normal equations, so that directions without points stay flat.
const RIDGE: f64 = 1e-9;

/// A weighted least-squares fit, with the buffers of the next one.
///
/// Over a ball of radius r a quadratic leaves terms of third order, so that what is left over is noise
/// where r is small against the radius of curvature.
#[derive(Clone, Debug, Default)]
pub(crate) struct SheetFit {
    dimension: usize,
    mean: Vec<f64>,
    /// Two orthonormal rows of N.
    tangents: [Vec<f64>; 2],
    /// For each term a vector of R^N across the plane.
    terms: [Vec<f64>; TERMS],
    /// Root mean square of the distances from the mean along the plane.
    extent: f64,
    centered: Vec<f64>,
    next: [Vec<f64>; 2],
}

fn subtract(from: &mut [f64], factor: f64, what: &[f64]) {
    for (x, y) in from.iter_mut().zip(what) {
        *x -= factor * y;
    }
}

/// Scales to length 1; `false` for nothing.
fn normalize(x: &mut [f64]) -> bool {
    let length = dot(x, x).sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return false;
    }
    x.iter_mut().for_each(|c| *c /= length);
    true
}

fn row(a: f64, b: f64) -> SVector<f64, TERMS> {
    SVector::from([1.0, a, b, a * a, a * b, b * b])
}

impl SheetFit {
    pub(crate) fn new(dimension: usize) -> Self {
        let zeros = || vec![0.0; dimension];
        Self {
            dimension,
            mean: zeros(),
            tangents: [zeros(), zeros()],
            terms: std::array::from_fn(|_| zeros()),
            extent: 0.0,
            centered: Vec::new(),
            next: [zeros(), zeros()],
        }
    }

    /// Root mean square of the distances of the fitted points from their mean, along the plane.
    pub(super) fn extent(&self) -> f64 {
        self.extent
    }

    /// Fits the sheet to points (`dimension` numbers each) with their weights. `false` for fewer than 12
    /// points of positive weight, or points on a line. O(k N) for k points, a few dozen times.
    pub(crate) fn fit(&mut self, points: &[f64], weights: &[f64]) -> bool {
        let n = self.dimension;
        let total: f64 = weights.iter().sum();
        if weights.iter().filter(|w| **w > 0.0).count() < LEAST_POINTS {
            return false;
        }
        self.mean.fill(0.0);
        for (x, w) in points.chunks_exact(n).zip(weights) {
            subtract(&mut self.mean, -w / total, x);
        }
        self.centered.clear();
        self.centered.extend_from_slice(points);
        for x in self.centered.chunks_exact_mut(n) {
            subtract(x, 1.0, &self.mean);
        }
        self.find_plane(weights) && self.fit_heights(weights)
    }

    /// The plane of the two largest variances, by iterating both directions together.
    fn find_plane(&mut self, weights: &[f64]) -> bool {
        let n = self.dimension;
        let rows = || self.centered.chunks_exact(n).zip(weights);
        let farthest = |off: &dyn Fn(&[f64]) -> f64| {
            rows().fold((0.0, None), |best: (f64, Option<&[f64]>), (x, w)| {
                let size = w * off(x);
                if size > best.0 { (size, Some(x)) } else { best }
            })
        };
        let Some(first) = farthest(&|x| dot(x, x)).1 else {
            return false;
        };
        self.tangents[0].copy_from_slice(first);
        if !normalize(&mut self.tangents[0]) {
            return false;
        }
        let along = &self.tangents[0];
        let Some(second) = farthest(&|x| dot(x, x) - dot(x, along).powi(2)).1 else {
            return false;
        };
        self.tangents[1].copy_from_slice(second);
        for _ in 0..STEPS {
            let [first, second] = &mut self.tangents;
            let inside = dot(first, second);
            subtract(second, inside, first);
            if !normalize(second) {
                return false;
            }
            self.next.iter_mut().for_each(|x| x.fill(0.0));
            for (x, w) in self.centered.chunks_exact(n).zip(weights) {
                for (next, axis) in self.next.iter_mut().zip(&self.tangents) {
                    subtract(next, -w * dot(x, axis), x);
                }
            }
            let [first, second] = &mut self.next;
            if !normalize(first) {
                return false;
            }
            let inside = dot(first, second);
            subtract(second, inside, first);
            if !normalize(second) {
                return false;
            }
            // What the old directions leave of the new ones: the sine of the turn.
            let turned = self.next.iter().map(|x| {
                let inside: f64 = self.tangents.iter().map(|t| dot(t, x).powi(2)).sum();
                1.0 - inside
            });
            let still = turned.fold(0.0, f64::max) < STILL;
            std::mem::swap(&mut self.tangents, &mut self.next);
            if still {
                break;
            }
        }
        true
    }

    fn fit_heights(&mut self, weights: &[f64]) -> bool {
        let n = self.dimension;
        let total: f64 = weights.iter().sum();
        let inside = |x: &[f64]| [dot(x, &self.tangents[0]), dot(x, &self.tangents[1])];
        let rows = || self.centered.chunks_exact(n).zip(weights);
        let square: f64 = rows()
            .map(|(x, w)| w * inside(x).map(|c| c * c).iter().sum::<f64>())
            .sum();
        self.extent = (square / total).sqrt();
        if !(self.extent > 0.0 && self.extent.is_finite()) {
            return false;
        }
        let mut normal = SMatrix::<f64, TERMS, TERMS>::zeros();
        self.terms.iter_mut().for_each(|t| t.fill(0.0));
        for (x, &w) in self.centered.chunks_exact(n).zip(weights) {
            let [a, b] = [dot(x, &self.tangents[0]), dot(x, &self.tangents[1])];
            let r = row(a / self.extent, b / self.extent);
            normal.ger(w, &r, &r, 1.0);
            for (term, factor) in self.terms.iter_mut().zip(r.iter()) {
                subtract(term, -w * factor, x);
            }
        }
        let ridge = RIDGE * normal.trace();
        for k in 0..TERMS {
            normal[(k, k)] += ridge;
        }
        let Some(inverse) = normal.cholesky().map(|c| c.inverse()) else {
            return false;
        };
        for axis in 0..n {
            let right = SVector::<f64, TERMS>::from_fn(|k, _| self.terms[k][axis]);
            let solved = inverse * right;
            for k in 0..TERMS {
                self.terms[k][axis] = solved[k];
            }
        }
        // Heights are what lies across the plane.
        for term in &mut self.terms {
            for axis in &self.tangents {
                let inside = dot(term, axis);
                subtract(term, inside, axis);
            }
        }
        true
    }

    /// Coordinates of a point in the plane, and its offset from the mean into `offset`.
    fn coordinates(&self, x: &[f64], offset: &mut Vec<f64>) -> [f64; 2] {
        offset.clear();
        offset.extend(x.iter().zip(&self.mean).map(|(x, m)| x - m));
        [
            dot(offset, &self.tangents[0]),
            dot(offset, &self.tangents[1]),
        ]
    }

    /// Distance of `x` from the sheet along its normal space. Beyond `reach` in the plane the sheet is not
    /// extrapolated: what counts is then the distance from its rim.
    pub(crate) fn distance(&self, x: &[f64], reach: f64, offset: &mut Vec<f64>) -> f64 {
        let [a, b] = self.coordinates(x, offset);
        let out = a.hypot(b);
        let share = if out > reach { reach / out } else { 1.0 };
        self.remove_sheet([a * share, b * share], offset);
        dot(offset, offset).sqrt()
    }

    /// Distance of `x` from the mean, along the plane.
    pub(super) fn out(&self, x: &[f64], offset: &mut Vec<f64>) -> f64 {
        let [a, b] = self.coordinates(x, offset);
        a.hypot(b)
    }

    /// Orthonormal directions of the plane that touches the sheet across from `x`.
    pub(crate) fn touching(&self, x: &[f64], offset: &mut Vec<f64>) -> [Vec<f64>; 2] {
        let [a, b] = self.coordinates(x, offset).map(|c| c / self.extent);
        let [mut first, mut second] = self.tangents.clone();
        for (term, [along, across]) in [
            (1, [1.0, 0.0]),
            (2, [0.0, 1.0]),
            (3, [2.0 * a, 0.0]),
            (4, [b, a]),
            (5, [0.0, 2.0 * b]),
        ] {
            subtract(&mut first, -along / self.extent, &self.terms[term]);
            subtract(&mut second, -across / self.extent, &self.terms[term]);
        }
        normalize(&mut first);
        let inside = dot(&first, &second);
        subtract(&mut second, inside, &first);
        normalize(&mut second);
        [first, second]
    }

    /// The mean of the points that were fitted.
    pub(crate) fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// The same without what only a next fit would use.
    pub(crate) fn kept(mut self) -> Self {
        self.centered = Vec::new();
        self
    }

    /// Subtracts the point of the sheet over the given coordinates from an offset.
    fn remove_sheet(&self, [a, b]: [f64; 2], offset: &mut [f64]) {
        subtract(offset, a, &self.tangents[0]);
        subtract(offset, b, &self.tangents[1]);
        let r = row(a / self.extent, b / self.extent);
        for (term, factor) in self.terms.iter().zip(r.iter()) {
            subtract(offset, *factor, term);
        }
    }

    /// Moves `x` across the plane onto the sheet.
    pub(crate) fn project(&self, x: &mut [f64], offset: &mut Vec<f64>) {
        let inside = self.coordinates(x, offset);
        self.remove_sheet(inside, offset);
        for (x, o) in x.iter_mut().zip(&*offset) {
            *x -= o;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surfaces::Random;

    /// Points of a paraboloid in R^5.
    fn paraboloid(count: usize) -> Vec<f64> {
        let mut random = Random::new(3);
        (0..count)
            .flat_map(|_| {
                let (a, b) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
                let (h, g) = (0.2 * a * a - 0.1 * a * b, 0.15 * b * b + 0.3);
                [a, 0.6 * b + 0.8 * h, 0.8 * b - 0.6 * h, g, 7.0]
            })
            .collect()
    }

    #[test]
    fn a_quadratic_sheet_is_left_in_its_place() {
        let points = paraboloid(60);
        let mut fit = SheetFit::new(5);
        assert!(fit.fit(&points, &[1.0; 60]));
        let mut offset = Vec::new();
        for x in points.chunks(5) {
            assert!(fit.distance(x, 10.0, &mut offset) < 0.02);
        }
        let flat: Vec<f64> = points.chunks(5).flat_map(|x| [x[0], x[1], 2.0]).collect();
        let mut fit = SheetFit::new(3);
        assert!(fit.fit(&flat, &[1.0; 60]));
        let mut x = [0.3, 0.2, 5.0];
        assert!((fit.distance(&x, 10.0, &mut offset) - 3.0).abs() < 1e-9);
        fit.project(&mut x, &mut offset);
        assert!((x[2] - 2.0).abs() < 1e-9 && (x[0] - 0.3).abs() < 1e-9);
    }

    #[test]
    fn the_rim_is_where_a_sheet_ends() {
        let flat: Vec<f64> = (0..49)
            .flat_map(|k| [f64::from(k % 7) - 3.0, f64::from(k / 7) - 3.0, 0.0])
            .collect();
        let mut fit = SheetFit::new(3);
        assert!(fit.fit(&flat, &[1.0; 49]));
        let mut offset = Vec::new();
        assert!((fit.distance(&[10.0, 0.0, 0.0], 4.0, &mut offset) - 6.0).abs() < 1e-9);
        assert!((fit.out(&[0.0, 8.0, 1.0], &mut offset) - 8.0).abs() < 1e-9);
    }

    #[test]
    fn points_of_a_line_and_few_points_have_no_sheet() {
        let line: Vec<f64> = (0..20).flat_map(|k| [f64::from(k), 0.0, 0.0]).collect();
        let mut fit = SheetFit::new(3);
        assert!(!fit.fit(&line, &[1.0; 20]));
        assert!(!fit.fit(&line[..33], &[1.0; 11]));
        assert!(!fit.fit(&[1.0; 60], &[1.0; 20]));
    }
}
