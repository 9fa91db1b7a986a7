//! NumPy arrays, `.npy`.
//!
//! Read and written by ourselves: a header of one line, then the numbers. Before anything is
//! allocated, the size that the header promises is compared with the bytes that are there.

use super::error::{Flaw, Parsed, excerpt};
use super::npy_header::{self, Field, Header};
use half::f16;

/// What to do about a type that is no plain number.
const SAVE_AGAIN: &str = "save it again as array.astype(float)";

/// Numbers as they are stored; integers of every width as `i64`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Numbers {
    F32(Vec<f32>),
    F64(Vec<f64>),
    Integer(Vec<i64>),
}

impl Numbers {
    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::F32(v) => v.len(),
            Self::F64(v) => v.len(),
            Self::Integer(v) => v.len(),
        }
    }

    /// Takes others of the same type behind these; those of another type not.
    pub(crate) fn extend(&mut self, others: Self) {
        match (self, others) {
            (Self::F32(all), Self::F32(more)) => all.extend(more),
            (Self::F64(all), Self::F64(more)) => all.extend(more),
            (Self::Integer(all), Self::Integer(more)) => all.extend(more),
            _ => {}
        }
    }

    /// Some columns of rows that have `columns` of them.
    pub(crate) fn columns(&self, columns: usize, kept: &[usize]) -> Self {
        fn some<T: Copy>(v: &[T], columns: usize, kept: &[usize]) -> Vec<T> {
            v.chunks_exact(columns)
                .flat_map(|row| kept.iter().map(|&k| row[k]))
                .collect()
        }
        match self {
            Self::F32(v) => Self::F32(some(v, columns, kept)),
            Self::F64(v) => Self::F64(some(v, columns, kept)),
            Self::Integer(v) => Self::Integer(some(v, columns, kept)),
        }
    }

    /// A number in double precision.
    pub(crate) fn at(&self, at: usize) -> f64 {
        match self {
            Self::F32(v) => v[at].into(),
            Self::F64(v) => v[at],
            Self::Integer(v) => v[at] as f64,
        }
    }

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
            // An empty array may have any number of columns.
            if v.is_empty() {
                return vec![];
            }
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
    /// Names of the columns, when the entries were records.
    pub(crate) names: Option<Vec<String>>,
    /// Whether the numbers were stored with 11 bits.
    pub(crate) half: bool,
}

impl Array {
    /// An array of numbers without names.
    pub(crate) fn new(shape: Vec<usize>, numbers: Numbers) -> Self {
        Self {
            shape,
            numbers,
            names: None,
            half: false,
        }
    }

    /// Rows and columns of a 2-dimensional array; axes of length one before or behind do not count.
    pub(crate) fn rows_columns(&self) -> Parsed<(usize, usize)> {
        match self.shape[..] {
            [rows, columns] => return Ok((rows, columns)),
            [1, rows, columns] | [rows, columns, 1] => return Ok((rows, columns)),
            _ => {}
        }
        let advice = match self.shape[..] {
            [_] => ": array.reshape(-1, N), with N coordinates a point",
            [_, _, _, ..] => ": array.reshape(len(array), -1) makes a point of every first index",
            _ => "",
        };
        Err(Flaw::new(
            format!("an array of shape {:?}", self.shape),
            format!("2 dimensions: rows and columns{advice}"),
        ))
    }

    /// The integers of an integer array; an empty array of any type passes.
    pub(crate) fn into_integers(self) -> Parsed<Vec<i64>> {
        match self.numbers {
            Numbers::Integer(v) => Ok(v),
            other if other.len() == 0 => Ok(vec![]),
            _ => Err(Flaw::new("floating point numbers", "integers")),
        }
    }
}

/// Reads one array. Records become rows: a column for every number in them.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Array> {
    if bytes.is_empty() {
        return Err(Flaw::new("an empty file", "a NumPy array"));
    }
    let (header, data) = npy_header::parse(bytes)?;
    let pickled = header.fields.iter().any(|f| f.kind.starts_with('O'));
    let promised = header
        .shape
        .iter()
        .try_fold(header.entry(), |product, &n| product.checked_mul(n));
    if promised != Some(data.len()) && !pickled {
        return Err(Flaw::new(
            format!("{} bytes of data", data.len()),
            match promised {
                Some(bytes) => format!("{bytes}, as the header promises shape {:?}", header.shape),
                None => format!(
                    "more than there can be, as the header promises shape {:?}",
                    header.shape
                ),
            },
        ));
    }
    if header.record {
        return records(&header, data);
    }
    let field = &header.fields[0];
    let mut numbers = decode(&field.kind, field.big, data)?;
    let shape = header.shape;
    if header.fortran && shape.iter().filter(|&&n| n != 1).count() > 1 {
        let long: Vec<usize> = shape.iter().copied().filter(|&n| n != 1).collect();
        let [rows, columns] = long[..] else {
            return Err(Flaw::new(
                format!("an array of shape {shape:?}"),
                "at most 2 dimensions",
            ));
        };
        numbers = numbers.transposed(columns, rows);
    }
    Ok(Array {
        half: field.kind == "f2",
        ..Array::new(shape, numbers)
    })
}

