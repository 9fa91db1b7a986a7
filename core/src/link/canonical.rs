//! One form for all links that are the same but for the names of their nodes.

/// The arcs of a link of `nodes` nodes in their canonical form: of all renamings that keep the order of the nodes' colors, the one with
/// the least list. Beyond `most` nodes renamings are not tried out, and only the colors are put in order.
pub(super) fn arcs(nodes: u8, arcs: &[[u8; 2]], most: usize) -> Vec<[u8; 2]> {
    let colors = colors(nodes, arcs);
    let mut order: Vec<u8> = (0..nodes).collect();
    order.sort_by_key(|&v| (colors[usize::from(v)], v));
    let mut best = renamed(arcs, &order);
    if usize::from(nodes) <= most {
        let same = |k: usize, order: &[u8]| {
            (k..order.len())
                .take_while(|&j| colors[usize::from(order[j])] == colors[usize::from(order[k])])
                .collect::<Vec<_>>()
        };
        permute(&mut order, 0, &same, &mut |order| {
            let arcs = renamed(arcs, order);
            if arcs < best {
                best = arcs;
            }
        });
    }
    best
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
fn renamed(arcs: &[[u8; 2]], order: &[u8]) -> Vec<[u8; 2]> {
    let mut name = [0u8; 256];
    for (k, &v) in (0u8..).zip(order) {
        name[usize::from(v)] = k;
    }
    let mut arcs: Vec<[u8; 2]> = arcs
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
fn colors(nodes: u8, arcs: &[[u8; 2]]) -> Vec<usize> {
    let mut signature: Vec<Vec<usize>> = (0..nodes)
        .map(|v| {
            let degree = arcs.iter().flatten().filter(|&&end| end == v).count();
            let loops = arcs.iter().filter(|arc| **arc == [v, v]).count();
            vec![degree, loops]
        })
        .collect();
    let mut colors = ranks(&signature);
    loop {
        for (v, own) in signature.iter_mut().enumerate() {
            let mut around: Vec<usize> = arcs
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
