//! Low-dimensional pictures of R^N: principal axes and Isomap.
