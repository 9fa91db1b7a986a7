//! The pieces of a mesh in a paragraph of English.

use super::{CrossingAngle, CurveEnd, DoubleCurve, Pieces, Sidedness};
use std::fmt;

impl fmt::Display for Pieces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut sentences = vec![self.inventory()];
        sentences.extend(self.meetings());
        sentences.extend(self.cuts());
        sentences.extend(self.touches());
        sentences.extend(self.lines());
        let triple = self
            .multiple_points
            .iter()
            .filter(|p| p.sheets == 3)
            .count();
        let higher = self.multiple_points.len() - triple;
        for (number, one, many) in [
            (triple, "triple point", "triple points"),
            (
                higher,
                "point of more than three sheets",
                "points of more than three sheets",
            ),
            (
                self.isolated_vertices,
                "isolated vertex",
                "isolated vertices",
            ),
        ] {
            if number > 0 {
                let verb = if number == 1 { "is" } else { "are" };
                sentences.push(format!("there {verb} {}", counted(number, one, many)));
            }
        }
        for (k, sentence) in sentences.iter().enumerate() {
            let mut letters = sentence.chars();
            let first: String = letters
                .next()
                .into_iter()
                .flat_map(char::to_uppercase)
                .collect();
            let space = if k > 0 { " " } else { "" };
            write!(f, "{space}{first}{}.", letters.as_str())?;
        }
        Ok(())
    }
}

/// A number in words up to twelve.
pub(super) fn number(n: usize) -> String {
    const WORDS: [&str; 13] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    WORDS.get(n).map_or_else(|| n.to_string(), |w| (*w).into())
}

fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{} {}", number(n), if n == 1 { one } else { many })
}

/// "a", "a and b", "a, b and c".
fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Angles in brackets, whole degrees; nothing for none.
fn angles(what: &str, all: impl Iterator<Item = CrossingAngle> + Clone) -> String {
    let least = all.clone().map(|a| a.min).fold(f64::INFINITY, f64::min);
    let most = all.map(|a| a.max).fold(f64::NEG_INFINITY, f64::max);
    if least > most {
        return String::new();
    }
    let (least, most) = (format!("{least:.0}"), format!("{most:.0}"));
    if least == most {
        format!(" ({what} {least} degrees)")
    } else {
        format!(" ({what} {least} to {most} degrees)")
    }
}

/// Equal items counted, in the order of their first appearance.
fn grouped<K: PartialEq, T>(items: impl Iterator<Item = (K, T)>) -> Vec<(K, Vec<T>)> {
    let mut groups: Vec<(K, Vec<T>)> = Vec::new();
    for (key, item) in items {
        match groups.iter_mut().find(|g| g.0 == key) {
            Some(group) => group.1.push(item),
            None => groups.push((key, vec![item])),
        }
    }
    groups
}

/// In which pinch points curves end, which all have as many.
fn stops(curves: &[&DoubleCurve]) -> String {
    let each = if curves.len() > 1 { ", each" } else { "" };
    let at_boundary = |c: &&DoubleCurve| c.ends.is_some_and(|e| e.contains(&CurveEnd::Boundary));
    match curves[0].pinches() {
        0 => String::new(),
        1 if curves.iter().all(at_boundary) => {
            format!("{each} from a pinch point to the boundary")
        }
        1 => format!("{each} from a pinch point"),
        _ => format!("{each} between two pinch points"),
    }
}

impl DoubleCurve {
    /// How many of its ends are pinch points.
    fn pinches(&self) -> usize {
        let ends = self.ends.iter().flatten();
        ends.filter(|&&end| end == CurveEnd::Pinch).count()
    }
}

impl Pieces {
    /// What a piece is called: by its name, with a number when there are several of that name.
    fn label(&self, piece: u32) -> String {
        let p = &self.pieces[piece as usize];
        let same = |q: &&super::Piece| q.surface == p.surface;
        if self.pieces.iter().filter(same).count() == 1 {
            return format!("the {}", p.name);
        }
        let place = self.pieces[..piece as usize].iter().filter(same).count();
        match p.name.split_once(" with ") {
            Some((head, tail)) => format!("{head} {} with {tail}", place + 1),
            None => format!("{} {}", p.name, place + 1),
        }
    }

    fn inventory(&self) -> String {
        if self.pieces.is_empty() {
            return "no surface".into();
        }
        let groups = grouped(self.pieces.iter().map(|p| (p.surface, ())));
        let items: Vec<String> = groups
            .iter()
            .map(|(s, all)| counted(all.len(), &s.to_string(), &s.plural()))
            .collect();
        listed(&items)
    }

    fn meetings(&self) -> Vec<String> {
        let kinds = grouped(
            self.curves
                .iter()
                .map(|c| ((c.circle, c.pinches(), c.preimages.clone()), c)),
        );
        kinds
            .iter()
            .map(|(_, curves)| self.meeting(curves))
            .collect()
    }

