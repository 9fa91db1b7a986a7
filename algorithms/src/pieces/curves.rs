//! How the pieces meet: double curves, junctions, points.

use super::gluing::{FREE, Gluing};
use super::normalization::Normalization;
use super::straightness::{self, Rims, unit};
use super::{
    BareCurve, CrossingAngle, CurveEnd, CurveMeeting, DoubleCurve, Junction, MultiplePoint,
    PointContact, Preimage, Sidedness,
};
use crate::homology::signed_union::{Joined, SignedUnion};
use crate::orthogonal::dot;
use crosscap_core::{Mesh, squared_distance};

/// A link from one end of an edge to an end of another: the number of the edge in its list and
/// which end.
type Links = Vec<[Option<(u32, usize)>; 2]>;

/// Edges in the order in which a curve runs through them, each with the end it is entered by.
struct Trail {
    steps: Vec<(u32, usize)>,
    circle: bool,
}

/// Follows the links: open curves first, each from the end that comes first in the list.
fn trails(links: &Links) -> Vec<Trail> {
    let mut done = vec![false; links.len()];
    let mut found = Vec::new();
    let open = (0..links.len()).flat_map(|d| [(d, 0), (d, 1)]);
    let open = open.filter(|&(d, end)| links[d][end].is_none());
    let any = (0..links.len()).map(|d| (d, 0));
    for (first, end) in open.chain(any) {
        if done[first] {
            continue;
        }
        let mut steps = Vec::new();
        let mut at = Some((first as u32, end));
        while let Some((d, entered)) = at {
            if std::mem::replace(&mut done[d as usize], true) {
                break;
            }
            steps.push((d, entered));
            at = links[d as usize][1 - entered];
        }
        found.push(Trail {
            steps,
            circle: at.is_some(),
        });
    }
    found
}

/// The vertices along a trail, the first one not repeated for a circle, and its length.
fn vertices_and_length(gluing: &Gluing<'_>, edges: &[u32], trail: &Trail) -> (Vec<u32>, f64) {
    let ends = |d: u32| gluing.sides.edges[edges[d as usize] as usize];
    let mut vertices: Vec<u32> = trail.steps.iter().map(|&(d, end)| ends(d)[end]).collect();
    if let Some(&(d, end)) = trail.steps.last().filter(|_| !trail.circle) {
        vertices.push(ends(d)[1 - end]);
    }
    let length = trail
        .steps
        .iter()
        .map(|&(d, _)| edge_length(gluing.mesh, ends(d)));
    (vertices, length.sum())
}

fn edge_length(mesh: &Mesh, [a, b]: [u32; 2]) -> f64 {
    let point = |v: u32| mesh.vertices.point(v as usize);
    squared_distance(point(a), point(b)).sqrt()
}

/// Angles along a curve, weighted by length.
struct AngleSum {
    sum: f64,
    total: f64,
    least: f64,
    most: f64,
}

impl Default for AngleSum {
    fn default() -> Self {
        Self {
            sum: 0.0,
            total: 0.0,
            least: f64::INFINITY,
            most: f64::NEG_INFINITY,
        }
    }
}

impl AngleSum {
    fn add(&mut self, length: f64, cosine: f64) {
        let degrees = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        self.sum += length * degrees;
        self.total += length;
        self.least = self.least.min(degrees);
        self.most = self.most.max(degrees);
    }

    fn result(&self) -> Option<CrossingAngle> {
        (self.total > 0.0).then(|| CrossingAngle {
            // Rounding must not carry it past equal angles.
            mean: (self.sum / self.total).clamp(self.least, self.most),
            min: self.least,
            max: self.most,
        })
    }
}

/// One of the two edges of the normalization over a double edge: two glued sides, the smaller
/// one first.
type Lift = [u32; 2];

/// Double curves with their preimages.
struct Crossings<'a> {
    gluing: &'a Gluing<'a>,
    normal: &'a Normalization,
    /// Double edges.
    edges: Vec<u32>,
    lifts: Vec<[Lift; 2]>,
    links: Links,
    ends: Vec<[CurveEnd; 2]>,
    /// Lifts `2 d` and `2 d + 1`, joined where they continue each other; the sign says whether
    /// the first sides of both lie on the same side of the preimage.
    preimages: SignedUnion,
    /// How many ends of lifts are joined, for each lift.
    joined: Vec<u8>,
    one_sided: Vec<u32>,
    /// Vertices of the mesh with a sheet through which a double curve passes.
    passes: Vec<(u32, u32)>,
}

