//! VTK's files in XML: elements with arrays of numbers, `.vtu` and `.vtp`.
//!
//! Arrays are read in the formats `ascii`, `binary` and `appended` (raw or base64), as they are or
//! packed by zlib: what ParaView, PyVista and meshio write.

use super::error::{Flaw, Parsed, excerpt};
use super::npy::{self, Numbers};
use super::npz::LARGEST_INFLATION;
use super::table::text;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use roxmltree::{Document, Node};
use std::io::Read;

/// Deepest nesting of elements that is handed to the parser, which recurses; a grid needs 5.
const DEEPEST: usize = 64;

/// The text of a file, apart from the arrays that are appended to it.
pub(crate) struct Source<'a> {
    text: std::borrow::Cow<'a, str>,
    appended: &'a [u8],
}

impl<'a> Source<'a> {
    /// Takes the appended arrays, which need not be text, out of a file.
    pub(crate) fn new(bytes: &'a [u8]) -> Parsed<Self> {
        let find = |from: usize, what: &[u8]| {
            let rest = &bytes[from..];
            rest.windows(what.len())
                .position(|w| w == what)
                .map(|at| from + at)
        };
        if let Some(element) = find(0, b"<AppendedData")
            && let Some(open) = find(element, b">")
            && let Some(mark) = find(open, b"_")
        {
            let close = b"</AppendedData>";
            let last = bytes.windows(close.len()).rposition(|w| w == close);
            let end = last.filter(|&at| at > mark).ok_or_else(|| {
                Flaw::new("appended data without an end", "a complete file").within("AppendedData")
            })?;
            let mut whole = String::from(text(&bytes[..=open])?);
            whole += text(&bytes[end..])?;
            return Ok(Self {
                text: whole.into(),
                appended: &bytes[mark + 1..end],
            });
        }
        Ok(Self {
            text: text(bytes)?.into(),
            appended: &[],
        })
    }

    /// Reads the elements.
    pub(crate) fn open(&self) -> Parsed<File<'_>> {
        if self.text.trim().is_empty() {
            return Err(Flaw::new("an empty file", "a VTK file in XML"));
        }
        if nesting(&self.text) > DEEPEST {
            return Err(Flaw::new(
                format!("elements nested more than {DEEPEST} deep"),
                "a VTK file in XML",
            ));
        }
        let document = Document::parse(&self.text).map_err(|e| {
            Flaw::line(
                e.pos().row as usize,
                format!("bad XML ({e})"),
                "a VTK file in XML",
            )
        })?;
        Ok(File {
            document,
            appended: self.appended,
        })
    }
}

/// A file whose elements are read.
pub(crate) struct File<'a> {
    document: Document<'a>,
    appended: &'a [u8],
}

/// How the binary arrays of a file are encoded.
struct Encoding<'a> {
    big: bool,
    wide: bool,
    compressor: Option<&'a str>,
    appended: &'a [u8],
    raw: bool,
}

/// A data set, or a piece of one.
pub(crate) struct Piece<'a, 'input> {
    node: Node<'a, 'input>,
    encoding: Encoding<'a>,
}

impl File<'_> {
    /// The pieces of a data set of this kind, such as `UnstructuredGrid`.
    pub(crate) fn pieces<'a>(&'a self, kind: &str) -> Parsed<Vec<Piece<'a, 'a>>> {
        let root = self.document.root_element();
        let pieces: Vec<_> = root
            .children()
            .filter(|n| n.has_tag_name(kind))
            .flat_map(|grid| grid.children().filter(|n| n.has_tag_name("Piece")))
            .map(|node| Piece {
                node,
                encoding: self.encoding(),
            })
            .collect();
        if pieces.is_empty() {
            let found = root.attribute("type").unwrap_or("unknown");
            return Err(Flaw::new(
                format!("0 pieces of {kind} (the type is {})", excerpt(found)),
                "one or more",
            ));
        }
        Ok(pieces)
    }

    /// An array that belongs to the data set as a whole.
    pub(crate) fn field(&self, kind: &str, name: &str) -> Parsed<Option<Numbers>> {
        let root = self.document.root_element();
        let grid = root.children().find(|n| n.has_tag_name(kind));
        let mut fields = grid
            .into_iter()
            .flat_map(|g| g.children().filter(|n| n.has_tag_name("FieldData")))
            .flat_map(|f| f.children());
        fields
            .find(|n| n.attribute("Name") == Some(name))
            .map(|node| {
                let array = data_array(node, &self.encoding()).map_err(|f| f.within(name))?;
                Ok(array.1)
            })
            .transpose()
    }

    fn encoding(&self) -> Encoding<'_> {
        let root = self.document.root_element();
        let appended = root.children().find(|n| n.has_tag_name("AppendedData"));
        Encoding {
            big: root.attribute("byte_order") == Some("BigEndian"),
            wide: root.attribute("header_type") == Some("UInt64"),
            compressor: root.attribute("compressor").filter(|c| !c.is_empty()),
            appended: self.appended,
            raw: appended.is_some_and(|n| n.attribute("encoding") == Some("raw")),
        }
    }
}

