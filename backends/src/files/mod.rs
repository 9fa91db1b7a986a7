//! Doors to the outside: point clouds and meshes in the formats people use.
