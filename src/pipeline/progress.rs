//! Where a reconstruction is, and how long each stage took.

use crosscap_backends::interrupt::Interrupt;
use serde::Serialize;
use std::fmt;
use std::time::Instant;

/// A step of the way, for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Stage {
    /// Building the neighborhood oracle.
    Index,
    /// Dimension and crossings at every point.
    Neighborhoods,
    /// Landmarks, chains and cells.
    Landmarks,
    /// Stars and repairs.
    Triangulation,
    /// Betti numbers, torsion, pieces.
    Homology,
    /// The verdict.
    Certificate,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Index => "index",
            Self::Neighborhoods => "neighborhoods",
            Self::Landmarks => "landmarks",
            Self::Triangulation => "triangulation",
            Self::Homology => "homology",
            Self::Certificate => "certificate",
        })
    }
}

/// Called at the beginning of every stage.
pub(super) type StageObserver = Box<dyn FnMut(Stage)>;

/// The stages gone through so far, with their seconds.
pub(super) struct Progress<'o> {
    observer: &'o mut StageObserver,
    interrupt: Interrupt,
    stages: Vec<(Stage, f64)>,
    running: Option<(Stage, Instant)>,
}

impl<'o> Progress<'o> {
    pub(super) fn new(observer: &'o mut StageObserver, interrupt: &Interrupt) -> Self {
        Self {
            observer,
            interrupt: interrupt.clone(),
            stages: Vec::new(),
            running: None,
        }
    }

    /// Begins a stage, which ends the one before, unless the run is to stop.
    pub(super) fn enter(&mut self, stage: Stage) {
        self.interrupt.heed();
        self.stop();
        self.running = Some((stage, Instant::now()));
        (self.observer)(stage);
    }

    fn stop(&mut self) {
        if let Some((stage, since)) = self.running.take() {
            let spent = since.elapsed().as_secs_f64();
            match self.stages.iter_mut().find(|s| s.0 == stage) {
                Some(s) => s.1 += spent,
                None => self.stages.push((stage, spent)),
            }
        }
    }

    /// Seconds by stage, in the order in which they were first entered.
    pub(super) fn finish(mut self) -> Vec<(Stage, f64)> {
        self.stop();
        self.stages
    }
}
