//! For every law there is an implementation that breaks it and nothing before it.

use super::{Failures, Law, LawBroken, Settings};

/// Sources of the modules that state laws.
const SOURCES: [&str; 10] = [
    include_str!("metric.rs"),
    concat!(
        include_str!("neighborhood/mod.rs"),
        "mod tests {",
        include_str!("neighborhood/tests.rs")
    ),
    concat!(
        include_str!("dimension/mod.rs"),
        "mod tests {",
        include_str!("dimension/tests.rs")
    ),
    concat!(
        include_str!("singularity/mod.rs"),
        "mod tests {",
        include_str!("singularity/tests.rs")
    ),
    concat!(
        include_str!("chart/mod.rs"),
        "mod tests {",
        include_str!("chart/tests.rs")
    ),
    include_str!("landmarks.rs"),
    include_str!("compatibility.rs"),
    include_str!("rule.rs"),
    include_str!("triangulation.rs"),
    include_str!("result.rs"),
];

#[test]
fn every_law_is_listed_and_has_a_twin() {
    let mut stated = 0;
    for source in SOURCES {
        let (laws, tests) = source.split_once("mod tests {").unwrap();
        let tests: String = tests.split_whitespace().collect();
        for line in laws.lines() {
            let name = line
                .strip_prefix("static ")
                .and_then(|l| l.strip_suffix(": Law = Law {"));
            if let Some(name) = name {
                stated += 1;
                let named = [")", ",)"].map(|end| format!("&{name}{end}"));
                assert!(
                    named.iter().any(|n| tests.contains(n)),
                    "no twin breaks {name}"
                );
            }
        }
    }
    let all = super::all();
    assert_eq!(all.len(), stated);
    let mut names: Vec<_> = all.iter().map(|l| (l.subject, l.name)).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), stated, "two laws of one name");
}

/// The table of the guide, without the laws of meshes, which are not of this crate.
#[test]
fn every_law_is_in_the_guide() {
    let guide = include_str!("../../../docs/src/laws.md");
    let (table, _) = guide.split_once("\n## ").unwrap();
    let mut listed: Vec<(&str, &str)> = table
        .lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| ")?.split(" | ");
            Some((cells.next()?, cells.next()?))
        })
        .filter(|row| !["about", "---", "a mesh", "WaistProducer"].contains(&row.0))
        .collect();
    let mut stated: Vec<(&str, &str)> = super::all().iter().map(|l| (l.subject, l.name)).collect();
    listed.sort_unstable();
    stated.sort_unstable();
    assert_eq!(listed, stated);
}

#[test]
fn a_failure_is_found_again() {
    struct Squared(super::StraightLine<f64>);
    impl crate::MetricSpace for Squared {
        type Scalar = f64;
        fn len(&self) -> usize {
            self.0.len()
        }
        fn distance(&self, a: usize, b: usize) -> f64 {
            self.0.distance(a, b).powi(2)
        }
        fn name(&self) -> &str {
            "squared"
        }
    }
    let put = |seed| {
        let settings = super::Settings {
            seed,
            ..super::Settings::default()
        };
        let failures = super::metric(&settings, |cloud| {
            Squared(super::StraightLine(cloud.clone()))
        });
        let failures = failures.unwrap_err();
        assert_eq!(failures.list().len(), 1, "{failures}");
        failures.broken().next().unwrap().clone()
    };
    let first = put(1);
    assert_eq!(first, put(1));
    // Shrunk to the least there can be: three points on a line.
    assert!(
        first.input.starts_with("PointCloud { dimension: 1,"),
        "{first}"
    );
    assert_eq!(first.input.matches(',').count(), 3, "{first}");
    assert_eq!(first.law, put(2).law);
}

/// Twins are many, and how small the input is in the end is the matter of a test of its own.
pub(super) fn quick() -> Settings {
    Settings {
        shrink_steps: 64,
        ..Settings::default()
    }
}

/// The twin passes without a fault, and with every other one fails by the law that goes with it.
#[track_caller]
pub(super) fn each_is_caught<F: Copy>(
    put: impl Fn(F) -> Result<(), Failures>,
    none: F,
    faults: &[(F, &'static Law)],
) {
    put(none).unwrap();
    for &(fault, law) in faults {
        catches(put(fault), law);
    }
}

/// The first report, which must be about this law and say all there is to say.
#[track_caller]
pub(super) fn catches(found: Result<(), impl Into<Failures>>, law: &'static Law) -> LawBroken {
    let failures = match found {
        Ok(()) => panic!(
            "nothing was found wrong, expected '{}' of {}",
            law.name, law.subject
        ),
        Err(failures) => failures.into(),
    };
    let broken = failures.broken().next().unwrap().clone();
    assert!(failures.to_string().starts_with(&broken.to_string()));
    assert_eq!(
        (broken.law.subject, broken.law.name),
        (law.subject, law.name),
        "{broken}"
    );
    let text = broken.to_string();
    for part in [
        law.name,
        law.subject,
        law.look_for,
        &broken.input,
        &broken.found,
    ] {
        assert!(!part.is_empty() && text.contains(part), "{text}");
    }
    assert_eq!(text, format!("{broken:?}"));
    broken
}
