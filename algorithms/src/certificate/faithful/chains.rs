//! Chains of places far from the points: slits and cuts.

use super::chance::{self, LEVELS, Level, TRIED};
use super::discs::Gap;
use super::ground::COUNTED;
use super::search::Search;
use super::slope::{Expected, Hole};
use super::tail::{LARGEST, Tail};
use super::tiles::{Empty, Shape, TILE};
use crate::balls::BallTree;
use crate::certificate::geometry::corners;

/// Chains of a level that are measured, largest first.
const MEASURED: usize = 12;
/// Tiles hang together when their middles are this near, in spacings.
const TOGETHER: f64 = 1.1 * TILE;
/// Tiles at least so far from the points, beside that of the chain which is farthest, are deep inside of the gap.
const DEEP: f64 = 0.75;

impl Search<'_> {
    /// The chains of tiles of every level, as gaps; what is below `significance` is asked whether it follows from the others.
    pub(super) fn chains(
        &self,
        tiles: &[Empty],
        middles: &[f64],
        significance: f64,
        gaps: &mut Vec<Gap>,
    ) {
        let pairs = self.pairs(tiles, middles);
        let mut sets = Sets::new(tiles);
        let mut next = 0;
        let least = self.least_level();
        for level in LEVELS.iter().rev().filter(|l| l.radius >= least) {
            let radius = self.even.radius(level.radius);
            while next < pairs.len() && pairs[next].0 >= radius {
                sets.join(pairs[next].1, pairs[next].2);
                next += 1;
            }
            let most = if self.even.is_even() {
                LARGEST
            } else {
                MEASURED
            };
            let chains = sets.largest(tiles, radius, most);
            let mut found: Vec<Likely> = (chains.iter().take(MEASURED))
                .map(|chain| self.likely(level, radius, chain, tiles, middles))
                .collect();
            let told = |likely: &Likely| likely.gap.p < significance;
            if self.even.is_even() && found.iter().any(told) {
                let others = (chains.iter().skip(MEASURED))
                    .map(|chain| self.measured(chain, tiles, middles).0.expected);
                let all = found.iter().map(|likely| likely.gap.expected);
                let all = all.chain(others).collect();
                follow(&mut found, all, self.points() as f64);
            }
            gaps.extend(found.into_iter().map(|likely| likely.gap));
        }
    }

    /// A chain of a level as a gap, with its probability.
    fn likely(
        &self,
        level: &Level,
        radius: f64,
        chain: &[u32],
        tiles: &[Empty],
        middles: &[f64],
    ) -> Likely {
        let (mut gap, counted, nearer) = self.measured(chain, tiles, middles);
        let random = (level.radius / radius).powi(2);
        let measure = chance::known(gap.expected * random, counted);
        let points = self.points() as f64;
        let nearer = if self.varies { nearer } else { 1.0 };
        gap.p = if self.varies {
            Level::at(nearer * level.radius).chain(points, measure)
        } else {
            level.chain(points, measure)
        };
        let measure = chance::known(gap.expected, counted);
        let random = Level::at(nearer * radius).chain(points, measure);
        Likely { gap, random }
    }

    /// A chain as a gap, the number of points around that its density is counted from, and how many times nearer to each other they are than
    /// those that its tiles were found by. Its probability is left to the caller.
    fn measured(&self, chain: &[u32], tiles: &[Empty], middles: &[f64]) -> (Gap, f64, f64) {
        let width = self.mesh.vertices.dimension();
        let at = |k: u32| &middles[k as usize * width..(k as usize + 1) * width];
        let widest = chain.iter().copied().fold(chain[0], |best, k| {
            if tiles[k as usize].away > tiles[best as usize].away {
                k
            } else {
                best
            }
        });
        let triangle = tiles[widest as usize].triangle;
        let places = chain.iter().flat_map(|&k| at(k).iter().copied()).collect();
        let spacing = 1.0 / self.middle_density(triangle).sqrt();
        let found = self.emptied(chain, tiles, places, triangle, spacing);
        let own = chain
            .iter()
            .map(|&k| self.middle_density(tiles[k as usize].triangle))
            .sum::<f64>()
            / chain.len() as f64;
        let density = found.density;
        let (away, end) = self.distances(at(widest));
        let deepest = tiles[widest as usize].away;
        let deep = |k: &&u32| tiles[**k as usize].away >= DEEP * deepest;
        let gap = Gap {
            width: 2.0 * away.min(end) * density.sqrt(),
            size: 2.0 * away.min(end),
            expected: found.points,
            p: 1.0,
            together: 1,
            triangle,
            place: at(widest).to_vec(),
            inner: (chain.iter().filter(deep))
                .flat_map(|&k| at(k).iter().copied())
                .collect(),
            depth: DEEP * away.min(end),
        };
        (gap, found.counted, (density / own).sqrt())
    }

    /// What is expected in the empty discs about the tiles of a chain, whose middles are `places`, the widest in `triangle`.
    fn emptied(
        &self,
        chain: &[u32],
        tiles: &[Empty],
        places: Vec<f64>,
        triangle: u32,
        spacing: f64,
    ) -> Expected {
        let width = self.mesh.vertices.dimension();
        let tree = BallTree::new(width, &places);
        let mut triangles: Vec<u32> = chain.iter().map(|&k| tiles[k as usize].triangle).collect();
        triangles.dedup();
        let radius = |&k: &u32| {
            let tile = &tiles[k as usize];
            let corner = self.mesh.complex.triangles[tile.triangle as usize];
            tile.away / self.ground.density_at(corner, tile.weights).sqrt()
        };
        let discs: Vec<f64> = chain.iter().map(radius).collect();
        let reach = discs.iter().copied().fold(0.0, f64::max);
        let inside = |p: &[f64]| {
            tree.any_within(p, reach, |k, square| {
                square < discs[k as usize] * discs[k as usize]
            })
        };
        if self.varies {
            triangles.insert(0, triangle);
            let hole = Hole {
                tree: &tree,
                triangles: &triangles,
                reach,
                spacing,
                inside: &inside,
            };
            return self
                .expected_in(&hole)
                .unwrap_or(Expected::nothing(spacing));
        }
        let near = |t: u32| {
            let shape = Shape::new(corners(self.mesh, t));
            let mut place = vec![0.0; width];
            shape.place([1.0 / 3.0; 3], &mut place);
            tree.any_within(&place, reach + shape.radius, |_, _| true)
        };
        let region = self.grown(&triangles, near);
        let empty: f64 = region.iter().map(|&t| self.part(t, spacing, &inside)).sum();
        let expected = empty / (spacing * spacing);
        let around = self.around(&triangles, COUNTED.max(2.0 * expected), |p| !inside(p));
        Expected {
            points: empty * around.density(),
            density: around.density(),
            counted: around.points,
        }
    }

    /// Density of the points at the middle of a triangle.
    fn middle_density(&self, triangle: u32) -> f64 {
        let corner = self.mesh.complex.triangles[triangle as usize];
        self.ground.density_at(corner, [1.0 / 3.0; 3])
    }

    /// Pairs of tiles that hang together, by the lesser of their distances, largest first.
    fn pairs(&self, tiles: &[Empty], middles: &[f64]) -> Vec<(f64, u32, u32)> {
        let width = self.mesh.vertices.dimension();
        let tree = BallTree::new(width, middles);
        let reach = |tile: &Empty| TOGETHER / self.middle_density(tile.triangle).sqrt();
        let reaches: Vec<f64> = tiles.iter().map(reach).collect();
        let mut pairs = Vec::new();
        for (k, tile) in tiles.iter().enumerate() {
            let middle = &middles[k * width..(k + 1) * width];
            tree.within(middle, reaches[k], |other, square| {
                let at = other as usize;
                // A pair that both see is told by the first of them.
                if at > k || at < k && square >= reaches[at] * reaches[at] {
                    let away = tile.away.min(tiles[at].away);
                    pairs.push((away, other.min(k as u32), other.max(k as u32)));
                }
            });
        }
        pairs.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        pairs
    }
}

