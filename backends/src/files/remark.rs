//! What a reader did, or left undone, that the one who reads ought to know.

use std::fmt;

/// What columns behind the positions are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Meaning {
    /// Three columns of unit length.
    Normals {
        /// The first of them, from 0.
        from: usize,
    },
    /// Three columns of whole numbers from 0 to 255.
    Colors {
        /// The first of them, from 0.
        from: usize,
    },
}

/// What a reader did, or left undone, that the one who reads ought to know. Columns count from 0.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// Columns were taken because of their names, others were left.
    Named {
        /// Those that were taken.
        taken: Vec<String>,
        /// Those that were left.
        left: Vec<String>,
    },
    /// The first three columns were taken, because the others are no positions.
    FirstThree {
        /// How many columns there are.
        columns: usize,
        /// What the others are, as far as they show.
        meanings: Vec<Meaning>,
    },
    /// All columns were taken, though some of them look like normals or colors.
    Suspect {
        /// How many columns there are.
        columns: usize,
        /// What some of them look like.
        meanings: Vec<Meaning>,
    },
    /// All columns were taken, and they are as many as positions with an intensity, normals or
    /// colors have.
    Many {
        /// How many columns there are.
        columns: usize,
    },
    /// A column that was taken numbers the rows.
    Counts {
        /// The column.
        column: usize,
    },
    /// A column that was taken is the same in all rows.
    Constant {
        /// The column.
        column: usize,
        /// What stands in it.
        value: f64,
    },
    /// There are many more coordinates than points: rows and columns may have changed places.
    Wide {
        /// Number of points, the rows.
        rows: usize,
        /// Number of coordinates, the columns.
        columns: usize,
    },
    /// Single or half precision cannot tell neighboring points well apart.
    Coarse {
        /// Bits of a number.
        bits: u32,
        /// Largest coordinate in absolute value, the unit of the data.
        largest: f64,
        /// Distance between two numbers of that size that can be stored.
        step: f64,
        /// About how far apart the points are, were they spread evenly over a surface.
        spacing: f64,
    },
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (what, from) = match self {
            Self::Normals { from } => ("unit normals", from),
            Self::Colors { from } => ("colors", from),
        };
        write!(f, "columns {from} to {} are {what}", from + 2)
    }
}

fn listed(meanings: &[Meaning]) -> String {
    let all: Vec<String> = meanings.iter().map(ToString::to_string).collect();
    all.join(", ")
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named { taken, left } => write!(
                f,
                "taken for coordinates: {}; left out: {} (--columns all takes every column)",
                taken.join(", "),
                left.join(", ")
            ),
            Self::FirstThree { columns, meanings } => {
                write!(
                    f,
                    "the first three of {columns} columns are taken for coordinates"
                )?;
                if !meanings.is_empty() {
                    write!(f, ", as {} (counted from 0)", listed(meanings))?;
                }
                write!(f, "; --columns all takes every column")
            }
            Self::Suspect { columns, meanings } => write!(
                f,
                "all {columns} columns are taken for coordinates, although {} by the look of them (counted from 0); \
                 if so: --columns 0,1,2",
                listed(meanings)
            ),
            Self::Many { columns } => write!(
                f,
                "all {columns} columns are taken for coordinates of points in R^{columns}; if the last of them are \
                 intensities, normals or colors: --columns 0,1,2"
            ),
            Self::Counts { column } => write!(
                f,
                "column {column} (from 0) numbers the rows and is taken for a coordinate; --columns takes others"
            ),
            Self::Constant { column, value } => write!(
                f,
                "column {column} (from 0) is {value} in all rows; --columns leaves it out"
            ),
            Self::Wide { rows, columns } => write!(
                f,
                "{rows} rows are taken for points, {columns} columns for their coordinates; if it is the other way \
                 round: --transpose"
            ),
            Self::Coarse {
                bits,
                largest,
                step,
                spacing,
            } => write!(
                f,
                "coordinates as large as {largest:.3e} in {bits} bits are {step:.1e} apart at least, the points about \
                 {spacing:.1e}: subtract an offset before the file is written, or write 64 bits"
            ),
        }
    }
}
