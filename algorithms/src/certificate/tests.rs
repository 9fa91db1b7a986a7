//! Whole meshes: good ones are verified, and each way of breaking them is found as what it is.

use super::*;
use crosscap_core::{Complex, CurveEdge};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// A mesh in the making.
#[derive(Clone, Default)]
struct Draft {
    places: Vec<Vec<f64>>,
    triangles: Vec<[u32; 3]>,
    curves: Vec<CurveEdge>,
}

impl Draft {
    fn mesh(&self) -> Mesh {
        let n = self.places.len();
        let cloud = PointCloud::new(self.places[0].len(), self.places.concat()).unwrap();
        let complex = Complex::new(n, self.triangles.clone(), self.curves.clone()).unwrap();
        Mesh::new(complex, cloud, vec![-1; n]).unwrap()
    }

    fn certificate(&self) -> Certificate {
        certify(&self.mesh(), &CertificateOptions::default())
    }

    fn kinds(&self) -> Vec<ViolationKind> {
        self.certificate().violations().map(|v| v.kind).collect()
    }

    fn add(&mut self, place: &[f64]) -> u32 {
        self.places.push(place.to_vec());
        self.places.len() as u32 - 1
    }

    /// Marks every edge with `count` triangles as a curve of that many cells.
    fn mark(mut self, count: u8) -> Self {
        let mut found: BTreeMap<[u32; 2], u8> = BTreeMap::new();
        for t in &self.triangles {
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                *found.entry([t[i].min(t[j]), t[i].max(t[j])]).or_default() += 1;
            }
        }
        let edges = found.into_iter().filter(|e| e.1 == count);
        self.curves
            .extend(edges.map(|(e, _)| CurveEdge::new(e[0], e[1], count)));
        self
    }

    /// Sets another mesh beside this one.
    fn beside(mut self, other: &Self) -> Self {
        let from = self.places.len() as u32;
        self.places.extend(other.places.iter().cloned());
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|v| v + from)));
        self.curves.extend(
            other
                .curves
                .iter()
                .map(|e| CurveEdge::new(e.ends[0] + from, e.ends[1] + from, e.cells)),
        );
        self
    }

    fn map(mut self, f: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        self.places.iter_mut().for_each(|p| *p = f(p));
        self
    }

    /// Merges vertices at the same place, within 1e-9.
    fn weld(self) -> Self {
        let mut kept: Vec<Vec<f64>> = Vec::new();
        let name: Vec<u32> = self
            .places
            .iter()
            .map(|p| {
                let same = |q: &Vec<f64>| p.iter().zip(q).all(|(a, b)| (a - b).abs() < 1e-9);
                kept.iter().position(same).unwrap_or_else(|| {
                    kept.push(p.clone());
                    kept.len() - 1
                }) as u32
            })
            .collect();
        let mut triangles: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .map(|t| {
                let mut t = t.map(|v| name[v as usize]);
                t.sort_unstable();
                t
            })
            .filter(|t| t[0] != t[1] && t[1] != t[2])
            .collect();
        triangles.sort_unstable();
        triangles.dedup();
        Self {
            places: kept,
            triangles,
            curves: vec![],
        }
    }
}

