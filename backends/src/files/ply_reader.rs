//! Polygon files, read: any elements with any properties, ASCII and binary of both byte orders.
//!
//! Before memory is taken, the element counts of the header are compared with the bytes that are
//! there.

use super::error::{Flaw, Parsed, excerpt};
use super::table::{number, text};

/// Longest header that is believed.
const LONGEST_HEADER: usize = 1 << 16;

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number in the first bytes; exact.
    fn number(self, bytes: &[u8], big: bool) -> Option<f64> {
        macro_rules! read {
            ($type:ty) => {{
                let bytes = *bytes.first_chunk()?;
                f64::from(if big {
                    <$type>::from_be_bytes(bytes)
                } else {
                    <$type>::from_le_bytes(bytes)
                })
            }};
        }
        Some(match self {
            Self::I8 => read!(i8),
            Self::U8 => read!(u8),
            Self::I16 => read!(i16),
            Self::U16 => read!(u16),
            Self::I32 => read!(i32),
            Self::U32 => read!(u32),
            Self::F32 => read!(f32),
            Self::F64 => read!(f64),
        })
    }
}

/// A property of an element.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Property {
    pub(crate) name: String,
    /// The type of its number, or of the numbers of a list.
    pub(crate) kind: Type,
    /// For a list: the type of their count.
    pub(crate) list: Option<Type>,
}

/// An element: its rows have these properties.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) count: usize,
    pub(crate) properties: Vec<Property>,
}

impl Element {
    /// Names of the properties that are one number, in the order of [`Rows::scalars`].
    pub(crate) fn scalars(&self) -> impl Iterator<Item = &Property> {
        self.properties.iter().filter(|p| p.list.is_none())
    }

    /// Which column of [`Rows::scalars`] a property is.
    pub(crate) fn column(&self, name: &str) -> Option<usize> {
        self.scalars().position(|p| p.name == name)
    }

    /// The fewest bytes of a row.
    fn least(&self, encoding: Encoding) -> usize {
        let width = |p: &Property| match encoding {
            // A digit, and a space or the end of the line.
            Encoding::Ascii => 2,
            _ => p.list.unwrap_or(p.kind).width(),
        };
        self.properties.iter().map(width).sum()
    }
}

/// How the rows are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Ascii,
    Binary { big: bool },
}

/// The rows of an element.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    /// Numbers of the properties that are one number, row after row.
    pub(crate) scalars: Vec<f64>,
    /// How many of them a row has.
    pub(crate) width: usize,
    /// The lists that are corners of faces, one after the other, and where each ends.
    pub(crate) corners: Vec<i64>,
    pub(crate) ends: Vec<usize>,
}

impl Rows {
    /// A column of [`Self::scalars`].
    pub(crate) fn column(&self, column: usize) -> impl Iterator<Item = f64> + '_ {
        self.scalars
            .chunks_exact(self.width)
            .map(move |r| r[column])
    }
}

/// A file of which the header is read.
pub(crate) struct Reader<'a> {
    pub(crate) elements: Vec<Element>,
    /// The comments of the header, without the word.
    pub(crate) comments: Vec<&'a str>,
    encoding: Encoding,
    data: &'a [u8],
    /// Line of the first row behind the header, from 1.
    line: usize,
}

impl<'a> Reader<'a> {
    /// Reads the header.
    pub(crate) fn open(bytes: &'a [u8]) -> Parsed<Self> {
        if bytes.is_empty() {
            return Err(Flaw::new("an empty file", "a polygon file"));
        }
        if !bytes.starts_with(b"ply") {
            return Err(Flaw::new(
                "something else",
                "a polygon file, which starts with ply",
            ));
        }
        let window = &bytes[..bytes.len().min(LONGEST_HEADER)];
        let end = b"end_header";
        let at = window
            .windows(end.len())
            .position(|w| w == end)
            .ok_or_else(|| Flaw::new("no end_header", "a header that ends so"))?;
        let mut reader = Self {
            elements: vec![],
            comments: vec![],
            encoding: Encoding::Ascii,
            data: &[],
            line: 1,
        };
        let mut told = false;
        for row in text(&bytes[..at])?.lines() {
            told |= reader.header(row.trim())?;
            reader.line += 1;
        }
        if !told {
            return Err(Flaw::new("no format", "a line such as format ascii 1.0"));
        }
        let data = &bytes[at + end.len()..];
        reader.data = match data {
            [b'\r', b'\n', rest @ ..] | [b'\n', rest @ ..] | [b'\r', rest @ ..] => rest,
            rest => rest,
        };
        reader.check()?;
        Ok(reader)
    }

