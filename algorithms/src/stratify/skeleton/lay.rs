//! Landmarks and chain edges along the parts of a kind of curve.

use super::Skeleton;
use super::ends::free_ends;
use super::graph::CurveGraph;
use super::ground::Ground;
use super::nodes::Nodes;
use super::sweep::{adjacent, sweep, without_triangles};
use crate::stratify::site::StratumKind;
use crosscap_core::{CurveEdge, Landmark, Row, Scalar};

/// Landmarks and edges of a chain, by nodes of its graph.
struct Chain {
    longest: f64,
    chosen: Vec<usize>,
    edges: Vec<(usize, usize)>,
}

/// One connected curve.
struct Part<'p> {
    graph: &'p CurveGraph,
    /// Its nodes, in order.
    members: &'p [usize],
    /// The corners that it ends at.
    anchors: Vec<usize>,
    /// Where it stops at nothing and must have a landmark.
    ends: Vec<usize>,
    /// Its nodes from one end to the other.
    order: Vec<usize>,
}

impl Part<'_> {
    fn holds(&self, node: usize) -> bool {
        self.members.binary_search(&node).is_ok()
    }
}

impl Skeleton {
    /// Lays all curves of a kind.
    pub(super) fn lay_kind<S: Scalar>(&mut self, ground: &Ground<'_, '_, S>, kind: StratumKind) {
        let nodes = Nodes::of(self, ground, kind);
        let graph = CurveGraph::new(self, ground, nodes);
        self.unreached.extend(&graph.unreached);
        for members in &graph.parts {
            let part = Part::of(ground, &graph, members);
            let before = self.rows.len();
            let steps = 0..ground.tuning.stretches;
            let mut best: Option<Chain> = None;
            for stretch in steps.map(|k| 1.0 + ground.tuning.stretch_step * k as f64) {
                let chain = self.chain(ground, &part, before, ground.dl * stretch);
                let shorter = |b: &Chain| chain.longest < b.longest * (1.0 - 1e-12);
                if best.as_ref().is_none_or(shorter) {
                    best = Some(chain);
                }
            }
            if let Some(chain) = best {
                self.enter(ground, &part, chain);
            }
        }
    }

    /// The chain along a part whose landmarks keep a separation; the first `before` landmarks are there.
    fn chain<S: Scalar>(
        &self,
        ground: &Ground<'_, '_, S>,
        part: &Part<'_>,
        before: usize,
        separation: f64,
    ) -> Chain {
        let rows = &part.graph.nodes.rows;
        let distance = |a: Row, b: Row| ground.distance(a, b);
        let mut chosen: Vec<usize> = Vec::new();
        for &k in &part.order {
            let row = rows[k];
            let free = (chosen.iter().rev()).all(|&c| distance(rows[c], row) >= separation)
                && (self.rows.iter().take(before)).all(|&r| distance(r, row) >= ground.dl);
            if free {
                chosen.push(k);
            }
        }
        let least = ground.tuning.end_separation * separation;
        for &end in &part.ends {
            let clear = |c: usize| part.ends.contains(&c) || distance(rows[c], rows[end]) >= least;
            chosen.retain(|&c| clear(c));
            if !chosen.contains(&end) {
                chosen.push(end);
            }
        }
        let sources: Vec<usize> = part.anchors.iter().chain(&chosen).copied().collect();
        let edges = adjacent(&part.graph.links, &sources, |k| {
            part.holds(k) || part.anchors.contains(&k)
        });
        let first_corner = part.graph.first_corner();
        let row_of = |k: usize| match k.checked_sub(first_corner) {
            Some(corner) => self.rows[Landmark::new(corner)],
            None => rows[k],
        };
        let length = |a: usize, b: usize| distance(row_of(a), row_of(b));
        let edges = without_triangles(edges, length);
        let lengths = edges.iter().map(|&(a, b)| length(a, b));
        Chain {
            longest: lengths.fold(0.0, f64::max),
            chosen,
            edges,
        }
    }

    /// Takes a chain over.
    fn enter<S: Scalar>(&mut self, ground: &Ground<'_, '_, S>, part: &Part<'_>, chain: Chain) {
        let before = self.rows.len();
        let cells = part.cells(ground);
        let rows = &part.graph.nodes.rows;
        self.rows.extend(chain.chosen.iter().map(|&k| rows[k]));
        self.cells.extend(chain.chosen.iter().map(|_| cells));
        let first_corner = part.graph.first_corner();
        let position = |k: usize| match k.checked_sub(first_corner) {
            Some(corner) => Landmark::new(corner),
            // Sources are corners or chosen, so it is there.
            None => {
                let at = chain.chosen.iter().position(|&c| c == k);
                Landmark::new(before + at.unwrap_or(0))
            }
        };
        for (a, b) in chain.edges {
            let [a, b] = [a, b].map(|k| position(k).into());
            self.edges.push(CurveEdge::new(a, b, cells));
        }
    }
}

impl<'p> Part<'p> {
    fn of<S: Scalar>(
        ground: &Ground<'_, '_, S>,
        graph: &'p CurveGraph,
        members: &'p [usize],
    ) -> Self {
        let (links, first_corner) = (&graph.links, graph.first_corner());
        let holds = |k: usize| members.binary_search(&k).is_ok();
        let ends_here = |c: &usize| links[*c].iter().any(|x| holds(x.0));
        let anchors: Vec<usize> = (first_corner..links.len()).filter(ends_here).collect();
        // A sweep from an end of the curve, or from anywhere on a closed one.
        let start = anchors.first().copied().unwrap_or_else(|| {
            let (order, _) = sweep(links, &[members[0]], holds);
            order.last().map_or(members[0], |&(k, _)| k)
        });
        let (order, _) = sweep(links, &[start], holds);
        let nodes = order.into_iter().map(|x| x.0);
        let rows = &graph.nodes.rows;
        let ends_anywhere =
            |&k: &usize| graph.nodes.is_bare(ground, k) || graph.nodes.is_fold(ground, k);
        let ends = if members.iter().all(ends_anywhere) {
            let distance = |a: usize, b: usize| ground.distance(rows[a], rows[b]);
            free_ends(links, members, first_corner, distance)
        } else {
            Vec::new()
        };
        Self {
            graph,
            members,
            anchors,
            ends,
            order: nodes.filter(|&k| k < first_corner).collect(),
        }
    }

    /// How many cells meet in the curve, as most of its points say.
    fn cells<S: Scalar>(&self, ground: &Ground<'_, '_, S>) -> u8 {
        let nodes = &self.graph.nodes;
        if nodes.kind == StratumKind::Boundary {
            return 1;
        }
        let mut votes = [0usize; 256];
        for &k in self.members {
            votes[ground.strata.cells(nodes.rows[k]) as usize] += 1;
        }
        (0..=255).max_by_key(|&c| votes[c as usize]).unwrap_or(0)
    }
}