/// `f` over a grid of m by n squares, corners at (0..=m)/m and (0..=n)/n.
fn grid(m: usize, n: usize, f: impl Fn(f64, f64) -> Vec<f64>) -> Draft {
    let mut draft = Draft::default();
    for i in 0..=m {
        for j in 0..=n {
            draft
                .places
                .push(f(i as f64 / m as f64, j as f64 / n as f64));
        }
    }
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    for i in 0..m {
        for j in 0..n {
            draft
                .triangles
                .push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            draft
                .triangles
                .push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    draft
}

fn plane(m: usize) -> Draft {
    let side = m as f64;
    grid(m, m, |s, t| vec![s * side, t * side + 0.5 * s * side, 0.0])
}

fn icosphere(rounds: usize) -> Draft {
    let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut draft = Draft::default();
    for (a, b) in [(1., g), (1., -g), (-1., g), (-1., -g)] {
        for p in [[0., a, b], [a, b, 0.], [b, 0., a]] {
            draft.places.push(p.to_vec());
        }
    }
    let near = |a: usize, b: usize, p: &[Vec<f64>]| {
        (crosscap_core::squared_distance(&p[a], &p[b]) - 4.0).abs() < 1e-9
    };
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let p = &draft.places;
                if near(a, b, p) && near(b, c, p) && near(a, c, p) {
                    draft.triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    for _ in 0..rounds {
        let mut middle: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for [a, b, c] in std::mem::take(&mut draft.triangles) {
            let mut half = |p: u32, q: u32| {
                *middle.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    let m: Vec<f64> = (0..3)
                        .map(|k| draft.places[p as usize][k] + draft.places[q as usize][k])
                        .collect();
                    let r = m.iter().map(|x| x * x).sum::<f64>().sqrt();
                    draft
                        .places
                        .push(m.iter().map(|x| x / r * (2.0 + g).sqrt()).collect());
                    draft.places.len() as u32 - 1
                })
            };
            let (d, e, f) = (half(a, b), half(b, c), half(a, c));
            draft
                .triangles
                .extend([[a, d, f], [b, d, e], [c, e, f], [d, e, f]]);
        }
    }
    draft.map(|p| p.iter().map(|x| x / (2.0 + g).sqrt()).collect())
}

fn torus() -> Draft {
    grid(36, 14, |s, t| {
        let r = 2.0 + (TAU * t).cos();
        vec![r * (TAU * s).cos(), r * (TAU * s).sin(), (TAU * t).sin()]
    })
    .weld()
}

/// Two unit spheres, centers sqrt(2) apart, meeting in a circle of vertices.
fn two_spheres() -> Draft {
    let sphere = |center: f64| {
        let flip = -center.signum();
        grid(16, 24, move |s, t| {
            let (a, b) = (PI * s, TAU * t);
            vec![
                center + flip * a.cos(),
                a.sin() * b.cos(),
                a.sin() * b.sin(),
            ]
        })
    };
    let d = FRAC_PI_4.cos();
    sphere(-d).beside(&sphere(d)).weld().mark(4)
}

fn moebius() -> Draft {
    grid(60, 6, |s, t| {
        let (a, r) = (TAU * s, 2.0 * t - 1.0);
        let q = 1.0 + 0.5 * r * (a / 2.0).cos();
        vec![q * a.cos(), q * a.sin(), 0.5 * r * (a / 2.0).sin()]
    })
    .weld()
    .mark(1)
}

fn projective_plane() -> Draft {
    icosphere(2)
        .map(|p| {
            let (x, y, z) = (p[0], p[1], p[2]);
            vec![x * y, x * z, y * z, x * x, y * y, z * z]
        })
        .weld()
}

/// Half planes that meet in one line, at the given angles in degrees.
fn book(pages: &[f64]) -> Draft {
    pages
        .iter()
        .map(|a| {
            let (s, c) = a.to_radians().sin_cos();
            grid(4, 6, move |u, v| vec![4.0 * u * c, 4.0 * u * s, 6.0 * v])
        })
        .fold(Draft::default(), |all, page| all.beside(&page))
        .weld()
        .mark(1)
        .mark(pages.len() as u8)
}

/// The three coordinate planes, crossing in the origin.
fn triple_point() -> Draft {
    (0..3)
        .map(|k| {
            grid(6, 6, move |u, v| {
                let mut p = vec![6.0 * u - 3.0, 6.0 * v - 3.0, 0.0];
                p.rotate_right(k);
                p
            })
        })
        .fold(Draft::default(), |all, page| all.beside(&page))
        .weld()
        .mark(1)
        .mark(4)
}

fn embed(draft: Draft, dimension: usize) -> Draft {
    draft.map(|p| {
        (0..dimension)
            .map(|k| {
                // columns of a cosine basis: orthonormal
                (0..p.len())
                    .map(|j| {
                        let scale = if j == 0 { 1.0 } else { 2.0_f64 };
                        p[j] * (scale / dimension as f64).sqrt()
                            * (PI * j as f64 * (k as f64 + 0.5) / dimension as f64).cos()
                    })
                    .sum()
            })
            .collect()
    })
}

fn dense_sphere(n: usize) -> PointCloud<f64> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let rows = (0..n)
        .flat_map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64;
            let (r, a) = ((1.0 - z * z).sqrt(), golden * i as f64);
            [r * a.cos(), r * a.sin(), z]
        })
        .collect();
    PointCloud::new(3, rows).unwrap()
}

