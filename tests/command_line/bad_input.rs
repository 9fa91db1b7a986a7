//! Files that are broken.

use crate::room::{Room, two_spheres};
use std::process::{Command, Stdio};

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
