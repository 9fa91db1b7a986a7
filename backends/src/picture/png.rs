//! A still image.

use super::palette::MARK;
use super::raster::{Corner, Face, Line, Picture};
use super::scene::Frame;
use super::shade::corner_normals;
use super::view::{CAMERA_DISTANCE, View, unit};
use super::{CurveKind, Scene, curve_color, piece_color};
use crosscap_core::Error;
use nalgebra::Vector3;
use rayon::prelude::*;

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

/// Largest width and height, so that an image stays within a few hundred megabytes.
const LARGEST: usize = 16_384;

/// Image rows of one band.
const BAND: usize = 24;

/// Share of the shorter side of the image that is left free around the mesh.
const MARGIN: f64 = 0.05;

/// Draws a scene into a PNG image of `width` by `height` pixels; the same scene and options give
/// the same bytes, on any number of threads.
///
/// Triangles are colored by piece and lit from both sides, curves are tubes of constant width on
/// the screen: double curves black, boundary curves dark blue.
///
/// # Errors
/// Those of [`Scene::check`]; [`Error::Parameter`] for a size outside of 1 to 16,384, an option out of
/// range or not finite; [`Error::Index`] for a layout that is not there.
///
/// # Complexity
/// O(samples covered + t log t) for t triangles; about 0.4 s for 10,000 triangles on
/// 800 x 600 pixels on two processors.
pub fn still(
    scene: &Scene,
    width: usize,
    height: usize,
    options: &StillOptions,
) -> Result<Vec<u8>, Error> {
    scene.check()?;
    check(scene, width, height, options)?;
    let samples = options.supersampling;
    let picture = compose(scene, width, height, options);
    let rows: Vec<Vec<u8>> = (0..height.div_ceil(BAND))
        .into_par_iter()
        .map(|band| {
            let first = band * BAND;
            let count = BAND.min(height - first);
            let colors = picture.band(first * samples, count * samples);
            average(&colors, width, count, samples)
        })
        .collect();
    Ok(encode(width, height, &rows.concat()))
}

fn check(scene: &Scene, width: usize, height: usize, options: &StillOptions) -> Result<(), Error> {
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
    if options.layout >= scene.layouts.len() {
        return Err(Error::Index {
            what: "layout",
            index: options.layout,
            limit: scene.layouts.len(),
        });
    }
    if !(1..=4).contains(&options.supersampling) {
        let value = options.supersampling.to_string();
        return refuse(
            "supersampling",
            value,
            "1 to 4 samples along each side of a pixel",
        );
    }
    if !(options.opacity > 0.0 && options.opacity <= 1.0) {
        return refuse("opacity", options.opacity.to_string(), "above 0, at most 1");
    }
    if let Some(w) = options.curve_width.filter(|w| !(0.0..=1000.0).contains(w)) {
        return refuse("curve_width", w.to_string(), "0 to 1000 pixels");
    }
    if let Some(cut) = &options.cut
        && !(0.0..=1.0).contains(&cut.keep)
    {
        return refuse("cut.keep", cut.keep.to_string(), "0 to 1");
    }
    let directions = [
        ("direction", options.direction),
        ("up", options.up),
        ("cut.direction", options.cut.and_then(|c| c.direction)),
    ];
    for (name, direction) in directions {
        if let Some(d) =
            direction.filter(|d| !d.iter().all(|c| c.is_finite()) || d.iter().all(|c| *c == 0.0))
        {
            return refuse(name, format!("{d:?}"), "three finite numbers, not all 0");
        }
    }
    Ok(())
}

/// A corner before projection: place in the camera, normal in the camera.
type Placed = (Vector3<f64>, Vector3<f64>);

/// The camera and the plane of the cut.
struct Stage {
    focal: f64,
    middle: [f64; 2],
    /// Normal in the camera and limit: what is beyond is cut away.
    cut: Option<(Vector3<f64>, f64)>,
}