impl Piece<'_, '_> {
    /// Components and numbers of an array in a part such as `Points` or `CellData`.
    pub(crate) fn array(&self, part: &str, name: Option<&str>) -> Parsed<Option<(usize, Numbers)>> {
        let shown = name.unwrap_or(part);
        self.node
            .children()
            .filter(|n| n.has_tag_name(part))
            .flat_map(|n| n.children())
            .find(|n| {
                n.has_tag_name("DataArray") && name.is_none_or(|m| n.attribute("Name") == Some(m))
            })
            .map(|node| data_array(node, &self.encoding).map_err(|f| f.within(shown)))
            .transpose()
    }

    /// An array of integers.
    pub(crate) fn integers(&self, part: &str, name: &str) -> Parsed<Option<Vec<i64>>> {
        match self.array(part, Some(name))? {
            None => Ok(None),
            Some((_, Numbers::Integer(v))) => Ok(Some(v)),
            Some(_) => Err(Flaw::new("floating point numbers", "integers").within(name)),
        }
    }

    /// The places of the points, three numbers each.
    pub(crate) fn points(&self) -> Parsed<Numbers> {
        let (components, points) = self
            .array("Points", None)?
            .ok_or_else(|| Flaw::new("no points", "a data array in Points"))?;
        if components != 3 || !points.len().is_multiple_of(3) {
            return Err(Flaw::new(
                format!("{} numbers, {components} a point", points.len()),
                "3 a point",
            )
            .within("Points"));
        }
        Ok(points)
    }
}

/// The points of all pieces of a data set.
pub(crate) fn parse_points(bytes: &[u8], kind: &str) -> Parsed<npy::Array> {
    let source = Source::new(bytes)?;
    let file = source.open()?;
    let pieces = file.pieces(kind)?;
    let mut all = Vec::with_capacity(pieces.len());
    for piece in &pieces {
        all.push(piece.points()?);
    }
    let numbers = match all.len() {
        1 => all.swap_remove(0),
        _ => Numbers::F64(all.into_iter().flat_map(Numbers::into_f64).collect()),
    };
    Ok(npy::Array::new(vec![numbers.len() / 3, 3], numbers))
}

/// How deep the elements of a text are nested, up to its first mistake in XML.
fn nesting(text: &str) -> usize {
    let (mut depth, mut deepest) = (0_usize, 0);
    let mut rest = text;
    while let Some(at) = rest.find('<') {
        rest = &rest[at..];
        let end = match rest {
            r if r.starts_with("<!--") => r[4..].find("-->").map(|i| i + 7),
            r if r.starts_with("<![CDATA[") => r.find("]]>").map(|i| i + 3),
            r if r.starts_with("<?") => r.find("?>").map(|i| i + 2),
            r if r.starts_with("</") => {
                depth = depth.saturating_sub(1);
                Some(2)
            }
            r => {
                let mut quote = None;
                let end = r.bytes().position(|byte| match (quote, byte) {
                    (None, b'>') => true,
                    (None, b'"' | b'\'') => {
                        quote = Some(byte);
                        false
                    }
                    (Some(open), _) if open == byte => {
                        quote = None;
                        false
                    }
                    _ => false,
                });
                depth += 1;
                deepest = deepest.max(depth);
                if end.is_some_and(|end| r[..end].ends_with('/')) {
                    depth -= 1;
                }
                end
            }
        };
        match end {
            Some(end) => rest = &rest[end..],
            None => break,
        }
    }
    deepest
}

