//! Seams: where two faces meet, edge by edge of the mesh.

use super::angle::Meeting;
use super::corners::Corners;
use super::faces::Faces;
use super::ground::Ground;
use super::trails::{Side, Trail, Way, trails};
use super::{Crease, CreaseAngle, Creases};
use crate::execute::{self, Execute};
use crosscap_core::squared_distance;

/// Edges that a job takes at a time.
const EDGES_AT_ONCE: usize = 32;

/// Radius in edges of the mesh from which a bend is told from a crease.
const RESOLVED: f64 = 2.0;

/// A curve in which two faces meet.
struct Seam {
    faces: [u32; 2],
    /// Where the sheets of the two faces meet, in order, from edge to edge.
    meetings: Vec<Meeting>,
    /// For an arc the sides at both ends.
    ends: Option<[Side; 2]>,
    /// Length of the line through the middles of the edges, unit of the data.
    length: f64,
    /// Number of edges.
    edges: usize,
}

/// All seams of a mesh.
pub(super) struct Seams<'g, 'a> {
    ground: &'g Ground<'a>,
    all: Vec<Seam>,
}

impl<'g, 'a> Seams<'g, 'a> {
    pub(super) fn between(ground: &'g Ground<'a>, faces: &Faces, execute: &dyn Execute) -> Self {
        let parted: Vec<[u32; 2]> = (ground.edges.iter().copied())
            .filter(|&e| faces.parted(e).is_some())
            .collect();
        let mut at_seam = vec![false; faces.of.len()];
        for &v in parted.iter().flatten() {
            at_seam[v as usize] = true;
        }
        let meetings = execute::map_blocks(
            execute,
            EDGES_AT_ONCE,
            parted.len(),
            || ground.walk(),
            |walk, k| Meeting::of(ground, parted[k], &faces.of, &at_seam, walk),
        );
        let seam = |Trail { edges, ends }| {
            let between = |&k: &u32| ground.mean(&parted[k as usize]);
            let middles: Vec<Vec<f64>> = edges.iter().map(between).collect();
            let own = edges.iter().filter_map(|&k| meetings[k as usize].clone());
            Some(Seam {
                faces: faces.parted(parted[*edges.first()? as usize])?,
                meetings: own.collect(),
                length: length(&middles, ends.is_none()),
                ends,
                edges: edges.len(),
            })
        };
        let all = trails(ground, faces, &parted).into_iter();
        Self {
            ground,
            all: all.filter_map(seam).collect(),
        }
    }

    /// Pairs of faces that continue each other.
    pub(super) fn smooth(&self) -> Vec<[u32; 2]> {
        let smooth = |s: &&Seam| !self.is_contact(s) && !self.is_sharp(s);
        self.all.iter().filter(smooth).map(|s| s.faces).collect()
    }

    /// Whether a seam is part of a corner: of four faces that meet in a point two have a short seam in common.
    fn is_contact(&self, seam: &Seam) -> bool {
        let ends = seam.ends.iter().flatten();
        ends.filter(|x| x.way == Way::Corner).count() == 2
            && seam.length <= self.ground.limits.contact * self.ground.edge
    }

    fn is_sharp(&self, seam: &Seam) -> bool {
        let limits = self.ground.limits;
        let sharp =
            |m: &&Meeting| m.angle <= limits.widest && 180.0 - m.angle >= limits.bends * m.bend;
        let sharp = seam.meetings.iter().filter(sharp).count() as f64;
        seam.edges >= limits.places && sharp >= limits.share * seam.edges as f64
    }

    /// The seams, none of which is smooth, as creases with the corners in which they end.
    pub(super) fn creases(mut self, faces: &Faces) -> Creases {
        let all = std::mem::take(&mut self.all);
        let (contacts, mut seams): (Vec<Seam>, Vec<Seam>) =
            all.into_iter().partition(|s| self.is_contact(s));
        seams.sort_by_key(|s| s.ends.is_some());
        let ends = |seams: &[Seam]| seams.iter().map(|s| s.ends).collect::<Vec<_>>();
        let corners = Corners::of(self.ground, &ends(&seams), &ends(&contacts));
        let creases = seams.into_iter().map(|seam| {
            let ends = seam.ends.map(|ends| ends.map(|side| corners.end(side)));
            crease(seam, ends)
        });
        Creases {
            faces: faces.count,
            resolution: RESOLVED * self.ground.edge,
            creases: creases.collect(),
            vertex_face: faces.of.clone(),
            corners: corners.found,
        }
    }
}

fn crease(seam: Seam, ends: Option<[super::CreaseEnd; 2]>) -> Crease {
    let mut angles: Vec<f64> = seam.meetings.iter().map(|m| m.angle).collect();
    angles.sort_unstable_by(f64::total_cmp);
    let angle = |at: usize| angles.get(at).copied().unwrap_or(180.0);
    let last = angles.len().saturating_sub(1);
    let places: Vec<Vec<f64>> = seam.meetings.into_iter().map(|m| m.place).collect();
    Crease {
        circle: ends.is_none(),
        faces: seam.faces,
        angle: CreaseAngle {
            min: angle(0),
            median: angle(last / 2),
            max: angle(last),
        },
        length: length(&places, ends.is_none()),
        ends,
        places,
    }
}

/// Length of a line from place to place.
fn length(places: &[Vec<f64>], closed: bool) -> f64 {
    let step = |(a, b): (&Vec<f64>, &Vec<f64>)| squared_distance(a, b).sqrt();
    let steps = places.windows(2).map(|x| step((&x[0], &x[1])));
    let back = places.last().zip(places.first()).filter(|_| closed);
    steps.sum::<f64>() + back.map_or(0.0, step)
}
