//! A depth-buffer renderer for bands of an image.
//!
//! Bands keep the memory small at three-fold supersampling, are drawn in parallel, and depend
//! on nothing but the primitives: the image is the same on any number of threads.

use super::shade::shade;
use nalgebra::Vector3;

/// A corner on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Place in samples, from the left and from the top.
    pub at: [f64; 2],
    /// One over the distance from the camera plane: linear on the screen.
    pub inverse: f64,
    /// Normal in camera coordinates.
    pub normal: Vector3<f64>,
}

/// A triangle of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub corners: [Corner; 3],
    pub color: [u8; 3],
}

/// A thick line with round ends, drawn as the tube around it; a disc when both ends coincide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Ends: place in samples, and one over the distance from the camera plane.
    pub ends: [([f64; 2], f64); 2],
    /// Half of the width, in samples.
    pub radius: f64,
    pub color: [u8; 3],
    /// Half of the width where it is hidden, in samples; 0 for not to be seen there.
    pub hidden: f64,
    /// Opacity where it is seen, 0 to 1.
    pub strength: f32,
}

/// Everything that is drawn.
pub(super) struct Picture {
    pub faces: Vec<Face>,
    pub lines: Vec<Line>,
    /// Samples across.
    pub width: usize,
    /// Samples in a unit length at unit distance from the camera plane.
    pub focal: f64,
    /// The middle of the projection, in samples.
    pub middle: [f64; 2],
    pub background: [u8; 3],
    /// Opacity of the surface, 1 for opaque.
    pub opacity: f64,
    /// Width of the outlines of opaque surfaces, in samples; 0 for none.
    pub outline: usize,
}

/// Drop in depth, in radii of the scene, from which on a silhouette is drawn.
const STEP: f32 = 0.035;

/// A piece of a transparent face behind one sample.
struct Fragment {
    sample: u32,
    distance: f32,
    color: [f32; 3],
    alpha: f32,
}

/// Sample rows of one band.
struct Band {
    first: usize,
    rows: usize,
    distance: Vec<f32>,
    color: Vec<[f32; 3]>,
    /// Whether a sample is on an opaque face, where an outline may be drawn.
    face: Vec<bool>,
    /// How strongly a hidden curve shines through.
    hidden: Vec<f32>,
    fragments: Vec<Fragment>,
}

impl Picture {
    /// Colors of the sample rows `first..first + rows`, in row order.
    pub(super) fn band(&self, first: usize, rows: usize) -> Vec<[f32; 3]> {
        // Outlines look at neighbors: some rows more above and below.
        let above = self.outline.min(first);
        let count = (rows + above + self.outline) * self.width;
        let mut band = Band {
            first: first - above,
            rows: rows + above + self.outline,
            distance: vec![f32::INFINITY; count],
            color: vec![self.background.map(f32::from); count],
            face: vec![false; count],
            hidden: vec![0.0; count],
            fragments: Vec::new(),
        };
        for face in &self.faces {
            self.fill(&mut band, face);
        }
        if self.outline > 0 && self.opacity >= 1.0 {
            self.outlines(&mut band);
        }
        for line in &self.lines {
            self.stroke(&mut band, line);
        }
        self.blend(&mut band);
        for (color, &h) in band.color.iter_mut().zip(&band.hidden) {
            *color = color.map(|c| c * (1.0 - h));
        }
        band.color[above * self.width..(above + rows) * self.width].to_vec()
    }

    /// The samples of a band that a box from `low` to `high` meets: columns, rows.
    fn window(
        &self,
        band: &Band,
        low: [f64; 2],
        high: [f64; 2],
    ) -> Option<(std::ops::Range<usize>, std::ops::Range<usize>)> {
        let last = (band.first + band.rows) as f64;
        let finite = low.iter().chain(&high).all(|c| c.is_finite());
        if !finite || high[1] < band.first as f64 || low[1] > last || high[0] < 0.0 {
            return None;
        }
        let clip = |c: f64, limit: usize| (c.max(0.0) as usize).min(limit);
        let columns = clip(low[0].floor(), self.width)..clip(high[0].ceil() + 1.0, self.width);
        let bottom = band.first + band.rows;
        let rows = clip(low[1].floor(), bottom).max(band.first)..clip(high[1].ceil() + 1.0, bottom);
        (!columns.is_empty() && !rows.is_empty()).then_some((columns, rows))
    }

