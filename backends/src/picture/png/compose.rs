//! Where everything that is to be seen lies in the image.

use super::options::StillOptions;
use super::stage::{Placed, Stage, fit};
use crate::picture::palette::MARK;
use crate::picture::raster::{Corner, Face, Line, Picture};
use crate::picture::scene::Frame;
use crate::picture::shade::corner_normals;
use crate::picture::view::View;
use crate::picture::{CurveKind, Layout, Scene, curve_color, piece_color};
use nalgebra::Vector3;

/// Share of the shorter side of the image that is left free around the mesh.
const MARGIN: f64 = 0.05;

fn wide(p: [f32; 3]) -> [f64; 3] {
    p.map(f64::from)
}

/// Projects everything that is to be seen.
pub(super) fn compose(
    scene: &Scene,
    width: usize,
    height: usize,
    options: &StillOptions,
) -> Picture {
    let set = Setting::new(scene, options, [width, height]);
    let mut faces = Vec::with_capacity(scene.triangles.len());
    let mut lines = Vec::new();
    if options.edges {
        set.edges(&mut lines);
    }
    set.triangles(&mut faces, &mut lines);
    set.dots(&mut lines);
    set.curves(&mut lines);
    set.marks(&mut lines);
    Picture {
        faces,
        lines,
        width: width * options.supersampling,
        focal: set.stage.focal,
        middle: set.stage.middle,
        background: options.background,
        opacity: options.opacity,
        outline: if options.outlines && options.opacity >= 1.0 {
            ((set.shorter / 900.0).round() as usize).clamp(1, 6)
        } else {
            0
        },
    }
}

/// A scene before the camera.
struct Setting<'s> {
    scene: &'s Scene,
    options: &'s StillOptions,
    frame: Frame,
    view: View,
    stage: Stage,
    /// Vertices and points in the frame.
    places: Vec<Vector3<f64>>,
    points: Vec<Vector3<f64>>,
    /// Vertices in the camera.
    camera: Vec<Vector3<f64>>,
    /// Shorter side of the image and width of a curve, in samples.
    shorter: f64,
    curve_width: f64,
    /// What all lines begin as.
    thin: Line,
}

impl<'s> Setting<'s> {
    fn new(scene: &'s Scene, options: &'s StillOptions, size: [usize; 2]) -> Self {
        let layout = &scene.layouts[options.layout];
        let used = scene.used(layout.places.len());
        let frame = frame(layout, &used);
        let place = |p: &[f32; 3]| Vector3::from(frame.place(wide(*p)));
        let places: Vec<Vector3<f64>> = layout.places.iter().map(place).collect();
        let points: Vec<Vector3<f64>> = match options.points || scene.is_bare() {
            true => layout.points.iter().map(place).collect(),
            false => Vec::new(),
        };
        let view = choose_view(scene, &places, &points, &used, options);
        let camera: Vec<Vector3<f64>> = places.iter().map(|p| view.of(*p)).collect();
        let seen: Vec<Vector3<f64>> = if layout.places.is_empty() {
            points.iter().map(|p| view.of(*p)).collect()
        } else {
            let drawn = camera.iter().zip(&used).filter(|(_, used)| **used);
            drawn.map(|(p, _)| *p).collect()
        };
        let samples = options.supersampling as f64;
        let size = size.map(|s| s as f64 * samples);
        let shorter = size[0].min(size[1]);
        let curve_width = options
            .curve_width
            .map_or((shorter / 115.0).max(1.6 * samples), |w| w * samples);
        Self {
            stage: fit(&seen, &view, size, shorter * MARGIN + curve_width, options),
            thin: Line {
                ends: [([0.0; 2], 0.0); 2],
                radius: (shorter / 1600.0).max(0.45 * samples),
                color: [20; 3],
                hidden: 0.0,
                strength: 0.45,
            },
            scene,
            options,
            frame,
            view,
            places,
            points,
            camera,
            shorter,
            curve_width,
        }
    }

    fn edges(&self, lines: &mut Vec<Line>) {
        for [a, b] in self.scene.edges() {
            let [a, b] = [a, b].map(|v| self.camera[v as usize]);
            self.stage.line(lines, a, b, self.thin);
        }
    }

