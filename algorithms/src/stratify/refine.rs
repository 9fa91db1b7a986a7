//! Landmarks where the surface bends more than triangles of the usual size can follow.

use crate::tuning::RefinementTuning;
use crosscap_core::{
    Complex, Landmark, Neighbor, NeighborhoodOracle, PointCloud, Row, Scalar, Table,
};

/// A triangulation beside the points that it should follow.
pub struct Refinement<'r, S: Scalar> {
    /// Neighborhoods of places in straight lines, between the coordinates that triangles are drawn in.
    pub near: &'r dyn NeighborhoodOracle<Scalar = S>,
    /// Where every row lies; `None` where rows have no places, and nothing is added.
    pub places: Option<&'r PointCloud<f64>>,
    /// Which rows may be landmarks.
    pub may_add: &'r dyn Fn(Row) -> bool,
    /// Rows of the landmarks.
    pub rows: &'r Table<Landmark, Row>,
    /// Landmark separation dl.
    pub dl: f64,
    /// How many times dl the separation at each point is; once everywhere when left out.
    pub scale: Option<&'r [f64]>,
    /// The numbers that decide.
    pub tuning: &'r RefinementTuning,
}

impl<S: Scalar> Refinement<'_, S> {
    /// Rows that should be landmarks as well: one where the middle of a triangle or of an edge is far from
    /// every point. None where every point is one already, or rows have no places.
    ///
    /// O(log n) for each triangle, O(L) for each that strays, with L landmarks.
    pub fn rows_where_astray(&self, complex: &Complex) -> Vec<Row> {
        let mut added = Vec::new();
        let Some(places) = self.places else {
            return added;
        };
        if self.rows.len() == places.len() {
            return added;
        }
        self.each_middle(complex, places, |t, middle| {
            let corners = t.map(|v| places.point(self.rows[Landmark::from(v)].index()));
            let first = self.rows[Landmark::from(t[0])];
            let missing = self.missing(first, corners, middle, &added);
            added.extend(missing);
        });
        added
    }

    /// The middles that are asked about, one after the other.
    pub fn middles(&self, complex: &Complex) -> Vec<S> {
        let mut all = Vec::new();
        if let Some(places) = self.places {
            self.each_middle(complex, places, |_, middle| all.extend_from_slice(middle));
        }
        all
    }

    /// How far from a middle that strays the surface is looked for, at least.
    pub fn look(&self) -> f64 {
        self.tuning.look * self.tuning.growth * self.dl
    }

    /// Visits the middles of all triangles and of their edges, each with its triangle.
    fn each_middle(
        &self,
        complex: &Complex,
        places: &PointCloud<f64>,
        mut visit: impl FnMut(&[u32; 3], &[S]),
    ) {
        let place = |v: u32| places.point(self.rows[Landmark::from(v)].index());
        let mut middle: Vec<S> = Vec::new();
        for t in &complex.triangles {
            let [a, b, c] = *t;
            for corners in [&[a, b][..], &[a, c], &[b, c], &[a, b, c]] {
                middle.clear();
                middle.extend((0..places.dimension()).map(|k| {
                    let sum: f64 = corners.iter().map(|&v| place(v)[k]).sum();
                    S::of(sum / corners.len() as f64)
                }));
                visit(t, &middle);
            }
        }
    }

    /// Landmark separation at a row.
    fn separation(&self, row: Row) -> f64 {
        self.dl * self.scale.map_or(1.0, |scale| scale[row.index()])
    }

    /// A row that should be a landmark beside a triangle with the given corners, the first of which stands for `row`,
    /// and a part of which has its middle at `middle`; `added` are landmarks that were added before.
    fn missing(&self, row: Row, corners: [&[f64]; 3], middle: &[S], added: &[Row]) -> Option<Row> {
        let RefinementTuning {
            stray,
            separation,
            look,
            growth,
            ..
        } = *self.tuning;
        let places = self.places?;
        let dl = self.separation(row);
        let mut reach = stray * dl;
        if self.near.is_near(middle, S::of(reach)) {
            return None;
        }
        let mut near: Vec<Neighbor<S>> = Vec::new();
        while near.is_empty() && reach < look * dl {
            reach *= growth;
            self.near.within_of(middle, S::of(reach), &mut near);
        }
        let nearest = near.first()?;
        if off_plane(corners, middle, places.point(nearest.index)) < stray * dl {
            return None;
        }
        let free = |row: Row| self.is_free(row, added, separation * dl);
        near.iter().map(Neighbor::row).find(|&r| free(r))
    }

    /// Rows that should be landmarks as well: points that a mesh leaves behind, at an edge or a tip that its triangles
    /// cut off; the farthest first. `heights` are the distances of all points from the mesh, unit of the data.
    ///
    /// Points without company are outliers and stay where they are: a surface that goes out to a point, be it to a tip, has
    /// points nearer to it than the mesh is. None where the space has no coordinates.
    /// O(n + f (log n + L)) for n points, f of them far from the mesh, and L landmarks.
    pub fn rows_left_behind(&self, heights: &[f64]) -> Vec<Row> {
        let mut added = Vec::new();
        if self
            .places
            .is_none_or(|places| places.len() != heights.len())
        {
            return added;
        }
        let far = |row: Row| heights[row.index()] / self.separation(row);
        let is_far = |&row: &Row| far(row).is_finite() && far(row) > self.tuning.behind;
        let rows = (0..heights.len()).map(Row::new);
        let mut behind: Vec<Row> = rows.filter(is_far).collect();
        behind.sort_by(|&a, &b| far(b).total_cmp(&far(a)).then(a.cmp(&b)));
        for row in behind {
            if self.is_free(row, &added, self.tuning.separation * self.separation(row))
                && self.has_company(row, heights)
            {
                added.push(row);
            }
        }
        added
    }

    /// Whether a row has [company](has_company).
    fn has_company(&self, row: Row, heights: &[f64]) -> bool {
        let mut near: Vec<Neighbor<S>> = Vec::new();
        self.near
            .nearest(row.index(), self.tuning.company + 1, &mut near);
        let others = near.iter().filter(|x| x.index != row.index());
        let others = others.map(|x| (x.distance.as_f64(), heights[x.index]));
        has_company(heights[row.index()], others, self.tuning)
    }

    /// Whether a row may become a landmark: it lies in a cell, so far from all others and from those `added`.
    fn is_free(&self, row: Row, added: &[Row], separation: f64) -> bool {
        let Some(places) = self.places else {
            return false;
        };
        let limit = separation.powi(2);
        let mut others = self.rows.iter().chain(added);
        (self.may_add)(row)
            && others.all(|r| places.squared_distance(r.index(), row.index()) >= limit)
    }
}

