//! Flat surfaces with holes, slits and cuts.

use super::feature::{Feature, Spot};
use super::solids::swap;
use crate::surfaces::Random;
use std::f64::consts::{PI, TAU};

/// Half the length of a slit.
const SLIT: f64 = 0.4;
/// Radius of the circle that a bent slit follows.
const BEND: f64 = 0.5;
/// Distance of the holes of a disc from its middle.
const HOLES: f64 = 0.55;
/// Half the width of the second of two crossing squares, and how far it stands above the first.
const STANDING: [f64; 2] = [0.6, 0.8];

pub(super) const ALL: &[Feature] = &[
    Feature {
        name: "plate-hole",
        betti: [1, 1, 0],
        most: 1.6,
        area: |f| 4.0 - PI * f * f / 4.0,
        place: |r, f| Some(square(r)).filter(|p| libm::hypot(p[0], p[1]) > f / 2.0),
        spots: |_| vec![[0.0; 3]],
        curve: None,
    },
    Feature {
        name: "slit",
        betti: [1, 1, 0],
        most: 0.8,
        area: |f| 4.0 - 2.0 * SLIT * f,
        place: |r, f| Some(square(r)).filter(|p| p[0].abs() > f / 2.0 || p[1].abs() > SLIT),
        spots: |_| vec![[0.0, -SLIT, 0.0], [0.0, SLIT, 0.0]],
        curve: None,
    },
    Feature {
        name: "bent-slit",
        betti: [1, 1, 0],
        most: 0.5,
        area: |f| 4.0 - PI * BEND * f,
        place: |r, f| {
            let ring = |p: &Spot| (libm::hypot(p[0], p[1]) - BEND).abs();
            Some(square(r)).filter(|p| p[1] < 0.0 || ring(p) > f / 2.0)
        },
        spots: |_| vec![[-BEND, 0.0, 0.0], [BEND, 0.0, 0.0], [0.0, BEND, 0.0]],
        curve: None,
    },
    Feature {
        name: "cut",
        betti: [2, 0, 0],
        most: 1.0,
        area: |f| 4.0 - 2.0 * f,
        place: |r, f| Some(square(r)).filter(|p| p[0].abs() > f / 2.0),
        spots: |_| vec![[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        curve: None,
    },
    Feature {
        name: "coplanar",
        betti: [2, 0, 0],
        most: 1.0,
        area: |_| 2.0 * 1.3 + 1.4 * 0.7,
        place: |r, f| {
            let [x, y, _] = square(r);
            let beyond = x > 0.3;
            let at = [if beyond { x + f } else { x }, y, 0.0];
            Some(at).filter(|_| !beyond || y.abs() < 0.7)
        },
        spots: |f| vec![[0.3 + f / 2.0, -0.7, 0.0], [0.3 + f / 2.0, 0.7, 0.0]],
        curve: None,
    },
    Feature {
        name: "disc-holes",
        betti: [1, 3, 0],
        most: 0.5,
        area: |f| PI * (1.0 - 0.75 * f * f),
        place: |r, f| {
            let p = square(r);
            let open = holes()
                .iter()
                .any(|h| libm::hypot(p[0] - h[0], p[1] - h[1]) < f / 2.0);
            Some(p).filter(|p| libm::hypot(p[0], p[1]) < 1.0 && !open)
        },
        spots: |_| holes().to_vec(),
        curve: None,
    },
    Feature {
        name: "parallel",
        betti: [2, 0, 0],
        most: 2.0,
        area: |_| 8.0,
        place: |r, f| {
            let [x, y, _] = square(r);
            Some([x, y, if r.uniform() < 0.5 { f } else { 0.0 }])
        },
        spots: |f| {
            let signs = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
            signs.map(|(x, y)| [x, y, f / 2.0]).to_vec()
        },
        curve: None,
    },
    Feature {
        // how far the second square reaches through the first
        name: "crossing-squares",
        betti: [1, 0, 0],
        most: 1.0,
        area: |f| 4.0 + 2.0 * STANDING[0] * (STANDING[1] + f),
        place: |r, f| {
            let [half, above] = STANDING;
            let second = 2.0 * half * (above + f);
            Some(if r.uniform() * (4.0 + second) < second {
                [0.0, r.between(-half, half), r.between(-f, above)]
            } else {
                square(r)
            })
        },
        spots: |_| vec![[0.0, -STANDING[0], 0.0], [0.0, STANDING[0], 0.0]],
        curve: None,
    },
    Feature {
        // its width
        name: "ribbon",
        betti: [1, 1, 0],
        most: 2.0,
        area: |f| TAU * f,
        place: |r, f| {
            let (sin, cos) = libm::sincos(r.between(0.0, TAU));
            Some([cos, sin, r.between(-f / 2.0, f / 2.0)])
        },
        spots: |_| around().to_vec(),
        curve: None,
    },
    Feature {
        // its width
        name: "moebius",
        betti: [1, 1, 0],
        most: 1.0,
        area: |f| TAU * f,
        place: |r, f| {
            let (u, w) = (r.between(0.0, TAU), r.between(-f / 2.0, f / 2.0));
            let ([sin, cos], [half_sin, half_cos]) = (swap(u), swap(u / 2.0));
            let ring = 1.0 + w * half_cos;
            Some([ring * cos, ring * sin, w * half_sin])
        },
        spots: |_| around().to_vec(),
        curve: None,
    },
];

/// A random place of the square [-1, 1]^2.
pub(super) fn square(r: &mut Random) -> Spot {
    [r.between(-1.0, 1.0), r.between(-1.0, 1.0), 0.0]
}

fn holes() -> [Spot; 3] {
    [0.0, 1.0, 2.0].map(|k| {
        let [sin, cos] = swap(k * TAU / 3.0);
        [HOLES * cos, HOLES * sin, 0.0]
    })
}

/// Places around the unit circle.
fn around() -> [Spot; 8] {
    std::array::from_fn(|k| {
        let [sin, cos] = swap(k as f64 * TAU / 8.0);
        [cos, sin, 0.0]
    })
}
