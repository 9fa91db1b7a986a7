//! Surfaces with every kind of singular curve and point: most of them flat pieces put together.

use super::books::{DISCS, PAGES, book, plate_on_plate};
use super::cayley::cayley;
use super::curves::{circle, curve, path, straight};
use super::flat::{axes, square};
use super::pierced::cube_with_hole;
use super::surface::SampleSurface;
use super::truth::{DISC, PROJECTIVE, SEGMENT, SPHERE, crossing, plain};
use super::{
    Cone, CrossCap, CurveKind, HalfDisc, Piece, PointKind, Ring, Segment, SphereCap, Truth,
    Umbrella,
};
use std::f64::consts::TAU;

/// The corners of the cube of side 2 about the origin.
fn corners() -> impl Iterator<Item = [f64; 3]> {
    (0..8).map(|k: u8| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 }))
}

/// The edges of that cube.
fn edges() -> impl Iterator<Item = [[f64; 3]; 2]> {
    corners().flat_map(|from| {
        let low = (0..3).filter(move |&axis| from[axis] < 0.0);
        low.map(move |axis| {
            let mut to = from;
            to[axis] = 1.0;
            [from, to]
        })
    })
}

/// Its faces, that at the top last.
fn faces() -> Vec<Box<dyn Piece>> {
    vec![
        square("left", [-1.0, 0.0, 0.0], 1, 2),
        square("right", [1.0, 0.0, 0.0], 1, 2),
        square("front", [0.0, -1.0, 0.0], 0, 2),
        square("back", [0.0, 1.0, 0.0], 0, 2),
        square("bottom", [0.0, 0.0, -1.0], 0, 1),
        square("top", [0.0, 0.0, 1.0], 0, 1),
    ]
}

fn boxes() -> Vec<SampleSurface> {
    let at_top = |p: [f64; 3]| p[2] > 0.0;
    let mut open = faces();
    open.pop();
    vec![
        SampleSurface::new(
            "cube",
            "the surface of a cube of side 2",
            faces(),
            Truth {
                creases: 12,
                ..plain([1, 0, 1], &DISCS[..6], 0)
            },
            15_000,
        )
        .singular(|m| {
            let crease = |[from, to]: [[f64; 3]; 2]| straight(CurveKind::Crease, from, to, m);
            edges().map(crease).collect()
        })
        .at(PointKind::Corner, corners().map(Vec::from)),
        SampleSurface::new(
            "open_box",
            "a cube of side 2 without its top",
            open,
            Truth {
                creases: 8,
                ..plain([1, 0, 0], &DISCS[..5], 1)
            },
            12_500,
        )
        .singular(move |m| {
            let below = edges().filter(|e| !e.iter().all(|&p| at_top(p)));
            below
                .map(|[from, to]| straight(CurveKind::Crease, from, to, m))
                .collect()
        })
        .bounded_by(|m| {
            let rim = [
                [-1.0, -1.0],
                [1.0, -1.0],
                [1.0, 1.0],
                [-1.0, 1.0],
                [-1.0, -1.0],
            ];
            vec![path(
                CurveKind::Boundary,
                rim.map(|[x, y]| [x, y, 1.0]).into(),
                m,
            )]
        })
        .at(
            PointKind::Corner,
            corners().filter(move |&p| !at_top(p)).map(Vec::from),
        )
        .at(
            PointKind::CreaseEnd,
            corners().filter(move |&p| at_top(p)).map(Vec::from),
        ),
    ]
}

fn cones() -> Vec<SampleSurface> {
    vec![
        SampleSurface::new(
            "cone",
            "a cone of radius 1 and height 1.5 with its lid",
            vec![
                Box::new(Cone::new("cone", 1.5, 0.0, 1.0)),
                Box::new(Ring::new("lid", vec![0.0; 3], axes(3, 0, 1), [0.0, 1.0])),
            ],
            Truth {
                creases: 1,
                ..plain([1, 0, 1], &[DISC, DISC], 0)
            },
            8_000,
        )
        .singular(|m| vec![circle(CurveKind::Crease, 1.0, 0.0, m)])
        .at(PointKind::Apex, [vec![0.0, 0.0, 1.5]]),
        SampleSurface::new(
            "double_cone",
            "two cones of radius 1 and height 1 that meet in their apexes",
            vec![
                Box::new(Cone::new("lower cone", 0.0, -1.0, 1.0)),
                Box::new(Cone::new("upper cone", 0.0, 1.0, 1.0)),
            ],
            Truth {
                isolated_crossings: 1,
                ..plain([1, 0, 0], &[DISC, DISC], 2)
            },
            8_000,
        )
        .at(PointKind::Isolated, [vec![0.0; 3]]),
    ]
}