impl<'a> Crossings<'a> {
    fn new(gluing: &'a Gluing<'a>, normal: &'a Normalization) -> Self {
        let edges = gluing.double_edges();
        let lifts: Vec<[Lift; 2]> = edges
            .iter()
            .map(|&e| {
                let at = gluing.sides.at(e as usize);
                let first = [at[0], gluing.partner[at[0] as usize]];
                let other = at[1..].iter().find(|&&s| s != first[1]).copied();
                let other = other.unwrap_or(at[0]);
                [first, [other, gluing.partner[other as usize]]]
            })
            .collect();
        let count = edges.len();
        let mut crossings = Self {
            gluing,
            normal,
            edges,
            lifts,
            links: vec![[None; 2]; count],
            ends: vec![[CurveEnd::Singular; 2]; count],
            preimages: SignedUnion::new(2 * count),
            joined: vec![0; 2 * count],
            one_sided: Vec::new(),
            passes: Vec::new(),
        };
        crossings.link();
        crossings
    }

    /// The sheets of both lifts of double edge `d` at its end.
    fn sheets(&self, d: usize, end: usize) -> [u32; 2] {
        self.lifts[d].map(|lift| self.normal.ends(self.gluing, lift[0])[end])
    }

    /// Two double edges continue each other at a vertex when they, and no third one, lie in the
    /// same two local sheets. This goes straight through triple points.
    fn link(&mut self) {
        let mut ends: Vec<([u32; 2], usize, usize)> = Vec::new();
        for d in 0..self.edges.len() {
            for end in 0..2 {
                let [a, b] = self.sheets(d, end);
                ends.push(([a.min(b), a.max(b)], d, end));
            }
        }
        ends.sort_unstable();
        for same in ends.chunk_by(|x, y| x.0 == y.0) {
            let [a, b] = same[0].0;
            let vertex = self.normal.original_vertex[a as usize];
            match *same {
                [(_, d, end), (_, other, other_end)] if a != b => {
                    self.links[d][end] = Some((other as u32, other_end));
                    self.links[other][other_end] = Some((d as u32, end));
                    self.passes.extend([(vertex, a), (vertex, b)]);
                    for sheet in [a, b] {
                        let lift_of = |d: usize, end| usize::from(self.sheets(d, end)[0] != sheet);
                        let (one, two) = (lift_of(d, end), lift_of(other, other_end));
                        self.join((d, one), (other, two), vertex);
                    }
                }
                [(_, d, end)] if a == b => {
                    self.ends[d][end] = CurveEnd::Pinch;
                    self.join((d, 0), (d, 1), vertex);
                }
                [(_, d, end)] if self.normal.rim[a as usize] || self.normal.rim[b as usize] => {
                    self.ends[d][end] = CurveEnd::Boundary;
                }
                _ => {}
            }
        }
    }

    fn join(&mut self, one: (usize, usize), two: (usize, usize), vertex: u32) {
        let (lift, next) = (self.lifts[one.0][one.1], self.lifts[two.0][two.1]);
        let Some(crossed) = self.side_change(lift, next, vertex) else {
            return;
        };
        let (one, two) = (2 * one.0 + one.1, 2 * two.0 + two.1);
        self.joined[one] += 1;
        self.joined[two] += 1;
        let (one, two) = (one as u32, two as u32);
        if self.preimages.join(one, two, crossed) == Joined::Contradiction {
            self.one_sided.push(one);
        }
    }

    /// Walks around a sheet's vertex from a side of one lift to the next lift: whether that
    /// leads from a first side to a second side.
    fn side_change(&self, lift: Lift, next: Lift, vertex: u32) -> Option<bool> {
        // On a boundary one way round may be barred, not both.
        (0..2).find_map(|k| {
            let mut side = lift[k];
            loop {
                side = self.gluing.turn(side, vertex);
                if let Some(reached) = next.iter().position(|&s| s == side) {
                    return Some(reached != k);
                }
                if lift.contains(&side) {
                    return None;
                }
                side = self.gluing.partner[side as usize];
                if side == FREE {
                    return None;
                }
            }
        })
    }

