//! Point clouds from files.

use super::any_cloud::{AnyCloud, cloud};
use super::columns::{ColumnChoice, Custom, Grid, Picked, Why, idle, inspect, pick};
use super::error::{FileError, Flaw, Parsed, Place};
use super::npy::{Array, Numbers};
use super::npz::Archive;
use super::remark::Remark;
use super::whole::{packed_extension, read_bytes};
use super::{frames, las, mat, npy, obj, off, pcd, ply, stl, table, trajectory, vtk, vtk_xml};
use crosscap_core::PointCloud;
use std::path::Path;

/// The extensions that [`read_points`] knows, each also with `.gz` behind it.
pub const POINT_EXTENSIONS: &str = ".npy, .npz, .csv, .tsv, .txt, .dat, .xyz, .asc, .pts, .pdb, \
    .xtc, .dcd, .ply, .pcd, .las, .laz, .off, .obj, .stl, .vtk, .vtu, .vtp, .mat";

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
    /// Which columns are coordinates; of an array that is transposed: which rows.
    pub columns: ColumnChoice,
}

/// Points, and what the one who asked for them ought to know about how they were taken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointFile {
    /// The points.
    pub points: AnyCloud,
    /// Columns that were left out, or taken though they look like no coordinates, and the like.
    pub remarks: Vec<Remark>,
}

/// Reads a point cloud in the format that the extension names; [`read_point_file`] without its
/// remarks.
///
/// # Errors
/// Those of [`read_point_file`].
pub fn read_points(path: impl AsRef<Path>, options: &PointOptions) -> Result<AnyCloud, FileError> {
    read_point_file(path, options).map(|file| file.points)
}

