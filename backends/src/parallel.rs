//! Many threads, on rayon.

use crate::interrupt::Interrupt;
use crosscap_algorithms::execute::Execute;
use crosscap_core::Error;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::ops::Range;

/// A pool of threads of its own. Results do not depend on their number.
#[derive(Debug)]
pub struct Threads {
    pool: ThreadPool,
    interrupt: Interrupt,
}

impl Threads {
    /// `count` threads; 0 for one a processor.
    ///
    /// # Errors
    /// [`Error::Parameter`] when the system gives no threads.
    pub fn new(count: usize) -> Result<Self, Error> {
        Self::heeding(count, &Interrupt::default())
    }

    /// The same for a run that can be stopped: every job asks first, and [`Interrupt::guard`] has to be around them.
    ///
    /// # Errors
    /// [`Error::Parameter`] when the system gives no threads.
    pub fn heeding(count: usize, interrupt: &Interrupt) -> Result<Self, Error> {
        rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .build()
            .map(|pool| Self {
                pool,
                interrupt: interrupt.clone(),
            })
            .map_err(|error| Error::Parameter {
                name: "threads",
                value: count.to_string(),
                expected: format!("a number of threads that the system gives ({error})"),
            })
    }

    /// Runs `work` with these threads: what it runs in parallel, it runs on them.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        self.pool.current_num_threads()
    }
}

impl Execute for Threads {
    fn ranges(&self, count: usize, job: &(dyn Fn(Range<usize>) + Sync)) {
        let heeded = |i: usize| {
            self.interrupt.heed();
            job(i..i + 1);
        };
        self.pool
            .install(|| (0..count).into_par_iter().for_each(heeded));
    }
}
