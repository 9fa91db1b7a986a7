//! Object files of the Geomview kind, `.off`: vertices and triangles, no curves.

use super::error::{Flaw, Parsed, excerpt};
use super::mesh::{Parts, Sheet};
use super::table::{number, text};
use std::fmt::Write;

/// The bytes of the file.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let complex = &sheet.mesh.complex;
    let mut out = format!("OFF\n{} {} 0\n", complex.vertices, complex.triangles.len());
    // Formatting into a string cannot fail.
    for [x, y, z] in &sheet.places {
        let _ = writeln!(out, "{x:?} {y:?} {z:?}");
    }
    for [a, b, c] in &complex.triangles {
        let _ = writeln!(out, "3 {a} {b} {c}");
    }
    out.into_bytes()
}

/// Reads the file; colors behind a face are skipped.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    let mut rows = text(bytes)?
        .lines()
        .enumerate()
        .map(|(at, row)| (at + 1, row.split('#').next().unwrap_or("").trim()))
        .filter(|(_, row)| !row.is_empty());
    let Some((line, head)) = rows.next() else {
        return Err(Flaw::new("an empty file", "OFF"));
    };
    let Some(same_line) = head.strip_prefix("OFF") else {
        return Err(Flaw::line(line, excerpt(head), "OFF"));
    };
    let (line, counts) = if same_line.trim().is_empty() {
        rows.next().ok_or_else(|| {
            Flaw::line(
                line,
                "the end of the file",
                "the numbers of vertices and faces",
            )
        })?
    } else {
        (line, same_line)
    };
    let counts: Vec<usize> = counts
        .split_whitespace()
        .map_while(|f| f.parse().ok())
        .collect();
    let &[vertices, faces, ..] = &counts[..] else {
        return Err(Flaw::line(
            line,
            format!("{} counts", counts.len()),
            "the numbers of vertices and faces",
        ));
    };
    let mut parts = Parts {
        dimension: 3,
        ..Parts::default()
    };
    let mut last = line;
    let mut next = |what: &str, at: usize, of: usize| {
        let row = rows.next().ok_or_else(|| {
            Flaw::line(
                last,
                format!("the end of the file after {at} {what}"),
                format!("{of}, as the header promises"),
            )
        })?;
        last = row.0;
        Ok(row)
    };
    for at in 0..vertices {
        let (line, row) = next("vertices", at, vertices)?;
        let mut found = 0;
        for (k, field) in row.split_whitespace().take(3).enumerate() {
            parts.coordinates.push(number(field, line, k + 1)?);
            found += 1;
        }
        if found < 3 {
            return Err(Flaw::line(line, format!("{found} numbers"), "x, y, z"));
        }
    }
    for at in 0..faces {
        let (line, row) = next("faces", at, faces)?;
        let mut fields = row.split_whitespace();
        match fields.next() {
            Some("3") => {}
            other => {
                return Err(Flaw::line(
                    line,
                    format!("{} corners", other.map_or("no".into(), excerpt)),
                    "3: split polygons into triangles",
                ));
            }
        }
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            let field = fields.next().unwrap_or("");
            *corner = field.parse().map_err(|_| {
                Flaw::field(line, k + 2, excerpt(field), "a vertex, counted from 0")
            })?;
        }
        parts.triangles.push(corners);
    }
    Ok(parts)
}
