//! Measurements, each in a process of its own.

use crate::Outcome;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where files go, and what there is to compare with.
pub(crate) struct Bench {
    pub(crate) folder: PathBuf,
    pub(crate) peers: Option<PathBuf>,
    pub(crate) python: String,
    pub(crate) full: bool,
}

impl Bench {
    /// Runs a measurement in a process of its own; what it found comes back as JSON.
    pub(crate) fn measure(&self, name: &str, arguments: &[String]) -> Outcome<Value> {
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
    pub(crate) fn best(&self, rounds: usize, name: &str, arguments: &[String]) -> Outcome<Value> {
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
    pub(crate) fn peer(&self, script: &str, arguments: &[&str]) -> Outcome<Option<Value>> {
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

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

pub(crate) fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or(f64::NAN)
}

pub(crate) fn text(path: &Path) -> String {
    path.display().to_string()
}
