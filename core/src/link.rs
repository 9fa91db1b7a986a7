//! What a surface looks like around a point: its link.
//!
//! A small sphere about a point cuts the surface in a graph, the link, and the surface near the point
//! is the cone over it. An interior point has a circle, a point of a boundary an arc, a point of a
//! double curve two nodes joined by four arcs. Where the surface is no surface, the link says
//! what it is instead.

use crate::Error;
use serde::{Deserialize, Serialize};
use std::fmt;

mod canonical;
mod kind;

pub use kind::LinkKind;

/// The link of a point, as a multigraph up to renaming.
///
/// Its **nodes** are the arms: the curves that leave the point. The degree of a node is the number of
/// cells that meet in the curve: 1 on a boundary, 2 on a crease, 3 on a Y-junction, 4 on a double
/// curve, 0 on a curve that no surface touches. Its **arcs** are the cells between the arms, and
/// **circles** are cells that no arm bounds. Points of degree 2 that are on no crease are
/// no nodes: an arc runs through them.
///
/// Two links made with [`Link::new`] or [`Link::of_graph`] are equal when one is the other with its
/// nodes renamed. That holds up to [`Link::MOST_NODES`] nodes; larger links, which no known
/// singularity has, may differ although they are the same, and are equal to none that has a name.
///
/// ```
/// use crosscap_core::Link;
/// let pinch = Link::new(1, &[[0, 0], [0, 0]], 0).unwrap();
/// assert_eq!(pinch.to_string(), "a node of degree 4 with two loops");
/// // The same with a point in the middle of every arc.
/// let graph = Link::of_graph(3, &[[1, 0], [0, 1], [1, 2], [2, 1]], |_| false);
/// assert_eq!(graph, pinch);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Link {
    nodes: u8,
    arcs: Vec<[u8; 2]>,
    circles: u8,
}

/// A link as it is read.
#[derive(Deserialize)]
struct Unchecked {
    nodes: u8,
    arcs: Vec<[u8; 2]>,
    circles: u8,
}

impl TryFrom<Unchecked> for Link {
    type Error = Error;

    fn try_from(raw: Unchecked) -> Result<Self, Error> {
        Self::new(raw.nodes, &raw.arcs, raw.circles).ok_or_else(|| Error::Shape {
            found: format!("a link of {} nodes with arcs {:?}", raw.nodes, raw.arcs),
            expected: "arcs between its nodes".into(),
        })
    }
}

impl Link {
    /// Number of nodes up to which renamed links are recognized.
    pub const MOST_NODES: usize = 8;
    /// Number of nodes, arcs and circles beyond which nothing is kept apart: counts stop there.
    const MOST: usize = 200;

    /// The link with the given number of nodes, arcs by the nodes at their ends, and circles. `None` for an
    /// arc that ends at no node, or for more than 200 of anything.
    pub fn new(nodes: u8, arcs: &[[u8; 2]], circles: u8) -> Option<Self> {
        let known = arcs.iter().flatten().all(|&end| end < nodes);
        let few = usize::from(nodes.max(circles)).max(arcs.len()) <= Self::MOST;
        (known && few).then(|| {
            Self {
                nodes,
                arcs: arcs.to_vec(),
                circles,
            }
            .canonical()
        })
    }

    /// The link of a graph of `count` points and edges between them, in which points of degree 2 are passed
    /// over unless they are `marked`. Edges may be doubled and may be loops; those that end at no point are
    /// left out.
    ///
    /// O(p + e) for p points and e edges, and at most 8! steps to bring it into its canonical form.
    pub fn of_graph(count: usize, edges: &[[u32; 2]], marked: impl Fn(usize) -> bool) -> Self {
        smoothed(count, edges, marked).canonical()
    }

    /// A circle: an interior point of a surface.
    pub fn circle() -> Self {
        Self {
            nodes: 0,
            arcs: Vec::new(),
            circles: 1,
        }
    }

    /// Two nodes joined by `cells` arcs: a point of a curve in which that many cells meet.
    pub fn suspension(cells: u8) -> Self {
        Self {
            nodes: 2,
            arcs: vec![[0, 1]; cells.into()],
            circles: 0,
        }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes.into()
    }

    /// The arcs by the nodes at their ends, sorted.
    pub fn arcs(&self) -> &[[u8; 2]] {
        &self.arcs
    }

    /// Number of circles.
    pub fn circles(&self) -> usize {
        self.circles.into()
    }

    /// How many arc ends are at a node, those of a loop both.
    pub fn degree(&self, node: u8) -> usize {
        self.arcs
            .iter()
            .flatten()
            .filter(|&&end| end == node)
            .count()
    }

    /// The same link with the nodes of degree 2 passed over: a crease is taken for a smooth sheet.
    pub fn without_creases(&self) -> Self {
        let edges: Vec<[u32; 2]> = self.arcs.iter().map(|arc| arc.map(u32::from)).collect();
        let mut link = smoothed(self.nodes(), &edges, |_| false);
        link.circles = link.circles.saturating_add(self.circles);
        link.canonical()
    }

    /// The same for all links that are the same but for the names of their nodes.
    fn canonical(self) -> Self {
        let arcs = canonical::arcs(self.nodes, &self.arcs, Self::MOST_NODES);
        Self { arcs, ..self }
    }

