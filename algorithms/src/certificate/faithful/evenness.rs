//! How even a sample is, beside points scattered at random.

use super::tail::Tail;
use std::f64::consts::LN_2;

/// Largest factor by which a sample may be called less even than a random one, as a radius: with more, large
/// holes would hide themselves.
const LEAST_EVEN: f64 = 1.5;
/// Standard errors by which a sample must differ from a random one to be treated otherwise.
const SURE: f64 = 3.0;
/// Standard error of the logarithm of the median share of n points, times sqrt(n): 1.65 to 1.67 in 600 random samples each of 300,
/// 600 and 1500 points, whose shares depend on each other.
const SHARE_ERROR: f64 = 1.66;
/// The neighbor whose distance the nearest one's is compared with: as far as a density is the same, and far enough to be steady.
pub(super) const NEIGHBOR: usize = 8;

/// The tail of the distances from places of the surface to the points.
///
/// For a random sample the number of points t expected in the empty disc about a place is above x with
/// probability exp(-x). Here it is exp(-(x / scale)^power): even samples have a power above one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Evenness {
    scale: f64,
    power: f64,
    /// How the largest empty discs go on, where that was read.
    tail: Option<Tail>,
}

impl Evenness {
    /// That of a random sample.
    pub const RANDOM: Self = Self {
        scale: 1.0,
        power: 1.0,
        tail: None,
    };

    /// Fitted to the median and the 90 percent quantile of `measures`, the expected numbers of points in the
    /// empty discs about places picked evenly. `points` is how many points there are.
    ///
    /// Large empty regions make a sample look less even than a random one, and would hide themselves. So it is held for
    /// that only where the points are `clustered` too, and no more than they are: the factor that [`clustering`](Self::clustering)
    /// says.
    pub fn of(mut measures: Vec<f64>, points: usize, clustered: f64) -> Self {
        if measures.len() < 50 || points < 50 {
            return Self::RANDOM;
        }
        measures.sort_unstable_by(f64::total_cmp);
        let at = |q: f64| measures[((measures.len() - 1) as f64 * q) as usize];
        let (half, high) = (at(0.5), at(0.9));
        if !(half > 0.0 && high > half && high.is_finite()) {
            return Self::RANDOM;
        }
        let independent = measures.len().min(points) as f64;
        // standard errors of the logarithms of quantiles of an exponential variable
        let (half_error, high_error) = (1.44 / independent.sqrt(), 1.3 / independent.sqrt());
        let ten = 10.0_f64.ln();
        let shift = |found: f64, random: f64, error: f64| {
            let off = (found / random).ln();
            if off.abs() < SURE * error {
                0.0
            } else {
                (off - off.signum() * error).min(clustered.ln())
            }
        };
        let half = LN_2 * shift(half, LN_2, half_error).exp();
        let high = ten * shift(high, ten, high_error).exp();
        let power = ((ten / LN_2).ln() / (high / half).ln().max(1e-3)).clamp(0.6, 8.0);
        Self {
            scale: half / LN_2.powf(1.0 / power),
            power,
            tail: None,
        }
    }

    /// The same sample with what its largest empty discs say: no measure is rarer than it is among them, nor less rare than in a random
    /// sample.
    pub fn with_tail(self, tail: Option<Tail>) -> Self {
        Self { tail, ..self }
    }

    /// By what factor points are nearer to each other than in a random sample, as areas, beyond what chance does; 1 where they are
    /// not. From the squared distances of some to their nearest point as a share of those to their neighbor number [`NEIGHBOR`]:
    /// in a random sample a share is below x with probability 1 - (1 - x)^(k - 1).
    pub fn clustering(mut shares: Vec<f64>) -> f64 {
        if shares.is_empty() {
            return 1.0;
        }
        shares.sort_unstable_by(f64::total_cmp);
        let half = shares[(shares.len() - 1) / 2];
        let random = 1.0 - 0.5_f64.powf(1.0 / (NEIGHBOR as f64 - 1.0));
        let chance = (-SURE * SHARE_ERROR / (shares.len() as f64).sqrt()).exp();
        (random * chance / half.max(f64::MIN_POSITIVE)).max(1.0)
    }

    /// Whether the sample is more even than a random one.
    pub fn is_even(&self) -> bool {
        self.power > 1.15
    }

