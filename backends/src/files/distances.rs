//! Distances that were measured or computed elsewhere.

use super::error::{FileError, Flaw, Parsed};
use super::npy;
use super::npz::Archive;
use super::whole::{packed_extension, read_bytes};
use crosscap_core::{Row, SparseDistances};
use std::path::Path;

const EXTENSIONS: &str = ".npy, .npz";

/// Largest difference of the two directions, and largest distance of a point to itself, relative to the
/// largest distance, that passes as rounding: single precision with room for a sum of a few terms.
const ROUNDING: f64 = 1e-5;

/// A symmetric matrix of distances.
#[derive(Clone, Debug, PartialEq)]
pub enum Distances {
    /// Every distance.
    Dense {
        /// Number of points, n.
        count: usize,
        /// n * n distances in row order, symmetric to the bit, 0 on the diagonal.
        values: Vec<f64>,
    },
    /// Some distances; the others are not known.
    Sparse(SparseDistances<f64, Row>),
}

impl Distances {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Self::Dense { count, .. } => *count,
            Self::Sparse(kept) => kept.len(),
        }
    }

    /// Whether there is no point; files without one are refused.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Reads a matrix of distances: dense from `.npy`, sparse from what `scipy.sparse.save_npz`
/// writes (`csr`, `csc`, `coo`).
///
/// What is within 1e-5 of the largest distance passes as rounding: on the diagonal and below zero it
/// becomes 0. Dense: the two directions of a pair may differ by as much and become their mean. Sparse: a pair may be there in one direction or in both, which must agree likewise
/// (the mean is kept); stored zeros are distances, the diagonal must be zero.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] with row and column for a distance that is not
/// finite or negative, a diagonal that is not zero, two directions that differ, a matrix that is
/// not square, indices out of range or twice; those of reading.
///
/// ```
/// use crosscap_backends::files::{Distances, read_distances, write_points};
/// use crosscap_core::PointCloud;
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("distances.npy");
/// write_points(&path, &PointCloud::new(2, vec![0.0, 3.0, 3.0, 0.0]).unwrap()).unwrap();
/// let Distances::Dense { count, values } = read_distances(&path).unwrap() else { panic!() };
/// assert_eq!((count, values[1]), (2, 3.0));
/// ```
pub fn read_distances(path: impl AsRef<Path>) -> Result<Distances, FileError> {
    let path = path.as_ref();
    known(path)?;
    distances_of_bytes(path, &read_bytes(path)?)
}

/// The same from the bytes of such a file, which need not exist: `path` tells the format, and is
/// what a refusal calls it.
///
/// # Errors
/// Those of [`read_distances`] but for reading.
pub fn distances_of_bytes(path: impl AsRef<Path>, bytes: &[u8]) -> Result<Distances, FileError> {
    let path = path.as_ref();
    parse(&known(path)?, bytes).map_err(|flaw| flaw.of(path))
}

fn known(path: &Path) -> Result<String, FileError> {
    let extension = packed_extension(path);
    if matches!(extension.as_str(), "npy" | "npz") {
        return Ok(extension);
    }
    Err(FileError::Extension {
        path: path.into(),
        extension,
        known: EXTENSIONS,
    })
}

/// Reads the bytes of a distance file with a known extension.
pub(crate) fn parse(extension: &str, bytes: &[u8]) -> Parsed<Distances> {
    if extension == "npy" {
        dense(bytes)
    } else {
        sparse(bytes)
    }
}

/// The distance that an entry stands for: what rounding leaves of 0, also below it, is 0.
///
/// Differences of squares (|a|^2 + |b|^2 - 2 a.b) leave 1e-8 of the distance of a point to itself, one
/// minus a cosine leaves 2e-16 or its negative.
fn entry(d: f64, limit: f64, row: usize, column: usize) -> Parsed<f64> {
    let flaw = |expected: String| Err(Flaw::row("", row, Some(column), d.to_string(), expected));
    if !d.is_finite() || d < -limit {
        return flaw("a finite distance, 0 or more".into());
    }
    if row == column && d.abs() > limit {
        return flaw(format!(
            "0 within {limit}, as the distance of a point to itself"
        ));
    }
    Ok(if row == column { 0.0 } else { d.max(0.0) })
}

/// What passes as rounding among these distances.
fn rounding(distances: &[f64]) -> f64 {
    ROUNDING * distances.iter().fold(0.0_f64, |a, &b| a.max(b))
}

fn directions(a: f64, b: f64, limit: f64, row: usize, column: usize) -> Parsed<f64> {
    if (a - b).abs() > limit {
        return Err(Flaw::row(
            "",
            row,
            Some(column),
            format!("{a}, and {b} in the other direction"),
            format!("the same within {limit}"),
        ));
    }
    // Halves first: the sum of two finite numbers need not be finite.
    Ok(if a == b { a } else { 0.5 * a + 0.5 * b })
}

fn dense(bytes: &[u8]) -> Parsed<Distances> {
    let array = npy::parse(bytes)?;
    let (count, columns) = array.rows_columns()?;
    if count != columns || count == 0 {
        return Err(Flaw::new(
            format!("{count} rows of {columns} columns"),
            "a square matrix of distances",
        ));
    }
    let mut values = array.numbers.into_f64();
    let limit = rounding(&values);
    for (at, d) in values.iter_mut().enumerate() {
        *d = entry(*d, limit, at / count, at % count)?;
    }
    for a in 0..count {
        for b in 0..a {
            let mean = directions(values[a * count + b], values[b * count + a], limit, a, b)?;
            values[a * count + b] = mean;
            values[b * count + a] = mean;
        }
    }
    Ok(Distances::Dense { count, values })
}

