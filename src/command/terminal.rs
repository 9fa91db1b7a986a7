//! Standard output, standard error and progress.
//!
//! The macros of the standard library panic when the reader of a pipe has gone away, so they are not used.

use super::cost::time;
use super::failure::Failure;
use crosscap::Stage;
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::time::Duration;

/// Writes a line, or several, to standard output. A reader that has gone away is no failure.
pub fn say(text: impl Display) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::usage(format!(
            "standard output: cannot write: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes a message to standard error; nobody may be listening.
pub fn complain(message: impl Display) {
    let _ = writeln!(io::stderr(), "crosscap: {message}");
}

/// What is being done, with the time it takes; shown when standard error is a terminal.
#[derive(Clone)]
pub struct Progress(ProgressBar);

/// How far a run is at the beginning of a stage, percent of its time: means over torus, double torus, Klein bottle and two
/// spheres of 20,000 points.
fn percent_before(stage: Stage) -> u64 {
    match stage {
        Stage::Index => 0,
        Stage::Neighborhoods => 1,
        Stage::Landmarks => 42,
        Stage::Triangulation => 48,
        Stage::Homology => 51,
        Stage::Certificate => 52,
    }
}

/// What a run will still take if the rest goes like the part before; nothing while there is too little to go by.
fn remaining(spent: Duration, percent: u64) -> Option<Duration> {
    (percent > 1).then(|| spent.mul_f64((100 - percent.min(100)) as f64 / percent as f64))
}

impl Progress {
    /// A line that says what is being done and moves.
    pub fn new(task: impl Into<String>) -> Self {
        let bar = ProgressBar::new_spinner();
        bar.set_message(task.into());
        // Ticking needs a thread of its own, which nobody would see.
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(120));
        }
        Self(bar)
    }

    /// A run with stages: percent done, time since its start, about what remains.
    pub fn of_stages() -> Self {
        let bar = Self::new("starting");
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} [{elapsed}{prefix}]") {
            bar.0.set_style(style);
        }
        bar
    }

    /// A run with stages begins one. A round of refinement goes back to stages that were there before.
    pub fn enter(&self, stage: Stage) {
        let percent = percent_before(stage).max(self.0.position());
        self.0.set_position(percent);
        self.0.set_message(format!("{stage}, {percent} %"));
        let left = remaining(self.0.elapsed(), percent);
        let left = left.map_or_else(String::new, |left| format!(", about {} left", time(left)));
        self.0.set_prefix(left);
    }

    /// A bar of `count` steps.
    pub fn of(count: u64, task: impl Into<String>) -> Self {
        let bar = ProgressBar::new(count);
        if let Ok(style) = ProgressStyle::with_template(
            "{bar:30} {percent} % ({pos}/{len}) {msg} [{elapsed}, {eta} left]",
        ) {
            bar.set_style(style);
        }
        bar.set_message(task.into());
        Self(bar)
    }

    /// Says what comes next.
    pub fn stage(&self, stage: impl Display) {
        self.0.set_message(stage.to_string());
    }

    /// Hides the bar while something is printed.
    pub fn suspend<T>(&self, print: impl FnOnce() -> T) -> T {
        self.0.suspend(print)
    }

    /// One step of the bar is done.
    pub fn step(&self) {
        self.0.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_remains_follows_from_what_was_spent() {
        let spent = Duration::from_secs(42);
        assert_eq!(remaining(spent, 42), Some(Duration::from_secs(58)));
        assert_eq!(remaining(spent, 100), Some(Duration::ZERO));
        assert_eq!(remaining(spent, 0), None);
    }

    #[test]
    fn stages_come_in_order() {
        let stages = [
            Stage::Index,
            Stage::Neighborhoods,
            Stage::Landmarks,
            Stage::Triangulation,
            Stage::Homology,
            Stage::Certificate,
        ];
        assert!(stages.map(percent_before).is_sorted());
        let progress = Progress::of_stages();
        progress.enter(Stage::Triangulation);
        progress.enter(Stage::Landmarks);
        assert_eq!(progress.0.position(), 48);
    }
}
