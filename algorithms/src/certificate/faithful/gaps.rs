//! Empty regions of the points that the mesh covers, against those that chance leaves.

use super::chance::{self, LEVELS};
use super::evenness::Evenness;
use super::footprints::Footprints;
use super::ground::{COUNTED, Count, Ground};
use super::tiles::{Cut, Shape, TILE};
use crate::balls::BallTree;
use crate::certificate::geometry::corners;
use crate::certificate::incidence::Incidence;
use crate::certificate::quality::{median, quantile};
use crosscap_core::{Mesh, squared_distance};
use serde::Serialize;
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Places of the mesh that the evenness is read from.
const READ: usize = 4000;
/// Points above which the slits of less than two spacings are not looked for: they cannot be told from
/// chance there, and their places are many.
const MANY: usize = 20_000;
/// Chains of a level that are measured, largest first.
const MEASURED: usize = 12;
/// Tiles hang together when their middles are this near, in spacings.
const TOGETHER: f64 = 1.1 * TILE;
/// Part of an edge of the boundary up to which the mesh may end beyond its points: the height of the arc
/// over a chord.
const CHORD: f64 = 0.15;
/// Least radius of a level where there are many points, in spacings.
const WIDE_LEVEL: f64 = 1.0;
/// The same where their density varies, and for even points, where small differences in density make all triangles of
/// a region gaps.
const CLEAR_LEVEL: f64 = 1.3;
/// Points that are counted around a gap in any case.
const LEAST_AROUND: f64 = 40.0;
/// Where the density varies, the most that the density around a hole may be above that of its own places, which the empty region itself
/// makes seem thinner: more than that is a density that varies.
const AROUND: f64 = 1.4;
/// The same for a chain, which is long and thin and takes little from the counts around it.
const ALONG: f64 = 1.1;
/// Ratio of the 90 to the 10 percent quantile of the local spacing above which the density varies: slits of less than
/// two spacings are not looked for then, as an error of a tenth in the spacing makes them, and a thin place
/// among dense ones is no gap.
const VARIES: f64 = 1.5;

/// An empty region of the points that the mesh covers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Gap {
    /// Diameter of its largest empty disc, in local spacings.
    pub width: f64,
    /// The same, unit of the data.
    pub size: f64,
    /// Number of points expected in it, at the density around.
    pub expected: f64,
    /// Probability that chance leaves such a gap anywhere in a sample like this one.
    pub p: f64,
    /// Triangle of its middle.
    pub triangle: u32,
    /// Its middle.
    pub place: Vec<f64>,
}

/// A small part of the mesh that is far from the points.
struct Empty {
    triangle: u32,
    /// Weights of its middle.
    weights: [f64; 3],
    /// Distance to the nearest point or to the end of the mesh, in spacings.
    away: f64,
    /// Number of points expected on it.
    measure: f64,
}

/// What gaps are looked for in.
pub(in crate::certificate) struct Search<'a> {
    pub mesh: &'a Mesh,
    pub incidence: &'a Incidence,
    pub feet: &'a Footprints,
    pub ground: &'a Ground,
    tree: BallTree,
    rim: Option<BallTree>,
    /// What is taken off a distance to the end of the mesh.
    chord: f64,
    even: Evenness,
    varies: bool,
    /// Largest empty disc that chance leaves, as a radius in spacings.
    largest: f64,
    /// Spacing of all points beside that of those that are looked at.
    finer: f64,
}

impl<'a> Search<'a> {
    pub fn new(
        mesh: &'a Mesh,
        incidence: &'a Incidence,
        feet: &'a Footprints,
        ground: &'a Ground,
        of: usize,
    ) -> Self {
        let width = mesh.vertices.dimension();
        let count = mesh.complex.triangles.len();
        let on_triangles: Vec<f64> = (0..feet.len())
            .filter(|&i| (feet.items[i] as usize) < count)
            .flat_map(|i| feet.place(i).iter().copied())
            .collect();
        let (places, chord) = rim(mesh, incidence);
        let mut search = Self {
            mesh,
            incidence,
            feet,
            ground,
            tree: BallTree::new(width, &on_triangles),
            rim: (!places.is_empty()).then(|| BallTree::new(width, &places)),
            chord,
            even: Evenness::RANDOM,
            varies: false,
            largest: 0.0,
            finer: (feet.len() as f64 / of.max(1) as f64).sqrt(),
        };
        search.varies = search.varies();
        search.even = search.evenness();
        // one of n discs
        let random = ((search.points().max(2) as f64).ln() / PI).sqrt();
        search.largest = search.even.radius(random);
        search
    }

