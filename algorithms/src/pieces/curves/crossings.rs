//! Double curves, with the curves on the pieces that lie over them.

use super::angle::AngleSum;
use super::trail::{Links, Trail, trails, vertices_and_length};
use crate::homology::signed_union::{Joined, SignedUnion};
use crate::orthogonal::dot;
use crate::pieces::gluing::{FREE, Gluing};
use crate::pieces::normalization::Normalization;
use crate::pieces::straightness::{self, Rims, unit};
use crate::pieces::{CrossingAngle, CurveEnd, DoubleCurve, MultiplePoint, Preimage, Sidedness};

/// One of the two edges of the normalization over a double edge: two glued sides, the smaller
/// one first.
type Lift = [u32; 2];

/// A preimage of a double curve: a curve on a piece.
#[derive(Clone, Copy, Default)]
struct Over {
    /// Of how many lifts it consists.
    lifts: usize,
    /// How many of their ends are joined.
    joined: usize,
    one_sided: bool,
}

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
        let over = self.over();
        let trails = trails(&self.links);
        let mut curves = Vec::with_capacity(trails.len());
        for trail in trails {
            let (vertices, length) = vertices_and_length(self.gluing, &self.edges, &trail);
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
                preimages: self.preimages_of(&trail, &over),
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

    /// What is known of the preimages, each under the lift that stands for it.
    fn over(&mut self) -> Vec<Over> {
        let mut over = vec![Over::default(); 2 * self.edges.len()];
        for l in 0..over.len() {
            let root = self.preimages.find(l as u32).0 as usize;
            over[root].lifts += 1;
            over[root].joined += self.joined[l] as usize;
        }
        for &l in &self.one_sided {
            over[self.preimages.find(l).0 as usize].one_sided = true;
        }
        over
    }

    /// The curves on the pieces that lie over a double curve.
    fn preimages_of(&mut self, trail: &Trail, over: &[Over]) -> Vec<Preimage> {
        let lifts = trail.steps.iter().flat_map(|&(d, _)| [2 * d, 2 * d + 1]);
        let mut roots: Vec<usize> = lifts.map(|l| self.preimages.find(l).0 as usize).collect();
        roots.sort_unstable();
        roots.dedup();
        let preimage = |&root: &usize| {
            let Over {
                lifts,
                joined,
                one_sided,
            } = over[root];
            let circle = joined == 2 * lifts;
            let side = self.lifts[root / 2][root % 2][0];
            Preimage {
                piece: self.normal.triangle_piece[side as usize / 3],
                circle,
                covers: (lifts / trail.steps.len()) as u32,
                sidedness: circle.then_some(if one_sided {
                    Sidedness::OneSided
                } else {
                    Sidedness::TwoSided
                }),
            }
        };
        let mut preimages: Vec<Preimage> = roots.iter().map(preimage).collect();
        preimages.sort_unstable();
        preimages
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

/// Curves in which two sheets cross, and the vertices where three or more of them do.
pub(in crate::pieces) fn double_curves(
    gluing: &Gluing<'_>,
    normal: &Normalization,
) -> (Vec<DoubleCurve>, Vec<MultiplePoint>) {
    let mut crossings = Crossings::new(gluing, normal);
    let points = crossings.multiple_points();
    (crossings.curves(&points), points)
}