fn verified(draft: &Draft) -> Certificate {
    let certificate = draft.certificate();
    assert!(certificate.verdict().is_verified(), "{certificate}");
    certificate
}

#[test]
fn good_closed_surfaces_are_verified() {
    for draft in [icosphere(0), icosphere(3), torus()] {
        let c = verified(&draft);
        let quality = c.quality.unwrap();
        assert_eq!(
            c.links.unwrap().census,
            BTreeMap::from([(LinkKind::Circle, draft.places.len())])
        );
        assert_eq!((quality.components, quality.cells.len()), (1, 1));
        assert!(quality.cells[0].orientable);
        let options = CertificateOptions {
            closed: true,
            ..Default::default()
        };
        assert!(certify(&draft.mesh(), &options).verdict().is_verified());
    }
    let area = verified(&icosphere(3)).quality.unwrap().area;
    assert!((area / (4.0 * PI) - 1.0).abs() < 0.02, "{area}");
}

#[test]
fn good_surfaces_with_curves_are_verified() {
    let c = verified(&two_spheres());
    let edges = c.edges.unwrap();
    assert_eq!(edges.curves, BTreeMap::from([(4, 24)]));
    assert_eq!(edges.by_triangles[&4], 24);
    assert_eq!(c.links.unwrap().census[&LinkKind::Double], 24);
    assert_eq!(c.quality.unwrap().cells.len(), 4);

    let c = verified(&moebius());
    assert!(!c.quality.unwrap().cells[0].orientable);
    assert_eq!(c.links.unwrap().census[&LinkKind::Arc], 120);
    let c = verified(&projective_plane());
    assert!(!c.quality.unwrap().cells[0].orientable);
    verified(&plane(5).mark(1));

    let c = verified(&book(&[0.0, 120.0, 240.0]));
    assert_eq!(c.links.as_ref().unwrap().census[&LinkKind::Junction], 5);
    assert_eq!(c.links.unwrap().census[&LinkKind::JunctionEnd], 2);
    let c = verified(&book(&[0.0, 60.0, 180.0, 240.0]));
    assert_eq!(c.links.unwrap().census[&LinkKind::DoubleEnd], 2);
    let c = verified(&triple_point());
    assert_eq!(c.links.unwrap().census[&LinkKind::Triple], 1);
}

#[test]
fn the_embedding_space_does_not_matter() {
    for n in [4, 7, 24] {
        verified(&embed(two_spheres(), n));
        verified(&embed(torus(), n));
    }
}

#[test]
fn curves_without_surface() {
    let mut draft = icosphere(2);
    let mut last = 0;
    for k in 1..4 {
        let place: Vec<f64> = draft.places[0]
            .iter()
            .map(|x| x * (1.0 + 0.2 * k as f64))
            .collect();
        let next = draft.add(&place);
        draft.curves.push(CurveEdge::new(last, next, 0));
        last = next;
    }
    let census = verified(&draft).links.unwrap().census;
    assert_eq!(census[&LinkKind::CurveOnSheet], 1);
    assert_eq!(
        (census[&LinkKind::Curve], census[&LinkKind::CurveEnd]),
        (2, 1)
    );
}

/// Three landmarks of a segment joined in a circle, and the circle that is one.
#[test]
fn a_segment_is_no_circle() {
    let circle = |places: [[f64; 3]; 3]| {
        let mut draft = icosphere(2);
        let [a, b, c] = places.map(|p| draft.add(&p));
        draft
            .curves
            .extend([[a, b], [b, c], [a, c]].map(|[p, q]| CurveEdge::new(p, q, 0)));
        draft
    };
    let folded = circle([[0.0, 0.0, 5.0], [0.0, 0.1, 6.0], [0.0, 0.0, 7.0]]);
    assert_eq!(folded.kinds(), [ViolationKind::BareFold]);
    let bend = folded
        .certificate()
        .geometry
        .unwrap()
        .smallest_bend
        .unwrap();
    assert!((5.0..6.0).contains(&bend), "{bend}");
    let round = circle([[0.0, 0.0, 5.0], [0.0, 0.9, 5.5], [0.0, 0.0, 6.0]]);
    assert_eq!(round.kinds(), []);
}