    /// The nodes of each connected part that has any.
    fn parts(&self) -> Vec<Vec<u8>> {
        let mut part: Vec<u8> = (0..self.nodes).collect();
        // Arcs are few: names spread until nothing changes.
        let mut changed = true;
        while changed {
            changed = false;
            for &[a, b] in &self.arcs {
                let least = part[usize::from(a)].min(part[usize::from(b)]);
                for end in [a, b] {
                    changed |= part[usize::from(end)] != least;
                    part[usize::from(end)] = least;
                }
            }
        }
        let mut parts: Vec<Vec<u8>> = Vec::new();
        for name in 0..self.nodes {
            let members: Vec<u8> = (0..self.nodes)
                .filter(|&v| part[usize::from(v)] == name)
                .collect();
            if !members.is_empty() {
                parts.push(members);
            }
        }
        parts
    }
}

/// The graph with unmarked points of degree 2 passed over, its nodes in their order.
fn smoothed(count: usize, edges: &[[u32; 2]], marked: impl Fn(usize) -> bool) -> Link {
    let edges: Vec<[usize; 2]> = (edges.iter().map(|e| e.map(|v| v as usize)))
        .filter(|e| e.iter().all(|&v| v < count))
        .collect();
    let mut at: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (k, e) in edges.iter().enumerate() {
        e.iter().for_each(|&v| at[v].push(k));
    }
    let is_node = |v: usize| at[v].len() != 2 || marked(v);
    let mut name = vec![0; count];
    let mut nodes = 0usize;
    for v in (0..count).filter(|&v| is_node(v)) {
        name[v] = nodes.min(Link::MOST);
        nodes += 1;
    }
    let mut used = vec![false; edges.len()];
    // The node at which a walk from `v` along edge `k` arrives; `None` where it goes round.
    let walk = |v: usize, k: usize, used: &mut Vec<bool>| -> Option<usize> {
        let (mut here, mut by) = (v, k);
        loop {
            used[by] = true;
            let [p, q] = edges[by];
            here = if p == here { q } else { p };
            if is_node(here) {
                return Some(here);
            }
            by = if at[here][0] == by {
                at[here][1]
            } else {
                at[here][0]
            };
            if used[by] {
                return None;
            }
        }
    };
    let mut arcs = Vec::new();
    for v in (0..count).filter(|&v| is_node(v)) {
        for &k in &at[v] {
            if !used[k]
                && let Some(end) = walk(v, k, &mut used)
            {
                arcs.push([name[v] as u8, name[end] as u8]);
            }
        }
    }
    let mut circles = 0usize;
    for k in 0..edges.len() {
        if !used[k] {
            walk(edges[k][0], k, &mut used);
            circles += 1;
        }
    }
    arcs.truncate(Link::MOST);
    Link {
        nodes: nodes.min(Link::MOST) as u8,
        arcs,
        circles: circles.min(Link::MOST) as u8,
    }
}

/// A count in words, as far as words are common.
fn number(count: usize) -> String {
    const WORDS: [&str; 13] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    WORDS
        .get(count)
        .map_or_else(|| count.to_string(), |word| (*word).into())
}

/// A count with a noun, "a" for one.
fn counted(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("a {noun}")
    } else {
        format!("{} {noun}s", number(count))
    }
}

impl fmt::Display for Link {
    /// The graph in words, part by part.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut words: Vec<String> = self
            .parts()
            .iter()
            .map(|part| self.describe(part))
            .collect();
        words.sort();
        let mut phrases: Vec<String> = Vec::new();
        if self.circles > 0 {
            phrases.push(counted(self.circles.into(), "circle"));
        }
        for same in words.chunk_by(|a, b| a == b) {
            phrases.push(match (same.len(), same[0].as_str()) {
                (1, _) => same[0].clone(),
                (count, "a point") => counted(count, "point"),
                (count, "an arc") => format!("{} arcs", number(count)),
                (count, one) => format!("{} times {one}", number(count)),
            });
        }
        if phrases.is_empty() {
            return f.write_str("nothing");
        }
        f.write_str(&phrases.join(" and "))
    }
}

impl Link {
    /// One connected part with nodes, in words.
    fn describe(&self, part: &[u8]) -> String {
        let leaves = part.iter().filter(|&&v| self.degree(v) == 1).count();
        let inner: Vec<u8> = part
            .iter()
            .copied()
            .filter(|&v| self.degree(v) != 1)
            .collect();
        let degrees: Vec<usize> = inner.iter().map(|&v| self.degree(v)).collect();
        let loops = self
            .arcs
            .iter()
            .filter(|[a, b]| a == b && part.contains(a))
            .count();
        let arcs = self.arcs.iter().filter(|[a, _]| part.contains(a)).count();
        match (&inner[..], leaves) {
            ([], _) => return "an arc".into(),
            ([_], 0) if degrees == [0] => return "a point".into(),
            _ => {}
        }
        let same = degrees.windows(2).all(|w| w[0] == w[1]);
        let mut text = if same {
            format!("{} of degree {}", counted(inner.len(), "node"), degrees[0])
        } else {
            let list: Vec<String> = degrees.iter().map(ToString::to_string).collect();
            format!(
                "{} of degrees {}",
                counted(inner.len(), "node"),
                list.join(", ")
            )
        };
        let between = arcs - loops - leaves;
        text += &match between {
            0 => String::new(),
            1 if inner.len() == 2 => " joined by an arc".into(),
            _ => format!(" joined by {}", counted(between, "arc")),
        };
        let mut with = Vec::new();
        if loops > 0 {
            with.push(counted(loops, "loop"));
        }
        match leaves {
            0 => {}
            1 => with.push("a leaf".into()),
            _ => with.push(format!("{} leaves", number(leaves))),
        }
        if !with.is_empty() {
            text += &format!(" with {}", with.join(" and "));
        }
        text
    }
}

#[cfg(test)]
mod tests;
