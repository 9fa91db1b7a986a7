//! Files are read in one go and written whole or not at all.

use super::FileError;
use super::error::{Flaw, Parsed};
use flate2::read::MultiGzDecoder;
use std::io::{self, Read, Write};
use std::path::Path;

/// Writes a file whole or not at all.
///
/// The bytes go to a temporary file in the same folder, which then takes the name in one step:
/// a reader sees the old file or the new one, never half of it, and a failure leaves the old one.
///
/// # Errors
/// [`FileError::Folder`] when the folder does not exist, [`FileError::NotAFile`] when the path
/// is a folder, [`FileError::Write`] when the system refuses.
///
/// ```
/// use crosscap_backends::files::write_bytes_whole;
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("report.json");
/// write_bytes_whole(&path, b"{}").unwrap();
/// assert_eq!(std::fs::read(&path).unwrap(), b"{}");
/// assert!(write_bytes_whole(folder.path().join("nowhere/report.json"), b"{}").is_err());
/// ```
pub fn write_bytes_whole(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), FileError> {
    let path = path.as_ref();
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(FileError::Folder {
            path: path.into(),
            folder: folder.into(),
        });
    }
    if path.is_dir() {
        return Err(FileError::NotAFile {
            path: path.into(),
            found: "a folder",
        });
    }
    // A device such as the null device must be written to, not replaced.
    if std::fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return std::fs::write(path, bytes).map_err(|source| FileError::Write {
            path: path.into(),
            source,
        });
    }
    let write = || -> io::Result<()> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".partial-");
        // A temporary file is private by default; the result gets the permissions any new file has.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut file = builder.tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        file.persist(path).map_err(|e| e.error)?;
        Ok(())
    };
    write().map_err(|source| FileError::Write {
        path: path.into(),
        source,
    })
}

/// Reads a regular file; what gzip packed (`.gz`) is unpacked.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let metadata = std::fs::metadata(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => FileError::Missing { path: path.into() },
        _ => FileError::Read {
            path: path.into(),
            source,
        },
    })?;
    if !metadata.is_file() {
        return Err(FileError::NotAFile {
            path: path.into(),
            found: if metadata.is_dir() {
                "a folder"
            } else {
                "a device or a pipe"
            },
        });
    }
    let bytes = std::fs::read(path).map_err(|source| FileError::Read {
        path: path.into(),
        source,
    })?;
    if extension(path) == PACKED {
        return unpack(&bytes).map_err(|flaw| flaw.of(path));
    }
    Ok(bytes)
}

/// The extension of what gzip packed.
const PACKED: &str = "gz";

/// Unpacks what gzip packed; memory is taken for bytes that come out, never for a promise.
pub(crate) fn unpack(bytes: &[u8]) -> Parsed<Vec<u8>> {
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(bytes)
        .read_to_end(&mut unpacked)
        .map_err(|e| Flaw::new(format!("bad gzip data ({e})"), "a complete .gz file"))?;
    Ok(unpacked)
}

/// The extension in lower case, before `.gz` if that is the last one; empty for none.
pub(crate) fn packed_extension(path: &Path) -> String {
    match extension(path).as_str() {
        PACKED => extension(Path::new(path.file_stem().unwrap_or_default())),
        plain => plain.into(),
    }
}

/// The extension in lower case, empty for none.
pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| e.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_whole_and_leaves_nothing_beside() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_bytes_whole(&path, b"old").unwrap();
        write_bytes_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn refuses_a_missing_folder_and_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_bytes_whole(folder.path().join("no/a.txt"), b"").unwrap_err();
        assert!(matches!(error, FileError::Folder { .. }), "{error}");
        let error = write_bytes_whole(folder.path(), b"").unwrap_err();
        assert!(matches!(error, FileError::NotAFile { .. }), "{error}");
    }

    #[test]
    fn unpacks_gzip_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.CSV.gz");
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packer.write_all(b"1,2\n").unwrap();
        let packed = packer.finish().unwrap();
        std::fs::write(&path, &packed).unwrap();
        assert_eq!(packed_extension(&path), "csv");
        assert_eq!(read_bytes(&path).unwrap(), b"1,2\n");
        std::fs::write(&path, &packed[..packed.len() - 9]).unwrap();
        let error = read_bytes(&path).unwrap_err().to_string();
        assert!(error.contains("bad gzip data"), "{error}");
        assert_eq!(packed_extension(Path::new("a.csv")), "csv");
        assert_eq!(packed_extension(Path::new("gz")), "");
    }

    #[test]
    fn reads_regular_files_only() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(
            read_bytes(folder.path()),
            Err(FileError::NotAFile { .. })
        ));
        assert!(matches!(
            read_bytes(&folder.path().join("none")),
            Err(FileError::Missing { .. })
        ));
    }
}
