//! Wavefront files, `.obj`: vertices, triangles, and curves as lines.
//!
//! Lines are grouped by the number of cells that meet in them (`g cells_4`). A file without a
//! single line says nothing about curves; they are then deduced from the triangles.

use super::error::{Flaw, Parsed, excerpt};
use super::mesh_parts::Parts;
use super::mesh_sheet::Sheet;
use super::npy::{Array, Numbers};
use super::table::{number, text};
use std::fmt::Write;

/// The bytes of the file.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let complex = &sheet.mesh.complex;
    let mut out = String::new();
    // Formatting into a string cannot fail.
    for [x, y, z] in &sheet.places {
        let _ = writeln!(out, "v {x:?} {y:?} {z:?}");
    }
    let one = |v: u32| u64::from(v) + 1;
    if !complex.triangles.is_empty() {
        out.push_str("g surface\n");
    }
    for &[a, b, c] in &sheet.triangles {
        let _ = writeln!(out, "f {} {} {}", one(a), one(b), one(c));
    }
    let mut curves = complex.curve_edges.clone();
    curves.sort_unstable_by_key(|e| (e.cells, e.ends));
    for group in curves.chunk_by(|a, b| a.cells == b.cells) {
        let _ = writeln!(out, "g cells_{}", group[0].cells);
        for edge in group {
            let _ = writeln!(out, "l {} {}", one(edge.ends[0]), one(edge.ends[1]));
        }
    }
    out.into_bytes()
}

/// Reads the vertices alone.
pub(crate) fn parse_points(bytes: &[u8]) -> Parsed<Array> {
    let coordinates = read(bytes, false)?.coordinates;
    Ok(Array::new(
        vec![coordinates.len() / 3, 3],
        Numbers::F64(coordinates),
    ))
}

/// Reads the file: `v`, `f` of three corners, `l`, `g`; everything else is skipped.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    read(bytes, true)
}

fn read(bytes: &[u8], with_faces: bool) -> Parsed<Parts> {
    let mut parts = Parts {
        dimension: 3,
        ..Parts::default()
    };
    let mut cells = None;
    for (at, row) in text(bytes)?.lines().enumerate() {
        let line = at + 1;
        let mut fields = row.split('#').next().unwrap_or("").split_whitespace();
        match fields.next() {
            Some("v") => {
                let mut found = 0;
                for (k, field) in fields.by_ref().take(3).enumerate() {
                    parts.coordinates.push(number(field, line, k + 2)?);
                    found += 1;
                }
                if found < 3 {
                    return Err(Flaw::line(line, format!("{found} numbers"), "x, y, z"));
                }
            }
            Some("f") if with_faces => {
                let corners = corners(line, fields, parts.coordinates.len() / 3)?;
                let &[a, b, c] = &corners[..] else {
                    return Err(Flaw::line(
                        line,
                        format!("{} corners", corners.len()),
                        "3: split polygons into triangles",
                    ));
                };
                parts.triangles.push([a, b, c]);
            }
            Some("l") if with_faces => {
                let ends = corners(line, fields, parts.coordinates.len() / 3)?;
                if ends.len() < 2 {
                    return Err(Flaw::line(
                        line,
                        format!("{} ends", ends.len()),
                        "2 or more",
                    ));
                }
                let curves = parts.curves.get_or_insert_default();
                curves.extend(ends.windows(2).map(|w| ([w[0], w[1]], cells)));
            }
            Some("g") => {
                cells = fields
                    .next()
                    .and_then(|name| name.strip_prefix("cells_")?.parse().ok());
            }
            _ => {}
        }
    }
    if parts.coordinates.is_empty() && parts.triangles.is_empty() {
        return Err(Flaw::new("no vertex", "lines v x y z"));
    }
    Ok(parts)
}

/// Vertices of a face or a line, counted from 0; negative ones count from the last vertex.
fn corners<'a>(
    line: usize,
    fields: impl Iterator<Item = &'a str>,
    vertices: usize,
) -> Parsed<Vec<i64>> {
    fields
        .enumerate()
        .map(|(k, field)| {
            let index = field.split('/').next().unwrap_or("");
            match index.parse::<i64>() {
                Ok(i) if i > 0 => Ok(i - 1),
                Ok(i) if i < 0 && i.unsigned_abs() <= vertices as u64 => Ok(vertices as i64 + i),
                _ => Err(Flaw::field(
                    line,
                    k + 2,
                    excerpt(field),
                    "a vertex, counted from 1 (or from -1 backwards)",
                )),
            }
        })
        .collect()
}