#[test]
fn unusable_arrays() {
    let good = icosphere(0).mesh();
    let kinds = |mesh: &Mesh| -> Vec<ViolationKind> {
        certify(mesh, &CertificateOptions::default())
            .violations()
            .map(|v| v.kind)
            .collect()
    };
    let mut mesh = good.clone();
    mesh.complex.triangles[3][2] = 99;
    assert_eq!(kinds(&mesh), [ViolationKind::IndexOutOfRange]);
    let mut mesh = good.clone();
    mesh.complex.triangles[3][2] = mesh.complex.triangles[3][0];
    assert_eq!(kinds(&mesh), [ViolationKind::RepeatedCorner]);
    let mut mesh = good.clone();
    let [a, b, c] = mesh.complex.triangles[3];
    mesh.complex.triangles.push([c, a, b]);
    assert!(kinds(&mesh).contains(&ViolationKind::RepeatedTriangle));
    let mut mesh = good.clone();
    mesh.complex.curve_edges = vec![
        CurveEdge::new(0, 1, 2),
        CurveEdge {
            ends: [1, 0],
            cells: 2,
        },
    ];
    assert!(kinds(&mesh).contains(&ViolationKind::RepeatedCurveEdge));
    let mut mesh = good.clone();
    mesh.complex.vertices += 1;
    assert_eq!(kinds(&mesh), [ViolationKind::Shape]);
    let mut mesh = good.clone();
    mesh.complex.triangles.clear();
    assert_eq!(kinds(&mesh), [ViolationKind::NoTriangles]);
    let mut mesh = good;
    mesh.complex.triangles[0].reverse();
    assert_eq!(kinds(&mesh), [], "order of corners does not matter");

    let mut draft = icosphere(1);
    draft.add(&[0.0, 0.0, 0.0]);
    assert_eq!(draft.kinds(), [ViolationKind::IsolatedVertex]);
    let twice = icosphere(1).beside(&icosphere(1));
    let kinds = twice.kinds();
    assert_eq!(kinds[0], ViolationKind::CoincidentVertices);
    assert_eq!(twice.certificate().indices.violations[0].count, 42);
}

#[test]
fn missing_triangle() {
    let mut draft = icosphere(2);
    let lost = draft.triangles.remove(17);
    let c = draft.certificate();
    let all: Vec<_> = c.violations().collect();
    assert_eq!(all.len(), 1);
    assert_eq!(
        (all[0].kind, all[0].count),
        (ViolationKind::UndeclaredBoundary, 3)
    );
    let Place::Edge(edge) = all[0].places[0] else {
        panic!("{:?}", all[0])
    };
    assert!(edge.iter().all(|v| lost.contains(v)));
    assert_eq!(all[0].coordinates, draft.places[edge[0] as usize]);
    let marked = draft.mark(1).mesh();
    let options = CertificateOptions {
        closed: true,
        ..Default::default()
    };
    let kinds: Vec<_> = certify(&marked, &options)
        .violations()
        .map(|v| v.kind)
        .collect();
    assert_eq!(
        kinds,
        [ViolationKind::BoundaryOfClosed, ViolationKind::SmallHole]
    );
    let c = certify(&marked, &CertificateOptions::default());
    let kinds: Vec<_> = c.violations().map(|v| v.kind).collect();
    assert_eq!(kinds, [ViolationKind::SmallHole]);
    assert_eq!(c.edges.unwrap().boundaries, [3]);
}

