//! `crosscap sample`.

use crate::room::Room;
use crosscap_backends::files::read_indices;

#[test]
fn a_seed_gives_the_same_file() {
    let room = Room::new();
    room.run("sample torus -n 500 --seed 3 -o a.npy")
        .expect(0)
        .says("500 points in R^3");
    room.run("sample torus -n 500 --seed 3 -o b.npy").expect(0);
    room.run("sample torus -n 500 --seed 4 -o c.npy").expect(0);
    let read = |name: &str| std::fs::read(room.path(name)).unwrap();
    assert_eq!(read("a.npy"), read("b.npy"));
    assert_ne!(read("a.npy"), read("c.npy"));
    // (sqrt(x^2 + y^2) - 2)^2 + z^2 = 1
    for p in room.points("a.npy").iter() {
        let off = (p[0].hypot(p[1]) - 2.0).hypot(p[2]) - 1.0;
        assert!(off.abs() < 1e-12, "{p:?}");
    }
}

#[test]
fn samples_are_thinned_turned_and_shaken() {
    let room = Room::new();
    room.run("sample sphere -n 2000 --thin 0.2 -o thin.csv")
        .expect(0);
    let thin = room.points("thin.csv");
    assert!(thin.len() > 100 && thin.len() < 700, "{}", thin.len());
    for a in 0..thin.len() {
        for b in 0..a {
            assert!(thin.squared_distance(a, b).sqrt() >= 0.2);
        }
    }
    room.run("sample sphere -n 300 --embed 7 -o wide.npy")
        .expect(0)
        .says("R^7");
    room.run("sample sphere -n 300 -o plain.npy").expect(0);
    let (wide, plain) = (room.points("wide.npy"), room.points("plain.npy"));
    assert_eq!(wide.dimension(), 7);
    for k in 1..300 {
        let change = wide.squared_distance(0, k) - plain.squared_distance(0, k);
        assert!(change.abs() < 1e-12);
    }
    room.run("sample sphere -n 300 --embed 7 --noise 0.01 -o noisy.npy")
        .expect(0);
    let noisy = room.points("noisy.npy");
    let moved = (0..300).flat_map(|k| {
        let (a, b) = (noisy.point(k), wide.point(k));
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b) * (a - b))
            .collect::<Vec<_>>()
    });
    let deviation = (moved.sum::<f64>() / 2100.0).sqrt();
    assert!((0.009..0.011).contains(&deviation), "{deviation}");
}

#[test]
fn boundary_points_come_with_their_rows() {
    let room = Room::new();
    room.run("sample hemisphere -n 1000 -o plain.npy").expect(0);
    room.run("sample hemisphere -n 1000 -o points.npy --boundary-out rows.npy")
        .expect(0)
        .says("on the boundary");
    let rows = read_indices(room.path("rows.npy")).unwrap();
    let points = room.points("points.npy");
    assert_eq!(room.points("plain.npy").len(), 1000);
    assert!(rows.len() > 50);
    assert_eq!(points.len(), 1000 + rows.len());
    for row in rows {
        let p = points.point(row);
        assert!(
            p[2].abs() < 1e-12 && (p[0].hypot(p[1]) - 1.0).abs() < 1e-12,
            "{p:?}"
        );
    }
}

#[test]
fn the_list_has_the_papers_surfaces() {
    let ran = Room::new().run("sample --list").expect(0);
    for name in [
        "sphere",
        "torus",
        "double_torus",
        "moebius",
        "klein_r5",
        "rp2_r6",
        "two_spheres",
        "klein_immersion",
        "henneberg",
        "cyclo-octane",
    ] {
        assert!(ran.out.contains(name), "{name}");
    }
}

#[test]
fn conformations_keep_their_bonds() {
    let room = Room::new();
    room.run("sample cyclo-octane -n 100 -o ring.npy")
        .expect(0)
        .says("100 points in R^24");
    for p in room.points("ring.npy").iter() {
        for atom in 0..8 {
            let (a, b) = (3 * atom, 3 * ((atom + 1) % 8));
            let bond: f64 = (0..3).map(|k| (p[a + k] - p[b + k]).powi(2)).sum();
            assert!((bond.sqrt() - 1.52).abs() < 1e-6);
        }
    }
}

#[test]
fn other_bonds_and_angles_are_another_ring() {
    let room = Room::new();
    room.run(
        "sample cyclo-octane -n 300 --bond-length 1.5 --bond-angle 128 --thin 0.1 -o ring.npy",
    )
    .expect(0)
    .says("points in R^24");
    let points = room.points("ring.npy");
    assert!(points.len() > 100);
    for (k, p) in points.iter().enumerate() {
        let distance = |a: usize, b: usize| {
            let square: f64 = (0..3).map(|c| (p[3 * a + c] - p[3 * b + c]).powi(2)).sum();
            square.sqrt()
        };
        let across = 3.0 * 64f64.to_radians().sin();
        for atom in 0..8 {
            assert!((distance(atom, (atom + 1) % 8) - 1.5).abs() < 1e-9);
            assert!((distance(atom, (atom + 2) % 8) - across).abs() < 1e-9);
        }
        for other in 0..k {
            assert!(points.squared_distance(k, other) >= 0.01);
        }
    }
    room.run("sample cyclo-octane --bond-angle 140 -o no.npy")
        .expect(2)
        .complains("make the bond angles smaller");
    room.run("sample sphere --bond-length 1 -o no.npy")
        .expect(2)
        .complains("has no bonds");
    assert_eq!(room.files(), ["ring.npy"]);
}
