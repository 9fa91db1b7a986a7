//! Third level: every vertex has a neighborhood of an admissible kind.
//!
//! The link of a vertex is the graph of its neighbors, joined by the edges opposite of it in its
//! triangles. Its shape, with nodes of degree two forgotten, says what the surface looks like
//! around the vertex: a circle is an interior point, an arc a boundary point, two nodes of
//! degree four joined by four arcs a point of a double curve, and so on.

use super::incidence::Incidence;
use super::{Place, Violation, ViolationKind};
use crosscap_core::{Link, LinkKind, Mesh};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A vertex that is declared to be a special point, a stratum of dimension 0.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpecialPoint {
    /// The vertex.
    pub vertex: u32,
    /// What its link must be; declares links of kinds outside [`LinkKind::GENERIC`] as well.
    pub link: Link,
}

/// Vertices by the kind of their link.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LinkReport {
    /// Number of vertices of each kind of link; vertices without any edge are left out.
    pub census: BTreeMap<LinkKind, usize>,
    /// What is wrong.
    pub violations: Vec<Violation>,
}

/// How many different links a violation describes.
const MOST_LISTED: usize = 3;

/// Work space for the graph of one vertex.
#[derive(Default)]
struct Around {
    nodes: Vec<u32>,
    edges: Vec<[u32; 2]>,
    degrees: Vec<u8>,
    component: Vec<u32>,
}

impl Around {
    /// Reads the graph about `vertex`; `along` are the neighbors along curve edges.
    fn read(&mut self, mesh: &Mesh, triangles: &[u32], vertex: u32, along: &[u32]) {
        self.nodes.clear();
        self.edges.clear();
        for &t in triangles {
            let corners = mesh.complex.triangles[t as usize];
            let mut others = corners.iter().copied().filter(|&v| v != vertex);
            if let (Some(a), Some(b)) = (others.next(), others.next()) {
                self.edges.push([a, b]);
                self.nodes.extend([a, b]);
            }
        }
        self.nodes.extend(along);
        self.nodes.sort_unstable();
        self.nodes.dedup();
        let nodes = &self.nodes;
        for e in &mut self.edges {
            let find = |v: u32| nodes.partition_point(|&n| n < v) as u32;
            *e = e.map(find);
        }
        self.degrees.clear();
        self.degrees.resize(self.nodes.len(), 0);
        for &v in self.edges.iter().flatten() {
            let degree = &mut self.degrees[v as usize];
            *degree = degree.saturating_add(1);
        }
    }

    /// The link that the graph is a subdivision of.
    fn link(&self) -> Link {
        Link::of_graph(self.nodes.len(), &self.edges, |_| false)
    }

    /// The kind of the link. Nearly all vertices have a circle or an arc, which are told without
    /// setting up the link.
    fn kind(&mut self) -> LinkKind {
        let leaves = self.degrees.iter().filter(|&&d| d == 1).count();
        let simple = self.degrees.iter().all(|&d| d == 1 || d == 2);
        match leaves {
            0 if simple && self.is_connected() => LinkKind::Circle,
            2 if simple && self.is_connected() => LinkKind::Arc,
            _ => self.link().kind(),
        }
    }

    fn is_connected(&mut self) -> bool {
        let n = self.nodes.len();
        self.component.clear();
        self.component.extend(0..n as u32);
        let mut parts = n;
        for &[a, b] in &self.edges {
            let [p, q] = [a, b].map(|v| root(&mut self.component, v));
            if p != q {
                self.component[p as usize] = q;
                parts -= 1;
            }
        }
        parts == 1
    }
}

/// The name of the part that a node is in, with the way to it shortened.
fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        parent[node as usize] = parent[parent[node as usize] as usize];
        node = parent[node as usize];
    }
    node
}

/// A link that no model explained, as it looks and what it would be.
fn in_words(link: &Link) -> String {
    match link.kind().meaning() {
        Some(meaning) => format!("{link}: {meaning}, and no model claims it"),
        None => format!("{link}: a point of no known kind"),
    }
}

/// The most frequent descriptions, with their numbers.
fn listed(found: &BTreeMap<String, usize>) -> String {
    let mut all: Vec<(&String, &usize)> = found.iter().collect();
    all.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let more = all.len().saturating_sub(MOST_LISTED);
    let mut words: Vec<String> = all
        .into_iter()
        .take(MOST_LISTED)
        .map(|(text, count)| match count {
            1 => text.clone(),
            _ => format!("{count} times {text}"),
        })
        .collect();
    if more > 0 {
        words.push(format!("and {more} more kinds"));
    }
    words.join("; ")
}