/// The estimated gap is an upper bound of the largest hole, and not a wasteful one, on scattered
/// points and on points with a least distance.
#[test]
fn the_gap_bounds_the_holes_of_a_sample() {
    use rand::RngExt;
    use rand::SeedableRng;
    let mesh = icosphere(4).mesh();
    for (seed, n) in [(1, 3000), (2, 10_000), (3, 40_000)] {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut rows: Vec<[f64; 3]> = Vec::new();
        while rows.len() < n {
            let p: [f64; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
            let r = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..1.0).contains(&r) {
                rows.push(p.map(|x| x / r));
            }
        }
        let thinned = {
            let least = (4.0 * PI / n as f64).sqrt() * 3.0;
            let mut kept: Vec<[f64; 3]> = Vec::new();
            for p in &rows {
                let far = |q: &[f64; 3]| crosscap_core::squared_distance(p, q) >= least * least;
                if kept.iter().all(far) {
                    kept.push(*p);
                }
            }
            kept
        };
        for sample in [rows, thinned] {
            let points = PointCloud::new(3, sample.concat()).unwrap();
            let options = CertificateOptions {
                points: Some(&points),
                landmark_separation: Some(0.5),
                ..Default::default()
            };
            let cover = certify(&mesh, &options).cover.unwrap();
            let hole = cover.mesh_to_points.unwrap().max;
            let gap = cover.point_gap;
            assert!(hole <= 1.15 * gap, "{} points: {hole} {gap}", points.len());
            assert!(hole >= 0.6 * gap, "{} points: {hole} {gap}", points.len());
        }
    }
}

#[test]
fn wrong_counts() {
    let mut draft = two_spheres();
    draft.curves.remove(5);
    assert_eq!(draft.kinds(), [ViolationKind::UndeclaredCurve]);
    let mut draft = two_spheres();
    draft.curves[5].cells = 3;
    assert_eq!(draft.kinds(), [ViolationKind::WrongCount]);
}

#[test]
fn bad_links() {
    // two tetrahedra that touch in one corner
    let tetrahedron = Draft {
        places: vec![
            vec![0., 0., 0.],
            vec![1., 1., 0.2],
            vec![-0.2, 1., 1.],
            vec![1., 0., 1.],
        ],
        triangles: vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]],
        curves: vec![],
    };
    let opposite = tetrahedron.clone().map(|p| p.iter().map(|x| -x).collect());
    let pair = tetrahedron.clone().beside(&opposite).weld();
    assert_eq!(pair.kinds(), [ViolationKind::SplitLink]);
    let special = [SpecialPoint {
        vertex: 0,
        link: LinkKind::IsolatedCrossing.link().unwrap(),
    }];
    let options = CertificateOptions {
        special_points: &special,
        ..Default::default()
    };
    let c = certify(&pair.mesh(), &options);
    assert!(c.verdict().is_verified(), "{c}");
    let special = [SpecialPoint {
        vertex: 1,
        link: LinkKind::IsolatedCrossing.link().unwrap(),
    }];
    let options = CertificateOptions {
        special_points: &special,
        ..Default::default()
    };
    let kinds: Vec<_> = certify(&pair.mesh(), &options)
        .violations()
        .map(|v| v.kind)
        .collect();
    assert_eq!(
        kinds,
        [ViolationKind::SplitLink, ViolationKind::SpecialPoint]
    );
    let special = [SpecialPoint {
        vertex: 77,
        link: LinkKind::Pinch.link().unwrap(),
    }];
    let options = CertificateOptions {
        special_points: &special,
        ..Default::default()
    };
    let kinds: Vec<_> = certify(&tetrahedron.mesh(), &options)
        .violations()
        .map(|v| v.kind)
        .collect();
    assert_eq!(kinds, [ViolationKind::SpecialPoint]);
    let options = CertificateOptions {
        admissible_links: &[LinkKind::Arc],
        ..Default::default()
    };
    let kinds: Vec<_> = certify(&tetrahedron.mesh(), &options)
        .violations()
        .map(|v| v.kind)
        .collect();
    assert_eq!(kinds, [ViolationKind::InadmissibleLink]);
}

