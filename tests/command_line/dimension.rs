//! `crosscap dimension`.

use crate::room::{Room, ball};
use crosscap_backends::files::write_points;
use crosscap_core::PointCloud;
use serde_json::Value;

#[test]
fn every_estimator_tells_the_dimension_of_a_sphere() {
    let room = Room::new();
    room.run("sample sphere -n 1500 --seed 1 -o s.npy")
        .expect(0);
    let told = room
        .run("dimension s.npy --json -o local.csv")
        .expect(0)
        .json();
    let names = ["pca", "mle", "correlation", "packing", "spanning-tree"];
    for (row, name) in told.as_array().unwrap().iter().zip(names) {
        assert_eq!(row["estimator"], name);
        assert_eq!(row["dimension"], 2, "{row}");
        assert!(row["share"].as_f64().unwrap() > 0.8, "{row}");
    }
    // A line a point, three columns an estimator.
    let table = std::fs::read_to_string(room.path("local.csv")).unwrap();
    assert_eq!(table.lines().count(), 1501);
    assert!(table.lines().all(|l| l.split(',').count() == 16));

    let told = room
        .run("dimension s.npy --global --json -k 15")
        .expect(0)
        .json();
    for (row, name) in told.as_array().unwrap().iter().zip(names) {
        assert_eq!(row["estimator"], name);
        // The flat that holds a sphere has one more.
        let expected = if name == "pca" { 3 } else { 2 };
        assert_eq!(row["dimension"], expected, "{row}");
    }
    let one = room
        .run("dimension s.npy --global --estimator mle -o g.csv")
        .expect(0);
    one.says("1500 points of R^3, one dimension for all, 20 nearest neighbors")
        .says("mle");
    let table = std::fs::read_to_string(room.path("g.csv")).unwrap();
    assert!(table.starts_with("estimator,dimension,value,"), "{table}");
    // Not a digit depends on the number of threads.
    let with = |threads: usize| {
        let command = format!("dimension s.npy --global --json --threads {threads}");
        room.run(&command).expect(0).out
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn dimensions_that_cannot_be_told_are_not() {
    let room = Room::new();
    write_points(room.path("p.npy"), &ball(50)).unwrap();
    room.run("dimension p.npy --eps 1 -k 9")
        .expect(2)
        .complains("cannot be used with");
    room.run("dimension p.npy -k 2")
        .expect(2)
        .complains("2 is not in 4..");
    room.run("dimension p.npy --eps 0")
        .expect(2)
        .complains("above 0");
    room.run("dimension p.npy -o p.npy")
        .expect(2)
        .complains(".csv");
    room.run("dimension p.npy --eps 1e-6")
        .expect(1)
        .complains("increase eps");
    room.run("dimension p.npy --global --eps 1e-6 --estimator packing")
        .expect(0);
    write_points(room.path("few.npy"), &ball(3)).unwrap();
    room.run("dimension few.npy --global --estimator mle")
        .expect(2)
        .complains("found 3 points");
    // All points in one place: no dimension, no panic.
    let copies = PointCloud::new(3, vec![1.0; 90]).unwrap();
    write_points(room.path("copies.npy"), &copies).unwrap();
    room.run("dimension copies.npy -k 20 --estimator mle")
        .expect(0)
        .says("0  100.0 %");
    room.run("dimension copies.npy -k 20").expect(0);
    room.run("dimension copies.npy --global --estimator correlation")
        .expect(2)
        .complains("copies");
}

#[test]
fn every_estimator_serves_a_reconstruction() {
    let room = Room::new();
    room.run("sample sphere -n 1500 --seed 1 -o s.npy")
        .expect(0);
    for name in ["pca", "mle", "correlation", "packing", "spanning-tree"] {
        let options = format!("--eps 0.5 --dl 0.25 --estimator {name} --report {name}.json");
        room.run(&format!("reconstruct s.npy -o {name}.npz {options}"))
            .expect(0)
            .says("One sphere");
        let report = std::fs::read_to_string(room.path(&format!("{name}.json"))).unwrap();
        let report: Value = serde_json::from_str(&report).unwrap();
        assert_eq!(report["estimator"], name);
    }
    room.run("reconstruct s.npy -o m.npz --eps 0.5 --dl 0.25 --surface --estimator mle")
        .expect(2)
        .complains("--surface");
}
