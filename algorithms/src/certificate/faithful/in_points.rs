//! The empty disc about a place as the points show it, whatever the mesh.
//!
//! A mesh of few triangles is a polyhedron: points are squeezed together where they are put down on it, most of all at its edges, and a
//! hole is narrower on it than it is. So the disc is measured once more on a quadratic patch through the points themselves, with their
//! density around. The distances are straight ones: of a sphere the area within a distance r is pi r^2 exactly, and of another surface
//! with curvatures k1 and k2 it is larger by (r (k1 - k2))^2 / 32 of that, up to terms of the fourth order.

use super::ground::COUNTED;
use super::patch::Patch;
use super::search::Search;
use super::slope::Expected;
use super::tiles::Shape;
use crate::certificate::distance::point_triangle;
use crate::certificate::geometry::corners;
use crosscap_core::squared_distance;
use std::f64::consts::PI;

/// Points that the density is counted from at most: the more, the less it errs, and one that does not vary is the same farther
/// off.
const WANTED: f64 = 3.0 * COUNTED;
/// Points that the patch is fitted to are nearer than so many radii of the disc.
const PATCH: f64 = 2.2;
/// Scatter of the points about the patch, in radii of the disc, above which it is none.
const SCATTER: f64 = 0.25;
/// The same of all that are counted about a patch of their own, in radii of what is counted. A sphere counted up to its radius
/// scatters by 0.01, two half planes at 30 degrees by 0.02, at 60 by 0.045. Beyond a crease a ball holds more of the surface than a disc does: on prisms of
/// 45 and 60 degrees gaps that chance leaves with p = 0.2 had 1e-3 before this was asked.
const SMOOTH: f64 = 0.03;
/// Radius of what is counted times how much the patch bends, at most: on a sphere it is then no more than that of the sphere, and the area
/// of a saddle is larger by an eighth than that of a disc.
const BENT: f64 = 1.4;
/// The middle is looked for so far about the place, in radii of the disc, in steps of a third of that, and again about what was found.
const ABOUT: f64 = 0.6;
const STEPS: i32 = 3;
const ROUNDS: usize = 3;

/// An empty disc of the points.
pub(super) struct PointDisc {
    /// Its radius, unit of the data.
    pub radius: f64,
    /// What is expected in it.
    pub expected: Expected,
}

impl Search<'_> {
    /// The empty disc of the points about a place of a triangle, where that of the mesh has the radius `away`; none where the
    /// surface ends or meets another one nearby, bends too much for it, or has too few points.
    pub(super) fn disc_in_points(
        &self,
        triangle: u32,
        place: &[f64],
        away: f64,
        spacing: f64,
    ) -> Option<PointDisc> {
        let counted = (away * away + WANTED / PI * spacing * spacing).sqrt();
        let reach = (counted + spacing).min(self.to_curve(place));
        let rows = self.around_place(triangle, place, reach);
        let near = |square: f64, radius: f64| square < radius * radius;
        let beside: Vec<&[f64]> = (rows.iter().copied())
            .filter(|row| near(squared_distance(row, place), PATCH * away))
            .collect();
        let mut patch = Patch::default();
        if !patch.fit(place, beside.iter().copied()) || patch.scatter > SCATTER * away {
            return None;
        }
        let (middle, square) = emptiest(&patch, place, &rows, away);
        let noise = patch.scatter * patch.scatter;
        let shift = squared_distance(&middle, place).sqrt();
        let farthest = (reach - shift).min(BENT / patch.bend());
        let (points, outer) = counted_about(&mut patch, &middle, &rows, farthest)?;
        // what noise across the surface adds to a square
        let inner = square - noise;
        let area = |square: f64| PI * square * (1.0 + square * patch.twist() / 32.0);
        let ring = area(outer) - area(square);
        (points >= COUNTED && inner > 0.0 && ring > 0.0).then(|| {
            let density = points / ring;
            PointDisc {
                radius: inner.sqrt(),
                expected: Expected {
                    points: area(inner) * density,
                    density,
                    counted: points,
                },
            }
        })
    }

    /// Distance from a place to the nearest edge that has not two triangles.
    fn to_curve(&self, place: &[f64]) -> f64 {
        let edges = self.mesh.complex.curve_edges.iter();
        let away = edges.filter(|edge| edge.cells > 0).map(|edge| {
            let [a, b] = edge.ends.map(|v| self.mesh.vertices.point(v as usize));
            point_triangle(place, a, b, b)
        });
        away.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The points nearer to a place than `reach` that stand on triangles connected with its own.
    fn around_place(&self, triangle: u32, place: &[f64], reach: f64) -> Vec<&[f64]> {
        let mut middle = vec![0.0; place.len()];
        let region = self.grown(&[triangle], |t| {
            let shape = Shape::new(corners(self.mesh, t));
            shape.place([1.0 / 3.0; 3], &mut middle);
            squared_distance(&middle, place).sqrt() < reach + shape.radius
        });
        let on = region.iter().flat_map(|&t| self.standing.on(t));
        on.map(|&k| self.cloud.point(self.feet.rows[k as usize] as usize))
            .filter(|row| squared_distance(row, place) < reach * reach)
            .collect()
    }
}

/// How many points the density about a place is counted from, and the square of how far they reach; the patch is that of all of
/// them, none where these are on no smooth one.
fn counted_about(
    patch: &mut Patch,
    middle: &[f64],
    rows: &[&[f64]],
    farthest: f64,
) -> Option<(f64, f64)> {
    let mut counted: Vec<(f64, &[f64])> = (rows.iter())
        .map(|row| (squared_distance(row, middle), *row))
        .filter(|about| about.0 < farthest * farthest)
        .collect();
    counted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let beyond = counted.get(WANTED as usize).map(|about| about.0);
    counted.truncate(WANTED as usize);
    let outer = beyond.unwrap_or(farthest * farthest);
    let smooth = patch.fit(middle, counted.iter().map(|about| about.1))
        && patch.scatter <= SMOOTH * outer.sqrt();
    smooth.then_some((counted.len() as f64, outer))
}

/// The place of the patch that is farthest from the points, and the square of how far.
fn emptiest(patch: &Patch, origin: &[f64], rows: &[&[f64]], away: f64) -> (Vec<f64>, f64) {
    let at = |flat: [f64; 2]| -> (Vec<f64>, f64) {
        let offset = patch.place(flat);
        let place: Vec<f64> = origin.iter().zip(offset).map(|(o, x)| o + x).collect();
        let squares = rows.iter().map(|row| squared_distance(row, &place));
        let least = squares.fold(f64::INFINITY, f64::min);
        (place, least)
    };
    let mut flat = [0.0; 2];
    let mut best = at(flat);
    let mut width = ABOUT * away;
    for _ in 0..ROUNDS {
        let about = flat;
        let step = width / f64::from(STEPS);
        for i in -STEPS..=STEPS {
            for j in -STEPS..=STEPS {
                let next = [
                    about[0] + step * f64::from(i),
                    about[1] + step * f64::from(j),
                ];
                let found = at(next);
                if found.1 > best.1 {
                    (best, flat) = (found, next);
                }
            }
        }
        width = step;
    }
    best
}
