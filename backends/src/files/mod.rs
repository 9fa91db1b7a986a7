//! Doors to the outside: point clouds, meshes and distances in the formats people use.
//!
//! | what | read | write |
//! | --- | --- | --- |
//! | points | [`read_points`], [`read_point_file`] | [`write_points`] |
//! | points, some at a time | [`PointRows`] | |
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
mod columns;
mod distances;
mod error;
mod frames;
mod glb;
mod indices;
mod las;
mod mat;
mod mesh;
mod mesh_npz;
mod mesh_parts;
mod mesh_sheet;
mod molecule;
mod npy;
mod npy_header;
mod npz;
mod obj;
mod off;
mod pcd;
mod ply;
mod ply_reader;
mod point_rows;
mod point_writer;
mod points;
mod remark;
mod stl;
mod table;
mod trajectory;
mod vtk;
mod vtk_xml;
mod vtu;
mod whole;

#[cfg(test)]
mod tests;

pub use any_cloud::AnyCloud;
pub use columns::{ColumnChoice, ColumnName};
pub use distances::{Distances, distances_of_bytes, read_distances};
pub use error::{FileError, Place};
pub use frames::Atom;
pub use indices::{read_indices, write_indices};
pub use mesh::{MESH_EXTENSIONS, MESH_READ_EXTENSIONS, read_mesh, write_mesh};
pub use mesh_npz::NO_TRIANGLES;
pub use mesh_parts::{MeshExtras, MeshFile};
pub use molecule::{Molecule, read_molecule};
pub use point_rows::PointRows;
pub use point_writer::write_points;
pub use points::{POINT_EXTENSIONS, PointFile, PointOptions, read_point_file, read_points};
pub use remark::{Meaning, Remark};
pub use whole::write_bytes_whole;