/// The cone over a figure eight, a double line that ends in the origin.
#[test]
fn pinch_point() {
    let mut draft = Draft::default();
    draft.add(&[0., 0., 0.]);
    draft.add(&[0., 0., 3.]);
    for side in [1.0, -1.0] {
        let from = draft.places.len() as u32;
        for a in [35.0, 75.0, 110.0, 145.0] {
            let (s, c) = f64::to_radians(a).sin_cos();
            // a loop that leaves the double line and comes back to it
            let p = [side * 3.0 * s, 3.0 * c, 3.0 * (1.0 - s)];
            draft.add(&p);
        }
        let loop_ = [1, from, from + 1, from + 2, from + 3, 1];
        draft
            .triangles
            .extend(loop_.windows(2).map(|w| [0, w[0], w[1]]));
    }
    let draft = draft.mark(1).mark(4);
    let kinds = draft.kinds();
    assert!(kinds.contains(&ViolationKind::Pinch), "{kinds:?}");
    let special = [SpecialPoint {
        vertex: 0,
        link: LinkKind::Pinch.link().unwrap(),
    }];
    let options = CertificateOptions {
        special_points: &special,
        ..Default::default()
    };
    let c = certify(&draft.mesh(), &options);
    assert!(
        !c.violations().any(|v| v.kind == ViolationKind::Pinch),
        "{c}"
    );
}

#[test]
fn folds_and_flat_triangles() {
    let mut draft = plane(4).mark(1);
    // the corner triangle is folded back over its neighbor
    let tip =
        draft
            .triangles
            .iter()
            .flatten()
            .fold(BTreeMap::new(), |mut m: BTreeMap<u32, u32>, &v| {
                *m.entry(v).or_default() += 1;
                m
            });
    let tip = *tip.iter().find(|e| *e.1 == 1).unwrap().0;
    let t = *draft.triangles.iter().find(|t| t.contains(&tip)).unwrap();
    let others: Vec<usize> = t
        .iter()
        .filter(|&&v| v != tip)
        .map(|&v| v as usize)
        .collect();
    let (p, q) = (
        draft.places[others[0]].clone(),
        draft.places[others[1]].clone(),
    );
    let place = &mut draft.places[tip as usize];
    *place = (0..3).map(|k| p[k] + q[k] - place[k]).collect();
    place[0] += 0.1;
    place[2] = 0.05;
    let kinds = draft.kinds();
    assert!(kinds.contains(&ViolationKind::Fold), "{kinds:?}");

    let mut draft = plane(4).mark(1);
    let middle: Vec<f64> = (0..3)
        .map(|k| 0.5 * (draft.places[12][k] + draft.places[6][k]))
        .collect();
    draft.places[7] = middle;
    assert!(draft.kinds().contains(&ViolationKind::ZeroArea));
    let mut line = plane(1).mark(1);
    line.places[1] = vec![0.5, 0.75 * 0.5 + 0.375, 0.0];
    line.places[2] = vec![1.0, 1.5, 0.0];
    line.places[3] = vec![1.5, 2.25, 0.0];
    assert!(line.kinds().contains(&ViolationKind::ZeroArea));
    assert!(
        book(&[0.0, 1.0, 180.0, 181.0])
            .kinds()
            .contains(&ViolationKind::CurveFold)
    );
}

#[test]
fn stacked_layers() {
    for n in [3, 5, 24] {
        let layer = |gap: f64| {
            plane(6)
                .mark(1)
                .beside(&plane(6).mark(1).map(|p| vec![p[0] + 0.3, p[1], gap]))
        };
        let two = |gap| embed(layer(gap), n);
        let kinds = two(0.2).kinds();
        assert_eq!(kinds, [ViolationKind::Stacked], "dimension {n}");
        verified(&two(1.2));
    }
}

#[test]
fn undeclared_crossings() {
    let ball = icosphere(3);
    let moved = ball
        .clone()
        .map(|p| vec![p[0] + 1.1, p[1] + 0.03, p[2] - 0.02]);
    let kinds = ball.beside(&moved).kinds();
    assert!(
        kinds.contains(&ViolationKind::SelfIntersection),
        "{kinds:?}"
    );
    // two planes of R^4 that meet in one point inside two triangles
    let flat = plane(5).mark(1);
    let first = flat.clone().map(|p| vec![p[0] - 2.6, p[1] - 3.7, 0.0, 0.0]);
    let second = |up: f64| {
        flat.clone()
            .map(move |p| vec![up, 0.0, p[0] - 2.6, p[1] - 3.7])
    };
    assert_eq!(
        first.clone().beside(&second(0.0)).kinds(),
        [ViolationKind::NearCrossing]
    );
    verified(&first.clone().beside(&second(9.0)));
    let lifted = embed(first.beside(&second(0.0)), 11);
    assert_eq!(lifted.kinds(), [ViolationKind::NearCrossing]);
}

