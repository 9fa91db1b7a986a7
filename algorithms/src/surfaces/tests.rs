//! The catalogue against what it says about itself.

use super::*;
use crosscap_core::PointCloud;
use std::f64::consts::TAU;

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[test]
fn names_are_unique_and_found() {
    let all = catalogue();
    assert_eq!(all.iter().filter(|s| s.paper().is_some()).count(), 9);
    let mut names: Vec<String> = Vec::new();
    for surface in &all {
        for name in std::iter::once(&surface.name()).chain(surface.aliases()) {
            assert_eq!(SampleSurface::find(name).unwrap().name(), surface.name());
            names.push((*name).into());
        }
    }
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    assert_eq!(
        SampleSurface::find("Two-Spheres").unwrap().name(),
        "two_spheres"
    );
    let error = SampleSurface::find("dodecahedron").err().unwrap();
    assert!(error.is_input() && error.to_string().contains("henneberg"));
}

#[test]
fn truth_is_consistent() {
    for s in catalogue() {
        let t = s.truth();
        let euler = |b: [usize; 3]| b[0] as i64 - b[1] as i64 + b[2] as i64;
        assert_eq!(euler(t.betti), euler(t.betti_mod_2), "{}", s.name());
        assert_eq!(t.pieces.len(), s.pieces().len(), "{}", s.name());
        let rims: usize = s.pieces().iter().map(|p| p.rims().len()).sum();
        let boundaries: usize = t.pieces.iter().map(|p| p.boundaries).sum();
        assert_eq!(rims, boundaries, "{}", s.name());
        assert_eq!(
            s.boundary_curves(10).len(),
            t.boundary_curves,
            "{}",
            s.name()
        );
        assert_eq!(s.triple_points().len(), t.triple_points, "{}", s.name());
        if let Some(curves) = s.singular_curves(10) {
            let of = |kind| curves.iter().filter(|c| c.kind == kind).count();
            assert_eq!(of(CurveKind::Double), t.double_curves, "{}", s.name());
            assert_eq!(of(CurveKind::Junction), t.junction_curves, "{}", s.name());
            assert_eq!(of(CurveKind::Crease), t.creases, "{}", s.name());
            assert_eq!(curves.len(), t.curves(), "{}", s.name());
        }
        // Even torsion of the first homology shows up once in each of two groups mod 2.
        assert_eq!(t.betti[1] + t.torsion.len(), t.betti_mod_2[1]);
        if let Some(paper) = s.paper() {
            assert_eq!(paper.betti, t.betti);
        }
    }
}

/// Euler characteristic of the immersed surface from that of its pieces: a place with k sheets is
/// counted k times before gluing.
#[test]
fn euler_characteristic_follows_from_the_strata() {
    let of_whole_sheets = |s: &&SampleSurface| {
        let t = s.truth();
        t.books + t.creases == 0
            && (t.junction_curves == 0 || s.boundary_curves(2).is_empty())
            && s.points()
                .iter()
                .all(|p| p.kind != PointKind::QuadrupleJunction)
            && s.pieces().iter().all(|p| p.dimension() == 2)
    };
    for s in catalogue().iter().filter(of_whole_sheets) {
        let t = s.truth();
        let abstract_euler: i64 = t.pieces.iter().map(|p| p.euler).sum();
        // Arcs end on the boundary, at places with two sheets, or in pinch points, with one; triple points cut
        // curves into arcs.
        let curves = s.singular_curves(2).unwrap_or_default();
        let open = curves.iter().filter(|c| !c.closed).count() as i64;
        let arcs = open + 3 * t.triple_points as i64;
        let open_ends = 2 * open - t.pinch_points as i64;
        let glued = arcs - open_ends - 2 * t.triple_points as i64 - t.isolated_crossings as i64;
        assert_eq!(
            t.betti[0] as i64 - t.betti[1] as i64 + t.betti[2] as i64,
            abstract_euler + glued,
            "{}",
            s.name()
        );
    }
}

