//! The camera, and the plane that cuts away what is before it.

use super::options::StillOptions;
use crate::picture::raster::Line;
use crate::picture::view::{CAMERA_DISTANCE, View, unit};
use nalgebra::Vector3;

/// A corner before projection: place in the camera, normal in the camera.
pub(super) type Placed = (Vector3<f64>, Vector3<f64>);

/// The camera and the plane of the cut.
pub(super) struct Stage {
    pub focal: f64,
    pub middle: [f64; 2],
    /// Normal in the camera and limit: what is beyond is cut away.
    cut: Option<(Vector3<f64>, f64)>,
}

/// Nearer to the camera plane than this nothing is drawn.
const NEAREST: f64 = 0.2;

impl Stage {
    pub fn project(&self, place: Vector3<f64>) -> ([f64; 2], f64) {
        let inverse = 1.0 / (CAMERA_DISTANCE - place.z);
        (
            [
                self.middle[0] + self.focal * place.x * inverse,
                self.middle[1] - self.focal * place.y * inverse,
            ],
            inverse,
        )
    }

    /// How far beyond the cut a place is.
    fn beyond(&self, place: Vector3<f64>) -> f64 {
        self.cut.map_or(-1.0, |(n, limit)| place.dot(&n) - limit)
    }

    /// What the cut leaves of a triangle (at most four corners), and the ends of the edge it makes.
    pub fn clip(&self, corners: [Placed; 3]) -> (Vec<Placed>, Vec<Vector3<f64>>) {
        let mut kept = Vec::with_capacity(4);
        let mut rim = Vec::new();
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let (da, db) = (self.beyond(a.0), self.beyond(b.0));
            if da <= 0.0 {
                kept.push(a);
            }
            if (da <= 0.0) != (db <= 0.0) {
                let t = da / (da - db);
                let place = a.0 + (b.0 - a.0) * t;
                kept.push((place, a.1 + (b.1 - a.1) * t));
                rim.push(place);
            }
        }
        (kept, rim)
    }

    /// What the cut leaves of a line.
    fn clip_line(&self, a: Vector3<f64>, b: Vector3<f64>) -> Option<[Vector3<f64>; 2]> {
        let (da, db) = (self.beyond(a), self.beyond(b));
        let at = || a + (b - a) * (da / (da - db));
        match (da <= 0.0, db <= 0.0) {
            (true, true) => Some([a, b]),
            (true, false) => Some([a, at()]),
            (false, true) => Some([at(), b]),
            (false, false) => None,
        }
    }

    /// Pushes the line between two places in the camera, as far as it is to be seen.
    pub fn line(&self, lines: &mut Vec<Line>, a: Vector3<f64>, b: Vector3<f64>, like: Line) {
        let visible = |p: &Vector3<f64>| CAMERA_DISTANCE - p.z > NEAREST;
        if let Some(ends) = self.clip_line(a, b).filter(|e| e.iter().all(visible)) {
            let ends = ends.map(|p| self.project(p));
            lines.push(Line { ends, ..like });
        }
    }
}

/// Scale and middle of the projection that fit what is seen into the image, and the cut.
pub(super) fn fit(
    seen: &[Vector3<f64>],
    view: &View,
    size: [f64; 2],
    margin: f64,
    options: &StillOptions,
) -> Stage {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in seen {
        let inverse = 1.0 / (CAMERA_DISTANCE - p.z);
        for (axis, c) in [p.x * inverse, -p.y * inverse].into_iter().enumerate() {
            low[axis] = low[axis].min(c);
            high[axis] = high[axis].max(c);
        }
    }
    if low[0] > high[0] {
        (low, high) = ([0.0; 2], [0.0; 2]);
    }
    let focal = (0..2)
        .map(|a| (size[a] - 2.0 * margin).max(size[a] * 0.2) / (high[a] - low[a]).max(0.02))
        .fold(f64::INFINITY, f64::min);
    let cut = options.cut.map(|cut| {
        let direction = cut
            .direction
            .and_then(|d| unit(Vector3::from(d)))
            .unwrap_or(view.toward);
        let normal = view.of(direction);
        let along = || seen.iter().map(|p| p.dot(&normal));
        let low = along().fold(f64::INFINITY, f64::min);
        let high = along().fold(f64::NEG_INFINITY, f64::max);
        // All or nothing means just that, whatever rounding says about the outermost vertex.
        let limit = if cut.keep >= 1.0 {
            f64::INFINITY
        } else {
            low + (high - low) * cut.keep
        };
        (normal, limit)
    });
    Stage {
        focal,
        middle: std::array::from_fn(|a| size[a] / 2.0 - focal * (low[a] + high[a]) / 2.0),
        cut: cut.filter(|c| c.1.is_finite()),
    }
}
