//! Many threads, on rayon.

use crosscap_algorithms::execute::Execute;
use crosscap_core::Error;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::ops::Range;

/// A pool of threads of its own. Results do not depend on their number.
#[derive(Debug)]
pub struct Threads(ThreadPool);

impl Threads {
    /// `count` threads; 0 for one a processor.
    ///
    /// # Errors
    /// [`Error::Parameter`] when the system gives no threads.
    pub fn new(count: usize) -> Result<Self, Error> {
        rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .build()
            .map(Self)
            .map_err(|error| Error::Parameter {
                name: "threads",
                value: count.to_string(),
                expected: format!("a number of threads that the system gives ({error})"),
            })
    }

    /// Runs `work` with these threads: what it runs in parallel, it runs on them.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.0.install(work)
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        self.0.current_num_threads()
    }
}

impl Execute for Threads {
    fn ranges(&self, count: usize, job: &(dyn Fn(Range<usize>) + Sync)) {
        self.0
            .install(|| (0..count).into_par_iter().for_each(|i| job(i..i + 1)));
    }
}
