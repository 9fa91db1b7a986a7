//! A limit of memory.

use crate::room::{Ran, Room};
use crosscap_algorithms::surfaces::{SampleSurface, Sampling};
use crosscap_backends::files::write_points;
use crosscap_core::PointCloud;

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
    room.run("reconstruct p.npy -o m.npz --surface --memory-limit 258MiB")
        .expect(2)
        .complains("looks at all points together")
        .complains("--memory-limit 258MiB --eps ")
        .complains("else --memory-limit");
    room.run(&format!("{run} --metric geodesic --memory-limit 258MiB"))
        .expect(2)
        .complains("parameter metric")
        .complains("--eps 0.6 --dl 0.3 and no other choice but --models");
    room.run(&format!("{run} --memory-limit 20MiB"))
        .expect(2)
        .complains("in tiles, too");
}

#[cfg(target_os = "linux")]
#[test]
fn crossings_are_worked_on_in_tiles() {
    let room = Room::new();
    // Two of the spheres cross.
    let sphere = SampleSurface::find("sphere").unwrap();
    let sphere = sphere.sample(&Sampling::new(40_000, 4)).unwrap().points;
    let row = (0..12).flat_map(|k| {
        let along = [0.0, 1.5][k.min(1)] + 4.0 * k.saturating_sub(1) as f64;
        let places = sphere.iter();
        places.flat_map(move |p| [p[0] + along, p[1], p[2] + 0.1 * along])
    });
    write_points(
        room.path("p.npy"),
        &PointCloud::new(3, row.collect()).unwrap(),
    )
    .unwrap();
    let run = "reconstruct p.npy -o m.npz --eps 0.4 --dl 0.2 --threads 2";
    room.run(run).expect(0).says("Betti numbers 11, 0, 13");
    let mesh = std::fs::read(room.path("m.npz")).unwrap();
    let limit = 325;
    let tiled = room
        .run(&format!("{run} --memory-limit {limit}MiB"))
        .expect(0)
        .complains("tiles on")
        .says("(verified)");
    assert!(held(&tiled) <= limit, "{}", tiled.err);
    assert!(std::fs::read(room.path("m.npz")).unwrap() == mesh);
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
