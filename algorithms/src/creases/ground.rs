//! The vertices of a mesh with the points about them.

use super::CreaseLimits;
use crate::balls::BallTree;
use crate::execute::{self, Execute};
use crate::prepare::SheetFit;
use crosscap_core::{Mesh, PointCloud};
use petgraph::unionfind::UnionFind;

/// A mesh, walked from vertex to vertex along edges at which no more than two triangles meet.
pub(super) struct Ground<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) limits: &'a CreaseLimits,
    points: &'a PointCloud<f64>,
    /// All edges at which no more than two triangles meet and that are on no curve of three cells and more, sorted.
    pub(super) edges: Vec<[u32; 2]>,
    /// Whether a vertex is on such a curve, or on no triangle.
    aside: Vec<bool>,
    starts: Vec<u32>,
    neighbors: Vec<u32>,
    own_starts: Vec<u32>,
    own: Vec<u32>,
    /// Median length of the edges.
    pub(super) edge: f64,
}

/// Buffers of a walk.
pub(super) struct Walk {
    seen: Vec<u32>,
    round: u32,
    layer: Vec<u32>,
    next: Vec<u32>,
    found: Vec<u32>,
    pub(super) offset: Vec<f64>,
}

impl<'a> Ground<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        points: &'a PointCloud<f64>,
        limits: &'a CreaseLimits,
        execute: &dyn Execute,
    ) -> Self {
        let count = mesh.complex.vertices;
        let (edges, aside) = edges(mesh);
        let mut both: Vec<[u32; 2]> = edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        both.retain(|e| e.iter().all(|&v| !aside[v as usize]));
        both.sort_unstable();
        let starts = (0..=count as u32).map(|v| both.partition_point(|e| e[0] < v) as u32);
        let (own_starts, own) = owned(mesh, points, limits.points, execute);
        let mut lengths: Vec<f64> = (edges.iter())
            .map(|&[a, b]| {
                mesh.vertices
                    .squared_distance(a as usize, b as usize)
                    .sqrt()
            })
            .collect();
        lengths.sort_unstable_by(f64::total_cmp);
        Self {
            mesh,
            limits,
            points,
            aside,
            starts: starts.collect(),
            neighbors: both.into_iter().map(|e| e[1]).collect(),
            own_starts,
            own,
            edge: lengths.get(lengths.len() / 2).copied().unwrap_or(0.0),
            edges,
        }
    }

    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.mesh.complex.vertices
    }

    /// Whether a vertex is on no face: on a curve of three cells and more, or on no triangle.
    pub(super) fn is_aside(&self, vertex: u32) -> bool {
        self.aside[vertex as usize]
    }

    pub(super) fn place(&self, vertex: u32) -> &[f64] {
        self.mesh.vertices.point(vertex as usize)
    }

    /// The mean of the places of vertices.
    pub(super) fn mean(&self, vertices: &[u32]) -> Vec<f64> {
        let mut mean = vec![0.0; self.mesh.vertices.dimension()];
        for &v in vertices {
            let share = self.place(v).iter().map(|x| x / vertices.len() as f64);
            mean.iter_mut().zip(share).for_each(|(m, x)| *m += x);
        }
        mean
    }

    /// Those that a vertex has an edge to.
    pub(super) fn neighbors(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.neighbors[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// The points that are nearest to a vertex.
    pub(super) fn own(&self, vertex: u32) -> impl Iterator<Item = &[f64]> {
        let v = vertex as usize;
        let own = &self.own[self.own_starts[v] as usize..self.own_starts[v + 1] as usize];
        own.iter().map(|&k| self.points.point(k as usize))
    }

    pub(super) fn walk(&self) -> Walk {
        Walk {
            seen: vec![0; self.len()],
            round: 0,
            layer: Vec::new(),
            next: Vec::new(),
            found: Vec::new(),
            offset: Vec::new(),
        }
    }

    /// Coordinates of the points about a vertex: those of as many layers of vertices that are admitted as hold enough, and one at
    /// least.
    pub(super) fn about(
        &self,
        vertex: u32,
        admits: impl Fn(u32) -> bool,
        walk: &mut Walk,
    ) -> Vec<f64> {
        self.about_counting(vertex, admits, |_| true, walk)
    }

    /// The same of those vertices alone that count, in as many layers of all that are admitted.
    pub(super) fn about_counting(
        &self,
        vertex: u32,
        admits: impl Fn(u32) -> bool,
        counts: impl Fn(u32) -> bool,
        walk: &mut Walk,
    ) -> Vec<f64> {
        walk.round += 1;
        walk.found.clear();
        walk.layer.clear();
        walk.layer.push(vertex);
        walk.seen[vertex as usize] = walk.round;
        for layer in 0..=self.limits.layers {
            for &v in walk.layer.iter().filter(|&&v| counts(v)) {
                let range = self.own_starts[v as usize]..self.own_starts[v as usize + 1];
                walk.found
                    .extend(&self.own[range.start as usize..range.end as usize]);
            }
            if layer > 0 && walk.found.len() >= self.limits.enough {
                break;
            }
            walk.next.clear();
            for &v in &walk.layer {
                for &w in self.neighbors(v) {
                    if walk.seen[w as usize] != walk.round && admits(w) {
                        walk.seen[w as usize] = walk.round;
                        walk.next.push(w);
                    }
                }
            }
            std::mem::swap(&mut walk.layer, &mut walk.next);
        }
        walk.found.sort_unstable();
        let step = walk.found.len().div_ceil(self.limits.most).max(1);
        let some = walk.found.iter().step_by(step);
        some.flat_map(|&k| self.points.point(k as usize))
            .copied()
            .collect()
    }

    /// The sheet through points, and what it leaves, root mean square; `None` for too few.
    pub(super) fn sheet(&self, points: &[f64], offset: &mut Vec<f64>) -> Option<(SheetFit, f64)> {
        let n = self.points.dimension();
        let mut fit = SheetFit::new(n);
        let count = points.len() / n;
        fit.fit(points, &vec![1.0; count]).then(|| {
            let square = |x: &[f64]| fit.distance(x, f64::INFINITY, offset).powi(2);
            let left = points.chunks_exact(n).map(square).sum::<f64>() / count as f64;
            (fit.kept(), left.sqrt())
        })
    }
}

/// Edges of a mesh at which no more than two triangles meet, and which vertices are on others, on no triangle, or where sheets
/// cross in a point.
fn edges(mesh: &Mesh) -> (Vec<[u32; 2]>, Vec<bool>) {
    let complex = &mesh.complex;
    let mut all: Vec<([u32; 2], u32)> = (complex.triangles.iter().zip(0..))
        .flat_map(|(&[a, b, c], t)| [[a, b], [b, c], [a, c]].map(|e| (e, t)))
        .map(|([a, b], t)| ([a.min(b), a.max(b)], t))
        .collect();
    all.sort_unstable();
    let mut aside = vec![true; complex.vertices];
    for v in complex.triangles.iter().flatten() {
        aside[*v as usize] = false;
    }
    let curves = complex.curve_edges.iter().filter(|e| e.cells > 2);
    curves
        .flat_map(|e| e.ends)
        .for_each(|v| aside[v as usize] = true);
    let mut edges = Vec::with_capacity(all.len() / 2);
    // Corners of triangles that hang together about their vertex.
    let mut fans = UnionFind::<u32>::new(3 * complex.triangles.len());
    let corner = |t: u32, v: u32| {
        let at = complex.triangles[t as usize].iter().position(|&x| x == v);
        3 * t + at.unwrap_or(0) as u32
    };
    for same in all.chunk_by(|a, b| a.0 == b.0) {
        let ends = same[0].0;
        match same {
            [_] => edges.push(ends),
            &[(_, s), (_, t)] => {
                edges.push(ends);
                for v in ends {
                    fans.union(corner(s, v), corner(t, v));
                }
            }
            _ => ends.iter().for_each(|&v| aside[v as usize] = true),
        }
    }
    // A vertex of two fans is a point in which sheets cross.
    let mut fan = vec![u32::MAX; complex.vertices];
    for (&v, corner) in complex.triangles.iter().flatten().zip(0..) {
        let (own, root) = (&mut fan[v as usize], fans.find(corner));
        aside[v as usize] |= *own != u32::MAX && *own != root;
        *own = root;
    }
    (edges, aside)
}

/// For every vertex the points that it is the nearest of, as starts in a list and the list; of many points an even part.
fn owned(
    mesh: &Mesh,
    points: &PointCloud<f64>,
    most: usize,
    execute: &dyn Execute,
) -> (Vec<u32>, Vec<u32>) {
    let count = mesh.complex.vertices;
    let tree = BallTree::new(mesh.vertices.dimension(), mesh.vertices.coordinates());
    let step = points.len().div_ceil((most * count).max(1)).max(1);
    let looked_at = points.len().div_ceil(step);
    let nearest = execute::map(
        execute,
        looked_at,
        || (),
        |(), k| {
            let found = tree.nearest(points.point(k * step), |_| true);
            (found.map_or(0, |x| x.0), (k * step) as u32)
        },
    );
    let mut pairs = nearest;
    pairs.sort_unstable();
    let starts = (0..=count as u32).map(|v| pairs.partition_point(|p| p.0 < v) as u32);
    (starts.collect(), pairs.iter().map(|p| p.1).collect())
}
