//! How points are taken from a file that leaves a choice.

use clap::Args;
use crosscap_backends::files::PointOptions;

#[derive(Args, Debug)]
pub struct PointArguments {
    /// Which array of a .npz of points, which variable of a .mat [default: points, vertices, or the only one]
    #[arg(long, value_name = "NAME")]
    array: Option<String>,

    /// The points are the columns of the array or table
    #[arg(long)]
    transpose: bool,
}

impl PointArguments {
    /// As the reader takes it.
    pub fn options(&self) -> PointOptions {
        PointOptions {
            array: self.array.clone(),
            transpose: self.transpose,
        }
    }
}
