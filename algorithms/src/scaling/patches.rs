//! Classical scaling of overlapping patches, moved onto each other.

use super::{Scaled, pivots::PivotFrame};
use crate::execute::{self, Execute};
use crosscap_core::{Error, PointCloud, Row, SparseDistances, Table};
use nalgebra::DMatrix;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Points of a patch that are scaled; the others are placed by their distances to these.
const PIVOTS: usize = 48;
/// A patch is laid onto what is there already by at least this many more points than dimensions.
const SPARE: usize = 3;
/// A direction in which the common points extend less than this share of their largest extent
/// cannot be laid: the patch could as well be turned over.
const LEAST_EXTENT: f64 = 1e-5;

/// Scales balls of which all distances are known, and lays them onto each other by the motion
/// that fits their common points best (Kabsch 1976), the one with the most of them first.
///
/// With every distance below a radius known, a ball is that of half the radius. For distances of
/// points in R^m the places are exact within rounding, wherever patches overlap in more than a
/// plane of their space; for others the deviation, over all known pairs, says how far off they are.
///
/// # Errors
/// [`Error::Shape`] for no point; [`Error::SparseNeighborhood`] for a point that is in no patch or
/// whose patch cannot be laid onto the others: the distances are too few, or the data in pieces.
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::scaling::scale_patches;
/// use crosscap_core::{PointCloud, Row, SparseDistances};
/// let rows = (0..400).flat_map(|k| {
///     let (u, v) = (f64::from(k % 20), f64::from(k / 20));
///     [u, v, (0.3 * u).sin() + (0.4 * v).cos()]
/// });
/// let cloud = PointCloud::new(3, rows.collect())?;
/// let pairs = (0..400).flat_map(|a| (0..a).map(move |b| (a, b)));
/// let near = pairs.map(|(a, b)| (Row::new(a), Row::new(b), cloud.squared_distance(a, b).sqrt()));
/// let known = SparseDistances::new(400, near.filter(|x| x.2 < 6.0))?;
/// let scaled = scale_patches(&known, &Serial)?;
/// assert_eq!(scaled.places.dimension(), 3);
/// assert!(scaled.deviation < 1e-8);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub fn scale_patches(
    known: &SparseDistances<f64, Row>,
    execute: &dyn Execute,
) -> Result<Scaled, Error> {
    let n = known.len();
    if n == 0 {
        return Err(Error::Shape {
            found: "no point".into(),
            expected: "at least 1".into(),
        });
    }
    let centers = cover(known);
    let patches = execute::map(
        execute,
        centers.len(),
        || (),
        |(), k| Patch::new(known, centers[k]),
    );
    let width = patches.iter().map(Patch::width).max().unwrap_or(1);
    let (places, placed) = Laying::new(n, width, &patches).lay();
    if let Some(point) = placed.iter().position(|p| !p) {
        return Err(Error::SparseNeighborhood {
            point,
            found: known.row(Row::new(point)).count() + 1,
            needed: width + 1 + SPARE,
            parameter: "the number of distances given",
        });
    }
    let places = PointCloud::new(width, places)?;
    let worst = execute::map(
        execute,
        n,
        || (),
        |(), i| {
            let row = known.row(Row::new(i));
            row.map(|(j, d)| (d - places.squared_distance(i, j.index()).sqrt()).abs())
                .fold(0.0, f64::max)
        },
    );
    Ok(Scaled {
        deviation: worst.into_iter().fold(0.0, f64::max),
        places,
    })
}

/// The radius up to which distances from a point are taken as known.
fn reach(known: &SparseDistances<f64, Row>, point: Row) -> f64 {
    known.row(point).map(|x| x.1).fold(0.0, f64::max)
}

/// Centers of patches whose quarter balls hold every point.
fn cover(known: &SparseDistances<f64, Row>) -> Vec<Row> {
    let mut held: Table<Row, bool> = Table::filled(known.len(), false);
    let mut centers = Vec::new();
    for i in held.ids() {
        if held[i] {
            continue;
        }
        centers.push(i);
        held[i] = true;
        let limit = 0.25 * reach(known, i);
        for (j, d) in known.row(i) {
            held[j] |= d <= limit;
        }
    }
    centers
}

/// Points with places of their own.
struct Patch {
    members: Vec<Row>,
    frame: PivotFrame,
    places: Vec<f64>,
}

impl Patch {
    fn new(known: &SparseDistances<f64, Row>, center: Row) -> Self {
        let limit = 0.5 * reach(known, center);
        let mut near: Vec<(f64, Row)> = (known.row(center).filter(|x| x.1 <= limit))
            .map(|(j, d)| (d, j))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let others = near.into_iter().map(|x| x.1);
        let mut members: Vec<Row> = std::iter::once(center).chain(others).collect();
        // Every few by distance, each with all distances to those before.
        let stride = members.len().div_ceil(PIVOTS).max(1);
        let mut pivots: Vec<Row> = Vec::with_capacity(PIVOTS);
        for &j in members.iter().step_by(stride) {
            if pivots.iter().all(|&p| known.get(p, j).is_some()) {
                pivots.push(j);
            }
        }
        members.retain(|&j| pivots.iter().all(|&p| known.get(p, j).is_some()));
        let square = |a: Row, b: Row| known.get(a, b).map_or(0.0, |d| d * d);
        let frame = PivotFrame::of(pivots.len(), super::MOST_DIMENSIONS, |a, b| {
            square(pivots[a], pivots[b])
        });
        let width = frame.width();
        let mut places = vec![0.0; members.len() * width];
        let mut squares = vec![0.0; pivots.len()];
        for (&j, place) in members.iter().zip(places.chunks_exact_mut(width)) {
            for (s, &p) in squares.iter_mut().zip(&pivots) {
                *s = square(p, j);
            }
            frame.place(&squares, place);
        }
        Self {
            members,
            frame,
            places,
        }
    }

