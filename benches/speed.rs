//! What a reconstruction costs: CPU seconds, wall seconds and peak memory.
//!
//! ```text
//! cargo bench                                      # every section but the largest clouds
//! cargo bench -- two-spheres closed                # some sections
//! cargo bench -- --full                            # with 1,031,644 points in R^24, and 10^7 in R^3
//! CROSSCAP_PEERS=../shared/peers cargo bench       # side by side with other people's programs
//! ```
//!
//! Every measurement is a process of its own, so that peak memory and CPU seconds (all threads, from
//! the start of the process) are its own, too. `CROSSCAP_PEERS` names a folder with `run_nn_pca.py` and
//! `run_tdc.py`, `CROSSCAP_PYTHON` the interpreter for them (python3 otherwise).

use crosscap::prelude::*;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::landmarks::RandomGreedy;
use crosscap_algorithms::moments::MomentTree;
use crosscap_algorithms::surfaces::{Random, RingConformations};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::{PointOptions, read_points, write_points};
use crosscap_core::{
    CellNeighborhood, Landmark, SparseDistances, StratifiedLandmarks, Table, squared_distance,
};
use rustix::time::{ClockId, clock_gettime};
use serde_json::{Value, json};
use std::cell::RefCell;
use std::collections::HashMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::rc::Rc;
use std::time::Instant;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Seconds that all threads of this process have run.
fn cpu() -> f64 {
    let t = clock_gettime(ClockId::ProcessCPUTime);
    t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
}

/// Largest resident set of this process so far, in MiB; 0 where the system does not tell.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|rest| rest.trim().trim_end_matches("kB").trim().parse().ok())
        .map_or(0.0, |kib: f64| kib / 1024.0)
}