/// A chain as a gap, with its probability in a sample as even as this one.
struct Likely {
    gap: Gap,
    /// Its probability in a random sample of the same density.
    random: f64,
}

/// Gaps of a level of an even sample that follow from the others, whose measures are among `all`, are as likely as these say, and no
/// likelier than in a random sample.
fn follow(found: &mut [Likely], mut all: Vec<f64>, points: f64) {
    all.sort_unstable_by(|a, b| b.total_cmp(a));
    let Some(tail) = Tail::of(&all, points) else {
        return;
    };
    for Likely { gap, random } in found {
        let shown = (TRIED * tail.above(gap.expected)).min(1.0);
        gap.p = gap.p.max(shown.min(*random));
    }
}

/// Sets of tiles with their measures.
struct Sets {
    parent: Vec<u32>,
    measure: Vec<f64>,
}

impl Sets {
    fn new(tiles: &[Empty]) -> Self {
        Self {
            parent: (0..tiles.len() as u32).collect(),
            measure: tiles.iter().map(|t| t.measure).collect(),
        }
    }

    fn root(&mut self, mut a: u32) -> u32 {
        while self.parent[a as usize] != a {
            let up = self.parent[self.parent[a as usize] as usize];
            self.parent[a as usize] = up;
            a = up;
        }
        a
    }

    /// The sets of tiles that are at least `radius` from the points, those of the largest measure first, and `most` of them at most.
    fn largest(&mut self, tiles: &[Empty], radius: f64, most: usize) -> Vec<Vec<u32>> {
        let deep: Vec<u32> = (0..tiles.len() as u32)
            .filter(|&k| tiles[k as usize].away >= radius)
            .collect();
        let mut chains: Vec<(f64, u32)> = Vec::new();
        for &k in &deep {
            if self.root(k) == k {
                chains.push((self.measure[k as usize], k));
            }
        }
        chains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        chains.truncate(most);
        let mut members = vec![Vec::new(); chains.len()];
        for k in deep {
            let root = self.root(k);
            if let Some(at) = chains.iter().position(|c| c.1 == root) {
                members[at].push(k);
            }
        }
        members
    }

    fn join(&mut self, a: u32, b: u32) {
        let (p, q) = (self.root(a), self.root(b));
        if p != q {
            let (low, high) = (p.min(q), p.max(q));
            self.parent[high as usize] = low;
            self.measure[low as usize] += self.measure[high as usize];
        }
    }
}