/// Reads a point cloud in the format that the extension names, packed by gzip if `.gz` follows.
///
/// | format | what is read |
/// | --- | --- |
/// | `.npy` | 2 dimensions, float16 or float32 (as f32), float64 or integers (as f64), any order and endianness; records |
/// | `.npz` | one such array, see [`PointOptions::array`] |
/// | `.csv`, `.tsv`, `.txt`, `.dat`, `.xyz`, `.asc`, `.pts` | a table: `;`, tabs, `,` or white space; comments; names; decimal commas |
/// | `.xyz` with a count line and labels | frames of a molecule, each one point of 3 numbers an atom |
/// | `.pdb` | the same: ATOM and HETATM of each MODEL |
/// | `.xtc`, `.dcd` | the same without the names of the atoms; `.xtc` in Angstrom too |
/// | `.ply`, `.pcd` | x, y, z of the vertices or points, text or binary |
/// | `.las`, `.laz` | the places |
/// | `.off`, `.obj`, `.stl` | the vertices, whatever the faces; of `.stl` each once |
/// | `.vtk`, `.vtu`, `.vtp` | the points |
/// | `.mat` | a real matrix, MATLAB version 5 (`-v7` and older) |
///
/// A row is a point, whatever the shape: a matrix with fewer rows than columns is not turned
/// unless [`PointOptions::transpose`] says so, as few points of a high dimension are no error.
/// Which columns are coordinates says [`ColumnChoice`]; what was done without being asked for
/// stands in [`PointFile::remarks`].
/// Memory: the file and the points, nothing a header merely promises.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] with line, or row and column, for a number
/// that is not finite or no number, ragged rows, no point, one column (a surface needs N >= 2), a
/// truncated file, a header that does not agree with the size of the file; those of reading.
///
/// ```
/// use crosscap_backends::files::{PointOptions, read_point_file};
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("points.csv");
/// std::fs::write(&path, "x,y,z,intensity\n0,0,1,17\n1,0,0,23\n").unwrap();
/// let file = read_point_file(&path, &PointOptions::default()).unwrap();
/// assert_eq!(file.points.dimension(), 3);
/// assert!(file.remarks[0].to_string().contains("left out: intensity"));
/// std::fs::write(&path, "x,y,z\n0,0,1\n1,0,nan\n").unwrap();
/// let error = read_point_file(&path, &PointOptions::default()).unwrap_err();
/// assert!(error.to_string().contains("line 3, column 3: found NaN, expected a finite number"));
/// ```
pub fn read_point_file(
    path: impl AsRef<Path>,
    options: &PointOptions,
) -> Result<PointFile, FileError> {
    let path = path.as_ref();
    let extension = packed_extension(path);
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
pub(crate) fn parse(extension: &str, bytes: &[u8], options: &PointOptions) -> Parsed<PointFile> {
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
    match extension {
        "npy" => from_array(npy::parse(bytes)?, options),
        "npz" => {
            let mut archive = Archive::open(bytes)?;
            let name = array_name(&archive, array)?;
            from_array(archive.array(&name)?, options).map_err(|f| f.within(&name))
        }
        "mat" => from_array(mat::parse(bytes, array)?, options),
        "ply" => {
            only_columns(options, "vertices")?;
            from_records(ply::parse_points(bytes, &options.columns)?)
                .map_err(|f| f.within("vertex"))
        }
        "pcd" => {
            only_columns(options, "the points of a scan")?;
            from_records(pcd::parse(bytes, &options.columns)?)
        }
        "las" | "laz" => from_places(las::parse(bytes)?, options),
        "off" => from_places(off::parse_points(bytes)?, options),
        "obj" => from_places(obj::parse_points(bytes)?, options),
        "stl" => {
            let coordinates = stl::parse(bytes)?.coordinates;
            let shape = vec![coordinates.len() / 3, 3];
            from_places(Array::new(shape, Numbers::F64(coordinates)), options)
        }
        "vtk" => from_places(vtk::parse(bytes)?, options),
        "vtu" => from_places(vtk_xml::parse_points(bytes, "UnstructuredGrid")?, options),
        "vtp" => from_places(vtk_xml::parse_points(bytes, "PolyData")?, options),
        "xtc" => from_frames(trajectory::parse_xtc(bytes)?, options),
        "dcd" => from_frames(trajectory::parse_dcd(bytes)?, options),
        "pdb" => from_frames(frames::parse_pdb(bytes)?, options),
        "xyz" if frames::is_chemical(bytes) => from_frames(frames::parse_xyz(bytes)?, options),
        _ => from_table(bytes, extension, options),
    }
}

/// Refuses what does not go with places that a format names.
fn only_columns(options: &PointOptions, what: &str) -> Parsed<()> {
    if options.transpose {
        return Err(Flaw::new(
            "the option to transpose",
            format!("none, as {what} are points"),
        ));
    }
    Ok(())
}

/// Frames of a molecule: every number is a coordinate.
fn from_frames(frames: frames::Coordinates, options: &PointOptions) -> Parsed<PointFile> {
    only_columns(options, "frames of a molecule")?;
    if matches!(options.columns, ColumnChoice::Chosen(_)) {
        return Err(Flaw::new(
            "the option to choose columns",
            "none, as frames of a molecule are points: --atoms chooses atoms",
        ));
    }
    let rows = frames.numbers.len() / frames.columns;
    let points = cloud(rows, frames.columns, Numbers::F64(frames.numbers))?;
    Ok(PointFile {
        points,
        remarks: vec![],
    })
}

/// Vertices with properties, of which those that are coordinates were taken.
fn from_records(array: Array) -> Parsed<PointFile> {
    let taken = PointOptions {
        columns: ColumnChoice::All,
        ..PointOptions::default()
    };
    from_array(array, &taken)
}

/// Places that are nothing else.
fn from_places(array: Array, options: &PointOptions) -> Parsed<PointFile> {
    only_columns(options, "places")?;
    if options.columns == ColumnChoice::Automatic {
        return from_records(array);
    }
    from_array(array, options)
}

pub(crate) fn from_array(array: Array, options: &PointOptions) -> Parsed<PointFile> {
    let (mut rows, mut columns) = array.rows_columns()?;
    if array.numbers.len() == 0 {
        // Before anything is made for so many columns as the header promises.
        cloud(rows, columns, Numbers::F64(vec![]))?;
    }
    let (mut numbers, mut names) = (array.numbers, array.names);
    if options.transpose {
        numbers = numbers.transposed(rows, columns);
        (rows, columns, names) = (columns, rows, None);
    }
    let picked = pick(names.as_deref(), columns, &options.columns)?;
    if picked.kept.iter().copied().ne(0..columns) {
        numbers = numbers.columns(columns.max(1), &picked.kept);
    }
    Rows {
        rows,
        total: columns,
        numbers,
        names,
        picked,
        custom: Custom::Array,
        bits: if array.half { 16 } else { 32 },
    }
    .settle()
}

fn from_table(bytes: &[u8], extension: &str, options: &PointOptions) -> Parsed<PointFile> {
    if options.transpose {
        let table = table::parse(bytes, &ColumnChoice::All)?;
        let shape = vec![table.numbers.len() / table.columns, table.columns];
        return from_array(Array::new(shape, Numbers::F64(table.numbers)), options);
    }
    let table = table::parse(bytes, &options.columns)?;
    Rows {
        rows: table.numbers.len() / table.columns.max(1),
        total: table.names.as_ref().map_or(table.columns, Vec::len),
        numbers: Numbers::F64(table.numbers),
        names: table.names,
        picked: table.picked,
        custom: match extension {
            "xyz" | "asc" => Custom::Positions,
            "pts" => Custom::Scan,
            _ => Custom::Table,
        },
        bits: 64,
    }
    .settle()
}

/// Rows of numbers in columns that were picked, on their way to points.
struct Rows {
    rows: usize,
    /// Columns of the file.
    total: usize,
    /// Those of the columns that were picked.
    numbers: Numbers,
    names: Option<Vec<String>>,
    picked: Picked,
    custom: Custom,
    /// Bits that a number of single precision was stored in.
    bits: u32,
}

impl Rows {
    fn grid(&self) -> Grid<'_> {
        Grid {
            rows: self.rows,
            columns: self.picked.kept.len(),
            numbers: &self.numbers,
        }
    }

    fn settle(mut self) -> Parsed<PointFile> {
        let mut remarks = Vec::new();
        match (self.picked.why, &self.names) {
            (Why::Named, Some(names)) if self.picked.kept.len() < self.total => {
                let is_kept = |k: &usize| self.picked.kept.contains(k);
                let shown = |k: usize| match names[k].trim() {
                    "" => format!("column {k}"),
                    name => name.into(),
                };
                remarks.push(Remark::Named {
                    taken: self.picked.kept.iter().map(|&k| shown(k)).collect(),
                    left: (0..self.total).filter(|k| !is_kept(k)).map(shown).collect(),
                });
            }
            (Why::Untold, _) => {
                let kept = inspect(&self.grid(), self.custom, &mut remarks);
                if kept.len() < self.picked.kept.len() {
                    self.numbers = self.numbers.columns(self.picked.kept.len(), &kept);
                    self.picked.kept = kept;
                }
            }
            _ => {}
        }
        if self.picked.why != Why::Asked {
            idle(&self.grid(), &self.picked.kept, &mut remarks);
        }
        // No method here has a use for so few points in so many dimensions.
        if self.rows * 8 < self.picked.kept.len() {
            remarks.push(Remark::Wide {
                rows: self.rows,
                columns: self.picked.kept.len(),
            });
        }
        let kept = self.picked.kept;
        let points = cloud(self.rows, kept.len(), self.numbers).map_err(|mut flaw| {
            // The column as the file counts it.
            if let Place::Row {
                column: Some(column),
                ..
            } = &mut flaw.place
            {
                *column = kept[*column];
            }
            flaw
        })?;
        if let AnyCloud::F32(cloud) = &points {
            remarks.extend(coarse(cloud, self.bits));
        }
        Ok(PointFile { points, remarks })
    }
}

