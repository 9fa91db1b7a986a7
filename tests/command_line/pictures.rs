//! Conversions and pictures.

use crate::room::{Room, ball, flat_torus, image_size, two_spheres};
use crosscap_backends::files::{read_mesh, write_points};

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