    fn curves(&mut self, multiple: &[MultiplePoint]) -> Vec<DoubleCurve> {
        let lift_count = 2 * self.edges.len();
        let mut sizes = vec![0usize; lift_count];
        let mut joined = vec![0usize; lift_count];
        let mut one_sided = vec![false; lift_count];
        for l in 0..lift_count {
            let root = self.preimages.find(l as u32).0 as usize;
            sizes[root] += 1;
            joined[root] += self.joined[l] as usize;
        }
        for k in 0..self.one_sided.len() {
            one_sided[self.preimages.find(self.one_sided[k]).0 as usize] = true;
        }
        let trails = trails(&self.links);
        let mut curves = Vec::with_capacity(trails.len());
        for trail in trails {
            let (vertices, length) = vertices_and_length(self.gluing, &self.edges, &trail);
            let mut roots: Vec<usize> = trail
                .steps
                .iter()
                .flat_map(|&(d, _)| [2 * d, 2 * d + 1])
                .map(|l| self.preimages.find(l).0 as usize)
                .collect();
            roots.sort_unstable();
            roots.dedup();
            let mut preimages: Vec<Preimage> = roots
                .iter()
                .map(|&root| {
                    let circle = joined[root] == 2 * sizes[root];
                    let side = self.lifts[root / 2][root % 2][0];
                    Preimage {
                        piece: self.normal.triangle_piece[side as usize / 3],
                        circle,
                        covers: (sizes[root] / trail.steps.len()) as u32,
                        sidedness: circle.then_some(if one_sided[root] {
                            Sidedness::OneSided
                        } else {
                            Sidedness::TwoSided
                        }),
                    }
                })
                .collect();
            preimages.sort_unstable();
            let first = trail.steps[0];
            let last = trail.steps[trail.steps.len() - 1];
            let is_multiple = |v: &u32| {
                multiple
                    .binary_search_by_key(v, |point| point.vertex)
                    .is_ok()
            };
            curves.push(DoubleCurve {
                circle: trail.circle,
                length,
                multiple_points: vertices.iter().copied().filter(is_multiple).collect(),
                vertices,
                preimages,
                ends: (!trail.circle).then(|| {
                    [
                        self.ends[first.0 as usize][first.1],
                        self.ends[last.0 as usize][1 - last.1],
                    ]
                }),
                angle: self.angle(&trail),
            });
        }
        curves
    }

    /// Angle between the two sheets, each taken as the line through its two half planes.
    fn angle(&self, trail: &Trail) -> Option<CrossingAngle> {
        let mut angles = AngleSum::default();
        for &(d, _) in &trail.steps {
            let [[a, b], [p, q]] = self.lifts[d as usize];
            let ends = self.gluing.sides.edges[self.edges[d as usize] as usize];
            let Some(Rims { length, directions }) =
                straightness::directions(self.gluing.mesh, ends, [a, b, p, q])
            else {
                continue;
            };
            let line = |i: usize, j: usize| {
                let across = directions[i].iter().zip(&directions[j]);
                unit(across.map(|(x, y)| x - y).collect())
            };
            let (Some((u, _)), Some((w, _))) = (line(0, 1), line(2, 3)) else {
                continue;
            };
            angles.add(length, dot(&u, &w).abs());
        }
        angles.result()
    }

    /// Vertices where three or more sheets cross along double curves.
    fn multiple_points(&mut self) -> Vec<MultiplePoint> {
        self.passes.sort_unstable();
        self.passes.dedup();
        let at_vertex = self.passes.chunk_by(|x, y| x.0 == y.0);
        at_vertex
            .filter(|sheets| sheets.len() >= 3)
            .map(|sheets| MultiplePoint {
                vertex: sheets[0].0,
                sheets: sheets.len() as u32,
            })
            .collect()
    }
}

pub(super) fn double_curves(
    gluing: &Gluing<'_>,
    normal: &Normalization,
) -> (Vec<DoubleCurve>, Vec<MultiplePoint>) {
    let mut crossings = Crossings::new(gluing, normal);
    let points = crossings.multiple_points();
    (crossings.curves(&points), points)
}

/// Curves in which three, or five and more, triangles meet.
pub(super) fn junctions(gluing: &Gluing<'_>, normal: &Normalization) -> Vec<Junction> {
    let count = |e: u32| gluing.sides.at(e as usize).len();
    let edges: Vec<u32> = (0..gluing.sides.edges.len() as u32)
        .filter(|&e| count(e) == 3 || count(e) > 4)
        .collect();
    let mut ends = Vec::new();
    for (d, &e) in edges.iter().enumerate() {
        for (end, v) in gluing.sides.edges[e as usize].into_iter().enumerate() {
            ends.push((v, count(e), d, end));
        }
    }
    ends.sort_unstable();
    let mut links: Links = vec![[None; 2]; edges.len()];
    for same in ends.chunk_by(|x, y| x.0 == y.0) {
        if let &[(_, n, d, end), (_, m, other, other_end)] = same
            && n == m
        {
            links[d][end] = Some((other as u32, other_end));
            links[other][other_end] = Some((d as u32, end));
        }
    }
    let trails = trails(&links);
    let describe = |trail: &Trail| {
        let (vertices, length) = vertices_and_length(gluing, &edges, trail);
        let at = trail.steps.iter();
        let at = at.flat_map(|&(d, _)| gluing.sides.at(edges[d as usize] as usize));
        let mut pieces: Vec<u32> = at.map(|&s| normal.triangle_piece[s as usize / 3]).collect();
        pieces.sort_unstable();
        pieces.dedup();
        Junction {
            circle: trail.circle,
            cells: count(edges[trail.steps[0].0 as usize]) as u32,
            length,
            vertices,
            pieces,
            angle: junction_angle(gluing, &edges, trail),
        }
    };
    trails.iter().map(describe).collect()
}

