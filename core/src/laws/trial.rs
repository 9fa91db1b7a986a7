//! The search for an input that breaks a law.

use super::{Law, LawBroken, Settings};
use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

/// What a single input showed: nothing wrong, or what was found.
pub(super) type Outcome = Result<(), String>;

impl Law {
    /// Draws inputs until one breaks the law, and makes that one as small as it can.
    ///
    /// A panic of the implementation breaks the law as well. Where the settings ask for another law alone,
    /// nothing is tried.
    pub(super) fn holds<T: Strategy>(
        &'static self,
        settings: &Settings,
        inputs: &T,
        test: impl Fn(&T::Value) -> Outcome,
    ) -> Result<(), LawBroken> {
        if settings.only.is_some_and(|name| name != self.name) {
            return Ok(());
        }
        let config = Config {
            failure_persistence: None,
            max_shrink_iters: settings.shrink_steps,
            max_shrink_time: 0,
            source_file: None,
            ..Config::with_cases(settings.cases)
        };
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &self.stream(settings.seed));
        let broken = |input: String, found: &str| LawBroken {
            law: self,
            input,
            found: found.to_string(),
            seed: Some(settings.seed),
        };
        TestRunner::new_with_rng(config, rng)
            .run(inputs, |input| test(&input).map_err(TestCaseError::fail))
            .map_err(|error| match error {
                TestError::Fail(found, input) => broken(format!("{input:?}"), found.message()),
                TestError::Abort(why) => broken("none could be drawn".into(), why.message()),
            })
    }

    /// Seed of the inputs of this law: laws do not share theirs, so that adding one changes no other.
    fn stream(&self, seed: u64) -> [u8; 32] {
        // Fowler-Noll-Vo, 64 bits.
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for byte in self.subject.bytes().chain(self.name.bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        let mut stream = [0; 32];
        stream[..8].copy_from_slice(&seed.to_le_bytes());
        stream[8..16].copy_from_slice(&hash.to_le_bytes());
        stream
    }
}

/// `Err` with the text unless the condition holds.
macro_rules! ensure {
    ($condition:expr, $($text:tt)*) => {
        let holds: bool = $condition;
        if !holds {
            return Err(format!($($text)*));
        }
    };
}
pub(super) use ensure;
