//! Vertices in which sheets touch.

use crate::pieces::PointContact;
use crate::pieces::gluing::Gluing;
use crate::pieces::normalization::Normalization;

/// Vertices where several sheets touch and no curve runs in which they meet.
pub(in crate::pieces) fn point_contacts(
    gluing: &Gluing<'_>,
    normal: &Normalization,
) -> Vec<PointContact> {
    let mut on_curve = vec![false; gluing.mesh.complex.vertices];
    for (e, ends) in gluing.sides.edges.iter().enumerate() {
        if gluing.sides.at(e).len() > 2 {
            ends.iter().for_each(|&v| on_curve[v as usize] = true);
        }
    }
    let mut piece = vec![u32::MAX; normal.original_vertex.len()];
    for (c, &sheet) in normal.sheet.iter().enumerate() {
        piece[sheet as usize] = normal.triangle_piece[c / 3];
    }
    // Sheets of one vertex have consecutive numbers.
    let sheets: Vec<(u32, u32)> = normal
        .original_vertex
        .iter()
        .zip(&piece)
        .filter(|&(_, &p)| p != u32::MAX)
        .map(|(&v, &p)| (v, p))
        .collect();
    sheets
        .chunk_by(|x, y| x.0 == y.0)
        .filter(|at| at.len() > 1 && !on_curve[at[0].0 as usize])
        .map(|at| {
            let mut pieces: Vec<u32> = at.iter().map(|&(_, p)| p).collect();
            pieces.sort_unstable();
            PointContact {
                vertex: at[0].0,
                pieces,
            }
        })
        .collect()
}
