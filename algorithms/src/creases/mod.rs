//! Creases of a surface: curves along which a sheet bends sharply, the faces between them and the corners in which they meet.
//!
//! A mesh does not show them by itself: its triangles cut every edge of a cube, and turn where a thin tube
//! does as well. So they are read from the points, over the mesh. Faces are grown from places where the points about a vertex lie on
//! one quadratic sheet; where two of them meet, each is fitted by its own points alone, from its own side, and the two
//! sheets are compared where they meet. On a surface that only bends they continue each other; at a crease they do not, however small
//! a neighborhood is.
//!
//! ```
//! use crosscap_algorithms::creases::{CreaseLimits, creases};
//! use crosscap_algorithms::execute::Serial;
//! use crosscap_core::{Complex, Mesh, PointCloud};
//!
//! // Two squares at a right angle, as a mesh of a grid folded along its middle, which is its own cloud.
//! let at = |u: f64, v: f64| [u.min(0.0), v, u.max(0.0)];
//! let places = (0..169).flat_map(|k| at(f64::from(k % 13) - 6.0, f64::from(k / 13)));
//! let cloud = PointCloud::new(3, places.collect())?;
//! let squares = (0..144).map(|k| k / 12 * 13 + k % 12);
//! let halves = squares.flat_map(|k| [[k, k + 1, k + 13], [k + 1, k + 13, k + 14]]);
//! let mesh = Mesh::new(Complex::new(169, halves.collect(), vec![])?, cloud.clone(), vec![-1; 169])?;
//! let found = creases(&mesh, &cloud, &CreaseLimits::MEASURED, &Serial)?;
//! assert!(found.to_string().starts_with("two faces, one crease (90 degrees;"));
//! # Ok::<(), crosscap_core::Error>(())
//! ```

mod angle;
mod corners;
mod description;
mod faces;
mod found;
mod ground;
mod limits;
mod seams;
mod trails;

pub use found::{Corner, Crease, CreaseAngle, CreaseEnd, Creases};
pub use limits::CreaseLimits;

use crate::execute::Execute;
use crosscap_core::{Error, Mesh, PointCloud};
use faces::Faces;
use ground::Ground;
use seams::Seams;

/// The creases of a mesh as the points show it was made from show them.
///
/// Curves in which three and more cells meet bound faces as well, and are no creases. Where points are too few to tell,
/// there is no crease. The result does not depend on the number of threads.
///
/// O(n log v) for n points, of which at most `points` a vertex are looked at, and v vertices.
///
/// # Errors
/// [`Error::Shape`] for points of another dimension than the mesh has.
pub fn creases(
    mesh: &Mesh,
    points: &PointCloud<f64>,
    limits: &CreaseLimits,
    execute: &dyn Execute,
) -> Result<Creases, Error> {
    if points.dimension() != mesh.vertices.dimension() {
        return Err(Error::Shape {
            found: format!("points of R^{}", points.dimension()),
            expected: format!("points of R^{}", mesh.vertices.dimension()),
        });
    }
    let ground = Ground::new(mesh, points, limits, execute);
    let mut faces = Faces::grown(&ground, execute);
    let seams = loop {
        let seams = Seams::between(&ground, &faces, execute);
        // Each round leaves fewer faces.
        if !faces.join(&seams.smooth()) {
            break seams;
        }
    };
    Ok(seams.creases(&faces))
}

#[cfg(test)]
mod tests;
