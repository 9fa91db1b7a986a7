//! MATLAB files of version 5 (what `save` writes up to `-v7`), `.mat`.
//!
//! Only full, real, numeric matrices of two dimensions are read. The reader is our own: the crate
//! tried for it, `matfile`, refuses `int32` matrices, prints to standard output and takes a
//! truncated file for one with fewer variables.

use super::error::{Flaw, Parsed};
use super::npy::{Array, Numbers};
use super::npz::LARGEST_INFLATION;
use flate2::read::ZlibDecoder;
use std::borrow::Cow;
use std::io::Read;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Reads the matrix called `name`; without a name `points`, `vertices`, or the only one there is.
pub(crate) fn parse(bytes: &[u8], name: Option<&str>) -> Parsed<Array> {
    let big = is_big_endian(bytes)?;
    let mut found: Option<(String, Array)> = None;
    let mut names = Vec::new();
    let mut cursor = Cursor {
        rest: &bytes[128..],
        big,
    };
    while !cursor.rest.is_empty() {
        let Some(data) = cursor.matrix()? else {
            continue;
        };
        let Some((variable, array)) = matrix(&data, big, name)? else {
            continue;
        };
        names.push(variable.clone());
        let better = found
            .as_ref()
            .is_none_or(|(best, _)| rank(&variable) < rank(best));
        if let Some(array) = array.filter(|_| better) {
            found = Some((variable, array));
        }
    }
    match (found, name, names.len()) {
        (Some((_, array)), Some(_), _) | (Some((_, array)), None, 1) => Ok(array),
        (Some((best, array)), None, _) if rank(&best) < UNKNOWN => Ok(array),
        (Some(_), None, _) => Err(Flaw::new(
            format!("the matrices [{}]", names.join(", ")),
            "one, or one named points or vertices, or the name of the one to take",
        )),
        (None, Some(name), _) => Err(Flaw::new(
            format!("the matrices [{}]", names.join(", ")),
            format!("a real matrix named {name}"),
        )),
        (None, None, _) => Err(Flaw::new(
            "no real numeric matrix of 2 dimensions",
            "one, with a point a row",
        )),
    }
}

/// Whether the numbers of the file start with their highest byte, by its header.
fn is_big_endian(bytes: &[u8]) -> Parsed<bool> {
    if bytes.is_empty() {
        return Err(Flaw::new("an empty file", "a MATLAB file of version 5"));
    }
    let header = bytes.get(..128).ok_or_else(|| {
        Flaw::new(
            format!("{} bytes", bytes.len()),
            "a MATLAB file of version 5, which starts with 128 bytes of header",
        )
    })?;
    let big = match &header[126..] {
        b"IM" => false,
        b"MI" => true,
        _ => return Err(Flaw::new("no MATLAB header", "a MATLAB file of version 5")),
    };
    let version = if big {
        u16::from_be_bytes([header[124], header[125]])
    } else {
        u16::from_le_bytes([header[124], header[125]])
    };
    if version != 0x0100 {
        return Err(Flaw::new(
            format!(
                "a MATLAB file of version {}.{}",
                version >> 8,
                version & 255
            ),
            "version 5: save it with the option -v7",
        ));
    }
    Ok(big)
}

/// Rank of a name that says nothing.
const UNKNOWN: usize = 2;

/// How well a name says that the matrix is the points, the best first.
fn rank(name: &str) -> usize {
    ["points", "vertices"]
        .iter()
        .position(|known| *known == name)
        .unwrap_or(UNKNOWN)
}

/// Inflates a compressed element: as many bytes as its first element says, no more.
fn inflate(packed: &[u8], big: bool) -> Parsed<Vec<u8>> {
    let bad = |e: std::io::Error| {
        Flaw::new(
            format!("a bad compressed variable ({e})"),
            "a MATLAB file of version 5",
        )
    };
    let mut decoder = ZlibDecoder::new(packed);
    let mut bytes = vec![0; 8];
    decoder.read_exact(&mut bytes).map_err(bad)?;
    let size = word([bytes[4], bytes[5], bytes[6], bytes[7]], big);
    if u64::from(size) > (packed.len() as u64).saturating_mul(LARGEST_INFLATION) {
        return Err(Flaw::new(
            format!("a claim of {size} bytes in {} packed ones", packed.len()),
            format!("at most {LARGEST_INFLATION} times as many"),
        ));
    }
    decoder
        .take(u64::from(size))
        .read_to_end(&mut bytes)
        .map_err(bad)?;
    Ok(bytes)
}

