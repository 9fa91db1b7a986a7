//! Spheres, tori and necks: with holes, close to each other, thin.

use super::feature::{Feature, Spot, direction};
use crate::surfaces::Random;
use std::f64::consts::{PI, TAU};

/// Radius of the tube of the torus with a hole; its middle circle has radius 1.
const TUBE: f64 = 0.4;

pub(super) const ALL: &[Feature] = &[
    Feature {
        name: "sphere-hole",
        betti: [1, 0, 0],
        most: 1.6,
        area: |_| 4.0 * PI,
        place: |r, f| {
            Some(direction(r)).filter(|p| p[2] < 0.0 || libm::hypot(p[0], p[1]) > f / 2.0)
        },
        spots: |_| vec![[0.0, 0.0, 1.0]],
        curve: None,
    },
    Feature {
        name: "torus-hole",
        betti: [1, 2, 0],
        most: 0.7,
        area: |_| TUBE * TAU * TAU,
        place: |r, f| {
            let p = torus(r, TUBE);
            let away = (p[0] - 1.0 - TUBE).powi(2) + p[1] * p[1] + p[2] * p[2];
            Some(p).filter(|_| away > f * f / 4.0)
        },
        spots: |_| vec![[1.0 + TUBE, 0.0, 0.0]],
        curve: None,
    },
    Feature {
        name: "concentric",
        betti: [2, 0, 2],
        most: 1.0,
        area: |f| 4.0 * PI * (1.0 + (1.0 + f) * (1.0 + f)),
        place: |r, f| {
            let outer = (1.0 + f) * (1.0 + f);
            let far = r.uniform() * (1.0 + outer) < outer;
            let radius = if far { 1.0 + f } else { 1.0 };
            Some(direction(r).map(|x| radius * x))
        },
        spots: |_| everywhere(),
        curve: None,
    },
    Feature {
        // how deep they go into each other
        name: "crossing-spheres",
        betti: [1, 0, 3],
        most: 1.0,
        area: |_| 8.0 * PI,
        place: |r, f| Some(on_two_spheres(r, 1.0 - f / 2.0)),
        spots: |_| vec![[0.0; 3]],
        curve: None,
    },
    Feature {
        name: "near-spheres",
        betti: [2, 0, 2],
        most: 1.0,
        area: |_| 8.0 * PI,
        place: |r, f| Some(on_two_spheres(r, 1.0 + f / 2.0)),
        spots: |_| vec![[0.0; 3]],
        curve: None,
    },
    Feature {
        // r^2 = cos^2 + (f / 2)^2 over the direction: the width of the waist
        name: "neck",
        betti: [1, 0, 1],
        most: 1.2,
        // fitted to the integral, within 2 percent
        area: |f| 2.0 * PI + f * f * (1.6 + 0.6 * f),
        place: |r, f| {
            let d = direction(r);
            let radius = (d[2] * d[2] + f * f / 4.0).sqrt();
            let slope = d[2] * libm::hypot(d[0], d[1]) / radius;
            // r sqrt(r^2 + slope^2) is at most this
            let most = (1.0 + f * f / 4.0) * 1.2;
            let kept = r.uniform() * most < radius * libm::hypot(radius, slope);
            Some(d.map(|x| radius * x)).filter(|_| kept)
        },
        spots: |f| {
            vec![
                [f / 2.0, 0.0, 0.0],
                [-f / 2.0, 0.0, 0.0],
                [0.0, f / 2.0, 0.0],
            ]
        },
        curve: None,
    },
    Feature {
        // width of the tube
        name: "thin-torus",
        betti: [1, 2, 1],
        most: 1.2,
        area: |f| 0.5 * TAU * TAU * f,
        place: |r, f| Some(torus(r, f / 2.0)),
        spots: |_| {
            [0.0, 1.0, 2.0, 3.0]
                .map(|k| swap(k * PI / 2.0))
                .map(|[s, c]| [c, s, 0.0])
                .to_vec()
        },
        curve: None,
    },
    Feature {
        // width of the small sphere beside the large one
        name: "small-part",
        betti: [2, 0, 2],
        most: 2.0,
        area: |f| 4.0 * PI * (1.0 + f * f / 4.0),
        place: |r, f| {
            let small = f / 2.0;
            let large = r.uniform() * (1.0 + small * small) < 1.0;
            let d = direction(r);
            Some(if large {
                d
            } else {
                [2.0 + small * (1.0 + d[0]), small * d[1], small * d[2]]
            })
        },
        spots: |f| vec![[2.0 + f / 2.0, 0.0, 0.0]],
        curve: None,
    },
    Feature {
        // distance of the rim of the disc from the sphere
        name: "disc-in-sphere",
        betti: [2, 0, 1],
        most: 0.6,
        area: |f| PI * (4.0 + (1.0 - f) * (1.0 - f)),
        place: |r, f| {
            let radius = 1.0 - f;
            if r.uniform() * (4.0 + radius * radius) < 4.0 {
                return Some(direction(r));
            }
            let (ring, [sin, cos]) = (radius * r.uniform().sqrt(), swap(r.between(0.0, TAU)));
            Some([ring * cos, ring * sin, 0.0])
        },
        spots: |_| {
            [0.0, 1.0, 2.0, 3.0]
                .map(|k| swap(k * PI / 2.0))
                .map(|[s, c]| [c, s, 0.0])
                .to_vec()
        },
        curve: None,
    },
];

/// Sine and cosine.
pub(super) fn swap(angle: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle);
    [sin, cos]
}

/// A random place of two unit spheres whose centers are `away` from the origin, on either side of it.
fn on_two_spheres(r: &mut Random, away: f64) -> Spot {
    let side = if r.uniform() < 0.5 { 1.0 } else { -1.0 };
    let [x, y, z] = direction(r);
    [x + side * away, y, z]
}

/// A random place of the torus with middle circle of radius 1.
fn torus(r: &mut Random, tube: f64) -> Spot {
    loop {
        let ([sin, cos], [up, out]) = (swap(r.between(0.0, TAU)), swap(r.between(0.0, TAU)));
        let ring = 1.0 + tube * out;
        if r.uniform() * (1.0 + tube) < ring {
            return [ring * cos, ring * sin, tube * up];
        }
    }
}

/// Corners of a cube on the unit sphere, and the middles of its faces.
fn everywhere() -> Vec<Spot> {
    let mut spots = Vec::new();
    for k in 0..27 {
        let p: Spot = [k % 3, k / 3 % 3, k / 9].map(|x| f64::from(x) - 1.0);
        let size = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        if size > 0.0 {
            spots.push(p.map(|x| x / size));
        }
    }
    spots
}