    /// The radius that is as rare in this sample as `radius` is in a random one, both in spacings.
    pub fn radius(&self, radius: f64) -> f64 {
        let random = std::f64::consts::PI * radius * radius;
        let own = self.scale * random.powf(1.0 / self.power);
        let shown = self.tail.map_or(own, |tail| tail.own(random).min(random));
        let own = own.max(shown);
        (own / std::f64::consts::PI).sqrt().min(LEAST_EVEN * radius)
    }

    /// The measure of an empty disc that is as rare in a random sample as `measure` is in this one.
    pub fn random(&self, measure: f64) -> f64 {
        let own = (measure / self.scale).powf(self.power);
        let shown = self
            .tail
            .map_or(own, |tail| tail.random(measure).max(measure));
        let own = own.min(shown);
        own.max(measure / (LEAST_EVEN * LEAST_EVEN))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Measures of the empty discs about a fine grid of places among the points of the unit square, away from its rim.
    fn measures(points: &[[f64; 2]]) -> Vec<f64> {
        let mut all = Vec::new();
        for i in 10..50 {
            for j in 10..50 {
                let (x, y) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                let square = |p: &[f64; 2]| (p[0] - x).powi(2) + (p[1] - y).powi(2);
                let least = points.iter().map(square).fold(f64::INFINITY, f64::min);
                all.push(std::f64::consts::PI * least * points.len() as f64);
            }
        }
        all
    }

    /// What it is asked whether points are clustered.
    fn shares(points: &[[f64; 2]]) -> Vec<f64> {
        let share = |p: &[f64; 2]| {
            let square = |q: &[f64; 2]| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2);
            let mut all: Vec<f64> = points.iter().map(square).filter(|&d| d > 0.0).collect();
            all.sort_unstable_by(f64::total_cmp);
            all[0] / all[NEIGHBOR - 1]
        };
        points.iter().map(share).collect()
    }

    #[test]
    fn large_gaps_are_hidden_no_more_than_the_points_are_clustered() {
        // One place in five is far in the middle of a hole.
        let random = |k: u32| -(1.0 - (f64::from(k) + 0.5) / 1000.0).ln();
        let all: Vec<f64> = (0..1000)
            .map(|k| if k % 5 == 0 { 30.0 } else { random(k) })
            .collect();
        let holes = |clustered| Evenness::of(all.clone(), 600, clustered).random(40.0);
        assert!(holes(1.0) > 38.0, "{}", holes(1.0));
        assert!(holes(1.1) > 30.0 && holes(1.1) < 40.0, "{}", holes(1.1));
        assert!(holes(3.0) < 20.0, "{}", holes(3.0));
        // Points that are a little nearer to each other than most random samples are hardly clustered.
        let shares = |half: f64| vec![half; 600];
        assert_eq!(Evenness::clustering(shares(0.08)), 1.0);
        let little = Evenness::clustering(shares(0.07));
        assert!(little > 1.0 && little < 1.15, "{little}");
    }

    #[test]
    fn a_random_sample_is_one_and_a_grid_is_not() {
        use rand::{RngExt, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        let scattered: Vec<[f64; 2]> = (0..900)
            .map(|_| std::array::from_fn(|_| random.random_range(0.0..1.0)))
            .collect();
        let even = Evenness::of(measures(&scattered), 900, 2.0);
        assert!((even.radius(1.3) - 1.3).abs() < 0.1, "{even:?}");
        assert_eq!(Evenness::clustering(shares(&scattered)), 1.0);
        let twins: Vec<[f64; 2]> = scattered
            .iter()
            .flat_map(|p| [*p, p.map(|x| x + 0.002)])
            .collect();
        assert!(Evenness::clustering(shares(&twins)) > 2.0);
        let mut shaken = |i: usize| (i as f64 + random.random_range(0.0..0.4)) / 30.0;
        let grid: Vec<[f64; 2]> = (0..900).map(|k| [shaken(k / 30), shaken(k % 30)]).collect();
        let even = Evenness::of(measures(&grid), 900, 1.0);
        assert!(even.radius(1.3) < 1.0, "{even:?}");
        assert!(even.random(6.0) > 12.0, "{even:?}");
    }
}
