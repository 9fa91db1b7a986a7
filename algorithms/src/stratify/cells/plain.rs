//! Landmarks whose chart holds one sheet and no curve: there nearness alone says what belongs
//! together, and no flood is needed.

use crate::balls::BallTree;
use crate::orthogonal::{dot, unit_across};
use crosscap_core::Landmark;
use nalgebra::{SMatrix, SVector};

/// Coefficients of a quadratic height over two directions.
const TERMS: usize = 6;
/// Rounds of subspace iteration for the two directions.
const ROUNDS: usize = 4;

/// Where landmarks and curves are.
pub(super) struct Surroundings {
    width: usize,
    /// Places of all landmarks.
    places: Vec<f64>,
    landmarks: BallTree,
    /// Landmarks and references on curves.
    curves: BallTree,
    /// A curve has one of them at least this close to any of its points.
    curve_gap: f64,
    /// How closely a sheet follows a quadratic height, unit of the data.
    flat: f64,
}

/// Buffers of one thread.
#[derive(Default)]
pub(super) struct Scratch {
    offsets: Vec<f64>,
    ends: Vec<f64>,
    image: Vec<f64>,
    rows: Vec<SVector<f64, TERMS>>,
    right: Vec<SVector<f64, TERMS>>,
}

impl Surroundings {
    /// `places` of all landmarks and `curves`, places on curves no farther apart than twice
    /// `curve_gap`, with `width` numbers each; a sheet follows a quadratic height as closely as `flat`.
    pub(super) fn new(
        width: usize,
        places: Vec<f64>,
        curves: &[f64],
        curve_gap: f64,
        flat: f64,
    ) -> Self {
        Self {
            landmarks: BallTree::new(width, &places),
            curves: BallTree::new(width, curves),
            width,
            places,
            curve_gap,
            flat,
        }
    }

    fn place(&self, landmark: Landmark) -> &[f64] {
        let at = landmark.index() * self.width;
        &self.places[at..at + self.width]
    }

    /// The other landmarks within `radius` of one.
    pub(super) fn near(&self, landmark: Landmark, radius: f64) -> Vec<Landmark> {
        let mut out = Vec::new();
        self.landmarks
            .within(self.place(landmark), radius, |other, _| {
                let other = Landmark::from(other);
                if other != landmark {
                    out.push(other);
                }
            });
        out
    }

    /// Whether no curve comes within `radius` of a landmark and the `members`, those near it,
    /// lie on one sheet with it: a quadratic height over two directions, in every coordinate.
    pub(super) fn is_plain(
        &self,
        landmark: Landmark,
        radius: f64,
        members: &[Landmark],
        scratch: &mut Scratch,
    ) -> bool {
        let origin = self.place(landmark);
        let mut clear = true;
        self.curves
            .within(origin, radius + self.curve_gap, |_, _| clear = false);
        // As many again as a height has coefficients, or it follows anything.
        if !clear || members.len() + 1 < 2 * TERMS {
            return false;
        }
        scratch.offsets.clear();
        scratch.offsets.resize(self.width, 0.0);
        for &m in members {
            let place = self.place(m).iter().zip(origin);
            scratch.offsets.extend(place.map(|(x, o)| (x - o) / radius));
        }
        scratch.is_one_sheet(self.width, self.flat / radius)
    }
}

impl Scratch {
    /// Whether a quadratic height over two directions follows all offsets within `tolerance`, in every coordinate.
    fn is_one_sheet(&mut self, width: usize, tolerance: f64) -> bool {
        let Self {
            offsets,
            ends,
            image,
            rows,
            right,
        } = self;
        if !tangents(width, offsets, ends, image) {
            return false;
        }
        let (first, second) = ends.split_at(width);
        rows.clear();
        right.clear();
        right.resize(width, SVector::zeros());
        let mut normal = SMatrix::<f64, TERMS, TERMS>::zeros();
        for x in offsets.chunks_exact(width) {
            let (a, b) = (dot(first, x), dot(second, x));
            let row = SVector::<f64, TERMS>::from([1.0, a, b, a * a, a * b, b * b]);
            normal.ger(1.0, &row, &row, 1.0);
            for (r, &c) in right.iter_mut().zip(x) {
                r.axpy(c, &row, 1.0);
            }
            rows.push(row);
        }
        let Some(factor) = normal.cholesky() else {
            return false;
        };
        for r in right.iter_mut() {
            factor.solve_mut(r);
        }
        let limit = tolerance.powi(2);
        offsets
            .chunks_exact(width)
            .zip(rows.iter())
            .all(|(x, row)| {
                let square: f64 = x
                    .iter()
                    .zip(right.iter())
                    .map(|(c, r)| (c - r.dot(row)).powi(2))
                    .sum();
                square <= limit
            })
    }
}

