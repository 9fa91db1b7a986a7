//! Charts that cover the conformations, each sheet by itself.

use super::chart::{COVER, Chart, Scratch, squared_distance};
use super::conformations::RingConformations;
use super::error::RingError;
use crate::orthogonal::dot;
use crate::surfaces::Random;
use nalgebra::DMatrix;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Radius of the disc of a chart, in units of the separation.
pub(super) const DISC: f64 = 1.1;
/// Distance, in units of the separation, within which the discs of two charts may meet.
const MEET: f64 = 2.2 * DISC;
/// Charts that are fewer are no piece of their own, if there is one beside them.
const CRUMB: usize = 8;
/// Random conformations that the charts spread from.
const STARTS: usize = 400;
/// Largest share of them at which the fixed distances may depend on each other.
const SINGULAR: f64 = 0.05;
/// Least margin of the alignment.
const LEAST_MARGIN: f64 = 0.01;

/// Charts that cover the surface, each sheet by itself.
pub(super) struct Net {
    /// No center is within this distance of another on its sheet.
    pub separation: f64,
    pub charts: Vec<Chart>,
    /// Least margin of the alignment over the centers.
    pub margin: f64,
    /// Three directions along which the surface is wide.
    axes: [Vec<f64>; 3],
    /// The charts in the cells that these span, with the shadows of their centers.
    cells: HashMap<[i64; 3], Vec<(u32, [f64; 3])>>,
}

/// Which charts belong together.
pub(super) struct Sheets {
    /// For each chart those on its sheet whose discs may meet its own, increasing.
    pub beside: Vec<Vec<u32>>,
    /// For each chart its smooth piece; pieces are numbered by falling number of charts.
    pub piece: Vec<u32>,
    /// Number of pieces.
    pub pieces: usize,
}

impl Net {
    pub fn spread(
        ring: &RingConformations,
        separation: f64,
        random: &mut Random,
    ) -> Result<Self, RingError> {
        let seeds = seeds(ring, random)?;
        let mut net = Self {
            separation,
            charts: Vec::new(),
            margin: f64::INFINITY,
            axes: widest(ring.fixed.coordinates(), &seeds),
            cells: HashMap::new(),
        };
        let (starts, mut singular) = (seeds.len(), 0);
        let mut scratch = Scratch::new(ring);
        for place in seeds {
            singular += usize::from(!net.offer(ring, &place, &mut scratch));
        }
        if net.charts.is_empty() || singular as f64 > SINGULAR * starts as f64 {
            return Err(RingError::Dependent { singular, starts });
        }
        // A front of new charts, then two sweeps over all of them for what it left. Slivers that remain
        // are within the discs, which are wider than the net.
        let mut done = 0;
        while done < net.charts.len() {
            net.check_margin()?;
            net.grow(ring, done, 10, random, &mut scratch);
            done += 1;
        }
        for _ in 0..2 {
            for k in 0..net.charts.len() {
                net.grow(ring, k, 4, random, &mut scratch);
            }
        }
        net.check_margin()?;
        Ok(net)
    }

    fn check_margin(&self) -> Result<(), RingError> {
        if self.margin < LEAST_MARGIN {
            return Err(RingError::Unaligned {
                margin: self.margin,
            });
        }
        Ok(())
    }

    /// Offers places around chart `k`, a little beyond its disc.
    fn grow(
        &mut self,
        ring: &RingConformations,
        k: usize,
        directions: usize,
        random: &mut Random,
        scratch: &mut Scratch,
    ) {
        let phase = random.uniform();
        for step in 0..directions {
            let (s, c) = libm::sincos(TAU * (step as f64 + phase) / directions as f64);
            let scale = self.charts[k].scale;
            let reach = scale * self.separation * random.between(0.95, 1.5);
            if self.charts[k].lift(ring, [reach * c, reach * s], scratch) {
                let place = scratch.place.clone();
                self.offer(ring, &place, scratch);
            }
        }
    }

