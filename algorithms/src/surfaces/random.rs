//! Random numbers that are the same on every platform and under every crate version.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A stream of random numbers from a seed.
///
/// ChaCha8 is specified to the bit; uniform, integer and normal deviates are derived from its
/// words here, with `libm` for logarithms, so that neither a crate's change of method nor a
/// platform's mathematics library moves a sample.
///
/// ```
/// use crosscap_algorithms::surfaces::Random;
/// assert_eq!(Random::new(7).uniform(), Random::new(7).uniform());
/// ```
#[derive(Clone, Debug)]
pub struct Random {
    words: ChaCha8Rng,
    spare: Option<f64>,
}

impl Random {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Self {
        Self::stream(seed, 0)
    }

    /// Stream number `stream` of `seed`: streams of one seed are independent of each other.
    pub fn stream(seed: u64, stream: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut words = ChaCha8Rng::from_seed(key);
        words.set_stream(stream);
        Self { words, spare: None }
    }

    /// A number in [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.words.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A whole number in `0..limit`, every one equally likely; 0 when `limit` is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        let limit = limit as u64;
        if limit == 0 {
            return 0;
        }
        // Words above the last multiple of `limit` would favor small numbers.
        let excess = (u64::MAX % limit + 1) % limit;
        loop {
            let word = self.words.next_u64();
            if word <= u64::MAX - excess {
                return (word % limit) as usize;
            }
        }
    }

    /// A standard normal deviate (polar method of Marsaglia).
    pub fn normal(&mut self) -> f64 {
        if let Some(value) = self.spare.take() {
            return value;
        }
        loop {
            let (x, y) = (self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                let factor = (-2.0 * libm::log(square) / square).sqrt();
                self.spare = Some(y * factor);
                return x * factor;
            }
        }
    }

    /// Brings `items` into random order (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            let other = self.below(last + 1);
            items.swap(last, other);
        }
    }

    /// A random permutation of `0..count`.
    pub fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        self.shuffle(&mut order);
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_chacha8() {
        // First words of the ChaCha8 key stream for the all-zero key and nonce (eSTREAM test vectors).
        let mut random = Random::new(0);
        assert_eq!(
            random.words.next_u32().to_le_bytes(),
            [0x3e, 0x00, 0xef, 0x2f]
        );
    }

    #[test]
    fn normal_deviates_have_the_moments_of_a_normal_law() {
        let mut random = Random::new(3);
        let count = 200_000;
        let mut moments = [0.0; 4];
        for _ in 0..count {
            let x = random.normal();
            for (k, m) in moments.iter_mut().enumerate() {
                *m += x.powi(k as i32 + 1) / f64::from(count);
            }
        }
        for (found, (expected, tolerance)) in
            moments
                .iter()
                .zip([(0.0, 0.01), (1.0, 0.015), (0.0, 0.04), (3.0, 0.11)])
        {
            assert!((found - expected).abs() < tolerance, "{moments:?}");
        }
    }

    #[test]
    fn below_reaches_every_number_equally() {
        let mut random = Random::new(9);
        let mut count = [0; 6];
        for _ in 0..60_000 {
            count[random.below(6)] += 1;
        }
        assert!(
            count.iter().all(|&c| (9_600..10_400).contains(&c)),
            "{count:?}"
        );
        assert_eq!(random.below(0), 0);
    }

    #[test]
    fn streams_differ() {
        assert_ne!(
            Random::stream(1, 0).uniform(),
            Random::stream(1, 1).uniform()
        );
    }
}
