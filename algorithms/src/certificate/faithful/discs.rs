//! The largest empty disc, and the places of the mesh that are far from the points.

use super::chance::{self, LEVELS};
use super::evenness::Evenness;
use super::ground::COUNTED;
use super::nearby::{Nearby, SPARE};
use super::search::Search;
use super::slope::{Expected, Hole};
use super::tiles::{Cut, Empty, Shape, TILE};
use crate::balls::BallTree;
use crate::certificate::geometry::corners;
use crosscap_core::squared_distance;
use serde::Serialize;
use std::f64::consts::PI;

/// Points above which the slits of less than two spacings are not looked for: they cannot be told from
/// chance there, and their places are many.
const MANY: usize = 20_000;
/// Least radius of a level where there are many points, in spacings.
const WIDE_LEVEL: f64 = 1.0;
/// The same where their density varies, and for even points, where small differences in density make all triangles of
/// a region gaps.
const CLEAR_LEVEL: f64 = 1.3;
/// An empty region of the points that the mesh covers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Gap {
    /// Diameter of its largest empty disc, in local spacings.
    pub width: f64,
    /// The same, unit of the data.
    pub size: f64,
    /// Number of points expected in it, at the density around.
    pub expected: f64,
    /// Probability that chance leaves such a gap anywhere in a sample like this one; with others, so many gaps of this
    /// size and larger.
    pub p: f64,
    /// Number of gaps that `p` is about: one, or several that are no chance together.
    pub together: usize,
    /// Triangle of its middle.
    pub triangle: u32,
    /// Its middle.
    pub place: Vec<f64>,
    /// Places deep inside of it, one after the other: the middle of a disc, the line amid a slit; none at a rim.
    #[serde(skip)]
    pub inner: Vec<f64>,
    /// The least distance of these to the points and to the end of the mesh, unit of the data.
    #[serde(skip)]
    pub depth: f64,
}

impl Search<'_> {
    /// Radius of the level from which on chains are looked for.
    pub(super) fn least_level(&self) -> f64 {
        if self.varies || self.even.is_even() {
            CLEAR_LEVEL
        } else if self.points() > MANY {
            WIDE_LEVEL
        } else {
            LEVELS[0].radius
        }
    }

    /// Tiles further from the points than the least level asks, with their middles one after the other.
    pub(super) fn far_tiles(&self) -> (Vec<Empty>, Vec<f64>) {
        let least = self.even.radius(self.least_level());
        let finest = self.finest();
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let (mut tiles, mut middles) = (Vec::new(), Vec::new());
        let mut nearby = Nearby::default();
        for (t, &corner) in self.mesh.complex.triangles.iter().enumerate() {
            let shape = Shape::new(corners(self.mesh, t as u32));
            let most = corner.map(|v| self.ground.density[v as usize]);
            let most = most.into_iter().fold(0.0, f64::max).sqrt();
            if !(most > 0.0 && shape.longest > 0.0) {
                continue;
            }
            // A point that covers a tile is closer to it than this.
            let reach = least / most;
            shape.place([1.0 / 3.0; 3], &mut place);
            nearby.begin();
            let about = (shape.radius + reach) * SPARE;
            self.within(&place, about, |point| nearby.add(point));
            let may_end = self.to_end(&place) < shape.radius + reach;
            shape.cut(&mut place, &mut |tile, place| {
                let (scale, weights) = (tile.scale(), tile.middle());
                let radius = shape.radius * scale;
                let covered = |away: f64| (away + radius) * most < least;
                let near = nearby.look(tile.depth(), place, reach + radius);
                if covered(near) || may_end && covered(self.to_end(place)) {
                    return Cut::Leave;
                }
                let density = self.ground.density_at(corner, weights);
                if scale > finest && shape.longest * scale * density.sqrt() > TILE {
                    return Cut::Further;
                }
                let away = if near.is_finite() {
                    near
                } else {
                    self.to_point(place)
                };
                let away = away.min(self.to_end(place));
                if away * density.sqrt() >= least {
                    tiles.push(Empty {
                        triangle: t as u32,
                        weights,
                        away: away * density.sqrt(),
                        measure: self.ground.areas[t] * scale * scale * density,
                    });
                    middles.extend_from_slice(place);
                }
                Cut::Leave
            });
        }
        (tiles, middles)
    }

    /// The empty disc about tile `k` as a gap whose probability is left to the caller, and its measure at a known density.
    pub(super) fn disc(&self, tiles: &[Empty], middles: &[f64], k: usize) -> (Gap, f64) {
        let width = self.mesh.vertices.dimension();
        let (tile, place) = (&tiles[k], &middles[k * width..(k + 1) * width]);
        let (away, end) = self.distances(place);
        let away = away.min(end);
        let inside = |p: &[f64]| squared_distance(p, place) < away * away;
        let found = self.expected_about(tile.triangle, place, away, away / tile.away, &inside);
        let measure =
            |found: &Expected| chance::known(self.even.random(found.points), found.counted);
        let on_mesh = (measure(&found), away, found);
        // How even a sample is was read off the distances on the mesh: what is farther in the points is no rarer for it.
        let in_points = (!self.varies && self.even == Evenness::RANDOM)
            .then(|| self.disc_in_points(tile.triangle, place, away, away / tile.away))
            .flatten()
            .map(|disc| (measure(&disc.expected), disc.radius, disc.expected));
        let (measure, radius, found) = match in_points {
            Some(other) if other.0 > on_mesh.0 => other,
            _ => on_mesh,
        };
        let gap = Gap {
            width: 2.0 * radius * found.density.sqrt(),
            size: 2.0 * radius,
            expected: found.points,
            p: 1.0,
            together: 1,
            triangle: tile.triangle,
            place: place.to_vec(),
            inner: place.to_vec(),
            depth: away,
        };
        (gap, measure)
    }

    /// What is expected in the disc of radius `away` about a place.
    fn expected_about(
        &self,
        triangle: u32,
        place: &[f64],
        away: f64,
        spacing: f64,
        inside: &dyn Fn(&[f64]) -> bool,
    ) -> Expected {
        if self.varies {
            let hole = Hole {
                tree: &BallTree::new(place.len(), place),
                triangles: &[triangle],
                reach: away,
                spacing,
                inside,
            };
            return self
                .expected_in(&hole)
                .unwrap_or(Expected::nothing(spacing));
        }
        // the density around, without the disc itself
        let around = self.around(&[triangle], COUNTED, |p| !inside(p));
        let density = around.density();
        Expected {
            points: PI * away * away * density,
            density,
            counted: around.points,
        }
    }
}
