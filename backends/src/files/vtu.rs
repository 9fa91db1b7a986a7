//! Unstructured grids of VTK in XML, `.vtu`: what ParaView opens.
//!
//! Written by `vtkio`: triangles, and lines for the curve edges with the cell data `cells`, the
//! number of cells that meet there (-1 at triangles). Read by our own reader on `roxmltree`,
//! because that of `vtkio` panics on a data array that is too short and on a missing one; it takes
//! arrays in the formats `ascii` and `binary` without compression.

use super::error::{Flaw, Parsed, excerpt};
use super::mesh::{Parts, RawCurve, Sheet};
use super::npy::{self, Numbers};
use super::table::text;
use base64::Engine;
use roxmltree::{Document, Node};
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, ElementType, IOBuffer,
    UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};

/// VTK's number for a line.
const LINE: i64 = 3;
/// VTK's number for a triangle.
const TRIANGLE: i64 = 5;

/// Deepest nesting of elements that is handed to the parser, which recurses; a grid needs 5.
const DEEPEST: usize = 64;

/// The bytes of the file.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mesh = sheet.mesh;
    let complex = &mesh.complex;
    let array = |name: &str, components: usize, data: IOBuffer| {
        Attribute::DataArray(DataArray {
            name: name.into(),
            elem: ElementType::Generic(components as u32),
            data,
        })
    };
    let mut connectivity: Vec<u64> = Vec::new();
    let mut offsets = Vec::new();
    let mut cells = Vec::new();
    for edge in &complex.curve_edges {
        connectivity.extend(edge.ends.map(u64::from));
        offsets.push(connectivity.len() as u64);
        cells.push(i32::from(edge.cells));
    }
    for triangle in &complex.triangles {
        connectivity.extend(triangle.map(u64::from));
        offsets.push(connectivity.len() as u64);
        cells.push(-1);
    }
    let lines = complex.curve_edges.len();
    let mut types = vec![CellType::Line; lines];
    types.resize(offsets.len(), CellType::Triangle);
    let mut point = vec![array(
        "point_index",
        1,
        IOBuffer::I64(mesh.point_index.clone()),
    )];
    if sheet.given || mesh.vertices.dimension() != 3 {
        point.push(array(
            "coordinates",
            mesh.vertices.dimension(),
            IOBuffer::F64(mesh.vertices.coordinates().to_vec()),
        ));
    }
    let mut cell = vec![array("cells", 1, IOBuffer::I32(cells))];
    if let Some(pieces) = sheet.pieces {
        let mut labels = vec![-1; lines];
        labels.extend_from_slice(pieces);
        cell.push(array("piece", 1, IOBuffer::I64(labels)));
    }
    let grid = Vtk {
        version: Version::new((1, 0)),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(UnstructuredGridPiece {
            points: IOBuffer::F64(sheet.places.as_flattened().to_vec()),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity,
                    offsets,
                },
                types,
            },
            data: Attributes { point, cell },
        }),
    };
    let mut bytes = b"<?xml version=\"1.0\"?>\n".to_vec();
    grid.write_xml(&mut bytes)
        .expect("a grid of inline arrays and memory that grows");
    bytes.push(b'\n');
    bytes
}

/// How the binary arrays of a file are encoded.
struct Encoding {
    big: bool,
    wide: bool,
    compressed: bool,
}

