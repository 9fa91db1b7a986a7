//! Corners: where three creases and more meet.

use super::ground::Ground;
use super::trails::{Side, Way};
use super::{Corner, CreaseEnd};
use std::collections::BTreeMap;

/// The sides at both ends of a seam, none of a closed one.
type Ends = Option<[Side; 2]>;

/// The corners of a mesh, and which triangles of three faces are at each.
pub(super) struct Corners {
    pub(super) found: Vec<Corner>,
    at: BTreeMap<u32, u32>,
}

impl Corners {
    /// Of the ends of seams that are creases, and of those that are parts of corners: triangles of three faces that one of these joins are
    /// at one corner.
    pub(super) fn of(ground: &Ground<'_>, creases: &[Ends], contacts: &[Ends]) -> Self {
        let triangles = |ends: &Ends| -> Vec<u32> {
            let ends = ends.iter().flatten();
            ends.filter(|side| side.way == Way::Corner)
                .filter_map(|side| side.triangle)
                .collect()
        };
        let ends: Vec<u32> = creases.iter().flat_map(triangles).collect();
        let joined = contacts.iter().map(triangles);
        let mut groups: Vec<Vec<u32>> = joined.collect();
        groups.extend(ends.iter().map(|&t| vec![t]));
        let mut parts: Vec<Vec<u32>> = Vec::new();
        for mut group in groups {
            // Few triangles are at corners.
            parts.retain_mut(|part| {
                let apart = part.iter().all(|t| !group.contains(t));
                if !apart {
                    group.append(part);
                }
                apart
            });
            group.sort_unstable();
            group.dedup();
            parts.push(group);
        }
        parts.sort_unstable();
        let mut out = Self {
            found: Vec::new(),
            at: BTreeMap::new(),
        };
        for part in parts {
            let creases = ends.iter().filter(|t| part.contains(t)).count();
            if creases < 3 {
                continue;
            }
            let own = out.found.len() as u32;
            out.at.extend(part.iter().map(|&t| (t, own)));
            let vertices: Vec<u32> = (part.iter())
                .flat_map(|&t| ground.mesh.complex.triangles[t as usize])
                .collect();
            out.found.push(Corner {
                place: ground.mean(&vertices),
                creases,
            });
        }
        out
    }

    /// Where a crease ends that comes to a side.
    pub(super) fn end(&self, side: Side) -> CreaseEnd {
        let corner = side.triangle.and_then(|t| self.at.get(&t));
        match (side.way, corner) {
            (Way::Corner, Some(&at)) => CreaseEnd::Corner(at),
            (Way::Boundary, _) => CreaseEnd::Boundary,
            _ => CreaseEnd::Elsewhere,
        }
    }
}
