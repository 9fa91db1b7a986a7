//! The density about an empty region where it varies.
//!
//! About the region the density is taken for exp(a + g . x), x in the plane of a triangle in its middle, and fitted to the
//! points around by local likelihood (Loader, Local likelihood density estimation, Annals of Statistics 24, 1996). The
//! mean of the points around is more than the density in their middle, the more the steeper it is; a fit of the slope is not.

use super::search::Search;
use super::tiles::{Cut, Shape, TILE};
use crate::balls::BallTree;
use crate::certificate::geometry::corners;
use crate::orthogonal::unit_across;

/// Points around a region that its density is fitted to, the nearest ones: more are where the slope is another.
const NEAREST: usize = 64;
/// Rounds in which the points are looked for, each as much farther than the one before.
const ROUNDS: usize = 24;
const FARTHER: f64 = 1.3;
/// Newton steps of the fit, and the steepest slope: the logarithm of the density at the farthest point and in the middle.
const STEPS: usize = 20;
const STEEPEST: f64 = 4.0;

/// An empty region: discs about places.
pub(super) struct Hole<'a> {
    /// The places.
    pub tree: &'a BallTree,
    /// Triangles of the places.
    pub triangles: &'a [u32],
    /// Radius of the largest disc.
    pub reach: f64,
    /// Spacing of the points, about.
    pub spacing: f64,
    /// Whether a place is in one of the discs.
    pub inside: &'a dyn Fn(&[f64]) -> bool,
}

/// What is expected in a region.
pub(super) struct Expected {
    /// Number of points.
    pub points: f64,
    /// The same for a unit of area.
    pub density: f64,
    /// How many points would give as sure a density, if it did not vary.
    pub counted: f64,
}

impl Expected {
    /// Where too little is around to expect anything.
    pub fn nothing(spacing: f64) -> Self {
        Self {
            points: 0.0,
            density: 1.0 / (spacing * spacing),
            counted: 0.0,
        }
    }
}

/// Parts of the mesh in the plane, with their areas, and the points around.
#[derive(Default)]
struct Flat {
    empty: Vec<([f64; 2], f64)>,
    around: Vec<([f64; 2], f64)>,
    points: Vec<[f64; 2]>,
}

impl Search<'_> {
    /// The points that are expected in a hole, from the nearest ones around it; none where there are too few.
    pub(super) fn expected_in(&self, hole: &Hole<'_>) -> Option<Expected> {
        let (region, feet, reach) = self.nearest_around(hole)?;
        let plane = Plane::of(corners(self.mesh, *hole.triangles.first()?), reach)?;
        let mut flat = Flat {
            points: feet.iter().map(|&k| plane.at(self.feet.place(k))).collect(),
            ..Flat::default()
        };
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let finest = self.finest();
        for t in region {
            let shape = Shape::new(corners(self.mesh, t));
            shape.cut(&mut place, &mut |tile, place| {
                let scale = tile.scale();
                if scale > finest && shape.longest * scale > TILE * hole.spacing {
                    return Cut::Further;
                }
                let part = (
                    plane.at(place),
                    self.ground.areas[t as usize] * scale * scale,
                );
                if (hole.inside)(place) {
                    flat.empty.push(part);
                } else if hole.tree.any_within(place, reach, |_, _| true) {
                    flat.around.push(part);
                }
                Cut::Leave
            });
        }
        flat.expected()
    }

    /// Triangles about a hole, the nearest points around it and how far they are.
    fn nearest_around(&self, hole: &Hole<'_>) -> Option<(Vec<u32>, Vec<usize>, f64)> {
        let mut reach = hole.reach + hole.spacing;
        let mut middle = vec![0.0; self.mesh.vertices.dimension()];
        let mut found: Vec<(f64, usize)> = Vec::new();
        let mut region = Vec::new();
        for _ in 0..ROUNDS {
            region = self.grown(hole.triangles, |t| {
                let shape = Shape::new(corners(self.mesh, t));
                shape.place([1.0 / 3.0; 3], &mut middle);
                (hole.tree).any_within(&middle, reach + shape.radius, |_, _| true)
            });
            found.clear();
            for &t in &region {
                for &k in self.standing.on(t) {
                    let place = self.feet.place(k as usize);
                    let away = hole.tree.nearest(place, |_| true)?.1.sqrt();
                    if away <= reach && !self.feet.on_boundary[k as usize] && !(hole.inside)(place)
                    {
                        found.push((away, k as usize));
                    }
                }
            }
            if found.len() > NEAREST || region.len() == self.mesh.complex.triangles.len() {
                break;
            }
            reach *= FARTHER;
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some(last) = found.get(NEAREST) {
            reach = last.0;
            found.truncate(NEAREST);
        }
        let feet = found.into_iter().map(|f| f.1).collect();
        Some((region, feet, reach))
    }
}

