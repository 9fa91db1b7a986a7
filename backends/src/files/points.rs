//! Point clouds from and to files.

use super::any_cloud::{AnyCloud, cloud};
use super::error::{FileError, Flaw, Parsed};
use super::npy::{Array, Numbers};
use super::npz::Archive;
use super::whole::{extension, read_bytes, write_bytes_whole};
use super::{mat, molecule, npy, ply, table};
use crosscap_core::PointCloud;
use ndarray::ArrayView2;
use std::path::Path;

/// The extensions that [`read_points`] knows.
pub const POINT_EXTENSIONS: &str = ".npy, .npz, .csv, .txt, .xyz, .pdb, .ply, .mat";

/// How to take points from a file that leaves a choice.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PointOptions {
    /// Which array of a `.npz`, which variable of a `.mat`.
    ///
    /// Left out: `points` or `vertices` if there is one, else the only one there is (of a `.mat`:
    /// the only real numeric matrix).
    pub array: Option<String>,
    /// Whether the points are the columns, rather than the rows, of the array or table.
    pub transpose: bool,
}

/// Reads a point cloud in the format that the extension names.
///
/// | format | what is read |
/// | --- | --- |
/// | `.npy` | 2 dimensions, float32 or float64 (kept) or integers (as f64), any order and endianness |
/// | `.npz` | one such array, see [`PointOptions::array`] |
/// | `.csv`, `.txt`, `.xyz` | a table: `;`, `,` or white space; `#` comments; one header line |
/// | `.xyz` with a count line | frames of a molecule, each one point of 3 numbers an atom |
/// | `.pdb` | the same: ATOM and HETATM of each MODEL |
/// | `.ply` | x, y, z of the vertices, ASCII or binary |
/// | `.mat` | a real matrix, MATLAB version 5 (`-v7` and older) |
///
/// A row is a point, whatever the shape: a matrix with fewer rows than columns is not turned
/// unless [`PointOptions::transpose`] says so, as few points of a high dimension are no error.
/// Memory: the file and the points, nothing a header merely promises.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] with line, or row and column, for a number
/// that is not finite or no number, ragged rows, no point, one column (a surface needs N >= 2), a
/// truncated file, a header that does not agree with the size of the file; those of reading.
///
/// ```
/// use crosscap_backends::files::{PointOptions, read_points};
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("points.csv");
/// std::fs::write(&path, "x,y,z\n0,0,1\n1,0,nan\n").unwrap();
/// let error = read_points(&path, &PointOptions::default()).unwrap_err();
/// assert!(error.to_string().ends_with("line 3, column 3: found NaN, expected a finite number"));
/// ```
pub fn read_points(path: impl AsRef<Path>, options: &PointOptions) -> Result<AnyCloud, FileError> {
    let path = path.as_ref();
    let extension = extension(path);
    if !POINT_EXTENSIONS
        .split(", ")
        .any(|known| known[1..] == extension)
    {
        return Err(FileError::Extension {
            path: path.into(),
            extension,
            known: POINT_EXTENSIONS,
        });
    }
    let bytes = read_bytes(path)?;
    parse(&extension, &bytes, options).map_err(|flaw| flaw.of(path))
}

