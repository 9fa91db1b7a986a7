//! The links that have a name.

use super::Link;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What kind of point has a link.
///
/// Names are given to the points of generic surfaces, of soap films, of parts that are put together from
/// plates, and of curves beside surfaces. [`LinkKind::Other`] and [`LinkKind::Split`] are all the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LinkKind {
    /// A circle: an interior point.
    Circle,
    /// An arc: a boundary point.
    Arc,
    /// Two nodes of degree 4 joined by four arcs: a point of a double curve.
    Double,
    /// One node of degree 4 with four leaves: a double curve ends where two boundaries cross.
    DoubleEnd,
    /// Six nodes of degree 4, an octahedron: three sheets cross in a point.
    Triple,
    /// Two nodes of degree 3 joined by three arcs: a point of a Y-junction.
    Junction,
    /// One node of degree 3 with three leaves: a Y-junction ends on three boundaries.
    JunctionEnd,
    /// One node of degree 3, a loop and a leaf: a sheet that stands on another one ends.
    SideSheetEnd,
    /// Four nodes of degree 3, each joined to each: four Y-junctions meet, as in soap films.
    QuadrupleJunction,
    /// One node of degree 4 with two loops, a figure eight: a double curve ends in a pinch point.
    Pinch,
    /// One node of degree 4 with a loop and two leaves: a double curve ends where the rim of one sheet goes
    /// through the other.
    RimThroughSheet,
    /// Two circles: two sheets meet in this point alone.
    IsolatedCrossing,
    /// A circle and two points: a curve goes through a sheet.
    CurveThroughSheet,
    /// A circle and one point: a curve ends on a sheet.
    CurveOnSheet,
    /// Two points: a curve that no surface touches.
    Curve,
    /// One point: the end of a curve that no surface touches.
    CurveEnd,
    /// Two nodes of one degree, five or more, joined by as many arcs: a point of a curve in which so many sheets meet.
    Book,
    /// One node of degree five or more with as many leaves: such a curve ends on the boundaries of all its sheets.
    BookEnd,
    /// Any other connected link.
    Other,
    /// Any other disconnected link.
    Split,
}

impl Link {
    /// What kind of point has this link, creases taken for smooth sheets.
    pub fn kind(&self) -> LinkKind {
        LinkKind::of(self)
    }
}

impl LinkKind {
    /// Kinds that need no declaration beyond the marks of the edges.
    pub const GENERIC: [Self; 14] = [
        Self::Circle,
        Self::Arc,
        Self::Double,
        Self::DoubleEnd,
        Self::Triple,
        Self::Junction,
        Self::JunctionEnd,
        Self::QuadrupleJunction,
        Self::CurveThroughSheet,
        Self::CurveOnSheet,
        Self::Curve,
        Self::CurveEnd,
        Self::Book,
        Self::BookEnd,
    ];

    /// All kinds that are those of one link.
    pub const NAMED: [Self; 16] = [
        Self::Circle,
        Self::Arc,
        Self::Double,
        Self::DoubleEnd,
        Self::Triple,
        Self::Junction,
        Self::JunctionEnd,
        Self::SideSheetEnd,
        Self::QuadrupleJunction,
        Self::Pinch,
        Self::RimThroughSheet,
        Self::IsolatedCrossing,
        Self::CurveThroughSheet,
        Self::CurveOnSheet,
        Self::Curve,
        Self::CurveEnd,
    ];

    /// The link of the kind; `None` for those that are the kind of several links.
    pub fn link(self) -> Option<Link> {
        let star = |leaves: u8| (1..=leaves).map(|leaf| [0, leaf]).collect::<Vec<_>>();
        let pairs = |nodes: u8, joined: fn(u8, u8) -> bool| {
            (0..nodes)
                .flat_map(|a| (a + 1..nodes).map(move |b| [a, b]))
                .filter(|&[a, b]| joined(a, b))
                .collect::<Vec<_>>()
        };
        let (nodes, arcs, circles) = match self {
            Self::Circle => (0, vec![], 1),
            Self::Arc => return Some(Link::suspension(1)),
            Self::Double => return Some(Link::suspension(4)),
            Self::Junction => return Some(Link::suspension(3)),
            Self::Curve => return Some(Link::suspension(0)),
            Self::DoubleEnd => (5, star(4), 0),
            Self::JunctionEnd => (4, star(3), 0),
            // Opposite corners of an octahedron add up to 5.
            Self::Triple => (6, pairs(6, |a, b| a + b != 5), 0),
            Self::QuadrupleJunction => (4, pairs(4, |_, _| true), 0),
            Self::SideSheetEnd => (2, vec![[0, 0], [0, 1]], 0),
            Self::Pinch => (1, vec![[0, 0]; 2], 0),
            Self::RimThroughSheet => (3, vec![[0, 0], [0, 1], [0, 2]], 0),
            Self::IsolatedCrossing => (0, vec![], 2),
            Self::CurveThroughSheet => (2, vec![], 1),
            Self::CurveOnSheet => (1, vec![], 1),
            Self::CurveEnd => (1, vec![], 0),
            Self::Book | Self::BookEnd | Self::Other | Self::Split => return None,
        };
        Link::new(nodes, &arcs, circles)
    }

    /// The kind of a link, creases taken for smooth sheets.
    fn of(link: &Link) -> Self {
        let link = link.without_creases();
        let same = |kind: &Self| kind.link().as_ref() == Some(&link);
        Self::NAMED.into_iter().find(same).unwrap_or_else(|| {
            match link.parts().len() + link.circles() {
                1 => Self::of_many(&link),
                _ => Self::Split,
            }
        })
    }

    /// The kind of a connected link of no one name.
    fn of_many(link: &Link) -> Self {
        let cells = u8::try_from(link.arcs().len()).unwrap_or(u8::MAX);
        if *link == Link::suspension(cells) {
            return Self::Book;
        }
        let leaves = (0..link.nodes).filter(|&node| link.degree(node) == 1);
        match leaves.count() == link.arcs().len() && link.nodes() == link.arcs().len() + 1 {
            true => Self::BookEnd,
            false => Self::Other,
        }
    }

    /// What the point is, in words; `None` where it has no name.
    pub fn meaning(self) -> Option<&'static str> {
        Some(match self {
            Self::Circle => "a point inside a sheet",
            Self::Arc => "a point of a boundary",
            Self::Double => "a point of a double curve",
            Self::DoubleEnd => "the end of a double curve, where two boundaries cross",
            Self::Triple => "a triple point",
            Self::Junction => "a point of a Y-junction",
            Self::JunctionEnd => "the end of a Y-junction on three boundaries",
            Self::SideSheetEnd => "the end of a sheet that stands on another one",
            Self::QuadrupleJunction => "a point where four Y-junctions meet",
            Self::Pinch => "a pinch point",
            Self::RimThroughSheet => "a point where the boundary of one sheet goes through another",
            Self::IsolatedCrossing => "a point that two sheets have alone in common",
            Self::CurveThroughSheet => "a point where a curve goes through a sheet",
            Self::CurveOnSheet => "the end of a curve on a sheet",
            Self::Curve => "a point of a curve without a surface",
            Self::CurveEnd => "the end of a curve without a surface",
            Self::Book => "a point of a curve in which five or more sheets meet",
            Self::BookEnd => {
                "the end of a curve in which five or more sheets meet, on the boundaries of all"
            }
            Self::Other | Self::Split => return None,
        })
    }
}

impl fmt::Display for LinkKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.meaning().unwrap_or("a point of no known kind"))
    }
}
