//! `crosscap compare`.

use crate::room::{Room, ball};
use crosscap_backends::files::write_points;
use serde_json::Value;

/// The lines of a table as cells; nothing in it but the last column has commas of its own.
fn cells(table: &str) -> Vec<Vec<String>> {
    let columns = table.lines().next().unwrap().split(',').count();
    table
        .lines()
        .map(|line| line.splitn(columns, ',').map(String::from).collect())
        .collect()
}

#[test]
fn metrics_are_compared() {
    let room = Room::new();
    room.run("sample sphere -n 1500 --seed 1 -o s.npy")
        .expect(0);
    let what = "compare s.npy --dl 0.3 --surface --eps 0.7:0.9:2 --metrics euclidean,geodesic";
    room.run(&format!(
        "{what} --betti 1,0,1 -o t.csv -o t.json -o t.svg -o t.html"
    ))
    .expect(0)
    .says("euclidean works at eps 0.7 to 0.9")
    .says("t.html: 4 runs");
    let text = |name: &str| std::fs::read_to_string(room.path(name)).unwrap();

    let told: Value = serde_json::from_str(&text("t.json")).unwrap();
    assert_eq!(
        (&told["points"], &told["dimension"]),
        (&1500.into(), &3.into())
    );
    assert_eq!(told["works"]["euclidean"], serde_json::json!([[0.7, 0.9]]));
    let runs = told["runs"].as_array().unwrap();
    let rows = cells(&text("t.csv"));
    assert_eq!((runs.len(), rows.len()), (4, 5));
    assert_eq!(rows[0].last().unwrap(), "reason");
    let order = [
        ("euclidean", 0.7),
        ("euclidean", 0.9),
        ("geodesic", 0.7),
        ("geodesic", 0.9),
    ];
    for ((run, row), (metric, eps)) in runs.iter().zip(&rows[1..]).zip(order) {
        assert_eq!((&run["metric"], &run["eps"]), (&metric.into(), &eps.into()));
        assert_eq!((row[0].as_str(), row[1].parse()), (metric, Ok(eps)));
        assert_eq!(row[2], run["state"].as_str().unwrap());
        for (k, name) in ["vertices", "triangles"].into_iter().enumerate() {
            assert_eq!(row[9 + k], run[name].to_string());
        }
        let lost = run["distortion"]["mean"].as_f64().unwrap();
        // A cap is not flat; on a sphere shortest ways have negative eigenvalues, which may make up for what is lost.
        let least = if metric == "euclidean" { 0.001 } else { 0.0 };
        assert!(lost >= least && lost < 0.1, "{metric}: {lost}");
        assert_eq!(row[11], format!("{lost:.6}"));
        // A sphere of V vertices has 2V - 4 triangles.
        if run["state"] == "verified" {
            let count = |name: &str| run[name].as_u64().unwrap();
            assert_eq!(run["betti"], serde_json::json!([1, 0, 1]));
            assert_eq!(count("triangles"), 2 * count("vertices") - 4);
        }
        assert_eq!(row.len(), 14);
        assert!(run.get("seconds").is_none());
    }
    let plot = text("t.svg");
    assert!(plot.starts_with("<svg") && plot.trim_end().ends_with("</svg>"));
    let page = text("t.html");
    assert!(page.starts_with("<!doctype html>") && page.contains("<svg"));
    for name in ["euclidean", "geodesic"] {
        assert!(plot.contains(name) && page.contains(&format!("<b>{name}</b> works at eps")));
    }
    assert_eq!(page.matches("<td class=\"reason\">").count(), 4);

    // Drawn again from its own table, and run again on another number of threads: the same.
    room.run("compare t.json -o again.csv -o again.svg")
        .expect(0);
    room.run(&format!("{what} --betti 1,0,1 --threads 1 -o one.json"))
        .expect(0);
    assert_eq!(text("again.csv"), text("t.csv"));
    assert_eq!(text("again.svg"), plot);
    assert_eq!(text("one.json"), text("t.json"));

    // A surface that is known to be another one does not work anywhere, though its mesh is verified.
    room.run("compare s.npy --dl 0.3 --surface --eps 0.7 --metrics euclidean --betti 1,2,1 --times -o other.csv")
        .expect(0)
        .says("euclidean works at no eps that was tried");
    let rows = cells(&text("other.csv"));
    assert_eq!(rows[1][2], "other-betti");
    assert_eq!(rows[0][13], "seconds");
    assert!(rows[1][13].parse::<f64>().unwrap() > 0.0);
    assert!(rows[1][14].contains("[1, 2, 1]"), "{:?}", rows[1]);
}

#[test]
fn a_comparison_that_makes_no_sense_is_refused() {
    let room = Room::new();
    write_points(room.path("p.npy"), &ball(50)).unwrap();
    room.write("odd.json", "{\"runs\": []}");
    for (arguments, complaint) in [
        ("p.npy --dl 0.2", "--output"),
        (
            "p.npy -o t.png --dl 0.2",
            "expected one of .html, .svg, .csv, .json",
        ),
        ("p.npy -o no/t.csv --dl 0.2", "there is no folder no"),
        (
            "p.npy -o t.csv -o t.csv --dl 0.2",
            "two outputs have this name",
        ),
        ("odd.json -o odd.json", "would be overwritten"),
        (
            "p.npy -o t.csv --dl 0.2 --metrics euclidean,taxicab",
            "euclidean, geodesic, conformal or lifted",
        ),
        ("p.npy -o t.csv --dl 0.2 --eps 2:1:3", "2 is not below 1"),
        (
            "p.npy -o t.csv --dl 0.2 --eps 1:2:0",
            "a number of steps from 2 to 200",
        ),
        ("p.npy -o t.csv --dl 0.2 --eps 1:2", "expected LO:HI:STEPS"),
        ("p.npy -o t.csv --dl 0.2 --eps 0:2:3", "above 0"),
        ("p.npy -o t.csv --dl 0.2 --eps 1:inf:3", "finite"),
        ("p.npy -o t.csv --dl 0 --eps 1", "above 0"),
        ("p.npy -o t.csv --dl 0.2 --betti 1,2", "three numbers"),
        ("p.npy -o t.csv --dl 0.2 --graph-k 0", "--graph-k"),
        (
            "p.npy -o t.csv --dl 0.2 --graph-k 5 --graph-eps 1",
            "cannot be used with",
        ),
        ("none.npy -o t.csv --dl 0.2", "no such file"),
        (
            "odd.json -o t.csv",
            "expected what `crosscap compare` writes as .json",
        ),
    ] {
        room.run(&format!("compare {arguments}"))
            .expect(2)
            .complains(complaint);
    }
    assert_eq!(room.files(), ["odd.json", "p.npy"]);
}