/// Number of components, and the numbers.
fn data_array(node: Node<'_, '_>, encoding: &Encoding<'_>) -> Parsed<(usize, Numbers)> {
    let components = match node.attribute("NumberOfComponents") {
        Some(n) => n
            .parse()
            .map_err(|_| Flaw::new(excerpt(n), "a number of components"))?,
        None => 1,
    };
    let kind = match node.attribute("type") {
        Some("Float64") => "f8",
        Some("Float32") => "f4",
        Some("Int64") => "i8",
        Some("Int32") => "i4",
        Some("Int16") => "i2",
        Some("Int8") => "i1",
        Some("UInt64") => "u8",
        Some("UInt32") => "u4",
        Some("UInt16") => "u2",
        Some("UInt8" | "String") => "u1",
        other => {
            return Err(Flaw::new(
                format!("type {}", excerpt(other.unwrap_or(""))),
                "a type of number",
            ));
        }
    };
    let content = node.text().unwrap_or("");
    let numbers = match node.attribute("format") {
        Some("ascii") if kind.starts_with('f') => Numbers::F64(ascii(content)?),
        Some("ascii") => Numbers::Integer(ascii(content)?),
        Some("binary") => {
            let packed: String = content.split_ascii_whitespace().collect();
            binary(packed.as_bytes(), false, kind, encoding)?
        }
        Some("appended") => {
            let offset = node.attribute("offset").unwrap_or("");
            let at = offset.parse::<usize>().ok();
            let data = at
                .and_then(|at| encoding.appended.get(at..))
                .ok_or_else(|| {
                    Flaw::new(
                        format!("offset {}", excerpt(offset)),
                        format!("one of {} bytes of appended data", encoding.appended.len()),
                    )
                })?;
            binary(data, encoding.raw, kind, encoding)?
        }
        other => {
            return Err(Flaw::new(
                format!("format {}", excerpt(other.unwrap_or(""))),
                "ascii, binary or appended",
            ));
        }
    };
    Ok((components, numbers))
}

fn ascii<T: std::str::FromStr>(content: &str) -> Parsed<Vec<T>> {
    content
        .split_ascii_whitespace()
        .map(|field| {
            field
                .parse()
                .map_err(|_| Flaw::new(excerpt(field), "a number"))
        })
        .collect()
}

/// Words that tell sizes, then the bytes of the numbers, in base64 or raw; packed by zlib or not.
fn binary(data: &[u8], raw: bool, kind: &str, encoding: &Encoding<'_>) -> Parsed<Numbers> {
    let width = if encoding.wide { 8 } else { 4 };
    let word = |bytes: &[u8]| {
        bytes.iter().enumerate().fold(0_u64, |sum, (k, &byte)| {
            let place = if encoding.big { width - 1 - k } else { k };
            sum | u64::from(byte) << (8 * place)
        })
    };
    // The first words stand alone in base64 when packed data follow.
    let head = |bytes: usize| -> Parsed<Vec<u8>> {
        let short = || {
            Flaw::new(
                format!("{} bytes", data.len()),
                format!("{bytes} bytes that say how many follow"),
            )
        };
        if raw {
            return data.get(..bytes).map(Vec::from).ok_or_else(short);
        }
        let characters = data.get(..4 * bytes.div_ceil(3)).ok_or_else(short)?;
        let mut decoded = decode(characters)?;
        if decoded.len() < bytes {
            return Err(short());
        }
        decoded.truncate(bytes);
        Ok(decoded)
    };
    let bytes = match encoding.compressor {
        None => {
            let size = word(&head(width)?);
            let needed = usize::try_from(size)
                .ok()
                .and_then(|s| s.checked_add(width));
            let there = if raw { data.len() } else { data.len() / 4 * 3 };
            let needed = needed.filter(|&n| n <= there).ok_or_else(|| {
                Flaw::new(
                    format!("{} bytes of data", there.saturating_sub(width)),
                    format!("{size}, as their header promises"),
                )
            })?;
            let mut all = if raw {
                data[..needed].to_vec()
            } else {
                let end = (4 * needed.div_ceil(3)).min(data.len());
                decode(&data[..end])?
            };
            if all.len() < needed {
                return Err(Flaw::new(
                    format!("{} bytes of data", all.len().saturating_sub(width)),
                    format!("{size}, as their header promises"),
                ));
            }
            all.truncate(needed);
            all.split_off(width)
        }
        Some("vtkZLibDataCompressor") => {
            let blocks = word(&head(width)?) as usize;
            if blocks > data.len() {
                return Err(Flaw::new(
                    format!("a promise of {blocks} blocks in {} bytes", data.len()),
                    "blocks that are there",
                ));
            }
            let header = (3 + blocks) * width;
            let words: Vec<u64> = head(header)?.chunks_exact(width).map(word).collect();
            let packed = if raw {
                data[header..].to_vec()
            } else {
                let sizes = words[3..]
                    .iter()
                    .fold(0_u64, |sum, &s| sum.saturating_add(s));
                let from = 4 * header.div_ceil(3);
                let length = usize::try_from(sizes).unwrap_or(usize::MAX).div_ceil(3);
                let to = from
                    .saturating_add(length.saturating_mul(4))
                    .min(data.len());
                decode(&data[from..to])?
            };
            inflate(&packed, &words[3..])?
        }
        Some(other) => {
            return Err(Flaw::new(
                format!("data packed by {}", excerpt(other)),
                "zlib, or none: save it again with another compressor",
            ));
        }
    };
    let one = usize::from(kind.as_bytes()[1] - b'0');
    if !bytes.len().is_multiple_of(one) {
        return Err(Flaw::new(
            format!("{} bytes of data", bytes.len()),
            format!("a multiple of {one}"),
        ));
    }
    npy::decode(kind, encoding.big, &bytes)
}

