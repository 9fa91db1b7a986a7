//! How far a mesh and the surface are from each other.

use crosscap::prelude::*;
use crosscap_algorithms::surfaces::{Drawing, Feature, FeatureCloud, Spot};
use crosscap_core::squared_distance;
use std::fmt;

/// Places of the surface that a mesh is compared with, at most, and how many for every point of the cloud.
const PLACES: usize = 12_000;
const FINER: usize = 6;
/// Radius of the largest empty disc among that many places, in their spacings: sqrt(log n / pi).
const EMPTY: f64 = 1.75;
/// Radius of the largest empty half of a disc at the rim of a random sample of some thousand points, in spacings where they
/// are thinnest: sqrt(2 log n / pi).
const RIM: f64 = 2.3;
/// Distance from which on a mesh is wrong, in dl: what its edges cut off a bend is less.
const TOO_FAR: f64 = 0.75;
/// Standard deviations of the noise that are added.
const SCATTER: f64 = 4.0;

/// The largest distances both ways, in landmark separations: where all lengths are in the spacing of the points, in that of the
/// nearest point.
pub struct Distance {
    /// From the mesh to the surface, in dl.
    out: f64,
    /// From the surface to the mesh, in dl.
    back: f64,
    /// The most that is allowed each way, in dl: the places of the surface are some way apart.
    allowed: [f64; 2],
    /// What is allowed beyond that where a surface ends, in dl.
    rim: f64,
}

impl Distance {
    pub fn is_near(&self) -> bool {
        self.is_within(self.rim)
    }

    /// The same without what chance leaves empty where a surface ends.
    pub fn is_near_at_ends(&self) -> bool {
        self.is_within(0.0)
    }

    fn is_within(&self, beyond: f64) -> bool {
        self.out <= self.allowed[0] + beyond && self.back <= self.allowed[1] + beyond
    }
}

impl fmt::Display for Distance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [out, back] = self.allowed;
        write!(
            f,
            "off {:.2} (of {out:.2}) and {:.2} dl (of {back:.2}; {:.2} more at ends)",
            self.out, self.back, self.rim
        )
    }
}

/// The largest distances both ways between a mesh and the surface its points were drawn from.
pub fn distance(
    feature: &Feature,
    cloud: &FeatureCloud,
    drawing: &Drawing,
    outcome: &Outcome,
) -> Result<Distance, Error> {
    let count = (FINER * cloud.points.len()).min(PLACES);
    let places = feature.places(cloud.size, count, drawing.seed)?;
    let dl = outcome.report.parameters.dl;
    let mesh = &outcome.mesh;
    let row = |v: u32| -> Spot { std::array::from_fn(|k| mesh.vertices.point(v as usize)[k]) };
    let mut faces: Vec<[Spot; 3]> = mesh.complex.triangles.iter().map(|t| t.map(row)).collect();
    faces.extend(mesh.complex.curve_edges.iter().map(|e| {
        let [a, b] = e.ends.map(row);
        [a, b, b]
    }));
    let scale = (outcome.report.parameters.spaces.metric).separation_scale(&cloud.points)?;
    // what stands for dl about a place, as a share of it
    let own = |place: &Spot| match &scale {
        None => 1.0,
        Some(scale) => {
            let near = cloud.points.iter().map(|p| squared_distance(p, place));
            let nearest = near.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            nearest.map_or(1.0, |(row, _)| scale[row])
        }
    };
    let out = faces.iter().flat_map(samples).map(|place| {
        let near = places.iter().map(|p| squared_distance(p, &place));
        near.fold(f64::INFINITY, f64::min).sqrt() / own(&place)
    });
    let back = places.iter().map(|p| {
        let near = faces.iter().map(|t| to_triangle(*p, *t));
        near.fold(f64::INFINITY, f64::min).sqrt() / own(p)
    });
    let (out, back) = (out.fold(0.0, f64::max), back.fold(0.0, f64::max));
    let apart = EMPTY * cloud.spacing * (drawing.count as f64 / count as f64).sqrt();
    let usual = TOO_FAR + SCATTER * drawing.noise * cloud.spacing / dl;
    // no method can tell better where a surface ends
    let ends = mesh.complex.curve_edges.iter().any(|e| e.cells == 1);
    let rim = if ends { RIM * cloud.thinnest / dl } else { 0.0 };
    Ok(Distance {
        out: out / dl,
        back: back / dl,
        allowed: [usual.hypot(apart / dl), usual],
        rim,
    })
}

/// Corners, middles of the sides and the middle of a triangle.
fn samples(corners: &[Spot; 3]) -> [Spot; 7] {
    let [a, b, c] = *corners;
    let mean = |of: &[Spot]| -> Spot {
        std::array::from_fn(|k| of.iter().map(|p| p[k]).sum::<f64>() / of.len() as f64)
    };
    [
        a,
        b,
        c,
        mean(&[a, b]),
        mean(&[b, c]),
        mean(&[a, c]),
        mean(corners),
    ]
}

/// Squared distance of a place to a triangle: the nearest of its three sides, or its inside.
fn to_triangle(p: Spot, [a, b, c]: [Spot; 3]) -> f64 {
    let minus = |x: Spot, y: Spot| -> Spot { std::array::from_fn(|k| x[k] - y[k]) };
    let dot = |x: Spot, y: Spot| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    let (u, v, w) = (minus(b, a), minus(c, a), minus(p, a));
    let (uu, uv, vv, wu, wv) = (dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v));
    let area = uu * vv - uv * uv;
    let (s, t) = (vv * wu - uv * wv, uu * wv - uv * wu);
    if area > 1e-14 * uu * vv && s >= 0.0 && t >= 0.0 && s + t <= area {
        let foot: Spot = std::array::from_fn(|k| w[k] - (s * u[k] + t * v[k]) / area);
        return dot(foot, foot);
    }
    let side = |x: Spot, y: Spot| {
        let (along, from) = (minus(y, x), minus(p, x));
        let length = dot(along, along);
        let share = if length > 0.0 {
            (dot(from, along) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let foot: Spot = std::array::from_fn(|k| from[k] - share * along[k]);
        dot(foot, foot)
    };
    side(a, b).min(side(b, c)).min(side(c, a))
}
