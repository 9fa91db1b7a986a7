//! What a picture can be asked for.

use crate::picture::Scene;
use crosscap_core::Error;

/// Largest width and height, so that an image stays within a few hundred megabytes.
const LARGEST: usize = 16_384;

/// A half-space that is cut away so that one can look inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The direction in which is cut away, in the coordinates of the layout; `None` for towards
    /// the viewer. Its length does not matter.
    pub direction: Option<[f64; 3]>,
    /// The share of the extent in this direction that is kept, 0 to 1.
    pub keep: f64,
}

/// What a still image looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct StillOptions {
    /// Index of the layout that is shown.
    pub layout: usize,
    /// Direction from the mesh to the viewer in the coordinates of the layout; `None` chooses:
    /// the side that shows most, turned and tilted a little.
    pub direction: Option<[f64; 3]>,
    /// Which way is up; `None` for the third axis, or with no direction given, the axis of least extent.
    pub up: Option<[f64; 3]>,
    /// Samples for each pixel along each side, 1 to 4. Three gives smooth lines.
    pub supersampling: usize,
    /// Whether shading is smooth over edges; otherwise every triangle is flat.
    pub smooth: bool,
    /// Whether the edges of triangles are drawn.
    pub edges: bool,
    /// Whether silhouettes are drawn, on an opaque surface.
    pub outlines: bool,
    /// Whether hidden parts of curves shine through an opaque surface as thin lines.
    pub hidden_curves: bool,
    /// Whether the sample points of the layout are drawn.
    pub points: bool,
    /// Opacity of the surface, above 0 to 1. Below 1 sheets are blended in order of depth, sample by sample.
    pub opacity: f64,
    /// What is cut away, if anything.
    pub cut: Option<Cut>,
    /// Width of double curves in pixels, others are drawn somewhat thinner; `None` for a width
    /// that goes with the size of the image.
    pub curve_width: Option<f64>,
    /// Indices of pieces that are left out.
    pub without_pieces: Vec<usize>,
    /// Color behind everything, red, green, blue.
    pub background: [u8; 3],
}

impl Default for StillOptions {
    fn default() -> Self {
        Self {
            layout: 0,
            direction: None,
            up: None,
            supersampling: 3,
            smooth: true,
            edges: false,
            outlines: true,
            hidden_curves: true,
            points: false,
            opacity: 1.0,
            cut: None,
            curve_width: None,
            without_pieces: Vec::new(),
            background: [255; 3],
        }
    }
}

impl StillOptions {
    /// Whether they are in range, and so is the size of the image.
    pub(super) fn check(&self, scene: &Scene, width: usize, height: usize) -> Result<(), Error> {
        let refuse = |name, value: String, expected: &str| {
            Err(Error::Parameter {
                name,
                value,
                expected: expected.into(),
            })
        };
        for (name, size) in [("width", width), ("height", height)] {
            if !(1..=LARGEST).contains(&size) {
                return refuse(name, size.to_string(), "1 to 16384 pixels");
            }
        }
        if self.layout >= scene.layouts.len() {
            return Err(Error::Index {
                what: "layout",
                index: self.layout,
                limit: scene.layouts.len(),
            });
        }
        if !(1..=4).contains(&self.supersampling) {
            let value = self.supersampling.to_string();
            return refuse(
                "supersampling",
                value,
                "1 to 4 samples along each side of a pixel",
            );
        }
        if !(self.opacity > 0.0 && self.opacity <= 1.0) {
            return refuse("opacity", self.opacity.to_string(), "above 0, at most 1");
        }
        if let Some(w) = self.curve_width.filter(|w| !(0.0..=1000.0).contains(w)) {
            return refuse("curve_width", w.to_string(), "0 to 1000 pixels");
        }
        if let Some(cut) = &self.cut
            && !(0.0..=1.0).contains(&cut.keep)
        {
            return refuse("cut.keep", cut.keep.to_string(), "0 to 1");
        }
        let directions = [
            ("direction", self.direction),
            ("up", self.up),
            ("cut.direction", self.cut.and_then(|c| c.direction)),
        ];
        for (name, direction) in directions {
            if let Some(d) = direction
                .filter(|d| !d.iter().all(|c| c.is_finite()) || d.iter().all(|c| *c == 0.0))
            {
                return refuse(name, format!("{d:?}"), "three finite numbers, not all 0");
            }
        }
        Ok(())
    }
}
