//! The points of a NumPy array that is read some rows at a time.
//!
//! Rows are read by the system's calls and not through a map of the file into memory: a map needs code that the compiler
//! cannot check, ends the process where the file is cut short meanwhile, and its pages count as memory that is held.

use super::any_cloud::cloud;
use super::error::{FileError, Flaw, Parsed, Place};
use super::npy::{Array, Numbers, decode};
use super::npy_header::{self, LONGEST};
use super::points::{PointFile, PointOptions, from_array};
use crosscap_core::PointCloud;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes before and behind the text of a header that say what it is and how long.
const PREAMBLE: usize = 12;

/// The points of an `.npy` file, of which no more are in memory than were asked for.
///
/// They are those of [`read_points`](super::read_points), number by number.
///
/// ```
/// use crosscap_backends::files::{PointRows, write_points};
/// use crosscap_core::PointCloud;
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("points.npy");
/// write_points(&path, &PointCloud::new(2, vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]).unwrap()).unwrap();
/// let rows = PointRows::open(&path).unwrap();
/// assert_eq!((rows.len(), rows.dimension()), (3, 2));
/// assert_eq!(rows.read(1..3).unwrap().coordinates(), [2.0, 3.0, 4.0, 5.0]);
/// ```
#[derive(Debug)]
pub struct PointRows {
    path: PathBuf,
    file: File,
    layout: Layout,
}

/// Where the numbers of an array are in its file.
#[derive(Debug)]
struct Layout {
    /// Bytes before the first number.
    begin: u64,
    rows: usize,
    columns: usize,
    /// Whether the rows of a column stand together, rather than the columns of a row.
    by_columns: bool,
    kind: String,
    big: bool,
    /// Bytes of a number.
    width: usize,
}

impl PointRows {
    /// Opens a file of plain numbers in two dimensions; nothing but its header is read.
    ///
    /// # Errors
    /// [`FileError::Missing`], [`FileError::NotAFile`], [`FileError::Read`]; [`FileError::Content`] for what is no such
    /// array, records, or a size that is not what the header promises.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let unread = |source: std::io::Error| match source.kind() {
            std::io::ErrorKind::NotFound => FileError::Missing { path: path.into() },
            _ => FileError::Read {
                path: path.into(),
                source,
            },
        };
        let file = File::open(path).map_err(unread)?;
        let metadata = file.metadata().map_err(unread)?;
        if !metadata.is_file() {
            return Err(FileError::NotAFile {
                path: path.into(),
                found: "a folder, a device or a pipe",
            });
        }
        let mut head = Vec::new();
        let most = (PREAMBLE + LONGEST) as u64;
        (&file).take(most).read_to_end(&mut head).map_err(unread)?;
        let layout = Layout::of(&head, metadata.len()).map_err(|flaw| flaw.of(path))?;
        Ok(Self {
            path: path.into(),
            file,
            layout,
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.layout.rows
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.layout.rows == 0
    }

    /// N, the dimension of the space that the points lie in.
    pub fn dimension(&self) -> usize {
        self.layout.columns
    }

    /// Some points, one after the other. Memory: these, twice.
    ///
    /// # Errors
    /// [`FileError::Read`]; [`FileError::Content`] with row and column for a number that is not finite.
    pub fn read(&self, rows: Range<usize>) -> Result<PointCloud<f64>, FileError> {
        let numbers = self.numbers(rows.clone())?;
        let points = cloud(rows.len(), self.layout.columns, numbers);
        let points = points.map_err(|flaw| in_file(flaw, |row| rows.start + row).of(&self.path))?;
        Ok(points.into_f64())
    }

    /// At most `count` points, evenly picked, with what is to be told of their columns.
    ///
    /// # Errors
    /// Those of [`read`](Self::read), and [`FileError::Content`] where there is no point, or one coordinate.
    pub fn sample(&self, count: usize) -> Result<PointFile, FileError> {
        let Layout { rows, columns, .. } = self.layout;
        let picked = rows.min(count);
        let row = |k: usize| (k as u128 * rows as u128 / picked.max(1) as u128) as usize;
        let mut all = self.numbers(0..0)?;
        for k in 0..picked {
            all.extend(self.numbers(row(k)..row(k) + 1)?);
        }
        let array = Array::new(vec![picked, columns], all);
        from_array(array, &PointOptions::default())
            .map_err(|flaw| in_file(flaw, row).of(&self.path))
    }

    fn numbers(&self, rows: Range<usize>) -> Result<Numbers, FileError> {
        let Layout {
            begin,
            columns,
            width,
            by_columns,
            ..
        } = self.layout;
        let (count, all) = (rows.len(), self.layout.rows);
        let mut bytes = vec![0; count * columns * width];
        let read = |from: usize, part: &mut [u8]| {
            let at = begin + (from * width) as u64;
            let mut file = &self.file;
            file.seek(SeekFrom::Start(at))
                .and_then(|_| file.read_exact(part))
                .map_err(|source| FileError::Read {
                    path: self.path.clone(),
                    source,
                })
        };
        if by_columns && count > 0 {
            let parts = bytes.chunks_exact_mut(count * width);
            for (column, part) in parts.enumerate() {
                read(column * all + rows.start, part)?;
            }
        } else {
            read(rows.start * columns, &mut bytes)?;
        }
        let numbers = decode(&self.layout.kind, self.layout.big, &bytes);
        let numbers = numbers.map_err(|flaw| flaw.of(&self.path))?;
        Ok(match by_columns {
            true => numbers.transposed(columns, count),
            false => numbers,
        })
    }
}