#[test]
fn samples_lie_on_the_surface() {
    for s in catalogue() {
        let mut sampling = Sampling::new(400, 5);
        sampling.boundary = true;
        for law in [SamplingLaw::Area, SamplingLaw::Parameters] {
            sampling.law = law;
            let sample = s.sample(&sampling).unwrap();
            let off = largest(&s.distances(&sample.points).unwrap());
            assert!(off < 1e-9, "{}: {off:e}", s.name());
            // Parameters and labels belong to the points.
            for k in 0..sample.points.len() {
                let piece = s.pieces()[sample.pieces[k] as usize].as_ref();
                let place = place_at(piece, sample.parameters[k]);
                for (x, y) in place.iter().zip(sample.points.point(k)) {
                    assert!((x - y).abs() < 1e-9, "{}", s.name());
                }
            }
            assert_eq!(
                sample.boundary.is_empty(),
                !s.has_boundary(),
                "{}",
                s.name()
            );
            assert_eq!(sample.points.len(), 400 + sample.boundary.len());
        }
    }
}

#[test]
fn distances_off_the_surface_agree_with_a_dense_sample() {
    for s in catalogue() {
        let dense = s.sample(&Sampling::new(40_000, 1)).unwrap().points;
        let mut noisy = Sampling::new(12, 2);
        noisy.noise = 0.02 * s.area().sqrt();
        let places = s.sample(&noisy).unwrap().points;
        let spacing = (s.area() / 40_000.0).sqrt();
        for (place, &found) in places.iter().zip(&s.distances(&places).unwrap()) {
            let nearest = dense
                .iter()
                .map(|p| crosscap_core::squared_distance(p, place))
                .fold(f64::INFINITY, f64::min)
                .sqrt();
            // The nearest sample is at most a few spacings aside of the nearest place.
            let beside = 5.0 * spacing;
            assert!(
                found <= nearest + 1e-9
                    && nearest * nearest <= found * found * 1.5 + 2.0 * beside * beside,
                "{}: {found} against {nearest}, spacing {spacing}",
                s.name()
            );
        }
    }
}

/// Chi-square over bins of the parameters whose shares are known from the area element.
#[test]
fn samples_are_uniform_by_area() {
    const BINS: usize = 8;
    const FINE: usize = 16;
    for s in catalogue() {
        let count = 40_000;
        let sample = s.sample(&Sampling::new(count, 11)).unwrap();
        let mut found = vec![[[0.0; BINS]; BINS]; s.pieces().len()];
        for (at, &k) in sample.parameters.iter().zip(&sample.pieces) {
            let domain = s.pieces()[k as usize].domain();
            let bin = |a: usize| {
                let [low, high] = domain[a];
                if high > low {
                    (((at[a] - low) / (high - low) * BINS as f64) as usize).min(BINS - 1)
                } else {
                    0
                }
            };
            found[k as usize][bin(0)][bin(1)] += 1.0;
        }
        let mut chi_square = 0.0;
        let mut bins = 0.0;
        let mut place = vec![Jet::default(); s.ambient_dimension()];
        let on_segments = |k: &&u32| s.pieces()[**k as usize].dimension() == 1;
        let segment = sample.pieces.iter().filter(on_segments).count();
        for (piece, found) in s
            .pieces()
            .iter()
            .zip(&found)
            .filter(|(p, _)| p.dimension() == 2)
        {
            let [[a, b], [c, d]] = piece.domain();
            let cell = (b - a) * (d - c) / ((BINS * FINE) as f64).powi(2);
            for (i, row) in found.iter().enumerate() {
                for (j, &found) in row.iter().enumerate() {
                    let mut area = 0.0;
                    for k in 0..FINE * FINE {
                        let u = a
                            + (b - a) * ((i * FINE + k / FINE) as f64 + 0.5) / (BINS * FINE) as f64;
                        let v = c
                            + (d - c) * ((j * FINE + k % FINE) as f64 + 0.5) / (BINS * FINE) as f64;
                        if piece.holds([u, v]) {
                            piece.map([Jet::first(u), Jet::second(v)], &mut place);
                            area += cell * area_element(&place);
                        }
                    }
                    let expected = (count - segment) as f64 * area / s.area();
                    if expected > 5.0 {
                        chi_square += (found - expected).powi(2) / expected;
                        bins += 1.0;
                    } else {
                        assert!(found <= 30.0, "{}: {found} against {expected}", s.name());
                    }
                }
            }
        }
        // Mean bins, variance 2 bins: four standard deviations.
        assert!(
            chi_square < bins + 4.0 * (2.0f64 * bins).sqrt(),
            "{}: {chi_square} in {bins}",
            s.name()
        );
    }
}