/// Whether the numbers stand too far apart to hold the points.
fn coarse(cloud: &PointCloud<f32>, bits: u32) -> Option<Remark> {
    /// Half a step is then a fortieth of the distance between points: noise that an estimate of
    /// dimension notices.
    const PART: f64 = 0.05;
    let mut low = vec![f64::INFINITY; cloud.dimension()];
    let mut high = vec![f64::NEG_INFINITY; cloud.dimension()];
    for point in cloud.iter() {
        for (k, &x) in point.iter().enumerate() {
            low[k] = low[k].min(x.into());
            high[k] = high[k].max(x.into());
        }
    }
    let largest = low
        .iter()
        .chain(&high)
        .fold(0.0, |a: f64, x| a.max(x.abs()));
    let diagonal = low.iter().zip(&high).map(|(a, b)| (b - a).powi(2));
    let spacing = diagonal.sum::<f64>().sqrt() / (cloud.len() as f64).sqrt();
    let digits = if bits == 16 { 10 } else { 23 };
    let step = largest.log2().floor().exp2() * 0.5_f64.powi(digits);
    (step > PART * spacing).then_some(Remark::Coarse {
        bits,
        largest,
        step,
        spacing,
    })
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
            "one, or one named points or vertices, or the name of the one to take (--array)",
        )),
    }
}
