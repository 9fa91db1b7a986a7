//! Archives of NumPy arrays, `.npz`: a zip of `.npy` files.

use super::error::{Flaw, Parsed};
use super::npy::{self, Array};
use std::io::{Cursor, Read, Write};
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter, write::SimpleFileOptions};

/// No stream of the deflate format grows more than this; an entry that claims to is a lie.
pub(crate) const LARGEST_INFLATION: u64 = 1032;

/// An archive that is being read.
pub(crate) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Names of the arrays in the order of the archive, without `.npy`.
    pub(crate) names: Vec<String>,
}

impl<'a> Archive<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Parsed<Self> {
        if bytes.is_empty() {
            return Err(Flaw::new("an empty file", "a zip archive of NumPy arrays"));
        }
        let bad = |e: zip::result::ZipError| {
            Flaw::new(
                format!("a bad archive ({e})"),
                "a complete zip archive of NumPy arrays",
            )
        };
        let mut zip = ZipArchive::new(Cursor::new(bytes)).map_err(bad)?;
        let names = (0..zip.len())
            .map(|i| {
                let entry = zip.by_index_raw(i).map_err(bad)?;
                Ok(entry
                    .name()
                    .strip_suffix(".npy")
                    .unwrap_or(entry.name())
                    .to_string())
            })
            .collect::<Parsed<Vec<_>>>()?;
        Ok(Self { zip, names })
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// Bytes of the entry with that name.
    fn entry(&mut self, name: &str) -> Parsed<Vec<u8>> {
        let Some(index) = self.names.iter().position(|n| n == name) else {
            return Err(Flaw::new(
                format!("the arrays [{}]", self.names.join(", ")),
                format!("one named {name}"),
            ));
        };
        let bad = |e: &dyn std::fmt::Display| {
            Flaw::new(format!("a bad entry ({e})"), "a NumPy array").within(name)
        };
        let entry = self.zip.by_index(index).map_err(|e| bad(&e))?;
        let (size, packed) = (entry.size(), entry.compressed_size());
        if size
            > packed
                .saturating_mul(LARGEST_INFLATION)
                .saturating_add(1024)
        {
            return Err(Flaw::new(
                format!("a claim of {size} bytes in {packed} packed ones"),
                format!("at most {LARGEST_INFLATION} times as many"),
            )
            .within(name));
        }
        let mut bytes = Vec::new();
        entry
            .take(size.saturating_add(1))
            .read_to_end(&mut bytes)
            .map_err(|e| bad(&e))?;
        if bytes.len() as u64 != size {
            return Err(Flaw::new(
                format!("{} bytes", bytes.len()),
                format!("{size}, as the archive says"),
            )
            .within(name));
        }
        Ok(bytes)
    }

    /// The array with that name.
    pub(crate) fn array(&mut self, name: &str) -> Parsed<Array> {
        npy::parse(&self.entry(name)?).map_err(|flaw| flaw.within(name))
    }

    /// Integers with `columns` columns in row order; `None` when the archive has no such array.
    pub(crate) fn integers(
        &mut self,
        name: &str,
        columns: Option<usize>,
    ) -> Parsed<Option<Vec<i64>>> {
        if !self.has(name) {
            return Ok(None);
        }
        let array = self.array(name)?;
        let fits = match (&array.shape[..], columns) {
            ([_], None) => true,
            (&[_, found], Some(wanted)) => found == wanted,
            _ => false,
        };
        if !fits {
            let expected = match columns {
                Some(columns) => format!("shape [any, {columns}]"),
                None => "one dimension".into(),
            };
            return Err(Flaw::new(format!("shape {:?}", array.shape), expected).within(name));
        }
        array
            .into_integers()
            .map(Some)
            .map_err(|flaw| flaw.within(name))
    }
}

/// The bytes of an archive; the same arrays give the same bytes, whatever the clock says.
pub(crate) fn bytes(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, array) in arrays {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .large_file(array.len() as u64 >= u64::from(u32::MAX));
        zip.start_file(format!("{name}.npy"), options)
            .and_then(|()| Ok(zip.write_all(array)?))
            .expect("distinct names and memory that grows");
    }
    zip.finish().expect("memory that grows").into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_array_keeps_its_shape_and_bytes_are_reproducible() {
        let array = npy::bytes::<i64>(&[0, 2], &[]);
        let archive = bytes(&[("edges", array.clone())]);
        assert_eq!(archive, bytes(&[("edges", array)]));
        let mut open = Archive::open(&archive).unwrap();
        assert_eq!(open.array("edges").unwrap().shape, [0, 2]);
        assert_eq!(open.integers("edges", Some(2)).unwrap(), Some(vec![]));
        assert_eq!(open.integers("none", Some(2)).unwrap(), None);
        assert!(open.integers("edges", Some(3)).is_err());
        assert!(open.array("none").unwrap_err().found.contains("edges"));
    }
}
