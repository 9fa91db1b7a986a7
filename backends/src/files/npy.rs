//! NumPy arrays, `.npy`.
//!
//! The header is parsed, and arrays are written, by `ndarray-npy`. Before it sees a header, its
//! length and nesting are bounded; before anything is allocated, the size that the header
//! promises is compared with the bytes that are there.

use super::error::{Flaw, Parsed, excerpt};
use ndarray::{ArrayView, Dimension};
use ndarray_npy::{WritableElement, WriteNpyExt, npy::header::Header};

/// Longest header that is believed; real ones have about 100 bytes.
const LONGEST_HEADER: usize = 1 << 16;

/// Numbers as they are stored; integers of every width as `i64`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Numbers {
    F32(Vec<f32>),
    F64(Vec<f64>),
    Integer(Vec<i64>),
}

impl Numbers {
    pub(crate) fn into_f64(self) -> Vec<f64> {
        match self {
            Self::F32(v) => v.into_iter().map(f64::from).collect(),
            Self::F64(v) => v,
            Self::Integer(v) => v.into_iter().map(|x| x as f64).collect(),
        }
    }

    /// Rows and columns exchanged: `rows x columns` in row order becomes `columns x rows`.
    pub(crate) fn transposed(&self, rows: usize, columns: usize) -> Self {
        fn turn<T: Copy>(v: &[T], rows: usize, columns: usize) -> Vec<T> {
            (0..columns)
                .flat_map(|c| (0..rows).map(move |r| v[r * columns + c]))
                .collect()
        }
        match self {
            Self::F32(v) => Self::F32(turn(v, rows, columns)),
            Self::F64(v) => Self::F64(turn(v, rows, columns)),
            Self::Integer(v) => Self::Integer(turn(v, rows, columns)),
        }
    }
}

/// An array in row order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    pub(crate) shape: Vec<usize>,
    pub(crate) numbers: Numbers,
}

impl Array {
    /// Rows and columns of a 2-dimensional array.
    pub(crate) fn rows_columns(&self) -> Parsed<(usize, usize)> {
        match self.shape[..] {
            [rows, columns] => Ok((rows, columns)),
            _ => Err(Flaw::new(
                format!("an array of shape {:?}", self.shape),
                "2 dimensions: rows and columns",
            )),
        }
    }

    /// The integers of an integer array; an empty array of any type passes.
    pub(crate) fn into_integers(self) -> Parsed<Vec<i64>> {
        match self.numbers {
            Numbers::Integer(v) => Ok(v),
            Numbers::F32(v) if v.is_empty() => Ok(vec![]),
            Numbers::F64(v) if v.is_empty() => Ok(vec![]),
            _ => Err(Flaw::new("floating point numbers", "integers")),
        }
    }
}

/// Reads one array.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Array> {
    if bytes.is_empty() {
        return Err(Flaw::new("an empty file", "a NumPy array"));
    }
    check_header(bytes)?;
    let mut rest = bytes;
    let header = Header::from_reader(&mut rest)
        .map_err(|e| Flaw::new(format!("a bad header ({e})"), "a NumPy array"))?;
    let descriptor = header
        .type_descriptor
        .as_string()
        .ok_or_else(|| Flaw::new("an array of records", "an array of numbers"))?;
    let (big, kind) = match descriptor.split_at_checked(1) {
        Some(("<" | "|" | "=", kind)) => (false, kind),
        Some((">", kind)) => (true, kind),
        _ => (false, descriptor.as_str()),
    };
    let size = match kind {
        "f8" | "i8" | "u8" => 8,
        "f4" | "i4" | "u4" => 4,
        "i2" | "u2" => 2,
        "i1" | "u1" => 1,
        _ => {
            return Err(Flaw::new(
                format!("an array of type {}", excerpt(descriptor)),
                "float32, float64 or integers",
            ));
        }
    };
    let promised = header
        .shape
        .iter()
        .try_fold(size, |product: usize, &n| product.checked_mul(n));
    if promised != Some(rest.len()) {
        return Err(Flaw::new(
            format!("{} bytes of data", rest.len()),
            match promised {
                Some(bytes) => format!("{bytes}, as the header promises shape {:?}", header.shape),
                None => format!(
                    "more than there can be, as the header promises shape {:?}",
                    header.shape
                ),
            },
        ));
    }
    let mut numbers = decode(kind, big, rest)?;
    let shape = header.shape;
    if header.layout.is_fortran() && shape.len() > 1 {
        let [rows, columns] = shape[..] else {
            return Err(Flaw::new(
                format!("an array of shape {shape:?}"),
                "at most 2 dimensions",
            ));
        };
        numbers = numbers.transposed(columns, rows);
    }
    Ok(Array { shape, numbers })
}

