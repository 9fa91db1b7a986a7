//! What a law is, and the report of those that do not hold.

use super::Settings;
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

/// What is wrong with one law of an implementation.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// The law does not hold.
    Broken(LawBroken),
    /// The law holds, and [`Settings::expected`](super::Settings::expected) says that it does not: the mark is out of
    /// date.
    Holds {
        /// The law.
        law: &'static Law,
        /// The reason that was given for the mark.
        reason: &'static str,
    },
    /// [`Settings`](super::Settings) name a law that is none of those that were to be tried.
    Unknown {
        /// The name that was given.
        name: &'static str,
        /// The laws there are.
        laws: Vec<&'static Law>,
    },
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Broken(broken) => broken.fmt(f),
            Self::Holds { law, reason } => write!(
                f,
                "the law '{}' of {} holds, and was expected to fail ({reason}): take the mark away",
                law.name, law.subject
            ),
            Self::Unknown { name, laws } => {
                let names: Vec<&str> = laws.iter().map(|l| l.name).collect();
                write!(
                    f,
                    "there is no law '{name}' here, only {}",
                    names.join(", ")
                )
            }
        }
    }
}

/// All that is wrong with an implementation, at least one thing, in the order in which the laws are tried: the
/// more basic first, so that the first failure often explains the others.
///
/// `Debug` prints what `Display` does, so that `unwrap` in a test says all of it.
#[derive(Clone, PartialEq)]
pub struct Failures {
    list: Vec<Failure>,
}

impl Failures {
    /// The failures, one a law.
    pub fn list(&self) -> &[Failure] {
        &self.list
    }

    /// The laws that do not hold.
    pub fn broken(&self) -> impl Iterator<Item = &LawBroken> {
        self.list.iter().filter_map(|failure| match failure {
            Failure::Broken(broken) => Some(broken),
            _ => None,
        })
    }
}

impl From<LawBroken> for Failures {
    fn from(broken: LawBroken) -> Self {
        Self {
            list: vec![Failure::Broken(broken)],
        }
    }
}

impl fmt::Display for Failures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, failure) in self.list.iter().enumerate() {
            if k > 0 {
                f.write_str("\n\n")?;
            }
            failure.fmt(f)?;
        }
        Ok(())
    }
}

impl fmt::Debug for Failures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Failures {}

/// Collects what the laws of one implementation show, then holds it against what was expected.
#[derive(Debug)]
pub struct Findings {
    laws: Vec<&'static Law>,
    only: Option<&'static str>,
    expected: Vec<(&'static str, &'static str)>,
    broken: Vec<LawBroken>,
}

impl Findings {
    /// Begins with a list of `laws`, all of which are put to it.
    pub fn new(settings: &Settings, laws: &[&'static Law]) -> Self {
        Self {
            laws: laws.to_vec(),
            only: settings.only,
            expected: settings.expected.clone(),
            broken: Vec::new(),
        }
    }

    /// Takes what one law showed. A law that is put twice is told once.
    pub fn put(&mut self, shown: Result<(), LawBroken>) {
        if let Err(broken) = shown
            && self.asks(broken.law)
            && self.broken.iter().all(|b| b.law != broken.law)
        {
            self.broken.push(broken);
        }
    }

    fn asks(&self, law: &Law) -> bool {
        self.only.is_none_or(|name| name == law.name)
    }

    /// What is wrong.
    ///
    /// # Errors
    /// The laws that do not hold and were expected to, those that hold and were not expected to, and names of no law.
    pub fn end(self) -> Result<(), Failures> {
        let law = |name: &str| self.laws.iter().copied().find(|l| l.name == name);
        let mark = |law: &Law| self.expected.iter().find(|e| e.0 == law.name);
        let is_broken = |law: &Law| self.broken.iter().any(|b| b.law == law);
        let names = self
            .only
            .into_iter()
            .chain(self.expected.iter().map(|e| e.0));
        let unknown = names.filter(|name| law(name).is_none());
        let mut list: Vec<Failure> = unknown
            .map(|name| Failure::Unknown {
                name,
                laws: self.laws.clone(),
            })
            .collect();
        let unexpected = self.broken.iter().filter(|b| mark(b.law).is_none());
        list.extend(unexpected.cloned().map(Failure::Broken));
        let held = self.expected.iter().filter_map(|&(name, reason)| {
            let law = law(name).filter(|law| self.asks(law) && !is_broken(law))?;
            Some(Failure::Holds { law, reason })
        });
        list.extend(held);
        if list.is_empty() {
            Ok(())
        } else {
            Err(Failures { list })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static FIRST: Law = law("first");
    static SECOND: Law = law("second");

    const fn law(name: &'static str) -> Law {
        Law {
            subject: "test",
            name,
            says: "nothing",
            look_for: "nothing",
        }
    }

    fn broken(law: &'static Law) -> Result<(), LawBroken> {
        Err(LawBroken {
            law,
            input: "0".into(),
            found: "1".into(),
            seed: None,
        })
    }

    fn told(settings: &Settings, shown: &[Result<(), LawBroken>]) -> String {
        let mut findings = Findings::new(settings, &[&FIRST, &SECOND]);
        shown.iter().for_each(|s| findings.put(s.clone()));
        findings
            .end()
            .map_or_else(|f| f.to_string(), |()| String::new())
    }

    #[test]
    fn all_that_is_broken_is_told_once() {
        let both = [broken(&FIRST), Ok(()), broken(&SECOND), broken(&FIRST)];
        let text = told(&Settings::default(), &both);
        assert_eq!(text.matches("does not hold").count(), 2, "{text}");
        assert!(text.find("'first'") < text.find("'second'"));
        let only = Settings::only("second");
        assert!(!told(&only, &both).contains("'first'"));
        assert_eq!(told(&only, &both[..1]), "");
    }

    #[test]
    fn marks_are_held_to() {
        let settings = Settings {
            expected: vec![("second", "it is a sketch")],
            ..Settings::default()
        };
        assert_eq!(told(&settings, &[broken(&SECOND)]), "");
        assert!(told(&settings, &[broken(&FIRST), broken(&SECOND)]).contains("'first'"));
        let text = told(&settings, &[]);
        assert!(
            text.contains("'second'") && text.contains("it is a sketch"),
            "{text}"
        );
        // Where the other law alone is asked for, the mark says nothing.
        let first = Settings {
            only: Some("first"),
            ..settings
        };
        assert_eq!(told(&first, &[]), "");
    }

    #[test]
    fn a_name_of_no_law_is_told() {
        let text = told(&Settings::only("frist"), &[]);
        assert!(
            text.contains("'frist'") && text.contains("first, second"),
            "{text}"
        );
        let settings = Settings {
            expected: vec![("third", "")],
            ..Settings::default()
        };
        assert!(told(&settings, &[]).contains("'third'"));
    }
}
