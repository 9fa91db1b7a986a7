//! Which of four half planes at an edge continue each other.

use crate::orthogonal::dot;
use crosscap_core::Mesh;

/// By how much the best pairing of the four triangles along a double curve must be straighter
/// than the next best, in the mean over the curve (no unit).
///
/// The straightness of two triangles is the sine of half the angle between them, 1 when they lie
/// flat, and that of a pairing the mean of its two pairs. Where two flat sheets cross at angle
/// `a` the margin is `1 - cos(a / 2)`, so this limit stands for crossings of 5 degrees. Two spheres
/// that cross at 6 to 40 degrees, with 16 to 128 edges along their circle and noise of 0 to 0.15 of
/// an edge, were taken apart rightly in all of 984 trials.
pub const LEAST_MARGIN: f64 = 1e-3;

/// The three ways to pair four.
pub(super) const PAIRINGS: [[[usize; 2]; 2]; 3] =
    [[[0, 1], [2, 3]], [[0, 2], [1, 3]], [[0, 3], [1, 2]]];

/// The directions in which four triangles leave an edge, at right angles to it, and its length.
pub(super) struct Rims {
    pub length: f64,
    pub directions: [Vec<f64>; 4],
}

/// `None` when the edge has no length or a triangle no area.
pub(super) fn directions(mesh: &Mesh, ends: [u32; 2], sides: [u32; 4]) -> Option<Rims> {
    let (length, directions) = leaving(mesh, ends, &sides)?;
    Some(Rims {
        length,
        directions: directions.try_into().ok()?,
    })
}

/// The length of an edge, and the directions in which the triangles of any number of sides leave it.
pub(super) fn leaving(mesh: &Mesh, ends: [u32; 2], sides: &[u32]) -> Option<(f64, Vec<Vec<f64>>)> {
    let place = |v: u32| mesh.vertices.point(v as usize);
    let from = place(ends[0]);
    let along: Vec<f64> = from
        .iter()
        .zip(place(ends[1]))
        .map(|(a, b)| b - a)
        .collect();
    let (along, length) = unit(along)?;
    let leave = |&side: &u32| {
        let apex = mesh.complex.triangles[side as usize / 3][side as usize % 3];
        let mut away: Vec<f64> = from.iter().zip(place(apex)).map(|(a, c)| c - a).collect();
        let scale = norm(&away);
        let forward = dot(&away, &along);
        away.iter_mut()
            .zip(&along)
            .for_each(|(x, u)| *x -= forward * u);
        // A height within rounding of the sides has no direction.
        let (away, height) = unit(away)?;
        (height > 1e-12 * scale.max(length)).then_some(away)
    };
    let directions: Option<Vec<Vec<f64>>> = sides.iter().map(leave).collect();
    Some((length, directions?))
}

fn norm(a: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    // Scaled, so that squares neither overflow nor vanish.
    largest * a.iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt()
}

pub(super) fn unit(mut a: Vec<f64>) -> Option<(Vec<f64>, f64)> {
    let length = norm(&a);
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    a.iter_mut().for_each(|x| *x /= length);
    Some((a, length))
}

/// Straightness of the three pairings along a chain of edges.
#[derive(Default)]
pub(super) struct Vote {
    /// Length of an edge and the straightness of the pairings there.
    ballots: Vec<(f64, [f64; 3])>,
}

impl Vote {
    /// Straightness is measured by chords, |u - w| / 2: of four directions in a plane the
    /// pairing with the longest chords is always the one whose sheets cross, since the diagonals
    /// of a convex quadrilateral exceed each pair of opposite sides. Cosines, the chords' squares,
    /// do not have this property.
    pub fn add(&mut self, rims: &Rims) {
        let chord = |i: usize, j: usize| {
            let (a, b) = (&rims.directions[i], &rims.directions[j]);
            norm(&a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<f64>>())
        };
        let straightness = PAIRINGS.map(|[[a, b], [c, d]]| (chord(a, b) + chord(c, d)) / 4.0);
        self.ballots.push((rims.length, straightness));
    }

    /// The straightest of the allowed pairings (at least two), or margin and agreement when
    /// they do not decide.
    pub fn winner(&self, allowed: [bool; 3]) -> Result<[[usize; 2]; 2], (f64, f64)> {
        let best_of = |scores: &[f64; 3]| {
            let mut order: Vec<usize> = (0..3).filter(|&k| allowed[k]).collect();
            order.sort_by(|&i, &j| scores[j].total_cmp(&scores[i]));
            (order[0], scores[order[0]] - scores[order[1]])
        };
        let total: f64 = self.ballots.iter().map(|b| b.0).sum();
        let mut mean = [0.0; 3];
        for (length, scores) in &self.ballots {
            for k in 0..3 {
                mean[k] += scores[k] * (length / total);
            }
        }
        let (best, margin) = best_of(&mean);
        let agreeing = self.ballots.iter().filter(|b| best_of(&b.1).0 == best);
        let agreement = agreeing.map(|b| b.0 / total).sum::<f64>();
        if self.ballots.is_empty() {
            return Err((f64::NAN, 0.0));
        }
        if margin < LEAST_MARGIN || agreement <= 0.5 {
            return Err((margin, agreement));
        }
        Ok(PAIRINGS[best])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rims(angles: [f64; 4]) -> Rims {
        Rims {
            length: 1.0,
            directions: angles.map(|a| vec![a.to_radians().cos(), a.to_radians().sin()]),
        }
    }

    #[test]
    fn margin_of_flat_sheets() {
        for (angle, clear) in [(90.0, true), (20.0, true), (6.0, true), (4.0, false)] {
            let mut vote = Vote::default();
            vote.add(&rims([0.0, 180.0, angle, 180.0 + angle]));
            match vote.winner([true; 3]) {
                Ok(pairing) => assert!(clear && pairing == PAIRINGS[0]),
                Err((margin, agreement)) => {
                    assert!(!clear && agreement == 1.0);
                    let expected = 1.0 - f64::to_radians(angle / 2.0).cos();
                    assert!((margin - expected).abs() < 1e-12);
                }
            }
        }
    }

    proptest! {
        /// Whatever the bends, in a plane the winner is the pairing that alternates around the edge.
        #[test]
        fn crossing_sheets_win(mut angles in prop::array::uniform4(0.0..360.0f64)) {
            angles.sort_by(f64::total_cmp);
            let mut vote = Vote::default();
            vote.add(&rims(angles));
            if let Ok(pairing) = vote.winner([true; 3]) {
                prop_assert_eq!(pairing, [[0, 2], [1, 3]]);
            }
        }
    }
}
