//! Object files of the Geomview kind, `.off`: vertices and triangles, no curves.
//!
//! Written in R^3; read with their variants, also in any dimension (`nOFF`), as text.

use super::error::{Flaw, Parsed, excerpt};
use super::mesh_parts::Parts;
use super::mesh_sheet::Sheet;
use super::npy::{Array, Numbers};
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
    for [a, b, c] in &sheet.triangles {
        let _ = writeln!(out, "3 {a} {b} {c}");
    }
    out.into_bytes()
}

/// What the first word announces: `[ST][C][N][4][n]OFF`.
struct Kind {
    /// A line with the dimension follows, and places have so many coordinates.
    any_dimension: bool,
    /// One coordinate more, by which the others are to be divided.
    projective: bool,
}

impl Kind {
    fn of(word: &str) -> Option<Self> {
        let rest = word.strip_suffix("OFF")?;
        let rest = rest.strip_prefix("ST").unwrap_or(rest);
        let rest = rest.strip_prefix('C').unwrap_or(rest);
        let rest = rest.strip_prefix('N').unwrap_or(rest);
        let (projective, rest) = match rest.strip_prefix('4') {
            Some(rest) => (true, rest),
            None => (false, rest),
        };
        let any_dimension = rest == "n";
        (any_dimension || rest.is_empty()).then_some(Self {
            any_dimension,
            projective,
        })
    }
}

/// Rows without comments, with their lines.
struct Rows<'a> {
    rows: std::iter::Enumerate<std::str::Lines<'a>>,
    /// Fields of the current row that were not taken yet.
    line: usize,
}

impl<'a> Rows<'a> {
    fn next(&mut self, expected: impl FnOnce() -> String) -> Parsed<(usize, &'a str)> {
        for (at, row) in self.rows.by_ref() {
            let row = row.split('#').next().unwrap_or("").trim();
            if !row.is_empty() {
                self.line = at + 1;
                return Ok((self.line, row));
            }
        }
        Err(Flaw::line(self.line, "the end of the file", expected()))
    }
}

/// What a file says before its places.
struct Head {
    kind: Kind,
    dimension: usize,
    vertices: usize,
    faces: usize,
}

impl Head {
    /// Reads the first word and the numbers behind it, in one line or several.
    fn read(rows: &mut Rows<'_>) -> Parsed<Self> {
        let (line, head) = rows
            .next(|| "OFF".into())
            .map_err(|_| Flaw::new("an empty file", "OFF"))?;
        let (word, same_line) = head.split_once(char::is_whitespace).unwrap_or((head, ""));
        if same_line.trim().starts_with("BINARY") {
            return Err(Flaw::line(
                line,
                "OFF BINARY",
                "OFF as text: save it again so",
            ));
        }
        // Some programs write the numbers right behind the word.
        let (word, same_line) = match word.find("OFF") {
            Some(at) if at + 3 < word.len() => (&word[..at + 3], &head[at + 3..]),
            _ => (word, same_line),
        };
        let kind = Kind::of(word).ok_or_else(|| Flaw::line(line, excerpt(head), "OFF"))?;
        let mut counts: Vec<(usize, &str)> =
            same_line.split_whitespace().map(|f| (line, f)).collect();
        let wanted = if kind.any_dimension { 3 } else { 2 };
        while counts.len() < wanted {
            let (line, row) = rows.next(|| "the numbers of vertices and faces".into())?;
            counts.extend(row.split_whitespace().map(|f| (line, f)));
        }
        let count = |k: usize| {
            let (line, field) = counts[k];
            field.parse::<usize>().map_err(|_| {
                Flaw::line(
                    line,
                    excerpt(field),
                    "a number of vertices, faces or dimensions",
                )
            })
        };
        let (dimension, first) = match kind.any_dimension {
            true => (count(0)?, 1),
            false => (3, 0),
        };
        let (vertices, faces) = (count(first)?, count(first + 1)?);
        if dimension == 0 {
            return Err(Flaw::line(line, "dimension 0", "at least one coordinate"));
        }
        Ok(Self {
            kind,
            dimension,
            vertices,
            faces,
        })
    }
}

/// Reads vertices in any dimension: their number of coordinates, and these.
pub(crate) fn parse_points(bytes: &[u8]) -> Parsed<Array> {
    let parts = read(bytes, false)?;
    let rows = parts.coordinates.len() / parts.dimension;
    Ok(Array::new(
        vec![rows, parts.dimension],
        Numbers::F64(parts.coordinates),
    ))
}

