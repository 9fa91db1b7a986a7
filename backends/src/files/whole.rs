//! Files are read in one go and written whole or not at all.

use super::FileError;
use std::io::{self, Write};
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

/// Reads a regular file.
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
    std::fs::read(path).map_err(|source| FileError::Read {
        path: path.into(),
        source,
    })
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