    /// Makes a chart at a place that none covers; `false` where there is none to make.
    fn offer(&mut self, ring: &RingConformations, place: &[f64], scratch: &mut Scratch) -> bool {
        let reach = COVER * self.separation;
        let guess = &mut scratch.guess;
        let mut near = self.near(place, reach);
        if near.any(|k| self.charts[k as usize].covers(place, self.separation, guess)) {
            return true;
        }
        drop(near);
        let Some(mut chart) = Chart::at(ring, place.to_vec()) else {
            return false;
        };
        // One that does not fit at the smallest size serves as well as it can; what it misses is counted when drawing.
        chart.fit(ring, DISC * self.separation, scratch);
        self.margin = self.margin.min(ring.position.alignment.margin(place));
        let shadow = self.shadow(place);
        let number = self.charts.len() as u32;
        let cell = self.cells.entry(self.cell(shadow)).or_default();
        cell.push((number, shadow));
        self.charts.push(chart);
        true
    }

    fn shadow(&self, place: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|k| dot(&self.axes[k], place))
    }

    fn cell(&self, shadow: [f64; 3]) -> [i64; 3] {
        // Cells a little wider than two discs: charts whose discs meet are in adjacent ones.
        shadow.map(|x| (x / (MEET * self.separation)).floor() as i64)
    }

    /// The charts whose centers may be within `reach` of a place: a projection never lengthens a distance. `reach` is
    /// no more than the width of a cell.
    fn near(&self, place: &[f64], reach: f64) -> impl Iterator<Item = u32> + '_ {
        let here = self.shadow(place);
        let [x, y, z] = self.cell(here);
        let limit = reach * reach * (1.0 + 1e-9);
        (0..27i64)
            .flat_map(move |k| {
                let cell = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
                self.cells.get(&cell).into_iter().flatten()
            })
            .filter(move |(_, there)| {
                let square = |k: usize| (here[k] - there[k]) * (here[k] - there[k]);
                square(0) + square(1) + square(2) < limit
            })
            .map(|&(number, _)| number)
    }

    /// Whether two charts next to each other are on one sheet: their centers cover each other (of charts of different
    /// size the larger one covers that of the smaller one), and their tangent planes agree, which those of two
    /// sheets beside a double curve do not.
    pub fn same_sheet(&self, k: usize, o: usize, scratch: &mut [f64]) -> bool {
        let (a, b) = (&self.charts[k], &self.charts[o]);
        let reach = 1.5 * self.separation;
        let agrees = |a: &Chart, b: &Chart| {
            a.tangent.iter().all(|t| {
                let along = |w: &Vec<f64>| dot(w, t).powi(2);
                b.tangent.iter().map(along).sum::<f64>() > 0.8
            })
        };
        (a.scale < b.scale || a.covers(&b.center, reach, scratch))
            && (b.scale < a.scale || b.covers(&a.center, reach, scratch))
            && agrees(a, b)
            && agrees(b, a)
    }

    /// Charts whose discs may meet are on one sheet when a chain of charts near both of them says so. Beside a double curve
    /// this tells the sheets apart however near to it the charts are.
    pub fn sheets(&self) -> Sheets {
        let near = self.meeting();
        let mut scratch = self.charts[0].center.clone();
        let next: Vec<Vec<u32>> = near
            .iter()
            .enumerate()
            .map(|(k, near)| {
                let same = |&&o: &&u32| self.same_sheet(k, o as usize, &mut scratch);
                near.iter().filter(same).copied().collect()
            })
            .collect();
        let (piece, pieces) = self.pieces(&next);
        Sheets {
            beside: (0..near.len())
                .map(|k| reached(k, &near[k], &next))
                .collect(),
            piece,
            pieces,
        }
    }

    /// For each chart those whose discs may meet its own, increasing.
    fn meeting(&self) -> Vec<Vec<u32>> {
        let reach = MEET * self.separation;
        let of = |k: usize| {
            let here = &self.charts[k];
            let meets = |&o: &u32| {
                let there = &self.charts[o as usize];
                let reach = 0.5 * (here.scale + there.scale) * reach;
                o as usize != k && squared_distance(&here.center, &there.center) < reach * reach
            };
            let mut near: Vec<u32> = self.near(&here.center, reach).filter(meets).collect();
            near.sort_unstable();
            near
        };
        (0..self.charts.len()).map(of).collect()
    }

    /// For each chart the piece that it is joined to by those of the same sheet, and how many pieces there are.
    fn pieces(&self, next: &[Vec<u32>]) -> (Vec<u32>, usize) {
        let count = self.charts.len();
        let mut union = petgraph::unionfind::UnionFind::<u32>::new(count);
        for (k, next) in next.iter().enumerate() {
            for &o in next {
                union.union(k as u32, o);
            }
        }
        let mut root: Vec<u32> = (0..count as u32).map(|k| union.find(k)).collect();
        let mut size = vec![0usize; count];
        root.iter().for_each(|&r| size[r as usize] += 1);
        // Where the surface is bent too strongly to tell, a chart belongs to the nearest piece.
        for k in 0..count {
            if size[root[k] as usize] >= CRUMB {
                continue;
            }
            let here = &self.charts[k].center;
            let far = |o: u32| squared_distance(here, &self.charts[o as usize].center);
            let nearest = self
                .near(here, MEET * self.separation)
                .filter(|&o| size[root[o as usize] as usize] >= CRUMB)
                .min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
            if let Some(o) = nearest {
                size[root[k] as usize] -= 1;
                size[root[o as usize] as usize] += 1;
                root[k] = root[o as usize];
            }
        }
        let mut roots: Vec<u32> = (0..count as u32)
            .filter(|&r| size[r as usize] > 0)
            .collect();
        roots.sort_by_key(|&r| (std::cmp::Reverse(size[r as usize]), r));
        let mut rank = vec![0u32; count];
        for (k, &r) in roots.iter().enumerate() {
            rank[r as usize] = k as u32;
        }
        (
            root.iter().map(|&r| rank[r as usize]).collect(),
            roots.len(),
        )
    }
}

