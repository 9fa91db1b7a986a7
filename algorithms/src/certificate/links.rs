//! Third level: every vertex has a neighborhood of an admissible kind.
//!
//! The link of a vertex is the graph of its neighbors, joined by the edges opposite of it in its
//! triangles. Its shape, with nodes of degree two forgotten, says what the surface looks like
//! around the vertex: a circle is an interior point, an arc a boundary point, two nodes of
//! degree four joined by four arcs a point of a double curve, and so on.

use super::incidence::Incidence;
use super::{Place, Violation, ViolationKind};
use crosscap_core::Mesh;
use serde::Serialize;
use std::collections::BTreeMap;

/// What the surface looks like around a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
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
    /// Any other connected link.
    Other,
    /// Any other disconnected link.
    Split,
}

impl LinkKind {
    /// Kinds that need no declaration beyond the marks of the edges.
    pub const GENERIC: [Self; 12] = [
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
    ];
}

/// A vertex that is declared to be a special point, a stratum of dimension 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct SpecialPoint {
    /// The vertex.
    pub vertex: u32,
    /// What its link must be; declares kinds outside [`LinkKind::GENERIC`] as well.
    pub link: LinkKind,
}

/// Vertices by the kind of their link.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LinkReport {
    /// Number of vertices of each kind of link; vertices without any edge are left out.
    pub census: BTreeMap<LinkKind, usize>,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

/// Work space for one link.
#[derive(Default)]
struct Link {
    nodes: Vec<u32>,
    edges: Vec<(u32, u32)>,
    starts: Vec<u32>,
    ends: Vec<u32>,
    component: Vec<u32>,
    stack: Vec<u32>,
}

impl Link {
    /// Reads the link of `vertex`; `lone` are the neighbors along curve edges.
    fn read(&mut self, mesh: &Mesh, triangles: &[u32], vertex: u32, along: &[u32]) {
        self.nodes.clear();
        self.edges.clear();
        for &t in triangles {
            let corners = mesh.complex.triangles[t as usize];
            let mut others = corners.iter().copied().filter(|&v| v != vertex);
            if let (Some(a), Some(b)) = (others.next(), others.next()) {
                self.edges.push((a, b));
                self.nodes.extend([a, b]);
            }
        }
        self.nodes.extend(along);
        self.nodes.sort_unstable();
        self.nodes.dedup();
        let nodes = &self.nodes;
        for e in &mut self.edges {
            let find = |v: u32| nodes.partition_point(|&n| n < v) as u32;
            *e = (find(e.0), find(e.1));
        }
        self.starts.clear();
        self.starts.resize(self.nodes.len() + 1, 0);
        for &(a, b) in &self.edges {
            self.starts[a as usize + 1] += 1;
            self.starts[b as usize + 1] += 1;
        }
        for k in 0..self.nodes.len() {
            self.starts[k + 1] += self.starts[k];
        }
        self.ends.clear();
        self.ends.resize(2 * self.edges.len(), 0);
        self.stack.clear();
        self.stack.extend(&self.starts);
        for (k, &(a, b)) in self.edges.iter().enumerate() {
            for v in [a, b] {
                self.ends[self.stack[v as usize] as usize] = k as u32;
                self.stack[v as usize] += 1;
            }
        }
    }

    fn at(&self, node: u32) -> &[u32] {
        &self.ends[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize]
    }

    fn degree(&self, node: u32) -> usize {
        self.at(node).len()
    }

    fn kind(&mut self) -> LinkKind {
        let n = self.nodes.len();
        self.component.clear();
        self.component.resize(n, u32::MAX);
        let (mut circles, mut points, mut others) = (0, 0, 0);
        let mut last = LinkKind::Other;
        for start in 0..n as u32 {
            if self.component[start as usize] != u32::MAX {
                continue;
            }
            self.stack.clear();
            self.stack.push(start);
            self.component[start as usize] = start;
            while let Some(a) = self.stack.pop() {
                for k in self.starts[a as usize]..self.starts[a as usize + 1] {
                    let (p, q) = self.edges[self.ends[k as usize] as usize];
                    let b = if p == a { q } else { p };
                    if self.component[b as usize] == u32::MAX {
                        self.component[b as usize] = start;
                        self.stack.push(b);
                    }
                }
            }
            match self.connected_kind(start) {
                LinkKind::CurveEnd => points += 1,
                LinkKind::Circle => circles += 1,
                kind => {
                    others += 1;
                    last = kind;
                }
            }
        }
        match (others, circles, points) {
            (0, 1, 0) => LinkKind::Circle,
            (1, 0, 0) => last,
            (0, 2, 0) => LinkKind::IsolatedCrossing,
            (0, 1, 2) => LinkKind::CurveThroughSheet,
            (0, 1, 1) => LinkKind::CurveOnSheet,
            (0, 0, 2) => LinkKind::Curve,
            (0, 0, 1) => LinkKind::CurveEnd,
            _ => LinkKind::Split,
        }
    }