fn pinched() -> Vec<SampleSurface> {
    let ends = [[0.0, 0.0, -0.5], [0.0; 3]];
    vec![
        SampleSurface::new(
            "whitney_umbrella",
            "Whitney's umbrella: a double segment from a pinch point to where the boundary crosses itself",
            vec![Box::new(Umbrella)],
            Truth {
                boundary_curves: 1,
                pinch_points: 1,
                ..crossing([1, 0, 0], &[DISC], 1)
            },
            10_000,
        )
        .also(&["umbrella"])
        .singular(|m| vec![straight(CurveKind::Double, [0.0; 3], [0.0, 0.0, 1.0], m)])
        .at(PointKind::Pinch, [vec![0.0; 3]])
        .at(PointKind::CurveEnd, [vec![0.0, 0.0, 1.0]]),
        SampleSurface::new(
            "cross_cap",
            "the cross-cap: the projective plane with one double segment between two pinch points",
            vec![Box::new(CrossCap)],
            Truth {
                pinch_points: 2,
                ..crossing([1, 0, 1], &[PROJECTIVE], 1)
            },
            10_000,
        )
        .also(&["crosscap"])
        .singular(move |m| vec![straight(CurveKind::Double, ends[0], ends[1], m)])
        .at(PointKind::Pinch, ends.map(Vec::from)),
        umbrella_with_handle(),
    ]
}

/// All real zeros of x^2 = y^2 z near the pinch point: beyond it the double line has no sheet.
fn umbrella_with_handle() -> SampleSurface {
    SampleSurface::new(
        "umbrella_with_handle",
        "Whitney's umbrella with its handle, the segment that continues the double segment beyond the pinch point",
        vec![
            Box::new(Umbrella),
            Box::new(Segment::new("handle", [vec![0.0; 3], axis(2, -1.0).into()])),
        ],
        Truth {
            boundary_curves: 1,
            pinch_points: 1,
            ..crossing([1, 0, 0], &[DISC, SEGMENT], 1)
        },
        10_000,
    )
    .singular(|m| vec![straight(CurveKind::Double, [0.0; 3], axis(2, 1.0), m)])
    .at(PointKind::Pinch, [vec![0.0; 3]])
    .at(PointKind::CurveEnd, [axis(2, 1.0).into()])
}

/// A place on the `k`-th coordinate axis.
fn axis(k: usize, x: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| if i == k { x } else { 0.0 })
}

/// Two squares.
fn two_squares() -> SampleSurface {
    SampleSurface::new(
        "two_squares",
        "two squares of side 2 that cross in a segment with both ends on their boundaries",
        vec![
            square("lying", [0.0; 3], 0, 1),
            square("standing", [0.0; 3], 1, 2),
        ],
        Truth {
            boundary_curves: 2,
            ..crossing([1, 0, 0], &[DISC, DISC], 1)
        },
        10_000,
    )
    .singular(move |m| vec![straight(CurveKind::Double, axis(1, -1.0), axis(1, 1.0), m)])
    .at(
        PointKind::CurveEnd,
        [-1.0, 1.0].map(|x| axis(1, x).to_vec()),
    )
}

/// Three squares.
fn three_squares() -> SampleSurface {
    SampleSurface::new(
        "three_squares",
        "three squares of side 2 that cross in three segments and a triple point",
        vec![
            square("lying", [0.0; 3], 0, 1),
            square("standing", [0.0; 3], 1, 2),
            square("facing", [0.0; 3], 0, 2),
        ],
        Truth {
            boundary_curves: 3,
            triple_points: 1,
            ..crossing([1, 0, 0], &[DISC, DISC, DISC], 3)
        },
        15_000,
    )
    .triple(vec![vec![0.0; 3]])
    .singular(move |m| {
        let segment = |k| straight(CurveKind::Double, axis(k, -1.0), axis(k, 1.0), m);
        (0..3).map(segment).collect()
    })
    .at(
        PointKind::CurveEnd,
        (0..6).map(|k| axis(k / 2, if k % 2 == 0 { -1.0 } else { 1.0 }).to_vec()),
    )
}

