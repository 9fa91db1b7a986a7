//! The table.

use crate::run::{End, Rule, Run};
use std::collections::BTreeMap;
use std::fmt;

/// Sizes of the feature at which a class ends, in spacings.
const CLASSES: [(f64, &str); 4] = [
    (3.0, "below 3"),
    (5.0, "3 to 5"),
    (8.0, "5 to 8"),
    (f64::INFINITY, "8 and more"),
];
/// Where dl was not the program's to choose, the most that it may be beside a feature that could be kept: a hole needs a
/// boundary of six edges.
const COARSE: f64 = 0.4;

#[derive(Clone, Copy, Default)]
struct Counts {
    ends: [usize; 4],
    seconds: f64,
}

impl Counts {
    fn of(&self, end: End) -> usize {
        self.ends[end as usize]
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [right, wrong, refused, late] = self.ends;
        write!(f, "{right} / **{wrong}** / {refused} / {late}")
    }
}

/// What became of all runs.
#[derive(Default)]
pub struct Tally {
    families: BTreeMap<&'static str, [Counts; CLASSES.len()]>,
    rules: BTreeMap<Rule, [Counts; CLASSES.len()]>,
    /// Runs with a feature that is large for points and dl.
    resolvable: BTreeMap<Rule, Counts>,
    /// Right runs that are wrong by the narrow limit at ends.
    off_at_end: [usize; CLASSES.len()],
}

impl Tally {
    pub fn add(&mut self, run: &Run) {
        let class = CLASSES.iter().position(|c| run.size < c.0).unwrap_or(0);
        let count = |counts: &mut Counts| {
            counts.ends[run.end as usize] += 1;
            counts.seconds += run.seconds;
        };
        count(&mut self.families.entry(run.feature.name).or_default()[class]);
        count(&mut self.rules.entry(run.rule).or_default()[class]);
        self.off_at_end[class] += usize::from(run.is_off_at_end());
        if class == CLASSES.len() - 1 && (run.rule == Rule::Auto || run.coarse <= COARSE) {
            count(self.resolvable.entry(run.rule).or_default());
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "right / **wrong** / refused / out of time, by the size of the feature in spacings\n"
        )?;
        let names = CLASSES.map(|c| c.1).join(" | ");
        writeln!(
            f,
            "| family | {names} | s |\n| --- | --- | --- | --- | --- | ---: |"
        )?;
        let mut line = |name: &str, counts: &[Counts; CLASSES.len()]| {
            let seconds: f64 = counts.iter().map(|c| c.seconds).sum();
            let cells = counts.map(|c| c.to_string()).join(" | ");
            writeln!(f, "| {name} | {cells} | {seconds:.0} |")
        };
        let mut all = [Counts::default(); CLASSES.len()];
        for (name, counts) in &self.families {
            line(name, counts)?;
            for (sum, own) in all.iter_mut().zip(counts) {
                sum.ends.iter_mut().zip(own.ends).for_each(|(a, b)| *a += b);
                sum.seconds += own.seconds;
            }
        }
        line("**all**", &all)?;
        for (rule, counts) in &self.rules {
            line(&format!("rule *{rule}*"), counts)?;
        }
        for (rule, counts) in &self.resolvable {
            let sum: usize = counts.ends.iter().sum();
            let right = counts.of(End::Right);
            writeln!(
                f,
                "\nrule {rule}: {right} of {sum} features of 8 spacings and more, none below 2.5 dl, are reconstructed"
            )?;
        }
        let off = self.off_at_end.map(|n| n.to_string()).join(", ");
        writeln!(
            f,
            "\nwrong as well when a mesh may be no further off where it ends than elsewhere: {off}"
        )
    }
}
