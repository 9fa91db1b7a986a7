//! Triangles for printers, `.stl`: no vertices in common, no curves, single precision.
//!
//! Written binary. Read binary and as text; corners at the same place, to the bit, become one
//! vertex.

use super::error::{Flaw, Parsed, excerpt};
use super::mesh_parts::Parts;
use super::mesh_sheet::Sheet;
use super::table::{number, text};
use std::collections::BTreeMap;

/// Bytes before the number of triangles.
const HEADER: usize = 80;
/// Bytes of a triangle: a normal and three corners in single precision, and two bytes of nothing.
const TRIANGLE: usize = 50;

/// The bytes of the file.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + 4 + TRIANGLE * sheet.triangles.len());
    // The word solid at the start would announce a text.
    bytes.extend(b"binary, written by Crosscap");
    bytes.resize(HEADER, b' ');
    bytes.extend((sheet.triangles.len() as u32).to_le_bytes());
    for triangle in &sheet.triangles {
        let [a, b, c] = triangle.map(|v| sheet.places[v as usize]);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let unit = normal.map(|x| if length > 0.0 { x / length } else { 0.0 });
        for x in [unit, a, b, c].as_flattened() {
            bytes.extend((*x as f32).to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// Reads the file.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    if bytes.is_empty() {
        return Err(Flaw::new("an empty file", "triangles"));
    }
    let promised = bytes
        .get(HEADER..HEADER + 4)
        .and_then(|b| b.first_chunk())
        .map(|&b| u32::from_le_bytes(b) as usize);
    let size = promised.and_then(|n| n.checked_mul(TRIANGLE)?.checked_add(HEADER + 4));
    let corners = if size == Some(bytes.len()) {
        binary(&bytes[HEADER + 4..])?
    } else if bytes.trim_ascii_start().starts_with(b"solid") {
        ascii(bytes)?
    } else {
        return Err(Flaw::new(
            format!("{} bytes", bytes.len()),
            match size {
                Some(size) => {
                    format!("{size}, as its header promises, or a text that starts with solid")
                }
                None => "a header of 84 bytes, or a text that starts with solid".into(),
            },
        ));
    };
    Ok(merged(&corners))
}

fn binary(data: &[u8]) -> Parsed<Vec<[f64; 3]>> {
    let mut corners = Vec::with_capacity(data.len() / TRIANGLE * 3);
    for (at, triangle) in data.chunks_exact(TRIANGLE).enumerate() {
        let numbers: Vec<f64> = triangle[12..48]
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&b| f32::from_le_bytes(b).into())
            .collect();
        if let Some(bad) = numbers.iter().find(|x| !x.is_finite()) {
            let found = bad.to_string();
            return Err(Flaw::row("triangles", at, None, found, "finite numbers"));
        }
        corners.extend(numbers.as_chunks::<3>().0);
    }
    Ok(corners)
}

fn ascii(bytes: &[u8]) -> Parsed<Vec<[f64; 3]>> {
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut loops = 0;
    for (at, row) in text(bytes)?.lines().enumerate() {
        let line = at + 1;
        let mut fields = row.split_whitespace();
        match fields.next() {
            Some("vertex") => {
                let fields: Vec<&str> = fields.collect();
                let &[x, y, z] = &fields[..] else {
                    let found = format!("{} numbers", fields.len());
                    return Err(Flaw::line(line, found, "x, y, z"));
                };
                corners.push([
                    number(x, line, 2)?,
                    number(y, line, 3)?,
                    number(z, line, 4)?,
                ]);
            }
            Some("endloop") => {
                loops += 1;
                if corners.len() != 3 * loops {
                    let found = format!("{} corners so far", corners.len());
                    return Err(Flaw::line(line, found, format!("{}", 3 * loops)));
                }
            }
            Some("solid" | "facet" | "outer" | "endfacet" | "endsolid" | "normal" | "color")
            | None => {}
            Some(word) => return Err(Flaw::line(line, excerpt(word), "facet, vertex or endsolid")),
        }
    }
    if corners.len() != 3 * loops {
        let found = format!("{} corners", corners.len());
        return Err(Flaw::new(found, format!("{}, three a facet", 3 * loops)));
    }
    Ok(corners)
}

/// Corners at one place become one vertex, numbered by their first appearance; triangles that
/// lose their area by it are left out, and one that is there twice is there once.
fn merged(corners: &[[f64; 3]]) -> Parts {
    let mut numbers: BTreeMap<[u64; 3], i64> = BTreeMap::new();
    let mut coordinates: Vec<f64> = Vec::new();
    let vertices: Vec<i64> = corners
        .iter()
        .map(|place| {
            let next = numbers.len() as i64;
            // Minus zero is at the place of zero.
            *numbers
                .entry(place.map(|x| (x + 0.0).to_bits()))
                .or_insert_with(|| {
                    coordinates.extend(place);
                    next
                })
        })
        .collect();
    let whole = |t: &&[i64; 3]| t[0] != t[1] && t[1] != t[2] && t[0] != t[2];
    let mut triangles: Vec<[i64; 3]> = vertices
        .as_chunks::<3>()
        .0
        .iter()
        .filter(whole)
        .copied()
        .collect();
    triangles.iter_mut().for_each(|t| t.sort_unstable());
    triangles.sort_unstable();
    triangles.dedup();
    Parts {
        dimension: 3,
        coordinates,
        triangles,
        ..Parts::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_at_one_place_become_one_vertex() {
        let text = "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n\
                    endloop\n endfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 -0.0 0\nvertex 1 1 0\nvertex 0 1e0 0\n\
                    endloop\nendfacet\nendsolid a b\n";
        let parts = parse(text.as_bytes()).unwrap();
        assert_eq!(
            parts.coordinates,
            [0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]
        );
        assert_eq!(parts.triangles, [[0, 1, 2], [1, 2, 3]]);
    }

    #[test]
    fn what_is_no_such_file_is_refused() {
        for (bytes, found) in [
            (&b""[..], "an empty file"),
            (b"solid\nfacet\nvertex 1 2\n", "2 numbers"),
            (b"solid\nvertex 1 2 3\nendloop\n", "1 corners so far"),
            (b"solid\nvertex 1 2 3\n", "1 corners"),
            (b"solid\n<html>\n", "\"<html>\""),
            (b"PK", "2 bytes"),
            (&[0; 100], "100 bytes"),
        ] {
            assert_eq!(parse(bytes).unwrap_err().found, found);
        }
        let mut lie = vec![0; 84 + 50];
        lie[80] = 1;
        assert!(parse(&lie).is_ok());
        lie[84 + 12..84 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(parse(&lie).unwrap_err().found, "NaN");
        lie[83] = 255;
        assert!(parse(&lie).unwrap_err().found.contains("134 bytes"));
    }
}
