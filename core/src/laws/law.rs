//! What a law is, and the report of one that does not hold.

use std::fmt;

/// A law of a trait.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Law {
    /// The trait whose documentation states it, or what else it is about.
    pub subject: &'static str,
    /// Its name, as that documentation words it.
    pub name: &'static str,
    /// What it asks.
    pub says: &'static str,
    /// What usually is wrong where it does not hold.
    pub look_for: &'static str,
}

/// A law that an implementation breaks, with the smallest input that was found to show it.
///
/// `Debug` prints what `Display` does, so that `unwrap` in a test says all of it.
#[derive(Clone, PartialEq)]
pub struct LawBroken {
    /// The law.
    pub law: &'static Law,
    /// The shrunk input, as its `Debug` prints it.
    pub input: String,
    /// What the implementation did with it.
    pub found: String,
    /// The seed that finds it again (see [`Settings::seed`](super::Settings::seed)); `None` where
    /// nothing was drawn.
    pub seed: Option<u64>,
}

impl fmt::Display for LawBroken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let law = self.law;
        writeln!(f, "the law '{}' of {} does not hold", law.name, law.subject)?;
        writeln!(f, "  it says:  {}", law.says)?;
        writeln!(f, "  found:    {}", self.found)?;
        writeln!(f, "  on input: {}", self.input)?;
        write!(f, "  look for: {}", law.look_for)?;
        if let Some(seed) = self.seed {
            write!(f, "\n  the same again with the seed {seed:#x}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for LawBroken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for LawBroken {}