/// Reads the bytes of a point file with a known extension.
pub(crate) fn parse(extension: &str, bytes: &[u8], options: &PointOptions) -> Parsed<AnyCloud> {
    if bytes.is_empty() {
        return Err(Flaw::new("an empty file", "at least one point"));
    }
    let array = options.array.as_deref();
    if let Some(name) = array.filter(|_| !matches!(extension, "npz" | "mat")) {
        return Err(Flaw::new(
            format!("the option to take the array {name}"),
            "none, as this format holds a single one",
        ));
    }
    let frames = |table: table::Table| {
        let rows = table.numbers.len() / table.columns;
        if options.transpose {
            Err(Flaw::new(
                "the option to transpose",
                "none, as frames of a molecule are points",
            ))
        } else {
            cloud(rows, table.columns, Numbers::F64(table.numbers))
        }
    };
    match extension {
        "npy" => matrix(npy::parse(bytes)?, options.transpose),
        "npz" => {
            let mut archive = Archive::open(bytes)?;
            let name = array_name(&archive, array)?;
            matrix(archive.array(&name)?, options.transpose).map_err(|f| f.within(&name))
        }
        "mat" => matrix(mat::parse(bytes, array)?, options.transpose),
        "ply" if options.transpose => Err(Flaw::new(
            "the option to transpose",
            "none, as vertices are points",
        )),
        "ply" => ply::parse_points(bytes),
        "pdb" => frames(molecule::parse_pdb(bytes)?),
        "xyz" if molecule::is_chemical(bytes) => frames(molecule::parse_xyz(bytes)?),
        _ => {
            let table = table::parse(bytes)?;
            let shape = vec![table.numbers.len() / table.columns, table.columns];
            let numbers = Numbers::F64(table.numbers);
            matrix(Array { shape, numbers }, options.transpose)
        }
    }
}

fn array_name(archive: &Archive<'_>, wanted: Option<&str>) -> Parsed<String> {
    if let Some(name) = wanted {
        return Ok(name.into());
    }
    if let Some(name) = ["points", "vertices"].into_iter().find(|n| archive.has(n)) {
        return Ok(name.into());
    }
    match &archive.names[..] {
        [only] => Ok(only.clone()),
        names => Err(Flaw::new(
            format!("the arrays [{}]", names.join(", ")),
            "one, or one named points or vertices, or the name of the one to take",
        )),
    }
}

fn matrix(array: Array, transpose: bool) -> Parsed<AnyCloud> {
    let (rows, columns) = array.rows_columns()?;
    if transpose {
        cloud(columns, rows, array.numbers.transposed(rows, columns))
    } else {
        cloud(rows, columns, array.numbers)
    }
}

/// Writes points in the format that the extension names, whole or not at all.
///
/// `.npy` (float64), `.csv` (commas, no header), `.xyz` (spaces) and `.ply` (binary, N = 3), all
/// of them to the last bit; the same points give the same bytes.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] for `.ply` when N is not 3; those of
/// [`write_bytes_whole`].
///
/// ```
/// use crosscap_backends::files::{PointOptions, read_points, write_points};
/// use crosscap_core::PointCloud;
/// let cloud = PointCloud::new(2, vec![0.1, 0.2, 0.3, 0.4]).unwrap();
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("points.npy");
/// write_points(&path, &cloud).unwrap();
/// assert_eq!(read_points(&path, &PointOptions::default()).unwrap().into_f64(), cloud);
/// ```
pub fn write_points(path: impl AsRef<Path>, cloud: &PointCloud<f64>) -> Result<(), FileError> {
    let path = path.as_ref();
    let extension = extension(path);
    let bytes = points_bytes(&extension, cloud)
        .ok_or_else(|| FileError::Extension {
            path: path.into(),
            extension: extension.clone(),
            known: ".npy, .csv, .xyz, .ply",
        })?
        .map_err(|flaw| flaw.of(path))?;
    write_bytes_whole(path, &bytes)
}

/// The bytes of a point file; `None` for an unknown extension.
pub(crate) fn points_bytes(extension: &str, cloud: &PointCloud<f64>) -> Option<Parsed<Vec<u8>>> {
    Some(Ok(match extension {
        "npy" => npy::bytes(
            ArrayView2::from_shape((cloud.len(), cloud.dimension()), cloud.coordinates())
                .expect("whole rows of a block of memory"),
        ),
        "csv" => table::bytes(cloud, ','),
        "xyz" => table::bytes(cloud, ' '),
        "ply" if cloud.dimension() == 3 => ply::point_bytes(cloud),
        "ply" => {
            return Some(Err(Flaw::new(
                format!("points of R^{}", cloud.dimension()),
                "points of R^3, which this format holds: write .npy",
            )));
        }
        _ => return None,
    }))
}
