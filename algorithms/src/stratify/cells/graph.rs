//! The graph that cells are flooded in.

use super::Node;
use super::region::Region;
use crate::execute::Execute;
use crate::space::{GRAPH_NEIGHBORS, NearestOfEach, Space};
use crate::stratify::strata::Strata;
use crosscap_core::{Error, PointCloud, Row, Scalar, Table};

/// The graph on the regular points of a region, cut along the curves.
///
/// Nodes that are near to each other have near numbers, and their places lie together.
pub(in crate::stratify) struct CellGraph {
    /// Node of every row, none outside of the region.
    pub(super) node_of: Table<Row, Node>,
    /// Row of every node.
    pub(super) rows: Table<Node, Row>,
    /// Place of every node.
    width: usize,
    places: Vec<f64>,
    starts: Vec<usize>,
    targets: Vec<Node>,
    /// Edges cut.
    pub(super) cut: usize,
}

/// The nodes next to one, none where there are fewer, and how many edges the labels cut there.
struct Links {
    targets: [Node; GRAPH_NEIGHBORS],
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
        separated: impl Fn(Row, Row) -> bool + Sync,
        region: &Region,
        execute: &dyn Execute,
    ) -> Result<Self, Error> {
        let search = NearestOfEach::new(space, &region.rows, region.margin);
        let is_node =
            |k: u32| region.inside[k as usize] && strata.is_regular(region.rows[k as usize]);
        let mut node_of = Table::filled(strata.len(), Node::NONE);
        let mut rows = Table::default();
        for k in search.order().into_iter().filter(|&k| is_node(k)) {
            let row = region.rows[k as usize];
            node_of[row] = rows.push(row);
        }
        let links_of = |from: Row, near: &[Row]| {
            let mut links = Links {
                targets: [Node::NONE; GRAPH_NEIGHBORS],
                cut: 0,
            };
            for (target, &to) in links.targets.iter_mut().zip(near) {
                let node = node_of[to];
                if node != Node::NONE && separated(from, to) {
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
                places.extend_from_slice(all.point(row.index()));
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

    pub(super) fn around(&self, node: Node) -> &[Node] {
        let node = node.index();
        &self.targets[self.starts[node]..self.starts[node + 1]]
    }

    /// Row of a node.
    pub(super) fn row(&self, node: Node) -> Row {
        self.rows[node]
    }

    /// Place of a node.
    pub(super) fn place(&self, node: Node) -> &[f64] {
        let node = node.index();
        &self.places[node * self.width..(node + 1) * self.width]
    }
}

/// Fewest links of a node about the end of a curve within its own cell.
const LEAST_LINKS: usize = 3;

/// Links nodes about the ends of curves within their cells. Two cells can be closer to each other there than points are
/// apart, so that all nearest neighbors of a point are on the other side of a curve; its cell is one
/// piece, and the nearest points of that are next to it.
fn link_wards(links: &mut [Links], strata: &Strata, node_of: &Table<Row, Node>) {
    let Some(places) = strata.places() else {
        return;
    };
    for region in strata.regions() {
        for cell in region.fit.labels_of(2) {
            let own = region.labels.iter().filter(|x| x.1 == cell);
            let own = own.map(|x| x.0).filter(|&row| node_of[row] != Node::NONE);
            let rows: Vec<Row> = own.collect();
            for &row in &rows {
                let targets = &mut links[node_of[row].index()].targets;
                if targets.iter().filter(|&&t| t != Node::NONE).count() >= LEAST_LINKS {
                    continue;
                }
                let square = |other: Row| places.squared_distance(row.index(), other.index());
                let mut near: Vec<Row> = rows.iter().copied().filter(|&r| r != row).collect();
                near.sort_by(|&a, &b| square(a).total_cmp(&square(b)).then(a.cmp(&b)));
                for node in near.into_iter().take(LEAST_LINKS).map(|r| node_of[r]) {
                    if !targets.contains(&node)
                        && let Some(free) = targets.iter_mut().find(|t| **t == Node::NONE)
                    {
                        *free = node;
                    }
                }
            }
        }
    }
}

/// The nodes that are linked to each, from either side and each once, with where those of a node start.
fn compressed(links: &[Links]) -> (Vec<usize>, Vec<Node>) {
    let count = links.len();
    // Bit k: the k-th target has no link back.
    let nodes = || (0..count).map(Node::new);
    let one_sided: Vec<u16> = nodes()
        .zip(links)
        .map(|(a, own)| {
            let bits = own.targets.iter().enumerate().map(|(k, &b)| {
                let back = b == Node::NONE || links[b.index()].targets.contains(&a);
                u16::from(!back) << k
            });
            bits.sum()
        })
        .collect();
    let pairs = || {
        nodes()
            .zip(links.iter().zip(&one_sided))
            .flat_map(|(a, (own, &one_sided))| {
                let targets = own
                    .targets
                    .iter()
                    .enumerate()
                    .filter(|x| *x.1 != Node::NONE);
                targets.map(move |(k, &b)| (a, b, one_sided >> k & 1 == 1))
            })
    };
    let mut starts = vec![0usize; count + 1];
    for (a, b, one_sided) in pairs() {
        starts[a.index() + 1] += 1;
        starts[b.index() + 1] += usize::from(one_sided);
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut all = vec![Node::NONE; starts[count]];
    for (a, b, one_sided) in pairs() {
        all[next[a.index()]] = b;
        next[a.index()] += 1;
        if one_sided {
            all[next[b.index()]] = a;
            next[b.index()] += 1;
        }
    }
    (starts, all)
}
