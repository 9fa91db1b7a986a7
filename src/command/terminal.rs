//! Standard output, standard error and progress.
//!
//! The macros of the standard library panic when the reader of a pipe has gone away, so they are not used.

use super::failure::Failure;
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

    /// A bar of `count` steps.
    pub fn of(count: u64, task: impl Into<String>) -> Self {
        let bar = ProgressBar::new(count);
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} [{elapsed}, {eta} left]")
        {
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
