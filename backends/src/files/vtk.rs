//! VTK's older files, `.vtk`, text and binary: the points alone. Read only.

use super::error::{Flaw, Parsed, excerpt};
use super::npy::{self, Array, Numbers};
use super::table::{number, text};

/// Reads the points of any data set that lists them.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Array> {
    if !bytes.starts_with(b"# vtk DataFile") {
        return Err(Flaw::new(
            "something else",
            "a file that starts with # vtk DataFile",
        ));
    }
    let mut lines = Lines {
        rest: bytes,
        taken: 0,
    };
    let big = lines.is_binary()?;
    let head = lines.points()?;
    let words: Vec<&str> = head.split_whitespace().collect();
    let count = match words[..] {
        ["POINTS", n, _] => n.parse::<usize>().ok().and_then(|n| n.checked_mul(3)),
        _ => None,
    };
    let Some(count) = count else {
        return Err(Flaw::line(
            lines.taken,
            excerpt(head),
            "POINTS, their number, a type",
        ));
    };
    let kind = stored(words[2])
        .ok_or_else(|| Flaw::line(lines.taken, excerpt(words[2]), "a type of number"))?;
    let Lines { rest, taken } = lines;
    let numbers = if big {
        let width = usize::from(kind.as_bytes()[1] - b'0');
        let data = count.checked_mul(width).and_then(|size| rest.get(..size));
        let data = data.ok_or_else(|| {
            Flaw::new(
                format!("{} bytes of data", rest.len()),
                format!("{} points, as the header promises", count / 3),
            )
            .within("POINTS")
        })?;
        npy::decode(kind, true, data)?
    } else {
        ascii(rest, count, taken, kind == "f4")?
    };
    Ok(Array::new(vec![count / 3, 3], numbers))
}

/// The lines before the data.
struct Lines<'b> {
    rest: &'b [u8],
    taken: usize,
}

impl<'b> Lines<'b> {
    fn next(&mut self) -> Option<&'b [u8]> {
        let Self { rest, .. } = *self;
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.rest = &rest[(end + 1).min(rest.len())..];
        self.taken += 1;
        Some(rest[..end].trim_ascii())
    }

    /// Whether the data is binary, which the third line says.
    fn is_binary(&mut self) -> Parsed<bool> {
        let (_, _) = (self.next(), self.next());
        match self.next() {
            Some(b"ASCII") => Ok(false),
            Some(b"BINARY") => Ok(true),
            other => {
                let found = String::from_utf8_lossy(other.unwrap_or_default()).into_owned();
                Err(Flaw::line(3, excerpt(&found), "ASCII or BINARY"))
            }
        }
    }

    /// The line that begins the points.
    fn points(&mut self) -> Parsed<&'b str> {
        let mut set = String::new();
        while let Some(row) = self.next() {
            if let Some(kind) = row.strip_prefix(b"DATASET") {
                set = String::from_utf8_lossy(kind).trim().into();
            }
            if row.starts_with(b"POINTS") {
                return text(row);
            }
        }
        Err(Flaw::new(
            format!("no POINTS in a data set of type {}", excerpt(&set)),
            "a data set that lists its points",
        ))
    }
}

/// A type of number as NumPy calls it.
fn stored(name: &str) -> Option<&'static str> {
    Some(match name {
        "float" => "f4",
        "double" => "f8",
        "char" => "i1",
        "unsigned_char" => "u1",
        "short" => "i2",
        "unsigned_short" => "u2",
        "int" => "i4",
        "unsigned_int" => "u4",
        "long" | "vtktypeint64" => "i8",
        "unsigned_long" => "u8",
        _ => return None,
    })
}

fn ascii(rest: &[u8], count: usize, before: usize, single: bool) -> Parsed<Numbers> {
    let mut numbers = Vec::new();
    'all: for (at, row) in rest.split(|&b| b == b'\n').enumerate() {
        if numbers.len() == count {
            break;
        }
        let line = before + at + 1;
        for (k, field) in text(row)?.split_whitespace().enumerate() {
            if numbers.len() == count {
                break 'all;
            }
            numbers.push(number(field, line, k + 1)?);
        }
    }
    if numbers.len() < count {
        return Err(Flaw::new(
            format!("{} numbers", numbers.len()),
            format!("{count}, as the header promises"),
        )
        .within("POINTS"));
    }
    Ok(if single {
        // As the type says; the text was written from single precision.
        Numbers::F32(numbers.iter().map(|&x| x as f32).collect())
    } else {
        Numbers::F64(numbers)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_binary_are_the_same_points() {
        let head = |mode: &str| {
            format!(
                "# vtk DataFile Version 3.0\nany title\n{mode}\nDATASET POLYDATA\nPOINTS 2 float\n"
            )
        };
        let places = [1.0_f32, 2.0, 3.0, 4.0, -5.0, 0.1];
        let mut text = head("ASCII").into_bytes();
        text.extend(b"1 2 3 4\n-5 0.1\nPOLYGONS 0 0\n");
        let mut binary = head("BINARY").into_bytes();
        binary.extend(places.iter().flat_map(|x| x.to_be_bytes()));
        binary.extend(b"\nMETADATA\n");
        for bytes in [&text, &binary] {
            let array = parse(bytes).unwrap();
            assert_eq!(
                (array.shape, array.numbers),
                (vec![2, 3], Numbers::F32(places.to_vec()))
            );
        }
        let short = parse(&binary[..binary.len() - 20]).unwrap_err();
        assert!(short.expected.contains("2 points"), "{short:?}");
        for (from, to, found) in [
            ("0.1\nPOLYGONS 0 0", "", "5 numbers"),
            ("ASCII", "TEXT", "TEXT"),
            ("POINTS 2 float", "POINTS x float", "POINTS x float"),
            ("POINTS 2 float", "DIMENSIONS 2 2 2", "no POINTS"),
            ("float", "string", "string"),
            ("-5", "five", "five"),
            ("# vtk", "vtk", "something else"),
        ] {
            let bad = String::from_utf8(text.clone()).unwrap().replace(from, to);
            let flaw = parse(bad.as_bytes()).unwrap_err();
            assert!(flaw.found.contains(found), "{flaw:?}");
        }
    }
}