impl Layout {
    /// What the first bytes of a file say of all of them.
    fn of(head: &[u8], length: u64) -> Parsed<Self> {
        if head.is_empty() {
            return Err(Flaw::new("an empty file", "a NumPy array"));
        }
        let (header, rest) = npy_header::parse(head)?;
        if header.record {
            return Err(Flaw::new(
                format!("records of {} fields", header.fields.len()),
                "plain numbers, which can be read some rows at a time: \
                 numpy.lib.recfunctions.structured_to_unstructured(array) makes them",
            ));
        }
        let begin = (head.len() - rest.len()) as u64;
        let entry = header.entry() as u64;
        let promised = header.shape.iter().try_fold(entry, |product, &n| {
            product.checked_mul(u64::try_from(n).ok()?)
        });
        if promised != Some(length - begin) {
            return Err(Flaw::new(
                format!("{} bytes of data", length - begin),
                format!(
                    "those that the header promises, as the shape is {:?}",
                    header.shape
                ),
            ));
        }
        let field = &header.fields[0];
        // Whether these are numbers.
        decode(&field.kind, field.big, &[])?;
        let (kind, big, width) = (field.kind.clone(), field.big, field.width);
        let (rows, columns) = Array::new(header.shape, Numbers::F64(vec![])).rows_columns()?;
        Ok(Self {
            begin,
            rows,
            columns,
            by_columns: header.fortran && rows > 1 && columns > 1,
            kind,
            big,
            width,
        })
    }
}

/// The flaw with the row that the file has it in.
fn in_file(mut flaw: Flaw, name: impl Fn(usize) -> usize) -> Flaw {
    if let Place::Row { row, .. } = &mut flaw.place {
        *row = name(*row);
    }
    flaw
}

#[cfg(test)]
mod tests {
    use super::super::npy::{Stored, bytes};
    use super::super::{read_points, write_bytes_whole};
    use super::*;
    use half::f16;

    fn file_of(bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.npy");
        write_bytes_whole(&path, bytes).unwrap();
        (folder, path)
    }

    fn in_pieces(bytes: &[u8]) {
        let (_folder, path) = file_of(bytes);
        let whole = read_points(&path, &PointOptions::default())
            .unwrap()
            .into_f64();
        let rows = PointRows::open(&path).unwrap();
        assert_eq!(
            (rows.len(), rows.dimension()),
            (whole.len(), whole.dimension())
        );
        let mut all = Vec::new();
        for start in (0..rows.len()).step_by(3) {
            let piece = rows.read(start..rows.len().min(start + 3)).unwrap();
            all.extend_from_slice(piece.coordinates());
        }
        assert_eq!(all, whole.coordinates());
        let sample = rows.sample(4).unwrap().points.into_f64();
        assert_eq!(sample, whole.select(&[0, 2, 5, 7]));
        assert_eq!(rows.sample(1000).unwrap().points.into_f64(), whole);
    }

    fn numbers<T: Stored>(of: impl Fn(i32) -> T) -> Vec<u8> {
        let numbers: Vec<T> = (0..20).map(|k| of(k * k - 7)).collect();
        bytes(&[10, 2], &numbers)
    }

    #[test]
    fn pieces_are_those_of_the_whole_file() {
        in_pieces(&numbers(|k| f64::from(k) / 3.0));
        in_pieces(&numbers(|k| k as f32 / 3.0));
        in_pieces(&numbers(|k| f16::from_f32(k as f32)));
        in_pieces(&numbers(i64::from));
        let mut turned = numbers(f64::from);
        let at = turned.windows(5).position(|w| w == b"False").unwrap();
        turned[at..at + 5].copy_from_slice(b"True ");
        in_pieces(&turned);
    }

    #[test]
    fn a_number_that_is_not_finite_is_named_by_its_row() {
        let mut all = vec![0.5; 40];
        all[27] = f64::NAN;
        let (_folder, path) = file_of(&bytes(&[20, 2], &all));
        let rows = PointRows::open(&path).unwrap();
        let error = rows.read(10..20).unwrap_err().to_string();
        assert!(
            error.contains("row 13, column 1 (from 0): found NaN"),
            "{error}"
        );
        assert!(rows.read(0..10).is_ok());
        let error = rows.sample(20).unwrap_err().to_string();
        assert!(error.contains("row 13"), "{error}");
    }

    #[test]
    fn a_file_is_not_believed() {
        let whole = numbers(f64::from);
        for (bytes, part) in [
            (&whole[..whole.len() - 1], "159 bytes of data"),
            (&whole[..40], "truncated"),
            (&b""[..], "an empty file"),
        ] {
            let (_folder, path) = file_of(bytes);
            let error = PointRows::open(&path).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        let (folder, path) = file_of(&bytes(&[4], &[1.0; 4]));
        let error = PointRows::open(&path).unwrap_err().to_string();
        assert!(error.contains("reshape"), "{error}");
        assert!(matches!(
            PointRows::open(folder.path()),
            Err(FileError::NotAFile { .. })
        ));
        assert!(matches!(
            PointRows::open(folder.path().join("none.npy")),
            Err(FileError::Missing { .. })
        ));
    }
}
