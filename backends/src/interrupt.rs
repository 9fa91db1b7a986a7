//! Stopping a run from outside.

use crosscap_core::Error;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A request to stop a run. Clones are one request: whoever holds one may ask, from any thread.
///
/// A job that is stopped in the middle has no result to give, and the stage that waits for it has
/// nothing to go on with. So [`Interrupt::heed`] leaves the run by unwinding, without the message of a
/// panic, and [`Interrupt::guard`] around the run turns that into [`Error::Interrupted`]. No
/// algorithm has to know of it, and a run that nobody stops pays for one load a job.
///
/// ```
/// use crosscap_backends::interrupt::Interrupt;
/// use crosscap_core::Error;
/// let interrupt = Interrupt::default();
/// let run = || {
///     interrupt.heed();
///     Ok(7)
/// };
/// assert_eq!(interrupt.guard(run), Ok(7));
/// interrupt.request();
/// assert_eq!(interrupt.guard(run), Err(Error::Interrupted));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

/// What a run that is left unwinds with.
struct Left;

impl Interrupt {
    /// Asks for the run to stop. It cannot be taken back.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Leaves the run if somebody asked; to be called inside [`Interrupt::guard`] alone.
    pub fn heed(&self) {
        if self.is_requested() {
            resume_unwind(Box::new(Left));
        }
    }

    /// Does `work`, which may be left by [`Interrupt::heed`], in this thread or in one that this thread
    /// waits for. What `work` was changing is then half changed, and should be dropped.
    ///
    /// # Errors
    /// Those of `work`, and [`Error::Interrupted`] where it was left.
    pub fn guard<T>(&self, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        match catch_unwind(AssertUnwindSafe(work)) {
            Ok(result) => result,
            Err(payload) if payload.is::<Left>() => Err(Error::Interrupted),
            Err(panic) => resume_unwind(panic),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Threads;
    use crosscap_algorithms::execute::Execute;
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn jobs_that_have_not_begun_are_not_begun() {
        for count in [1, 3] {
            let interrupt = Interrupt::default();
            let threads = Threads::heeding(count, &interrupt).unwrap();
            let begun = AtomicUsize::new(0);
            let result = interrupt.guard(|| {
                threads.ranges(100_000, &|_| {
                    begun.fetch_add(1, Ordering::Relaxed);
                    interrupt.request();
                });
                Ok(())
            });
            assert_eq!(result, Err(Error::Interrupted));
            assert!(begun.into_inner() <= count);
        }
    }

    #[test]
    fn a_panic_stays_a_panic() {
        let interrupt = Interrupt::default();
        let work = || interrupt.guard(|| -> Result<(), Error> { resume_unwind(Box::new(5_u8)) });
        let payload = catch_unwind(AssertUnwindSafe(work)).unwrap_err();
        assert_eq!(payload.downcast_ref(), Some(&5_u8));
    }
}
