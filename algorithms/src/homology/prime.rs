//! Primality of 64-bit numbers.

/// Whether `n` is a prime, exactly.
///
/// Miller-Rabin with the first twelve primes as bases, which leaves no composite number below
/// 3.18 * 10^23 (Sorenson and Webster 2017, "Strong pseudoprimes to twelve prime bases").
pub(crate) fn is_prime(n: u64) -> bool {
    const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    if n < 2 {
        return false;
    }
    if let Some(&q) = BASES.iter().find(|&&q| n.is_multiple_of(q)) {
        return n == q;
    }
    let twos = (n - 1).trailing_zeros();
    let odd = (n - 1) >> twos;
    BASES.iter().all(|&base| {
        let mut x = power(base, odd, n);
        if x == 1 || x == n - 1 {
            return true;
        }
        (1..twos).any(|_| {
            x = product(x, x, n);
            x == n - 1
        })
    })
}

/// `a * b` modulo `n`.
pub(crate) fn product(a: u64, b: u64, n: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(n)) as u64
}

/// `base ^ exponent` modulo `n`.
pub(crate) fn power(mut base: u64, mut exponent: u64, n: u64) -> u64 {
    let mut result = 1 % n;
    base %= n;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = product(result, base, n);
        }
        base = product(base, base, n);
        exponent >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_trial_division() {
        for n in 0..5000u64 {
            let divided = n > 1 && (2..n).take_while(|d| d * d <= n).all(|d| n % d != 0);
            assert_eq!(is_prime(n), divided, "{n}");
        }
    }

    #[test]
    fn strong_pseudoprimes_and_large_numbers() {
        // The smallest strong pseudoprimes to the first 4, 7 and 9 prime bases.
        for n in [
            3_215_031_751,
            341_550_071_728_321,
            3_825_123_056_546_413_051,
        ] {
            assert!(!is_prime(n), "{n}");
        }
        assert!(is_prime(18_446_744_073_709_551_557));
        assert!(!is_prime(u64::MAX));
        assert!(!is_prime(4_294_967_291 * 4_294_967_279));
    }
}
