//! Curves of edges without a triangle.

use super::trail::{Links, Trail, edge_length, trails};
use crate::pieces::gluing::Gluing;
use crate::pieces::normalization::Normalization;
use crate::pieces::{BareCurve, CurveMeeting};

/// Curves of edges without a triangle.
pub(in crate::pieces) fn bare_curves(
    gluing: &Gluing<'_>,
    normal: &Normalization,
) -> Vec<BareCurve> {
    let links = links(normal);
    let touching = Touching::new(normal);
    let original = |v: u32| normal.original_vertex[v as usize];
    let describe = |trail: &Trail| {
        let edges = trail
            .steps
            .iter()
            .map(|&(d, end)| (normal.bare[d as usize], end));
        let mut vertices: Vec<u32> = edges
            .clone()
            .map(|(ends, end)| original(ends[end]))
            .collect();
        if let Some((ends, end)) = edges.clone().next_back().filter(|_| !trail.circle) {
            vertices.push(original(ends[1 - end]));
        }
        let last = vertices.len() - 1;
        let meetings = vertices.iter().enumerate().filter_map(|(k, &vertex)| {
            let pieces = touching.at(vertex);
            (!pieces.is_empty()).then_some(CurveMeeting {
                vertex,
                pieces,
                end: !trail.circle && (k == 0 || k == last),
            })
        });
        BareCurve {
            circle: trail.circle,
            length: edges
                .map(|(ends, _)| edge_length(gluing.mesh, ends.map(original)))
                .sum(),
            meetings: meetings.collect(),
            vertices,
        }
    };
    trails(&links).iter().map(describe).collect()
}

/// Which bare edges continue each other: at a bare vertex of the normalization nothing but bare edges meets.
fn links(normal: &Normalization) -> Links {
    let mut ends: Vec<(u32, usize, usize)> = Vec::new();
    for (d, bare) in normal.bare.iter().enumerate() {
        ends.extend([(bare[0], d, 0), (bare[1], d, 1)]);
    }
    ends.sort_unstable();
    let mut links: Links = vec![[None; 2]; normal.bare.len()];
    for same in ends.chunk_by(|x, y| x.0 == y.0) {
        if let &[(_, d, end), (_, other, other_end)] = same {
            links[d][end] = Some((other as u32, other_end));
            links[other][other_end] = Some((d as u32, end));
        }
    }
    links
}

/// The pieces at every vertex of the mesh.
struct Touching {
    /// Vertices with a piece that has a sheet there, sorted.
    all: Vec<(u32, u32)>,
}

impl Touching {
    fn new(normal: &Normalization) -> Self {
        let corners = normal.sheet.iter().enumerate();
        let mut all: Vec<(u32, u32)> = corners
            .map(|(c, &sheet)| {
                let vertex = normal.original_vertex[sheet as usize];
                (vertex, normal.triangle_piece[c / 3])
            })
            .collect();
        all.sort_unstable();
        all.dedup();
        Self { all }
    }

    fn at(&self, vertex: u32) -> Vec<u32> {
        let from = self.all.partition_point(|s| s.0 < vertex);
        let at = self.all[from..].iter().take_while(|s| s.0 == vertex);
        at.map(|s| s.1).collect()
    }
}
