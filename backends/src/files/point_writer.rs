//! Point clouds to files.

use super::error::{FileError, Flaw, Parsed};
use super::whole::{extension, write_bytes_whole};
use super::{npy, ply, table};
use crosscap_core::PointCloud;
use std::path::Path;

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
        "npy" => npy::bytes(&[cloud.len(), cloud.dimension()], cloud.coordinates()),
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
