//! How many inputs are drawn, and from which seed.

/// How thoroughly laws are tested. The same settings draw the same inputs.
///
/// ```
/// use crosscap_core::laws::Settings;
/// let thorough = Settings { cases: 5000, ..Settings::default() };
/// assert_eq!(thorough.seed, Settings::default().seed);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Inputs drawn for every law.
    pub cases: u32,
    /// What they are drawn from.
    pub seed: u64,
    /// How often an input that breaks a law is made smaller, at most.
    pub shrink_steps: u32,
    /// The name of the one law to try; all of them when left out.
    pub only: Option<&'static str>,
    /// Laws that are known not to hold, by name, each with the reason. Such a law is no failure; it is one should it
    /// hold after all.
    pub expected: Vec<(&'static str, &'static str)>,
}

impl Settings {
    /// The default for one law alone, by its name.
    pub fn only(law: &'static str) -> Self {
        Self {
            only: Some(law),
            ..Self::default()
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            cases: 128,
            seed: 0xc205_5ca9,
            shrink_steps: 4000,
            only: None,
            expected: Vec::new(),
        }
    }
}

impl Settings {
    /// As thorough, with at most `cases` inputs: for laws whose inputs are costly.
    pub(super) fn at_most(&self, cases: u32) -> Self {
        Self {
            cases: self.cases.min(cases),
            ..self.clone()
        }
    }
}
