//! Further surfaces: crossings of every kind, boundaries, flat and rolled sheets.

use super::curves::{
    DoubleBubble, circle_of_spheres, equilateral_centers, roman_segments, torus_sphere_circles,
    torus_through_torus, triple_points_of_three_spheres,
};
use super::flat::axes;
use super::surface::SampleSurface;
use super::truth::{ANNULUS, DISC, PROJECTIVE, SEGMENT, SPHERE, TORUS, crossing, plain};
use super::{
    BoySurface, CurveKind, Cylinder, Piece, PointKind, Rectangle, Ring, RomanSurface, Segment,
    SphereCap, SwissRoll, Torus, Truth,
};
use std::f64::consts::{FRAC_PI_2, PI};

/// Direction of the third axis.
const VERTICAL: [f64; 3] = [0.0, 0.0, 1.0];

/// All of them.
pub(super) fn further_surfaces() -> Vec<SampleSurface> {
    vec![
        three_spheres(),
        double_bubble(),
        planes_r4(),
        line_disc(),
        hemisphere(),
        annulus(),
        torus_sphere(),
        two_tori(),
        swiss_roll(),
        square(),
        cylinder(),
        boy_surface(),
        roman(),
    ]
}

/// Three spheres with triple points.
fn three_spheres() -> SampleSurface {
    let centers = equilateral_centers();
    SampleSurface::new(
        "three_spheres",
        "three unit spheres, centers one unit apart, with two triple points",
        centers
            .iter()
            .zip(["first sphere", "second sphere", "third sphere"])
            .map(|(&c, name)| Box::new(SphereCap::sphere(name, c, 1.0)) as Box<dyn Piece>)
            .collect(),
        Truth {
            triple_points: 2,
            ..crossing([1, 0, 7], &[SPHERE, SPHERE, SPHERE], 3)
        },
        60_000,
    )
    .triple(triple_points_of_three_spheres())
    .singular(move |m| {
        [(0, 1), (0, 2), (1, 2)]
            .map(|(a, b)| {
                circle_of_spheres(CurveKind::Double, [centers[a], centers[b]], [1.0; 2], m)
            })
            .into()
    })
}

/// Three caps on a Y-junction.
fn double_bubble() -> SampleSurface {
    let bubble = DoubleBubble::new(1.0, 0.8);
    let pole = |k: usize| [bubble.centers[k], 0.0, 0.0];
    SampleSurface::new(
        "double_bubble",
        "the standard double bubble, radii 1 and 0.8: three caps that meet at 120 degrees",
        vec![
            Box::new(SphereCap::cap(
                "large cap",
                pole(0),
                bubble.radii[0],
                [-1.0, 0.0, 0.0],
                bubble.angles[0],
            )),
            Box::new(SphereCap::cap(
                "small cap",
                pole(1),
                bubble.radii[1],
                [1.0, 0.0, 0.0],
                bubble.angles[1],
            )),
            Box::new(SphereCap::cap(
                "film",
                pole(2),
                bubble.radii[2],
                [-1.0, 0.0, 0.0],
                bubble.angles[2],
            )),
        ],
        Truth {
            junction_curves: 1,
            ..plain([1, 0, 2], &[DISC, DISC, DISC], 0)
        },
        40_000,
    )
    .singular(move |m| bubble.junction(m))
}

/// Two discs that cross in one point.
fn planes_r4() -> SampleSurface {
    SampleSurface::new(
        "planes_r4",
        "two unit discs in R^4 that cross in one point",
        vec![
            Box::new(Ring::new(
                "first disc",
                vec![0.0; 4],
                axes(4, 0, 1),
                [0.0, 1.0],
            )),
            Box::new(Ring::new(
                "second disc",
                vec![0.0; 4],
                axes(4, 2, 3),
                [0.0, 1.0],
            )),
        ],
        Truth {
            isolated_crossings: 1,
            ..plain([1, 0, 0], &[DISC, DISC], 2)
        },
        10_000,
    )
}

/// A curve through a sheet.
fn line_disc() -> SampleSurface {
    SampleSurface::new(
        "line_disc",
        "a segment through the middle of a unit disc",
        vec![
            Box::new(Ring::new("disc", vec![0.0; 3], axes(3, 0, 1), [0.0, 1.0])),
            Box::new(Segment::new(
                "segment",
                [vec![0.0, 0.0, -1.0], vec![0.0, 0.0, 1.0]],
            )),
        ],
        Truth {
            isolated_crossings: 1,
            ..plain([1, 0, 0], &[DISC, SEGMENT], 1)
        },
        5_000,
    )
}