    /// Median over the vertices of the local spacing of all points, unit of the data.
    pub fn spacing(&self) -> f64 {
        let density = self.ground.density.iter().copied().filter(|&d| d > 0.0);
        let all: Vec<f64> = density.map(|d| self.finer / d.sqrt()).collect();
        median(all)
    }

    /// Radius of the largest empty disc of all points that chance leaves where the spacing is the median.
    pub fn gap(&self) -> f64 {
        self.largest * self.spacing()
    }

    /// The same at a vertex; zero where there are no points.
    pub fn gap_at_vertex(&self, vertex: u32) -> f64 {
        let density = self.ground.density[vertex as usize];
        if density > 0.0 {
            self.largest * self.finer / density.sqrt()
        } else {
            0.0
        }
    }

    /// The largest of the three at the corners of a triangle.
    pub fn gap_at(&self, triangle: u32) -> f64 {
        let corners = self.mesh.complex.triangles[triangle as usize];
        corners
            .map(|v| self.gap_at_vertex(v))
            .into_iter()
            .fold(0.0, f64::max)
    }

    /// Longest part of a curve without a point that chance leaves, for the curve edges without triangles.
    pub fn curve_gap(&self, bare: &[[u32; 2]]) -> f64 {
        let first = self.mesh.complex.triangles.len() as u32;
        let found = self
            .feet
            .items
            .iter()
            .filter(|&&i| i >= first && i < u32::MAX)
            .count() as f64;
        let places = &self.mesh.vertices;
        let length: f64 = bare
            .iter()
            .map(|e| places.squared_distance(e[0] as usize, e[1] as usize).sqrt())
            .sum();
        if found > 0.0 {
            self.finer * self.finer * length / found * (found + 1.0).ln()
        } else {
            0.0
        }
    }

    /// Number of points that stand on triangles.
    fn points(&self) -> usize {
        self.tree.order().len()
    }

    /// Distance from a place to the nearest point, and to the end of the mesh.
    fn distances(&self, place: &[f64]) -> (f64, f64) {
        let nearest = |tree: &BallTree| tree.nearest(place, |_| true).map(|n| n.1.sqrt());
        let end = self.rim.as_ref().and_then(nearest);
        (
            nearest(&self.tree).unwrap_or(f64::INFINITY),
            end.map_or(f64::INFINITY, |d| (d - self.chord).max(0.0)),
        )
    }

    /// Largest gaps first by how unlikely they are: the least likely one, and all below `level`.
    pub fn run(&self, level: f64) -> Vec<Gap> {
        if self.points() < 2 {
            return Vec::new();
        }
        let even = self.even;
        let (tiles, middles) = self.far_tiles(&even);
        let mut gaps: Vec<Gap> = self.widest(&even, &tiles, &middles).into_iter().collect();
        self.chains(&even, &tiles, &middles, &mut gaps);
        gaps.sort_by(|a, b| a.p.total_cmp(&b.p).then(b.expected.total_cmp(&a.expected)));
        let shown = gaps.iter().filter(|g| g.p < level).count().max(1);
        gaps.truncate(shown);
        gaps
    }

    /// How even the points are, from the distances of places picked evenly to them.
    fn evenness(&self) -> Evenness {
        let triangles = &self.mesh.complex.triangles;
        let mut sums = Vec::with_capacity(triangles.len());
        let mut sum = 0.0;
        for t in 0..triangles.len() as u32 {
            sum += self.ground.expected(self.mesh, t);
            sums.push(sum);
        }
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let mut measures = Vec::new();
        for k in 0..READ {
            let at = (k as f64 + 0.5) / READ as f64 * sum;
            let t = sums.partition_point(|&s| s < at).min(triangles.len() - 1);
            // two shares that fill the unit square evenly (Roberts' sequence), folded into a triangle
            let (mut a, mut b) = (
                (k as f64 * 0.754_877_666_246_692_8).fract(),
                (k as f64 * 0.569_840_290_998_053_2).fract(),
            );
            if a + b > 1.0 {
                (a, b) = (1.0 - a, 1.0 - b);
            }
            let weights = [1.0 - a - b, a, b];
            let sides = corners(self.mesh, t as u32);
            for (k, x) in place.iter_mut().enumerate() {
                *x = weights[0] * sides[0][k] + weights[1] * sides[1][k] + weights[2] * sides[2][k];
            }
            let density = self.ground.density_at(triangles[t], weights);
            let (away, end) = self.distances(&place);
            if density > 0.0 && end > away {
                measures.push(PI * density * away * away);
            }
        }
        Evenness::of(measures, self.points())
    }

