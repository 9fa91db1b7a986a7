//! `crosscap check`.

use crate::room::{Room, ball, mesh, octahedron, two_spheres};
use crosscap_algorithms::surfaces::{Drawing, Feature, Random};
use crosscap_backends::files::{read_mesh, write_mesh, write_points};
use crosscap_core::{CurveEdge, PointCloud};
use std::f64::consts::TAU;

#[test]
fn neighborhoods_are_checked_one_by_one() {
    let room = Room::new();
    room.run("sample sphere -n 4000 --seed 1 -o sphere.npy")
        .expect(0);
    room.run("reconstruct sphere.npy -o sphere.npz --eps 0.4 --dl 0.2 --surface")
        .expect(0);
    room.run("check sphere.npz --local")
        .expect(0)
        .says("of radius 0.4")
        .says("all have Betti numbers 1, 0, 0");
    // A ball that holds all of the sphere but a cap is contractible still; one that holds all of it is not.
    room.run("check sphere.npz --local --eps 2.1")
        .expect(1)
        .says("1, 0, 1 over Q")
        .says("first at vertex 0 (point")
        .says("a smaller --eps")
        .complains("neighborhoods that are not contractible");
    let found = room
        .run("check sphere.npz --local --eps 2.1 --json")
        .expect(1)
        .json();
    assert_eq!(found["verified"], false);
    let failures = found["local"]["failures"].as_array().unwrap();
    assert_eq!(
        failures.len() as u64,
        found["local"]["neighborhoods"].as_u64().unwrap()
    );
    room.run("check sphere.npz --local --eps 0.05")
        .expect(2)
        .complains("is not above the median edge");
    room.run("check sphere.npz --eps 0.4")
        .expect(2)
        .complains("--local");
    room.mesh("bare.npz", &octahedron());
    room.run("check bare.npz --local")
        .expect(2)
        .complains("give --eps");
}

#[test]
fn junctions_and_bare_curves_are_described() {
    // Three caps on one circle, and a line through the middle one.
    let n = 12u32;
    let mut places = Vec::new();
    let mut triangles = Vec::new();
    for k in 0..n {
        let (s, c) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        places.extend([c, s, 0.0]);
    }
    for (cap, top) in [(0, 1.0), (1, 0.0), (2, -1.0)] {
        for k in 0..n {
            let (s, c) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            places.extend([0.6 * c, 0.6 * s, 0.7 * top]);
            let ring = |k: u32| n + cap * (n + 1) + k % n;
            let (p, q) = (k, (k + 1) % n);
            triangles.extend([[p, q, ring(k)], [q, ring(k), ring(k + 1)]]);
            triangles.push([ring(k), ring(k + 1), n + cap * (n + 1) + n]);
        }
        places.extend([0.0, 0.0, top]);
    }
    let middle = n + (n + 1) + n;
    let line = places.len() as u32 / 3;
    places.extend([0.0, 0.0, 0.3, 0.0, 0.0, -0.3]);
    let mut curves: Vec<CurveEdge> = (0..n).map(|k| CurveEdge::new(k, (k + 1) % n, 3)).collect();
    curves.extend([
        CurveEdge::new(middle, line, 0),
        CurveEdge::new(middle, line + 1, 0),
    ]);
    let room = Room::new();
    room.mesh("bubble.npz", &mesh(3, places, triangles, curves));
    let said = room.run("check bubble.npz --closed").expect(0).out;
    assert!(
        said.contains("end in one circle of three cells (angles"),
        "{said}"
    );
    assert!(
        said.contains("One bare arc goes through disc 2 in one point."),
        "{said}"
    );
    assert!(said.contains("1, 0, 2 over Q"), "{said}");
}

#[test]
fn a_good_mesh_is_verified() {
    let room = Room::new();
    room.mesh("sphere.npz", &octahedron());
    room.run("check sphere.npz")
        .expect(0)
        .says("1, 0, 1 over Q")
        .says("One sphere.")
        .says("verified");
    room.mesh("spheres.npz", &two_spheres(12));
    let found = room.run("check spheres.npz --json").expect(0).json();
    assert_eq!(found["verified"], true);
    assert_eq!(found["orientable"], true);
    assert_eq!(
        found["homology"]["betti_rational"],
        serde_json::json!([1, 0, 3])
    );
    assert_eq!(found["homology"]["torsion"], serde_json::json!([]));
    assert_eq!(found["certificate"]["edges"]["by_triangles"]["4"], 12);
    assert_eq!(found["certificate"]["links"]["census"]["double"], 12);
    assert_eq!(found["pieces"]["pieces"].as_array().unwrap().len(), 2);
    assert_eq!(found["pieces"]["curves"][0]["circle"], true);
    assert!(
        found["certificate"]["quality"]["min_angle"]["min"]
            .as_f64()
            .unwrap()
            > 5.0
    );
}

#[test]
fn torsion_and_one_sidedness_are_told() {
    // The projective plane on six vertices, in general position in R^5.
    let triangles = vec![
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 1, 5],
        [1, 2, 4],
        [2, 4, 5],
        [2, 3, 5],
        [1, 3, 5],
        [1, 3, 4],
    ];
    let mut places = vec![0.0; 30];
    (1..6).for_each(|k| places[5 * k + k - 1] = 1.0);
    let room = Room::new();
    room.mesh("plane.npz", &mesh(5, places, triangles, vec![]));
    let found = room.run("check plane.npz --json").json();
    assert_eq!(
        found["homology"]["betti_rational"],
        serde_json::json!([1, 0, 0])
    );
    assert_eq!(
        found["homology"]["betti_mod2"],
        serde_json::json!([1, 1, 1])
    );
    assert_eq!(found["homology"]["torsion"], serde_json::json!(["2"]));
    assert_eq!(found["orientable"], false);
}