    /// Kind of the component that starts at a node; a single node is a [`LinkKind::CurveEnd`].
    fn connected_kind(&self, start: u32) -> LinkKind {
        let mut degrees = [0_usize; 6];
        let members =
            || (start..self.nodes.len() as u32).filter(|&v| self.component[v as usize] == start);
        for v in members() {
            degrees[self.degree(v).min(5)] += 1;
        }
        let branch = |d: usize| members().filter(move |&v| self.degree(v) == d);
        match (degrees[0], degrees[1], degrees[3], degrees[4], degrees[5]) {
            (1, 0, 0, 0, 0) => LinkKind::CurveEnd,
            (0, 0, 0, 0, 0) => LinkKind::Circle,
            (0, 2, 0, 0, 0) => LinkKind::Arc,
            (0, 0, 0, 1, 0) => LinkKind::Pinch,
            (0, 4, 0, 1, 0) => LinkKind::DoubleEnd,
            (0, 3, 1, 0, 0) => LinkKind::JunctionEnd,
            (0, 1, 1, 0, 0) => LinkKind::SideSheetEnd,
            (0, 0, 0, 2, 0) if branch(4).all(|v| !self.has_loop(v)) => LinkKind::Double,
            (0, 0, 2, 0, 0) if branch(3).all(|v| !self.has_loop(v)) => LinkKind::Junction,
            // a simple graph with these degrees is the octahedron, or the complete one
            (0, 0, 0, 6, 0) if branch(4).all(|v| self.is_simple_at(v)) => LinkKind::Triple,
            (0, 0, 4, 0, 0) if branch(3).all(|v| self.is_simple_at(v)) => {
                LinkKind::QuadrupleJunction
            }
            _ => LinkKind::Other,
        }
    }

    /// Node at the other end of the arc that leaves `node` by `edge`.
    fn arc_end(&self, node: u32, edge: u32) -> u32 {
        let (mut at, mut by) = (node, edge);
        // an arc visits every edge at most once
        for _ in 0..=self.edges.len() {
            let (p, q) = self.edges[by as usize];
            at = if p == at { q } else { p };
            if self.degree(at) != 2 {
                break;
            }
            let next = self.at(at);
            by = if next[0] == by { next[1] } else { next[0] };
        }
        at
    }

    fn has_loop(&self, node: u32) -> bool {
        self.at(node).iter().any(|&e| self.arc_end(node, e) == node)
    }

    fn is_simple_at(&self, node: u32) -> bool {
        let ends = self.at(node);
        (0..ends.len()).all(|i| {
            let far = self.arc_end(node, ends[i]);
            far != node && (0..i).all(|j| self.arc_end(node, ends[j]) != far)
        })
    }
}

pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    admissible: &[LinkKind],
    special: &[SpecialPoint],
) -> LinkReport {
    let n = mesh.complex.vertices;
    // neighbors along curve edges, sorted by vertex
    let mut along: Vec<(u32, u32)> = mesh
        .complex
        .curve_edges
        .iter()
        .flat_map(|e| [(e.ends[0], e.ends[1]), (e.ends[1], e.ends[0])])
        .collect();
    along.sort_unstable();
    let mut declared: Vec<(u32, LinkKind)> = special.iter().map(|s| (s.vertex, s.link)).collect();
    declared.sort_unstable();
    let mut report = LinkReport::default();
    let (mut bad, mut split, mut pinched, mut undone) = (vec![], vec![], vec![], vec![]);
    let mut bad_kinds: BTreeMap<LinkKind, usize> = BTreeMap::new();
    let mut link = Link::default();
    let (mut neighbors, mut next, mut next_declared) = (Vec::new(), 0, 0);
    for v in 0..n as u32 {
        neighbors.clear();
        while next < along.len() && along[next].0 == v {
            neighbors.push(along[next].1);
            next += 1;
        }
        let triangles = incidence.at_vertex(v as usize);
        let mut wanted = None;
        while next_declared < declared.len() && declared[next_declared].0 == v {
            wanted = Some(declared[next_declared].1);
            next_declared += 1;
        }
        if triangles.is_empty() && neighbors.is_empty() {
            if wanted.is_some() {
                undone.push(Place::Vertex(v));
            }
            continue;
        }
        link.read(mesh, triangles, v, &neighbors);
        let kind = link.kind();
        *report.census.entry(kind).or_default() += 1;
        let place = Place::Vertex(v);
        if let Some(wanted) = wanted {
            if wanted != kind {
                undone.push(place);
            }
        } else if !admissible.contains(&kind) {
            match kind {
                LinkKind::Pinch => pinched.push(place),
                LinkKind::Split | LinkKind::IsolatedCrossing => split.push(place),
                _ => {
                    *bad_kinds.entry(kind).or_default() += 1;
                    bad.push(place);
                }
            }
        }
    }
    undone.extend(declared[next_declared..].iter().map(|d| Place::Vertex(d.0)));
    let at = |p: Place| super::coordinates(mesh, p);
    let kinds = bad_kinds
        .iter()
        .map(|(k, c)| format!("{k:?} {c}"))
        .collect::<Vec<_>>()
        .join(", ");
    report
        .violations
        .extend(Violation::at(ViolationKind::InadmissibleLink, bad, at).map(|v| v.detailed(kinds)));
    report
        .violations
        .extend(Violation::at(ViolationKind::SplitLink, split, at));
    report
        .violations
        .extend(Violation::at(ViolationKind::Pinch, pinched, at));
    report
        .violations
        .extend(Violation::at(ViolationKind::SpecialPoint, undone, at));
    report
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::{Complex, CurveEdge, PointCloud};

    /// The kind of link that a list of link edges makes: vertex 0 is the cone point.
    fn cone(edges: &[[u32; 2]], bare: &[u32]) -> LinkKind {
        let top = edges
            .iter()
            .flatten()
            .chain(bare)
            .max()
            .copied()
            .unwrap_or(0) as usize;
        let triangles = edges.iter().map(|&[a, b]| [0, a, b]).collect();
        let curves = bare.iter().map(|&b| CurveEdge::new(0, b, 0)).collect();
        let complex = Complex::new(top + 1, triangles, curves).unwrap();
        let incidence = Incidence::new(&complex);
        let cloud = PointCloud::new(1, vec![0.0; top + 1]).unwrap();
        let mesh = Mesh::new(complex, cloud, vec![-1; top + 1]).unwrap();
        let mut link = Link::default();
        link.read(&mesh, incidence.at_vertex(0), 0, bare);
        link.kind()
    }

    /// Edges of a graph with every edge cut into three.
    fn subdivided(edges: &[[u32; 2]]) -> Vec<[u32; 2]> {
        let mut next = edges.iter().flatten().max().unwrap() + 1;
        let mut all = vec![];
        for &[a, b] in edges {
            all.extend([[a, next], [next, next + 1], [next + 1, b]]);
            next += 2;
        }
        all
    }

    #[test]
    fn every_kind_is_told() {
        use LinkKind::*;
        let octahedron: Vec<[u32; 2]> = (1..=6)
            .flat_map(|a| (a + 1..=6).map(move |b| [a, b]))
            .filter(|e| e[0] + e[1] != 7)
            .collect();
        let complete: Vec<[u32; 2]> = (1..=4)
            .flat_map(|a| (a + 1..=4).map(move |b| [a, b]))
            .collect();
        let cases: Vec<(Vec<[u32; 2]>, LinkKind)> = vec![
            (subdivided(&[[1, 1]]), Circle),
            (vec![[1, 2], [2, 3]], Arc),
            (subdivided(&[[1, 2], [1, 2], [1, 2], [1, 2]]), Double),
            (subdivided(&[[1, 2], [1, 2], [1, 1], [2, 2]]), Other),
            (subdivided(&[[1, 1], [1, 1]]), Pinch),
            (vec![[1, 2], [1, 3], [1, 4], [1, 5]], DoubleEnd),
            (octahedron.clone(), Triple),
            (subdivided(&octahedron), Triple),
            (subdivided(&[[1, 2], [1, 2], [1, 2]]), Junction),
            (subdivided(&[[1, 2], [1, 1], [2, 2]]), Other),
            (vec![[1, 2], [1, 3], [1, 4]], JunctionEnd),
            (subdivided(&[[1, 1], [1, 2]]), SideSheetEnd),
            (complete.clone(), QuadrupleJunction),
            (subdivided(&complete), QuadrupleJunction),
            (
                subdivided(&[[1, 2], [1, 2], [3, 4], [3, 4], [1, 3], [2, 4]]),
                Other,
            ),
            (subdivided(&[[1, 1], [2, 2]]), IsolatedCrossing),
            (subdivided(&[[1, 1], [2, 2], [3, 3]]), Split),
            (vec![[1, 2], [3, 4]], Split),
            (subdivided(&[[1, 1], [1, 1], [1, 1]]), Other),
        ];
        for (edges, kind) in cases {
            assert_eq!(cone(&edges, &[]), kind, "{edges:?}");
        }
        let circle = subdivided(&[[1, 1]]);
        assert_eq!(cone(&circle, &[8, 9]), CurveThroughSheet);
        assert_eq!(cone(&circle, &[8]), CurveOnSheet);
        assert_eq!(cone(&[], &[1, 2]), Curve);
        assert_eq!(cone(&[], &[1]), CurveEnd);
        assert_eq!(cone(&[], &[1, 2, 3]), Split);
        assert_eq!(cone(&[[1, 2]], &[3]), Split);
    }
}
