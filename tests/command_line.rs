//! The built program, run as a user runs it.

use crosscap_algorithms::surfaces::{Drawing, Feature, Random, SampleSurface, Sampling};
use crosscap_backends::files::{
    MeshExtras, PointOptions, read_indices, read_mesh, read_points, write_mesh, write_points,
};
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// What a run of the program left behind.
struct Ran {
    code: Option<i32>,
    out: String,
    err: String,
}

impl Ran {
    #[track_caller]
    fn expect(self, code: i32) -> Self {
        assert!(!self.err.contains("panicked"), "{}", self.err);
        assert_eq!(
            self.code,
            Some(code),
            "\nstdout: {}\nstderr: {}",
            self.out,
            self.err
        );
        self
    }

    #[track_caller]
    fn says(self, part: &str) -> Self {
        assert!(self.out.contains(part), "no {part:?} in: {}", self.out);
        self
    }

    #[track_caller]
    fn complains(self, part: &str) -> Self {
        assert!(self.err.contains(part), "no {part:?} in: {}", self.err);
        self
    }

    #[track_caller]
    fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap()
    }
}

/// A folder to run the program in, which goes away with the test.
struct Room(TempDir);

impl Room {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Arguments between white space; file names are relative to the folder.
    fn run(&self, arguments: &str) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_crosscap"))
            .args(arguments.split_whitespace())
            .current_dir(self.0.path())
            .output()
            .unwrap();
        Ran {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    fn files(&self) -> Vec<String> {
        let all = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = all
            .map(|f| f.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    fn mesh(&self, name: &str, mesh: &Mesh) {
        write_mesh(self.path(name), mesh, &MeshExtras::default(), None).unwrap();
    }

    fn points(&self, name: &str) -> PointCloud<f64> {
        let cloud = read_points(self.path(name), &PointOptions::default());
        cloud.unwrap().into_f64()
    }
}

fn mesh(
    dimension: usize,
    places: Vec<f64>,
    triangles: Vec<[u32; 3]>,
    curves: Vec<CurveEdge>,
) -> Mesh {
    let places = PointCloud::new(dimension, places).unwrap();
    let count = places.len();
    let complex = Complex::new(count, triangles, curves).unwrap();
    Mesh::new(complex, places, vec![-1; count]).unwrap()
}

/// A sphere of eight triangles.
fn octahedron() -> Mesh {
    let places = vec![
        1., 0., 0., -1., 0., 0., 0., 1., 0., 0., -1., 0., 0., 0., 1., 0., 0., -1.,
    ];
    let signs = [0, 1].into_iter();
    let faces = signs.flat_map(|x| {
        [2, 3]
            .into_iter()
            .flat_map(move |y| [4, 5].map(|z| [x, y, z]))
    });
    mesh(3, places, faces.collect(), vec![])
}

/// Two spheres that cross in a circle of `n` edges: four caps over one rim, two of them bulging out over a
/// ring of their own.
fn two_spheres(n: u32) -> Mesh {
    let mut places = Vec::new();
    for (x, radius) in [(0.0, 1.0), (-0.8, 1.5), (0.8, 1.5)] {
        for k in 0..n {
            let (sine, cosine) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            places.extend([x, radius * cosine, radius * sine]);
        }
    }
    for apex in [-3.0, 3.0, -1.6, 1.6] {
        places.extend([apex, 0.0, 0.0]);
    }
    let mut faces = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        for side in [1, 2] {
            let (a, b) = (side * n + k, side * n + next);
            faces.extend([[k, next, a], [next, a, b], [a, b, 3 * n + side - 1]]);
            faces.push([k, next, 3 * n + 1 + side]);
        }
    }
    let rim = (0..n).map(|k| CurveEdge::new(k, (k + 1) % n, 4));
    mesh(3, places, faces, rim.collect())
}

/// A torus in R^4, the product of two circles.
fn flat_torus(n: u32) -> Mesh {
    let mut places = Vec::new();
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..n {
            for k in [i, j] {
                let (sine, cosine) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
                places.extend([cosine, sine]);
            }
            let at = |i: u32, j: u32| (i % n) * n + j % n;
            faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            faces.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
    }
    mesh(4, places, faces, vec![])
}

/// Points that fill a ball of R^3: no surface.
fn ball(count: usize) -> PointCloud<f64> {
    let mut random = Random::new(5);
    let mut coordinates = Vec::new();
    while coordinates.len() < 3 * count {
        let p = [0; 3].map(|_| random.between(-1.0, 1.0));
        if p.iter().map(|c| c * c).sum::<f64>() < 1.0 {
            coordinates.extend(p);
        }
    }
    PointCloud::new(3, coordinates).unwrap()
}

// Memory

/// The most memory that a run has held, in MiB, as its last line says.
fn held(ran: &Ran) -> u64 {
    let told = ran.err.trim_end().strip_suffix(" MiB at most").unwrap();
    told.rsplit(' ').next().unwrap().parse().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_cloud_that_does_not_fit_is_worked_on_in_tiles() {
    let room = Room::new();
    // Spheres in a row, so that halos are small beside the cloud.
    let sphere = SampleSurface::find("sphere").unwrap();
    let sphere = sphere.sample(&Sampling::new(25_000, 4)).unwrap().points;
    let row = (0..12).flat_map(|k| {
        let places = sphere.iter();
        places.flat_map(move |p| [p[0] + 4.0 * f64::from(k), p[1], p[2]])
    });
    // A point that is there twice counts once, whatever becomes of the rows behind it.
    let twice = sphere.point(9).iter().copied();
    let row = PointCloud::new(3, twice.chain(row).collect()).unwrap();
    write_points(room.path("p.npy"), &row).unwrap();
    let run = "reconstruct p.npy -o m.npz --eps 0.6 --dl 0.3 --surface --threads 2";
    room.run(run).expect(0);
    let mesh = std::fs::read(room.path("m.npz")).unwrap();
    let limit = 258;
    let tiled = room
        .run(&format!("{run} --memory-limit {limit}MiB --report r.json"))
        .expect(0)
        .complains("in memory a run with these 300001 points of R^3 takes up to")
        .complains("tiles on")
        .says("(verified)")
        .says("1 duplicate point in the input");
    assert!(held(&tiled) <= limit, "{}", tiled.err);
    assert!(std::fs::read(room.path("m.npz")).unwrap() == mesh);
    assert_eq!(room.files(), ["m.npz", "p.npy", "r.json"]);
    // What tiles cannot do is refused before the work, with what would do.
    room.run("reconstruct p.npy -o m.npz --memory-limit 258MiB")
        .expect(2)
        .complains("looks at all points together")
        .complains("--surface`")
        .complains("else --memory-limit");
    room.run("reconstruct p.npy -o m.npz --eps 0.6 --dl 0.3 --memory-limit 258MiB")
        .expect(2)
        .complains("curves are not looked for in tiles")
        .complains("--memory-limit 258MiB --surface`");
    room.run(&format!("{run} --metric geodesic --memory-limit 258MiB"))
        .expect(2)
        .complains("parameter metric");
    room.run(&format!("{run} --memory-limit 20MiB"))
        .expect(2)
        .complains("in tiles, too");
}

#[test]
fn a_limit_of_memory_needs_a_file_in_rows() {
    let room = Room::new();
    room.write("p.csv", "1,2,3\n");
    for points in ["p.csv", "p.npy --transpose", "p.npy --columns 0,1"] {
        room.run(&format!(
            "reconstruct {points} -o m.npz --memory-limit 1GiB"
        ))
        .expect(2)
        .complains("some rows at a time");
    }
    room.run("reconstruct p.npy -o m.npz --memory-limit 2")
        .expect(2)
        .complains("no such file");
    room.run("reconstruct p.npy -o m.npz --memory-limit 2X")
        .expect(2)
        .complains("2GiB, 1.5GB, 800MiB");
}

// Usage

#[test]
fn every_command_explains_itself() {
    let room = Room::new();
    room.run("--help")
        .expect(0)
        .says("Exit codes:")
        .says("demo");
    room.run("--version")
        .expect(0)
        .says(env!("CARGO_PKG_VERSION"));
    for command in [
        "demo",
        "sample",
        "reconstruct",
        "check",
        "dimension",
        "view",
        "convert",
        "paper",
    ] {
        let ran = room.run(&format!("{command} --help")).expect(0);
        ran.says("Examples:").says(&format!("crosscap {command}"));
    }
}

#[test]
fn help_comes_in_two_lengths() {
    let room = Room::new();
    let options = |words: &str| {
        let ran = room.run(words).expect(0);
        let lines = ran.out.lines().map(str::trim_start);
        lines.filter(|line| line.starts_with('-')).count()
    };
    let short = options("reconstruct --help");
    assert!((10..=14).contains(&short), "{short}");
    assert_eq!(short, options("reconstruct -h"));
    assert!(options("reconstruct --help-all") > 30);
    // Options that most runs need stand in the first group, whatever group was defined before them.
    let all = room.run("reconstruct --help-all").expect(0).out;
    let at = |text: &str| all.find(text).unwrap_or_else(|| panic!("{text}"));
    for name in [
        "--boundary <",
        "--threads <",
        "--report <",
        "--keep-unverified",
    ] {
        assert!(at(name) < at("Estimators and tolerances:"), "{name}");
    }
    assert!(at("--tries <") > at("Attempts and what they leave:"));
    room.run("reconstruct --help").expect(0).says("--help-all");
}

#[test]
fn long_names_stand_beside_the_short_ones() {
    let room = Room::new();
    let ran = room.run("reconstruct --help-all").expect(0);
    for name in [
        "--epsilon",
        "--triangulation-epsilon",
        "--dimension-tolerance",
        "--fit-tolerance",
        "--curve-tolerance",
        "--landmark-separation",
    ] {
        assert!(ran.out.contains(name), "{name}");
    }
    // They are read, too: the complaint is about the values.
    room.run("reconstruct p.npy -o m.npz --epsilon 0.1 --landmark-separation 0.2")
        .expect(2)
        .complains("--dl 0.2 is larger than --eps 0.1");
}

#[test]
fn usage_errors_name_what_is_wrong() {
    let room = Room::new();
    write_points(room.path("p.npy"), &ball(50)).unwrap();
    room.mesh("m.npz", &octahedron());
    let reconstruct = "reconstruct p.npy -o out.npz";
    for (arguments, complaint) in [
        ("", "Usage:"),
        ("fly", "unrecognized subcommand"),
        ("reconstruct p.npy --eps 1 --dl 0.5", "--output"),
        (
            &format!("{reconstruct} --eps 0 --dl 0.2"),
            "expected a number above 0",
        ),
        (
            &format!("{reconstruct} --eps -1 --dl 0.2"),
            "expected a number above 0",
        ),
        (
            &format!("{reconstruct} --eps nan --dl 0.2"),
            "expected a finite number",
        ),
        (
            &format!("{reconstruct} --eps x --dl 0.2"),
            "expected a number",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl inf"),
            "expected a finite number",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --dt 1"),
            "above 0 and below 1",
        ),
        (&format!("{reconstruct} --eps 1 --dl 0.5 --dp 0"), "--dp"),
        (&format!("{reconstruct} --eps 1 --dl 0.5 --ep -0.1"), "--ep"),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --seed -1"),
            "--seed",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --method best"),
            "cells, paper",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 2"),
            "--dl 2 is larger than --eps 1",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --tri-eps 0.5"),
            "1.5 is a good value",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --ep 1"),
            "--ep 1 is not smaller than --eps 1",
        ),
        (
            "reconstruct p.npy -o no/m.npz --eps 1 --dl 0.5",
            "there is no folder no",
        ),
        (
            "reconstruct p.npy -o m.dae --eps 1 --dl 0.5",
            "extension .dae, expected one of .npz",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --picture a.gif"),
            "expected one of .html, .png",
        ),
        (
            &format!("{reconstruct} --eps 1 --dl 0.5 --report no/r.json"),
            "there is no folder no",
        ),
        (
            "reconstruct m.npz -o m.npz --eps 1 --dl 0.5",
            "would be overwritten",
        ),
        ("sample", "<SURFACE>"),
        ("sample sphere", "--output"),
        ("sample sphere -n 0 -o a.npy", "0"),
        ("sample sphere -n 4000000000 -o a.npy", "too many"),
        ("sample sphere --noise -1 -o a.npy", "at least 0"),
        ("sample sphere --thin 0 -o a.npy", "above 0"),
        (
            "sample sphere --embed 2 -o a.npy",
            "the surface lies in R^3",
        ),
        ("sample sphere -o no/a.npy", "there is no folder no"),
        ("sample sphere -o a.png", "expected one of .npy"),
        (
            "sample sphere -o a.npy --boundary-out b.npy",
            "sphere has no boundary",
        ),
        (
            "sample moebius -o a.npy --boundary-out a.npy",
            "two outputs have this name",
        ),
        ("sample teapot -o a.npy", "two_spheres"),
        (
            "sample cyclo-octane --parameter-uniform -o a.npy",
            "no parameters",
        ),
        ("check none.npz", "no such file"),
        ("check p.npy", "expected one of .npz"),
        ("check m.npz --dl 0", "above 0"),
        ("view m.npz -o a.jpg", "expected one of .html, .png"),
        ("view m.npz -o a.png --size 5", "WIDTHxHEIGHT"),
        ("view m.npz -o a.png --layout best", "pca, isomap, xyz"),
        ("convert m.npz a.txt", "expected one of .npz"),
        ("convert m.npz m.npz", "would be overwritten"),
        ("paper --only teapot", "expected one of sphere"),
        ("paper --seeds 0", "0"),
        ("demo -o no/demo", "there is no folder no"),
        ("demo -o p.npy", "is a file"),
    ] {
        room.run(arguments).expect(2).complains(complaint);
    }
    assert_eq!(room.files(), ["m.npz", "p.npy"]);
}

// Bad input

/// A `.npy` file of float64 with a header of its own.
fn npy(header: &str, numbers: &[f64]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let text = format!("{header:<117}\n");
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

fn header(rows: usize, columns: usize) -> String {
    format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}")
}

#[test]
fn bad_points_are_refused_with_their_place() {
    let room = Room::new();
    let good: Vec<f64> = (0..60).map(f64::from).collect();
    let mut nan = good.clone();
    nan[10] = f64::NAN;
    let mut infinite = good.clone();
    infinite[5] = f64::INFINITY;
    room.write("good.npy", npy(&header(20, 3), &good));
    for (name, content, complaint) in [
        ("nan.npy", npy(&header(20, 3), &nan), "row 3, column 1"),
        (
            "infinity.npy",
            npy(&header(20, 3), &infinite),
            "row 1, column 2",
        ),
        ("nan.csv", b"0,0,1\n1,nan,2\n".to_vec(), "line 2, column 2"),
        (
            "word.csv",
            b"0,0,1\n1,2,2\n1,two,2\n".to_vec(),
            "line 3, column 2",
        ),
        ("ragged.csv", b"0,0,1\n1,2\n".to_vec(), "line 2"),
        ("column.csv", b"0\n1\n2\n".to_vec(), "column"),
        ("empty.csv", Vec::new(), "empty"),
        ("empty.npy", Vec::new(), "empty"),
        ("norows.npy", npy(&header(0, 3), &[]), "point"),
        ("column.npy", npy(&header(60, 1), &good), "column"),
        ("truncated.npy", npy(&header(20, 3), &good[..50]), "bytes"),
        ("lies.npy", npy(&header(1 << 60, 3), &good), "bytes"),
        (
            "garbage.npy",
            b"not an array at all".to_vec(),
            "garbage.npy",
        ),
        (
            "few.csv",
            b"0,0,1\n1,2,3\n".to_vec(),
            "found 2 points, expected at least 8",
        ),
        ("points.doc", b"0,0,1\n".to_vec(), "extension .doc"),
    ] {
        room.write(name, content);
        room.run(&format!(
            "reconstruct {name} -o mesh.npz --eps 5 --dl 2 --report report.json"
        ))
        .expect(2)
        .complains(complaint)
        .complains(name);
        assert!(!room.path("mesh.npz").exists() && !room.path("report.json").exists());
    }
    room.run("reconstruct absent.npy -o mesh.npz --eps 5 --dl 2")
        .expect(2)
        .complains("absent.npy: no such file");
    room.write("rows.txt", "0 1 20\n");
    room.run("reconstruct good.npy -o mesh.npz --eps 5 --dl 2 --boundary rows.txt")
        .expect(2)
        .complains("rows.txt: row 2 (from 0): found index 20, expected 0 to 19");
    room.write("rows.txt", "0 -1\n");
    room.run("reconstruct good.npy -o mesh.npz --eps 5 --dl 2 --boundary rows.txt")
        .expect(2)
        .complains("rows.txt");
}

#[test]
fn bad_meshes_are_refused_with_their_place() {
    let room = Room::new();
    room.write("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    room.write("garbage.npz", "this is no archive");
    for command in ["check", "view -o a.png", "convert"] {
        for name in ["range.off", "garbage.npz"] {
            let last = if command == "convert" { " b.npz" } else { "" };
            room.run(&format!("{command} {name}{last}"))
                .expect(2)
                .complains(name);
        }
    }
    assert_eq!(room.files(), ["garbage.npz", "range.off"]);
}

#[test]
fn a_reader_that_goes_away_is_no_accident() {
    let room = Room::new();
    room.mesh("m.npz", &two_spheres(12));
    for arguments in ["check m.npz --json", "sample --list", "--help"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_crosscap"))
            .args(arguments.split_whitespace())
            .current_dir(room.0.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{arguments}: {complaint}");
    }
}

// Samples

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

// Molecules

/// Conformations as frames of a molecule with hydrogens, each turned and carried away.
fn trajectory(conformations: &PointCloud<f64>) -> String {
    let mut xyz = String::new();
    let mut random = Random::new(3);
    for (k, p) in conformations.iter().enumerate() {
        let angles: [f64; 3] = [0; 3].map(|_| random.between(-3.0, 3.0));
        let shift: [f64; 3] = [0; 3].map(|_| random.between(-20.0, 20.0));
        xyz += &format!("16\nframe {k}\n");
        for atom in 0..8 {
            // A hydrogen outside of each carbon.
            for (element, stretch) in [("C", 1.0), ("H", 1.4)] {
                let mut q: [f64; 3] = std::array::from_fn(|i| stretch * p[3 * atom + i]);
                for (axis, angle) in [2, 0, 2].into_iter().zip(angles) {
                    let (s, c) = angle.sin_cos();
                    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                    (q[i], q[j]) = (c * q[i] - s * q[j], s * q[i] + c * q[j]);
                }
                let [x, y, z]: [f64; 3] = std::array::from_fn(|i| q[i] + shift[i]);
                xyz += &format!("{element} {x:.9} {y:.9} {z:.9}\n");
            }
        }
    }
    xyz
}

#[test]
fn a_trajectory_becomes_a_surface() {
    let room = Room::new();
    let ring = crosscap_algorithms::surfaces::RingConformations::new(8, 1.52, 130.0).unwrap();
    let drawn = ring.sample(12_000, 1).unwrap().points;
    room.write("ring.xyz", trajectory(&drawn));
    write_points(room.path("first.npy"), &drawn.select(&[0])).unwrap();
    let parameters = "--eps 0.25 --dl 0.14 --dp 0.08 --ep 0.03";
    let said = room
        .run(&format!(
            "reconstruct ring.xyz --atoms element:C --align kabsch --reference first.npy {parameters} -o ring.npz"
        ))
        .expect(0)
        .out;
    assert!(said.contains("in R^24"), "{said}");
    assert!(said.contains("meet in two circles"), "{said}");
    let mesh = read_mesh(room.path("ring.npz")).unwrap().mesh;
    // Its rows are those of the frames, and off the double curves its vertices the conformations, in the position of
    // the reference.
    let singular: Vec<u32> = mesh
        .complex
        .curve_edges
        .iter()
        .flat_map(|e| e.ends)
        .collect();
    let first = crosscap_algorithms::alignment::Alignment::new(
        drawn.point(0).as_chunks::<3>().0,
        &[1.0; 8],
    );
    let first = first.unwrap();
    for v in (0..mesh.complex.vertices).filter(|&v| !singular.contains(&(v as u32))) {
        let aligned = first.align(drawn.point(mesh.point_index[v] as usize)).place;
        let far = mesh.vertices.point(v).iter().zip(&aligned);
        assert!(far.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max) < 1e-7);
    }
    // The check reads the points in the same way.
    let check = "check ring.npz --points ring.xyz --atoms element:C --reference first.npy --local --eps 0.25";
    room.run(check)
        .expect(0)
        .says("all have Betti numbers 1, 0, 0");
}

#[test]
fn bad_molecules_are_refused_with_place_and_advice() {
    let room = Room::new();
    let frame = "4\n\nC 0 0 0\nX 1 0 0\nC 0 1 0\nH 0 0 1\n";
    room.write("a.xyz", frame.repeat(10));
    room.write("line.xyz", "3\n\nC 0 0 0\nC 1 0 0\nC 2 0 0\n".repeat(10));
    room.write("two.csv", "0,0\n1,1\n".repeat(10));
    let run = |arguments: &str| {
        room.run(&format!(
            "reconstruct {arguments} --eps 1 --dl 0.5 -o m.npz"
        ))
    };
    for (arguments, complaint) in [
        ("a.xyz --atoms 5", "expected 1 to 4"),
        ("a.xyz --atoms N", "which no atom is called"),
        ("a.xyz --align eckart", "for the element of atom 2 (\"X\")"),
        ("a.xyz --reference frame:11", "expected frame:1 to frame:10"),
        ("a.xyz --reference frame:0", "expected frame:1 to frame:10"),
        ("a.xyz --align none --reference frame:1", "leave it out"),
        ("a.xyz --reference line.xyz", "expected 12"),
        ("a.xyz --reference missing.xyz", "missing.xyz: no such file"),
        ("line.xyz --align kabsch", "on a line"),
        ("two.csv --align kabsch", "three coordinates an atom"),
        ("a.xyz --align best", "kabsch"),
    ] {
        run(arguments).expect(2).complains(complaint);
    }
    assert_eq!(room.files().len(), 3);
}

// Checks

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

// What files carry beside positions

#[test]
fn normals_are_no_dimensions() {
    let room = Room::new();
    room.run("sample sphere -o sphere.csv -n 2500 --seed 3")
        .expect(0);
    // A unit sphere about the origin: a place is its own normal.
    let rows = std::fs::read_to_string(room.path("sphere.csv")).unwrap();
    let doubled: String = rows.lines().map(|row| format!("{row},{row}\n")).collect();
    room.write("normals.xyz", doubled.replace(',', " "));
    let ran = room.run("reconstruct normals.xyz -o sphere.npz --eps 0.4 --dl 0.2 --surface");
    let ran = ran
        .expect(0)
        .says("1, 0, 1")
        .complains("columns 3 to 5 are unit normals");
    assert!(ran.err.contains("--columns all"), "{}", ran.err);
    assert_eq!(
        read_mesh(room.path("sphere.npz"))
            .unwrap()
            .mesh
            .vertices
            .dimension(),
        3
    );
    room.run("dimension normals.xyz --columns 0,9 --eps 0.4")
        .expect(2)
        .complains("found 6 columns without names, expected column 9 of --columns");
}

#[test]
fn completions_and_pages_of_the_manual() {
    let room = Room::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let words = room.run(&format!("completions {shell}")).expect(0);
        assert!(
            words.out.contains("reconstruct") && words.out.contains("columns"),
            "{shell}"
        );
    }
    room.run("completions man")
        .expect(0)
        .says(".TH crosscap")
        .says("reconstruct");
    room.run("completions man reconstruct")
        .expect(0)
        .says("columns");
    room.run("completions man reconstrut")
        .expect(2)
        .complains("expected one of demo, sample");
    room.run("completions zsh sample")
        .expect(2)
        .complains("COMMAND goes with man");
}

// Conversions and pictures

#[test]
fn meshes_survive_a_round_trip() {
    let room = Room::new();
    let spheres = two_spheres(8);
    room.mesh("a.npz", &spheres);
    let mut from = "a.npz".to_string();
    for to in ["b.vtu", "c.ply", "d.obj", "e.off", "f.npz"] {
        room.run(&format!("convert {from} {to}"))
            .expect(0)
            .says("28 vertices, 64 triangles");
        from = to.into();
    }
    let back = read_mesh(room.path("f.npz")).unwrap().mesh;
    assert_eq!(back.complex, spheres.complex);
    assert_eq!(back.vertices, spheres.vertices);
    for to in ["g.stl", "h.glb"] {
        room.run(&format!("convert a.npz {to}")).expect(0);
    }
    // A printer's file has no vertices of its own: those of its triangles are found again.
    room.run("check g.stl").says("1, 0, 3");
}

#[test]
fn meshes_of_four_dimensions_are_laid_out() {
    let room = Room::new();
    let torus = flat_torus(12);
    room.mesh("a.npz", &torus);
    for layout in ["", "--layout pca", "--layout isomap", "--layout xyz"] {
        room.run(&format!("convert a.npz b.ply {layout}")).expect(0);
        let flat = read_mesh(room.path("b.ply")).unwrap().mesh;
        assert_eq!(flat.vertices.dimension(), 3);
        assert_eq!(flat.complex.triangles, torus.complex.triangles);
    }
    // These keep all coordinates.
    for name in ["c.npz", "c.vtu"] {
        room.run(&format!("convert a.npz {name}")).expect(0);
        assert_eq!(
            read_mesh(room.path(name)).unwrap().mesh.vertices,
            torus.vertices
        );
    }
}

/// A trajectory of CHARMM without a cell.
fn dcd(frames: &[&[[f32; 3]]]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut record = |content: Vec<u8>| {
        let mark = (content.len() as u32).to_le_bytes();
        out.extend(mark);
        out.extend(content);
        out.extend(mark);
    };
    let mut header = b"CORD".to_vec();
    header.resize(84, 0);
    record(header);
    record(vec![0; 4]);
    record((frames[0].len() as u32).to_le_bytes().to_vec());
    for frame in frames {
        for axis in 0..3 {
            record(frame.iter().flat_map(|p| p[axis].to_le_bytes()).collect());
        }
    }
    out
}

#[test]
fn atoms_of_a_trajectory_have_the_names_of_its_topology() {
    let room = Room::new();
    let frame = |x: f32| [[x, 0.0, 0.0], [0.0, 1.0 + x, 0.0], [0.0, 0.0, 2.0]];
    let frames: Vec<_> = (0..40).map(|k| frame(k as f32 / 7.0)).collect();
    let frames: Vec<&[[f32; 3]]> = frames.iter().map(|f| &f[..]).collect();
    room.write("run.dcd", dcd(&frames));
    room.write("top.xyz", "3\nwater\nO 0 0 0\nH 0 1 0\nH 0 0 1\n");
    room.write("more.xyz", "2\n\nO 0 0 0\nH 0 1 0\n");
    room.run("dimension run.dcd -k 8 --estimator mle")
        .expect(0)
        .says("40 points of R^9");
    room.run("dimension run.dcd --topology top.xyz --atoms element:H -k 8 --estimator mle")
        .expect(0)
        .says("40 points of R^6");
    room.run("dimension run.dcd --atoms element:H -k 8")
        .expect(2)
        .complains("no atom is called");
    room.run("dimension run.dcd --topology more.xyz --atoms heavy -k 8")
        .expect(2)
        .complains("more.xyz: found 2 atoms, expected 3");
}

#[test]
fn points_are_shown_alone_and_with_their_mesh() {
    let room = Room::new();
    write_points(room.path("points.npy"), &ball(300)).unwrap();
    for name in ["points.html", "points.png"] {
        room.run(&format!("view points.npy -o {name}"))
            .expect(0)
            .says("300 points of R^3");
    }
    // A format of meshes and of points alike.
    write_points(room.path("points.ply"), &ball(300)).unwrap();
    room.run("view points.ply -o ply.html")
        .expect(0)
        .says("300 points of R^3");
    room.mesh("spheres.npz", &two_spheres(12));
    room.run("view spheres.npz --points points.npy -o both.html")
        .expect(0);
    let page = |name: &str| std::fs::read_to_string(room.path(name)).unwrap();
    for name in ["height", "dimension", "distance to the mesh"] {
        assert!(
            page("both.html").contains(&format!("\"name\":\"{name}\"")),
            "{name}"
        );
    }
    assert!(!page("points.html").contains("distance to the mesh"));
    room.run("view points.npy --points points.ply -o c.html")
        .expect(2)
        .complains("holds points and no mesh");
    room.run("view points.npy -o points.npy").expect(2);
}

#[test]
fn pictures_are_pages_and_images() {
    let room = Room::new();
    room.mesh("spheres.npz", &two_spheres(12));
    room.mesh("torus.npz", &flat_torus(12));
    for name in ["spheres", "torus"] {
        room.run(&format!("view {name}.npz -o {name}.html"))
            .expect(0)
            .says("piece");
        let page = std::fs::read_to_string(room.path(&format!("{name}.html"))).unwrap();
        assert!(page.starts_with("<!DOCTYPE html>"));
        for size in ["200x150", "64x64"] {
            room.run(&format!("view {name}.npz -o {name}.png --size {size}"))
                .expect(0);
            let image = std::fs::read(room.path(&format!("{name}.png"))).unwrap();
            assert_eq!(image_size(&image), size);
        }
    }
    room.run("view torus.npz -o pca.png --layout pca --size 64x64")
        .expect(0);
    let read = |name: &str| std::fs::read(room.path(name)).unwrap();
    assert_ne!(read("pca.png"), read("torus.png"));
}

/// Width and height from the header of a PNG image.
fn image_size(image: &[u8]) -> String {
    assert_eq!(&image[1..4], b"PNG");
    let side = |at: usize| u32::from_be_bytes(image[at..at + 4].try_into().unwrap());
    format!("{}x{}", side(16), side(20))
}

// Reconstruction

const SPHERE: &str = "--eps 0.5 --dl 0.25 --surface";

fn sphere_points(room: &Room) {
    room.run("sample sphere -n 3000 --seed 1 -o points.npy")
        .expect(0);
}

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

// The paper's table and the demonstration

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

// Dimension

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

// Comparison of metrics

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
