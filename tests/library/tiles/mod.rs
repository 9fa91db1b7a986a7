//! A cloud in tiles is the same surface as the cloud as a whole, to the last bit, whatever the tiles are.

mod boundaries;
mod curves;
mod same;
mod surfaces;