#[test]
fn cover_of_points() {
    let points = dense_sphere(20_000);
    let ball = icosphere(3);
    let separation = Some(0.12);
    let ask = |draft: &Draft| {
        let options = CertificateOptions {
            points: Some(&points),
            landmark_separation: separation,
            ..Default::default()
        };
        certify(&draft.mesh(), &options)
    };
    let c = ask(&ball);
    assert!(c.verdict().is_verified(), "{c}");
    let cover = c.cover.unwrap();
    assert!(cover.points_to_mesh.unwrap().max < 0.1 && cover.mesh_to_points.unwrap().max < 0.3);
    assert!(cover.point_gap < 0.5, "{}", cover.point_gap);

    // a declared hole of one star
    let mut holed = ball.clone();
    holed.triangles.retain(|t| !t.contains(&50));
    let all = holed.places.len() as u32 - 1;
    holed.places.swap(50, all as usize);
    holed.places.pop();
    holed
        .triangles
        .iter_mut()
        .flatten()
        .filter(|v| **v == all)
        .for_each(|v| *v = 50);
    let c = ask(&holed.mark(1));
    let kinds: Vec<_> = c.violations().map(|v| v.kind).collect();
    assert_eq!(kinds, [ViolationKind::UncoveredPoints], "{c}");
    assert!(c.violations().next().unwrap().coordinates.len() == 3);

    // a triangle far away
    let mut far = ball.clone();
    let corner: Vec<u32> = [[3., 0., 0.], [3., 0.15, 0.], [3., 0., 0.15]]
        .iter()
        .map(|p| far.add(p))
        .collect();
    far.triangles.push([corner[0], corner[1], corner[2]]);
    let kinds: Vec<_> = ask(&far.mark(1)).violations().map(|v| v.kind).collect();
    assert!(
        kinds.contains(&ViolationKind::MeshFarFromPoints),
        "{kinds:?}"
    );

    // a large triangle through the inside, with corners on the sphere
    let mut bridge = ball.clone();
    let corner: Vec<u32> = [0.1_f64, 2.2, 4.3]
        .iter()
        .map(|a| bridge.add(&[a.cos() * 0.99, a.sin() * 0.99, 0.01]))
        .collect();
    bridge.triangles.push([corner[0], corner[1], corner[2]]);
    let kinds: Vec<_> = ask(&bridge.mark(1)).violations().map(|v| v.kind).collect();
    assert!(
        kinds.contains(&ViolationKind::MeshFarFromPoints),
        "{kinds:?}"
    );

    // a shell 0.8 dl above the points, which are sparse
    let sparse = dense_sphere(1500);
    let shell = ball.clone().map(|p| p.iter().map(|x| x * 1.09).collect());
    let options = CertificateOptions {
        points: Some(&sparse),
        landmark_separation: separation,
        ..Default::default()
    };
    let kinds: Vec<_> = certify(&shell.mesh(), &options)
        .violations()
        .map(|v| v.kind)
        .collect();
    assert!(kinds.contains(&ViolationKind::MeshOffPoints), "{kinds:?}");
    assert!(certify(&ball.mesh(), &options).verdict().is_verified());
}

#[test]
fn landmarks_as_the_only_points() {
    let ball = icosphere(3);
    let points = ball.mesh().vertices;
    let options = CertificateOptions {
        points: Some(&points),
        ..Default::default()
    };
    let c = certify(&ball.mesh(), &options);
    assert!(c.verdict().is_verified(), "{c}");
}

#[test]
fn landmarks_left_out() {
    let mesh = icosphere(2).mesh();
    let unused = [4, 9];
    let options = CertificateOptions {
        unused_landmarks: &unused,
        ..Default::default()
    };
    let c = certify(&mesh, &options);
    let all: Vec<_> = c.violations().collect();
    assert_eq!(
        (all[0].kind, all[0].count),
        (ViolationKind::UnusedLandmarks, 2)
    );
    assert_eq!(all[0].places, [Place::Point(4), Place::Point(9)]);
}

