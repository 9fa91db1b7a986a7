//! A chart that remembers how much it lost.

use crosscap_backends::interrupt::Interrupt;
use crosscap_core::{Chart, Error, LocalChart};
use serde::{Deserialize, Serialize};
use std::sync::Mutex;

/// Shares of the squared distances that charts do not carry, 0 (all flat) to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Distortion {
    /// Mean over all charts that were made, those of repairs included.
    pub mean: f64,
    /// Largest.
    pub max: f64,
}

/// A chart that remembers how much it lost.
pub(crate) struct Watched<'a> {
    chart: &'a dyn LocalChart,
    interrupt: Interrupt,
    /// Number of charts, sum and largest of their distortions.
    seen: Mutex<(usize, f64, f64)>,
}

impl<'a> Watched<'a> {
    pub(crate) fn new(chart: &'a dyn LocalChart, interrupt: &Interrupt) -> Self {
        Self {
            chart,
            interrupt: interrupt.clone(),
            seen: Mutex::new((0, 0.0, 0.0)),
        }
    }

    pub(crate) fn distortion(&self) -> Distortion {
        self.seen.lock().map_or(Distortion::default(), |seen| {
            let (count, sum, max) = *seen;
            let mean = sum / count.max(1) as f64;
            Distortion { mean, max }
        })
    }
}

impl LocalChart for Watched<'_> {
    fn chart(&self, count: usize, distances: &[f64], dimension: usize) -> Result<Chart, Error> {
        // The triangulation runs in one thread, chart by chart.
        self.interrupt.heed();
        let chart = self.chart.chart(count, distances, dimension)?;
        // A star is made after the other, so the order of the sum is always the same.
        if let Ok(mut seen) = self.seen.lock() {
            seen.0 += 1;
            seen.1 += chart.distortion;
            seen.2 = seen.2.max(chart.distortion);
        }
        Ok(chart)
    }

    fn name(&self) -> &str {
        self.chart.name()
    }
}