/// Reads the file; normals and colors behind a place and colors behind a face are skipped.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    read(bytes, true)
}

fn read(bytes: &[u8], with_faces: bool) -> Parsed<Parts> {
    let mut rows = Rows {
        rows: text(bytes)?.lines().enumerate(),
        line: 0,
    };
    let Head {
        kind,
        dimension,
        vertices,
        faces,
    } = Head::read(&mut rows)?;
    let mut parts = Parts {
        dimension,
        ..Parts::default()
    };
    for at in 0..vertices {
        let (line, row) = rows.next(|| promised(at, "vertices", vertices))?;
        place(
            &mut parts.coordinates,
            dimension,
            kind.projective,
            line,
            row,
        )?;
    }
    let faces = if with_faces { faces } else { 0 };
    for at in 0..faces {
        let (line, row) = rows.next(|| promised(at, "faces", faces))?;
        parts.triangles.push(face(line, row)?);
    }
    Ok(parts)
}

fn promised(at: usize, what: &str, of: usize) -> String {
    format!("{of} {what}, as the header promises, behind {at} of them")
}

fn place(
    coordinates: &mut Vec<f64>,
    dimension: usize,
    projective: bool,
    line: usize,
    row: &str,
) -> Parsed<()> {
    let total = dimension.saturating_add(usize::from(projective));
    let start = coordinates.len();
    for (k, field) in row.split_whitespace().take(total).enumerate() {
        coordinates.push(number(field, line, k + 1)?);
    }
    let found = coordinates.len() - start;
    if found < total {
        return Err(Flaw::line(
            line,
            format!("{found} numbers"),
            match total {
                3 => "x, y, z".into(),
                _ => format!("{total} coordinates"),
            },
        ));
    }
    if projective {
        let last = coordinates.pop().unwrap_or(1.0);
        for x in &mut coordinates[start..] {
            *x /= last;
            if !x.is_finite() {
                return Err(Flaw::line(line, "a point at infinity", "a finite point"));
            }
        }
    }
    Ok(())
}

fn face(line: usize, row: &str) -> Parsed<[i64; 3]> {
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
        *corner = field
            .parse()
            .map_err(|_| Flaw::field(line, k + 2, excerpt(field), "a vertex, counted from 0"))?;
    }
    Ok(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_head() {
        for (text, dimension, places) in [
            (
                "OFF\n2 0 0\n1 2 3\n4 5 6\n",
                3,
                vec![1., 2., 3., 4., 5., 6.],
            ),
            ("OFF 1 0 0\n1 2 3\n", 3, vec![1., 2., 3.]),
            ("OFF1 0 0\n1 2 3\n", 3, vec![1., 2., 3.]),
            ("COFF\n# c\n1 0\n1 2 3 255 0 0 255\n", 3, vec![1., 2., 3.]),
            ("STCN4OFF\n1 0 0\n2 4 6 2\n", 3, vec![1., 2., 3.]),
            ("nOFF\n5\n1 0 0\n1 2 3 4 5\n", 5, vec![1., 2., 3., 4., 5.]),
            ("nOFF 2\n1 0 0\n1 2\n", 2, vec![1., 2.]),
        ] {
            let parts = parse(text.as_bytes()).unwrap_or_else(|f| panic!("{text}: {f:?}"));
            assert_eq!(
                (parts.dimension, parts.coordinates),
                (dimension, places),
                "{text}"
            );
        }
        for (text, found) in [
            ("OFF BINARY\n", "OFF BINARY"),
            ("XOFF\n1 0 0\n", "\"XOFF\""),
            ("4nOFF\n2\n1 0 0\n1 2\n", "2 numbers"),
            ("4OFF\n1 0 0\n1 2 3 0\n", "a point at infinity"),
            ("nOFF\n18446744073709551615\n1 0 0\n1 2\n", "2 numbers"),
            ("nOFF\n0\n1 0 0\n\n", "dimension 0"),
        ] {
            assert_eq!(parse(text.as_bytes()).unwrap_err().found, found, "{text}");
        }
        let quad = b"OFF\n1 1 0\n1 2 3\n4 0 0 0 0\n";
        assert!(parse(quad).is_err() && parse_points(quad).is_ok());
    }
}