/// Reads the file.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    let text = text(bytes)?;
    if text.trim().is_empty() {
        return Err(Flaw::new("an empty file", "an unstructured grid"));
    }
    if nesting(text) > DEEPEST {
        return Err(Flaw::new(
            format!("elements nested more than {DEEPEST} deep"),
            "an unstructured grid",
        ));
    }
    let document = Document::parse(text).map_err(|e| {
        Flaw::line(
            e.pos().row as usize,
            format!("bad XML ({e})"),
            "an unstructured grid, without raw appended data",
        )
    })?;
    let root = document.root_element();
    let encoding = Encoding {
        big: root.attribute("byte_order") == Some("BigEndian"),
        wide: root.attribute("header_type") == Some("UInt64"),
        compressed: root.attribute("compressor").is_some_and(|c| !c.is_empty()),
    };
    let pieces: Vec<Node> = root
        .children()
        .filter(|n| n.has_tag_name("UnstructuredGrid"))
        .flat_map(|grid| grid.children().filter(|n| n.has_tag_name("Piece")))
        .collect();
    let &[piece] = &pieces[..] else {
        return Err(Flaw::new(
            format!("{} pieces of an unstructured grid", pieces.len()),
            "one",
        ));
    };
    let read = |part: &str, name: Option<&str>| -> Parsed<Option<(usize, Numbers)>> {
        let shown = name.unwrap_or(part);
        piece
            .children()
            .filter(|n| n.has_tag_name(part))
            .flat_map(|n| n.children())
            .find(|n| {
                n.has_tag_name("DataArray") && name.is_none_or(|m| n.attribute("Name") == Some(m))
            })
            .map(|node| data_array(node, &encoding).map_err(|f| f.within(shown)))
            .transpose()
    };
    let integers = |part: &str, name: &str| -> Parsed<Option<Vec<i64>>> {
        match read(part, Some(name))? {
            None => Ok(None),
            Some((_, Numbers::Integer(v))) => Ok(Some(v)),
            Some(_) => Err(Flaw::new("floating point numbers", "integers").within(name)),
        }
    };
    let needed = |name: &str| {
        integers("Cells", name)?
            .ok_or_else(|| Flaw::new("no such array", "one in Cells").within(name))
    };
    let (components, points) =
        read("Points", None)?.ok_or_else(|| Flaw::new("no points", "a data array in Points"))?;
    let points = points.into_f64();
    if components != 3 || !points.len().is_multiple_of(3) {
        return Err(Flaw::new(
            format!("{} numbers, {components} a point", points.len()),
            "3 a point",
        )
        .within("Points"));
    }
    let (dimension, coordinates) = match read("PointData", Some("coordinates"))? {
        Some((dimension, numbers)) => {
            let numbers = numbers.into_f64();
            if dimension == 0 || dimension.checked_mul(points.len() / 3) != Some(numbers.len()) {
                return Err(Flaw::new(
                    format!("{} numbers", numbers.len()),
                    format!("{dimension} for each of {} points", points.len() / 3),
                )
                .within("coordinates"));
            }
            (dimension, numbers)
        }
        None => (3, points),
    };
    let mut parts = Parts {
        dimension,
        coordinates,
        point_index: integers("PointData", "point_index")?,
        ..Parts::default()
    };
    let (connectivity, offsets, types) = (
        needed("connectivity")?,
        needed("offsets")?,
        needed("types")?,
    );
    let (cells, labels) = (
        integers("CellData", "cells")?,
        integers("CellData", "piece")?,
    );
    for (name, found) in [
        ("types", Some(types.len())),
        ("cells", cells.as_ref().map(Vec::len)),
        ("piece", labels.as_ref().map(Vec::len)),
    ] {
        if let Some(found) = found.filter(|&n| n != offsets.len()) {
            return Err(Flaw::new(
                format!("{found} entries"),
                format!("{}, one a cell", offsets.len()),
            )
            .within(name));
        }
    }
    let mut curves: Vec<RawCurve> = Vec::new();
    let mut pieces = Vec::new();
    let mut from = 0;
    for (at, (&to, &kind)) in offsets.iter().zip(&types).enumerate() {
        let corners = usize::try_from(to)
            .ok()
            .and_then(|to| connectivity.get(from..to))
            .ok_or_else(|| {
                Flaw::row(
                    "offsets",
                    at,
                    None,
                    to.to_string(),
                    format!("a number from {from} to {}", connectivity.len()),
                )
            })?;
        from += corners.len();
        match (kind, corners) {
            (LINE, &[a, b]) => curves.push(([a, b], cells.as_ref().map(|c| c[at]))),
            (TRIANGLE, &[a, b, c]) => {
                parts.triangles.push([a, b, c]);
                pieces.extend(labels.as_ref().map(|l| l[at]));
            }
            _ => {
                return Err(Flaw::row(
                    "cells",
                    at,
                    None,
                    format!("a cell of type {kind} with {} corners", corners.len()),
                    "lines (type 3) of 2 and triangles (type 5) of 3",
                ));
            }
        }
    }
    // Without lines and without the array that we write, the file says nothing about curves.
    parts.curves = (cells.is_some() || !curves.is_empty()).then_some(curves);
    parts.pieces = labels.is_some().then_some(pieces);
    Ok(parts)
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
fn data_array(node: Node<'_, '_>, encoding: &Encoding) -> Parsed<(usize, Numbers)> {
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
        Some("UInt8") => "u1",
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
        Some("binary") if !encoding.compressed => binary(content, kind, encoding)?,
        Some("binary") => {
            return Err(Flaw::new(
                "compressed data",
                "data without compression: save it again without",
            ));
        }
        other => {
            return Err(Flaw::new(
                format!("format {}", excerpt(other.unwrap_or(""))),
                "ascii or binary: save it again with one of these data modes",
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

/// Base64 of the number of bytes, then the bytes.
fn binary(content: &str, kind: &str, encoding: &Encoding) -> Parsed<Numbers> {
    let packed: String = content.split_ascii_whitespace().collect();
    let bytes = base64::engine::general_purpose::STANDARD
        .decode(packed)
        .map_err(|e| Flaw::new(format!("bad base64 ({e})"), "binary data"))?;
    let width = if encoding.wide { 8 } else { 4 };
    let Some((size, data)) = bytes.split_at_checked(width) else {
        return Err(Flaw::new(
            format!("{} bytes", bytes.len()),
            format!("{width} bytes that say how many follow"),
        ));
    };
    let size = size.iter().enumerate().fold(0_u64, |size, (k, &byte)| {
        let place = if encoding.big { width - 1 - k } else { k };
        size | u64::from(byte) << (8 * place)
    });
    let one = u64::from(kind.as_bytes()[1] - b'0');
    if size != data.len() as u64 || !size.is_multiple_of(one) {
        return Err(Flaw::new(
            format!("{} bytes of data", data.len()),
            format!("{size}, as its header promises, a multiple of {one}"),
        ));
    }
    npy::decode(kind, encoding.big, data)
}

#[cfg(test)]
mod tests {
    use super::*;

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
