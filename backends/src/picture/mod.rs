//! Pictures of a mesh: a page to turn it in and a still image.
//!
//! | door | gives | for |
//! | --- | --- | --- |
//! | [`page`] | one self-contained HTML file | turning, cutting open, switching pieces off |
//! | [`still`] | a PNG image | reports, README files, a quick look |
//!
//! Both take a [`Scene`]: triangles named by piece, marked curves, and one or several
//! [`Layout`]s, that is ways to put the vertices into three dimensions. A scene is checked
//! before anything is drawn; nothing in it, however degenerate, makes either of them panic.
//!
//! ```
//! use crosscap_backends::picture::{Layout, Scene, StillOptions, page, still};
//! use crosscap_core::{Complex, PointCloud};
//! let places = PointCloud::new(3, vec![
//!     0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
//! ])?;
//! let sphere = Complex::new(4, vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]], vec![])?;
//! let layout = Layout::coordinates("x, y, z", &places, None, [0, 1, 2])?;
//! let scene = Scene::new("Tetrahedron", &sphere, vec![layout]);
//! assert!(page(&scene)?.starts_with("<!DOCTYPE html>"));
//! let image = still(&scene, 64, 48, &StillOptions::default())?;
//! assert_eq!(&image[1..4], b"PNG");
//! # Ok::<(), crosscap_core::Error>(())
//! ```

#[cfg(test)]
mod gallery;
mod page;
mod palette;
mod png;
mod raster;
mod scene;
mod shade;
mod view;

pub use self::page::page;
pub use self::png::{Cut, StillOptions, still};
pub use palette::{curve_color, piece_color};
pub use scene::{Curve, CurveKind, Layout, Mark, Scene, SceneScalar};
