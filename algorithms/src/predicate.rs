//! Exact planar test of how two triangles of a chart meet.

use crosscap_core::{ChartTriangle, CompatibilityTest, Meeting};
use robust::{Coord, orient2d};

/// How two triangles of a chart meet, decided by the signs of exact determinants.
///
/// # The relation
/// A triangle is the closed convex hull of its corners. Let `F` be the convex hull of the
/// corners that the two triangles share, a corner being shared when its *landmark* is.
/// - [`Meeting::Disjoint`]: the triangles have no point in common.
/// - [`Meeting::CommonFace`]: they share corners, and have `F` in common and nothing else
///   (`F` is a corner, a side, or all of both when the three landmarks are the same).
/// - [`Meeting::Overlap`]: anything else. So a corner of one in the interior or on a side of
///   the other without being shared (a T-junction), crossing sides, overlapping interiors, and
///   two landmarks at one place are all overlaps.
///
/// This is the relation of the linear program (6) of Martin & Watson (2011, section 2): `Disjoint`
/// when it has no solution, `CommonFace` when its maximum is 0, `Overlap` when it is positive.
///
/// Cases in which the program has no clear answer are defined as follows:
/// - a triangle whose corners lie on one line is no face of a surface. It is disjoint from what
///   it does not touch, in a common face with a triangle of the same three landmarks, and
///   otherwise overlaps what it touches;
/// - a landmark at two different places, or a coordinate that is not finite, is an overlap.
///
/// # Exactness and cost
/// No rounding: determinants come from Shewchuk's adaptive predicates through `robust`, and are
/// exact while the products of coordinate differences neither overflow nor underflow (magnitudes
/// from about 1e-140 to 1e140). No allocation, at most 20 determinants; about 0.1 us a call.
///
/// ```
/// use crosscap_algorithms::predicate::PlanarPredicate;
/// use crosscap_core::{ChartTriangle, CompatibilityTest, Landmark, Meeting};
/// let below = ChartTriangle { corners: [0, 1, 2].map(Landmark::new), places: [[0.0, 0.0], [2.0, 0.0], [1.0, -1.0]] };
/// let above = ChartTriangle { corners: [1, 0, 3].map(Landmark::new), places: [[2.0, 0.0], [0.0, 0.0], [1.0, 1.0]] };
/// let on_the_side = ChartTriangle { corners: [4, 5, 3].map(Landmark::new), places: [[1.0, 0.0], [3.0, 2.0], [1.0, 1.0]] };
/// assert_eq!(PlanarPredicate.meeting(&below, &above), Meeting::CommonFace);
/// assert_eq!(PlanarPredicate.meeting(&below, &on_the_side), Meeting::Overlap);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlanarPredicate;

impl CompatibilityTest for PlanarPredicate {
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
        if !finite(a) || !finite(b) {
            return Meeting::Overlap;
        }
        // The corner of `b` that is corner `i` of `a`.
        let mut partner = [None; 3];
        let mut shared = 0;
        for (i, partner) in partner.iter_mut().enumerate() {
            *partner = b.corners.iter().position(|&c| c == a.corners[i]);
            if let Some(j) = *partner {
                if a.places[i] != b.places[j] {
                    return Meeting::Overlap;
                }
                shared += 1;
            }
        }
        if shared == 0 {
            return if separated(a, b) {
                Meeting::Disjoint
            } else {
                Meeting::Overlap
            };
        }
        if shared == 3 && b.corners.iter().all(|c| a.corners.contains(c)) {
            return Meeting::CommonFace;
        }
        let only_the_face = match shared {
            1 => apart_at_corner(a, b, &partner),
            2 => opposite_on_side(a, b, &partner),
            _ => false, // a triangle that names a landmark twice
        };
        if only_the_face {
            Meeting::CommonFace
        } else {
            Meeting::Overlap
        }
    }

    fn name(&self) -> &str {
        "exact planar predicate"
    }
}

