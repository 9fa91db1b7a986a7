//! What the level asks its questions of: the mesh with the points that stand on it, their spacing, and how even they are.

use super::evenness::{Evenness, NEIGHBOR};
use super::footprints::Footprints;
use super::ground::Ground;
use super::standing::Standing;
use super::tiles::Empty;
use crate::balls::BallTree;
use crate::certificate::geometry::corners;
use crate::certificate::incidence::Incidence;
use crate::certificate::quality::{median, quantile};
use crosscap_core::{Mesh, PointCloud, squared_distance};
use std::f64::consts::PI;

/// Places of the mesh that the evenness is read from.
const READ: usize = 4000;
/// Radius about a point that holds that many neighbors nearly always, in spacings: 20 are expected.
const NEIGHBORHOOD: f64 = 2.5;
/// Part of an edge of the boundary up to which the mesh may end beyond its points: the height of the arc
/// over a chord.
pub(super) const CHORD: f64 = 0.15;
/// Ratio of the 90 to the 10 percent quantile of the local spacing above which the density varies: slits of less than
/// two spacings are not looked for then, as an error of a tenth in the spacing makes them, and a thin place
/// among dense ones is no gap.
const VARIES: f64 = 1.5;

/// Tiles of one triangle for each point of the whole sample, about: at the density that the points have a triangle that holds all of them needs fewer. One that would need
/// more is nearly empty, or without area, and larger tiles show that as well.
const TILES: f64 = 16.0;

/// What gaps are looked for in.
pub(in crate::certificate) struct Search<'a> {
    pub mesh: &'a Mesh,
    pub incidence: &'a Incidence,
    pub feet: &'a Footprints,
    pub ground: &'a Ground,
    /// The points themselves.
    pub(super) cloud: &'a PointCloud<f64>,
    /// Which points are on which triangle.
    pub(super) standing: Standing,
    /// The points that stand on triangles, by their positions among the feet, and the tree of their places.
    on_triangles: Vec<u32>,
    tree: BallTree,
    rim: Option<BallTree>,
    /// What is taken off a distance to the end of the mesh.
    chord: f64,
    pub(super) even: Evenness,
    /// What is far from the points, and the middles of these tiles one after the other.
    pub(super) far: (Vec<Empty>, Vec<f64>),
    pub(super) varies: bool,
    /// Largest empty disc that chance leaves, as a radius in spacings.
    largest: f64,
    /// How many points there are.
    pub(super) of: usize,
    /// Spacing of all points beside that of those that are looked at.
    pub(super) finer: f64,
}

impl<'a> Search<'a> {
    pub fn new(
        mesh: &'a Mesh,
        incidence: &'a Incidence,
        feet: &'a Footprints,
        ground: &'a Ground,
        cloud: &'a PointCloud<f64>,
        of: usize,
    ) -> Self {
        let width = mesh.vertices.dimension();
        let count = mesh.complex.triangles.len();
        let on_triangles: Vec<u32> = (0..feet.len() as u32)
            .filter(|&i| (feet.items[i as usize] as usize) < count)
            .collect();
        let spots: Vec<f64> = (on_triangles.iter())
            .flat_map(|&i| feet.place(i as usize).iter().copied())
            .collect();
        let (places, chord) = rim(mesh, incidence);
        let mut search = Self {
            mesh,
            incidence,
            feet,
            ground,
            cloud,
            standing: Standing::new(count, feet),
            on_triangles,
            tree: BallTree::new(width, &spots),
            rim: (!places.is_empty()).then(|| BallTree::new(width, &places)),
            chord,
            even: Evenness::RANDOM,
            far: Default::default(),
            varies: false,
            largest: 0.0,
            of,
            finer: (feet.len() as f64 / of.max(1) as f64).sqrt(),
        };
        search.varies = search.varies();
        search.even = search.evenness();
        if search.points() >= 2 {
            search.far = search.far_tiles();
        }
        if search.even.is_even() {
            search.even = search.even.with_tail(search.tail());
        }
        // one of n discs
        let random = ((search.points().max(2) as f64).ln() / PI).sqrt();
        search.largest = search.even.radius(random);
        search
    }

    /// Median over the vertices of the local spacing of all points, unit of the data.
    pub fn spacing(&self) -> f64 {
        let density = self.ground.density.iter().copied().filter(|&d| d > 0.0);
        let all: Vec<f64> = density.map(|d| self.finer / d.sqrt()).collect();
        median(all)
    }

    /// Radius of the largest empty disc of all points that chance leaves where the spacing is the median.
    pub fn gap(&self) -> f64 {
        self.largest * self.spacing()
    }

    /// The same at a vertex; zero where there are no points.
    pub fn gap_at_vertex(&self, vertex: u32) -> f64 {
        let density = self.ground.density[vertex as usize];
        if density > 0.0 {
            self.largest * self.finer / density.sqrt()
        } else {
            0.0
        }
    }

    /// The largest of the three at the corners of a triangle.
    pub fn gap_at(&self, triangle: u32) -> f64 {
        let corners = self.mesh.complex.triangles[triangle as usize];
        corners
            .map(|v| self.gap_at_vertex(v))
            .into_iter()
            .fold(0.0, f64::max)
    }

    /// Longest part of a curve without a point that chance leaves, for the curve edges without triangles.
    pub fn curve_gap(&self, bare: &[[u32; 2]]) -> f64 {
        let first = self.mesh.complex.triangles.len() as u32;
        let found = self
            .feet
            .items
            .iter()
            .filter(|&&i| i >= first && i < u32::MAX)
            .count() as f64;
        let places = &self.mesh.vertices;
        let length: f64 = bare
            .iter()
            .map(|e| places.squared_distance(e[0] as usize, e[1] as usize).sqrt())
            .sum();
        if found > 0.0 {
            self.finer * self.finer * length / found * (found + 1.0).ln()
        } else {
            0.0
        }
    }

