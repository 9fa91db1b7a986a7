//! Point clouds of the Point Cloud Library, `.pcd`: text, binary, and binary packed by LZF. Read
//! only.

use super::columns::{ColumnChoice, pick};
use super::error::{Flaw, Parsed, excerpt};
use super::npy::{self, Array, Numbers};
use super::table::{number, text};

/// Longest header that is believed.
const LONGEST_HEADER: usize = 1 << 14;

/// Most numbers of one field that are believed.
const MOST_OF_A_FIELD: usize = 4096;

/// LZF takes at least three bytes for this many.
const LARGEST_RUN: usize = 264;

/// A field of a point.
struct Field {
    name: String,
    /// Type as NumPy calls it.
    kind: String,
    width: usize,
    count: usize,
}

struct Header {
    fields: Vec<Field>,
    points: usize,
    data: String,
    /// Lines of the header.
    lines: usize,
}

/// Reads the points: x, y, z, or the fields that are wanted.
pub(crate) fn parse(bytes: &[u8], wanted: &ColumnChoice) -> Parsed<Array> {
    let (header, data) = header(bytes)?;
    let mut names = Vec::new();
    for field in &header.fields {
        for k in 0..field.count {
            names.push(match field.count {
                1 => field.name.clone(),
                _ => format!("{}[{k}]", field.name),
            });
        }
    }
    let xyz = ["x", "y", "z"].map(str::to_string);
    if *wanted == ColumnChoice::Automatic && !xyz.iter().all(|n| names.contains(n)) {
        return Err(Flaw::new(
            format!("the fields {}", names.join(", ")),
            "x, y, z; --columns takes others",
        ));
    }
    let kept = pick(Some(&names), names.len(), wanted)?.kept;
    let numbers = match header.data.as_str() {
        "ascii" => ascii(data, &header, names.len(), &kept)?,
        "binary" => binary(data, &header, &kept, false)?,
        "binary_compressed" => {
            let word = |at: usize| {
                data.get(at..at + 4)?
                    .first_chunk()
                    .map(|&b| u32::from_le_bytes(b) as usize)
            };
            let (Some(packed), Some(size)) = (word(0), word(4)) else {
                return Err(Flaw::new("the end of the file", "the sizes of packed data"));
            };
            let rest = &data[8..];
            let stream = rest.get(..packed).ok_or_else(|| {
                Flaw::new(
                    format!("{} bytes of packed data", rest.len()),
                    format!("{packed}, as their header promises"),
                )
            })?;
            binary(&unpack(stream, size)?, &header, &kept, true)?
        }
        other => {
            return Err(Flaw::new(
                format!("data {}", excerpt(other)),
                "ascii, binary or binary_compressed",
            ));
        }
    };
    Ok(Array::new(vec![header.points, kept.len()], numbers))
}

/// What the lines before the data have said so far.
#[derive(Default)]
struct Told<'b> {
    names: Vec<&'b str>,
    sizes: Vec<usize>,
    types: Vec<&'b str>,
    counts: Option<Vec<usize>>,
    width: Option<usize>,
    height: Option<usize>,
    points: Option<usize>,
}

