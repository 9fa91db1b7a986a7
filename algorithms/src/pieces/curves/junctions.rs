//! Curves in which three cells meet, or five and more.

use super::angle::AngleSum;
use super::trail::{Links, Trail, trails, vertices_and_length};
use crate::orthogonal::dot;
use crate::pieces::gluing::Gluing;
use crate::pieces::normalization::Normalization;
use crate::pieces::straightness;
use crate::pieces::{CrossingAngle, Junction};

/// Curves in which three, or five and more, triangles meet.
pub(in crate::pieces) fn junctions(gluing: &Gluing<'_>, normal: &Normalization) -> Vec<Junction> {
    let count = |e: u32| gluing.sides.at(e as usize).len();
    let edges: Vec<u32> = (0..gluing.sides.edges.len() as u32)
        .filter(|&e| count(e) == 3 || count(e) > 4)
        .collect();
    let mut ends = Vec::new();
    for (d, &e) in edges.iter().enumerate() {
        for (end, v) in gluing.sides.edges[e as usize].into_iter().enumerate() {
            ends.push((v, count(e), d, end));
        }
    }
    ends.sort_unstable();
    let mut links: Links = vec![[None; 2]; edges.len()];
    for same in ends.chunk_by(|x, y| x.0 == y.0) {
        if let &[(_, n, d, end), (_, m, other, other_end)] = same
            && n == m
        {
            links[d][end] = Some((other as u32, other_end));
            links[other][other_end] = Some((d as u32, end));
        }
    }
    let trails = trails(&links);
    let describe = |trail: &Trail| {
        let (vertices, length) = vertices_and_length(gluing, &edges, trail);
        let at = trail.steps.iter();
        let at = at.flat_map(|&(d, _)| gluing.sides.at(edges[d as usize] as usize));
        let mut pieces: Vec<u32> = at.map(|&s| normal.triangle_piece[s as usize / 3]).collect();
        pieces.sort_unstable();
        pieces.dedup();
        Junction {
            circle: trail.circle,
            cells: count(edges[trail.steps[0].0 as usize]) as u32,
            length,
            vertices,
            pieces,
            angle: junction_angle(gluing, &edges, trail),
        }
    };
    trails.iter().map(describe).collect()
}

/// Angles between each two of three cells.
fn junction_angle(gluing: &Gluing<'_>, edges: &[u32], trail: &Trail) -> Option<CrossingAngle> {
    let mut angles = AngleSum::default();
    for &(d, _) in &trail.steps {
        let e = edges[d as usize] as usize;
        let at = gluing.sides.at(e);
        if at.len() != 3 {
            return None;
        }
        let ends = gluing.sides.edges[e];
        let Some((length, directions)) = straightness::leaving(gluing.mesh, ends, at) else {
            continue;
        };
        for [i, j] in [[0, 1], [1, 2], [0, 2]] {
            angles.add(length, dot(&directions[i], &directions[j]));
        }
    }
    angles.result()
}
