use super::super::principal_places;
use super::*;
use crosscap_core::{Complex, CurveEdge};

/// A `wide` by `tall` sheet of triangles with diagonals of both directions, put into space by `place`.
fn sheet(wide: usize, tall: usize, place: impl Fn(f64, f64) -> Vec<f64>) -> Mesh {
    let at = |i: usize, j: usize| (i * tall + j) as u32;
    let mut triangles = Vec::new();
    let mut coordinates = Vec::new();
    let mut dimension = 0;
    for i in 0..wide {
        for j in 0..tall {
            let p = place(i as f64, j as f64);
            dimension = p.len();
            coordinates.extend(p);
            if i + 1 < wide && j + 1 < tall {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if (i + j) % 2 == 0 {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
    }
    let count = wide * tall;
    Mesh::new(
        Complex::new(count, triangles, vec![]).unwrap(),
        PointCloud::new(dimension, coordinates).unwrap(),
        vec![-1; count],
    )
    .unwrap()
}

/// Largest difference between distances in `places` and in the plane of the parameters, over the width.
fn worst(mesh: &Mesh, places: &PointCloud<f64>, tall: usize) -> f64 {
    let n = mesh.complex.vertices;
    let flat = |k: usize| [(k / tall) as f64, (k % tall) as f64];
    let mut worst = 0.0_f64;
    for a in (0..n).step_by(7) {
        for b in (0..n).step_by(11) {
            let d = crosscap_core::squared_distance(&flat(a), &flat(b)).sqrt();
            worst = worst.max((places.squared_distance(a, b).sqrt() - d).abs());
        }
    }
    worst / (n / tall) as f64
}

fn tilted(u: f64, v: f64) -> Vec<f64> {
    let (s, c) = (0.6, 0.8);
    vec![s * u, c * u, 0.0, c * v, -s * v + 40.0]
}

#[test]
fn a_flat_grid_comes_back_up_to_motion() {
    let mesh = sheet(30, 20, tilted);
    let p = principal_places(&mesh.vertices, 3).unwrap();
    assert!(worst(&mesh, &p.places, 20) < 1e-9);
    // With an edge between every two vertices the ways are straight: exact but for rounding.
    let all = (0..600)
        .step_by(5)
        .flat_map(|a| (0..a).step_by(5).map(move |b| CurveEdge::new(a, b, 0)))
        .collect();
    let complete = Mesh::new(
        Complex::new(600, vec![], all).unwrap(),
        mesh.vertices.clone(),
        mesh.point_index.clone(),
    )
    .unwrap();
    let e = isomap_places(&complete, 3, &IsomapOptions::default()).unwrap();
    for a in (0..600).step_by(5) {
        for b in (0..a).step_by(5) {
            let d = mesh.vertices.squared_distance(a, b).sqrt();
            assert!((e.places.squared_distance(a, b).sqrt() - d).abs() < 1e-6);
        }
    }
    // Ways along the edges of a grid are up to 8 % longer than straight ones, by direction.
    let e = isomap_places(&mesh, 3, &IsomapOptions::default()).unwrap();
    assert!(worst(&mesh, &e.places, 20) < 0.12);
    assert!(e.residual_variance < 0.006, "{}", e.residual_variance);
    let energy = |axis: usize| e.places.iter().map(|p| p[axis] * p[axis]).sum::<f64>();
    assert!(energy(2) < 0.1 * energy(1), "{}", energy(2) / energy(1));
}

#[test]
fn a_path_comes_back_exactly() {
    let edges = (0..9).map(|k| CurveEdge::new(k, k + 1, 0)).collect();
    let coordinates = (0..10)
        .flat_map(|k| [(k as f64).cos(), (k as f64).sin()])
        .collect();
    let mesh = Mesh::new(
        Complex::new(10, vec![], edges).unwrap(),
        PointCloud::new(2, coordinates).unwrap(),
        vec![-1; 10],
    )
    .unwrap();
    let step = mesh.vertices.squared_distance(0, 1).sqrt();
    let e = isomap_places(&mesh, 3, &IsomapOptions { landmarks: 4 }).unwrap();
    for k in 0..10 {
        let d = e.places.squared_distance(0, k).sqrt();
        assert!((d - step * k as f64).abs() < 1e-9);
    }
    assert!(e.residual_variance < 1e-9);
}

#[test]
fn a_swiss_roll_is_unrolled() {
    // Arc length along the spiral r = a t, so that (u, v) are the flat coordinates.
    let roll = |u: f64, v: f64| {
        let a = 2.0;
        let mut t = 4.0_f64;
        let length = |t: f64| a / 2.0 * (t * (1.0 + t * t).sqrt() + t.asinh());
        let goal = length(4.0) + u;
        for _ in 0..40 {
            t -= (length(t) - goal) / (a * (1.0 + t * t).sqrt());
        }
        vec![a * t * t.cos(), v, a * t * t.sin(), 0.0]
    };
    let mesh = sheet(90, 14, roll);
    let rolled = principal_places(&mesh.vertices, 3).unwrap();
    let unrolled = isomap_places(&mesh, 3, &IsomapOptions { landmarks: 120 }).unwrap();
    assert!(worst(&mesh, &rolled.places, 14) > 0.5);
    assert!(worst(&mesh, &unrolled.places, 14) < 0.15);
    assert!(unrolled.residual_variance < 0.006);
    // Along the roll the order of the vertices is kept, from end to end.
    let along: Vec<f64> = (0..90)
        .map(|i| unrolled.places.point(i * 14 + 7)[0])
        .collect();
    let steps = || along.windows(2).map(|w| w[1] - w[0]);
    assert!(steps().all(|s| s > 0.5) || steps().all(|s| s < -0.5));
}

#[test]
fn components_stand_apart() {
    let mut mesh = sheet(6, 5, |u, v| vec![u, v]);
    let more = sheet(4, 4, |u, v| vec![u, v]);
    let shift = mesh.complex.vertices as u32;
    let mut triangles = mesh.complex.triangles.clone();
    triangles.extend(more.complex.triangles.iter().map(|t| t.map(|v| v + shift)));
    let mut coordinates = mesh.vertices.coordinates().to_vec();
    coordinates.extend_from_slice(more.vertices.coordinates());
    coordinates.extend([0.0, 0.0, 0.0, 0.0]);
    let count = coordinates.len() / 2;
    mesh = Mesh::new(
        Complex::new(count, triangles, vec![]).unwrap(),
        PointCloud::new(2, coordinates).unwrap(),
        vec![-1; count],
    )
    .unwrap();
    let e = isomap_places(&mesh, 3, &IsomapOptions::default()).unwrap();
    assert_eq!(e.components, 4);
    let parts = [0..30, 30..46, 46..47, 47..48];
    for (k, a) in parts.iter().enumerate() {
        for b in &parts[..k] {
            for i in a.clone() {
                for j in b.clone() {
                    assert!(e.places.squared_distance(i, j) > 0.05);
                }
            }
        }
    }
}

#[test]
fn degenerate_meshes_are_laid_out() {
    let empty = Mesh::new(
        Complex::default(),
        PointCloud::new(3, vec![]).unwrap(),
        vec![],
    )
    .unwrap();
    let e = isomap_places(&empty, 3, &IsomapOptions::default()).unwrap();
    assert!(e.places.is_empty());
    // All vertices in one place, and places at the end of the range.
    for size in [0.0, 1e300] {
        let mesh = sheet(3, 3, |u, v| vec![u * size, v * size]);
        let e = isomap_places(&mesh, 3, &IsomapOptions::default()).unwrap();
        assert!(e.places.coordinates().iter().all(|c| c.is_finite()));
    }
    assert!(isomap_places(&empty, 0, &IsomapOptions::default()).is_err());
    assert!(isomap_places(&empty, 3, &IsomapOptions { landmarks: 0 }).is_err());
}

#[test]
fn the_same_mesh_gives_the_same_places() {
    let mesh = sheet(12, 9, |u, v| vec![u, v, (u * 0.5).sin(), (v * 0.4).cos()]);
    let options = IsomapOptions { landmarks: 25 };
    assert_eq!(
        isomap_places(&mesh, 3, &options).unwrap(),
        isomap_places(&mesh, 3, &options).unwrap()
    );
}

#[test]
#[ignore = "measures time: 15,000 vertices in R^24"]
fn fifteen_thousand_vertices() {
    let mesh = sheet(150, 100, |u, v| {
        (0..24)
            .map(|k| ((u * 0.02 * (k + 1) as f64).sin() + (v * 0.03).cos()) * 3.0 + u * 0.1)
            .collect()
    });
    let start = std::time::Instant::now();
    let e = isomap_places(&mesh, 3, &IsomapOptions::default()).unwrap();
    println!(
        "{:?}, residual variance {}",
        start.elapsed(),
        e.residual_variance
    );
}
