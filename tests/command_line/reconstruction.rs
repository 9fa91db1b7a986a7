//! `crosscap reconstruct`.

use crate::room::{Room, SPHERE, ball, sphere_points};
use crosscap_backends::files::{read_mesh, write_points};
use serde_json::Value;

#[test]
fn a_sphere_is_reconstructed() {
    let room = Room::new();
    sphere_points(&room);
    room.run(&format!(
        "reconstruct points.npy -o mesh.npz {SPHERE} --report report.json --picture page.html"
    ))
    .expect(0)
    .says("verified")
    .says("Betti numbers 1, 0, 1 over Q")
    .says("One sphere.");
    room.run("check mesh.npz --points points.npy").expect(0);
    let file = read_mesh(room.path("mesh.npz")).unwrap();
    let points = room.points("points.npy");
    for (vertex, &row) in file.mesh.point_index.iter().enumerate() {
        assert_eq!(file.mesh.vertices.point(vertex), points.point(row as usize));
    }
    assert_eq!(file.extras.metadata["dl"], 0.25);
    assert_eq!(file.extras.metadata["verified"], true);
    let report: Value =
        serde_json::from_slice(&std::fs::read(room.path("report.json")).unwrap()).unwrap();
    assert_eq!(report["verified"], true);
    assert_eq!(report["points"], 3000);
    assert_eq!(report["parameters"]["seed"], 0);
    assert_eq!(
        report["homology"]["betti_mod2"],
        serde_json::json!([1, 0, 1])
    );
    assert_eq!(report["input"]["file"], "points.npy");
    let page = std::fs::read_to_string(room.path("page.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>"));
}

#[test]
fn nothing_but_the_points_is_needed_and_the_printed_command_repeats_the_run() {
    let room = Room::new();
    sphere_points(&room);
    let ran = room
        .run("reconstruct points.npy -o chosen.npz")
        .expect(0)
        .says("Betti numbers 1, 0, 1 over Q")
        .says("99 of 100 points have 60 others nearer than that")
        .says("half of eps");
    let again = ran
        .out
        .lines()
        .find_map(|line| line.strip_prefix("the same again: crosscap "));
    let again = again.unwrap().replace("chosen.npz", "again.npz");
    let ran = room.run(&again).expect(0);
    assert!(!ran.out.contains("chosen:"), "{}", ran.out);
    let read = |name: &str| std::fs::read(room.path(name)).unwrap();
    assert_eq!(read("chosen.npz"), read("again.npz"));
}

#[test]
fn what_is_pinned_stays_and_the_rest_is_chosen() {
    let room = Room::new();
    sphere_points(&room);
    room.run("reconstruct points.npy -o mesh.npz --dl 0.31 --seed 4 --report report.json")
        .expect(0)
        .says("eps 0.62 (twice dl), dl 0.31 (given)");
    let report: Value =
        serde_json::from_slice(&std::fs::read(room.path("report.json")).unwrap()).unwrap();
    assert_eq!(report["parameters"]["dl"], 0.31);
    assert_eq!(report["parameters"]["seed"], 4);
    assert_eq!(report["attempts"][0]["parameters"]["eps"], 0.62);
    assert_eq!(report["density"]["points"], 3000);
}

#[test]
fn the_same_input_gives_the_same_mesh_on_any_number_of_threads() {
    let room = Room::new();
    sphere_points(&room);
    for (name, more) in [
        ("a", "--threads 1"),
        ("b", "--threads 2"),
        ("c", "--seed 9"),
    ] {
        room.run(&format!(
            "reconstruct points.npy -o {name}.npz {SPHERE} {more}"
        ))
        .expect(0);
    }
    let read = |name: &str| std::fs::read(room.path(name)).unwrap();
    assert_eq!(read("a.npz"), read("b.npz"));
    assert_ne!(read("a.npz"), read("c.npz"));
}

#[test]
fn a_given_boundary_is_kept() {
    let room = Room::new();
    room.run("sample hemisphere -n 3000 -o points.npy --boundary-out rim.npy")
        .expect(0);
    room.run("reconstruct points.npy -o mesh.npz --eps 0.4 --dl 0.2 --surface --boundary rim.npy")
        .expect(0)
        .says("1, 0, 0 over Q")
        .says("disc");
    let complex = read_mesh(room.path("mesh.npz")).unwrap().mesh.complex;
    assert!(complex.curve_edges.iter().all(|e| e.cells == 1));
    assert!(complex.curve_edges.len() > 10);
}

