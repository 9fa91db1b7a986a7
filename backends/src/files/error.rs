//! What is wrong with a file, and where.

use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Where in a file something is wrong.
///
/// Lines of a text are counted from 1, as editors do; rows and columns of an array from 0, as
/// the program that wrote it does.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole, or its header.
    Whole,
    /// A line of a text, and its field if one is at fault; both counted from 1.
    Line {
        /// The line, from 1.
        line: usize,
        /// The field on that line, from 1.
        field: Option<usize>,
    },
    /// A row of an array, and its column if one is at fault; both counted from 0.
    Row {
        /// Name of the array, empty when the file holds only one.
        array: String,
        /// The row, from 0.
        row: usize,
        /// The column, from 0.
        column: Option<usize>,
    },
    /// A named part: an array of an archive, a variable, an element.
    Part(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line { line, field } => {
                write!(f, "line {line}")?;
                if let Some(field) = field {
                    write!(f, ", column {field}")?;
                }
                write!(f, ": ")
            }
            Self::Row { array, row, column } => {
                if !array.is_empty() {
                    write!(f, "{array}, ")?;
                }
                write!(f, "row {row}")?;
                if let Some(column) = column {
                    write!(f, ", column {column}")?;
                }
                write!(f, " (from 0): ")
            }
            Self::Part(name) => write!(f, "{name}: "),
        }
    }
}

/// Why a file could not be read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// There is no such file.
    #[error("{}: no such file", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The path leads to a folder or a device.
    #[error("{}: not a file but {found}, expected a regular file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// What it leads to.
        found: &'static str,
    },
    /// The folder that the file should go into is not there.
    #[error("{}: there is no folder {}: create it, or choose another place", path.display(), folder.display())]
    Folder {
        /// The file that was to be written.
        path: PathBuf,
        /// The folder that is not there.
        folder: PathBuf,
    },
    /// The system refused to read.
    #[error("{}: cannot read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The system refused to write.
    #[error("{}: cannot write: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The extension names no format that serves here.
    #[error("{}: found {}, expected one of {known}{}", path.display(),
        if extension.is_empty() { "no extension".to_string() } else { format!("extension .{extension}") },
        instead(extension))]
    Extension {
        /// The file.
        path: PathBuf,
        /// Its extension in lower case, empty for none.
        extension: String,
        /// The extensions that serve.
        known: &'static str,
    },
    /// The content is not what the format, or the use, asks for.
    #[error("{}: {place}found {found}, expected {expected}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: Place,
        /// What is there.
        found: String,
        /// What should be there.
        expected: String,
    },
}

/// What to do with a file of a kind that is known and not read.
fn instead(extension: &str) -> &'static str {
    match extension {
        "h5" | "hdf5" | "nc" => ": numpy.save(\"points.npy\", h5py.File(name)[dataset])",
        "parquet" | "feather" | "arrow" | "pkl" | "pickle" => {
            ": numpy.save(\"points.npy\", frame[[\"x\", \"y\", \"z\"]].to_numpy()), with the frame as pandas reads it"
        }
        "xlsx" | "xls" | "ods" => ": save it as .csv",
        "e57" => ": pdal translate points.e57 points.ply",
        "trr" | "nc4" => {
            ": numpy.save(\"frames.npy\", trajectory.xyz.reshape(len(trajectory), -1)), as mdtraj reads it"
        }
        "gltf" | "glb" | "dae" | "fbx" | "3mf" | "step" | "stp" | "iges" => {
            ": convert it to .ply or .stl first"
        }
        "xz" | "bz2" | "zst" | "zip" => ": unpack it, or use gzip",
        _ => "",
    }
}

/// A [`FileError::Content`] before the file has a name: readers work on bytes.
#[derive(Debug)]
pub(crate) struct Flaw {
    pub(crate) place: Place,
    pub(crate) found: String,
    pub(crate) expected: String,
}

/// What a reader of bytes returns.
pub(crate) type Parsed<T> = Result<T, Flaw>;

impl Flaw {
    pub(crate) fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self {
            place: Place::Whole,
            found: found.into(),
            expected: expected.into(),
        }
    }

    pub(crate) fn line(line: usize, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::new(found, expected).at(Place::Line { line, field: None })
    }

    pub(crate) fn field(
        line: usize,
        field: usize,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self::new(found, expected).at(Place::Line {
            line,
            field: Some(field),
        })
    }

    pub(crate) fn row(
        array: &str,
        row: usize,
        column: Option<usize>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self::new(found, expected).at(Place::Row {
            array: array.into(),
            row,
            column,
        })
    }

    pub(crate) fn at(mut self, place: Place) -> Self {
        self.place = place;
        self
    }

    /// Names the part of the file, where no finer place is known.
    pub(crate) fn within(mut self, name: &str) -> Self {
        match &mut self.place {
            Place::Whole => self.place = Place::Part(name.into()),
            Place::Row { array, .. } if array.is_empty() => *array = name.into(),
            _ => {}
        }
        self
    }

    pub(crate) fn of(self, path: &Path) -> FileError {
        FileError::Content {
            path: path.into(),
            place: self.place,
            found: self.found,
            expected: self.expected,
        }
    }
}

/// A piece of the file for a message: short, and without control characters.
pub(crate) fn excerpt(text: &str) -> String {
    let mut shown: String = text.chars().take(40).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    format!("{shown:?}")
}
