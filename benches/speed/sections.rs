//! What is printed.

use crate::Outcome;
use crate::bench::{Bench, number, text};
use crosscap::prelude::*;
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::surfaces::RingConformations;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::write_points;
use serde_json::Value;

/// A section: its name, and what it prints.
pub(crate) type Section = (&'static str, fn(&Bench) -> Outcome<()>);

pub(crate) const SECTIONS: [Section; 6] = [
    ("two-spheres", two_spheres),
    ("closed", closed),
    ("triangulation", triangulation),
    ("preprocessing", preprocessing),
    ("threads", threads),
    ("cyclo-octane", cyclo_octane),
];

/// Points of the full sample of cyclo-octane.
const CONFORMATIONS: usize = 1_031_644;

fn stages(found: &Value) -> String {
    [
        "index",
        "neighborhoods",
        "landmarks",
        "triangulation",
        "homology",
        "certificate",
    ]
    .map(|s| format!("{s} {:.3}", number(&found["stages"], s)))
    .join(", ")
}

fn two_spheres(bench: &Bench) -> Outcome<()> {
    let sampling = Sampling {
        thinning: Some(0.01),
        ..Sampling::new(200_000, 1)
    };
    let sample = SampleSurface::find("two_spheres")?.sample(&sampling)?;
    let file = bench.file("two_spheres.npy");
    write_points(&file, &sample.points)?;
    let arguments: Vec<String> = [text(&file)]
        .into_iter()
        .chain(["eps=0.25", "dl=0.1", "dp=0.05", "ep=0.05"].map(String::from))
        .collect();
    let found = bench.best(3, "reconstruct", &arguments)?;
    println!(
        "{} points in R^3, {:.0} neighbors, {} not 2-dimensional, {} landmarks, Betti numbers {}, verified {}",
        found["points"],
        number(&found, "neighbors"),
        found["candidates"],
        found["landmarks"],
        found["betti"],
        found["verified"]
    );
    println!(
        "before the triangulation {:.3} CPU s; whole {:.3}; {:.0} MiB; {}",
        number(&found, "before"),
        number(&found, "cpu"),
        number(&found, "peak"),
        stages(&found)
    );
    if let Some(peer) = bench.peer("run_nn_pca.py", &[&text(&file), "0.25"])? {
        let theirs = number(&peer, "build_cpu_s")
            + number(&peer, "query_cpu_s")
            + number(&peer, "pca_cpu_s");
        println!(
            "scipy kd-tree and numpy PCA (dimension alone) {theirs:.2} CPU s: {:.1} times as much",
            theirs / number(&found, "before")
        );
    }
    Ok(())
}

/// Name, points, parameters of the paper.
const CLOSED: [(&str, usize, f64, f64); 5] = [
    ("sphere", 10_000, 0.4, 0.1),
    ("torus", 10_000, 1.0, 0.3),
    ("double_torus", 20_000, 1.2, 0.3),
    ("klein_r5", 10_000, 1.0, 0.25),
    ("rp2_r6", 100_000, 0.35, 0.1),
];

fn closed(bench: &Bench) -> Outcome<()> {
    for (name, count, eps, dl) in CLOSED {
        let sample = SampleSurface::find(name)?.sample(&Sampling::new(count, 1))?;
        let oracle = EuclideanOracle::new(sample.points.clone())?;
        let all: Vec<usize> = (0..sample.points.len()).collect();
        let rows = RandomGreedy::new().select(&oracle, &all, &[], dl, 1)?;
        let file = bench.file(&format!("{name}.npy"));
        write_points(&file, &sample.points.select(&rows))?;
        let arguments = [
            text(&file),
            format!("eps={eps}"),
            format!("dl={dl}"),
            "surface=1".into(),
        ];
        let found = bench.best(5, "reconstruct", &arguments)?;
        print!(
            "{name}: {} landmarks, Betti numbers {}, verified {}: whole process {:.3} CPU s",
            found["landmarks"],
            found["betti"],
            found["verified"],
            number(&found, "cpu")
        );
        if let Some(peer) =
            bench.peer("run_tdc.py", &[&text(&file), "60", &(0.5 * dl).to_string()])?
        {
            let fix = peer["fix_cpu_s"].as_f64().unwrap_or(0.0);
            let theirs = number(&peer, "cpu_s") + fix;
            print!("; tangential complex {theirs:.3} (of it perturbation {fix:.3})");
        }
        println!();
    }
    Ok(())
}

fn triangulation(bench: &Bench) -> Outcome<()> {
    let mut last: Option<(f64, f64)> = None;
    for rows in [100, 316, 1000] {
        let found = bench.measure("triangulate", &[rows.to_string()])?;
        let (count, cpu) = (number(&found, "landmarks"), number(&found, "cpu"));
        print!(
            "flat torus in R^4, {count} landmarks: {cpu:.2} CPU s, {:.0} MiB of which the waist {:.0}, closed {}, {} open, {} given up",
            number(&found, "peak"),
            number(&found, "input"),
            found["torus"],
            found["open"],
            found["dropped"]
        );
        exponent(&mut last, count, cpu);
    }
    Ok(())
}

/// Prints how the cost grew since the size before.
fn exponent(last: &mut Option<(f64, f64)>, size: f64, cost: f64) {
    match last.replace((size, cost)) {
        Some((n, c)) => println!("; exponent {:.2}", (cost / c).ln() / (size / n).ln()),
        None => println!(),
    }
}

fn preprocessing(bench: &Bench) -> Outcome<()> {
    let mut last = None;
    let mut sizes = vec![100_000, 1_000_000];
    if bench.full {
        sizes.push(10_000_000);
    }
    for count in sizes {
        let found = bench.measure("dimensions", &[count.to_string(), "1".into()])?;
        print!(
            "two spheres, {count} points, {:.0} neighbors: {:.2} CPU s, {:.0} MiB of which the points {:.0}; {} landmarks triangulated in {:.2} CPU s",
            number(&found, "neighbors"),
            number(&found, "cpu"),
            number(&found, "peak"),
            number(&found, "input"),
            found["landmarks"],
            number(&found, "triangulation")
        );
        exponent(&mut last, count as f64, number(&found, "cpu"));
    }
    Ok(())
}

fn threads(bench: &Bench) -> Outcome<()> {
    let run = |threads: usize| bench.measure("dimensions", &["400000".into(), threads.to_string()]);
    let (one, two) = (run(1)?, run(2)?);
    println!(
        "two spheres, 400000 points, before the triangulation: 1 thread {:.2} s of wall time, 2 threads {:.2}: {:.2} times; same mesh {}",
        number(&one, "wall"),
        number(&two, "wall"),
        number(&one, "wall") / number(&two, "wall"),
        one["mesh"] == two["mesh"]
    );
    Ok(())
}

fn cyclo_octane(bench: &Bench) -> Outcome<()> {
    let ring = RingConformations::cyclo_octane();
    let count = if bench.full {
        CONFORMATIONS
    } else {
        CONFORMATIONS / 8
    };
    let file = bench.file("cyclo_octane.npy");
    write_points(&file, &ring.sample(count, 1)?.points)?;
    let first = bench.best(2, "first-step", &[text(&file), "0.23".into()])?;
    let own = number(&first, "cpu");
    println!(
        "{count} points in R^24, dimension of every neighborhood, one thread: {own:.2} CPU s, {:.0} MiB, {} of dimension 3 and more",
        number(&first, "peak"),
        first["higher"]
    );
    if let Some(peer) = bench.peer("run_nn_pca.py", &[&text(&file), "0.23", "2000"])? {
        let theirs = number(&peer, "extrapolated_cpu_s");
        println!(
            "scipy kd-tree and numpy PCA, extrapolated from 2,000 points: {theirs:.0} CPU s, {:.0} times as much",
            theirs / own
        );
    }
    let run = |dl: f64, threads: usize| {
        let arguments: Vec<String> = [
            text(&file),
            format!("dl={dl}"),
            format!("threads={threads}"),
        ]
        .into_iter()
        .chain(["eps=0.23", "dp=0.05", "ep=0.02"].map(String::from))
        .collect();
        bench.measure("reconstruct", &arguments)
    };
    let [one, two] = [run(0.12, 1)?, run(0.12, 2)?].map(|r| number(&r, "before_wall"));
    println!(
        "before the triangulation: 1 thread {one:.2} s of wall time, 2 threads {two:.2}: {:.2} times",
        one / two
    );
    for dl in [0.12, 0.11, 0.10, 0.09, 0.08] {
        let found = run(dl, 0)?;
        println!(
            "{count} points in R^24, dl {dl}: {} landmarks, Betti numbers {}, verified {}: {:.1} s of wall time, {:.1} CPU s, {:.0} MiB; {}",
            found["landmarks"],
            found["betti"],
            found["verified"],
            number(&found, "wall"),
            number(&found, "cpu"),
            number(&found, "peak"),
            stages(&found)
        );
    }
    Ok(())
}