    fn fill(&self, band: &mut Band, face: &Face) {
        let [a, b, c] = face.corners.map(|k| k.at);
        let low = [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1])];
        let high = [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1])];
        let Some((columns, rows)) = self.window(band, low, high) else {
            return;
        };
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let part = |p: [f64; 2], q: [f64; 2], x: f64, y: f64| {
            ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area
        };
        for row in rows {
            let y = row as f64 + 0.5;
            for column in columns.clone() {
                let x = column as f64 + 0.5;
                let (u, v, w) = (part(b, c, x, y), part(c, a, x, y), part(a, b, x, y));
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let [p, q, r] = &face.corners;
                let distance = 1.0 / (u * p.inverse + v * q.inverse + w * r.inverse);
                let sample = (row - band.first) * self.width + column;
                if distance as f32 >= band.distance[sample] {
                    continue;
                }
                let normal = p.normal * u + q.normal * v + r.normal * w;
                let eye = Vector3::new(
                    (self.middle[0] - x) / self.focal,
                    (y - self.middle[1]) / self.focal,
                    1.0,
                )
                .normalize();
                let (color, facing) = shade(face.color, normal, eye);
                if self.opacity >= 1.0 {
                    band.distance[sample] = distance as f32;
                    band.color[sample] = color;
                    band.face[sample] = true;
                } else {
                    // The way through a thin layer is longer where it is seen from the side.
                    let alpha = 1.0 - (1.0 - self.opacity).powf(1.0 / facing.max(0.12));
                    band.fragments.push(Fragment {
                        sample: sample as u32,
                        distance: distance as f32,
                        color,
                        alpha: alpha as f32,
                    });
                }
            }
        }
    }

    /// Darkens the samples of a face beside which the picture drops away.
    fn outlines(&self, band: &mut Band) {
        let reach = self.outline as isize;
        let mut dark = vec![false; band.distance.len()];
        for row in 0..band.rows as isize {
            for column in 0..self.width as isize {
                let sample = row as usize * self.width + column as usize;
                if !band.face[sample] {
                    continue;
                }
                let own = band.distance[sample];
                let beyond = |dr: isize, dc: isize| {
                    let (r, c) = (row + dr, column + dc);
                    let inside = (0..band.rows as isize).contains(&r)
                        && (0..self.width as isize).contains(&c);
                    inside
                        && band.distance[r as usize * self.width + c as usize] - own
                            > STEP * (dr.abs() + dc.abs()) as f32
                };
                dark[sample] = (1..=reach)
                    .any(|k| beyond(k, 0) || beyond(-k, 0) || beyond(0, k) || beyond(0, -k));
            }
        }
        for (color, _) in band.color.iter_mut().zip(&dark).filter(|(_, d)| **d) {
            *color = color.map(|c| c * 0.32);
        }
    }

    fn stroke(&self, band: &mut Band, line: &Line) {
        let [(a, near_a), (b, near_b)] = line.ends;
        let r = line.radius;
        let low = [a[0].min(b[0]) - r, a[1].min(b[1]) - r];
        let high = [a[0].max(b[0]) + r, a[1].max(b[1]) + r];
        let Some((columns, rows)) = self.window(band, low, high) else {
            return;
        };
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = along[0] * along[0] + along[1] * along[1];
        for row in rows {
            let y = row as f64 + 0.5;
            for column in columns.clone() {
                let x = column as f64 + 0.5;
                let (dx, dy) = (x - a[0], y - a[1]);
                let t = if length > 0.0 {
                    ((dx * along[0] + dy * along[1]) / length).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let (ex, ey) = (dx - t * along[0], dy - t * along[1]);
                let off = ex * ex + ey * ey;
                if off > r * r {
                    continue;
                }
                let axis = 1.0 / (near_a + t * (near_b - near_a));
                // The tube stands out by its own roundness and half of its radius again, so
                // that the mesh edge it runs along cannot cut into it.
                let lift = ((r * r - off).sqrt() + 0.5 * r) * axis / self.focal;
                let distance = (axis - lift) as f32;
                let sample = (row - band.first) * self.width + column;
                if distance < band.distance[sample] {
                    let s = line.strength;
                    let old = band.color[sample];
                    band.color[sample] =
                        std::array::from_fn(|k| old[k] + (f32::from(line.color[k]) - old[k]) * s);
                    if s >= 1.0 {
                        band.distance[sample] = distance;
                        band.hidden[sample] = 0.0;
                        band.face[sample] = false;
                    }
                } else if off <= line.hidden * line.hidden && band.face[sample] {
                    band.hidden[sample] = 0.38;
                }
            }
        }
    }

    /// Lays the transparent fragments over the rest, furthest first.
    fn blend(&self, band: &mut Band) {
        let Band {
            fragments,
            distance,
            color,
            ..
        } = band;
        fragments.retain(|f| f.distance < distance[f.sample as usize]);
        fragments.sort_by(|f, g| {
            f.sample
                .cmp(&g.sample)
                .then(g.distance.total_cmp(&f.distance))
        });
        for f in fragments {
            let under = &mut color[f.sample as usize];
            *under = std::array::from_fn(|k| under[k] + (f.color[k] - under[k]) * f.alpha);
        }
    }
}
