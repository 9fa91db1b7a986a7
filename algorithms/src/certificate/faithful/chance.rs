//! How likely an empty region of a sample is by chance.
//!
//! The null is a Poisson process on the mesh with the local density of the points. Regions are measured by
//! the number of points expected in them, so that one table serves all densities.

/// What is known of the tail of the empty chains of one level.
///
/// A chain of level r is a connected set of places further than r spacings from every point, and its measure
/// the number of points expected within r of it. N(x) = exp(`start` - `rate` x) chains a point have a
/// measure above x.
pub(super) struct Level {
    /// Radius of the empty discs, in spacings.
    pub radius: f64,
    start: f64,
    rate: f64,
}

const fn level(radius: f64, start: f64, rate: f64) -> Level {
    Level {
        radius,
        start,
        rate,
    }
}

/// Levels from slits to holes. Below 0.6 spacings the empty places hang together all over a plane (filling
/// 1.13 of the discs), and chains say nothing.
///
/// Fitted to the tails of 60 Poisson samples of 90,000 points of the plane, cut into pixels of 0.3
/// spacings; at the ends of the fits (counts of some ten in 5.4 million points) they err to the side of chance.
pub(super) const LEVELS: [Level; 7] = [
    level(0.8, -3.98, 0.115),
    level(0.9, -3.90, 0.158),
    level(1.0, -3.40, 0.224),
    level(1.15, -3.10, 0.32),
    level(1.3, -2.58, 0.40),
    level(1.5, -3.00, 0.44),
    level(1.75, -4.50, 0.44),
];

/// What is looked for beside each other: chains of every level, and discs.
pub(super) const TRIED: f64 = 2.0 * LEVELS.len() as f64;

impl Level {
    /// The level of a radius between those of the table; the last one for all above, and a level where nothing is unlikely for those
    /// below.
    pub fn at(radius: f64) -> Self {
        let next = LEVELS.partition_point(|l| l.radius < radius);
        let last = LEVELS.len() - 1;
        let (low, high) = match next {
            0 => return level(radius, 0.0, 0.0),
            next if next > last => return Self { ..LEVELS[last] },
            next => (&LEVELS[next - 1], &LEVELS[next]),
        };
        let share = (radius - low.radius) / (high.radius - low.radius);
        let between = |a: f64, b: f64| a + share * (b - a);
        level(
            radius,
            between(low.start, high.start),
            between(low.rate, high.rate),
        )
    }

    /// Probability that one of the chains of `points` points is as large as `measure`, at most; all levels, and
    /// discs beside chains, are counted as tried.
    pub fn chain(&self, points: f64, measure: f64) -> f64 {
        (TRIED * points * (self.start - self.rate * measure).exp()).min(1.0)
    }
}

/// Probability that one of the empty discs of `points` points has as large a `measure`, at most: n (1 + t) exp(-t),
/// twice, as chains are tried beside discs.
pub(super) fn disc(points: f64, measure: f64) -> f64 {
    (2.0 * points * (1.0 + measure) * (-measure).exp()).min(1.0)
}

/// Discs that chance leaves in the mean, above which a few more say nothing.
const EXPECTED: f64 = 20.0;

/// Probability that at least `count` empty discs of `points` points that lie apart have as large a `measure` each, twice, as
/// chains are tried beside discs.
///
/// Far apart, large empty discs are rare events, whose number is that of a Poisson law with the mean n (1 + t) exp(-t).
pub(super) fn discs(points: f64, measure: f64, count: usize) -> f64 {
    let mean = points * (1.0 + measure) * (-measure).exp();
    if mean > EXPECTED {
        return 1.0;
    }
    // The terms from `count` on, without the loss of digits of one less those before.
    let mut term = (-mean).exp();
    for k in 1..=count {
        term *= mean / k as f64;
    }
    let mut sum = 0.0;
    let mut k = count;
    while sum + term > sum {
        sum += term;
        k += 1;
        term *= mean / k as f64;
    }
    (2.0 * sum).min(1.0)
}

/// The measure that so many of the empty discs of `points` points exceed in a random sample, in the mean: the t with
/// n (1 + t) exp(-t) = rank.
pub(super) fn measure_of_rank(points: f64, rank: f64) -> f64 {
    let log = (points / rank).ln().max(0.0);
    // t = log + ln(1 + t): a contraction for every t above zero.
    (0..60).fold(log, |t, _| log + t.ln_1p())
}

/// The measure that is as unlikely at a known density as `measure` is at a density that was
/// counted from `counted` points: (1 + x / m)^-m stands for exp(-x).
pub(super) fn known(measure: f64, counted: f64) -> f64 {
    if counted > 0.0 {
        counted * (measure / counted).ln_1p()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_discs_are_those_of_theory() {
        // 5,000 points, p = 0.001: 4.8 to 4.9 spacings at a known density
        let t = |width: f64| std::f64::consts::PI * width * width / 4.0;
        assert!(disc(5000.0, t(5.0)) < 1e-3 && disc(5000.0, t(4.7)) > 1e-3);
        assert!(known(20.0, 60.0) < 20.0 && (known(20.0, 1e9) - 20.0).abs() < 1e-5);
        assert_eq!(known(20.0, 0.0), 0.0);
    }

    #[test]
    fn several_discs_are_less_likely_than_one() {
        let one = discs(600.0, 12.0, 1);
        assert!((one / disc(600.0, 12.0) - 1.0).abs() < 0.1, "{one}");
        let three = discs(600.0, 12.0, 3);
        let mean = 600.0_f64 * 13.0 * (-12.0_f64).exp();
        let first = 2.0 * mean.powi(3) / 6.0;
        assert!(three < first && three > 0.9 * first, "{three} {first}");
        assert_eq!(discs(1e3, 0.1, 3), 1.0);
        assert_eq!(discs(1e6, 1e3, 3), 0.0);
    }

    #[test]
    fn levels_beyond_the_table() {
        assert_eq!(Level::at(0.7).chain(1e4, 1e6), 1.0);
        let last = &LEVELS[LEVELS.len() - 1];
        let beyond = Level::at(3.0).chain(1e4, 30.0);
        assert_eq!(beyond, last.chain(1e4, 30.0));
        assert_eq!(Level::at(1.0).chain(1e4, 30.0), LEVELS[2].chain(1e4, 30.0));
    }

    #[test]
    fn wider_chains_are_rarer() {
        for pair in LEVELS.windows(2) {
            assert!(pair[0].radius < pair[1].radius);
            assert!(pair[0].chain(1e4, 40.0) >= pair[1].chain(1e4, 40.0));
            let between = Level::at(0.5 * (pair[0].radius + pair[1].radius));
            assert!(pair[0].chain(1e4, 40.0) >= between.chain(1e4, 40.0));
            assert!(between.chain(1e4, 40.0) >= pair[1].chain(1e4, 40.0));
        }
    }
}
