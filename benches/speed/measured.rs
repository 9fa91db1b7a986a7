//! What is measured, in the process that is measured.

use crate::Outcome;
use crosscap::prelude::*;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::moments::MomentTree;
use crosscap_algorithms::surfaces::Random;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::{PointOptions, read_points};
use crosscap_core::{
    CellNeighborhood, Landmark, SparseDistances, StratifiedLandmarks, Table, squared_distance,
};
use rustix::time::{ClockId, clock_gettime};
use serde_json::{Value, json};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::time::Instant;

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

/// The part of a measurement that runs in its own process.
pub(crate) fn by_name(name: &str, arguments: &[String]) -> Outcome<Value> {
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