/// Bounds the length and nesting of the header, which a recursive parser reads next.
fn check_header(bytes: &[u8]) -> Parsed<()> {
    let not_an_array = || {
        Flaw::new(
            "something else",
            "a NumPy array, which starts with \\x93NUMPY",
        )
    };
    let truncated = || Flaw::new("a truncated header", "a NumPy array");
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err(not_an_array());
    }
    let (start, length) = match bytes.get(6..12) {
        Some(&[1, _, a, b, _, _]) => (10, u16::from_le_bytes([a, b]) as usize),
        Some(&[_, _, a, b, c, d]) => (12, u32::from_le_bytes([a, b, c, d]) as usize),
        _ => return Err(truncated()),
    };
    if length > LONGEST_HEADER {
        return Err(Flaw::new(
            format!("a header of {length} bytes"),
            format!("at most {LONGEST_HEADER}"),
        ));
    }
    let header = bytes.get(start..start + length).ok_or_else(truncated)?;
    let mut depth = 0_usize;
    for byte in header {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > 8 {
            return Err(Flaw::new(
                "a header of nested brackets",
                "an array of numbers",
            ));
        }
    }
    Ok(())
}

/// Numbers of a type named as NumPy does (`f8`, `i4`, ...), one after the other.
pub(crate) fn decode(kind: &str, big: bool, bytes: &[u8]) -> Parsed<Numbers> {
    macro_rules! all {
        ($type:ty, $width:literal) => {
            bytes.as_chunks::<$width>().0.iter().map(|&c| {
                if big {
                    <$type>::from_be_bytes(c)
                } else {
                    <$type>::from_le_bytes(c)
                }
            })
        };
    }
    Ok(match kind {
        "f8" => Numbers::F64(all!(f64, 8).collect()),
        "f4" => Numbers::F32(all!(f32, 4).collect()),
        "i8" => Numbers::Integer(all!(i64, 8).collect()),
        "i4" => Numbers::Integer(all!(i32, 4).map(i64::from).collect()),
        "i2" => Numbers::Integer(all!(i16, 2).map(i64::from).collect()),
        "i1" => Numbers::Integer(all!(i8, 1).map(i64::from).collect()),
        "u4" => Numbers::Integer(all!(u32, 4).map(i64::from).collect()),
        "u2" => Numbers::Integer(all!(u16, 2).map(i64::from).collect()),
        "u1" => Numbers::Integer(all!(u8, 1).map(i64::from).collect()),
        "u8" => Numbers::Integer(
            all!(u64, 8)
                .enumerate()
                .map(|(at, x)| {
                    i64::try_from(x).map_err(|_| {
                        Flaw::new(
                            format!("{x} as entry {at}"),
                            format!("an integer up to {}", i64::MAX),
                        )
                    })
                })
                .collect::<Parsed<_>>()?,
        ),
        _ => {
            return Err(Flaw::new(
                format!("numbers of type {kind}"),
                "float32, float64 or integers",
            ));
        }
    })
}

/// The bytes of an array file.
pub(crate) fn bytes<A: WritableElement, D: Dimension>(array: ArrayView<'_, A, D>) -> Vec<u8> {
    let mut bytes = Vec::new();
    array
        .write_npy(&mut bytes)
        .expect("a short header and memory that grows");
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array1, Array2, ShapeBuilder};

    fn with_header(text: &str, data: usize) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.as_bytes());
        bytes.extend(vec![0; data]);
        bytes
    }

    #[test]
    fn fortran_order_and_every_integer() {
        let f = Array2::from_shape_vec((2, 3).f(), vec![1.0, 4.0, 2.0, 5.0, 3.0, 6.0]).unwrap();
        let back = parse(&bytes(f.view())).unwrap();
        assert_eq!(back.shape, [2, 3]);
        assert_eq!(
            back.numbers,
            Numbers::F64(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
        );
        macro_rules! kind {
            ($($type:ty),*) => {$(
                let a = Array1::from(vec![0 as $type, 7, <$type>::MAX / 2]);
                let back = parse(&bytes(a.view())).unwrap().into_integers().unwrap();
                assert_eq!(back, [0, 7, (<$type>::MAX / 2) as i64]);
            )*};
        }
        kind!(i8, i16, i32, i64, u8, u16, u32, u64);
        let too_large = bytes(Array1::from(vec![1, u64::MAX]).view());
        assert!(parse(&too_large).unwrap_err().found.contains("entry 1"));
    }

    #[test]
    fn big_endian() {
        let header = "{'descr': '>i2', 'fortran_order': False, 'shape': (1,), }\n";
        let mut bytes = with_header(header, 2);
        *bytes.last_mut().unwrap() = 5;
        assert_eq!(parse(&bytes).unwrap().numbers, Numbers::Integer(vec![5]));
    }

    #[test]
    fn a_header_that_lies_is_refused_before_allocation() {
        for shape in [
            "(1000000000000, 3)",
            "(18446744073709551615, 18446744073709551615)",
            "(2, 1)",
        ] {
            let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
            let flaw = parse(&with_header(&text, 8)).unwrap_err();
            assert_eq!(flaw.found, "8 bytes of data");
            assert!(flaw.expected.contains("header promises"), "{flaw:?}");
        }
        let nested = "(".repeat(60_000);
        let flaw = parse(&with_header(&nested, 0)).unwrap_err();
        assert!(flaw.found.contains("nested"), "{flaw:?}");
    }
}