/// Whether a point is one of many, `height` away from a mesh: half of its nearest, each given by its distance from the point
/// and its own height, are at least half as high, or are clearly nearer to the point than the mesh is. An outlier has no
/// company: its nearest points are on the mesh. The unit of all lengths is that of the data.
pub fn has_company(
    height: f64,
    nearest: impl Iterator<Item = (f64, f64)>,
    tuning: &RefinementTuning,
) -> bool {
    let (mut along, mut beside) = (0, 0);
    for (distance, other) in nearest {
        along += usize::from(other >= 0.5 * height);
        beside += usize::from(distance < tuning.nearer * height);
    }
    2 * along.max(beside) >= tuning.company
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
    fn an_outlier_has_no_company_and_points_of_an_edge_or_a_tip_have() {
        let tuning = RefinementTuning::MEASURED;
        let has = |near: [(f64, f64); 4]| has_company(1.0, near.into_iter(), &tuning);
        // Beside a sheet, with one other outlier near it.
        assert!(!has([(0.4, 0.8), (1.0, 0.0), (1.1, 0.1), (1.2, 0.0)]));
        // Along an edge that triangles pass below; at a tip, where the mesh is soon reached.
        assert!(has([(0.5, 0.9), (0.6, 0.9), (0.8, 0.1), (0.9, 0.2)]));
        assert!(has([(0.4, 0.4), (0.6, 0.3), (0.8, 0.1), (0.9, 0.0)]));
    }

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
