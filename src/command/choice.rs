//! What was chosen, and what was tried, in lines.

use super::number::counted;
use super::repeat;
use crosscap::auto::{Attempt, End};
use crosscap::{Pinned, Search};
use crosscap_algorithms::singularity::ModelName;

/// What was chosen and why, and the command that repeats the run; nothing where nothing was chosen.
pub fn chosen(input: &str, pinned: &Pinned, search: &Search) -> Vec<String> {
    let (Some(density), Some(first)) = (&search.density, search.attempts.first()) else {
        return Vec::new();
    };
    let models = match &first.parameters.models[..] {
        all if all == ModelName::AUTO => "all models".into(),
        some => some.iter().map(|m| m.name()).collect::<Vec<_>>().join(", "),
    };
    let mut lines = vec![
        format!(
            "{input}: {}, {} apart ({} to {} for 98 of 100)",
            counted(density.points, "point"),
            short(density.spacing),
            short(density.dense),
            short(density.sparse)
        ),
        format!("chosen: {}, {models}", first.reason),
    ];
    if let Some(preparation) = &search.preparation {
        lines.extend(preparation.to_string().lines().map(String::from));
    }
    if search.attempts.len() > 1 {
        lines.extend(search.attempts.iter().enumerate().map(tried));
    }
    if search.is_verified() {
        let parameters = &search.attempts[search.chosen].parameters;
        lines.push(format!(
            "the same again: {}",
            repeat::command(pinned, parameters, search.preparation.is_some())
        ));
    }
    lines
}

/// One attempt in a line.
fn tried((number, attempt): (usize, &Attempt)) -> String {
    let parameters = &attempt.parameters;
    let reason = if number == 0 {
        "first"
    } else {
        &attempt.reason
    };
    let end = match &attempt.end {
        End::Verified(topology) => format!("verified, {topology}"),
        End::Denied(topology) => {
            format!(
                "refused, it covers a gap of the points that an earlier attempt found, {topology}"
            )
        }
        End::Refused {
            open,
            violations,
            vertices,
        } => {
            let mut all: Vec<String> = Vec::new();
            if *open > 0 {
                all.push(format!("{} of {vertices} open", counted(*open, "star")));
            }
            all.extend(
                violations
                    .iter()
                    .map(|(kind, n)| format!("{n} {}", kind.meaning())),
            );
            format!("refused, {}", all.join(", "))
        }
        End::Failed(why) => format!("failed, {why}"),
    };
    format!(
        "  attempt {}: eps {}, dl {} ({reason}): {end}",
        number + 1,
        parameters.eps,
        parameters.dl
    )
}

/// A length with three digits.
fn short(length: f64) -> String {
    let rounded: f64 = format!("{length:.2e}").parse().unwrap_or(length);
    rounded.to_string()
}
