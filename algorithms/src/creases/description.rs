//! Creases in a line.

use super::{Crease, Creases};
use std::fmt;

impl fmt::Display for Creases {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.creases.is_empty() {
            return f.write_str("no crease");
        }
        write!(
            f,
            "{}, {} ({}), {}",
            counted(self.faces, "face"),
            counted(self.creases.len(), "crease"),
            angles(&self.creases),
            counted(self.corners.len(), "corner")
        )
    }
}

/// The angles at several creases, those that are typical of each.
fn angles(creases: &[Crease]) -> String {
    let each = || creases.iter().map(|c| c.angle.median.round());
    let least = each().fold(f64::INFINITY, f64::min);
    let most = each().fold(0.0, f64::max);
    match least == most {
        true => format!("{least} degrees"),
        false => format!("{least} to {most} degrees"),
    }
}

/// A number in words up to twelve, with what is counted.
fn counted(n: usize, what: &str) -> String {
    const WORDS: [&str; 13] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    let number = WORDS.get(n).map_or_else(|| n.to_string(), |w| (*w).into());
    let plural = if n < 2 { "" } else { "s" };
    format!("{number} {what}{plural}")
}
