//! Laws of links.

use super::*;
use proptest::prelude::*;

/// Edges of a graph with every edge cut into three.
fn subdivided(count: usize, edges: &[[u32; 2]]) -> (usize, Vec<[u32; 2]>) {
    let mut next = count as u32;
    let mut all = vec![];
    for &[a, b] in edges {
        all.extend([[a, next], [next, next + 1], [next + 1, b]]);
        next += 2;
    }
    (next as usize, all)
}

fn graph() -> impl Strategy<Value = (usize, Vec<[u32; 2]>)> {
    (1usize..7).prop_flat_map(|count| {
        let ends = (0..count as u32, 0..count as u32).prop_map(|(a, b)| [a, b]);
        (Just(count), prop::collection::vec(ends, 0..12))
    })
}

proptest! {
    #[test]
    fn names_of_nodes_do_not_matter((count, edges) in graph(), seed in any::<u64>()) {
        let mut name: Vec<u32> = (0..count as u32).collect();
        let mut state = seed;
        for k in (1..count).rev() {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            name.swap(k, (state >> 33) as usize % (k + 1));
        }
        let marked = |v: usize| v.is_multiple_of(3);
        let renamed: Vec<[u32; 2]> = edges.iter().rev().map(|&[a, b]| {
            [name[b as usize], name[a as usize]]
        }).collect();
        let old = |v: usize| name.iter().position(|&n| n as usize == v).is_some_and(marked);
        prop_assert_eq!(Link::of_graph(count, &edges, marked), Link::of_graph(count, &renamed, old));
    }

    #[test]
    fn points_on_arcs_do_not_matter((count, edges) in graph()) {
        let (more, finer) = subdivided(count, &edges);
        let marked = |v: usize| v < count && v.is_multiple_of(2);
        prop_assert_eq!(Link::of_graph(count, &edges, marked), Link::of_graph(more, &finer, marked));
    }

    #[test]
    fn degrees_count_every_arc_twice((count, edges) in graph()) {
        let link = Link::of_graph(count, &edges, |v| v % 2 == 0);
        let degrees: usize = (0..link.nodes() as u8).map(|v| link.degree(v)).sum();
        prop_assert_eq!(degrees, 2 * link.arcs().len());
        let again = Link::new(link.nodes() as u8, link.arcs(), link.circles() as u8);
        prop_assert_eq!(again, Some(link.clone()));
        let plain = Link::of_graph(count, &edges, |_| false);
        prop_assert_eq!(link.without_creases(), plain);
    }
}

#[test]
fn every_named_link_is_told() {
    for kind in LinkKind::NAMED {
        assert_eq!(kind.link().unwrap().kind(), kind, "{kind:?}");
    }
    for cells in 0..9u8 {
        let link = Link::suspension(cells);
        assert_eq!(link.nodes(), 2);
        assert!((0..2).all(|v| link.degree(v) == usize::from(cells)));
    }
    assert_eq!(Link::suspension(2).kind(), LinkKind::Circle);
    for cells in 5..9u8 {
        assert_eq!(Link::suspension(cells).kind(), LinkKind::Book);
        let leaves: Vec<[u8; 2]> = (1..=cells).map(|leaf| [0, leaf]).collect();
        let end = Link::new(1 + cells, &leaves, 0).unwrap();
        assert_eq!(end.kind(), LinkKind::BookEnd);
        let loops = Link::new(
            cells,
            &[&leaves[..usize::from(cells) - 1], &[[0, 0]]].concat(),
            0,
        );
        assert_eq!(loops.unwrap().kind(), LinkKind::Other);
    }
    assert_eq!(Link::new(2, &[[0, 2]], 0), None);
    let arcs = vec![[1, 0], [1, 1]];
    let raw = Unchecked {
        nodes: 2,
        arcs,
        circles: 0,
    };
    assert_eq!(Link::try_from(raw).unwrap().kind(), LinkKind::SideSheetEnd);
    let raw = Unchecked {
        nodes: 1,
        arcs: vec![[0, 1]],
        circles: 0,
    };
    assert!(Link::try_from(raw).unwrap_err().is_input());
}

#[test]
fn links_of_the_same_degrees_are_told_apart() {
    let kind = |nodes, arcs: &[[u8; 2]]| Link::new(nodes, arcs, 0).unwrap().kind();
    assert_eq!(kind(2, &[[0, 1], [0, 1], [0, 0], [1, 1]]), LinkKind::Other);
    assert_eq!(kind(2, &[[0, 1], [0, 0], [1, 1]]), LinkKind::Other);
    let two_pairs = [[0, 1], [0, 1], [2, 3], [2, 3], [0, 2], [1, 3]];
    assert_eq!(kind(4, &two_pairs), LinkKind::Other);
    assert_eq!(kind(4, &[[0, 1], [2, 3]]), LinkKind::Split);
    assert_eq!(kind(3, &[[0, 1]]), LinkKind::Split);
    assert_eq!(kind(3, &[]), LinkKind::Split);
    assert_eq!(kind(0, &[]), LinkKind::Split);
    assert_eq!(kind(1, &[[0, 0]; 3]), LinkKind::Other);
}

#[test]
fn links_are_put_in_words() {
    let said = |kind: LinkKind| kind.link().unwrap().to_string();
    assert_eq!(said(LinkKind::Circle), "a circle");
    assert_eq!(said(LinkKind::Arc), "an arc");
    assert_eq!(
        said(LinkKind::Double),
        "two nodes of degree 4 joined by four arcs"
    );
    assert_eq!(
        said(LinkKind::DoubleEnd),
        "a node of degree 4 with four leaves"
    );
    assert_eq!(said(LinkKind::Pinch), "a node of degree 4 with two loops");
    assert_eq!(
        said(LinkKind::SideSheetEnd),
        "a node of degree 3 with a loop and a leaf"
    );
    assert_eq!(
        said(LinkKind::Triple),
        "six nodes of degree 4 joined by twelve arcs"
    );
    assert_eq!(said(LinkKind::IsolatedCrossing), "two circles");
    assert_eq!(said(LinkKind::CurveThroughSheet), "a circle and two points");
    let three = Link::new(6, &[[0, 1], [2, 3], [4, 5]], 0).unwrap();
    assert_eq!(three.to_string(), "three arcs");
    let mixed = Link::new(3, &[[0, 0], [0, 1], [1, 2]], 0).unwrap();
    assert_eq!(
        mixed.to_string(),
        "two nodes of degrees 2, 3 joined by an arc with a loop and a leaf"
    );
}
