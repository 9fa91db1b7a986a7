//! Polygon files, `.ply`, ASCII and binary.
//!
//! Read by `ply-rs-bw`, after the element counts of the header have been compared with the bytes
//! that are there. Written as little-endian binary in double precision, hence lossless.

use super::any_cloud::{AnyCloud, cloud};
use super::error::{Flaw, Parsed, Place, excerpt};
use super::mesh::{Parts, Sheet};
use super::npy::Numbers;
use crosscap_core::{CurveEdge, PointCloud};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

/// The scalar properties that mean something here; others are skipped.
const NAMES: [&str; 8] = [
    "x",
    "y",
    "z",
    "vertex1",
    "vertex2",
    "cells",
    "point_index",
    "piece",
];
const X: usize = 0;
const VERTEX_1: usize = 3;
const CELLS: usize = 5;
const POINT_INDEX: usize = 6;
const PIECE: usize = 7;

/// One element of any kind.
#[derive(Debug, Default)]
struct Row {
    values: [f64; NAMES.len()],
    corners: Vec<i64>,
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        fn integers<T: Into<i64>>(v: Vec<T>) -> Vec<i64> {
            v.into_iter().map(Into::into).collect()
        }
        let value = match property {
            Property::Char(x) => x.into(),
            Property::UChar(x) => x.into(),
            Property::Short(x) => x.into(),
            Property::UShort(x) => x.into(),
            Property::Int(x) => x.into(),
            Property::UInt(x) => x.into(),
            Property::Float(x) => x.into(),
            Property::Double(x) => x,
            list if is_corners(name) => {
                self.corners = match list {
                    Property::ListChar(v) => integers(v),
                    Property::ListUChar(v) => integers(v),
                    Property::ListShort(v) => integers(v),
                    Property::ListUShort(v) => integers(v),
                    Property::ListInt(v) => integers(v),
                    Property::ListUInt(v) => integers(v),
                    _ => return PropertyAccessResult::UnsupportedType,
                };
                return PropertyAccessResult::Set;
            }
            _ => return PropertyAccessResult::Ignored,
        };
        match NAMES.iter().position(|n| *n == name) {
            Some(at) => {
                self.values[at] = value;
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::Ignored,
        }
    }
}

fn is_corners(name: &str) -> bool {
    name == "vertex_indices" || name == "vertex_index"
}

fn flaw(e: &ParseError) -> Flaw {
    let message = e.to_string();
    // The line at fault says more than the names of the parser's rules.
    let row = message.split("String: '").nth(1).map(|row| {
        let end = row.find(['\'', '\n']).unwrap_or(row.len());
        excerpt(row[..end].trim())
    });
    let flaw = match row {
        Some(row) => Flaw::new(
            row,
            "the finite numbers or the words that the format has here",
        ),
        None => Flaw::new(
            message.replace(['\n', '\t'], " "),
            "a complete polygon file whose header says what follows",
        ),
    };
    match e.line() {
        Some(line) => flaw.at(Place::Line { line, field: None }),
        None => flaw,
    }
}

type Source<'a> = Reader<&'a [u8]>;

