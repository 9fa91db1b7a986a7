//! Landmarks where the surface bends more than triangles of the usual size can follow.

use super::producer::WaistProducer;
use crate::tuning::RefinementTuning;
use crosscap_core::{Complex, Neighbor, NeighborhoodOracle, Scalar};

/// A triangulation beside the points that it should follow.
pub struct Refinement<'r, S: Scalar> {
    /// Neighborhoods of places in straight lines, between the coordinates that triangles are drawn in.
    pub near: &'r dyn NeighborhoodOracle<Scalar = S>,
    /// Says where every row lies, and which may be landmarks.
    pub producer: &'r dyn WaistProducer<S>,
    /// Rows of the landmarks.
    pub rows: &'r [usize],
    /// Landmark separation dl.
    pub dl: f64,
    /// The numbers that decide.
    pub tuning: &'r RefinementTuning,
}

impl<S: Scalar> Refinement<'_, S> {
    /// Rows that should be landmarks as well: one where the middle of a triangle or of an edge is far from
    /// every point. None where every point is one already, or the producer names no places.
    ///
    /// O(log n) for each triangle, O(L) for each that strays, with L landmarks.
    pub fn rows_where_astray(&self, complex: &Complex) -> Vec<usize> {
        let mut added = Vec::new();
        let Some(places) = self.producer.places() else {
            return added;
        };
        if self.rows.len() == places.len() {
            return added;
        }
        let place = |v: u32| places.point(self.rows[v as usize]);
        let mut middle: Vec<S> = Vec::new();
        for t in &complex.triangles {
            let [a, b, c] = *t;
            for corners in [&[a, b][..], &[a, c], &[b, c], &[a, b, c]] {
                middle.clear();
                middle.extend((0..places.dimension()).map(|k| {
                    let sum: f64 = corners.iter().map(|&v| place(v)[k]).sum();
                    S::of(sum / corners.len() as f64)
                }));
                added.extend(self.missing(t.map(place), &middle, &added));
            }
        }
        added
    }

    /// A row that should be a landmark beside a triangle with the given corners, a part of which has its
    /// middle at `middle`; `added` are landmarks that were added before.
    fn missing(&self, corners: [&[f64]; 3], middle: &[S], added: &[usize]) -> Option<usize> {
        let RefinementTuning {
            stray,
            separation,
            look,
            growth,
            ..
        } = *self.tuning;
        let places = self.producer.places()?;
        let mut reach = stray * self.dl;
        if self.near.is_near(middle, S::of(reach)) {
            return None;
        }
        let mut near: Vec<Neighbor<S>> = Vec::new();
        while near.is_empty() && reach < look * self.dl {
            reach *= growth;
            self.near.within_of(middle, S::of(reach), &mut near);
        }
        let nearest = near.first()?;
        if off_plane(corners, middle, places.point(nearest.index)) < stray * self.dl {
            return None;
        }
        let limit = (separation * self.dl).powi(2);
        let free = |row: usize| {
            let mut others = self.rows.iter().chain(added);
            self.producer.may_add(row) && others.all(|&r| places.squared_distance(r, row) >= limit)
        };
        near.iter().map(|x| x.index).find(|&r| free(r))
    }
}

/// Distance of `x` from the plane through `middle` that is parallel to a triangle, in R^N.
fn off_plane<S: Scalar>(corners: [&[f64]; 3], middle: &[S], x: &[f64]) -> f64 {
    let minus =
        |p: &[f64], q: &[f64]| -> Vec<f64> { p.iter().zip(q).map(|(a, b)| a - b).collect() };
    let dot = |p: &[f64], q: &[f64]| -> f64 { p.iter().zip(q).map(|(a, b)| a * b).sum() };
    let (u, v) = (minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    let w: Vec<f64> = x.iter().zip(middle).map(|(a, m)| a - m.as_f64()).collect();
    let (uu, uv, vv, uw, vw) = (
        dot(&u, &u),
        dot(&u, &v),
        dot(&v, &v),
        dot(&u, &w),
        dot(&v, &w),
    );
    let area = uu * vv - uv * uv;
    if area <= 1e-12 * uu * vv {
        return dot(&w, &w).sqrt();
    }
    let (s, t) = ((uw * vv - vw * uv) / area, (vw * uu - uw * uv) / area);
    let inside: f64 = s * uw + t * vw;
    (dot(&w, &w) - inside).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_far_a_point_is_off_the_plane_of_a_triangle() {
        let corners = [
            [0.0, 0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
        ];
        let corners = [0, 1, 2].map(|k| &corners[k][..]);
        let middle = [0.3, 0.3, 0.0, 0.0];
        let off = |x: [f64; 4]| off_plane::<f64>(corners, &middle, &x);
        assert!((off([0.7, -2.0, 3.0, 4.0]) - 5.0).abs() < 1e-12);
        assert!(off([5.0, 5.0, 0.0, 0.0]) < 1e-9);
        // A triangle without area has no plane.
        let flat = [corners[0], corners[1], corners[1]];
        assert!((off_plane::<f64>(flat, &middle, &[0.3, 0.3, 0.0, 2.0]) - 2.0).abs() < 1e-12);
    }
}