#[test]
fn duplicates_do_no_harm() {
    let room = Room::new();
    sphere_points(&room);
    let points = room.points("points.npy");
    let rows: Vec<usize> = (0..3000).chain(0..500).collect();
    write_points(room.path("twice.npy"), &points.select(&rows)).unwrap();
    room.run(&format!(
        "reconstruct twice.npy -o mesh.npz {SPHERE} --report report.json"
    ))
    .expect(0)
    .says("500 duplicate points");
}

#[test]
fn no_surface_no_mesh() {
    let room = Room::new();
    write_points(room.path("ball.npy"), &ball(3000)).unwrap();
    let command = "reconstruct ball.npy -o mesh.npz --eps 0.4 --dl 0.2";
    let more = "--report report.json --picture page.html --cut-out worst.xyz";
    room.run(&format!("{command} {more}"))
        .expect(1)
        .complains("the points fill a space of more than two dimensions")
        .complains("leave out the points there, or the columns that are no coordinates");
    // There was no mesh to draw.
    assert_eq!(room.files(), ["ball.npy", "report.json", "worst.xyz"]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(room.path("report.json")).unwrap()).unwrap();
    assert_eq!(report["verified"], false);
    assert_eq!(report["refusal"]["faults"][0]["kind"], "dimension");
    let cut = room.points("worst.xyz");
    assert!(cut.len() <= 1500, "{}", cut.len());
    let ran = room.run(&format!("{command} --surface {more}")).expect(1);
    assert!(!ran.err.is_empty());
    assert_eq!(
        room.files(),
        ["ball.npy", "page.html", "report.json", "worst.xyz"]
    );
    room.run(&format!("{command} --surface {more} --keep-unverified"))
        .expect(1)
        .says("not verified")
        .complains("this mesh is not verified");
    assert!(room.files().contains(&"mesh.npz".to_string()));
    room.run("check mesh.npz --points ball.npy").expect(1);
}

#[test]
fn a_refusal_advises_what_was_tried() {
    let room = Room::new();
    sphere_points(&room);
    // Landmarks as far apart as the sphere is wide.
    room.run("reconstruct points.npy -o mesh.npz --eps 1.9 --dl 1.6 --report report.json")
        .expect(1)
        .complains("it is verified: Betti numbers 1, 0, 1");
    let report: Value =
        serde_json::from_slice(&std::fs::read(room.path("report.json")).unwrap()).unwrap();
    let advised = &report["refusal"]["advice"]["parameters"][0];
    room.run(&format!(
        "reconstruct points.npy -o mesh.npz --eps {} --dl {} --models auto",
        advised["eps"], advised["dl"]
    ))
    .expect(0);
}

/// Lengths in the spacing of the points are for one closed surface, and it is not for the user to say that again.
#[test]
fn a_metric_alone_chooses_what_goes_with_it() {
    let room = Room::new();
    sphere_points(&room);
    let ran = room
        .run("reconstruct points.npy -o mesh.npz --metric conformal")
        .expect(0)
        .says("half of the points have 60 others nearer than that")
        .says("Betti numbers 1, 0, 1 over Q");
    assert!(ran.out.contains("--surface"), "{}", ran.out);
    // What is advised after a refusal is tried with the same metric.
    room.run("reconstruct points.npy -o no.npz --eps 1.9 --dl 1.6 --metric conformal --surface")
        .expect(1)
        .complains("it is verified: Betti numbers 1, 0, 1");
}

#[test]
fn a_failure_leaves_the_old_file_alone() {
    let room = Room::new();
    write_points(room.path("ball.npy"), &ball(3000)).unwrap();
    room.write("mesh.npz", "precious");
    room.run("reconstruct ball.npy -o mesh.npz --eps 0.4 --dl 0.2 --surface")
        .expect(1);
    assert_eq!(std::fs::read(room.path("mesh.npz")).unwrap(), b"precious");
}

/// Options for a metric that the run does not have are no error, as a command that repeats a run may carry them; but it is said.
#[test]
fn options_that_nothing_asks_are_told() {
    let room = Room::new();
    sphere_points(&room);
    let run = |options: &str| {
        let run =
            format!("reconstruct points.npy -o m.npz --eps 0.3 --dl 0.15 --surface {options}");
        room.run(&run).expect(0)
    };
    run("--graph-k 20 --lift 1")
        .complains("--graph-k has no effect here: it is for --metric or --tri-metric geodesic or conformal")
        .complains("--lift has no effect here: it is for --metric or --tri-metric lifted");
    let told = run("--graph-k 20 --tri-metric geodesic").err;
    assert!(!told.contains("no effect"), "{told}");
    let ran = room
        .run("reconstruct points.npy -o m.npz --graph-k 20")
        .expect(0);
    assert!(!ran.err.contains("no effect"), "{}", ran.err);
}