#[test]
fn a_broken_mesh_is_refused_with_place_and_advice() {
    let room = Room::new();
    let whole = octahedron();
    let holed = mesh(
        3,
        whole.vertices.coordinates().to_vec(),
        whole.complex.triangles[1..].to_vec(),
        vec![],
    );
    room.mesh("hole.npz", &holed);
    room.run("check hole.npz")
        .expect(1)
        .says("first at edge")
        .says("To change:")
        .complains("hole.npz: not verified");
    let found = room.run("check hole.npz --json").expect(1).json();
    assert_eq!(found["verified"], false);
    let kinds = found["certificate"]["edges"]["violations"]
        .as_array()
        .unwrap();
    assert!(!kinds.is_empty());
}

#[test]
fn points_count_in_a_check() {
    let room = Room::new();
    room.mesh("sphere.npz", &octahedron());
    let mut points = octahedron().vertices.coordinates().to_vec();
    write_points(
        room.path("near.csv"),
        &PointCloud::new(3, points.clone()).unwrap(),
    )
    .unwrap();
    points.extend([9.0, 9.0, 9.0]);
    write_points(room.path("far.csv"), &PointCloud::new(3, points).unwrap()).unwrap();
    room.run("check sphere.npz --points near.csv --dl 1.4")
        .expect(0);
    room.run("check sphere.npz --points far.csv --dl 1.4")
        .expect(1)
        .says("input points far from the mesh");
    room.write("plane.csv", "0,0\n1,0\n");
    room.run("check sphere.npz --points plane.csv")
        .expect(2)
        .complains("plane.csv: found points in R^2, expected R^3");
}

/// Where landmarks follow the spacing of the points, so does the check: a mesh that was verified is verified again.
#[test]
fn a_check_measures_in_the_lengths_that_a_mesh_was_made_with() {
    let room = Room::new();
    let drawing = Drawing {
        count: 800,
        size: 8.3,
        ratio: 20.0,
        noise: 0.0,
        seed: 5,
    };
    let cloud = Feature::find("small-part").unwrap().draw(&drawing).unwrap();
    write_points(room.path("p.npy"), &cloud.points).unwrap();
    let dl = 1.7 * cloud.spacing;
    let lengths = format!("--eps {} --dl {dl}", 2.0 * dl);
    let spaced = "--metric conformal --graph-k 20 --surface --models two-planes";
    room.run(&format!("reconstruct p.npy -o m.npz {lengths} {spaced}"))
        .expect(0)
        .says("Two spheres");
    room.run("check m.npz --points p.npy").expect(0);
    // One separation everywhere is what the mesh was not made with.
    room.run(&format!("check m.npz --points p.npy --dl {dl}"))
        .expect(1)
        .says("input points far from the mesh");
}

/// A sphere of radius 1 with noise of half a spacing, and outliers, one in a hundred.
fn noisy_sphere() -> PointCloud<f64> {
    let random = &mut Random::new(8);
    let mut rows = Vec::new();
    for place in ball(2000).iter() {
        let norm = place.iter().map(|x| x * x).sum::<f64>().sqrt();
        let far = (1.0 + 0.04 * random.normal()) / norm;
        rows.extend(place.iter().map(|x| far * x));
    }
    rows.extend((0..60).map(|_| random.between(-2.0, 2.0)));
    PointCloud::new(3, rows).unwrap()
}

/// What a run found out about noise and outliers a check finds out again: the mesh is verified, and a wrong one is not.
#[test]
fn a_mesh_of_noisy_points_is_verified_again_and_a_wrong_one_refused() {
    let room = Room::new();
    let points = noisy_sphere();
    write_points(room.path("p.npy"), &points).unwrap();
    room.run("reconstruct p.npy -o m.npz")
        .expect(0)
        .says("points moved onto fits")
        .says("outliers");
    room.run("check m.npz --points p.npy")
        .expect(0)
        .says("points moved onto fits")
        .says("left out");
    // A file that does not tell how it was made is judged as that of a run without parameters.
    room.run("convert m.npz m.ply").expect(0);
    room.run("check m.ply --points p.npy").expect(0);
    room.run("check m.npz --points p.npy --prepare no")
        .expect(1)
        .says("input points far from the mesh");

    // A cap is missing from the points: 11 spacings across.
    let open: Vec<usize> = (0..points.len())
        .filter(|&row| points.point(row)[2] < 0.9 || row >= 2000)
        .collect();
    write_points(room.path("open.npy"), &points.select(&open)).unwrap();
    room.run("check m.npz --points open.npy")
        .expect(1)
        .says("points moved onto fits")
        .says("gaps of the points that the mesh covers");
    // The mesh is four times as far off as the points scatter, and more.
    let mut file = read_mesh(room.path("m.npz")).unwrap();
    let larger = file.mesh.vertices.coordinates().iter().map(|x| 1.5 * x);
    file.mesh.vertices = PointCloud::new(3, larger.collect()).unwrap();
    write_mesh(room.path("large.npz"), &file.mesh, &file.extras, None).unwrap();
    room.run("check large.npz --points p.npy").expect(1);
}

#[test]
fn crossings_are_taken_apart() {
    let room = Room::new();
    room.mesh("spheres.npz", &two_spheres(12));
    room.run("check spheres.npz --normalization apart.npz")
        .expect(0);
    let apart = read_mesh(room.path("apart.npz")).unwrap();
    assert_eq!(
        apart.mesh.complex.vertices,
        two_spheres(12).complex.vertices + 12
    );
    assert!(apart.mesh.complex.curve_edges.is_empty());
    let homology = crosscap_algorithms::homology::homology(&apart.mesh.complex).unwrap();
    assert_eq!(homology.betti_rational, [2, 0, 2]);
}
