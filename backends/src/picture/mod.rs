//! Pictures of a mesh: a page to turn it in and a still image.