    /// Curves with equal preimages in one sentence.
    fn meeting(&self, curves: &[&DoubleCurve]) -> String {
        let curve = curves[0];
        let many = curves.len() > 1;
        let what = if curve.circle {
            counted(curves.len(), "circle", "circles")
        } else {
            counted(curves.len(), "arc", "arcs")
        };
        let sides = |s: Option<Sidedness>| match s {
            Some(Sidedness::OneSided) => "one-sided",
            Some(Sidedness::TwoSided) => "two-sided",
            None => "open",
        };
        let mut text = match curve.pieces()[..] {
            [a, b] => format!("{} and {} meet in {what}", self.label(a), self.label(b)),
            _ => {
                let a = curve.preimages.first().map_or(0, |p| p.piece);
                format!("{} crosses itself in {what}", self.label(a))
            }
        };
        text += &stops(curves);
        match curve.preimages[..] {
            [a, b] if curve.circle && a.piece != b.piece => {
                let each = if many { "each " } else { "" };
                let (s, t) = (sides(a.sidedness), sides(b.sidedness));
                let (a, b) = (self.label(a.piece), self.label(b.piece));
                text += &format!(", {each}{s} on {a} and {t} on {b}");
            }
            [a, b] if curve.circle => {
                let (s, t) = (sides(a.sidedness), sides(b.sidedness));
                text += if many {
                    ", each the image"
                } else {
                    ", the image"
                };
                text += &if s == t {
                    format!(" of two {s} circles")
                } else {
                    format!(" of a {s} and a {t} circle")
                };
            }
            [a] => {
                text += if many { ", each covered" } else { ", covered" };
                text += &match (a.circle, a.sidedness) {
                    (true, s) => format!(" twice by one {} circle", sides(s)),
                    (false, _) => " twice by one arc".to_string(),
                };
            }
            _ => {}
        }
        text += &angles("crossing angle", curves.iter().filter_map(|c| c.angle));
        text
    }

    /// Points in which sheets meet.
    fn touches(&self) -> Vec<String> {
        let groups = grouped(self.contacts.iter().map(|c| (&c.pieces, ())));
        let say = |(pieces, all): &(&Vec<u32>, Vec<()>)| {
            let mut once = (*pieces).clone();
            once.dedup();
            let labels: Vec<String> = once.iter().map(|&p| self.label(p)).collect();
            let (verb, itself) = match labels.len() {
                1 => ("meets", " itself"),
                _ => ("meet", ""),
            };
            let points = counted(all.len(), "point", "points");
            format!("{} {verb}{itself} in {points} alone", listed(&labels))
        };
        groups.iter().map(say).collect()
    }

    /// Curves without a surface.
    fn lines(&self) -> Vec<String> {
        /// Whether it is a circle, and how often it meets which pieces, ending there or not.
        type Kind<'a> = (bool, Vec<((&'a Vec<u32>, bool), usize)>);
        let kinds = grouped(self.bare_curves.iter().map(|c| {
            let meetings = grouped(c.meetings.iter().map(|m| ((&m.pieces, m.end), ())));
            let counts: Vec<_> = meetings
                .iter()
                .map(|(key, all)| (*key, all.len()))
                .collect();
            ((c.circle, counts), ())
        }));
        let say = |((circle, meetings), all): &(Kind<'_>, Vec<()>)| {
            let many = all.len() > 1;
            let what = match circle {
                true => counted(all.len(), "bare circle", "bare circles"),
                false => counted(all.len(), "bare arc", "bare arcs"),
            };
            if meetings.is_empty() {
                return format!("{what} {} apart", if many { "lie" } else { "lies" });
            }
            let each = meetings.iter().map(|((pieces, end), count)| {
                let labels: Vec<String> = pieces.iter().map(|&p| self.label(p)).collect();
                let verb = match (end, many) {
                    (true, false) => "ends on",
                    (true, true) => "end on",
                    (false, false) => "goes through",
                    (false, true) => "go through",
                };
                let points = counted(*count, "point", "points");
                let each = if many { " each" } else { "" };
                format!("{verb} {} in {points}{each}", listed(&labels))
            });
            format!("{what} {}", listed(&each.collect::<Vec<_>>()))
        };
        kinds.iter().map(say).collect()
    }

    fn cuts(&self) -> Vec<String> {
        let kinds = grouped(
            self.junctions
                .iter()
                .map(|j| ((j.circle, j.cells, &j.pieces), j.angle)),
        );
        type Kind<'a> = ((bool, u32, &'a Vec<u32>), Vec<Option<CrossingAngle>>);
        let describe = |((circle, cells, pieces), all): &Kind<'_>| {
            let labels: Vec<String> = pieces.iter().map(|&p| self.label(p)).collect();
            let what = match circle {
                true => counted(all.len(), "circle", "circles"),
                false => counted(all.len(), "arc", "arcs"),
            };
            let verb = if labels.len() == 1 { "ends" } else { "end" };
            let cells = number(*cells as usize);
            let angles = angles("angles", all.iter().flatten().copied());
            format!(
                "{} {verb} in {what} of {cells} cells{angles}",
                listed(&labels)
            )
        };
        kinds.iter().map(describe).collect()
    }
}