/// Random conformations to start from.
fn seeds(ring: &RingConformations, random: &mut Random) -> Result<Vec<Vec<f64>>, RingError> {
    let mut best = f64::INFINITY;
    let mut seeds = Vec::new();
    for _ in 0..STARTS {
        match ring.seed(random) {
            Ok(place) => seeds.push(place),
            Err(deviation) => best = best.min(deviation),
        }
    }
    match seeds.is_empty() {
        true => Err(RingError::NotClosed {
            starts: STARTS,
            deviation: best,
        }),
        false => Ok(seeds),
    }
}

/// The three directions along which places of `n` coordinates spread most.
fn widest(n: usize, places: &[Vec<f64>]) -> [Vec<f64>; 3] {
    let mut covariance = DMatrix::<f64>::zeros(n, n);
    for s in places {
        for i in 0..n {
            for j in 0..n {
                covariance[(i, j)] += s[i] * s[j];
            }
        }
    }
    let eigen = covariance.symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let axis = |k: usize| {
        let column = eigen.eigenvectors.column(order[k]);
        column.iter().copied().collect()
    };
    [0, 1, 2].map(axis)
}

/// Those of the charts `near` chart k that a chain of them leads to, by the steps `next` of each chart.
fn reached(k: usize, near: &[u32], next: &[Vec<u32>]) -> Vec<u32> {
    let mut reached = vec![false; near.len()];
    let mut stack = vec![k];
    while let Some(at) = stack.pop() {
        for &o in &next[at] {
            if let Ok(place) = near.binary_search(&o)
                && !reached[place]
            {
                reached[place] = true;
                stack.push(o as usize);
            }
        }
    }
    let each = near.iter().zip(reached);
    each.filter(|(_, reached)| *reached)
        .map(|(&o, _)| o)
        .collect()
}
