//! Lists of point indices, such as the points of a given boundary.

use super::error::{FileError, Flaw, Parsed};
use super::whole::{extension, packed_extension, read_bytes, write_bytes_whole};
use super::{npy, table};
use std::fmt::Write;
use std::path::Path;

const EXTENSIONS: &str = ".npy, .txt";

/// Reads row indices, counted from 0: a one-dimensional integer `.npy`, or a `.txt` with numbers
/// between white space or commas and `#` comments.
///
/// An empty list is a list. Whether the indices are below the number of points is for the one to
/// ask who has the points.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] with the place of a negative index, of what is
/// no integer, or for an array that is not one-dimensional; those of reading.
///
/// ```
/// use crosscap_backends::files::{read_indices, write_indices};
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("boundary.npy");
/// write_indices(&path, &[3, 1, 4]).unwrap();
/// assert_eq!(read_indices(&path).unwrap(), [3, 1, 4]);
/// ```
pub fn read_indices(path: impl AsRef<Path>) -> Result<Vec<usize>, FileError> {
    let path = path.as_ref();
    let extension = packed_extension(path);
    if !matches!(extension.as_str(), "npy" | "txt") {
        return Err(unknown(path, &extension));
    }
    parse(&extension, &read_bytes(path)?).map_err(|flaw| flaw.of(path))
}

/// Writes row indices as int64 `.npy` or as `.txt`, one a line; whole or not at all.
///
/// # Errors
/// [`FileError::Extension`]; those of [`write_bytes_whole`].
pub fn write_indices(path: impl AsRef<Path>, indices: &[usize]) -> Result<(), FileError> {
    let path = path.as_ref();
    let extension = extension(path);
    let bytes = indices_bytes(&extension, indices).ok_or_else(|| unknown(path, &extension))?;
    write_bytes_whole(path, &bytes)
}

fn unknown(path: &Path, extension: &str) -> FileError {
    FileError::Extension {
        path: path.into(),
        extension: extension.into(),
        known: EXTENSIONS,
    }
}

/// The bytes of an index file; `None` for an unknown extension.
pub(crate) fn indices_bytes(extension: &str, indices: &[usize]) -> Option<Vec<u8>> {
    match extension {
        "npy" => {
            let wide: Vec<i64> = indices.iter().map(|&i| i as i64).collect();
            Some(npy::bytes(&[wide.len()], &wide))
        }
        "txt" => {
            let mut text = String::new();
            for i in indices {
                // Formatting into a string cannot fail.
                let _ = writeln!(text, "{i}");
            }
            Some(text.into_bytes())
        }
        _ => None,
    }
}

/// Reads the bytes of an index file with a known extension.
pub(crate) fn parse(extension: &str, bytes: &[u8]) -> Parsed<Vec<usize>> {
    if extension == "txt" {
        let mut indices = Vec::new();
        for (at, row) in table::text(bytes)?.lines().enumerate() {
            let row = row.split('#').next().unwrap_or("");
            let fields = row.split([',', ' ', '\t']).map(str::trim);
            for (k, field) in fields.filter(|f| !f.is_empty()).enumerate() {
                indices.push(field.parse().map_err(|_| {
                    Flaw::field(
                        at + 1,
                        k + 1,
                        super::error::excerpt(field),
                        "an index: a whole number from 0",
                    )
                })?);
            }
        }
        return Ok(indices);
    }
    let array = npy::parse(bytes)?;
    if array.shape.len() != 1 {
        return Err(Flaw::new(
            format!("an array of shape {:?}", array.shape),
            "one dimension",
        ));
    }
    array
        .into_integers()?
        .into_iter()
        .enumerate()
        .map(|(row, i)| {
            usize::try_from(i).map_err(|_| {
                Flaw::row(
                    "",
                    row,
                    None,
                    i.to_string(),
                    "an index: a whole number from 0",
                )
            })
        })
        .collect()
}
