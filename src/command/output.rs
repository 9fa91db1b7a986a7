//! Files to be written, asked about before the work begins.

use super::failure::Failure;
use crosscap_backends::files::FileError;
use std::path::{Path, PathBuf};

/// The extensions that points can be written with.
pub const POINTS: &str = ".npy, .csv, .xyz, .ply";
/// The extensions that indices can be written with.
pub const INDICES: &str = ".npy, .txt";
/// The extensions of pictures.
pub const PICTURES: &str = ".html, .png";

/// Refuses a path that nothing could be written to: its folder is not there, it is a folder itself, or its
/// extension is none of `known` (any will do when that is empty).
pub fn check(path: &Path, known: &'static str) -> Result<(), FileError> {
    let extension = extension(path);
    if !known.is_empty() && !known.split(", ").any(|k| k[1..] == extension) {
        return Err(FileError::Extension {
            path: path.into(),
            extension,
            known,
        });
    }
    if !folder_of(path).is_dir() {
        return Err(FileError::Folder {
            path: path.into(),
            folder: folder_of(path).into(),
        });
    }
    if path.is_dir() {
        return Err(FileError::NotAFile {
            path: path.into(),
            found: "a folder",
        });
    }
    Ok(())
}

/// Refuses outputs that would overwrite each other or one of the inputs.
pub fn distinct(inputs: &[&Path], outputs: &[&Path]) -> Result<(), Failure> {
    let inputs: Vec<PathBuf> = inputs.iter().map(|p| resolved(p)).collect();
    let resolved: Vec<PathBuf> = outputs.iter().map(|p| resolved(p)).collect();
    for (k, path) in resolved.iter().enumerate() {
        let shown = outputs[k].display();
        if inputs.contains(path) {
            return Err(Failure::usage(format!(
                "{shown}: is an input, and would be overwritten: choose another name"
            )));
        }
        if resolved[..k].contains(path) {
            return Err(Failure::usage(format!(
                "{shown}: two outputs have this name: choose another one"
            )));
        }
    }
    Ok(())
}

/// The extension in lower case, empty for none.
pub fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| e.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The path without detours; a file that does not exist yet has a folder that does.
fn resolved(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| {
        let folder = folder_of(path);
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.into());
        path.file_name()
            .map_or(folder.clone(), |name| folder.join(name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_outputs_of_one_name() {
        let folder = tempfile::tempdir().unwrap();
        let a = folder.path().join("a.npz");
        let same = folder.path().join(".").join("a.npz");
        let b = folder.path().join("b.npz");
        assert!(distinct(&[], &[&a, &b]).is_ok());
        assert!(distinct(&[], &[&a, &same]).is_err());
        std::fs::write(&a, b"").unwrap();
        assert!(distinct(&[&a], &[&same]).is_err());
        assert!(distinct(&[&a], &[&b]).is_ok());
    }

    #[test]
    fn refuses_what_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        assert!(check(&at("a.png"), PICTURES).is_ok());
        assert!(check(&at("a.HTML"), PICTURES).is_ok());
        assert!(matches!(
            check(&at("a.gif"), PICTURES),
            Err(FileError::Extension { .. })
        ));
        assert!(matches!(
            check(&at("a"), PICTURES),
            Err(FileError::Extension { .. })
        ));
        assert!(matches!(
            check(&at("no/a.png"), PICTURES),
            Err(FileError::Folder { .. })
        ));
        assert!(matches!(
            check(folder.path(), ""),
            Err(FileError::NotAFile { .. })
        ));
    }
}