#[test]
fn needles() {
    let mut draft = plane(3).mark(1);
    // an inner vertex next to one of its neighbors
    draft.places[5] = (0..3)
        .map(|k| 0.9995 * draft.places[9][k] + 0.0005 * draft.places[5][k])
        .collect();
    assert!(draft.kinds().contains(&ViolationKind::NeedleTriangle));
}

#[test]
fn nonsense_options_are_named() {
    let mesh = icosphere(0).mesh();
    for dl in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = CertificateOptions {
            landmark_separation: Some(dl),
            ..Default::default()
        };
        let c = certify(&mesh, &options);
        assert_eq!(c.violations().next().unwrap().kind, ViolationKind::Options);
    }
    let mut options = CertificateOptions::default();
    options.limits.fold = f64::NAN;
    assert!(certify(&mesh, &options).to_string().contains("fold is NaN"));
    let flat = PointCloud::new(2, vec![0.0; 4]).unwrap();
    let options = CertificateOptions {
        points: Some(&flat),
        ..Default::default()
    };
    assert_eq!(
        certify(&mesh, &options).violations().next().unwrap().kind,
        ViolationKind::Shape
    );
}

#[test]
fn the_report_reads_well() {
    let mut draft = icosphere(2);
    let good = draft.certificate().to_string();
    assert!(
        good.contains("162 circle") && good.ends_with("verified"),
        "{good}"
    );
    draft.triangles.remove(0);
    let bad = draft.certificate().to_string();
    assert!(
        bad.contains("3 ordinary edges with one triangle; first at edge"),
        "{bad}"
    );
    assert!(bad.contains("To change: "), "{bad}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Whatever the arrays say, there is a certificate and no panic.
    #[test]
    fn never_panics(
        n in 0_usize..8, dimension in 1_usize..5,
        triangles in proptest::collection::vec([0_u32..9, 0..9, 0..9], 0..12),
        curves in proptest::collection::vec(([0_u32..9, 0..9], 0_u8..6), 0..5),
        values in proptest::collection::vec(0_u8..4, 40),
        scale in prop_oneof![Just(1.0), Just(1e-200), Just(1e200)],
    ) {
        let rows = (0..n * dimension).map(|k| scale * f64::from(values[k % 40])).collect();
        let mesh = Mesh {
            complex: Complex {
                vertices: n,
                triangles,
                curve_edges: curves.into_iter().map(|(ends, cells)| CurveEdge { ends, cells }).collect(),
            },
            vertices: PointCloud::new(dimension, rows).unwrap(),
            point_index: vec![-1; n],
        };
        let points = mesh.vertices.clone();
        let options = CertificateOptions { points: Some(&points), ..Default::default() };
        let c = certify(&mesh, &options);
        prop_assert!(!c.to_string().is_empty());
    }

    /// A motion, a change of unit and another order of the vertices change nothing that counts.
    #[test]
    fn motion_and_scale_do_not_matter(angle in 0.0..6.0_f64, exponent in -6..6_i32, shift in -3.0..3.0_f64) {
        let scale = 10.0_f64.powi(exponent);
        let (s, c) = angle.sin_cos();
        let draft = two_spheres().map(|p| {
            vec![scale * (c * p[0] - s * p[1] + shift), scale * (s * p[0] + c * p[1]), scale * (p[2] - shift)]
        });
        let mut turned = draft.clone();
        let last = turned.places.len() as u32 - 1;
        turned.places.reverse();
        turned.triangles.iter_mut().flatten().for_each(|v| *v = last - *v);
        turned.curves.iter_mut().for_each(|e| *e = CurveEdge::new(last - e.ends[0], last - e.ends[1], e.cells));
        for d in [draft, turned] {
            let c = d.certificate();
            prop_assert!(c.verdict().is_verified(), "{}", c);
            prop_assert_eq!(c.links.unwrap().census[&LinkKind::Double], 24);
        }
    }
}