impl<'b> Told<'b> {
    /// Takes a line of the header; what the data is where the line says that.
    fn take(&mut self, row: &'b str, line: usize) -> Parsed<Option<&'b str>> {
        let words: Vec<&str> = row.split_whitespace().collect();
        let size = |w: &&str| {
            w.parse::<usize>()
                .map_err(|_| Flaw::line(line, excerpt(w), "a number that there can be"))
        };
        let sizes = |words: &[&str]| words.iter().map(size).collect::<Parsed<Vec<usize>>>();
        match words[..] {
            [] | ["VERSION" | "VIEWPOINT", ..] => {}
            [w, ..] if w.starts_with('#') => {}
            ["FIELDS" | "COLUMNS", ref all @ ..] => self.names = all.to_vec(),
            ["SIZE", ref all @ ..] => self.sizes = sizes(all)?,
            ["TYPE", ref all @ ..] => self.types = all.to_vec(),
            ["COUNT", ref all @ ..] => self.counts = Some(sizes(all)?),
            ["WIDTH", w] => self.width = Some(size(&w)?),
            ["HEIGHT", h] => self.height = Some(size(&h)?),
            ["POINTS", n] => self.points = Some(size(&n)?),
            ["DATA", data] => return Ok(Some(data)),
            _ => {
                return Err(Flaw::line(
                    line,
                    excerpt(row),
                    "a header of the Point Cloud Library",
                ));
            }
        }
        Ok(None)
    }

    /// The header that ends on a line.
    fn header(self, data: &str, line: usize) -> Parsed<Header> {
        let count = self.names.len();
        let counts = self.counts.unwrap_or_else(|| vec![1; count]);
        let (sizes, types) = (self.sizes, self.types);
        if [sizes.len(), types.len(), counts.len()] != [count; 3] {
            let found = format!(
                "{count} fields, {} sizes, {} types",
                sizes.len(),
                types.len()
            );
            return Err(Flaw::line(line, found, "as many of each"));
        }
        let area = (self.width.zip(self.height)).and_then(|(w, h)| w.checked_mul(h));
        let points =
            (self.points.or(area)).ok_or_else(|| Flaw::line(line, "no POINTS", "their number"))?;
        let fields = (0..count).map(|k| Field::of(self.names[k], sizes[k], types[k], counts[k]));
        Ok(Header {
            fields: fields.collect::<Parsed<_>>()?,
            points,
            data: data.into(),
            lines: line,
        })
    }
}

impl Field {
    fn of(name: &str, size: usize, kind: &str, count: usize) -> Parsed<Self> {
        let letter = kind.to_lowercase();
        let known = matches!(letter.as_str(), "f" | "i" | "u") && matches!(size, 1 | 2 | 4 | 8);
        if !known || count > MOST_OF_A_FIELD {
            let found = format!("{count} of type {kind} and size {size}");
            return Err(Flaw::new(found, "types F, I, U of 1, 2, 4 or 8 bytes").within(name));
        }
        Ok(Self {
            name: name.into(),
            kind: format!("{letter}{size}"),
            width: size,
            count,
        })
    }
}

/// The header, and the data behind it.
fn header(bytes: &[u8]) -> Parsed<(Header, &[u8])> {
    let window = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let mut told = Told::default();
    let mut rest = window;
    let mut line = 0;
    while let Some(end) = rest.iter().position(|&b| b == b'\n') {
        let row = text(&rest[..end])?.trim();
        rest = &rest[end + 1..];
        line += 1;
        if let Some(data) = told.take(row, line)? {
            let header = told.header(data, line)?;
            return Ok((header, &bytes[window.len() - rest.len()..]));
        }
    }
    Err(Flaw::new(
        "no line DATA",
        "a header of the Point Cloud Library",
    ))
}

/// NaN is how such files mark a point that was not measured.
fn not_measured(flaw: Flaw) -> Flaw {
    if flaw.found == "NaN" {
        let expected = "a finite number: leave out the points that were not measured".into();
        return Flaw { expected, ..flaw };
    }
    flaw
}

fn ascii(data: &[u8], header: &Header, total: usize, kept: &[usize]) -> Parsed<Numbers> {
    let mut numbers = Vec::new();
    let mut points = 0;
    for (at, row) in text(data)?.lines().enumerate() {
        let fields: Vec<&str> = row.split_whitespace().collect();
        if fields.is_empty() {
            continue;
        }
        let line = header.lines + at + 1;
        if fields.len() != total {
            let found = format!("{} numbers", fields.len());
            return Err(Flaw::line(line, found, format!("{total}, one a field")));
        }
        points += 1;
        for &k in kept {
            numbers.push(number(fields[k], line, k + 1).map_err(not_measured)?);
        }
    }
    if points != header.points {
        return Err(Flaw::new(
            format!("{points} points"),
            format!("{}, as the header promises", header.points),
        ));
    }
    Ok(Numbers::F64(numbers))
}

/// Points one after the other; or, when packed, field after field.
fn binary(data: &[u8], header: &Header, kept: &[usize], by_field: bool) -> Parsed<Numbers> {
    let entry: usize = header.fields.iter().map(|f| f.width * f.count).sum();
    let needed = header.points.checked_mul(entry);
    let data = needed.and_then(|n| data.get(..n)).ok_or_else(|| {
        Flaw::new(
            format!("{} bytes of data", data.len()),
            format!(
                "{} points of {entry} bytes, as the header promises",
                header.points
            ),
        )
    })?;
    let mut columns: Vec<Numbers> = Vec::new();
    let mut from = 0;
    for field in &header.fields {
        let size = field.width * field.count;
        for k in 0..field.count {
            let at = |point: usize| match by_field {
                true => header.points * from + point * size + k * field.width,
                false => point * entry + from + k * field.width,
            };
            if !kept.contains(&columns.len()) {
                columns.push(Numbers::Integer(vec![]));
                continue;
            }
            let bytes: Vec<u8> = (0..header.points)
                .flat_map(|p| &data[at(p)..at(p) + field.width])
                .copied()
                .collect();
            let numbers = npy::decode(&field.kind, false, &bytes);
            columns.push(numbers.map_err(|f| f.within(&field.name))?);
        }
        from += size;
    }
    let all = (0..header.points).flat_map(|p| kept.iter().map(move |&k| (p, k)));
    let all = all.map(|(p, k)| columns[k].at(p));
    Ok(
        if kept.iter().all(|&k| matches!(columns[k], Numbers::F32(_))) {
            // Exact: every one of them was widened from single precision.
            Numbers::F32(all.map(|x| x as f32).collect())
        } else {
            Numbers::F64(all.collect())
        },
    )
}

/// Unpacks LZF: a byte below 32 announces so many bytes and one more as they are; else its upper
/// three bits are a length, its lower five the upper part of a distance backward.
fn unpack(packed: &[u8], size: usize) -> Parsed<Vec<u8>> {
    let bad = || Flaw::new("bad packed data", "data packed by LZF");
    if size > packed.len().saturating_mul(LARGEST_RUN) {
        return Err(Flaw::new(
            format!("a promise of {size} bytes in {} packed ones", packed.len()),
            format!("at most {LARGEST_RUN} times as many"),
        ));
    }
    let mut out: Vec<u8> = Vec::new();
    let mut bytes = packed.iter().map(|&b| usize::from(b));
    while let Some(control) = bytes.next() {
        if control < 32 {
            for _ in 0..=control {
                out.push(bytes.next().ok_or_else(bad)? as u8);
            }
            continue;
        }
        let mut length = control >> 5;
        if length == 7 {
            length += bytes.next().ok_or_else(bad)?;
        }
        let distance = ((control & 31) << 8 | bytes.next().ok_or_else(bad)?) + 1;
        let start = out.len().checked_sub(distance).ok_or_else(bad)?;
        for k in 0..length + 2 {
            out.push(out[start + k]);
        }
        if out.len() > size {
            break;
        }
    }
    if out.len() != size {
        return Err(Flaw::new(
            format!("{} unpacked bytes", out.len()),
            format!("{size}, as their header promises"),
        ));
    }
    Ok(out)
}

#[cfg(test)]
mod tests;