/// What the links of all vertices show.
#[derive(Default)]
struct Findings {
    census: BTreeMap<LinkKind, usize>,
    bad: Vec<Place>,
    split: Vec<Place>,
    pinched: Vec<Place>,
    /// Declared points whose link is another one.
    undone: Vec<Place>,
    /// Links that no model explained, in words.
    unexplained: BTreeMap<String, usize>,
    /// Links in place of those that were declared.
    otherwise: BTreeMap<String, usize>,
}

impl Findings {
    /// Looks at the link about a vertex, which was declared to be `wanted`, or else is of one of the kinds that are
    /// `admissible`.
    fn look(
        &mut self,
        v: u32,
        around: &mut Around,
        wanted: Option<&Link>,
        admissible: &[LinkKind],
    ) {
        let (kind, place) = (around.kind(), Place::Vertex(v));
        *self.census.entry(kind).or_default() += 1;
        if let Some(wanted) = wanted {
            let link = around.link();
            if wanted.without_creases() != link {
                let told = format!("{link} instead of {wanted}");
                *self.otherwise.entry(told).or_default() += 1;
                self.undone.push(place);
            }
        } else if !admissible.contains(&kind) {
            let told = in_words(&around.link());
            *self.unexplained.entry(told).or_default() += 1;
            match kind {
                LinkKind::Pinch => self.pinched.push(place),
                LinkKind::Split | LinkKind::IsolatedCrossing => self.split.push(place),
                _ => self.bad.push(place),
            }
        }
    }

    fn report(self, mesh: &Mesh) -> LinkReport {
        let at = |p: Place| super::coordinates(mesh, p);
        let found = listed(&self.unexplained);
        let kinds = [
            (ViolationKind::InadmissibleLink, self.bad, found.clone()),
            (ViolationKind::SplitLink, self.split, found.clone()),
            (ViolationKind::Pinch, self.pinched, found),
            (
                ViolationKind::SpecialPoint,
                self.undone,
                listed(&self.otherwise),
            ),
        ];
        let violations = kinds.into_iter().filter_map(|(kind, places, detail)| {
            Violation::at(kind, places, at).map(|v| v.detailed(detail))
        });
        LinkReport {
            violations: violations.collect(),
            census: self.census,
        }
    }
}

/// Reads the link of every vertex.
pub(super) fn check(
    mesh: &Mesh,
    incidence: &Incidence,
    admissible: &[LinkKind],
    special: &[SpecialPoint],
) -> LinkReport {
    // Neighbors along curve edges, sorted by vertex.
    let edges = mesh.complex.curve_edges.iter();
    let mut along: Vec<(u32, u32)> = edges
        .flat_map(|e| [(e.ends[0], e.ends[1]), (e.ends[1], e.ends[0])])
        .collect();
    along.sort_unstable();
    let mut declared: Vec<(u32, &Link)> = special.iter().map(|s| (s.vertex, &s.link)).collect();
    declared.sort_unstable();
    let mut findings = Findings::default();
    let mut around = Around::default();
    let (mut neighbors, mut next, mut next_declared) = (Vec::new(), 0, 0);
    for v in 0..mesh.complex.vertices as u32 {
        neighbors.clear();
        while next < along.len() && along[next].0 == v {
            neighbors.push(along[next].1);
            next += 1;
        }
        let mut wanted = None;
        while next_declared < declared.len() && declared[next_declared].0 == v {
            wanted = Some(declared[next_declared].1);
            next_declared += 1;
        }
        let triangles = incidence.at_vertex(v as usize);
        if !triangles.is_empty() || !neighbors.is_empty() {
            around.read(mesh, triangles, v, &neighbors);
            findings.look(v, &mut around, wanted, admissible);
        } else if wanted.is_some() {
            findings.undone.push(Place::Vertex(v));
        }
    }
    let beyond = declared[next_declared..].iter();
    findings.undone.extend(beyond.map(|d| Place::Vertex(d.0)));
    findings.report(mesh)
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
        let mut around = Around::default();
        around.read(&mesh, incidence.at_vertex(0), 0, bare);
        around.kind()
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