    /// A line of the header; whether it tells the format.
    fn header(&mut self, row: &'a str) -> Parsed<bool> {
        let line = self.line;
        let bad = |expected: &str| Err(Flaw::line(line, excerpt(row), expected));
        let words: Vec<&str> = row.split_whitespace().collect();
        match words[..] {
            ["ply"] | [] | ["obj_info", ..] => {}
            ["comment", ..] => self.comments.push(row["comment".len()..].trim()),
            ["format", name, _] => {
                self.encoding = match name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::Binary { big: false },
                    "binary_big_endian" => Encoding::Binary { big: true },
                    _ => return bad("ascii, binary_little_endian or binary_big_endian"),
                };
                return Ok(true);
            }
            ["element", name, count] => {
                let Ok(count) = count.parse() else {
                    return bad("a number of elements that there can be");
                };
                self.elements.push(Element {
                    name: name.into(),
                    count,
                    properties: vec![],
                });
            }
            ["property", "list", count, kind, name] => {
                let (Some(list), Some(kind)) = (Type::of(count), Type::of(kind)) else {
                    return bad("types of numbers");
                };
                return self.property(Some(list), kind, name);
            }
            ["property", kind, name] => {
                let Some(kind) = Type::of(kind) else {
                    return bad("a type of number");
                };
                return self.property(None, kind, name);
            }
            _ => return bad("format, element, property, comment or end_header"),
        }
        Ok(false)
    }

    fn property(&mut self, list: Option<Type>, kind: Type, name: &str) -> Parsed<bool> {
        let Some(element) = self.elements.last_mut() else {
            return Err(Flaw::line(self.line, "a property", "an element before it"));
        };
        element.properties.push(Property {
            name: name.into(),
            kind,
            list,
        });
        Ok(false)
    }

    /// Compares what the header promises with the bytes that are there.
    fn check(&self) -> Parsed<()> {
        let there = self.data.len();
        let mut needed = 0_usize;
        for element in &self.elements {
            let least = element.least(self.encoding);
            if least == 0 && element.count > 0 {
                return Err(Flaw::new("no property", "at least one").within(&element.name));
            }
            needed = needed.saturating_add(element.count.saturating_mul(least));
            // The last line of an ASCII file may lack its end.
            if needed > there.saturating_add(1) {
                return Err(Flaw::new(
                    format!("{there} bytes behind the header"),
                    format!(
                        "{needed} or more, as the header promises {} elements",
                        element.count
                    ),
                )
                .within(&element.name));
            }
        }
        Ok(())
    }

    /// The rows of the next element.
    pub(crate) fn rows(&mut self, element: &Element) -> Parsed<Rows> {
        let mut rows = Rows {
            width: element.scalars().count(),
            ..Rows::default()
        };
        for at in 0..element.count {
            match self.encoding {
                Encoding::Ascii => self.text_row(element, at, &mut rows)?,
                Encoding::Binary { big } => self.binary_row(element, at, big, &mut rows)?,
            }
        }
        Ok(rows)
    }

    fn text_row(&mut self, element: &Element, at: usize, rows: &mut Rows) -> Parsed<()> {
        let (row, line) = loop {
            if self.data.is_empty() {
                return Err(truncated(element, at));
            }
            let end = self.data.iter().position(|&b| b == b'\n');
            let (row, rest) = self.data.split_at(end.map_or(self.data.len(), |e| e + 1));
            (self.data, self.line) = (rest, self.line + 1);
            let row = text(row).map_err(|f| f.within(&element.name))?.trim();
            if !row.is_empty() {
                break (row, self.line);
            }
        };
        let mut fields = row.split_whitespace().enumerate();
        let mut next = |kind: Type| -> Parsed<f64> {
            let (k, field) = fields
                .next()
                .ok_or_else(|| Flaw::line(line, excerpt(row), "a number for every property"))?;
            let x = number(field, line, k + 1)?;
            // As a file with bytes would hold it.
            Ok(if kind == Type::F32 {
                f64::from(x as f32)
            } else {
                x
            })
        };
        for property in &element.properties {
            let count = match property.list {
                None => {
                    rows.scalars.push(next(property.kind)?);
                    continue;
                }
                Some(list) => next(list)?,
            };
            let wanted = is_corners(&property.name);
            let mut left = count;
            while left >= 1.0 {
                let item = next(property.kind)?;
                if wanted {
                    rows.corners.push(item as i64);
                }
                left -= 1.0;
            }
            if wanted {
                rows.ends.push(rows.corners.len());
            }
        }
        Ok(())
    }

    fn binary_row(
        &mut self,
        element: &Element,
        at: usize,
        big: bool,
        rows: &mut Rows,
    ) -> Parsed<()> {
        let data = &mut self.data;
        let mut next = |kind: Type| {
            let x = kind
                .number(data, big)
                .ok_or_else(|| truncated(element, at))?;
            *data = &data[kind.width()..];
            Ok(x)
        };
        for property in &element.properties {
            let Some(list) = property.list else {
                rows.scalars.push(next(property.kind)?);
                continue;
            };
            let wanted = is_corners(&property.name);
            let mut left = next(list)?;
            while left >= 1.0 {
                let item = next(property.kind)?;
                if wanted {
                    rows.corners.push(item as i64);
                }
                left -= 1.0;
            }
            if wanted {
                rows.ends.push(rows.corners.len());
            }
        }
        Ok(())
    }
}

fn truncated(element: &Element, at: usize) -> Flaw {
    Flaw::new(
        format!("the end of the file after {at} rows"),
        format!("{}, as the header promises", element.count),
    )
    .within(&element.name)
}

fn is_corners(name: &str) -> bool {
    name == "vertex_indices" || name == "vertex_index"
}