/// The plane of a triangle, in units of a length.
struct Plane {
    origin: Vec<f64>,
    /// Both directions, one after the other.
    axes: Vec<f64>,
}

impl Plane {
    /// `None` for a triangle whose corners are on a line.
    fn of([a, b, c]: [&[f64]; 3], unit: f64) -> Option<Self> {
        let width = a.len();
        let from = a.iter().cycle();
        let mut axes: Vec<f64> = (b.iter().chain(c)).zip(from).map(|(x, a)| x - a).collect();
        let mut is_across = |k| unit_across(&mut axes, width, k, 1, 1e-18);
        if !(is_across(0) && is_across(1)) {
            return None;
        }
        axes.iter_mut().for_each(|x| *x /= unit);
        Some(Self {
            origin: a.to_vec(),
            axes,
        })
    }

    fn at(&self, place: &[f64]) -> [f64; 2] {
        let (first, second) = self.axes.split_at(self.origin.len());
        let mut found = [0.0; 2];
        for (k, (x, o)) in place.iter().zip(&self.origin).enumerate() {
            found[0] += (x - o) * first[k];
            found[1] += (x - o) * second[k];
        }
        found
    }
}

/// Areas weighted by the density: all of it, its mean place, and its spread.
struct Weighted {
    area: f64,
    mean: [f64; 2],
    spread: [f64; 3],
}

fn weighted(parts: &[([f64; 2], f64)], slope: [f64; 2]) -> Weighted {
    let (mut area, mut mean, mut spread) = (0.0, [0.0; 2], [0.0; 3]);
    for &([x, y], part) in parts {
        let w = part * (slope[0] * x + slope[1] * y).exp();
        area += w;
        mean[0] += w * x;
        mean[1] += w * y;
        spread[0] += w * x * x;
        spread[1] += w * x * y;
        spread[2] += w * y * y;
    }
    let mean = mean.map(|m| m / area);
    let [a, b, c] = spread.map(|s| s / area);
    Weighted {
        area,
        mean,
        spread: [
            a - mean[0] * mean[0],
            b - mean[0] * mean[1],
            c - mean[1] * mean[1],
        ],
    }
}

/// The solution of a positive matrix [a, b; b, c].
fn solved([a, b, c]: [f64; 3], [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let determinant = a * c - b * b;
    (determinant > 1e-9 * (a + c) * (a + c))
        .then(|| [(c * x - b * y) / determinant, (a * y - b * x) / determinant])
}

impl Flat {
    /// The fit by Newton's method; its logarithm is concave.
    fn expected(&self) -> Option<Expected> {
        let count = self.points.len() as f64;
        if self.points.is_empty() || self.empty.is_empty() || self.around.is_empty() {
            return None;
        }
        let mean: [f64; 2] =
            std::array::from_fn(|k| self.points.iter().map(|p| p[k]).sum::<f64>() / count);
        let mut slope = [0.0; 2];
        let mut around = weighted(&self.around, slope);
        for _ in 0..STEPS {
            let off = [mean[0] - around.mean[0], mean[1] - around.mean[1]];
            let step = solved(around.spread, off)?;
            let size = step[0].hypot(step[1]);
            let short = 1.0 / size.max(1.0);
            slope = [slope[0] + short * step[0], slope[1] + short * step[1]];
            let steep = (STEEPEST / slope[0].hypot(slope[1])).min(1.0);
            slope = slope.map(|s| s * steep);
            around = weighted(&self.around, slope);
            if size < 1e-6 {
                break;
            }
        }
        let empty = weighted(&self.empty, slope);
        let off = [
            empty.mean[0] - around.mean[0],
            empty.mean[1] - around.mean[1],
        ];
        let [x, y] = solved(around.spread, off)?;
        let points = count * empty.area / around.area;
        let area: f64 = self.empty.iter().map(|part| part.1).sum();
        Some(Expected {
            points,
            density: points / area,
            // variance of the logarithm: that of the mean, and that of the slope times the way from it
            counted: count / (1.0 + off[0] * x + off[1] * y),
        })
    }
}
