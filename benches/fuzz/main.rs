//! Inputs that nobody would make on purpose, millions of them: no panic, no hang, bounded memory.
//!
//! ```text
//! cargo bench --bench fuzz -- --inputs 1000000 --seed 1          # all three targets in turn
//! cargo bench --bench fuzz -- --target files --inputs 10000000   # one of them
//! cargo bench --bench fuzz -- --target clouds --seed 1 --only 37 # one input again
//! ```
//!
//! `files` changes valid files of every format and gives them to every reader; `meshes` gives triangles and curves that fit nothing to homology, pieces and
//! certificate; `clouds` gives small clouds (equal, on a line, in a plane, huge, denormal, crossing ...) to the pipeline, with parameters chosen by the program and drawn at
//! random, and every tenth twice: both meshes must be the same. Every input comes from the seed and its number alone. The first fault stops the run, with the command that repeats it.

mod clouds;
mod files;
mod memory;
mod meshes;

use crosscap_algorithms::surfaces::Random;
use std::collections::BTreeMap;
use std::error::Error as AnyError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::exit;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// What can be attacked.
#[derive(Clone, Copy, PartialEq)]
enum Target {
    Files,
    Meshes,
    Clouds,
}

impl Target {
    const ALL: [Self; 3] = [Self::Files, Self::Meshes, Self::Clouds];

    fn name(self) -> &'static str {
        match self {
            Self::Files => "files",
            Self::Meshes => "meshes",
            Self::Clouds => "clouds",
        }
    }

    /// How much memory one input may take at a time, bytes: an input is at most a few kilobytes.
    fn memory_limit(self) -> usize {
        match self {
            Self::Files => 16 << 20,
            Self::Meshes => 128 << 20,
            Self::Clouds => 256 << 20,
        }
    }
}

struct Options {
    inputs: usize,
    seed: u64,
    targets: Vec<Target>,
    only: Option<usize>,
    /// Longer than this is a hang.
    limit: Duration,
}

fn options() -> Result<Options, Box<dyn AnyError>> {
    let mut options = Options {
        inputs: 3000,
        seed: 0,
        targets: Target::ALL.to_vec(),
        only: None,
        limit: Duration::from_secs(60),
    };
    let mut arguments = std::env::args().skip(1).filter(|a| a != "--bench");
    while let Some(name) = arguments.next() {
        let value = arguments
            .next()
            .ok_or_else(|| format!("{name}: no value"))?;
        match name.as_str() {
            "--inputs" => options.inputs = value.parse()?,
            "--seed" => options.seed = value.parse()?,
            "--only" => options.only = Some(value.parse()?),
            "--limit" => options.limit = Duration::from_secs(value.parse()?),
            "--target" => {
                let named = Target::ALL.into_iter().find(|t| t.name() == value);
                options.targets = vec![named.ok_or("--target: files, meshes or clouds")?];
            }
            _ => return Err(format!("{name}: not an option").into()),
        }
    }
    Ok(options)
}

/// The input that is worked on, and since when.
static CURRENT: Mutex<Option<(String, Instant)>> = Mutex::new(None);

fn set_current(what: Option<String>) {
    let mut current = CURRENT.lock().unwrap_or_else(|e| e.into_inner());
    *current = what.map(|what| (what, Instant::now()));
}

/// A hang cannot be stopped from within: another thread looks on, and ends the program.
fn watch(limit: Duration) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_millis(500));
            let current = CURRENT.lock().unwrap_or_else(|e| e.into_inner());
            if let Some((what, since)) = &*current
                && since.elapsed() > limit
            {
                println!("hang: more than {} s\n{what}", limit.as_secs());
                exit(1);
            }
        }
    });
}

fn main() -> Result<(), Box<dyn AnyError>> {
    let options = options()?;
    let folder = tempfile::tempdir()?;
    let corpus = files::Corpus::new();
    watch(options.limit);
    let mut tally: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    let mut most = BTreeMap::new();
    let numbers = match options.only {
        Some(number) => number..number + 1,
        None => 0..options.inputs,
    };
    for number in numbers {
        let target = options.targets[number % options.targets.len()];
        let mut random = Random::stream(options.seed, number as u64);
        let repeat = format!(
            "repeat it with: cargo bench --bench fuzz -- --seed {} --only {number}",
            options.seed
        ) + &match options.targets.len() {
            1 => format!(" --target {}", target.name()),
            _ => String::new(),
        };
        set_current(Some(repeat.clone()));
        memory::start();
        let end = catch_unwind(AssertUnwindSafe(|| match target {
            Target::Files => files::run(&corpus, &mut random, folder.path()),
            Target::Meshes => meshes::run(&mut random),
            Target::Clouds => clouds::run(&mut random),
        }));
        let peak = memory::peak();
        set_current(None);
        let Ok(end) = end else {
            println!("panic\n{repeat}");
            exit(1);
        };
        if peak > target.memory_limit() {
            println!("{} MiB at a time\n{repeat}", peak >> 20);
            exit(1);
        }
        *tally.entry((target.name(), end)).or_default() += 1;
        let most = most.entry(target.name()).or_insert(0);
        *most = peak.max(*most);
    }
    for ((target, end), count) in tally {
        println!("{target:8}{end:14}{count:10}");
    }
    for (target, peak) in most {
        println!("{target:8}at most {:.1} MiB", peak as f64 / 1_048_576.0);
    }
    Ok(())
}
