//! Help, and command lines that make no sense.

use crate::room::{Room, ball, octahedron};
use crosscap_backends::files::write_points;

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