fn word(bytes: [u8; 4], big: bool) -> u32 {
    if big {
        u32::from_be_bytes(bytes)
    } else {
        u32::from_le_bytes(bytes)
    }
}

struct Cursor<'a> {
    rest: &'a [u8],
    big: bool,
}

impl<'a> Cursor<'a> {
    /// The content of the next variable, inflated where that is needed; `None` where it is no matrix.
    fn matrix(&mut self) -> Parsed<Option<Cow<'a, [u8]>>> {
        let (kind, data) = self.element(true)?;
        match kind {
            MATRIX => Ok(Some(Cow::Borrowed(data))),
            COMPRESSED => {
                let mut inflated = inflate(data, self.big)?;
                if inflated.first_chunk::<8>().is_none() {
                    return Ok(None);
                }
                let mut inner = Cursor {
                    rest: &inflated,
                    big: self.big,
                };
                let (kind, data) = inner.element(true)?;
                // Behind its type and size.
                let content = 8..8 + data.len();
                inflated.truncate(content.end);
                inflated.drain(..content.start);
                Ok((kind == MATRIX).then_some(Cow::Owned(inflated)))
            }
            _ => Ok(None),
        }
    }

    /// Type and data of the next element, padding skipped. Compressed elements have no padding.
    fn element(&mut self, top: bool) -> Parsed<(u32, &'a [u8])> {
        let truncated = |found: usize, wanted: usize| {
            Flaw::new(
                format!("{found} bytes of an element"),
                format!("{wanted}: the file is truncated or its header lies"),
            )
        };
        let rest = self.rest;
        let head = rest
            .first_chunk::<4>()
            .ok_or_else(|| truncated(rest.len(), 8))?;
        let first = word(*head, self.big);
        if !top && first >> 16 != 0 {
            // Small element: size and type in one word, data in the next.
            let size = (first >> 16) as usize;
            let data = rest
                .get(4..8)
                .and_then(|data| data.get(..size))
                .ok_or_else(|| truncated(rest.len(), 4 + size))?;
            self.rest = &rest[8..];
            return Ok((first & 0xffff, data));
        }
        let size = rest
            .get(4..)
            .and_then(|r| r.first_chunk::<4>())
            .map(|s| word(*s, self.big) as usize)
            .ok_or_else(|| truncated(rest.len(), 8))?;
        let data = rest[8..]
            .get(..size)
            .ok_or_else(|| truncated(rest.len() - 8, size))?;
        let padding = if first == COMPRESSED {
            0
        } else {
            size.wrapping_neg() % 8
        };
        self.rest = rest[8 + size..].get(padding..).unwrap_or(&[]);
        Ok((first, data))
    }
}

/// Name and content of a matrix element: `None` when it is no real numeric matrix of two
/// dimensions, no content when another name is wanted.
fn matrix(data: &[u8], big: bool, wanted: Option<&str>) -> Parsed<Option<(String, Option<Array>)>> {
    let mut cursor = Cursor { rest: data, big };
    let (_, flags) = cursor.element(false)?;
    let Some(flags) = flags.first_chunk::<4>().map(|f| word(*f, big)) else {
        return Ok(None);
    };
    let class = flags & 0xff;
    if !(6..=15).contains(&class) || flags & 0x0800 != 0 {
        return Ok(None);
    }
    let (_, dimensions) = cursor.element(false)?;
    let dimensions: Vec<usize> = dimensions
        .as_chunks::<4>()
        .0
        .iter()
        .map(|&d| word(d, big) as usize)
        .collect();
    let &[rows, columns] = &dimensions[..] else {
        return Ok(None);
    };
    let (_, name) = cursor.element(false)?;
    let name = String::from_utf8_lossy(name).into_owned();
    if wanted.is_some_and(|w| w != name) {
        return Ok(Some((name, None)));
    }
    let (kind, data) = cursor.element(false).map_err(|f| f.within(&name))?;
    let numbers = numbers(kind, data, big).map_err(|f| f.within(&name))?;
    let count = numbers.len();
    if rows.checked_mul(columns) != Some(count) {
        return Err(Flaw::new(
            format!("{count} numbers"),
            format!("{rows} x {columns}, as its header promises"),
        )
        .within(&name));
    }
    // MATLAB stores a column after the other.
    let array = Array::new(vec![rows, columns], numbers.transposed(columns, rows));
    Ok(Some((name, Some(array))))
}