/// Three half discs.
fn three_half_discs() -> SampleSurface {
    let out = |k: usize| {
        let (s, c) = libm::sincos(TAU * k as f64 / 3.0);
        [c, 0.0, s]
    };
    SampleSurface::new(
        "three_half_discs",
        "three half discs with their diameter in common, at 120 degrees",
        (0..3)
            .map(|k| Box::new(HalfDisc::new(PAGES[k], 1.0, axis(1, 1.0), out(k))) as Box<dyn Piece>)
            .collect(),
        Truth {
            junction_curves: 1,
            ..plain([1, 0, 0], &DISCS[..3], 3)
        },
        7_500,
    )
    .singular(move |m| {
        vec![straight(
            CurveKind::Junction,
            axis(1, -1.0),
            axis(1, 1.0),
            m,
        )]
    })
    .bounded_by(move |m| {
        let rim = |k: usize| {
            curve(CurveKind::Boundary, false, m, move |t| {
                let (s, c) = libm::sincos(0.5 * TAU * t);
                let [x, _, z] = out(k);
                vec![s * x, c, s * z]
            })
        };
        (0..3).map(rim).collect()
    })
    .at(
        PointKind::CurveEnd,
        [-1.0, 1.0].map(|x| axis(1, x).to_vec()),
    )
}

/// A sphere with a wall: the two sides of the T-junction bend as the sphere does.
fn divided_sphere() -> SampleSurface {
    SampleSurface::new(
        "divided_sphere",
        "the unit sphere with a disc through its middle",
        vec![
            Box::new(SphereCap::sphere("sphere", [0.0; 3], 1.0)),
            Box::new(Ring::new(
                "wall",
                vec![0.0; 3],
                [axis(0, 1.0).to_vec(), axis(1, 1.0).to_vec()],
                [0.0, 1.0],
            )),
        ],
        Truth {
            junction_curves: 1,
            ..plain([1, 0, 2], &[SPHERE, DISC], 0)
        },
        8_000,
    )
    .singular(move |m| {
        vec![curve(CurveKind::Junction, true, m, |t| {
            let (s, c) = libm::sincos(TAU * t);
            vec![c, s, 0.0]
        })]
    })
}

/// A segment that stands on a sphere.
fn sphere_with_hair() -> SampleSurface {
    SampleSurface::new(
        "sphere_with_hair",
        "the unit sphere with a segment that stands on it",
        vec![
            Box::new(SphereCap::sphere("sphere", [0.0; 3], 1.0)),
            Box::new(Segment::new(
                "hair",
                [vec![0.0, 0.0, 1.0], vec![0.0, 0.0, 2.0]],
            )),
        ],
        plain([1, 0, 1], &[SPHERE, SEGMENT], 0),
        8_000,
    )
    .at(PointKind::Isolated, [vec![0.0, 0.0, 1.0]])
}

/// Surfaces with singular curves and points of every kind.
pub(super) fn singular_surfaces() -> Vec<SampleSurface> {
    let mut all = pinched();
    all.extend([
        two_squares(),
        three_squares(),
        three_half_discs(),
        plate_on_plate(
            "plate_on_plate",
            "a plate that stands on the middle of a larger one",
            0.6,
        ),
        plate_on_plate(
            "t_junction",
            "a plate that stands on another one from rim to rim",
            1.0,
        ),
        book("book_5", "five pages that meet in one side", 5),
        book("book_6", "six pages that meet in one side", 6),
        book("book_8", "eight pages that meet in one side", 8),
        divided_sphere(),
        sphere_with_hair(),
    ]);
    all.extend(boxes());
    all.extend(cones());
    all.push(cube_with_hole());
    all.push(cayley());
    all
}