    fn width(&self) -> usize {
        self.frame.width()
    }

    /// Coordinate `c` of member `k`, 0 beyond its own dimensions.
    fn at(&self, k: usize, c: usize) -> f64 {
        if c < self.width() {
            self.places[k * self.width() + c]
        } else {
            0.0
        }
    }
}

/// Patches that are laid one after the other, and what is laid so far.
struct Laying<'a> {
    patches: &'a [Patch],
    /// Dimension of the space that they are laid in.
    width: usize,
    places: Vec<f64>,
    placed: Vec<bool>,
    patches_of: Table<Row, Vec<u32>>,
    /// Number of placed members of every patch.
    common: Vec<usize>,
    laid: Vec<bool>,
    /// With how many placed members a patch could not be laid.
    tried: Vec<usize>,
}

impl<'a> Laying<'a> {
    fn new(n: usize, width: usize, patches: &'a [Patch]) -> Self {
        let mut patches_of: Table<Row, Vec<u32>> = Table::filled(n, Vec::new());
        for (p, patch) in patches.iter().enumerate() {
            for &j in &patch.members {
                patches_of[j].push(p as u32);
            }
        }
        Self {
            patches,
            width,
            places: vec![0.0; n * width],
            placed: vec![false; n],
            patches_of,
            common: vec![0; patches.len()],
            laid: vec![false; patches.len()],
            tried: vec![0; patches.len()],
        }
    }

    /// Lays all patches that can be, the one with the most placed members first. Places of all points in R^`width`, and which of
    /// them have one.
    fn lay(mut self) -> (Vec<f64>, Vec<bool>) {
        let mut queue = BinaryHeap::new();
        if let Some(first) = self.first() {
            let turn = DMatrix::<f64>::identity(self.width, self.width);
            let middle = vec![0.0; self.width];
            self.place(first, &(turn, middle.clone(), middle));
            self.ask_again(first, &mut queue);
        }
        while let Some((count, Reverse(p))) = queue.pop() {
            if self.laid[p] || count != self.common[p] || self.tried[p] == count {
                continue;
            }
            self.tried[p] = count;
            let motion = motion(&self.patches[p], self.width, &self.places, &self.placed);
            if let Some(motion) = motion {
                self.place(p, &motion);
                self.ask_again(p, &mut queue);
            }
        }
        (self.places, self.placed)
    }

    /// The patch with the most extent in all dimensions.
    fn first(&self) -> Option<usize> {
        let extent = |p: &Patch| {
            if p.width() == self.width {
                p.frame.eigenvalues[self.width - 1]
            } else {
                0.0
            }
        };
        (0..self.patches.len()).max_by(|&a, &b| {
            let by_extent = extent(&self.patches[a]).total_cmp(&extent(&self.patches[b]));
            by_extent.then(b.cmp(&a))
        })
    }

    /// Places the members of a patch that have no place yet.
    fn place(&mut self, p: usize, (turn, from, to): &Motion) {
        let width = self.width;
        let patch = &self.patches[p];
        self.laid[p] = true;
        for (k, &j) in patch.members.iter().enumerate() {
            if self.placed[j.index()] {
                continue;
            }
            self.placed[j.index()] = true;
            for r in 0..width {
                let turned = (0..width).map(|c| turn[(r, c)] * (patch.at(k, c) - from[c]));
                self.places[j.index() * width + r] = to[r] + turned.sum::<f64>();
            }
            for &other in &self.patches_of[j] {
                self.common[other as usize] += 1;
            }
        }
    }

    /// Queues the patches that have more placed members than before, now that a patch is laid.
    fn ask_again(&self, p: usize, queue: &mut BinaryHeap<(usize, Reverse<usize>)>) {
        for &j in &self.patches[p].members {
            for &other in &self.patches_of[j] {
                let other = other as usize;
                if !self.laid[other] && self.tried[other] != self.common[other] {
                    queue.push((self.common[other], Reverse(other)));
                }
            }
        }
    }
}

/// Rotation or reflection, center before, center after.
type Motion = (DMatrix<f64>, Vec<f64>, Vec<f64>);

/// The motion that lays a patch onto the places of its members; `None` where these do not decide it.
fn motion(patch: &Patch, width: usize, places: &[f64], placed: &[bool]) -> Option<Motion> {
    let common: Vec<(usize, usize)> = (patch.members.iter().enumerate())
        .map(|(k, &j)| (k, j.index()))
        .filter(|&(_, j)| placed[j])
        .collect();
    let own = patch.width();
    if common.len() < own + 1 + SPARE {
        return None;
    }
    let count = common.len() as f64;
    let (mut from, mut to) = (vec![0.0; width], vec![0.0; width]);
    for &(k, j) in &common {
        for c in 0..width {
            from[c] += patch.at(k, c) / count;
            to[c] += places[j * width + c] / count;
        }
    }
    let mut cross = DMatrix::<f64>::zeros(width, width);
    let mut spread = DMatrix::<f64>::zeros(own, own);
    for &(k, j) in &common {
        for c in 0..own {
            let x = patch.at(k, c) - from[c];
            for r in 0..width {
                cross[(r, c)] += (places[j * width + r] - to[r]) * x;
            }
            for e in 0..own {
                spread[(e, c)] += x * (patch.at(k, e) - from[e]);
            }
        }
    }
    // All directions that the patch itself has must show in what is common.
    let extents = spread.symmetric_eigenvalues();
    if extents.min() < LEAST_EXTENT * LEAST_EXTENT * extents.max() {
        return None;
    }
    let svd = cross.svd(true, true);
    Some((svd.u? * svd.v_t?, from, to))
}