    /// The triangles, as far as they are not cut away, and the rims of the cut.
    fn triangles(&self, faces: &mut Vec<Face>, lines: &mut Vec<Line>) {
        let scene = self.scene;
        let curve_edges = scene.curve_edges();
        let smooth = self.options.smooth;
        let normals = corner_normals(&self.places, &scene.triangles, &curve_edges, smooth);
        let triangles = scene.triangles.iter().zip(&scene.triangle_piece);
        for ((t, &piece), normal) in triangles.zip(&normals) {
            if self.options.without_pieces.contains(&(piece as usize)) {
                continue;
            }
            let color = piece_color(piece as usize);
            let corners: [Placed; 3] =
                std::array::from_fn(|k| (self.camera[t[k] as usize], self.view.of(normal[k])));
            let (kept, rim) = self.stage.clip(corners);
            if let [a, b] = rim[..] {
                // Already on the cut: clipping it again would lose half of it to rounding.
                lines.push(Line {
                    ends: [a, b].map(|p| self.stage.project(p)),
                    radius: self.curve_width * 0.3,
                    color: color.map(|c| c / 3),
                    strength: 1.0,
                    ..self.thin
                });
            }
            let corner = |p: &Placed| {
                let (at, inverse) = self.stage.project(p.0);
                Corner {
                    at,
                    inverse,
                    normal: p.1,
                }
            };
            for k in 2..kept.len() {
                faces.push(Face {
                    corners: [corner(&kept[0]), corner(&kept[k - 1]), corner(&kept[k])],
                    color,
                });
            }
        }
    }

    /// The points, and the vertices of a scene that has nothing else.
    fn dots(&self, lines: &mut Vec<Line>) {
        for p in &self.points {
            let place = self.view.of(*p);
            let dot = Line {
                radius: self.curve_width * 0.3,
                color: [70, 70, 76],
                strength: 1.0,
                ..self.thin
            };
            self.stage.line(lines, place, place, dot);
        }
        if !self.scene.is_bare() {
            return;
        }
        for &place in &self.camera {
            let dot = Line {
                radius: self.curve_width * 0.5,
                color: piece_color(0),
                strength: 1.0,
                ..self.thin
            };
            self.stage.line(lines, place, place, dot);
        }
    }

    fn curves(&self, lines: &mut Vec<Line>) {
        for curve in &self.scene.curves {
            let share = match curve.kind {
                CurveKind::Double => 0.5,
                _ => 0.38,
            };
            let like = Line {
                radius: self.curve_width * share,
                color: curve_color(curve.kind),
                hidden: match self.options.hidden_curves {
                    true => (self.curve_width * 0.16).max(0.5),
                    false => 0.0,
                },
                strength: 1.0,
                ..self.thin
            };
            for e in &curve.edges {
                let [a, b] = e.map(|v| self.camera[v as usize]);
                self.stage.line(lines, a, b, like);
            }
        }
    }

    fn marks(&self, lines: &mut Vec<Line>) {
        let marks = self.scene.marks.iter();
        for mark in marks.filter(|m| m.layout == self.options.layout) {
            let place = self.frame.place(wide(mark.place));
            let place = self.view.of(Vector3::from(place));
            let dot = Line {
                radius: self.curve_width * 0.8,
                color: MARK,
                hidden: self.curve_width * 0.4,
                strength: 1.0,
                ..self.thin
            };
            self.stage.line(lines, place, place, dot);
        }
    }
}

/// The frame of what is drawn, or of whatever there is.
fn frame(layout: &Layout, used: &[bool]) -> Frame {
    let drawn = layout.places.iter().zip(used).filter(|(_, used)| **used);
    Frame::of(drawn.map(|(p, _)| wide(*p)))
        .or_else(|| Frame::of(layout.points.iter().map(|p| wide(*p))))
        .unwrap_or_default()
}

/// The view asked for, or the automatic one.
fn choose_view(
    scene: &Scene,
    places: &[Vector3<f64>],
    points: &[Vector3<f64>],
    used: &[bool],
    options: &StillOptions,
) -> View {
    let up = options.up.map_or(Vector3::z(), Vector3::from);
    if let Some(d) = options.direction {
        return View::from(Vector3::from(d), up);
    }
    let view = View::of_scene(scene, places, points, used);
    match options.up {
        Some(_) => View::from(view.toward, up),
        None => view,
    }
}