/// A sphere with a boundary.
fn hemisphere() -> SampleSurface {
    SampleSurface::new(
        "hemisphere",
        "half of the unit sphere",
        vec![Box::new(SphereCap::cap(
            "hemisphere",
            [0.0; 3],
            1.0,
            VERTICAL,
            FRAC_PI_2,
        ))],
        plain([1, 0, 0], &[DISC], 1),
        5_000,
    )
}

/// A flat ring.
fn annulus() -> SampleSurface {
    SampleSurface::new(
        "annulus",
        "a flat ring of radii 0.5 and 1",
        vec![Box::new(Ring::new(
            "annulus",
            vec![0.0; 3],
            axes(3, 0, 1),
            [0.5, 1.0],
        ))],
        plain([1, 1, 0], &[ANNULUS], 2),
        5_000,
    )
}

/// A torus and a sphere.
fn torus_sphere() -> SampleSurface {
    SampleSurface::new(
        "torus_sphere",
        "a torus that runs through a sphere",
        vec![
            Box::new(Torus::new("torus", [0.0; 3], VERTICAL, 2.0, 1.0)),
            Box::new(SphereCap::sphere("sphere", [2.0, 0.0, 0.0], 1.6)),
        ],
        crossing([1, 2, 3], &[TORUS, SPHERE], 2),
        120_000,
    )
    .singular(|m| torus_sphere_circles(2.0, 1.0, 1.6, m))
}

/// Two tori.
fn two_tori() -> SampleSurface {
    let wide = Torus::new("wide torus", [0.0; 3], VERTICAL, 2.0, 1.0);
    let thin = Torus::new("thin torus", [4.0, 0.0, 0.0], [0.0, 1.0, 0.0], 2.0, 0.5);
    SampleSurface::new(
        "two_tori",
        "a thin torus that runs once through the tube of a wide one",
        vec![Box::new(wide.clone()), Box::new(thin.clone())],
        crossing([1, 4, 3], &[TORUS, TORUS], 2),
        150_000,
    )
    // The thin core enters at (2, 0, 0), where its angle is that of the direction -x.
    .singular(move |m| torus_through_torus(&wide, &thin, angle_of_minus_x(&thin), FRAC_PI_2, m))
}

/// A strip whose turns are close to each other.
fn swiss_roll() -> SampleSurface {
    SampleSurface::new(
        "swiss_roll",
        "a strip wound in a spiral",
        vec![Box::new(SwissRoll::new(0.1, [1.5 * PI, 4.5 * PI], 10.0))],
        plain([1, 0, 0], &[DISC], 1),
        10_000,
    )
}

/// A flat square.
fn square() -> SampleSurface {
    SampleSurface::new(
        "square",
        "a flat square of side 2",
        vec![Box::new(Rectangle::new(
            "square",
            vec![0.0; 3],
            axes(3, 0, 1),
        ))],
        plain([1, 0, 0], &[DISC], 1),
        5_000,
    )
}

/// A cylinder without lids.
fn cylinder() -> SampleSurface {
    SampleSurface::new(
        "cylinder",
        "a cylinder of radius 1 and height 2",
        vec![Box::new(Cylinder::new("cylinder", 1.0, 1.0))],
        plain([1, 1, 0], &[ANNULUS], 2),
        10_000,
    )
}

/// A projective plane with a triple point.
fn boy_surface() -> SampleSurface {
    SampleSurface::new(
        "boy_surface",
        "Boy's surface: the projective plane immersed with one triple point",
        vec![Box::new(BoySurface)],
        Truth {
            triple_points: 1,
            ..crossing([1, 0, 1], &[PROJECTIVE], 1)
        },
        100_000,
    )
    .also(&["boy"])
    .triple(vec![vec![0.0; 3]])
}

/// A projective plane with pinch points.
fn roman() -> SampleSurface {
    SampleSurface::new(
        "roman",
        "Steiner's Roman surface: the projective plane with three double segments and six pinch points",
        vec![Box::new(RomanSurface)],
        Truth {
            triple_points: 1,
            pinch_points: 6,
            ..crossing([1, 0, 4], &[PROJECTIVE], 3)
        },
        50_000,
    )
    .also(&["roman_surface", "steiner"])
    .triple(vec![vec![0.0; 3]])
    .at(PointKind::Pinch, (0..6).map(|k| {
        (0..3).map(|axis| if axis == k / 2 { k as f64 % 2.0 - 0.5 } else { 0.0 }).collect()
    }))
    .singular(roman_segments)
}

/// Angle about its axis at which a torus reaches farthest towards -x.
fn angle_of_minus_x(torus: &Torus) -> f64 {
    (0..4)
        .map(|k| f64::from(k) * FRAC_PI_2)
        .min_by(|&a, &b| {
            let x = |t: f64| super::place_at(torus, [t, 0.0])[0];
            x(a).total_cmp(&x(b))
        })
        .unwrap_or(0.0)
}
