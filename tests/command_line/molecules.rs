//! Trajectories of molecules.

use crate::room::Room;
use crosscap_algorithms::surfaces::Random;
use crosscap_backends::files::{read_mesh, write_points};
use crosscap_core::PointCloud;

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
