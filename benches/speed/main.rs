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

mod bench;
mod measured;
mod sections;

use bench::Bench;
use sections::SECTIONS;
use std::error::Error;
use std::path::PathBuf;

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    // Cargo adds --bench.
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if arguments.first().is_some_and(|a| a == "--measure") {
        let found = measured::by_name(&arguments[1], &arguments[2..])?;
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
