//! Surfaces with known formulas, for tests of pictures and to look at.

use super::{Curve, CurveKind, Cut, Layout, Scene, StillOptions, page, still};
use crosscap_core::{Complex, CurveEdge, PointCloud};
use std::f64::consts::{PI, TAU};

/// Vertices that are welded when they are equal to the sixth digit.
#[derive(Default)]
struct Welded {
    index: std::collections::BTreeMap<[i64; 3], u32>,
    places: Vec<f64>,
}

impl Welded {
    fn at(&mut self, p: [f64; 3]) -> u32 {
        let key = p.map(|c| (c * 1e6).round() as i64);
        let next = self.index.len() as u32;
        *self.index.entry(key).or_insert_with(|| {
            self.places.extend(p);
            next
        })
    }
}

/// The triangles of a grid of quadrilaterals over [0, 1]^2, placed and welded, without degenerate ones.
fn grid(
    vertices: &mut Welded,
    (wide, tall): (usize, usize),
    place: impl Fn(f64, f64) -> [f64; 3],
) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for i in 0..wide {
        for j in 0..tall {
            let mut at = |a: usize, b: usize| {
                vertices.at(place(a as f64 / wide as f64, b as f64 / tall as f64))
            };
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let halves = if (i + j) % 2 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            triangles.extend(
                halves
                    .into_iter()
                    .filter(|t| t[0] != t[1] && t[1] != t[2] && t[0] != t[2]),
            );
        }
    }
    triangles
}

/// A scene from welded vertices, triangles by piece, and a rule for which edges are on a curve.
fn scene(
    title: &str,
    vertices: Welded,
    pieces: Vec<(&str, Vec<[u32; 3]>)>,
    curve: impl Fn(&[f64], &[f64]) -> Option<u8>,
) -> Scene {
    let count = vertices.places.len() / 3;
    let cloud = PointCloud::new(3, vertices.places).unwrap();
    let all: Vec<[u32; 3]> = pieces.iter().flat_map(|p| p.1.clone()).collect();
    let bare = Complex {
        vertices: count,
        triangles: all.clone(),
        curve_edges: vec![],
    };
    let marked = bare
        .edges()
        .into_iter()
        .filter_map(|[a, b]| {
            let cells = curve(cloud.point(a as usize), cloud.point(b as usize))?;
            Some(CurveEdge::new(a, b, cells))
        })
        .collect();
    let complex = Complex {
        curve_edges: marked,
        ..bare
    };
    let layouts = vec![
        Layout::coordinates("x, y, z", &cloud, Some(&cloud), [0, 1, 2]).unwrap(),
        Layout::coordinates("x, y", &cloud, None, [0, 1, 3]).unwrap(),
    ];
    let mut out = Scene::new(title, &complex, layouts);
    out.triangle_piece = pieces
        .iter()
        .enumerate()
        .flat_map(|(k, p)| vec![k as u32; p.1.len()])
        .collect();
    out.piece_names = pieces.iter().map(|p| p.0.to_string()).collect();
    out.facts = vec![
        ("Betti numbers".into(), "1, 0, 3".into()),
        (
            "Verdict".into(),
            "verified: every edge and every link is as its stratum asks".into(),
        ),
        ("eps".into(), "0.25".into()),
    ];
    out
}

/// Two unit spheres, centers sqrt 2 apart, glued along their circle, one red, one green.
pub(super) fn two_spheres(rings: usize) -> Scene {
    let shift = 0.5_f64.sqrt();
    let mut vertices = Welded::default();
    let ball = |sign: f64| {
        move |u: f64, v: f64| {
            let (t, p) = (u * PI, v * TAU);
            [
                sign * (shift + t.cos()),
                t.sin() * p.cos(),
                t.sin() * p.sin(),
            ]
        }
    };
    let size = (4 * rings, 8 * rings);
    let a = grid(&mut vertices, size, ball(1.0));
    let b = grid(&mut vertices, size, ball(-1.0));
    let pieces = vec![("sphere", a), ("second sphere", b)];
    scene("Two spheres", vertices, pieces, |p, q| {
        (p[0].abs() < 1e-6 && q[0].abs() < 1e-6).then_some(4)
    })
}

fn torus() -> Scene {
    let mut vertices = Welded::default();
    let t = grid(&mut vertices, (60, 30), |u, v| {
        let (a, b) = (u * TAU, v * TAU);
        let r = 2.0 + b.cos();
        [r * a.cos(), r * a.sin(), b.sin()]
    });
    scene("Torus", vertices, vec![("torus", t)], |_, _| None)
}

fn sphere() -> Scene {
    let mut vertices = Welded::default();
    let t = grid(&mut vertices, (24, 48), |u, v| {
        let (t, p) = (u * PI, v * TAU);
        [t.sin() * p.cos(), t.sin() * p.sin(), t.cos()]
    });
    scene("Sphere", vertices, vec![("sphere", t)], |_, _| None)
}