/// A section: its name, and what it prints.
type Section = (&'static str, fn(&Bench) -> Outcome<()>);

const SECTIONS: [Section; 6] = [
    ("two-spheres", two_spheres),
    ("closed", closed),
    ("triangulation", triangulation),
    ("preprocessing", preprocessing),
    ("threads", threads),
    ("cyclo-octane", cyclo_octane),
];

/// Points of the full sample of cyclo-octane.
const CONFORMATIONS: usize = 1_031_644;

struct Bench {
    folder: PathBuf,
    peers: Option<PathBuf>,
    python: String,
    full: bool,
}

impl Bench {
    /// Runs a measurement in a process of its own; what it found comes back as JSON.
    fn measure(&self, name: &str, arguments: &[String]) -> Outcome<Value> {
        let out = Command::new(std::env::current_exe()?)
            .arg("--measure")
            .arg(name)
            .args(arguments)
            .output()?;
        if !out.status.success() {
            return Err(format!(
                "{name} {arguments:?}: {}",
                String::from_utf8_lossy(&out.stderr)
            )
            .into());
        }
        Ok(serde_json::from_slice(&out.stdout)?)
    }

    /// The same a few times, the one of least CPU seconds.
    fn best(&self, rounds: usize, name: &str, arguments: &[String]) -> Outcome<Value> {
        let mut best: Option<Value> = None;
        for _ in 0..rounds {
            let found = self.measure(name, arguments)?;
            if best
                .as_ref()
                .is_none_or(|b| number(&found, "cpu") < number(b, "cpu"))
            {
                best = Some(found);
            }
        }
        best.ok_or_else(|| "no round".into())
    }

    /// Runs a program of others, which prints one line of JSON; `None` without `CROSSCAP_PEERS`.
    fn peer(&self, script: &str, arguments: &[&str]) -> Outcome<Option<Value>> {
        let Some(peers) = &self.peers else {
            return Ok(None);
        };
        let out = Command::new(&self.python)
            .arg(peers.join(script))
            .args(arguments)
            .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")])
            .output()?;
        if !out.status.success() {
            return Err(format!("{script}: {}", String::from_utf8_lossy(&out.stderr)).into());
        }
        Ok(Some(serde_json::from_slice(&out.stdout)?))
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or(f64::NAN)
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

fn main() -> Outcome<()> {
    // Cargo adds --bench.
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if arguments.first().is_some_and(|a| a == "--measure") {
        let found = measured(&arguments[1], &arguments[2..])?;
        println!("{found}");
        return Ok(());
    }
    let folder = std::env::temp_dir().join(format!("crosscap-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let bench = Bench {
        peers: std::env::var_os("CROSSCAP_PEERS").map(PathBuf::from),
        python: std::env::var("CROSSCAP_PYTHON").unwrap_or_else(|_| "python3".into()),
        full: arguments.iter().any(|a| a == "--full"),
        folder,
    };
    let asked: Vec<&String> = arguments.iter().filter(|a| !a.starts_with("--")).collect();
    if let Some(unknown) = asked
        .iter()
        .find(|a| SECTIONS.iter().all(|s| s.0 != a.as_str()))
    {
        let names = SECTIONS.map(|s| s.0).join(", ");
        return Err(format!("{unknown}: expected one of {names}").into());
    }
    let mut result = Ok(());
    for (name, section) in SECTIONS {
        let wanted = asked.is_empty() || asked.iter().any(|a| *a == name);
        if wanted && result.is_ok() {
            println!("\n## {name}");
            result = section(&bench);
        }
    }
    std::fs::remove_dir_all(&bench.folder)?;
    result
}

/// The part of a measurement that runs in its own process.
fn measured(name: &str, arguments: &[String]) -> Outcome<Value> {
    match name {
        "reconstruct" => reconstruct(arguments),
        "triangulate" => triangulate(arguments),
        "dimensions" => dimensions(arguments),
        "first-step" => first_step(arguments),
        other => Err(format!("no measurement {other}").into()),
    }
}

/// Arguments `FILE key=value ...`: from the file to the mesh, CPU seconds of every stage.
fn reconstruct(arguments: &[String]) -> Outcome<Value> {
    let begin = Instant::now();
    let mut parameters = Parameters::new(1.0, 1.0);
    let settings: HashMap<&str, &str> = arguments[1..]
        .iter()
        .filter_map(|a| a.split_once('='))
        .collect();
    let of = |key: &str| -> Outcome<f64> {
        Ok(settings
            .get(key)
            .ok_or(format!("{key} is missing"))?
            .parse()?)
    };
    (parameters.eps, parameters.dl) = (of("eps")?, of("dl")?);
    parameters.dp = of("dp").unwrap_or(parameters.eps / 5.0);
    parameters.ep = of("ep").unwrap_or(parameters.eps / 10.0);
    parameters.threads = Some(of("threads").unwrap_or(1.0) as usize);
    parameters.surface = settings.contains_key("surface");
    parameters.seed = of("seed").unwrap_or(0.0) as u64;
    let cloud = read_points(&arguments[0], &PointOptions::default())?.into_f64();
    let read = cpu();
    type Stages = Vec<(Stage, f64, f64)>;
    let stages: Rc<RefCell<Stages>> = Rc::default();
    let seen = Rc::clone(&stages);
    let mut pipeline = Pipeline::new(parameters)?.on_stage(move |stage| {
        let now = (stage, cpu(), begin.elapsed().as_secs_f64());
        seen.borrow_mut().push(now);
    });
    let start = begin.elapsed().as_secs_f64();
    let found = pipeline.reconstruct(&cloud)?;
    let end = cpu();
    let stages = stages.borrow();
    let mut spent: HashMap<String, f64> = HashMap::new();
    for (k, (stage, since, _)) in stages.iter().enumerate() {
        let until = stages.get(k + 1).map_or(end, |s| s.1);
        *spent.entry(stage.to_string()).or_default() += until - since;
    }
    // Everything before the first triangulation.
    let (_, before, wall) = *stages
        .iter()
        .find(|s| s.0 == Stage::Triangulation)
        .ok_or("no triangulation")?;
    Ok(json!({
        "points": cloud.len(),
        "verified": found.is_verified(),
        "betti": found.homology.betti_rational,
        "landmarks": found.report.landmarks.landmarks,
        "candidates": found.report.candidates,
        "neighbors": found.report.mean_neighbors,
        "read": read,
        "before": before - read,
        "before_wall": wall - start,
        "stages": spent,
        "cpu": cpu(),
        "wall": begin.elapsed().as_secs_f64(),
        "peak": peak(),
    }))
}

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

/// A flat torus in R^4 with landmarks on a disturbed hexagonal lattice of `rows` rows, spacing 1.
fn flat_torus(rows: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let rows = rows.next_multiple_of(2);
    let tau = std::f64::consts::TAU;
    let (width, height) = (rows as f64, rows as f64 * 0.75_f64.sqrt());
    let (r, s) = (width / tau, height / tau);
    let mut out = Vec::with_capacity(4 * rows * rows);
    for j in 0..rows {
        for i in 0..rows {
            let x = i as f64 + 0.5 * (j % 2) as f64 + 0.4 * (random.uniform() - 0.5);
            let y = j as f64 * 0.75_f64.sqrt() + 0.4 * (random.uniform() - 0.5);
            let (a, b) = (x / r, y / s);
            out.extend([r * a.cos(), r * a.sin(), s * b.cos(), s * b.sin()]);
        }
    }
    out
}

/// The waist of landmarks on a closed surface: all within 3 spacings are one neighborhood.
fn waist(places: PointCloud<f64>) -> Outcome<StratifiedLandmarks<f64>> {
    let count = places.len();
    let oracle = EuclideanOracle::new(places)?;
    let mut near = Vec::new();
    let neighborhoods: Vec<CellNeighborhood> = (0..count)
        .map(|center| {
            oracle.within(center, 3.0, &mut near);
            let members = near.iter().map(|x| Landmark::new(x.index));
            CellNeighborhood::new(Landmark::new(center), members)
        })
        .collect();
    let cloud = oracle.cloud();
    let distances = SparseDistances::within(count, &neighborhoods, |a, b| {
        squared_distance(cloud.point(a.index()), cloud.point(b.index())).sqrt()
    })?;
    let strata = Table::filled(count, 2);
    let waist = StratifiedLandmarks::new(strata, Vec::new(), neighborhoods, distances)?;
    Ok(waist)
}

/// Argument: rows of the lattice. Triangulation alone.
fn triangulate(arguments: &[String]) -> Outcome<Value> {
    let rows: usize = arguments[0].parse()?;
    let input = waist(PointCloud::new(4, flat_torus(rows, 7))?)?;
    let (before, memory) = (cpu(), peak());
    let pipeline = Pipeline::new(Parameters::new(3.0, 1.0).surface())?;
    let found = pipeline.triangulate(&input)?;
    let count = input.strata().len();
    Ok(json!({
        "landmarks": count,
        "cpu": cpu() - before,
        "input": memory,
        "peak": peak(),
        "open": found.incomplete.len(),
        "dropped": found.dropped.len(),
        "triangles": found.complex.triangles.len(),
        "torus": found.complex.triangles.len() == 2 * count,
    }))
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

/// Arguments: points, threads. Two spheres with a fixed number of neighbors, as far as the waist.
fn dimensions(arguments: &[String]) -> Outcome<Value> {
    let count: usize = arguments[0].parse()?;
    let threads: usize = arguments[1].parse()?;
    let sample = SampleSurface::find("two_spheres")?.sample(&Sampling::new(count, 3))?;
    let cloud = sample.points;
    let (before, memory, begin) = (cpu(), peak(), Instant::now());
    // 200 neighbors whatever the number of points; the other lengths in proportion.
    let area = 8.0 * std::f64::consts::PI * 0.854;
    let eps = (200.0 * area / (count as f64 * std::f64::consts::PI)).sqrt();
    let parameters = Parameters {
        threads: Some(threads),
        ..Parameters::new(eps, 0.5 * eps)
    };
    type Stages = Vec<(Stage, f64, f64, f64)>;
    let stages: Rc<RefCell<Stages>> = Rc::default();
    let seen = Rc::clone(&stages);
    let mut pipeline = Pipeline::new(parameters)?.on_stage(move |stage| {
        let now = (stage, cpu(), begin.elapsed().as_secs_f64(), peak());
        seen.borrow_mut().push(now);
    });
    let found = pipeline.reconstruct(&cloud)?;
    let stages = stages.borrow();
    let first = stages.iter().position(|s| s.0 == Stage::Triangulation);
    let first = first.ok_or("no triangulation")?;
    let (_, end, wall, peak) = stages[first];
    Ok(json!({
        "points": count,
        "neighbors": found.report.mean_neighbors,
        "cpu": end - before,
        "wall": wall,
        "landmarks": found.report.landmarks.landmarks,
        "triangulation": stages.get(first + 1).map_or(0.0, |s| s.1 - end),
        "input": memory,
        "peak": peak,
        "mesh": found.mesh.complex,
    }))
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

/// Arguments: file, eps. The dimension of every neighborhood and nothing else, in one thread.
fn first_step(arguments: &[String]) -> Outcome<Value> {
    let cloud = read_points(&arguments[0], &PointOptions::default())?.into_f64();
    let before = cpu();
    let tree = MomentTree::new(&cloud)?;
    let found = tree.settled_dimensions(arguments[1].parse()?, 0.05, &Serial)?;
    Ok(json!({
        "cpu": cpu() - before,
        "peak": peak(),
        "higher": found.iter().filter(|d| d.dimension > 2).count(),
    }))
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
