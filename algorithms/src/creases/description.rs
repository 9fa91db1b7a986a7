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
            "{}, {} ({}; a bend of a radius below {} counts as one), {}",
            counted(self.faces, "face"),
            counted(self.creases.len(), "crease"),
            angles(&self.creases),
            figures(self.resolution),
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

/// A positive number to two figures.
fn figures(x: f64) -> f64 {
    let scale = 10_f64.powi(1 - x.log10().floor() as i32);
    (x * scale).round() / scale
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