/// The numbers of an element of a type: MATLAB takes the narrowest one that holds the values.
fn numbers(kind: u32, data: &[u8], big: bool) -> Parsed<Numbers> {
    macro_rules! all {
        ($type:ty, $width:literal) => {
            data.as_chunks::<$width>().0.iter().map(|&c| {
                if big {
                    <$type>::from_be_bytes(c)
                } else {
                    <$type>::from_le_bytes(c)
                }
            })
        };
    }
    Ok(match kind {
        1 => Numbers::F64(all!(i8, 1).map(f64::from).collect()),
        2 => Numbers::F64(all!(u8, 1).map(f64::from).collect()),
        3 => Numbers::F64(all!(i16, 2).map(f64::from).collect()),
        4 => Numbers::F64(all!(u16, 2).map(f64::from).collect()),
        5 => Numbers::F64(all!(i32, 4).map(f64::from).collect()),
        6 => Numbers::F64(all!(u32, 4).map(f64::from).collect()),
        7 => Numbers::F32(all!(f32, 4).collect()),
        9 => Numbers::F64(all!(f64, 8).collect()),
        12 => Numbers::F64(all!(i64, 8).map(|x| x as f64).collect()),
        13 => Numbers::F64(all!(u64, 8).map(|x| x as f64).collect()),
        _ => {
            return Err(Flaw::new(
                format!("data of type {kind}"),
                "a type of number",
            ));
        }
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use flate2::{Compression, write::ZlibEncoder};
    use std::io::Write;

    fn element(kind: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = kind.to_le_bytes().to_vec();
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    }

    fn variable(name: &str, rows: u32, columns: u32, column_major: &[f64]) -> Vec<u8> {
        let mut body = element(6, &[6, 0, 0, 0, 0, 0, 0, 0]);
        body.extend(element(
            5,
            &[rows.to_le_bytes(), columns.to_le_bytes()].concat(),
        ));
        // A short name goes into a small element.
        if name.len() <= 4 {
            body.extend((1_u32 | (name.len() as u32) << 16).to_le_bytes());
            let mut short = name.as_bytes().to_vec();
            short.resize(4, 0);
            body.extend(short);
        } else {
            body.extend(element(1, name.as_bytes()));
        }
        let data: Vec<u8> = column_major.iter().flat_map(|x| x.to_le_bytes()).collect();
        body.extend(element(9, &data));
        element(MATRIX, &body)
    }

    /// A file as MATLAB writes it.
    pub(crate) fn file(variables: &[(&str, u32, u32, &[f64])], compressed: bool) -> Vec<u8> {
        let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
        bytes.resize(124, b' ');
        bytes.extend([0, 1, b'I', b'M']);
        for (name, rows, columns, data) in variables {
            let plain = variable(name, *rows, *columns, data);
            if compressed {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(&plain).unwrap();
                let packed = encoder.finish().unwrap();
                bytes.extend(COMPRESSED.to_le_bytes());
                bytes.extend((packed.len() as u32).to_le_bytes());
                bytes.extend(packed);
            } else {
                bytes.extend(plain);
            }
        }
        bytes
    }

    #[test]
    fn columns_become_rows() {
        for compressed in [false, true] {
            let data = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
            let bytes = file(&[("X", 2, 3, &data), ("other", 1, 1, &[7.0])], compressed);
            let array = parse(&bytes, Some("X")).unwrap();
            assert_eq!(array.shape, [2, 3]);
            assert_eq!(
                array.numbers,
                Numbers::F64(vec![1.0, 3.0, 5.0, 2.0, 4.0, 6.0])
            );
            assert_eq!(parse(&bytes, Some("other")).unwrap().shape, [1, 1]);
            assert!(parse(&bytes, None).unwrap_err().found.contains("X, other"));
            assert!(parse(&bytes, Some("Y")).unwrap_err().expected.contains('Y'));
            let named = [("A", 1, 1, &[1.0][..]), ("vertices", 2, 1, &[1.0, 2.0])];
            let named = parse(&file(&named, compressed), None).unwrap();
            assert_eq!(named.shape, [2, 1]);
            let cut = &bytes[..bytes.len() - 9];
            assert!(parse(cut, Some("X")).is_err());
        }
    }

    #[test]
    fn a_header_that_lies_and_other_versions() {
        let bytes = file(&[("points", 4_000_000_000, 3, &[1.0])], true);
        let flaw = parse(&bytes, None).unwrap_err();
        assert!(flaw.expected.contains("4000000000 x 3"), "{flaw:?}");
        let mut newer = file(&[], false);
        newer[125] = 2;
        assert!(parse(&newer, None).unwrap_err().expected.contains("-v7"));
        assert!(parse(&file(&[], false), None).is_err());
    }
}