/// Two orthonormal directions near those in which the offsets extend most, one after the other in
/// `ends`; `false` where the offsets lie on a line.
fn tangents(width: usize, offsets: &[f64], ends: &mut Vec<f64>, image: &mut Vec<f64>) -> bool {
    // The longest offset and the one farthest from its line are not far from the plane.
    ends.clear();
    ends.resize(2 * width, 0.0);
    for k in 0..2 {
        let (done, own) = ends.split_at_mut(k * width);
        let beside = |x: &[f64]| {
            let along = if k == 0 { 0.0 } else { dot(done, x) };
            dot(x, x) - along * along
        };
        let mut best = 0.0;
        for x in offsets.chunks_exact(width) {
            let square = beside(x);
            if square > best {
                best = square;
                own[..width].copy_from_slice(x);
            }
        }
        if !orthonormalize(width, ends, k) {
            return false;
        }
    }
    for _ in 0..ROUNDS {
        image.clear();
        image.resize(2 * width, 0.0);
        for x in offsets.chunks_exact(width) {
            for (end, out) in ends.chunks_exact(width).zip(image.chunks_exact_mut(width)) {
                let along = dot(end, x);
                for (o, c) in out.iter_mut().zip(x) {
                    *o += along * c;
                }
            }
        }
        std::mem::swap(ends, image);
        if !(orthonormalize(width, ends, 0) && orthonormalize(width, ends, 1)) {
            return false;
        }
    }
    true
}

/// Makes direction `k` of `ends` a unit vector orthogonal to those before it.
fn orthonormalize(width: usize, ends: &mut [f64], k: usize) -> bool {
    unit_across(ends, width, k, 1, 1e-12)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Landmarks on a lattice of spacing 1 over the plane, lifted by `height`, in R^5.
    fn lattice(height: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        (0..81)
            .flat_map(|k| {
                let (a, b) = (f64::from(k % 9) - 4.0, f64::from(k / 9) - 4.0);
                let h = height(a, b);
                // Askew to all coordinates.
                [
                    0.6 * a - 0.8 * h,
                    0.8 * a + 0.6 * h,
                    0.8 * b,
                    0.6 * b,
                    0.01 * a * b,
                ]
            })
            .collect()
    }

    fn middle_is_plain(places: Vec<f64>, curves: &[f64]) -> bool {
        let around = Surroundings::new(5, places, curves, 0.7, 0.1);
        let middle = Landmark::new(40);
        let members = around.near(middle, 3.0);
        around.is_plain(middle, 3.0, &members, &mut Scratch::default())
    }

    #[test]
    fn a_bent_sheet_is_plain() {
        assert!(middle_is_plain(lattice(|_, _| 0.0), &[]));
        assert!(middle_is_plain(
            lattice(|a, b| 0.05 * a * a - 0.08 * a * b),
            &[]
        ));
    }

    #[test]
    fn a_second_sheet_is_seen() {
        // Every other landmark, or one at the rim, half a spacing above the rest.
        let second = lattice(|a, b| if (a + b) % 2.0 == 0.0 { 0.0 } else { 0.5 });
        assert!(!middle_is_plain(second, &[]));
        let rim = lattice(|a, b| if a == 2.0 && b == 2.0 { 0.5 } else { 0.0 });
        assert!(!middle_is_plain(rim, &[]));
    }

    #[test]
    fn a_curve_close_by_is_seen() {
        let flat = lattice(|_, _| 0.0);
        let curve = |a: f64| [0.6 * a, 0.8 * a, 0.0, 0.0, 0.0];
        assert!(!middle_is_plain(flat.clone(), &curve(3.5)));
        assert!(middle_is_plain(flat, &curve(3.8)));
    }

    #[test]
    fn landmarks_on_a_line_are_not_a_sheet() {
        let line = (0..15).flat_map(|k| [f64::from(k) * 0.2, 0.0]).collect();
        let around = Surroundings::new(2, line, &[], 0.0, 0.02);
        let middle = Landmark::new(7);
        let members = around.near(middle, 9.0);
        assert_eq!(members.len(), 14);
        assert!(!around.is_plain(middle, 9.0, &members, &mut Scratch::default()));
    }
}