/// Nearer to the camera plane than this nothing is drawn.
const NEAREST: f64 = 0.2;

impl Stage {
    fn project(&self, place: Vector3<f64>) -> ([f64; 2], f64) {
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
    fn clip(&self, corners: [Placed; 3]) -> (Vec<Placed>, Vec<Vector3<f64>>) {
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
    fn line(&self, lines: &mut Vec<Line>, a: Vector3<f64>, b: Vector3<f64>, like: Line) {
        let visible = |p: &Vector3<f64>| CAMERA_DISTANCE - p.z > NEAREST;
        if let Some(ends) = self.clip_line(a, b).filter(|e| e.iter().all(visible)) {
            let ends = ends.map(|p| self.project(p));
            lines.push(Line { ends, ..like });
        }
    }
}

/// Projects everything that is to be seen.
fn compose(scene: &Scene, width: usize, height: usize, options: &StillOptions) -> Picture {
    let layout = &scene.layouts[options.layout];
    let wide = |p: [f32; 3]| p.map(f64::from);
    // The frame is that of what is drawn, or of whatever there is.
    let used = scene.used(layout.places.len());
    let bare = scene.is_bare();
    let drawn = || {
        layout
            .places
            .iter()
            .zip(&used)
            .filter(|(_, u)| **u)
            .map(|(p, _)| wide(*p))
    };
    let alone = layout.places.is_empty();
    let show_points = options.points || bare;
    let frame = Frame::of(drawn())
        .or_else(|| Frame::of(layout.points.iter().map(|p| wide(*p))))
        .unwrap_or_default();
    let place = |p: &[f32; 3]| Vector3::from(frame.place(wide(*p)));
    let places: Vec<Vector3<f64>> = layout.places.iter().map(place).collect();
    let points: Vec<Vector3<f64>> = if show_points {
        layout.points.iter().map(place).collect()
    } else {
        Vec::new()
    };

    let view = choose_view(scene, &places, &points, &used, options);
    let seen: Vec<Vector3<f64>> = if alone {
        points.iter().map(|p| view.of(*p)).collect()
    } else {
        drawn()
            .map(|p| view.of(Vector3::from(frame.place(p))))
            .collect()
    };
    let samples = options.supersampling as f64;
    let size = [width as f64 * samples, height as f64 * samples];
    let shorter = size[0].min(size[1]);
    let curve_width = options
        .curve_width
        .map_or((shorter / 115.0).max(1.6 * samples), |w| w * samples);
    let stage = fit(&seen, &view, size, shorter * MARGIN + curve_width, options);

    let camera: Vec<Vector3<f64>> = places.iter().map(|p| view.of(*p)).collect();
    let normals = corner_normals(
        &places,
        &scene.triangles,
        &scene.curve_edges(),
        options.smooth,
    );
    let mut faces = Vec::with_capacity(scene.triangles.len());
    let mut lines = Vec::new();
    let thin = Line {
        ends: [([0.0; 2], 0.0); 2],
        radius: (shorter / 1600.0).max(0.45 * samples),
        color: [20; 3],
        hidden: 0.0,
        strength: 0.45,
    };
    if options.edges {
        for [a, b] in scene.edges() {
            stage.line(&mut lines, camera[a as usize], camera[b as usize], thin);
        }
    }
    for ((t, &piece), normal) in scene
        .triangles
        .iter()
        .zip(&scene.triangle_piece)
        .zip(&normals)
    {
        if options.without_pieces.contains(&(piece as usize)) {
            continue;
        }
        let color = piece_color(piece as usize);
        let corners: [Placed; 3] =
            std::array::from_fn(|k| (camera[t[k] as usize], view.of(normal[k])));
        let (kept, rim) = stage.clip(corners);
        if let [a, b] = rim[..] {
            let edge = Line {
                radius: curve_width * 0.3,
                color: color.map(|c| c / 3),
                strength: 1.0,
                ..thin
            };
            // Already on the cut: clipping it again would lose half of it to rounding.
            let ends = [a, b].map(|p| stage.project(p));
            lines.push(Line { ends, ..edge });
        }
        let corner = |p: &Placed| {
            let (at, inverse) = stage.project(p.0);
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
    for p in &points {
        let place = view.of(*p);
        let dot = Line {
            radius: curve_width * 0.3,
            color: [70, 70, 76],
            strength: 1.0,
            ..thin
        };
        stage.line(&mut lines, place, place, dot);
    }
    if bare {
        for &place in &camera {
            let dot = Line {
                radius: curve_width * 0.5,
                color: piece_color(0),
                strength: 1.0,
                ..thin
            };
            stage.line(&mut lines, place, place, dot);
        }
    }
    for curve in &scene.curves {
        let share = if curve.kind == CurveKind::Double {
            0.5
        } else {
            0.38
        };
        let like = Line {
            radius: curve_width * share,
            color: curve_color(curve.kind),
            hidden: if options.hidden_curves {
                (curve_width * 0.16).max(0.5)
            } else {
                0.0
            },
            strength: 1.0,
            ..thin
        };
        for e in &curve.edges {
            let [a, b] = e.map(|v| camera[v as usize]);
            stage.line(&mut lines, a, b, like);
        }
    }
    for mark in scene.marks.iter().filter(|m| m.layout == options.layout) {
        let place = view.of(Vector3::from(frame.place(wide(mark.place))));
        let dot = Line {
            radius: curve_width * 0.8,
            color: MARK,
            hidden: curve_width * 0.4,
            strength: 1.0,
            ..thin
        };
        stage.line(&mut lines, place, place, dot);
    }
    Picture {
        faces,
        lines,
        width: width * options.supersampling,
        focal: stage.focal,
        middle: stage.middle,
        background: options.background,
        opacity: options.opacity,
        outline: if options.outlines && options.opacity >= 1.0 {
            ((shorter / 900.0).round() as usize).clamp(1, 6)
        } else {
            0
        },
    }
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

/// Scale and middle of the projection that fit what is seen into the image, and the cut.
fn fit(
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

/// Means over `samples` by `samples` blocks, as bytes.
fn average(colors: &[[f32; 3]], width: usize, rows: usize, samples: usize) -> Vec<u8> {
    let mut out = Vec::with_capacity(width * rows * 3);
    let share = (samples * samples) as f32;
    for row in 0..rows {
        for column in 0..width {
            let mut sum = [0.0_f32; 3];
            for y in 0..samples {
                let start = (row * samples + y) * width * samples + column * samples;
                for color in &colors[start..start + samples] {
                    for (s, c) in sum.iter_mut().zip(color) {
                        *s += c;
                    }
                }
            }
            out.extend(sum.map(|s| (s / share).round() as u8));
        }
    }
    out
}

/// The bytes of a PNG file.
fn encode(width: usize, height: usize, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder
        .write_header()
        .expect("the size was checked and memory takes every write");
    writer
        .write_image_data(pixels)
        .expect("there are width x height pixels of three bytes");
    writer
        .finish()
        .expect("the image is complete and memory takes every write");
    bytes
}

#[cfg(test)]
mod tests {
    use super::super::{Layout, gallery};
    use super::*;
    use proptest::prelude::*;

    fn decode(bytes: &[u8]) -> (usize, usize, Vec<[u8; 3]>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let pixels = pixels.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        (info.width as usize, info.height as usize, pixels)
    }

    fn count(pixels: &[[u8; 3]], like: impl Fn(i32, i32, i32) -> bool) -> usize {
        pixels
            .iter()
            .filter(|p| like(p[0].into(), p[1].into(), p[2].into()))
            .count()
    }

    const RED: fn(i32, i32, i32) -> bool = |r, g, b| r > g + 50 && r > b + 50;
    const GREEN: fn(i32, i32, i32) -> bool = |r, g, b| g > r + 40 && g > b + 15;
    const BLACK: fn(i32, i32, i32) -> bool = |r, g, b| r < 24 && g < 24 && b < 24;

    #[test]
    fn two_pieces_and_their_double_curve_are_seen() {
        let scene = gallery::two_spheres(4);
        let lined = StillOptions {
            outlines: false,
            ..StillOptions::default()
        };
        let image = still(&scene, 240, 180, &lined).unwrap();
        let (width, height, pixels) = decode(&image);
        assert_eq!((width, height, pixels.len()), (240, 180, 240 * 180));
        assert!(count(&pixels, RED) > 4000, "{}", count(&pixels, RED));
        assert!(count(&pixels, GREEN) > 4000, "{}", count(&pixels, GREEN));
        assert!(count(&pixels, BLACK) > 50, "{}", count(&pixels, BLACK));
        // Nothing touches the border.
        let border =
            |k: usize| k.is_multiple_of(240) || k % 240 == 239 || !(240..240 * 179).contains(&k);
        assert!(
            (0..pixels.len())
                .filter(|k| border(*k))
                .all(|k| pixels[k] == [255; 3])
        );
        // Without the curves no black is left, without a piece no color of it.
        let mut bare = scene.clone();
        bare.curves.clear();
        let options = StillOptions {
            without_pieces: vec![1],
            ..lined
        };
        let (_, _, pixels) = decode(&still(&bare, 240, 180, &options).unwrap());
        assert_eq!(count(&pixels, BLACK) + count(&pixels, GREEN), 0);
        assert!(count(&pixels, RED) > 4000);
    }

    #[test]
    fn the_nearer_piece_hides_the_other() {
        let scene = gallery::two_spheres(4);
        let from = |x: f64| {
            let options = StillOptions {
                direction: Some([x, 0.0, 0.0]),
                ..StillOptions::default()
            };
            decode(&still(&scene, 100, 100, &options).unwrap()).2[50 * 100 + 50]
        };
        let [r, g, b] = from(1.0).map(i32::from);
        assert!(RED(r, g, b), "{r} {g} {b}");
        let [r, g, b] = from(-1.0).map(i32::from);
        assert!(GREEN(r, g, b), "{r} {g} {b}");
    }

    #[test]
    fn a_cut_opens_and_glass_shows_both() {
        let scene = gallery::two_spheres(4);
        let middle = |options: StillOptions| {
            let options = StillOptions {
                direction: Some([1.0, 0.0, 0.0]),
                ..options
            };
            decode(&still(&scene, 100, 100, &options).unwrap()).2[50 * 100 + 50].map(i32::from)
        };
        // The first third of the extent along x belongs to the green sphere alone.
        let [r, g, b] = middle(StillOptions {
            cut: Some(Cut {
                direction: None,
                keep: 0.3,
            }),
            ..StillOptions::default()
        });
        assert!(GREEN(r, g, b), "{r} {g} {b}");
        let opaque = middle(StillOptions::default());
        let glass = middle(StillOptions {
            opacity: 0.4,
            ..StillOptions::default()
        });
        assert!(glass[1] > opaque[1] + 15, "{glass:?} {opaque:?}");
    }

    #[test]
    fn the_same_scene_gives_the_same_bytes_on_any_number_of_threads() {
        let scene = gallery::two_spheres(3);
        for options in [
            StillOptions::default(),
            StillOptions {
                opacity: 0.5,
                edges: true,
                points: true,
                ..StillOptions::default()
            },
        ] {
            let many = still(&scene, 131, 97, &options).unwrap();
            let one = rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build()
                .unwrap()
                .install(|| still(&scene, 131, 97, &options).unwrap());
            assert_eq!(many, one);
        }
    }

    fn loose(places: Vec<[f32; 3]>, points: Vec<[f32; 3]>) -> Scene {
        Scene {
            layouts: vec![Layout {
                name: String::new(),
                places,
                points,
            }],
            ..Scene::default()
        }
    }

    #[test]
    fn degenerate_scenes_are_drawn() {
        let far = f32::MAX;
        let mut flat = loose(vec![[2.0; 3]; 3], vec![]);
        flat.triangles = vec![[0, 1, 2], [0, 0, 0]];
        flat.triangle_piece = vec![0, 0];
        flat.piece_names = vec!["point".into()];
        let mut huge = flat.clone();
        huge.layouts[0].places = vec![[far, far, far], [-far, far, 0.0], [0.0, -far, -far]];
        for scene in [
            loose(vec![], vec![]),
            loose(vec![[1.0, 2.0, 3.0]], vec![]),
            loose(vec![], vec![[1.0, 2.0, 3.0]]),
            loose(
                vec![[0.0; 3], [1.0; 3]],
                vec![[far, 0.0, 0.0], [0.0, 0.0, -far]],
            ),
            flat,
            huge,
        ] {
            for (width, height) in [(1, 1), (3, 200), (64, 48)] {
                let image = still(&scene, width, height, &StillOptions::default()).unwrap();
                assert_eq!(decode(&image).2.len(), width * height);
            }
        }
        // One point is seen.
        let image = still(
            &loose(vec![[7.0; 3]], vec![]),
            60,
            60,
            &StillOptions::default(),
        );
        assert!(count(&decode(&image.unwrap()).2, RED) > 3);
    }

    #[test]
    fn refuses_options_out_of_range() {
        let scene = gallery::two_spheres(1);
        let wrong: [fn(&mut StillOptions); 9] = [
            |o| o.layout = 7,
            |o| o.supersampling = 0,
            |o| o.opacity = 0.0,
            |o| o.opacity = f64::NAN,
            |o| o.curve_width = Some(f64::INFINITY),
            |o| o.direction = Some([0.0; 3]),
            |o| o.up = Some([f64::NAN, 0.0, 1.0]),
            |o| {
                o.cut = Some(Cut {
                    direction: None,
                    keep: 1.5,
                })
            },
            |o| {
                o.cut = Some(Cut {
                    direction: Some([0.0; 3]),
                    keep: 0.5,
                })
            },
        ];
        for spoil in wrong {
            let mut options = StillOptions::default();
            spoil(&mut options);
            assert!(still(&scene, 10, 10, &options).is_err(), "{options:?}");
        }
        for (width, height) in [(0, 10), (10, 0), (20_000, 10)] {
            assert!(still(&scene, width, height, &StillOptions::default()).is_err());
        }
        let bad = loose(vec![[f32::NAN; 3]], vec![]);
        assert!(still(&bad, 10, 10, &StillOptions::default()).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn any_triangles_are_drawn(
            places in prop::collection::vec(prop::array::uniform3(
                prop_oneof![-1.0..1.0f32, Just(0.0), prop::num::f32::NORMAL]), 3..12),
            corners in prop::collection::vec(prop::array::uniform3(0usize..100), 0..20),
            direction in prop::option::of(prop::array::uniform3(0.1..1.0f64)),
            keep in prop::option::of(0.0..=1.0f64),
            opacity in 0.1..=1.0f64,
        ) {
            let n = places.len();
            let mut scene = loose(places, vec![]);
            scene.triangles = corners.iter().map(|t| t.map(|v| (v % n) as u32)).collect();
            scene.triangle_piece = vec![0; corners.len()];
            scene.piece_names = vec!["p".into()];
            scene.curves = vec![super::super::Curve {
                kind: CurveKind::Boundary,
                edges: scene.edges(),
            }];
            let options = StillOptions {
                direction,
                opacity,
                edges: true,
                supersampling: 2,
                cut: keep.map(|keep| Cut { direction: None, keep }),
                ..StillOptions::default()
            };
            let image = still(&scene, 40, 30, &options).unwrap();
            prop_assert_eq!(decode(&image).2.len(), 1200);
        }
    }
}
