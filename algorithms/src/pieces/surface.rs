//! Compact surfaces by name.

use serde::Serialize;
use std::fmt;

/// A connected compact surface up to homeomorphism: the classification theorem says that these
/// three numbers are enough.
///
/// ```
/// use crosscap_algorithms::pieces::Surface;
/// let s = Surface { orientable: false, genus: 2, boundary_circles: 0 };
/// assert_eq!((s.to_string().as_str(), s.euler()), ("Klein bottle", 0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Surface {
    /// Whether it has two sides in the intrinsic sense: no Moebius strip inside.
    pub orientable: bool,
    /// Number of handles when orientable, of crosscaps when not.
    pub genus: u64,
    /// Number of boundary circles; 0 for a closed surface.
    pub boundary_circles: u64,
}

impl Surface {
    /// Euler characteristic: 2 - 2 genus - boundary circles, or 2 - genus - boundary circles
    /// when not orientable.
    pub fn euler(&self) -> i64 {
        let taken = if self.orientable { 2 } else { 1 } * self.genus + self.boundary_circles;
        2 - taken as i64
    }

    /// From its Euler characteristic.
    pub(super) fn from_euler(orientable: bool, euler: i64, boundary_circles: u64) -> Self {
        let taken = (2 - euler).unsigned_abs().saturating_sub(boundary_circles);
        Self {
            orientable,
            genus: if orientable { taken / 2 } else { taken },
            boundary_circles,
        }
    }

    /// The name of several of them.
    pub fn plural(&self) -> String {
        let name = self.to_string();
        let (head, tail) = name.split_once(" with ").unwrap_or((&name, ""));
        let head = match head {
            "pair of pants" => "pairs of pants".into(),
            _ => match head.strip_suffix("us") {
                Some(stem) => format!("{stem}i"),
                None => format!("{head}s"),
            },
        };
        if tail.is_empty() {
            head
        } else {
            format!("{head} with {tail}")
        }
    }
}

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (g, b) = (self.genus, self.boundary_circles);
        let name = match (self.orientable, g, b) {
            (true, 0, 0) => "sphere",
            (true, 0, 1) => "disc",
            (true, 0, 2) => "annulus",
            (true, 0, 3) => "pair of pants",
            (true, 0, _) => "sphere",
            (true, 1, _) => "torus",
            (true, _, _) => return numbered(f, format_args!("genus-{g} surface"), b),
            (false, 1, 0) => "projective plane",
            (false, 1, 1) => "Moebius strip",
            (false, 1, _) => "projective plane",
            (false, 2, _) => "Klein bottle",
            (false, _, _) => {
                return numbered(f, format_args!("non-orientable genus-{g} surface"), b);
            }
        };
        let named_whole = matches!((self.orientable, g, b), (true, 0, 1..=3) | (false, 1, 1));
        numbered(f, format_args!("{name}"), if named_whole { 0 } else { b })
    }
}

fn numbered(f: &mut fmt::Formatter<'_>, name: fmt::Arguments<'_>, circles: u64) -> fmt::Result {
    match circles {
        0 => write!(f, "{name}"),
        1 => write!(f, "{name} with 1 boundary circle"),
        b => write!(f, "{name} with {b} boundary circles"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        let named = |orientable, euler, b| {
            let s = Surface::from_euler(orientable, euler, b);
            assert_eq!(s.euler(), euler);
            (s.to_string(), s.plural())
        };
        for (orientable, euler, b, one, many) in [
            (true, 2, 0, "sphere", "spheres"),
            (true, 0, 0, "torus", "tori"),
            (true, -2, 0, "genus-2 surface", "genus-2 surfaces"),
            (true, 1, 1, "disc", "discs"),
            (true, 0, 2, "annulus", "annuli"),
            (true, -1, 3, "pair of pants", "pairs of pants"),
            (
                true,
                -2,
                4,
                "sphere with 4 boundary circles",
                "spheres with 4 boundary circles",
            ),
            (
                true,
                -1,
                1,
                "torus with 1 boundary circle",
                "tori with 1 boundary circle",
            ),
            (false, 1, 0, "projective plane", "projective planes"),
            (false, 0, 0, "Klein bottle", "Klein bottles"),
            (false, 0, 1, "Moebius strip", "Moebius strips"),
            (
                false,
                -1,
                0,
                "non-orientable genus-3 surface",
                "non-orientable genus-3 surfaces",
            ),
        ] {
            assert_eq!(named(orientable, euler, b), (one.into(), many.into()));
        }
    }
}
