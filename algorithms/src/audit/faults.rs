//! Faults found by many threads, told in one order.

use crosscap_core::Error;
use std::sync::{Arc, Mutex, PoisonError};

/// The fault at the point that comes first: which one is found first depends on the threads.
/// Clones share what they know.
#[derive(Clone, Debug, Default)]
pub(crate) struct Faults(Arc<Mutex<Option<(usize, Error)>>>);

impl Faults {
    /// Remembers the fault if none at an earlier point is known.
    pub(crate) fn add(&self, point: usize, error: Error) {
        let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if first.as_ref().is_none_or(|f| point < f.0) {
            *first = Some((point, error));
        }
    }

    /// The fault at the first point.
    ///
    /// # Errors
    /// That fault.
    pub(crate) fn none(&self) -> Result<(), Error> {
        let first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        first.as_ref().map_or(Ok(()), |f| Err(f.1.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_point_is_told_whoever_comes_first() {
        let fault = |point| Error::Index {
            what: "point",
            index: point,
            limit: 0,
        };
        let faults = Faults::default();
        assert!(faults.none().is_ok());
        for point in [7, 3, 5] {
            faults.add(point, fault(point));
        }
        assert_eq!(faults.clone().none(), Err(fault(3)));
    }
}