fn sparse(bytes: &[u8]) -> Parsed<Distances> {
    let mut archive = Archive::open(bytes)?;
    let count = rows_of(&mut archive)?;
    if !archive.has("indptr") && !archive.has("row") {
        return Err(missing("indptr or row"));
    }
    let data = archive.array("data")?;
    if data.shape.len() != 1 {
        return Err(Flaw::new(format!("shape {:?}", data.shape), "one dimension").within("data"));
    }
    let data = data.numbers.into_f64();
    let (rows, columns) = match archive.has("indptr") {
        true => compressed(&mut archive, count)?,
        false => {
            let rows = indices(&mut archive, "row", count)?;
            (rows, indices(&mut archive, "col", count)?)
        }
    };
    if rows.len() != data.len() || columns.len() != data.len() {
        return Err(Flaw::new(
            format!(
                "{} distances at {} rows and {} columns",
                data.len(),
                rows.len(),
                columns.len()
            ),
            "as many of each",
        ));
    }
    // The coordinate form has no array as long as the matrix has rows: a shape without entries
    // would cost memory that the file does not pay for.
    if count > bytes.len().saturating_mul(16) {
        return Err(Flaw::new(
            format!("a matrix of {count} rows with {} distances", data.len()),
            "distances for most of the rows",
        ));
    }
    SparseDistances::new(count, pairs(&rows, &columns, &data)?)
        .map(Distances::Sparse)
        .map_err(|e| Flaw::new(e.to_string(), "a matrix of distances"))
}

fn missing(name: &str) -> Flaw {
    Flaw::new(
        format!("no array {name}"),
        "a sparse matrix in csr, csc or coo form",
    )
}

/// Number of rows of a sparse matrix, which is square.
fn rows_of(archive: &mut Archive<'_>) -> Parsed<usize> {
    let shape = archive
        .integers("shape", None)?
        .ok_or_else(|| missing("shape"))?;
    match shape[..] {
        [rows, columns] if rows == columns && (1..=i64::from(u32::MAX)).contains(&rows) => {
            Ok(rows as usize)
        }
        _ => Err(Flaw::new(
            format!("shape {shape:?}"),
            "a square matrix of 1 to 4294967295 rows",
        )),
    }
}

/// An array of rows or columns, all of them below `count`.
fn indices(archive: &mut Archive<'_>, name: &str, count: usize) -> Parsed<Vec<u32>> {
    let all = archive.integers(name, None)?.ok_or_else(|| missing(name))?;
    let index = |(at, i): (usize, i64)| {
        let inside = u32::try_from(i).ok().filter(|&i| (i as usize) < count);
        inside.ok_or_else(|| {
            let expected = format!("an index from 0 to {}", count - 1);
            Flaw::row(name, at, None, i.to_string(), expected)
        })
    };
    all.into_iter().enumerate().map(index).collect()
}

/// Rows and columns of the entries in one of the compressed forms; which of the two is which does not matter, since distances go
/// both ways.
fn compressed(archive: &mut Archive<'_>, count: usize) -> Parsed<(Vec<u32>, Vec<u32>)> {
    let columns = indices(archive, "indices", count)?;
    let starts = archive
        .integers("indptr", None)?
        .ok_or_else(|| missing("indptr"))?;
    let ordered = starts.windows(2).all(|w| w[0] <= w[1]);
    let ends = (starts.first(), starts.last());
    // Also bounds the memory: a matrix of n rows has n + 1 starts in the file.
    if starts.len() != count + 1 || !ordered || ends != (Some(&0), Some(&(columns.len() as i64))) {
        return Err(Flaw::new(
            format!("{} starts from {:?} to {:?}", starts.len(), ends.0, ends.1),
            format!("{}, rising from 0 to {}", count + 1, columns.len()),
        )
        .within("indptr"));
    }
    let rows = starts
        .windows(2)
        .zip(0..)
        .flat_map(|(w, row)| (w[0]..w[1]).map(move |_| row))
        .collect();
    Ok((rows, columns))
}

/// The distances, one a pair, wherever the file has them.
fn pairs(rows: &[u32], columns: &[u32], data: &[f64]) -> Parsed<Vec<(Row, Row, f64)>> {
    let limit = rounding(data);
    let mut entries: Vec<(u32, u32, bool, f64)> = Vec::with_capacity(data.len());
    for ((&a, &b), &d) in rows.iter().zip(columns).zip(data) {
        let d = entry(d, limit, a as usize, b as usize)?;
        entries.push((a.min(b), a.max(b), a > b, d));
    }
    entries.sort_unstable_by_key(|&(a, b, turned, _)| (a, b, turned));
    let mut pairs = Vec::with_capacity(entries.len());
    for run in entries.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let (a, b, _, d) = run[0];
        let d = match run {
            [_] => d,
            [first, second] if first.2 != second.2 => {
                directions(d, second.3, limit, a as usize, b as usize)?
            }
            _ => {
                return Err(Flaw::row(
                    "",
                    a as usize,
                    Some(b as usize),
                    "more than one distance",
                    "one: sum or drop duplicates before saving",
                ));
            }
        };
        pairs.push((Row::from(a), Row::from(b), d));
    }
    Ok(pairs)
}
