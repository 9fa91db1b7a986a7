//! The tail of the largest empty discs, as far as the sample itself shows it.
//!
//! How even a sample is, is read from half and from nine tenths of its places. Points of a grid go on as they begin; points of a scan do
//! not: where views were merged or triangles were left out, one place in a hundred is emptier than nine tenths of them foretell. The
//! largest empty discs of the sample say how its tail goes on, and a gap that follows from the others is no hole. A hole of the surface
//! does not follow from them: it stands out, and so do several of one size together.

use super::chance;

/// Discs, or chains of a level, that the tail is read from, at most.
pub(super) const LARGEST: usize = 80;
/// The same at least, without those that stand out.
const LEAST: usize = 20;
/// Probability below which the largest discs do not follow from the others.
const OUT: f64 = 1e-3;

/// How the measures of the largest empty discs go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tail {
    /// Measure of the smallest disc that was read, in points expected in it as all measures here.
    from: f64,
    /// How many were read.
    count: f64,
    /// The measure that is as rare in a random sample.
    rare: f64,
    /// Measure in which the discs become rarer by a factor e.
    scale: f64,
}

impl Tail {
    /// Read from the measures of the largest empty discs of `points` points, largest first; none where there are too few of them.
    ///
    /// Of n variables with an exponential tail the k-th largest is above the next by a variable with the mean `scale` / k, each
    /// independent of the others (A. Renyi, On the theory of order statistics, 1953). The largest ones, up to half of them, are left out as far as such a step is no chance.
    /// O(discs).
    pub fn of(measures: &[f64], points: f64) -> Option<Self> {
        let rest = &measures[standing_out(measures)..];
        let from = *rest.last()?;
        let count = rest.len() as f64;
        (rest.len() > LEAST).then(|| Self {
            from,
            count,
            rare: chance::measure_of_rank(points, count),
            scale: mean_step(rest, 0),
        })
    }

    /// The measure in a random sample that is as rare as `measure` is in this tail.
    pub fn random(&self, measure: f64) -> f64 {
        self.rare + (measure - self.from) / self.scale
    }

    /// How many as large as `measure` there are in the mean.
    pub fn above(&self, measure: f64) -> f64 {
        self.count * ((self.from - measure) / self.scale).exp()
    }

    /// The other way round than [`random`](Self::random).
    pub fn own(&self, random: f64) -> f64 {
        self.from + (random - self.rare) * self.scale
    }
}

/// How many of the largest do not follow from the others, up to half of them.
fn standing_out(measures: &[f64]) -> usize {
    let tried = measures.len() / 2;
    let out = |&k: &usize| {
        let left = measures.len() - 2 - k;
        if left < LEAST {
            return false;
        }
        // The scale is the mean of `left` steps, so that the ratio has the law of a mean of one to one of so many.
        let known = left as f64;
        let ratio = step(measures, k) / mean_step(measures, k + 1);
        (1.0 + ratio / known).powf(-known) * tried as f64 <= OUT
    };
    (0..tried).rev().find(out).map_or(0, |k| k + 1)
}

/// The mean of the steps from number `first` on.
fn mean_step(measures: &[f64], first: usize) -> f64 {
    let steps = measures.len() - 1 - first;
    (first..measures.len() - 1)
        .map(|k| step(measures, k))
        .sum::<f64>()
        / steps as f64
}

/// How far the measure number `k` is above the next, times how many are as large.
fn step(measures: &[f64], k: usize) -> f64 {
    (k + 1) as f64 * (measures[k] - measures[k + 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest of 5,000 variables of a law whose tail is exponential, each at the middle of its rank.
    fn exponential(scale: f64) -> Vec<f64> {
        (0..60)
            .map(|k| scale * (5000.0 / (f64::from(k) + 0.5)).ln())
            .collect()
    }

    #[test]
    fn a_tail_goes_on_as_it_begins() {
        let measures = exponential(0.7);
        let tail = Tail::of(&measures, 5000.0).unwrap();
        assert!((tail.scale - 0.7).abs() < 0.05, "{tail:?}");
        let next = tail.random(measures[0]);
        let expected = chance::measure_of_rank(5000.0, 1.0);
        assert!((next - expected).abs() < 1.0, "{next} {expected}");
        assert!((tail.own(tail.random(3.0)) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn holes_stand_out_alone_and_together() {
        let clean = Tail::of(&exponential(0.2), 5000.0).unwrap();
        for count in [1, 3, 12] {
            let mut measures = exponential(0.2);
            measures.splice(0..0, vec![12.0; count]);
            let tail = Tail::of(&measures, 5000.0).unwrap();
            assert!((tail.scale / clean.scale - 1.0).abs() < 0.05, "{tail:?}");
        }
        assert!(Tail::of(&exponential(0.2)[..15], 5000.0).is_none());
    }

    #[test]
    fn equal_discs_have_a_tail_of_their_size() {
        let tail = Tail::of(&[1.5; 60], 5000.0).unwrap();
        assert!(tail.random(1.6) > 1e9);
    }
}