fn klein() -> Scene {
    let mut vertices = Welded::default();
    let t = grid(&mut vertices, (110, 44), |u, v| {
        let (t, r) = (u * TAU, v * TAU);
        let (c, s) = ((t / 2.0).cos(), (t / 2.0).sin());
        let w = c * r.sin() - s * (2.0 * r).sin();
        [
            (3.0 + w) * t.cos(),
            (3.0 + w) * t.sin(),
            s * r.sin() + c * (2.0 * r).sin(),
        ]
    });
    let on = |p: &[f64]| p[2].abs() < 1e-6 && (p[0].hypot(p[1]) - 3.0).abs() < 1e-6;
    scene(
        "Klein bottle",
        vertices,
        vec![("Klein bottle", t)],
        move |p, q| (on(p) && on(q)).then_some(4),
    )
}

fn roman() -> Scene {
    // The octahedron, so that edges follow the coordinate planes.
    let mut vertices = Welded::default();
    let n = 26;
    let mut triangles = Vec::new();
    for (x, y, z) in [
        (1.0, 1.0, 1.0),
        (-1.0, 1.0, 1.0),
        (1.0, -1.0, 1.0),
        (1.0, 1.0, -1.0),
    ] {
        let mut at = |i: usize, j: usize| {
            let p = [x * i as f64, y * j as f64, z * (n - i - j) as f64];
            let l = p.iter().map(|c| c * c).sum::<f64>();
            vertices.at([p[1] * p[2] / l, p[0] * p[2] / l, p[0] * p[1] / l])
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    let triangles = triangles
        .into_iter()
        .filter(|t| t[0] != t[1] && t[1] != t[2] && t[0] != t[2])
        .collect();
    let axis = |p: &[f64], q: &[f64]| {
        (0..3).any(|k| (0..3).all(|m| m == k || (p[m].abs() < 1e-6 && q[m].abs() < 1e-6)))
    };
    scene(
        "Roman surface",
        vertices,
        vec![("projective plane", triangles)],
        move |p, q| axis(p, q).then_some(4),
    )
}

fn henneberg() -> Scene {
    let mut vertices = Welded::default();
    let place = |rho: f64, t: f64| {
        let (r2, r3, r6) = (rho * rho, rho.powi(3), rho.powi(6));
        [
            2.0 * (r2 - 1.0) * t.cos() / rho - 2.0 * (r6 - 1.0) * (3.0 * t).cos() / (3.0 * r3),
            -(6.0 * r2 * (r2 - 1.0) * t.sin() + 2.0 * (r6 - 1.0) * (3.0 * t).sin()) / (3.0 * r3),
            2.0 * (r2 * r2 + 1.0) * (2.0 * t).cos() / r2,
        ]
    };
    let t = grid(&mut vertices, (14, 160), |u, v| {
        place(0.4 + 0.2 * u, v * TAU)
    });
    let mut out = scene("Henneberg", vertices, vec![("annulus", t)], |_, _| None);
    // The edges with one triangle are the boundary.
    let boundary = out
        .edges()
        .into_iter()
        .filter(|e| {
            let has = |t: &&[u32; 3]| e.iter().all(|v| t.contains(v));
            out.triangles.iter().filter(has).count() == 1
        })
        .collect();
    out.curves = vec![Curve {
        kind: CurveKind::Boundary,
        edges: boundary,
    }];
    out
}

#[test]
#[ignore = "writes pictures to look at into the folder for temporary files"]
fn pictures_to_look_at() {
    let folder = std::env::temp_dir().join("crosscap-pictures");
    std::fs::create_dir_all(&folder).unwrap();
    let scenes = [
        two_spheres(8),
        torus(),
        sphere(),
        klein(),
        roman(),
        henneberg(),
    ];
    for scene in &scenes {
        let name = scene.title.replace(' ', "-").to_lowercase();
        std::fs::write(folder.join(format!("{name}.html")), page(scene).unwrap()).unwrap();
        let plain = StillOptions::default();
        let variants = [
            ("plain", plain.clone()),
            (
                "cut",
                StillOptions {
                    cut: Some(Cut {
                        direction: None,
                        keep: 0.55,
                    }),
                    edges: true,
                    ..plain.clone()
                },
            ),
            (
                "glass",
                StillOptions {
                    opacity: 0.45,
                    ..plain.clone()
                },
            ),
        ];
        for (variant, options) in variants {
            let start = std::time::Instant::now();
            let image = still(scene, 800, 600, &options).unwrap();
            println!(
                "{name} {variant}: {} triangles, {:?}",
                scene.triangles.len(),
                start.elapsed()
            );
            std::fs::write(folder.join(format!("{name}-{variant}.png")), image).unwrap();
        }
    }
}