fn open<'a>(bytes: &'a [u8]) -> Parsed<(Source<'a>, Header)> {
    if bytes.is_empty() {
        return Err(Flaw::new("an empty file", "a polygon file"));
    }
    let mut source = Reader::new(bytes);
    let header = Parser::<Row>::new()
        .read_header(&mut source)
        .map_err(|e| flaw(&e))?;
    let there = source.get_ref().len();
    let mut needed = 0_usize;
    for element in header.elements.values() {
        let least = least_bytes(element, header.encoding);
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
    Ok((source, header))
}

/// The fewest bytes that one element of this kind takes.
fn least_bytes(element: &ElementDef, encoding: Encoding) -> usize {
    let size = |scalar: ScalarType| match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    element
        .properties
        .values()
        .map(|property| match (encoding, &property.data_type) {
            // A digit, and a space or the end of the line.
            (Encoding::Ascii, _) => 2,
            (_, PropertyType::Scalar(scalar)) => size(scalar.clone()),
            (_, PropertyType::List(count, _)) => size(count.clone()),
        })
        .sum()
}

fn rows(source: &mut Source<'_>, header: &Header, element: &ElementDef) -> Parsed<Vec<Row>> {
    Parser::new()
        .read_payload_for_element(source, element, header)
        .map_err(|e| flaw(&e).within(&element.name))
}

fn has(element: &ElementDef, property: &str) -> bool {
    element.properties.contains_key(property)
}

/// The places of the vertices, and whether all three coordinates are stored as `float`.
fn places(element: &ElementDef, vertices: &[Row]) -> Parsed<(Vec<f64>, bool)> {
    let mut single = true;
    for name in &NAMES[X..X + 3] {
        match element.properties.get(*name).map(|p| &p.data_type) {
            Some(PropertyType::Scalar(scalar)) => single &= *scalar == ScalarType::Float,
            _ => {
                return Err(
                    Flaw::new(format!("no number {name}"), "the properties x, y, z")
                        .within("vertex"),
                );
            }
        }
    }
    let places = vertices
        .iter()
        .flat_map(|v| v.values[X..X + 3].iter().copied())
        .collect();
    Ok((places, single))
}

/// The vertices as points.
pub(crate) fn parse_points(bytes: &[u8]) -> Parsed<AnyCloud> {
    let (mut source, header) = open(bytes)?;
    for element in header.elements.values() {
        let all = rows(&mut source, &header, element)?;
        if element.name == "vertex" {
            let (coordinates, single) = places(element, &all)?;
            let numbers = if single {
                // Exact: every one of them was widened from single precision.
                Numbers::F32(coordinates.iter().map(|&x| x as f32).collect())
            } else {
                Numbers::F64(coordinates)
            };
            return cloud(all.len(), 3, numbers).map_err(|f| f.within("vertex"));
        }
    }
    Err(Flaw::new("no element vertex", "one"))
}

/// Vertices, triangles, and curve edges where there are any.
pub(crate) fn parse_mesh(bytes: &[u8]) -> Parsed<Parts> {
    let (mut source, header) = open(bytes)?;
    let mut parts = Parts::default();
    let mut seen = false;
    for element in header.elements.values() {
        let all = rows(&mut source, &header, element)?;
        match element.name.as_str() {
            "vertex" => {
                seen = true;
                let (coordinates, _) = places(element, &all)?;
                parts.dimension = 3;
                parts.coordinates = coordinates;
                if has(element, NAMES[POINT_INDEX]) {
                    parts.point_index =
                        Some(all.iter().map(|v| v.values[POINT_INDEX] as i64).collect());
                }
            }
            "face" => {
                for (at, face) in all.iter().enumerate() {
                    let &[a, b, c] = &face.corners[..] else {
                        return Err(Flaw::row(
                            "face",
                            at,
                            None,
                            format!("{} corners", face.corners.len()),
                            "3: split polygons into triangles",
                        ));
                    };
                    parts.triangles.push([a, b, c]);
                }
                if has(element, NAMES[PIECE]) {
                    parts.pieces = Some(all.iter().map(|f| f.values[PIECE] as i64).collect());
                }
            }
            "edge" => {
                let counted = has(element, NAMES[CELLS]);
                parts.curves = Some(
                    all.iter()
                        .map(|e| {
                            (
                                [e.values[VERTEX_1] as i64, e.values[VERTEX_1 + 1] as i64],
                                counted.then_some(e.values[CELLS] as i64),
                            )
                        })
                        .collect(),
                );
            }
            _ => {}
        }
    }
    if !seen {
        return Err(Flaw::new("no element vertex", "one"));
    }
    Ok(parts)
}

/// Points of R^3.
pub(crate) fn point_bytes(cloud: &PointCloud<f64>) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nend_header\n",
        cloud.len()
    )
    .into_bytes();
    bytes.extend(cloud.coordinates().iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// A mesh with places in R^3.
pub(crate) fn mesh_bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mesh = sheet.mesh;
    let complex = &mesh.complex;
    // The format has no integer of 64 bits; rows beyond 32 are kept as doubles, exactly.
    let narrow = |all: &[i64]| all.iter().all(|&i| i32::try_from(i).is_ok());
    let name = |narrow| if narrow { "int" } else { "double" };
    let put = |bytes: &mut Vec<u8>, narrow: bool, i: i64| {
        if narrow {
            bytes.extend((i as i32).to_le_bytes());
        } else {
            bytes.extend((i as f64).to_le_bytes());
        }
    };
    let narrow_rows = narrow(&mesh.point_index);
    let narrow_pieces = sheet.pieces.is_some_and(narrow);
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nproperty {} point_index\n\
         element face {}\nproperty list uchar uint vertex_indices\n",
        complex.vertices,
        name(narrow_rows),
        complex.triangles.len(),
    );
    if sheet.pieces.is_some() {
        header += &format!("property {} piece\n", name(narrow_pieces));
    }
    header += &format!(
        "element edge {}\nproperty uint vertex1\nproperty uint vertex2\nproperty uchar cells\n\
         end_header\n",
        complex.curve_edges.len()
    );
    let mut bytes = header.into_bytes();
    for (place, &row) in sheet.places.iter().zip(&mesh.point_index) {
        bytes.extend(place.iter().flat_map(|x| x.to_le_bytes()));
        put(&mut bytes, narrow_rows, row);
    }
    for (at, triangle) in complex.triangles.iter().enumerate() {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|v| v.to_le_bytes()));
        if let Some(pieces) = sheet.pieces {
            put(&mut bytes, narrow_pieces, pieces[at]);
        }
    }
    for CurveEdge { ends, cells } in &complex.curve_edges {
        bytes.extend(ends.iter().flat_map(|v| v.to_le_bytes()));
        bytes.push(*cells);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_with_other_properties_keeps_single_precision() {
        let text = "ply\nformat ascii 1.0\ncomment c\nelement vertex 2\nproperty float x\n\
                    property float y\nproperty uchar red\nproperty float z\n\
                    element face 0\nproperty list uchar int vertex_indices\nend_header\n\
                    0.1 2e+0 255 3\n4 5 0 -6E-05\n";
        let AnyCloud::F32(cloud) = parse_points(text.as_bytes()).unwrap() else {
            panic!("single precision");
        };
        assert_eq!(cloud.coordinates(), &[0.1, 2.0, 3.0, 4.0, 5.0, -6e-5]);
    }

    #[test]
    fn a_header_that_lies_is_refused() {
        for element in [
            "element vertex 1000000000000\nproperty float x\n",
            "element vertex 1000000000000\n",
            "element vertex 18446744073709551615\nproperty double x\nproperty double y\n",
        ] {
            for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
                let text = format!("ply\nformat {encoding} 1.0\n{element}end_header\n1\n");
                let flaw = parse_points(text.as_bytes()).unwrap_err();
                assert_eq!(flaw.place, Place::Part("vertex".into()), "{flaw:?}");
            }
        }
    }

    #[test]
    fn polygons_are_refused() {
        let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
                    property float z\nelement face 1\nproperty list uchar int vertex_index\n\
                    end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
        let flaw = parse_mesh(text.as_bytes()).unwrap_err();
        assert_eq!(flaw.found, "4 corners");
    }
}
