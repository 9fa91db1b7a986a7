//! Which triangles continue each other across which edge.

use super::PiecesError;
use super::straightness::{self, PAIRINGS, Vote};
use crate::homology::sides::Sides;
use crosscap_core::{Error, Mesh};

/// No triangle continues this side.
pub(super) const FREE: u32 = u32::MAX;

/// The sides of the triangles of a mesh, glued in pairs: the surface without its crossings.
///
/// Side `3 t + k` is opposite corner `3 t + k`, corner `k` of triangle `t`.
pub(super) struct Gluing<'a> {
    pub mesh: &'a Mesh,
    pub sides: Sides,
    /// For each side the edge it lies on.
    pub edge_of: Vec<u32>,
    /// For each side the side that continues it, or [`FREE`].
    pub partner: Vec<u32>,
}

impl<'a> Gluing<'a> {
    /// Glues across every edge with two triangles, and by vote across those with four.
    pub fn new(mesh: &'a Mesh) -> Result<Self, PiecesError> {
        let mut gluing = Self::across_plain_edges(mesh)?;
        for glued in gluing.paired_chains()? {
            for [s, t] in glued {
                gluing.partner[s as usize] = t;
                gluing.partner[t as usize] = s;
            }
        }
        Ok(gluing)
    }

    /// Glues across every edge with two triangles, and no other.
    pub fn across_plain_edges(mesh: &'a Mesh) -> Result<Self, Error> {
        let sides = Sides::new(&mesh.complex)?;
        let count = 3 * mesh.complex.triangles.len();
        let mut gluing = Self {
            mesh,
            sides,
            edge_of: vec![0; count],
            partner: vec![FREE; count],
        };
        for e in 0..gluing.sides.edges.len() {
            let at = gluing.sides.at(e);
            for &side in at {
                gluing.edge_of[side as usize] = e as u32;
            }
            if let &[s, t] = at {
                gluing.partner[s as usize] = t;
                gluing.partner[t as usize] = s;
            }
        }
        Ok(gluing)
    }

    /// Edges with exactly four triangles, increasing.
    pub fn double_edges(&self) -> Vec<u32> {
        let all = 0..self.sides.edges.len();
        all.filter(|&e| self.sides.at(e).len() == 4)
            .map(|e| e as u32)
            .collect()
    }

    /// The corner of the triangle of `side` that lies at vertex `v`.
    pub fn corner(&self, side: u32, v: u32) -> u32 {
        let t = side / 3;
        let corners = &self.mesh.complex.triangles[t as usize];
        let k = u32::from(corners[1] == v) + 2 * u32::from(corners[2] == v);
        3 * t + k
    }

    /// The other side at vertex `v` of the triangle of `side`, a side at `v`.
    pub fn turn(&self, side: u32, v: u32) -> u32 {
        let t = side / 3;
        // The numbers of the two sides at v and of the corner at v are 0, 1, 2.
        3 * t + (3 - side % 3 - self.corner(side, v) % 3)
    }

    /// The other end of edge `e`.
    fn far_end(&self, e: u32, v: u32) -> u32 {
        let [a, b] = self.sides.edges[e as usize];
        if v == a { b } else { a }
    }

    /// Walks from four sides at a double edge around vertex `v`, through edges with two
    /// triangles, to the next edges of another kind: if all four walks end at one other double
    /// edge, that edge and the sides in corresponding order.
    fn step(&self, order: [u32; 4], v: u32) -> Option<(u32, [u32; 4])> {
        let ends = order.map(|side| {
            let mut side = self.turn(side, v);
            while self.partner[side as usize] != FREE {
                side = self.turn(self.partner[side as usize], v);
            }
            side
        });
        let next = self.edge_of[ends[0] as usize];
        let same = ends.iter().all(|&s| self.edge_of[s as usize] == next);
        (same && next != self.edge_of[order[0] as usize] && self.sides.at(next as usize).len() == 4)
            .then_some((next, ends))
    }

    /// For each chain of double edges, the pairs of sides to glue.
    ///
    /// A chain is a longest run of double edges with the same four rims of surface beside all
    /// of them; its ends are triple points, pinch points, boundaries.
    fn paired_chains(&self) -> Result<Vec<Vec<[u32; 2]>>, PiecesError> {
        let double = self.double_edges();
        let mut done = vec![false; double.len()];
        let place = |e: u32| double.partition_point(|&x| x < e);
        let mut result = Vec::new();
        for (k, &first) in double.iter().enumerate() {
            if done[k] {
                continue;
            }
            done[k] = true;
            let at = self.sides.at(first as usize);
            let start = [at[0], at[1], at[2], at[3]];
            let mut chain = vec![(first, start)];
            let mut returned = None;
            for end in [1, 0] {
                let mut v = self.sides.edges[first as usize][end];
                let mut order = start;
                while let Some((next, ends)) = self.step(order, v) {
                    if next == first {
                        returned = Some(ends);
                        break;
                    }
                    done[place(next)] = true;
                    chain.push((next, ends));
                    v = self.far_end(next, v);
                    order = ends;
                }
                if returned.is_some() {
                    break;
                }
            }
            let pairing = self.decide(&chain, start, returned)?;
            let pairs = chain
                .iter()
                .flat_map(|(_, order)| pairing.map(|[i, j]| [order[i], order[j]]));
            result.push(pairs.collect());
        }
        Ok(result)
    }

    fn decide(
        &self,
        chain: &[(u32, [u32; 4])],
        start: [u32; 4],
        returned: Option<[u32; 4]>,
    ) -> Result<[[usize; 2]; 2], PiecesError> {
        let edge = self.sides.edges[chain[0].0 as usize];
        let mut allowed = [true; 3];
        if let Some(ends) = returned {
            let position = |side: u32| start.iter().position(|&s| s == side).unwrap_or(0);
            let moved = ends.map(position);
            for (k, pairing) in PAIRINGS.iter().enumerate() {
                let [i, j] = pairing[0].map(|i| moved[i]);
                allowed[k] = pairing.contains(&[i.min(j), i.max(j)]);
            }
        }
        let mut vote = Vote::default();
        for &(e, order) in chain {
            if let Some(rims) =
                straightness::directions(self.mesh, self.sides.edges[e as usize], order)
            {
                vote.add(&rims);
            }
        }
        match allowed.iter().filter(|&&a| a).count() {
            0 => Err(PiecesError::Twisted { edge }),
            // The topology leaves no choice.
            1 => Ok(PAIRINGS[allowed.iter().position(|&a| a).unwrap_or(0)]),
            _ => vote
                .winner(allowed)
                .map_err(|(margin, agreement)| PiecesError::Ambiguous {
                    edge,
                    edges: chain.len(),
                    margin,
                    limit: super::LEAST_MARGIN,
                    agreement,
                }),
        }
    }
}
