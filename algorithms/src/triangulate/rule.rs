//! Which triangle is tried first on a dangling edge.

use crosscap_core::TriangleRule;

/// Smallest circumradius first, uvw/4K with the area K by Heron's formula (Martin & Watson
/// 2011, section 2.6).
///
/// ```
/// use crosscap_algorithms::triangulate::MinimumCircumradius;
/// use crosscap_core::TriangleRule;
/// assert!((MinimumCircumradius.rank(3.0, 4.0, 5.0) - 2.5).abs() < 1e-12);
/// assert_eq!(MinimumCircumradius.rank(1.0, 1.0, 2.0), f64::INFINITY);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct MinimumCircumradius;

impl TriangleRule for MinimumCircumradius {
    fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
        circumradius(edge, a, b)
    }

    fn name(&self) -> &str {
        "minimum-circumradius"
    }
}

/// Largest angle at the candidate first: the Delaunay triangle of the edge on its side.
///
/// Unlike the circumradius it does not prefer a far candidate to a near one that sees the edge under
/// an obtuse angle. The rank is the cosine of the angle.
#[derive(Clone, Copy, Debug, Default)]
pub struct LargestAngle;

impl TriangleRule for LargestAngle {
    fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
        if circumradius(edge, a, b).is_infinite() {
            return f64::INFINITY;
        }
        (a * a + b * b - edge * edge) / (2.0 * a * b)
    }

    fn name(&self) -> &str {
        "largest-angle"
    }
}

/// Circumradius of a triangle from its sides, infinite where it has no area.
pub(super) fn circumradius(a: f64, b: f64, c: f64) -> f64 {
    let mut s = [a, b, c];
    s.sort_by(f64::total_cmp);
    let [z, y, x] = s;
    // Kahan's form of Heron's formula: 16 K^2 without cancellation.
    let square = (x + (y + z)) * (z - (x - y)) * (z + (x - y)) * (x + (y - z));
    if square > 1e-24 * x.powi(4) {
        x * y * z / square.sqrt()
    } else {
        f64::INFINITY
    }
}
