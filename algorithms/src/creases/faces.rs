//! Faces, grown from where the points lie on one sheet.

use super::ground::{Ground, Walk};
use crate::execute::{self, Execute};
use crate::prepare::SheetFit;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Vertices that a job takes at a time.
const VERTICES_AT_ONCE: usize = 64;

/// Which face every vertex is on.
pub(super) struct Faces {
    /// None on curves in which sheets cross, and where no sheet was found.
    pub(super) of: Vec<Option<u32>>,
    pub(super) count: usize,
}

/// A vertex that a face may take, by how far it is off its sheet.
struct Candidate {
    off: f64,
    vertex: u32,
    from: u32,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    /// The nearest is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        let by = (other.off.total_cmp(&self.off)).then(other.vertex.cmp(&self.vertex));
        by.then(other.from.cmp(&self.from))
    }
}

impl Faces {
    /// Vertices whose neighborhoods are regular make faces where they hang together; these take the others, those first that lie on their
    /// sheets best. Each vertex that is taken gets a sheet through the points of its face alone, which tells of the next.
    pub(super) fn grown(ground: &Ground<'_>, execute: &dyn Execute) -> Self {
        let vertices = ground.len();
        let mut sheets = regular(ground, execute);
        let mut faces = Self::hanging_together(ground, |v| sheets[v as usize].is_some());
        faces.begin_with(ground.limits.seeds, &mut sheets);
        let mut walk = ground.walk();
        let mut open = BinaryHeap::new();
        for v in 0..vertices as u32 {
            if let Some(sheet) = &sheets[v as usize] {
                faces.offer(ground, v, 0.0, sheet, &mut open, &mut walk);
            }
        }
        while let Some(Candidate { off, vertex, from }) = open.pop() {
            if faces.of[vertex as usize].is_some() {
                continue;
            }
            let face = faces.of[from as usize];
            faces.of[vertex as usize] = face;
            let own = ground.about(vertex, |w| faces.of[w as usize] == face, &mut walk);
            let sheet = ground.sheet(&own, &mut walk.offset).map(|x| x.0);
            let Some(sheet) = sheet.or_else(|| sheets[from as usize].clone()) else {
                continue;
            };
            faces.offer(ground, vertex, off, &sheet, &mut open, &mut walk);
            sheets[vertex as usize] = Some(sheet);
        }
        faces.without_small(ground)
    }

    /// Parts of those vertices that are chosen.
    fn hanging_together(ground: &Ground<'_>, chosen: impl Fn(u32) -> bool) -> Self {
        let mut faces = Self {
            of: vec![None; ground.len()],
            count: 0,
        };
        for first in (0..ground.len() as u32).filter(|&v| chosen(v)) {
            if faces.of[first as usize].is_some() {
                continue;
            }
            let own = Some(faces.count as u32);
            faces.count += 1;
            faces.of[first as usize] = own;
            let mut open = vec![first];
            while let Some(v) = open.pop() {
                for &w in ground.neighbors(v) {
                    if chosen(w) && faces.of[w as usize].is_none() {
                        faces.of[w as usize] = own;
                        open.push(w);
                    }
                }
            }
        }
        faces
    }

    /// Keeps those that so many vertices have begun.
    fn begin_with(&mut self, least: usize, sheets: &mut [Option<SheetFit>]) {
        let sizes = self.sizes();
        for (of, sheet) in self.of.iter_mut().zip(sheets) {
            if of.is_some_and(|f| sizes[f as usize] < least) {
                (*of, *sheet) = (None, None);
            }
        }
        self.join(&[]);
    }

