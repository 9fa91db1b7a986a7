//! VTK's files in XML: elements with arrays of numbers, `.vtu` and `.vtp`.
//!
//! Arrays are read in the formats `ascii`, `binary` and `appended` (raw or base64), as they are or
//! packed by zlib: what ParaView, PyVista and meshio write.

mod data;

use super::error::{Flaw, Parsed, excerpt};
use super::npy::{self, Numbers};
use super::table::text;
use data::{Encoding, data_array};
use roxmltree::{Document, Node};

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

#[cfg(test)]
mod tests;
