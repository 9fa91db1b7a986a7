//! Exact Euclidean neighborhoods in any dimension, on kiddo.
