//! The edges of a mesh between two faces, one after the other.

use super::faces::Faces;
use super::ground::Ground;

/// How a seam goes on beyond an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Over another edge, by its number.
    On(u32),
    /// There is a third face.
    Corner,
    /// The surface ends.
    Boundary,
    /// There is a vertex on no face.
    Elsewhere,
}

/// One of the two sides of an edge: how the seam goes on there, and through which triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Side {
    /// None where the surface ends.
    pub(super) triangle: Option<u32>,
    pub(super) way: Way,
}

/// Edges that follow each other between the same two faces, and for an arc the sides at both ends.
pub(super) struct Trail {
    pub(super) edges: Vec<u32>,
    pub(super) ends: Option<[Side; 2]>,
}

/// The seams of faces, as trails over `parted`, the edges whose ends are on two faces, sorted.
pub(super) fn trails(ground: &Ground<'_>, faces: &Faces, parted: &[[u32; 2]]) -> Vec<Trail> {
    let sides = sides(ground, faces, parted);
    let mut used = vec![false; parted.len()];
    let mut found = Vec::new();
    let is_end = |side: &Side| !matches!(side.way, Way::On(_));
    let all = || 0..parted.len() as u32;
    // Arcs from their ends first: what is left are circles.
    let at_ends = all().filter(|&k| sides[k as usize].iter().any(is_end));
    for first in at_ends.chain(all()) {
        if used[first as usize] {
            continue;
        }
        let own = sides[first as usize];
        let (mut out, start) = match is_end(&own[0]) {
            true => (own[1], Some(own[0])),
            false => (own[0], is_end(&own[1]).then_some(own[1])),
        };
        let mut edges = vec![first];
        used[first as usize] = true;
        while let Way::On(next) = out.way {
            if used[next as usize] {
                break;
            }
            used[next as usize] = true;
            edges.push(next);
            let [a, b] = sides[next as usize];
            out = if a.triangle == out.triangle { b } else { a };
        }
        let ends = start.map(|start| [start, out]);
        found.push(Trail { edges, ends });
    }
    found
}

/// Both sides of every edge.
fn sides(ground: &Ground<'_>, faces: &Faces, parted: &[[u32; 2]]) -> Vec<[Side; 2]> {
    let boundary = Side {
        triangle: None,
        way: Way::Boundary,
    };
    let mut sides = vec![[boundary; 2]; parted.len()];
    let mut given = vec![0; parted.len()];
    for (t, &[a, b, c]) in ground.mesh.complex.triangles.iter().enumerate() {
        let number = |[a, b]: [u32; 2]| parted.binary_search(&[a.min(b), a.max(b)]).ok();
        let own: Vec<usize> = ([[a, b], [b, c], [a, c]].into_iter())
            .filter_map(number)
            .collect();
        let known = [a, b, c].iter().all(|&v| faces.of[v as usize].is_some());
        for &k in &own {
            let other = own.iter().find(|&&other| other != k);
            let way = match (known, own.len(), other) {
                (true, 2, Some(&other)) => Way::On(other as u32),
                (true, 3, _) => Way::Corner,
                _ => Way::Elsewhere,
            };
            // An edge with more triangles is on a curve, and in no seam.
            if given[k] < 2 {
                sides[k][given[k]] = Side {
                    triangle: Some(t as u32),
                    way,
                };
                given[k] += 1;
            }
        }
    }
    sides
}
