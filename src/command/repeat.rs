//! The command that repeats a run with everything pinned.

use crosscap::{MetricName, Neighborhoods, Parameters, Pinned};
use crosscap_algorithms::singularity::ModelName;
use crosscap_backends::geodesic::EdgeRule;
use std::ffi::OsString;

/// The command of this process with the parameters that it chose.
///
/// `prepared` says whether something was done about outliers and noise.
pub fn command(pinned: &Pinned, chosen: &Parameters, prepared: bool) -> String {
    // Another program may stand before the command, an interpreter say.
    let own = std::env::args_os()
        .skip_while(|word| word != "reconstruct")
        .map(quoted);
    let more = Some(options(pinned, chosen, prepared)).filter(|more| !more.is_empty());
    own.chain(more)
        .fold("crosscap".into(), |line, word| line + " " + &word)
}

/// The options that stand for what was chosen beside what is pinned.
pub fn options(pinned: &Pinned, chosen: &Parameters, prepared: bool) -> String {
    let mut all = flags(pinned, chosen);
    if prepared && pinned.prepare.is_none() {
        all.push("--prepare yes".into());
    }
    all.join(" ")
}

/// The options of what was chosen, where it is not the default.
fn flags(pinned: &Pinned, chosen: &Parameters) -> Vec<String> {
    let usual = Parameters::new(chosen.eps, chosen.dl);
    let mut out = Vec::new();
    let mut add = |name: &str, value: String| out.push(format!("--{name} {value}"));
    let lengths = [
        ("eps", pinned.eps, chosen.eps, f64::NAN),
        ("dl", pinned.dl, chosen.dl, f64::NAN),
        ("dt", pinned.dt, chosen.dt, usual.dt),
        ("dp", pinned.dp, chosen.dp, usual.dp),
        ("ep", pinned.ep, chosen.ep, usual.ep),
    ];
    for (name, given, value, default) in lengths {
        if given.is_none() && value != default {
            add(name, value.to_string());
        }
    }
    if let (None, Some(radius)) = (pinned.tri_eps, chosen.tri_eps) {
        add("tri-eps", radius.to_string());
    }
    if pinned.models.is_none() && chosen.models != usual.models {
        add("models", names(&chosen.models));
    }
    if pinned.seed.is_none() && chosen.seed != usual.seed {
        add("seed", chosen.seed.to_string());
    }
    let spaces = &chosen.spaces;
    if pinned.metric.is_none() && spaces.metric != MetricName::default() {
        add("metric", spaces.metric.to_string());
    }
    if let (None, Some(metric)) = (pinned.tri_metric, spaces.tri_metric) {
        add("tri-metric", metric.to_string());
    }
    if pinned.graph.is_none() && spaces.graph != usual.spaces.graph {
        match spaces.graph {
            EdgeRule::Nearest(count) => add("graph-k", count.to_string()),
            EdgeRule::Within(radius) => add("graph-eps", radius.to_string()),
        }
    }
    if pinned.neighborhoods.is_none() && spaces.neighborhoods != Neighborhoods::default() {
        add("neighborhoods", spaces.neighborhoods.to_string());
    }
    if pinned.sheets.is_none() && spaces.sheets {
        out.push("--graph-sheets".into());
    }
    if pinned.planes.is_none() && spaces.planes {
        out.push("--tri-planes".into());
    }
    if pinned.surface.is_none() && chosen.surface {
        out.push("--surface".into());
    }
    out
}

/// The value of `--models`.
fn names(models: &[ModelName]) -> String {
    if models == ModelName::AUTO {
        return "auto".into();
    }
    let names: Vec<&str> = models.iter().map(|model| model.name()).collect();
    names.join(",")
}

/// An argument as a shell takes it.
fn quoted(argument: OsString) -> String {
    let text = argument.to_string_lossy();
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        return text.into_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_chosen_is_added() {
        let chosen = Parameters {
            models: ModelName::AUTO.to_vec(),
            seed: 3,
            ..Parameters::new(0.25, 0.125)
        };
        let all = flags(&Pinned::default(), &chosen).join(" ");
        assert_eq!(all, "--eps 0.25 --dl 0.125 --models auto --seed 3");
        let pinned = Pinned {
            dl: Some(0.125),
            seed: Some(3),
            ..Pinned::default()
        };
        assert_eq!(
            flags(&pinned, &chosen).join(" "),
            "--eps 0.25 --models auto"
        );
    }

    #[test]
    fn a_shell_reads_the_same_words() {
        assert_eq!(quoted("a-b_1.npy".into()), "a-b_1.npy");
        assert_eq!(quoted("two words".into()), "'two words'");
        assert_eq!(quoted("it's".into()), r"'it'\''s'");
        assert_eq!(quoted("".into()), "''");
    }
}
