//! The graph that cells are flooded in.

use super::NONE;
use super::region::Region;
use crate::execute::Execute;
use crate::space::{GRAPH_NEIGHBORS, NearestOfEach, Space};
use crate::stratify::strata::Strata;
use crosscap_core::{Error, PointCloud, Scalar};

/// The graph on the regular points of a region, cut along the curves.
///
/// Nodes that are near to each other have near numbers, and their places lie together.
pub(in crate::stratify) struct CellGraph {
    /// Node of every row, `NONE` outside of the region.
    pub(super) node_of: Vec<u32>,
    /// Row of every node.
    pub(super) rows: Vec<u32>,
    /// Place of every node.
    width: usize,
    places: Vec<f64>,
    starts: Vec<usize>,
    targets: Vec<u32>,
    /// Edges cut.
    pub(super) cut: usize,
}

/// The nodes next to one, `NONE` where there are fewer, and how many edges the labels cut there.
struct Links {
    targets: [u32; GRAPH_NEIGHBORS],
    cut: usize,
}

impl CellGraph {
    /// Union of the 12 nearest neighbors of every point of the region in the space of the analysis,
    /// curve points counted among them and then removed; an edge is cut when its ends carry different
    /// labels in the fit that is nearest to either.
    ///
    /// # Errors
    /// [`Error::Law`] for a distance that is no number.
    pub(super) fn new<S: Scalar>(
        space: &Space<'_, S>,
        strata: &Strata,
        separated: impl Fn(usize, usize) -> bool + Sync,
        region: &Region,
        execute: &dyn Execute,
    ) -> Result<Self, Error> {
        let search = NearestOfEach::new(space, &region.rows, region.margin);
        let is_node = |k: u32| {
            let row = region.rows[k as usize] as usize;
            region.inside[k as usize] && strata.is_regular(row)
        };
        let mut node_of = vec![NONE; strata.len()];
        let mut rows = Vec::new();
        for k in search.order().into_iter().filter(|&k| is_node(k)) {
            let row = region.rows[k as usize];
            node_of[row as usize] = rows.len() as u32;
            rows.push(row);
        }
        let links_of = |from: usize, near: &[u32]| {
            let mut links = Links {
                targets: [NONE; GRAPH_NEIGHBORS],
                cut: 0,
            };
            for (target, &to) in links.targets.iter_mut().zip(near) {
                let node = node_of[to as usize];
                if node != NONE && separated(from, to as usize) {
                    links.cut += 1;
                } else {
                    *target = node;
                }
            }
            links
        };
        let mut all_links = search.each(&is_node, execute, links_of)?;
        drop(search);
        link_wards(&mut all_links, strata, &node_of);
        let width = strata.places().map_or(0, PointCloud::dimension);
        let mut places = Vec::with_capacity(rows.len() * width);
        if let Some(all) = strata.places() {
            for &row in &rows {
                places.extend_from_slice(all.point(row as usize));
            }
        }
        let (starts, targets) = compressed(&all_links);
        Ok(Self {
            node_of,
            rows,
            width,
            places,
            starts,
            targets,
            cut: all_links.iter().map(|links| links.cut).sum(),
        })
    }

    pub(super) fn around(&self, node: usize) -> &[u32] {
        &self.targets[self.starts[node]..self.starts[node + 1]]
    }

    /// Row of a node.
    pub(super) fn row(&self, node: usize) -> usize {
        self.rows[node] as usize
    }

    /// Place of a node.
    pub(super) fn place(&self, node: usize) -> &[f64] {
        &self.places[node * self.width..(node + 1) * self.width]
    }
}

/// Fewest links of a node about the end of a curve within its own cell.
const LEAST_LINKS: usize = 3;

/// Links nodes about the ends of curves within their cells. Two cells can be closer to each other there than points are
/// apart, so that all nearest neighbors of a point are on the other side of a curve; its cell is one
/// piece, and the nearest points of that are next to it.
fn link_wards(links: &mut [Links], strata: &Strata, node_of: &[u32]) {
    let Some(places) = strata.places() else {
        return;
    };
    for region in strata.regions() {
        for cell in (0..region.fit.strata.len() as u8).filter(|&l| region.is_cell(l)) {
            let own = region.labels.iter().filter(|x| x.1 == cell);
            let rows = own.map(|x| x.0 as usize);
            let rows: Vec<usize> = rows.filter(|&row| node_of[row] != NONE).collect();
            for &row in &rows {
                let targets = &mut links[node_of[row] as usize].targets;
                if targets.iter().filter(|&&t| t != NONE).count() >= LEAST_LINKS {
                    continue;
                }
                let square = |other: usize| places.squared_distance(row, other);
                let mut near: Vec<usize> = rows.iter().copied().filter(|&r| r != row).collect();
                near.sort_by(|&a, &b| square(a).total_cmp(&square(b)).then(a.cmp(&b)));
                for node in near.into_iter().take(LEAST_LINKS).map(|r| node_of[r]) {
                    if !targets.contains(&node)
                        && let Some(free) = targets.iter_mut().find(|t| **t == NONE)
                    {
                        *free = node;
                    }
                }
            }
        }
    }
}

/// The nodes that are linked to each, from either side and each once, with where those of a node start.
fn compressed(links: &[Links]) -> (Vec<usize>, Vec<u32>) {
    let count = links.len();
    // Bit k: the k-th target has no link back.
    let one_sided: Vec<u16> = (0_u32..)
        .zip(links)
        .map(|(a, own)| {
            let bits = own.targets.iter().enumerate().map(|(k, &b)| {
                let back = b == NONE || links[b as usize].targets.contains(&a);
                u16::from(!back) << k
            });
            bits.sum()
        })
        .collect();
    let pairs = || {
        (0_u32..)
            .zip(links.iter().zip(&one_sided))
            .flat_map(|(a, (own, &one_sided))| {
                let targets = own.targets.iter().enumerate().filter(|x| *x.1 != NONE);
                targets.map(move |(k, &b)| (a, b, one_sided >> k & 1 == 1))
            })
    };
    let mut starts = vec![0usize; count + 1];
    for (a, b, one_sided) in pairs() {
        starts[a as usize + 1] += 1;
        starts[b as usize + 1] += usize::from(one_sided);
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut all = vec![0u32; starts[count]];
    for (a, b, one_sided) in pairs() {
        all[next[a as usize]] = b;
        next[a as usize] += 1;
        if one_sided {
            all[next[b as usize]] = a;
            next[b as usize] += 1;
        }
    }
    (starts, all)
}