    /// Whether the density varies over the mesh.
    fn varies(&self) -> bool {
        let density = self.ground.density.iter().copied().filter(|&d| d > 0.0);
        let mut all: Vec<f64> = density.map(|d| 1.0 / d.sqrt()).collect();
        all.sort_unstable_by(f64::total_cmp);
        quantile(&all, 0.9) > VARIES * quantile(&all, 0.1)
    }

    /// Radius of the level from which on chains are looked for.
    fn least_level(&self) -> f64 {
        if self.varies || self.even.is_even() {
            CLEAR_LEVEL
        } else if self.points() > MANY {
            WIDE_LEVEL
        } else {
            LEVELS[0].radius
        }
    }

    /// Tiles further from the points than the least level asks, with their middles one after the other.
    fn far_tiles(&self, even: &Evenness) -> (Vec<Empty>, Vec<f64>) {
        let least = even.radius(self.least_level());
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let (mut tiles, mut middles) = (Vec::new(), Vec::new());
        for (t, &corner) in self.mesh.complex.triangles.iter().enumerate() {
            let shape = Shape::new(corners(self.mesh, t as u32));
            let most = corner.map(|v| self.ground.density[v as usize]);
            let most = most.into_iter().fold(0.0, f64::max).sqrt();
            if !(most > 0.0 && shape.longest > 0.0) {
                continue;
            }
            shape.cut(&mut place, &mut |tile, place| {
                let (scale, weights) = (tile.scale(), tile.middle());
                let (away, end) = self.distances(place);
                let (away, radius) = (away.min(end), shape.radius * scale);
                if (away + radius) * most < least {
                    return Cut::Leave;
                }
                let density = self.ground.density_at(corner, weights);
                if shape.longest * scale * density.sqrt() > TILE {
                    return Cut::Further;
                }
                if away * density.sqrt() >= least {
                    tiles.push(Empty {
                        triangle: t as u32,
                        weights,
                        away: away * density.sqrt(),
                        measure: self.ground.areas[t] * scale * scale * density,
                    });
                    middles.extend_from_slice(place);
                }
                Cut::Leave
            });
        }
        (tiles, middles)
    }

