//! Tangent planes and graphs of a cloud, kept from one reconstruction of it to the next.
//!
//! A search for parameters works on the same points several times, with other lengths each time. Planes and paths go by the points
//! and not by the lengths, so that they need not be made again. Whoever asks gets what would be made now, bit for bit: it is known by
//! all that it depends on.

use crosscap_algorithms::tangents::TangentField;
use crosscap_algorithms::tuning::TangentTuning;
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::geodesic::{EdgeRule, GeodesicMetric};
use crosscap_backends::parallel::Threads;
use crosscap_core::{Error, PointCloud};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What tangent planes depend on.
#[derive(PartialEq)]
struct PlanesOf {
    cloud: Arc<PointCloud<f64>>,
    tuning: TangentTuning,
}

/// What paths depend on.
#[derive(PartialEq)]
struct PathsOf {
    cloud: Arc<PointCloud<f64>>,
    graph: EdgeRule,
    /// How the planes that join points of one sheet are laid through the same cloud, where they do.
    sheets: Option<TangentTuning>,
}

/// One thing with all that it depends on.
struct Made<K, T> {
    of: K,
    it: Arc<T>,
}

/// What was made last, for whoever asks next.
type Last<K, T> = Arc<Mutex<Option<Made<K, T>>>>;

/// The planes and the paths that were asked for last. Clones share them.
#[derive(Clone, Default)]
pub(crate) struct Kept {
    planes: Last<PlanesOf, TangentField>,
    paths: Last<PathsOf, GeodesicMetric<f64>>,
}

impl Kept {
    /// The tangent planes of the points that `oracle` serves.
    ///
    /// # Errors
    /// Those of [`TangentField::new`].
    pub(crate) fn planes(
        &self,
        oracle: &EuclideanOracle<f64>,
        tuning: &TangentTuning,
        threads: &Threads,
    ) -> Result<Arc<TangentField>, Error> {
        let cloud = oracle.cloud();
        let of = PlanesOf {
            cloud: cloud.clone(),
            tuning: *tuning,
        };
        let make = || TangentField::new(cloud.clone(), oracle, tuning, threads);
        found_or_made(&mut lock(&self.planes), of, make)
    }

    /// Shortest paths through the graph of the points that `oracle` serves, where planes are given through edges on one sheet alone.
    ///
    /// # Errors
    /// Those of [`GeodesicMetric::joining`].
    pub(crate) fn paths(
        &self,
        oracle: &EuclideanOracle<f64>,
        graph: EdgeRule,
        sheets: Option<(&TangentField, &TangentTuning)>,
        threads: &Threads,
    ) -> Result<Arc<GeodesicMetric<f64>>, Error> {
        let cloud = oracle.cloud();
        let of = PathsOf {
            cloud: cloud.clone(),
            graph,
            sheets: sheets.map(|(_, tuning)| *tuning),
        };
        let joins = |a, b| sheets.is_none_or(|(planes, _)| planes.joins(a, b));
        let make = || threads.install(|| GeodesicMetric::joining(oracle, graph, &joins));
        found_or_made(&mut lock(&self.paths), of, make)
    }
}

/// What is there, if it depends on the same; else it makes room for what `make` makes.
fn found_or_made<K: PartialEq, T>(
    last: &mut Option<Made<K, T>>,
    of: K,
    make: impl FnOnce() -> Result<T, Error>,
) -> Result<Arc<T>, Error> {
    if let Some(found) = last.as_ref().filter(|made| made.of == of) {
        return Ok(found.it.clone());
    }
    *last = None;
    let it = Arc::new(make()?);
    *last = Some(Made { of, it: it.clone() });
    Ok(it)
}

/// What a thread that panicked left behind is whole: it is put there in one step.
fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_algorithms::surfaces::Random;
    use std::ptr;

    fn oracle(seed: u64) -> EuclideanOracle<f64> {
        let mut random = Random::stream(seed, 0);
        let numbers = (0..300).map(|_| random.between(0.0, 1.0)).collect();
        EuclideanOracle::new(PointCloud::new(3, numbers).unwrap()).unwrap()
    }

    /// Equal points are asked for once; other points, another graph and other numbers are made anew.
    #[test]
    fn what_is_kept_is_given_for_the_same_alone() {
        let (kept, threads) = (Kept::default(), Threads::new(1).unwrap());
        let tuning = TangentTuning::MEASURED;
        let [a, b, other] = [oracle(1), oracle(1), oracle(2)];
        let planes = |o, t| kept.planes(o, t, &threads).unwrap();
        let first = planes(&a, &tuning);
        assert!(Arc::ptr_eq(&first, &planes(&b, &tuning)));
        let wider = TangentTuning {
            plane: tuning.plane + 4,
            ..tuning
        };
        assert!(!Arc::ptr_eq(&first, &planes(&a, &wider)));
        let again = planes(&other, &tuning);
        assert!(!Arc::ptr_eq(&first, &again));

        let field = planes(&a, &tuning);
        let sheets = Some((&*field, &tuning));
        let paths = |o, rule, sheets| kept.paths(o, rule, sheets, &threads).unwrap();
        let (ten, five) = (EdgeRule::Nearest(10), EdgeRule::Nearest(5));
        let plain = paths(&a, ten, None);
        assert!(ptr::eq(&*plain, &*paths(&b, ten, None)));
        let creased = paths(&a, ten, sheets);
        assert!(creased.report().edges < plain.report().edges);
        assert_eq!(paths(&a, five, None).report().points, 100);
        assert!(!Arc::ptr_eq(&plain, &paths(&other, ten, None)));
    }
}