/// Records as rows, their numbers as columns; texts and gaps are left out.
fn records(header: &Header, data: &[u8]) -> Parsed<Array> {
    let entry = header.entry();
    let is_number = |f: &&Field| f.count > 0 && matches!(f.kind.as_bytes()[0], b'f' | b'i' | b'u');
    if entry == 0 || header.shape.len() != 1 || !header.fields.iter().any(|f| is_number(&f)) {
        return Err(Flaw::new(
            format!(
                "records of {} fields in shape {:?}",
                header.fields.len(),
                header.shape
            ),
            "a list of records with numbers",
        ));
    }
    let rows = data.len() / entry;
    let mut names = Vec::new();
    let mut columns: Vec<Numbers> = Vec::new();
    let mut from = 0;
    for field in &header.fields {
        let size = field.count * field.width;
        if is_number(&field) {
            let packed: Vec<u8> = data
                .chunks_exact(entry)
                .flat_map(|row| &row[from..from + size])
                .copied()
                .collect();
            let numbers =
                decode(&field.kind, field.big, &packed).map_err(|f| f.within(&field.name))?;
            for k in 0..field.count {
                columns.push(numbers.columns(field.count, &[k]));
                names.push(if field.count == 1 {
                    field.name.clone()
                } else {
                    format!("{}[{k}]", field.name)
                });
            }
        }
        from += size;
    }
    let width = columns.len();
    let all = (0..rows * width).map(|at| columns[at % width].at(at / width));
    // Exact: single precision was widened, and is kept only when every column is of it.
    let numbers = if columns.iter().all(|c| matches!(c, Numbers::F32(_))) {
        Numbers::F32(all.map(|x| x as f32).collect())
    } else {
        Numbers::F64(all.collect())
    };
    Ok(Array {
        names: Some(names),
        half: header.fields.iter().any(|f| f.kind == "f2"),
        ..Array::new(vec![rows, width], numbers)
    })
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
        // Widening is exact.
        "f2" => Numbers::F32(all!(f16, 2).map(f32::from).collect()),
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
            let found = match kind {
                "b1" => "truth values".to_string(),
                "c8" | "c16" => format!("complex numbers ({kind})"),
                "f12" | "f16" => format!("long doubles ({kind})"),
                "O" | "O8" => "Python objects".into(),
                _ => format!("type {}", excerpt(kind)),
            };
            return Err(Flaw::new(
                format!("an array of {found}"),
                format!("float16, float32, float64 or integers: {SAVE_AGAIN}"),
            ));
        }
    })
}

/// A number as NumPy stores it.
pub(crate) trait Stored: Copy {
    /// NumPy's name of the type, with the byte order.
    const DESCRIPTOR: &'static str;
    /// Appends its bytes.
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! stored {
    ($($type:ty: $name:literal),*) => {$(
        impl Stored for $type {
            const DESCRIPTOR: &'static str = $name;
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    )*};
}
stored!(f64: "<f8", i64: "<i8", u8: "|u1");
#[cfg(test)]
stored!(f16: "<f2", f32: "<f4", i8: "|i1", i16: "<i2", i32: "<i4", u16: "<u2", u32: "<u4", u64: "<u8");

/// The bytes of an array file, numbers in row order.
///
/// # Panics
/// When the shape is not that of so many numbers.
pub(crate) fn bytes<T: Stored>(shape: &[usize], numbers: &[T]) -> Vec<u8> {
    assert_eq!(shape.iter().product::<usize>(), numbers.len());
    let mut tuple: Vec<String> = shape.iter().map(ToString::to_string).collect();
    if tuple.len() == 1 {
        tuple.push(String::new());
    }
    let text = format!(
        "{{'descr': '{}', 'fortran_order': False, 'shape': ({})}}",
        T::DESCRIPTOR,
        tuple.join(", ").trim_end()
    );
    // The data begin at a multiple of 64 bytes, behind spaces and the end of the line.
    let length = (text.len() + 11).next_multiple_of(64) - 10;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(text.bytes());
    bytes.resize(9 + length, b' ');
    bytes.push(b'\n');
    bytes.reserve(size_of_val(numbers));
    numbers.iter().for_each(|x| x.put(&mut bytes));
    bytes
}

#[cfg(test)]
mod tests;
