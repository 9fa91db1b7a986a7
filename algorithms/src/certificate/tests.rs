//! Whole meshes, good and broken.