/// Angles between each two of three cells.
fn junction_angle(gluing: &Gluing<'_>, edges: &[u32], trail: &Trail) -> Option<CrossingAngle> {
    let mut angles = AngleSum::default();
    for &(d, _) in &trail.steps {
        let e = edges[d as usize] as usize;
        let at = gluing.sides.at(e);
        if at.len() != 3 {
            return None;
        }
        let ends = gluing.sides.edges[e];
        let Some((length, directions)) = straightness::leaving(gluing.mesh, ends, at) else {
            continue;
        };
        for [i, j] in [[0, 1], [1, 2], [0, 2]] {
            angles.add(length, dot(&directions[i], &directions[j]));
        }
    }
    angles.result()
}

/// Curves of edges without a triangle.
pub(super) fn bare_curves(gluing: &Gluing<'_>, normal: &Normalization) -> Vec<BareCurve> {
    // At a bare vertex of the normalization nothing but bare edges meets.
    let mut ends: Vec<(u32, usize, usize)> = Vec::new();
    for (d, bare) in normal.bare.iter().enumerate() {
        ends.extend([(bare[0], d, 0), (bare[1], d, 1)]);
    }
    ends.sort_unstable();
    let mut links: Links = vec![[None; 2]; normal.bare.len()];
    for same in ends.chunk_by(|x, y| x.0 == y.0) {
        if let &[(_, d, end), (_, other, other_end)] = same {
            links[d][end] = Some((other as u32, other_end));
            links[other][other_end] = Some((d as u32, end));
        }
    }
    let mut sheets: Vec<(u32, u32)> = normal
        .sheet
        .iter()
        .enumerate()
        .map(|(c, &sheet)| {
            let vertex = normal.original_vertex[sheet as usize];
            (vertex, normal.triangle_piece[c / 3])
        })
        .collect();
    sheets.sort_unstable();
    sheets.dedup();
    let pieces_at = |v: u32| -> Vec<u32> {
        let from = sheets.partition_point(|s| s.0 < v);
        let at = sheets[from..].iter().take_while(|s| s.0 == v);
        at.map(|s| s.1).collect()
    };
    let original = |v: u32| normal.original_vertex[v as usize];
    let describe = |trail: &Trail| {
        let edges = trail
            .steps
            .iter()
            .map(|&(d, end)| (normal.bare[d as usize], end));
        let mut vertices: Vec<u32> = edges
            .clone()
            .map(|(ends, end)| original(ends[end]))
            .collect();
        if let Some((ends, end)) = edges.clone().next_back().filter(|_| !trail.circle) {
            vertices.push(original(ends[1 - end]));
        }
        let last = vertices.len() - 1;
        let meetings = vertices.iter().enumerate().filter_map(|(k, &vertex)| {
            let pieces = pieces_at(vertex);
            (!pieces.is_empty()).then_some(CurveMeeting {
                vertex,
                pieces,
                end: !trail.circle && (k == 0 || k == last),
            })
        });
        BareCurve {
            circle: trail.circle,
            length: edges
                .map(|(ends, _)| edge_length(gluing.mesh, ends.map(original)))
                .sum(),
            meetings: meetings.collect(),
            vertices,
        }
    };
    trails(&links).iter().map(describe).collect()
}

/// Vertices where several sheets touch and no curve runs in which they meet.
pub(super) fn point_contacts(gluing: &Gluing<'_>, normal: &Normalization) -> Vec<PointContact> {
    let mut on_curve = vec![false; gluing.mesh.complex.vertices];
    for (e, ends) in gluing.sides.edges.iter().enumerate() {
        if gluing.sides.at(e).len() > 2 {
            ends.iter().for_each(|&v| on_curve[v as usize] = true);
        }
    }
    let mut piece = vec![u32::MAX; normal.original_vertex.len()];
    for (c, &sheet) in normal.sheet.iter().enumerate() {
        piece[sheet as usize] = normal.triangle_piece[c / 3];
    }
    // Sheets of one vertex have consecutive numbers.
    let sheets: Vec<(u32, u32)> = normal
        .original_vertex
        .iter()
        .zip(&piece)
        .filter(|&(_, &p)| p != u32::MAX)
        .map(|(&v, &p)| (v, p))
        .collect();
    sheets
        .chunk_by(|x, y| x.0 == y.0)
        .filter(|at| at.len() > 1 && !on_curve[at[0].0 as usize])
        .map(|at| {
            let mut pieces: Vec<u32> = at.iter().map(|&(_, p)| p).collect();
            pieces.sort_unstable();
            PointContact {
                vertex: at[0].0,
                pieces,
            }
        })
        .collect()
}