    /// How many vertices are on each face.
    fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.count];
        let faces = self.of.iter().flatten();
        faces.for_each(|&f| sizes[f as usize] += 1);
        sizes
    }

    /// Offers a sheet to those neighbors of a vertex that are on no face. No vertex comes before the one that it is
    /// reached from.
    fn offer(
        &self,
        ground: &Ground<'_>,
        from: u32,
        least: f64,
        sheet: &SheetFit,
        open: &mut BinaryHeap<Candidate>,
        walk: &mut Walk,
    ) {
        for &vertex in ground.neighbors(from) {
            if self.of[vertex as usize].is_some() {
                continue;
            }
            let mut all: Vec<f64> = std::iter::once(ground.place(vertex))
                .chain(ground.own(vertex))
                .map(|x| sheet.distance(x, f64::INFINITY, &mut walk.offset))
                .collect();
            let middle = all.len() / 2;
            let off = *all.select_nth_unstable_by(middle, f64::total_cmp).1;
            let off = off.max(least);
            open.push(Candidate { off, vertex, from });
        }
    }

    /// Faces of few vertices go to the neighbor that they have most edges to.
    fn without_small(mut self, ground: &Ground<'_>) -> Self {
        let sizes = self.sizes();
        let mut shared: Vec<[u32; 2]> = (ground.edges.iter())
            .filter_map(|&e| self.parted(e))
            .flat_map(|[a, b]| [[a, b], [b, a]])
            .filter(|&[a, _]| sizes[a as usize] < ground.limits.face)
            .collect();
        shared.sort_unstable();
        let mut into: Vec<[u32; 2]> = Vec::new();
        for own in shared.chunk_by(|x, y| x[0] == y[0]) {
            let runs = own.chunk_by(|x, y| x == y);
            let best = runs.max_by(|x, y| x.len().cmp(&y.len()).then(y[0].cmp(&x[0])));
            into.extend(best.map(|x| x[0]));
        }
        self.join(&into);
        self
    }

    /// The faces of the ends of an edge, where they differ.
    pub(super) fn parted(&self, [a, b]: [u32; 2]) -> Option<[u32; 2]> {
        let [a, b] = [self.of[a as usize]?, self.of[b as usize]?];
        (a != b).then_some([a.min(b), a.max(b)])
    }

    /// Makes one of each two faces; whether there were any.
    pub(super) fn join(&mut self, pairs: &[[u32; 2]]) -> bool {
        let mut lead: Vec<u32> = (0..self.count as u32).collect();
        let top = |lead: &[u32], mut f: u32| {
            while lead[f as usize] != f {
                f = lead[f as usize];
            }
            f
        };
        for &[a, b] in pairs {
            let [a, b] = [top(&lead, a), top(&lead, b)];
            lead[a.max(b) as usize] = a.min(b);
        }
        let mut numbers = vec![u32::MAX; self.count];
        let mut count = 0;
        for of in self.of.iter_mut().flatten() {
            let own = &mut numbers[top(&lead, *of) as usize];
            if *own == u32::MAX {
                *own = count;
                count += 1;
            }
            *of = *own;
        }
        self.count = count as usize;
        !pairs.is_empty()
    }
}

/// The sheets of the regular neighborhoods.
fn regular(ground: &Ground<'_>, execute: &dyn Execute) -> Vec<Option<SheetFit>> {
    let fits = execute::map_blocks(
        execute,
        VERTICES_AT_ONCE,
        ground.len(),
        || ground.walk(),
        |walk, v| {
            let vertex = v as u32;
            if ground.is_aside(vertex) {
                return None;
            }
            let about = ground.about(vertex, |_| true, walk);
            ground.sheet(&about, &mut walk.offset)
        },
    );
    let mut left: Vec<f64> = fits.iter().flatten().map(|x| x.1).collect();
    if left.is_empty() {
        return vec![None; ground.len()];
    }
    let quarter = left.len() / 4;
    let usual = *left.select_nth_unstable_by(quarter, f64::total_cmp).1;
    let limits = ground.limits;
    let most = limits.regular * usual + limits.flat * ground.edge;
    let is_regular = |x: (SheetFit, f64)| (x.1 <= most).then_some(x.0);
    fits.into_iter().map(|x| x.and_then(is_regular)).collect()
}
