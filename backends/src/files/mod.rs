//! Doors to the outside: point clouds, meshes and distances in the formats people use.
//!
//! | what | read | write |
//! | --- | --- | --- |
//! | points | [`read_points`] | [`write_points`] |
//! | frames of a molecule | [`read_molecule`] | |
//! | indices of points | [`read_indices`] | [`write_indices`] |
//! | meshes | [`read_mesh`] | [`write_mesh`] |
//! | distances | [`read_distances`] | |
//! | reports, pages | | [`write_bytes_whole`] |
//!
//! The extension chooses the format. Three laws hold for all of them:
//! - *whole or not at all*: a failed write leaves what was there before;
//! - *same input, same bytes*: no clock, no order of a hash table;
//! - *a file is not believed*: sizes that a header promises are compared with the bytes that are
//!   there before memory is taken for them, and no content panics; a refusal ([`FileError`]) names
//!   the file, the place in it, what was found and what was expected.

mod any_cloud;
mod distances;
mod error;
mod indices;
mod mat;
mod mesh;
mod mesh_npz;
mod molecule;
mod npy;
mod npz;
mod obj;
mod off;
mod ply;
mod points;
mod table;
mod vtu;
mod whole;

#[cfg(test)]
mod tests;

pub use any_cloud::AnyCloud;
pub use distances::{Distances, read_distances};
pub use error::{FileError, Place};
pub use indices::{read_indices, write_indices};
pub use mesh::{MESH_EXTENSIONS, MeshExtras, MeshFile, read_mesh, write_mesh};
pub use molecule::{Atom, Molecule, read_molecule};
pub use points::{POINT_EXTENSIONS, PointOptions, read_points, write_points};
pub use whole::write_bytes_whole;
