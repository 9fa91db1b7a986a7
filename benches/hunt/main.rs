//! A hunt for verified meshes that are wrong.
//!
//! ```text
//! cargo bench --bench hunt -- --runs 500 --seed 1             # small clouds around one feature each
//! cargo bench --bench hunt -- --family slit,cut --rule auto   # some families, parameters chosen by the program
//! cargo bench --bench hunt -- --runs 500 --seed 1 --even      # thinned points, of one density
//! cargo bench --bench hunt -- --seed 1 --only 37 --keep here  # one run again, its cloud kept
//! ```
//!
//! Run number r draws a cloud of the r-th family in turn (`surfaces::Feature`): 500 to 4,000 points, the feature 0.5 to 12
//! spacings, one cloud in three with a density that varies up to 30 times and one in three with noise up to half a spacing. It is
//! reconstructed at lengths by rule (eps the 99 percent quantile of the distance to the 60th neighbor, dl half of it, all
//! models), at random ones, or with nothing given at all, in turn. A mesh that is verified is *wrong*
//! when its Betti numbers over Q are not those of the surface, or when it and the surface are further from each other than
//! `TOO_FAR`, where a surface ends by what chance leaves empty there more; how many are wrong without that is told too. Each run is repeated by its seed and its number alone, whatever the families that are asked for.

mod even;
mod run;
mod tally;
mod truth;

use crosscap_algorithms::surfaces::Feature;
use run::{Rule, Run, Settings};
use std::error::Error as AnyError;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tally::Tally;

struct Options {
    runs: usize,
    families: Vec<String>,
    only: Option<usize>,
    threads: usize,
    /// Whether every run is printed.
    all: bool,
    settings: Settings,
}

fn options() -> Result<Options, Box<dyn AnyError>> {
    let mut options = Options {
        runs: 100,
        families: Vec::new(),
        only: None,
        threads: 1,
        all: false,
        settings: Settings {
            seed: 0,
            rule: None,
            points: [500, 4000],
            sizes: [0.5, 12.0],
            even: false,
            limit: Duration::from_secs(30),
            keep: None,
        },
    };
    let mut arguments = std::env::args().skip(1).filter(|a| a != "--bench");
    while let Some(name) = arguments.next() {
        if name == "--all" {
            options.all = true;
            continue;
        }
        if name == "--even" {
            options.settings.even = true;
            continue;
        }
        let value = arguments
            .next()
            .ok_or_else(|| format!("{name}: no value"))?;
        let settings = &mut options.settings;
        match name.as_str() {
            "--runs" => options.runs = value.parse()?,
            "--only" => options.only = Some(value.parse()?),
            "--threads" => options.threads = value.parse::<usize>()?.max(1),
            "--family" => options.families = value.split(',').map(Into::into).collect(),
            "--seed" => settings.seed = value.parse()?,
            "--limit" => settings.limit = Duration::from_secs(value.parse()?),
            "--keep" => settings.keep = Some(PathBuf::from(value)),
            "--rule" => settings.rule = Some(Rule::named(&value)?),
            "--points" => settings.points = pair(&value)?,
            "--sizes" => settings.sizes = pair(&value)?,
            _ => return Err(format!("{name}: not an option").into()),
        }
    }
    let known = |name: &&String| Feature::find(name).is_none();
    if let Some(name) = options.families.iter().find(known) {
        let names: Vec<&str> = Feature::all().map(|f| f.name).collect();
        return Err(format!("{name}: none of {}", names.join(", ")).into());
    }
    Ok(options)
}

/// Two numbers with a colon between them.
fn pair<T: std::str::FromStr<Err: AnyError + 'static>>(
    text: &str,
) -> Result<[T; 2], Box<dyn AnyError>> {
    let (low, high) = text
        .split_once(':')
        .ok_or_else(|| format!("{text}: expected LOW:HIGH"))?;
    Ok([low.parse()?, high.parse()?])
}

fn main() -> Result<(), Box<dyn AnyError>> {
    let options = options()?;
    if let Some(folder) = &options.settings.keep {
        std::fs::create_dir_all(folder)?;
    }
    let features: Vec<Feature> = Feature::all().collect();
    let asked = |run: &usize| {
        let name = features[run % features.len()].name;
        options.families.is_empty() || options.families.iter().any(|f| f == name)
    };
    let runs: Vec<usize> = match options.only {
        Some(run) => vec![run],
        None => (0..).filter(asked).take(options.runs).collect(),
    };
    let (next, tally) = (AtomicUsize::new(0), Mutex::new(Tally::default()));
    let work = || -> Result<(), String> {
        while let Some(&number) = runs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let run = Run::made(&features, number, &options.settings)
                .map_err(|error| format!("run {number}: {error}"))?;
            if options.all || run.is_wrong() || run.is_off_at_end() || options.only.is_some() {
                println!("{run}");
            }
            tally.lock().map_err(|e| e.to_string())?.add(&run);
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..options.threads).map(|_| scope.spawn(work)).collect();
        let ends = workers.into_iter().map(|worker| worker.join());
        ends.into_iter()
            .try_for_each(|end| end.map_err(|_| "a run panicked".to_string())?)
    })?;
    println!("\n{}", tally.into_inner().map_err(|e| e.to_string())?);
    Ok(())
}
