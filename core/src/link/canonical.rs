//! One form for all links that are the same but for the names of their nodes.

use super::Link;

/// The canonical form: of all renamings that keep the order of the nodes' colors, the one with the least
/// list of arcs.
pub(super) fn of(link: &Link) -> Link {
    let nodes = usize::from(link.nodes);
    let colors = colors(link);
    let mut order: Vec<u8> = (0..link.nodes).collect();
    order.sort_by_key(|&v| (colors[usize::from(v)], v));
    let mut best = renamed(link, &order);
    if nodes <= Link::MOST_NODES {
        let same = |k: usize, order: &[u8]| {
            (k..order.len())
                .take_while(|&j| colors[usize::from(order[j])] == colors[usize::from(order[k])])
                .collect::<Vec<_>>()
        };
        permute(&mut order, 0, &same, &mut |order| {
            let arcs = renamed(link, order);
            if arcs < best {
                best = arcs;
            }
        });
    }
    Link {
        nodes: link.nodes,
        arcs: best,
        circles: link.circles,
    }
}

/// All orders in which nodes of one color, which lie together, change places.
fn permute(
    order: &mut Vec<u8>,
    from: usize,
    same: &impl Fn(usize, &[u8]) -> Vec<usize>,
    found: &mut impl FnMut(&[u8]),
) {
    if from == order.len() {
        return found(order);
    }
    for k in same(from, order) {
        order.swap(from, k);
        permute(order, from + 1, same, found);
        order.swap(from, k);
    }
}

/// The arcs when the node at place k of `order` is called k, sorted.
fn renamed(link: &Link, order: &[u8]) -> Vec<[u8; 2]> {
    let mut name = [0u8; 256];
    for (k, &v) in (0u8..).zip(order) {
        name[usize::from(v)] = k;
    }
    let mut arcs: Vec<[u8; 2]> = link
        .arcs
        .iter()
        .map(|arc| {
            let [a, b] = arc.map(|v| name[usize::from(v)]);
            [a.min(b), a.max(b)]
        })
        .collect();
    arcs.sort_unstable();
    arcs
}

/// Colors that renaming does not change: degree and number of loops first, then again and again the colors
/// of the neighbors, until no more nodes are told apart.
fn colors(link: &Link) -> Vec<usize> {
    let nodes = usize::from(link.nodes);
    let mut signature: Vec<Vec<usize>> = (0..link.nodes)
        .map(|v| {
            let loops = link.arcs.iter().filter(|arc| **arc == [v, v]).count();
            vec![link.degree(v), loops]
        })
        .collect();
    let mut colors = ranks(&signature);
    loop {
        for (v, own) in signature.iter_mut().enumerate() {
            let mut around: Vec<usize> = link
                .arcs
                .iter()
                .flat_map(|&[a, b]| [(a, b), (b, a)])
                .filter(|x| usize::from(x.0) == v)
                .map(|x| colors[usize::from(x.1)])
                .collect();
            around.sort_unstable();
            *own = std::iter::once(colors[v]).chain(around).collect();
        }
        let next = ranks(&signature);
        let count = |colors: &[usize]| colors.iter().max().map_or(0, |m| m + 1);
        if count(&next) == count(&colors) || nodes == 0 {
            return next;
        }
        colors = next;
    }
}

/// Rank of each value among the different ones.
fn ranks(values: &[Vec<usize>]) -> Vec<usize> {
    let mut different: Vec<&Vec<usize>> = values.iter().collect();
    different.sort_unstable();
    different.dedup();
    values
        .iter()
        .map(|v| different.partition_point(|d| *d < v))
        .collect()
}
