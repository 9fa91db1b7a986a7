//! Triangles cut into tiles that are small beside the spacing of the points.

use crosscap_core::squared_distance;

/// Longest side of a tile, in local spacings. Gaps are at least two wide.
pub(super) const TILE: f64 = 0.4;
/// Deepest cut: a side becomes at most 2^12 sides.
const DEEPEST: u32 = 12;

/// A small part of the mesh that is far from the points.
pub(super) struct Empty {
    pub triangle: u32,
    /// Weights of its middle.
    pub weights: [f64; 3],
    /// Distance to the nearest point or to the end of the mesh, in spacings.
    pub away: f64,
    /// Number of points expected on it.
    pub measure: f64,
}

/// A part of a triangle, like it in shape.
#[derive(Clone, Copy)]
pub(super) struct Tile {
    /// Corners as weights of the corners of the triangle.
    corners: [[f64; 3]; 3],
    depth: u32,
}

impl Tile {
    /// Weights of the middle.
    pub fn middle(&self) -> [f64; 3] {
        let [a, b, c] = &self.corners;
        std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0)
    }

    /// How often the triangle was cut.
    pub fn depth(&self) -> usize {
        self.depth as usize
    }

    /// Its side, area or radius as a share of those of the triangle: the share of lengths.
    pub fn scale(&self) -> f64 {
        0.5_f64.powi(self.depth as i32)
    }

    fn parts(&self) -> [Self; 4] {
        let [a, b, c] = self.corners;
        let mid =
            |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| 0.5 * (p[k] + q[k])) };
        let (ab, bc, ca) = (mid(a, b), mid(b, c), mid(c, a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|corners| Self {
            corners,
            depth: self.depth + 1,
        })
    }
}

/// What to do with a tile.
pub(super) enum Cut {
    /// Nothing more is asked of it.
    Leave,
    /// Its four parts come next.
    Further,
}

/// Shape of a triangle: what its tiles are measured by.
pub(super) struct Shape<'a> {
    pub corners: [&'a [f64]; 3],
    pub longest: f64,
    /// Largest distance of a corner from the middle.
    pub radius: f64,
}

impl<'a> Shape<'a> {
    pub fn new(corners: [&'a [f64]; 3]) -> Self {
        let longest = (0..3)
            .map(|k| squared_distance(corners[k], corners[(k + 1) % 3]))
            .fold(0.0, f64::max)
            .sqrt();
        let middle: Vec<f64> = (0..corners[0].len())
            .map(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0)
            .collect();
        let radius = corners
            .iter()
            .map(|c| squared_distance(c, &middle))
            .fold(0.0, f64::max)
            .sqrt();
        Self {
            corners,
            longest,
            radius,
        }
    }

    /// The place of some weights.
    pub fn place(&self, weights: [f64; 3], place: &mut [f64]) {
        let [a, b, c] = self.corners;
        for (k, x) in place.iter_mut().enumerate() {
            *x = weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k];
        }
    }

    /// Visits the triangle and, where `visit` says so, its parts, each with the place of its middle.
    pub fn cut(&self, place: &mut [f64], visit: &mut impl FnMut(&Tile, &[f64]) -> Cut) {
        let whole = Tile {
            corners: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            depth: 0,
        };
        self.cut_tile(whole, place, visit);
    }

    fn cut_tile(
        &self,
        tile: Tile,
        place: &mut [f64],
        visit: &mut impl FnMut(&Tile, &[f64]) -> Cut,
    ) {
        self.place(tile.middle(), place);
        if matches!(visit(&tile, place), Cut::Further) && tile.depth < DEEPEST {
            for part in tile.parts() {
                self.cut_tile(part, place, visit);
            }
        }
    }
}