    /// Number of points that stand on triangles.
    pub(super) fn points(&self) -> usize {
        self.on_triangles.len()
    }

    /// The side of the smallest tile of a triangle, as a share of the triangle's.
    pub(super) fn finest(&self) -> f64 {
        (TILES * self.points() as f64).sqrt().recip()
    }

    /// Distance from a place to the nearest point, and to the end of the mesh.
    pub(super) fn distances(&self, place: &[f64]) -> (f64, f64) {
        (self.to_point(place), self.to_end(place))
    }

    /// Visits the places of the points closer to a place than `reach`.
    pub(super) fn within(&self, place: &[f64], reach: f64, mut visit: impl FnMut(&[f64])) {
        self.tree.within(place, reach, |at, _| {
            visit(self.feet.place(self.on_triangles[at as usize] as usize));
        });
    }

    /// Distance from a place to the nearest point.
    pub(super) fn to_point(&self, place: &[f64]) -> f64 {
        let found = self.tree.nearest(place, |_| true);
        found.map_or(f64::INFINITY, |n| n.1.sqrt())
    }

    /// Distance from a place to the end of the mesh.
    pub(super) fn to_end(&self, place: &[f64]) -> f64 {
        let nearest = |tree: &BallTree| tree.nearest(place, |_| true);
        let found = self.rim.as_ref().and_then(nearest);
        found.map_or(f64::INFINITY, |n| (n.1.sqrt() - self.chord).max(0.0))
    }

    /// How even the points are, from the distances of places picked evenly to them.
    fn evenness(&self) -> Evenness {
        let triangles = &self.mesh.complex.triangles;
        let mut sums = Vec::with_capacity(triangles.len());
        let mut sum = 0.0;
        for t in 0..triangles.len() as u32 {
            sum += self.ground.expected(self.mesh, t);
            sums.push(sum);
        }
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let mut measures = Vec::new();
        for k in 0..READ {
            let at = (k as f64 + 0.5) / READ as f64 * sum;
            let t = sums.partition_point(|&s| s < at).min(triangles.len() - 1);
            // two shares that fill the unit square evenly (Roberts' sequence), folded into a triangle
            let (mut a, mut b) = (
                (k as f64 * 0.754_877_666_246_692_8).fract(),
                (k as f64 * 0.569_840_290_998_053_2).fract(),
            );
            if a + b > 1.0 {
                (a, b) = (1.0 - a, 1.0 - b);
            }
            let weights = [1.0 - a - b, a, b];
            let sides = corners(self.mesh, t as u32);
            for (k, x) in place.iter_mut().enumerate() {
                *x = weights[0] * sides[0][k] + weights[1] * sides[1][k] + weights[2] * sides[2][k];
            }
            let density = self.ground.density_at(triangles[t], weights);
            let (away, end) = self.distances(&place);
            if density > 0.0 && end > away {
                measures.push(PI * density * away * away);
            }
        }
        Evenness::of(
            measures,
            self.points(),
            Evenness::clustering(self.nearest()),
        )
    }

    /// Squared distances of some of the points to their nearest one, as a share of those to another of their neighbors: a
    /// density that is wrong does not matter to them.
    fn nearest(&self) -> Vec<f64> {
        let triangles = &self.mesh.complex.triangles;
        let inside = |&k: &usize| {
            (self.feet.items[k] as usize) < triangles.len() && !self.feet.on_boundary[k]
        };
        let (mut all, mut squares) = (Vec::new(), Vec::new());
        let step = self.points().div_ceil(READ).max(1);
        for foot in (0..self.feet.len()).filter(inside).step_by(step) {
            let corners = triangles[self.feet.items[foot] as usize];
            let reach = NEIGHBORHOOD / self.ground.density_at(corners, [1.0 / 3.0; 3]).sqrt();
            squares.clear();
            self.tree.within(self.feet.place(foot), reach, |_, square| {
                if square > 0.0 {
                    squares.push(square);
                }
            });
            squares.sort_unstable_by(f64::total_cmp);
            all.extend(squares.get(NEIGHBOR - 1).map(|far| squares[0] / far));
        }
        all
    }

    /// Whether the density varies over the mesh.
    fn varies(&self) -> bool {
        let density = self.ground.density.iter().copied().filter(|&d| d > 0.0);
        let mut all: Vec<f64> = density.map(|d| 1.0 / d.sqrt()).collect();
        all.sort_unstable_by(f64::total_cmp);
        quantile(&all, 0.9) > VARIES * quantile(&all, 0.1)
    }
}

/// Places along the edges that end the mesh, and the chord that is allowed there.
fn rim(mesh: &Mesh, incidence: &Incidence) -> (Vec<f64>, f64) {
    let (mut places, mut lengths) = (Vec::new(), Vec::new());
    for (e, ends) in incidence.edges.iter().enumerate() {
        if incidence.at_edge(e).len() != 1 {
            continue;
        }
        let [a, b] = ends.map(|v| mesh.vertices.point(v as usize));
        lengths.push(squared_distance(a, b).sqrt());
        for k in 0..8 {
            let share = (f64::from(k) + 0.5) / 8.0;
            places.extend(a.iter().zip(b).map(|(x, y)| x + share * (y - x)));
        }
    }
    (places, CHORD * median(lengths))
}