#[test]
fn singular_curves_lie_on_both_sheets() {
    for s in catalogue() {
        let Some(curves) = s.singular_curves(50) else {
            continue;
        };
        for curve in curves {
            // A plate stands on the middle of another one: three cells, two pieces.
            let sheets = match curve.kind {
                CurveKind::Junction if s.pieces().len() > 2 => 3,
                CurveKind::Book { cells } => cells.into(),
                _ => 2,
            };
            let distances: Vec<Vec<f64>> = s
                .pieces()
                .iter()
                .map(|p| p.distances(&curve.points))
                .collect();
            // A single sheet may meet itself, whatever curves there are beside it.
            let several = s.pieces().iter().filter(|p| p.dimension() == 2).count() > 1;
            for k in 0..curve.points.len() {
                let touched = distances.iter().filter(|d| d[k] < 1e-9).count();
                assert!(touched >= if several { sheets } else { 1 }, "{}", s.name());
            }
        }
    }
    // One piece that meets itself: different parameters, one place, different tangent planes.
    let klein = KleinFigureEight::immersed();
    for k in 0..20 {
        let t = TAU * f64::from(k) / 20.0;
        assert_same_place_other_tangent(&klein, [t, 0.0], [t, TAU / 2.0]);
        let r = 0.4 + 0.2 * f64::from(k) / 19.0;
        for [a, b] in Henneberg::double_parameters(r) {
            assert_same_place_other_tangent(&Henneberg, a, b);
        }
    }
}

fn assert_same_place_other_tangent(piece: &dyn Piece, a: [f64; 2], b: [f64; 2]) {
    let normal = |at: [f64; 2]| {
        let mut p = [Jet::default(); 3];
        piece.map([Jet::first(at[0]), Jet::second(at[1])], &mut p);
        let n = super::round::cross(p.map(|j| j.by_first), p.map(|j| j.by_second));
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        (p.map(|j| j.value), n.map(|x| x / length))
    };
    let ((p, m), (q, n)) = (normal(a), normal(b));
    assert!(
        (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9),
        "{} {a:?} {b:?}",
        piece.name()
    );
    let cosine: f64 = (0..3).map(|k| m[k] * n[k]).sum();
    assert!(cosine.abs() < 0.99, "{} {a:?} {b:?}", piece.name());
}

#[test]
fn triple_points_lie_on_three_sheets() {
    let s = SampleSurface::find("three_spheres").unwrap();
    for p in s.triple_points() {
        let place = PointCloud::new(3, p.clone()).unwrap();
        assert!(
            s.pieces()
                .iter()
                .all(|piece| piece.distances(&place)[0] < 1e-12)
        );
    }
}

#[test]
fn boundary_points_have_the_density_of_the_rest() {
    for s in catalogue().iter().filter(|s| s.has_boundary()) {
        let mut sampling = Sampling::new(3000, 1);
        sampling.boundary = true;
        sampling.thinning = Some(0.5 * (s.area() / 3000.0).sqrt());
        let sample = s.sample(&sampling).unwrap();
        let count = sample.points.len() - sample.boundary.len();
        assert!(count < 3000);
        let mut length = 0.0;
        for curve in s.boundary_curves(4000) {
            for k in 0..4000 {
                length += curve.points.squared_distance(k, (k + 1) % 4000).sqrt();
            }
        }
        let expected = length / (0.9 * (s.area() / count as f64).sqrt());
        let found = sample.boundary.len() as f64;
        assert!(
            (found - expected).abs() < 3.0,
            "{}: {found} {expected}",
            s.name()
        );
        let rims = sample.points.select(&sample.boundary);
        let truth: Vec<f64> = s
            .boundary_curves(2000)
            .iter()
            .flat_map(|c| c.points.coordinates().to_vec())
            .collect();
        let truth = PointCloud::new(s.ambient_dimension(), truth).unwrap();
        let step = length / 2000.0;
        for p in rims.iter() {
            let near = truth
                .iter()
                .any(|q| crosscap_core::squared_distance(p, q) < step * step);
            assert!(near, "{}", s.name());
        }
    }
}

#[test]
fn same_seed_same_points() {
    for name in [
        "sphere",
        "double_torus",
        "klein_immersion",
        "moebius",
        "line_disc",
    ] {
        let s = SampleSurface::find(name).unwrap();
        let mut sampling = Sampling::new(300, 9);
        (sampling.boundary, sampling.noise, sampling.thinning) = (true, 0.01, Some(0.02));
        assert_eq!(s.sample(&sampling).unwrap(), s.sample(&sampling).unwrap());
        let other = Sampling {
            seed: 10,
            ..sampling
        };
        assert_ne!(s.sample(&sampling).unwrap(), s.sample(&other).unwrap());
    }
}