fn decode(characters: &[u8]) -> Parsed<Vec<u8>> {
    STANDARD
        .decode(characters)
        .map_err(|e| Flaw::new(format!("bad base64 ({e})"), "binary data"))
}

/// Blocks of these sizes, one after the other.
fn inflate(packed: &[u8], sizes: &[u64]) -> Parsed<Vec<u8>> {
    let mut all = Vec::new();
    let mut rest = packed;
    for (k, &size) in sizes.iter().enumerate() {
        let block = usize::try_from(size)
            .ok()
            .and_then(|s| rest.split_at_checked(s));
        let (block, behind) = block.ok_or_else(|| {
            Flaw::new(
                format!("{} bytes for block {k}", rest.len()),
                format!("{size}"),
            )
        })?;
        rest = behind;
        let limit = (block.len() as u64).saturating_mul(LARGEST_INFLATION);
        ZlibDecoder::new(block)
            .take(limit)
            .read_to_end(&mut all)
            .map_err(|e| Flaw::new(format!("bad packed data ({e})"), "blocks packed by zlib"))?;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write;

    /// A grid of two points whose array stands in the file in one of the ways there are.
    fn grid(root: &str, array: &str, content: &[u8], appended: &[u8]) -> Vec<u8> {
        let mut bytes = format!(
            "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" {root}><PolyData><Piece><Points>\
             <DataArray type=\"Float32\" NumberOfComponents=\"3\" {array}>"
        )
        .into_bytes();
        bytes.extend(content);
        bytes.extend(b"</DataArray></Points></Piece></PolyData>");
        bytes.extend(appended);
        bytes.extend(b"</VTKFile>");
        bytes
    }

    #[test]
    fn arrays_are_read_however_they_are_stored() {
        let numbers = [0.5_f32, 1.0, 2.0, 3.0, 4.0, -5.0];
        let data: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let plain = [&24_u32.to_le_bytes()[..], &data].concat();
        let mut blocks = Vec::new();
        for half in data.chunks(12) {
            let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
            packer.write_all(half).unwrap();
            blocks.push(packer.finish().unwrap());
        }
        let sizes = [2, 12, 0, blocks[0].len() as u64, blocks[1].len() as u64];
        let head: Vec<u8> = sizes.iter().flat_map(|s| s.to_le_bytes()).collect();
        let body = blocks.concat();
        let zlib = "compressor=\"vtkZLibDataCompressor\" header_type=\"UInt64\"";
        let at = "format=\"appended\" offset=\"2\"";
        let base64 = |b: &[u8]| STANDARD.encode(b).into_bytes();
        let packed = [base64(&head), base64(&body)].concat();
        let append = |encoding: &str, data: &[u8]| {
            let mut all = format!("<AppendedData encoding=\"{encoding}\">\n _xx").into_bytes();
            all.extend(data);
            all.extend(b"\n</AppendedData>");
            all
        };
        let raw = [&head[..], &body].concat();
        for (name, bytes) in [
            (
                "ascii",
                grid("", "format=\"ascii\"", b" 0.5 1\n2 3 4 -5 ", b""),
            ),
            (
                "binary",
                grid("", "format=\"binary\"", &base64(&plain), b""),
            ),
            ("packed", grid(zlib, "format=\"binary\"", &packed, b"")),
            ("raw", grid("", at, b"", &append("raw", &plain))),
            ("packed raw", grid(zlib, at, b"", &append("raw", &raw))),
            (
                "base64",
                grid("", at, b"", &append("base64", &base64(&plain))),
            ),
            (
                "packed base64",
                grid(zlib, at, b"", &append("base64", &packed)),
            ),
        ] {
            let array =
                parse_points(&bytes, "PolyData").unwrap_or_else(|f| panic!("{name}: {f:?}"));
            assert_eq!(array.shape, [2, 3], "{name}");
            let expected = numbers.map(f64::from);
            assert_eq!(array.numbers.into_f64(), expected, "{name}");
        }
    }

    #[test]
    fn nesting_is_counted_as_the_parser_sees_it() {
        for (text, deepest) in [
            ("<?xml version=\"1.0\"?><a><b/><b x='/>'/><c></c></a>", 2),
            ("<a><!-- </a><b><c> --><d e=\">\"><f/></d></a>", 3),
            ("<a><![CDATA[</a></a>]]><b><c/></b></a>", 3),
            ("<a><a><a", 3),
            ("", 0),
        ] {
            assert_eq!(nesting(text), deepest, "{text}");
        }
    }
}
