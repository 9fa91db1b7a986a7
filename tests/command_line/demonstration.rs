//! The paper's table and the demonstration.

use crate::room::{Room, image_size};
use std::path::Path;

#[test]
fn a_row_of_the_papers_table() {
    let room = Room::new();
    let found = room
        .run("paper --only sphere --seeds 2 --json")
        .expect(0)
        .json();
    let row = &found["surfaces"][0];
    assert_eq!(row["surface"], "sphere");
    assert_eq!((&row["ok"], &row["silent_wrong"]), (&2.into(), &0.into()));
    assert_eq!(row["paper_landmarks"], 886);
    assert_eq!(row["runs"].as_array().unwrap().len(), 2);
    let k = row["mean_neighbors"].as_f64().unwrap();
    assert!((20.0..45.0).contains(&k), "{k}");
    room.run("paper --only sphere --seeds 1")
        .expect(0)
        .says("(886)")
        .says("1/1");
}

#[test]
fn the_demonstration_leaves_something_to_look_at() {
    let room = Room::new();
    room.run("demo -o shown")
        .expect(0)
        .says("1, 0, 3 over Q")
        .says("Two spheres")
        .says("verified");
    let at = |name: &str| room.path("shown").join(name);
    assert!(
        std::fs::read_to_string(at("index.html"))
            .unwrap()
            .starts_with("<!DOCTYPE html>")
    );
    assert_eq!(
        image_size(&std::fs::read(at("picture.png")).unwrap()),
        "1200x900"
    );
    assert!(only_files(
        &room.path("shown"),
        &["index.html", "mesh.npz", "picture.png", "report.json"]
    ));
    room.run("check shown/mesh.npz").expect(0);
}

fn only_files(folder: &Path, names: &[&str]) -> bool {
    let all = std::fs::read_dir(folder).unwrap();
    let mut found: Vec<String> = all
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .collect();
    found.sort();
    found == names
}
