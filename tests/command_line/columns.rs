//! What files carry beside positions, completions and the manual.

use crate::room::Room;
use crosscap_backends::files::read_mesh;

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
