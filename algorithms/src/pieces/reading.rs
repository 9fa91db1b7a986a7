//! What the pieces are and how they meet, in a form that two meshes of one surface have in common.

use super::{CurveEnd, Pieces};
use serde::Serialize;

/// What a mesh is and how it crosses itself, whatever order its vertices, pieces and curves have and wherever they
/// lie: two meshes of one surface have equal readings. See [`Pieces::reading`].
///
/// Lengths and angles are not in it, for they differ from mesh to mesh.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Reading {
    /// For every piece its surface and the curves and points in which it meets others or itself, sorted.
    pieces: Vec<String>,
    /// For every curve and every point in which sheets meet what comes together there, sorted.
    meetings: Vec<String>,
}

impl Pieces {
    /// The reading of these pieces.
    ///
    /// Pieces are told apart by their surface and by what meets on them. Different readings mean different surfaces;
    /// equal ones mean the same but for pieces of one kind that only differ in whose neighbors they are neighbors of.
    ///
    /// O(m log m) for m pieces, curves and points.
    ///
    /// ```
    /// use crosscap_algorithms::pieces::pieces;
    /// use crosscap_core::{Complex, Mesh, PointCloud};
    /// // The two sheets of a pair of triangles with a corner in common, in either order.
    /// let places = vec![0., 0., 0., 1., 0., 0., 0., 1., 0., -1., 0., 1., 0., -1., 1.];
    /// let mesh = |triangles| {
    ///     let complex = Complex::new(5, triangles, vec![]).unwrap();
    ///     Mesh::new(complex, PointCloud::new(3, places.clone()).unwrap(), vec![-1; 5]).unwrap()
    /// };
    /// let one = pieces(&mesh(vec![[0, 1, 2], [0, 3, 4]])).unwrap();
    /// let other = pieces(&mesh(vec![[0, 3, 4], [0, 1, 2]])).unwrap();
    /// assert_eq!(one.reading(), other.reading());
    /// ```
    pub fn reading(&self) -> Reading {
        let mut kinds: Vec<String> = (self.pieces.iter())
            .map(|piece| piece.surface.to_string())
            .collect();
        let around = self.told_by(&kinds);
        for (piece, kind) in kinds.iter_mut().enumerate() {
            let mut own: Vec<&str> = (around.iter())
                .filter(|meeting| meeting.pieces.contains(&(piece as u32)))
                .map(|meeting| meeting.told.as_str())
                .collect();
            own.sort_unstable();
            *kind = format!("{kind} [{}]", own.join("; "));
        }
        let mut meetings: Vec<String> = self.told_by(&kinds).into_iter().map(|m| m.told).collect();
        meetings.sort_unstable();
        kinds.sort_unstable();
        Reading {
            pieces: kinds,
            meetings,
        }
    }

    /// Every curve and point in which sheets meet, told by the kinds of their pieces.
    fn told_by(&self, kinds: &[String]) -> Vec<Meeting> {
        let kind = |piece: &u32| kinds[*piece as usize].as_str();
        let of = |pieces: &[u32]| sorted(pieces.iter().map(kind));
        let mut all = Vec::new();
        for curve in &self.curves {
            let over = curve.preimages.iter().map(|p| {
                let way = (p.circle, p.covers, p.sidedness);
                format!("{} {way:?}", kind(&p.piece))
            });
            let ends = curve.ends.map(|ends| {
                let mut ends = ends.map(end);
                ends.sort_unstable();
                ends
            });
            all.push(Meeting {
                told: format!(
                    "double curve {} {ends:?} {} over {}",
                    curve.circle,
                    curve.multiple_points.len(),
                    sorted(over)
                ),
                pieces: curve.pieces(),
            });
        }
        all.extend(self.junctions.iter().map(|junction| Meeting {
            told: format!(
                "junction {} of {} in {}",
                junction.circle,
                junction.cells,
                of(&junction.pieces)
            ),
            pieces: junction.pieces.clone(),
        }));
        all.extend(self.contacts.iter().map(|contact| Meeting {
            told: format!("contact of {}", of(&contact.pieces)),
            pieces: contact.pieces.clone(),
        }));
        all.extend(self.multiple_points.iter().map(|point| Meeting {
            told: format!("point of {} sheets", point.sheets),
            pieces: Vec::new(),
        }));
        all.extend(self.bare_curves.iter().map(|curve| {
            let met = curve.meetings.iter();
            let told = sorted(met.clone().map(|m| format!("{} {}", m.end, of(&m.pieces))));
            Meeting {
                told: format!("bare curve {} at {told}", curve.circle),
                pieces: met.flat_map(|m| m.pieces.iter().copied()).collect(),
            }
        }));
        all
    }
}

/// A curve or a point in which sheets meet.
struct Meeting {
    told: String,
    pieces: Vec<u32>,
}

/// In order, and in one line.
fn sorted<T: AsRef<str> + Ord>(items: impl Iterator<Item = T>) -> String {
    let mut items: Vec<T> = items.collect();
    items.sort_unstable();
    let items: Vec<&str> = items.iter().map(AsRef::as_ref).collect();
    format!("({})", items.join(", "))
}

fn end(end: CurveEnd) -> &'static str {
    match end {
        CurveEnd::Pinch => "pinch",
        CurveEnd::Boundary => "boundary",
        CurveEnd::Singular => "singular",
    }
}
