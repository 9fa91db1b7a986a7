//! Where curves stop, and ends that go on where another stops.

use super::sweep::sweep;
use crosscap_core::squared_distance;

/// The ends of a part of a curve that stop at nothing: no corner is joined to them, and all that is near
/// them is on one side. None on a closed curve; a single node is one end.
pub(super) fn free_ends(
    graph: &[Vec<(usize, f64)>],
    part: &[usize],
    first_corner: usize,
    distance: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    let inside = |k: usize| part.binary_search(&k).is_ok();
    let farthest = |from: usize| sweep(graph, &[from], inside).0.last().map_or(from, |x| x.0);
    let one = farthest(part[0]);
    let other = farthest(one);
    let mut ends = vec![one, other];
    ends.dedup();
    ends.retain(|&end| {
        let around = &graph[end];
        let far = around.iter().map(|x| x.1).fold(0.0, f64::max);
        around.iter().all(|&(k, _)| k < first_corner)
            && around
                .iter()
                .enumerate()
                .all(|(x, &(a, _))| around[..x].iter().all(|&(b, _)| distance(a, b) <= far))
    });
    ends
}

/// Pairs of free ends that go on where the other stops, at most `limit` apart, nearest first and each end
/// once: where the points of a curve have a gap. A part of a single node takes two.
pub(super) fn bridges<'p>(
    graph: &[Vec<(usize, f64)>],
    ends: &[Vec<usize>],
    place: impl Fn(usize) -> &'p [f64],
    limit: f64,
    parted: impl Fn(usize, usize) -> bool,
) -> Vec<(usize, usize, f64)> {
    // Whether `to` is ahead of the end of a curve.
    let ahead = |end: usize, to: usize| {
        let back = graph[end].iter().max_by(|a, b| a.1.total_cmp(&b.1));
        back.is_none_or(|&(back, _)| {
            let [p, q, r] = [back, end, to].map(&place);
            (0..p.len())
                .map(|i| (q[i] - p[i]) * (r[i] - q[i]))
                .sum::<f64>()
                > 0.0
        })
    };
    let mut free: Vec<usize> = ends.iter().flatten().copied().collect();
    free.sort_unstable();
    let mut pairs = Vec::new();
    for (x, &a) in free.iter().enumerate() {
        for &b in &free[..x] {
            let d = squared_distance(place(a), place(b)).sqrt();
            let joined = graph[a].iter().any(|&(k, _)| k == b);
            if d <= limit && !joined && !parted(a, b) && ahead(a, b) && ahead(b, a) {
                pairs.push((d, b, a));
            }
        }
    }
    pairs.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut slots: Vec<usize> = free
        .iter()
        .map(|&k| if graph[k].is_empty() { 2 } else { 1 })
        .collect();
    let mut out = Vec::new();
    for (d, a, b) in pairs {
        let at = [a, b].map(|k| free.binary_search(&k).unwrap_or(0));
        if at.iter().all(|&i| slots[i] > 0) {
            at.iter().for_each(|&i| slots[i] -= 1);
            out.push((a, b, d));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::sweep::components;
    use super::*;

    const BRIDGE: f64 = 2.0;

    /// Nodes within `reach` of each other joined.
    fn graph(places: &[[f64; 2]], reach: f64) -> Vec<Vec<(usize, f64)>> {
        let far = |a: usize, b: usize| squared_distance(&places[a], &places[b]).sqrt();
        (0..places.len())
            .map(|a| {
                let near = (0..places.len()).filter(|&b| b != a && far(a, b) <= reach);
                near.map(|b| (b, far(a, b))).collect()
            })
            .collect()
    }

    fn found(places: &[[f64; 2]]) -> Vec<[usize; 2]> {
        let graph = graph(places, 1.0);
        let distance = |a: usize, b: usize| squared_distance(&places[a], &places[b]).sqrt();
        let ends: Vec<Vec<usize>> = components(&graph, places.len())
            .iter()
            .map(|part| free_ends(&graph, part, places.len(), distance))
            .collect();
        let found = bridges(&graph, &ends, |k| &places[k][..], BRIDGE, |_, _| false);
        found.iter().map(|&(a, b, _)| [a, b]).collect()
    }

    fn circle(turns: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
        turns
            .map(|t| std::f64::consts::TAU * t)
            .map(|t| [5.0 * t.cos(), 5.0 * t.sin()])
            .collect()
    }

    #[test]
    fn a_closed_curve_is_closed_over_a_gap_of_its_points() {
        let steps = |k: usize| k as f64 / 100.0;
        assert_eq!(found(&circle((0..100).map(steps))), [] as [[usize; 2]; 0]);
        assert_eq!(found(&circle((0..97).map(steps))), [[0, 96]]);
        assert_eq!(found(&circle((0..92).map(steps))), [] as [[usize; 2]; 0]);
        let two_gaps: Vec<_> = circle((0..97).filter(|k| !(40..43).contains(k)).map(steps));
        assert_eq!(found(&two_gaps), [[39, 40], [0, 93]]);
    }

    #[test]
    fn ends_side_by_side_are_not_joined() {
        let side = |y: f64| (0..20).map(move |k| [0.25 * f64::from(k), y]);
        let places: Vec<_> = side(0.0).chain(side(1.4)).collect();
        assert_eq!(found(&places), [] as [[usize; 2]; 0]);
    }

    #[test]
    fn a_bare_curve_ends_on_both_sides() {
        let places: Vec<_> = (0..20).map(|k| [0.25 * f64::from(k), 0.0]).collect();
        let graph = graph(&places, 2.0);
        let part: Vec<usize> = (0..20).collect();
        let distance = |a: usize, b: usize| squared_distance(&places[a], &places[b]).sqrt();
        let mut ends = free_ends(&graph, &part, 20, distance);
        ends.sort_unstable();
        assert_eq!(ends, [0, 19]);
    }
}