fn finite(t: &ChartTriangle) -> bool {
    t.places.iter().flatten().all(|x| x.is_finite())
}

/// Positive when `r` lies to the left of the line from `p` to `q`.
fn turn(p: [f64; 2], q: [f64; 2], r: [f64; 2]) -> f64 {
    let coord = |[x, y]: [f64; 2]| Coord { x, y };
    orient2d(coord(p), coord(q), coord(r))
}

/// Whether two triangles without shared corners have no point in common.
///
/// Closed convex polygons without a common point are strictly separated along a side of one of
/// them, or, where both lie on one line, by a coordinate.
fn separated(a: &ChartTriangle, b: &ChartTriangle) -> bool {
    for axis in 0..2 {
        let range = |t: &ChartTriangle| {
            let [x, y, z] = t.places.map(|p| p[axis]);
            (x.min(y).min(z), x.max(y).max(z))
        };
        let ((low, high), (other_low, other_high)) = (range(a), range(b));
        if high < other_low || other_high < low {
            return true;
        }
    }
    beyond_a_side(a, b) || beyond_a_side(b, a)
}

/// Whether all of `b` lies strictly beyond the line of a side of `a`.
fn beyond_a_side(a: &ChartTriangle, b: &ChartTriangle) -> bool {
    let [p, q, r] = a.places;
    let inside = turn(p, q, r);
    [(p, q), (q, r), (r, p)].into_iter().any(|(p, q)| {
        let first = turn(p, q, b.places[0]);
        // A triangle without interior lies on its line: either side of it is beyond.
        (first > 0.0 && inside <= 0.0 || first < 0.0 && inside >= 0.0)
            && (b.places[1..].iter()).all(|&v| turn(p, q, v) * first.signum() > 0.0)
    })
}

/// Whether the third corners lie strictly on opposite sides of the shared side.
fn opposite_on_side(a: &ChartTriangle, b: &ChartTriangle, partner: &[Option<usize>; 3]) -> bool {
    let Some(third) = partner.iter().position(Option::is_none) else {
        return false;
    };
    let (p, q) = (a.places[(third + 1) % 3], a.places[(third + 2) % 3]);
    let Some(other) = (0..3).find(|j| !partner.contains(&Some(*j))) else {
        return false;
    };
    let (x, y) = (turn(p, q, a.places[third]), turn(p, q, b.places[other]));
    x > 0.0 && y < 0.0 || x < 0.0 && y > 0.0
}

/// Whether two triangles with one shared corner have only that corner in common.
///
/// They have more exactly when a side of one that leaves the corner points into the closed
/// angle of the other.
fn apart_at_corner(a: &ChartTriangle, b: &ChartTriangle, partner: &[Option<usize>; 3]) -> bool {
    let Some((i, j)) = (0..3).find_map(|i| partner[i].map(|j| (i, j))) else {
        return false;
    };
    let apex = a.places[i];
    // The two other corners, counterclockwise about the shared one.
    let arms = |t: &ChartTriangle, at: usize| {
        let (u, v) = (t.places[(at + 1) % 3], t.places[(at + 2) % 3]);
        let turn = turn(apex, u, v);
        if turn == 0.0 {
            None
        } else if turn > 0.0 {
            Some([u, v])
        } else {
            Some([v, u])
        }
    };
    let (Some(a), Some(b)) = (arms(a, i), arms(b, j)) else {
        return false;
    };
    // turns[i][j] is positive when arm j of b is to the left of arm i of a.
    let turns = a.map(|u| b.map(|v| turn(apex, u, v)));
    let b_into_a = (0..2).any(|j| turns[0][j] >= 0.0 && turns[1][j] <= 0.0);
    let a_into_b = (0..2).any(|i| turns[i][0] <= 0.0 && turns[i][1] >= 0.0);
    !b_into_a && !a_into_b
}

#[cfg(test)]
mod tests;