    /// The largest empty disc.
    fn widest(&self, even: &Evenness, tiles: &[Empty], middles: &[f64]) -> Option<Gap> {
        let width = self.mesh.vertices.dimension();
        let (k, tile) = tiles
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.away.total_cmp(&b.1.away).then(b.0.cmp(&a.0)))?;
        let place = &middles[k * width..(k + 1) * width];
        let (away, end) = self.distances(place);
        let away = away.min(end);
        // the density around, without the disc itself
        let around = self.around(&[tile.triangle], COUNTED, |p| {
            squared_distance(p, place) > away * away
        });
        let own = (tile.away / away).powi(2);
        let most = if self.varies {
            AROUND * own
        } else {
            f64::INFINITY
        };
        let (density, counted) = (around.density().min(most), around.points);
        let expected = PI * away * away * density;
        let p = chance::disc(
            self.points() as f64,
            chance::known(even.random(expected), counted),
        );
        Some(Gap {
            width: 2.0 * away * density.sqrt(),
            size: 2.0 * away,
            expected,
            p,
            triangle: tile.triangle,
            place: place.to_vec(),
        })
    }

    /// The chains of tiles of every level, as gaps.
    fn chains(&self, even: &Evenness, tiles: &[Empty], middles: &[f64], gaps: &mut Vec<Gap>) {
        let pairs = self.pairs(tiles, middles);
        let mut sets = Sets::new(tiles);
        let mut next = 0;
        let least = self.least_level();
        for level in LEVELS.iter().rev().filter(|l| l.radius >= least) {
            let radius = even.radius(level.radius);
            while next < pairs.len() && pairs[next].0 >= radius {
                sets.join(pairs[next].1, pairs[next].2);
                next += 1;
            }
            let deep: Vec<u32> = (0..tiles.len() as u32)
                .filter(|&k| tiles[k as usize].away >= radius)
                .collect();
            let mut chains: Vec<(f64, u32)> = Vec::new();
            for &k in &deep {
                if sets.root(k) == k {
                    chains.push((sets.measure[k as usize], k));
                }
            }
            chains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            chains.truncate(MEASURED);
            if chains.is_empty() {
                continue;
            }
            let mut members = vec![Vec::new(); chains.len()];
            for k in deep {
                let root = sets.root(k);
                if let Some(at) = chains.iter().position(|c| c.1 == root) {
                    members[at].push(k);
                }
            }
            for chain in &members {
                let (mut gap, counted) = self.measured(chain, tiles, middles);
                let random = (level.radius / radius).powi(2);
                let measure = chance::known(gap.expected * random, counted);
                gap.p = level.chain(self.points() as f64, measure);
                gaps.push(gap);
            }
        }
    }

    /// A chain as a gap, and the number of points around that its density is counted from. Its probability is left to the caller.
    fn measured(&self, chain: &[u32], tiles: &[Empty], middles: &[f64]) -> (Gap, f64) {
        let width = self.mesh.vertices.dimension();
        let at = |k: u32| &middles[k as usize * width..(k as usize + 1) * width];
        let places: Vec<f64> = chain.iter().flat_map(|&k| at(k).iter().copied()).collect();
        let tree = BallTree::new(width, &places);
        let widest = chain.iter().copied().fold(chain[0], |best, k| {
            if tiles[k as usize].away > tiles[best as usize].away {
                k
            } else {
                best
            }
        });
        let mut triangles: Vec<u32> = chain.iter().map(|&k| tiles[k as usize].triangle).collect();
        triangles.dedup();
        let triangle = tiles[widest as usize].triangle;
        let spacing = 1.0
            / self
                .ground
                .density_at(
                    self.mesh.complex.triangles[triangle as usize],
                    [1.0 / 3.0; 3],
                )
                .sqrt();
        // the empty discs about the tiles
        let discs: Vec<f64> = chain
            .iter()
            .map(|&k| {
                let tile = &tiles[k as usize];
                let corner = self.mesh.complex.triangles[tile.triangle as usize];
                tile.away / self.ground.density_at(corner, tile.weights).sqrt()
            })
            .collect();
        let reach = discs.iter().copied().fold(0.0, f64::max);
        let inside = |p: &[f64]| {
            tree.any_within(p, reach, |k, square| {
                square < discs[k as usize] * discs[k as usize]
            })
        };
        let near = |t: u32| {
            let shape = Shape::new(corners(self.mesh, t));
            let mut place = vec![0.0; width];
            shape.place([1.0 / 3.0; 3], &mut place);
            tree.any_within(&place, reach + shape.radius, |_, _| true)
        };
        let region = self.grown(&triangles, near);
        let empty: f64 = region.iter().map(|&t| self.part(t, spacing, &inside)).sum();
        let expected_here = empty / (spacing * spacing);
        let around = self.around(&triangles, COUNTED.max(2.0 * expected_here), |p| !inside(p));
        let mut own: Vec<f64> = Vec::with_capacity(chain.len());
        for &k in chain {
            let corner = self.mesh.complex.triangles[tiles[k as usize].triangle as usize];
            own.push(self.ground.density_at(corner, [1.0 / 3.0; 3]));
        }
        let own = own.iter().sum::<f64>() / own.len() as f64;
        let most = if self.varies {
            ALONG * own
        } else {
            f64::INFINITY
        };
        let (density, counted) = (around.density().min(most), around.points);
        let (away, end) = self.distances(at(widest));
        let gap = Gap {
            width: 2.0 * away.min(end) * density.sqrt(),
            size: 2.0 * away.min(end),
            expected: empty * density,
            p: 1.0,
            triangle,
            place: at(widest).to_vec(),
        };
        (gap, counted)
    }

    /// Area of the part of a triangle that is `inside`.
    fn part(&self, t: u32, spacing: f64, inside: &impl Fn(&[f64]) -> bool) -> f64 {
        let shape = Shape::new(corners(self.mesh, t));
        let mut place = vec![0.0; self.mesh.vertices.dimension()];
        let mut area = 0.0;
        shape.cut(&mut place, &mut |tile, place| {
            let scale = tile.scale();
            if shape.longest * scale > TILE * spacing {
                return Cut::Further;
            }
            if inside(place) {
                area += self.ground.areas[t as usize] * scale * scale;
            }
            Cut::Leave
        });
        area
    }

    /// Triangles connected with `from` over those that are `near`.
    fn grown(&self, from: &[u32], near: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut seen: BTreeSet<u32> = from.iter().copied().collect();
        let mut all: Vec<u32> = seen.iter().copied().collect();
        let mut k = 0;
        while k < all.len() {
            for v in self.mesh.complex.triangles[all[k] as usize] {
                for &t in self.incidence.at_vertex(v as usize) {
                    if seen.insert(t) && near(t) {
                        all.push(t);
                    }
                }
            }
            k += 1;
        }
        all
    }

    /// Area and points of rings about triangles that hold `wanted` points and are of one density, where `counts` holds.
    fn around(&self, from: &[u32], wanted: f64, counts: impl Fn(&[f64]) -> bool) -> Count {
        let mut seen: BTreeSet<u32> = from.iter().copied().collect();
        let mut ring: Vec<u32> = seen.iter().copied().collect();
        let mut all = Count::default();
        // rings that are denser by chance would be taken for another density
        let (least, wanted) = if self.varies {
            (LEAST_AROUND, wanted)
        } else {
            (f64::INFINITY, 2.0 * wanted)
        };
        while !ring.is_empty() {
            let mut own = Count::default();
            for &t in &ring {
                let corner = self.mesh.complex.triangles[t as usize];
                let density = self.ground.density_at(corner, [1.0 / 3.0; 3]);
                own.points += f64::from(self.ground.counts[t as usize]);
                own.ground += self.part(t, 1.0 / density.sqrt(), &counts);
            }
            if !all.take(own, least, wanted) || all.points >= wanted {
                break;
            }
            let mut next = Vec::new();
            for &t in &ring {
                for v in self.mesh.complex.triangles[t as usize] {
                    let at = self.incidence.at_vertex(v as usize);
                    next.extend(at.iter().filter(|&&t| seen.insert(t)));
                }
            }
            ring = next;
        }
        all
    }

    /// Pairs of tiles that hang together, by the lesser of their distances, largest first.
    fn pairs(&self, tiles: &[Empty], middles: &[f64]) -> Vec<(f64, u32, u32)> {
        let width = self.mesh.vertices.dimension();
        let tree = BallTree::new(width, middles);
        let mut pairs = Vec::new();
        for (k, tile) in tiles.iter().enumerate() {
            let corner = self.mesh.complex.triangles[tile.triangle as usize];
            let reach = TOGETHER / self.ground.density_at(corner, [1.0 / 3.0; 3]).sqrt();
            tree.within(&middles[k * width..(k + 1) * width], reach, |other, _| {
                if other != k as u32 {
                    let away = tile.away.min(tiles[other as usize].away);
                    pairs.push((away, other.min(k as u32), other.max(k as u32)));
                }
            });
        }
        pairs.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        pairs.dedup();
        pairs
    }
}

/// Places along the edges that end the mesh, and the chord that is allowed there.
fn rim(mesh: &Mesh, incidence: &Incidence) -> (Vec<f64>, f64) {
    let (mut places, mut lengths) = (Vec::new(), Vec::new());
    for (e, ends) in incidence.edges.iter().enumerate() {
        if incidence.at_edge(e).len() != 1 {
            continue;
        }
        let [a, b] = ends.map(|v| mesh.vertices.point(v as usize));
        lengths.push(squared_distance(a, b).sqrt());
        for k in 0..8 {
            let share = (f64::from(k) + 0.5) / 8.0;
            places.extend(a.iter().zip(b).map(|(x, y)| x + share * (y - x)));
        }
    }
    (places, CHORD * median(lengths))
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

    fn join(&mut self, a: u32, b: u32) {
        let (p, q) = (self.root(a), self.root(b));
        if p != q {
            let (low, high) = (p.min(q), p.max(q));
            self.parent[high as usize] = low;
            self.measure[low as usize] += self.measure[high as usize];
        }
    }
}
