//! Parts of a mesh that no edge joins, and whose points are as near to each other as points of one sheet.

use super::search::Search;
use crate::balls::BallTree;
use crosscap_core::{Complex, PointCloud, squared_distance};

/// Distance in spacings from which on two parts are apart. The nearest two points of two round cones that meet in their apexes are less than
/// that apart in 92 of 100 samples and more; parts that the program tells apart are about three apart and more.
const APART: f64 = 1.5;

/// A place where the points of two parts are no farther from each other than points of one sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touch {
    /// A vertex next to it.
    pub(super) vertex: u32,
    /// How far the points are apart, in local spacings, the smaller of both.
    pub(super) apart: f64,
}

/// All places where parts touch, nearest first; none where the mesh is one part. The vertices of one part are those that edges join.
///
/// What is told of two such parts is nothing that the points show: they could as well have a point or a curve in common.
/// O(k log n) for k of the n points that are not on the part that has most of them.
pub(super) fn touching(search: &Search<'_>, points: &PointCloud<f64>) -> Vec<Touch> {
    let (mesh, feet) = (search.mesh, search.feet);
    let part_of = parts(&mesh.complex);
    let triangles = &mesh.complex.triangles;
    let mut standing: Vec<Standing> = Vec::new();
    for (&row, &item) in feet.rows.iter().zip(&feet.items) {
        let Some(&corners) = triangles.get(item as usize) else {
            continue;
        };
        let density = search.ground.density_at(corners, [1.0 / 3.0; 3]);
        standing.push(Standing {
            row,
            corners,
            part: part_of[corners[0] as usize],
            spacing: if density > 0.0 {
                density.sqrt().recip()
            } else {
                0.0
            },
        });
    }
    let Some(main) = most(&standing) else {
        return Vec::new();
    };
    let place = |s: &Standing| points.point(s.row as usize);
    let places: Vec<f64> = standing
        .iter()
        .flat_map(|s| place(s).iter().copied())
        .collect();
    let tree = BallTree::new(points.dimension(), &places);
    let mut found = Vec::new();
    for own in standing.iter().filter(|s| s.part != main) {
        let mut nearest = f64::INFINITY;
        tree.within(place(own), APART * own.spacing, |k, square| {
            let other = &standing[k as usize];
            let apart = square.sqrt() / own.spacing.min(other.spacing);
            if other.part != own.part && apart < APART {
                nearest = nearest.min(apart);
            }
        });
        let far = |v: u32| squared_distance(mesh.vertices.point(v as usize), place(own));
        let vertex =
            (own.corners.into_iter()).min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
        let touch = vertex.map(|vertex| Touch {
            vertex,
            apart: nearest,
        });
        found.extend(touch.filter(|t| t.apart < APART));
    }
    found.sort_by(|a, b| a.vertex.cmp(&b.vertex).then(a.apart.total_cmp(&b.apart)));
    found.dedup_by_key(|t| t.vertex);
    found.sort_by(|a, b| a.apart.total_cmp(&b.apart).then(a.vertex.cmp(&b.vertex)));
    found
}

/// A point over a triangle.
struct Standing {
    row: u32,
    corners: [u32; 3],
    part: u32,
    spacing: f64,
}

/// The part that has most of the points; `None` where there are not two.
fn most(standing: &[Standing]) -> Option<u32> {
    let first = standing.first()?.part;
    standing.iter().find(|s| s.part != first)?;
    let mut parts: Vec<u32> = standing.iter().map(|s| s.part).collect();
    parts.sort_unstable();
    let runs = parts.chunk_by(|a, b| a == b);
    runs.max_by_key(|run| run.len()).map(|run| run[0])
}

/// For every vertex the least of those that edges join with it.
fn parts(complex: &Complex) -> Vec<u32> {
    let mut above: Vec<u32> = (0..complex.vertices as u32).collect();
    let mut join = |a: u32, b: u32| {
        let [a, b] = [a, b].map(|v| top(&mut above, v));
        above[a.max(b) as usize] = a.min(b);
    };
    for &[a, b, c] in &complex.triangles {
        join(a, b);
        join(b, c);
    }
    for edge in &complex.curve_edges {
        join(edge.ends[0], edge.ends[1]);
    }
    (0..complex.vertices as u32)
        .map(|v| top(&mut above, v))
        .collect()
}

/// The root of a vertex; the way there is halved.
fn top(above: &mut [u32], mut v: u32) -> u32 {
    while above[v as usize] != v {
        let next = above[v as usize];
        above[v as usize] = above[next as usize];
        v = next;
    }
    v
}
