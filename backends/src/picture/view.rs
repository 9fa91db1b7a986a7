//! Where to look from.

use super::Scene;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// A camera: right, up and towards the viewer, orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    pub right: Vector3<f64>,
    pub up: Vector3<f64>,
    pub toward: Vector3<f64>,
}

/// Distance of the camera from the middle, in radii of the scene: far enough for a calm perspective.
pub(super) const CAMERA_DISTANCE: f64 = 5.0;

/// Variances nearer to each other than this are taken as equal, and the axes of the data are
/// used where the principal ones mean nothing.
const EQUAL: f64 = 0.12;

impl View {
    /// The view along `-toward`, upright with respect to `up`, or to another axis when they are parallel.
    pub(super) fn from(toward: Vector3<f64>, up: Vector3<f64>) -> Self {
        let toward = unit(toward).unwrap_or(Vector3::z());
        let right = [up, Vector3::z(), Vector3::y()]
            .into_iter()
            .find_map(|u| {
                let r = unit(u)?.cross(&toward);
                (r.norm() > 1e-6).then(|| r.normalize())
            })
            .unwrap_or(Vector3::x());
        Self {
            right,
            up: toward.cross(&right),
            toward,
        }
    }

    /// The view that shows most: across the direction of smallest extent, which stands upright, longest
    /// side across the picture, turned and tilted so that it reads as a body; flat things are looked
    /// at from further above. `weighted` are places with weights (areas).
    pub(super) fn automatic(weighted: &[(Vector3<f64>, f64)]) -> Self {
        let total: f64 = weighted.iter().map(|w| w.1).sum();
        if total <= 0.0 {
            return Self::from(
                tilted([Vector3::x(), Vector3::y(), Vector3::z()], 0.45),
                Vector3::z(),
            );
        }
        let mean = weighted.iter().map(|(p, w)| p * *w).sum::<Vector3<f64>>() / total;
        let mut scatter = Matrix3::zeros();
        for (p, w) in weighted {
            let d = p - mean;
            scatter += d * d.transpose() * (*w / total);
        }
        let eigen = SymmetricEigen::new(scatter);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| {
            eigen.eigenvalues[b]
                .total_cmp(&eigen.eigenvalues[a])
                .then(a.cmp(&b))
        });
        let value = order.map(|i| eigen.eigenvalues[i].max(0.0));
        let axis = order.map(|i| signed(eigen.eigenvectors.column(i).into_owned()));
        let same = |a: f64, b: f64| a - b <= EQUAL * a;
        let (first, third) = match (same(value[0], value[1]), same(value[1], value[2])) {
            (true, true) => (Vector3::x(), Vector3::z()),
            (true, false) => (across(axis[2], Vector3::x()), axis[2]),
            (false, true) => (axis[0], across(axis[0], Vector3::z())),
            (false, false) => (axis[0], axis[2]),
        };
        let flatness = if value[1] > 0.0 {
            1.0 - (value[2] / value[1]).sqrt()
        } else {
            0.0
        };
        let elevation = 0.45 + 0.5 * flatness * flatness;
        Self::from(
            tilted([first, third.cross(&first), third], elevation),
            third,
        )
    }

    /// The automatic view of a scene: of its triangles by area, else of the places that are
    /// `used`, else of the points. Places and points are relative to their frame.
    pub(super) fn of_scene(
        scene: &Scene,
        places: &[Vector3<f64>],
        points: &[Vector3<f64>],
        used: &[bool],
    ) -> Self {
        let mut weighted: Vec<(Vector3<f64>, f64)> = scene
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| places[v as usize]);
                ((a + b + c) / 3.0, (b - a).cross(&(c - a)).norm())
            })
            .collect();
        if weighted.iter().all(|w| w.1 == 0.0) {
            let drawn = places.iter().zip(used).filter(|(_, u)| **u);
            weighted = drawn.map(|(p, _)| (*p, 1.0)).collect();
        }
        if weighted.is_empty() {
            weighted = points.iter().map(|p| (*p, 1.0)).collect();
        }
        Self::automatic(&weighted)
    }

    /// Coordinates in the camera: to the right, up, towards the viewer.
    pub(super) fn of(&self, place: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            place.dot(&self.right),
            place.dot(&self.up),
            place.dot(&self.toward),
        )
    }
}

/// The direction to the viewer, `elevation` (radians) above the first two axes.
fn tilted(axes: [Vector3<f64>; 3], elevation: f64) -> Vector3<f64> {
    let azimuth = 0.5_f64;
    elevation.cos() * (azimuth.sin() * axes[0] - azimuth.cos() * axes[1])
        + elevation.sin() * axes[2]
}

/// The part of `wish` across `axis`, or of another coordinate axis when they are parallel.
fn across(axis: Vector3<f64>, wish: Vector3<f64>) -> Vector3<f64> {
    [wish, Vector3::x(), Vector3::y()]
        .into_iter()
        .map(|w| w - axis * w.dot(&axis))
        .find(|w| w.norm() > 0.3)
        .map_or(wish, |w| w.normalize())
}

/// The axis with its largest coordinate positive.
fn signed(axis: Vector3<f64>) -> Vector3<f64> {
    if axis[axis.iamax()] < 0.0 {
        -axis
    } else {
        axis
    }
}

/// The vector at length one; `None` for one without a direction.
pub(super) fn unit(v: Vector3<f64>) -> Option<Vector3<f64>> {
    let top = v.amax();
    (top > 0.0 && top.is_finite()).then(|| (v / top).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_orthonormal_whatever_is_asked_for() {
        for toward in [
            Vector3::z(),
            Vector3::y(),
            Vector3::zeros(),
            Vector3::new(1e300, 1e300, 0.0),
            Vector3::new(f64::NAN, 0.0, 0.0),
        ] {
            let v = View::from(toward, Vector3::z());
            assert!((v.right.cross(&v.up) - v.toward).norm() < 1e-9);
            assert!((v.right.norm() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_short_side_stands_upright_and_the_long_one_lies_across() {
        let points: Vec<_> = (0..200)
            .map(|k| {
                let t = f64::from(k);
                (
                    Vector3::new(t.sin(), 3.0 * (t * 1.7).sin(), 9.0 * (t * 0.3).sin()),
                    1.0,
                )
            })
            .collect();
        let v = View::automatic(&points);
        assert!(v.up.x.abs() > 0.6 && v.right.z.abs() > 0.6, "{v:?}");
        assert_eq!(v, View::automatic(&points));
        View::automatic(&[]);
        View::automatic(&[(Vector3::zeros(), 1.0)]);
    }
}