/// Numbers of points that the paper prints after thinning.
#[test]
fn thinned_counts_are_those_of_the_paper() {
    for s in catalogue() {
        let Some(count) = s.paper().and_then(|p| p.count_after_thinning) else {
            continue;
        };
        let found = s
            .sample(&Sampling {
                boundary: false,
                ..s.default_sampling(1)
            })
            .unwrap()
            .points
            .len();
        let share = found as f64 / count as f64;
        // Henneberg's printed number is above what 100,000 points can give, by area or by parameters:
        // greedy thinning reaches it from about 400,000.
        let range = if s.name() == "henneberg" {
            0.85..0.95
        } else {
            0.95..1.05
        };
        assert!(
            range.contains(&share),
            "{}: {found} against {count}",
            s.name()
        );
    }
}

#[test]
fn noise_has_the_deviation_asked_for() {
    let s = SampleSurface::find("square").unwrap();
    let sample = s
        .sample(&Sampling {
            noise: 0.05,
            ..Sampling::new(20_000, 4)
        })
        .unwrap();
    let square: f64 = sample.points.iter().map(|p| p[2] * p[2]).sum::<f64>() / 20_000.0;
    assert!((square.sqrt() - 0.05).abs() < 0.001);
}

#[test]
fn refuses_parameters_without_meaning() {
    let s = SampleSurface::find("sphere").unwrap();
    let good = Sampling::new(10, 0);
    for bad in [
        Sampling { count: 0, ..good },
        Sampling {
            noise: -1.0,
            ..good
        },
        Sampling {
            noise: f64::NAN,
            ..good
        },
        Sampling {
            thinning: Some(0.0),
            ..good
        },
        Sampling {
            thinning: Some(f64::NAN),
            ..good
        },
    ] {
        assert!(s.sample(&bad).unwrap_err().is_input(), "{bad:?}");
    }
    assert!(
        s.distances(&PointCloud::new(2, vec![0.0; 2]).unwrap())
            .is_err()
    );
}

/// Alexander duality: a compact set in space has as many independent 2-cycles as its complement has
/// bounded components. Counted on a grid whose cells near the surface are taken out.
#[test]
fn enclosed_regions_are_as_many_as_the_second_betti_number() {
    for (name, count, side) in [
        ("three_spheres", 200_000, 64),
        ("double_bubble", 200_000, 64),
        ("foam", 200_000, 56),
        ("torus_sphere", 400_000, 80),
        ("two_tori", 600_000, 100),
        ("klein_immersion", 400_000, 80),
        ("roman", 200_000, 56),
        ("cross_cap", 200_000, 56),
        ("cone", 100_000, 40),
        ("cube_with_hole", 200_000, 48),
        ("boy_surface", 600_000, 72),
        ("double_torus", 200_000, 56),
    ] {
        let s = SampleSurface::find(name).unwrap();
        let points = s.sample(&Sampling::new(count, 3)).unwrap().points;
        assert_eq!(
            bounded_components(&points, side),
            s.truth().betti[2],
            "{name}"
        );
    }
}

fn bounded_components(points: &PointCloud<f64>, side: usize) -> usize {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points.iter() {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    let step = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max) / (side - 4) as f64;
    let mut full = vec![false; side * side * side];
    for p in points.iter() {
        let [x, y, z] = [0, 1, 2].map(|k| ((p[k] - low[k]) / step) as usize + 2);
        full[(x * side + y) * side + z] = true;
    }
    let mut components = 0;
    for start in 0..full.len() {
        if full[start] {
            continue;
        }
        // Slivers between cells that happen to be full are no regions.
        let mut size = 0;
        let mut stack = vec![start];
        full[start] = true;
        while let Some(at) = stack.pop() {
            size += 1;
            let place = [at / side / side, at / side % side, at % side];
            for (k, stride) in [side * side, side, 1].into_iter().enumerate() {
                for next in [
                    (place[k] > 0).then(|| at - stride),
                    (place[k] + 1 < side).then(|| at + stride),
                ]
                .into_iter()
                .flatten()
                {
                    if !full[next] {
                        full[next] = true;
                        stack.push(next);
                    }
                }
            }
        }
        components += usize::from(size > 20);
    }
    components - 1
}
