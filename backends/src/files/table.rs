//! Tables of numbers in a text: `.csv`, `.txt`, plain `.xyz`.
//!
//! The columns are separated by semicolons, commas or white space, whichever the first row shows
//! (in that order). `#` starts a comment. A first row of
//! names, none of which is or begins like a number, is a header.

use super::error::{Flaw, Parsed, excerpt};
use crosscap_core::{PointCloud, Scalar};
use std::fmt::Write;

/// A table: rows of equal length in row order.
#[derive(Debug, PartialEq)]
pub(crate) struct Table {
    pub(crate) columns: usize,
    pub(crate) numbers: Vec<f64>,
}

/// The bytes as text, or the line at which they stop being one.
pub(crate) fn text(bytes: &[u8]) -> Parsed<&str> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| {
        let line = 1 + bytes[..e.valid_up_to()]
            .iter()
            .filter(|&&b| b == b'\n')
            .count();
        Flaw::line(line, "bytes that are no UTF-8", "a text file")
    })
}

/// A field as a finite number.
pub(crate) fn number(field: &str, line: usize, column: usize) -> Parsed<f64> {
    match field.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(x) => Err(Flaw::field(line, column, x.to_string(), "a finite number")),
        Err(_) if field.is_empty() => Err(Flaw::field(line, column, "an empty field", "a number")),
        Err(_) => Err(Flaw::field(line, column, excerpt(field), "a number")),
    }
}

/// Reads a table.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Table> {
    let text = text(bytes)?;
    let mut table = Table {
        columns: 0,
        numbers: vec![],
    };
    let first = text
        .lines()
        .map(without_comment)
        .find(|line| !line.is_empty());
    let Some(first) = first else {
        return Err(Flaw::new("no row of numbers", "at least one point"));
    };
    let delimiter = [';', ','].into_iter().find(|&d| first.contains(d));
    match delimiter {
        Some(delimiter) => {
            let mut reader = csv::ReaderBuilder::new()
                .delimiter(delimiter as u8)
                .has_headers(false)
                .flexible(true)
                .comment(Some(b'#'))
                .trim(csv::Trim::All)
                .from_reader(text.as_bytes());
            let mut record = csv::StringRecord::new();
            let mut header_may_come = true;
            loop {
                let more = reader
                    .read_record(&mut record)
                    .map_err(|e| Flaw::new(e.to_string(), "a table of numbers"))?;
                if !more {
                    break;
                }
                // The position of a record is that of the blank lines and comments before it.
                let (mut line, byte) = record
                    .position()
                    .map_or((1, 0), |p| (p.line() as usize, p.byte() as usize));
                line += text[byte.min(text.len())..]
                    .lines()
                    .take_while(|row| row.is_empty() || row.starts_with('#'))
                    .count();
                let fields: Vec<&str> = record
                    .iter()
                    .map(|f| f.split('#').next().unwrap_or("").trim())
                    .collect();
                if fields.iter().all(|f| f.is_empty()) && fields.len() < 2 {
                    continue;
                }
                table.row(line, &fields, &mut header_may_come)?;
            }
        }
        None => {
            let mut header_may_come = true;
            let mut fields = Vec::new();
            for (at, line) in text.lines().enumerate() {
                fields.clear();
                fields.extend(without_comment(line).split_whitespace());
                if !fields.is_empty() {
                    table.row(at + 1, &fields, &mut header_may_come)?;
                }
            }
        }
    }
    if table.columns == 0 {
        return Err(Flaw::new(
            "a header and no row of numbers",
            "at least one point",
        ));
    }
    Ok(table)
}

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or("").trim()
}

impl Table {
    fn row(&mut self, line: usize, fields: &[&str], header_may_come: &mut bool) -> Parsed<()> {
        if std::mem::take(header_may_come) && fields.iter().all(|f| is_name(f)) {
            return Ok(());
        }
        if self.columns == 0 {
            self.columns = fields.len();
        }
        if fields.len() != self.columns {
            return Err(Flaw::line(
                line,
                format!("{} columns", fields.len()),
                format!("{} as in the first row", self.columns),
            ));
        }
        for (at, field) in fields.iter().enumerate() {
            self.numbers.push(number(field, line, at + 1)?);
        }
        Ok(())
    }
}

/// Whether a field can head a column: no number, and nothing that was meant as one.
fn is_name(field: &str) -> bool {
    field.parse::<f64>().is_err()
        && !field.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// Rows of numbers, as few digits as give the same numbers back.
pub(crate) fn bytes<S: Scalar>(cloud: &PointCloud<S>, delimiter: char) -> Vec<u8> {
    let mut text = String::new();
    for point in cloud.iter() {
        for (at, x) in point.iter().enumerate() {
            if at > 0 {
                text.push(delimiter);
            }
            // Formatting into a string cannot fail.
            let _ = write!(text, "{x:?}");
        }
        text.push('\n');
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str) -> Vec<f64> {
        parse(text.as_bytes()).unwrap().numbers
    }

    #[test]
    fn separators_comments_and_headers() {
        let expected = [1.0, 2.5, -3e4, 4.0];
        for text in [
            "1,2.5\n-3e4,4\n",
            "1;2.5\n-3e4;4",
            "1 2.5\r\n-3e4\t 4\r\n",
            "x,y\n\n1, 2.5\n# between\n-3e4 ,4 # behind\n",
            "\u{feff}# first\n  x y\n 1   2.5\n-3e4 4\n\n",
            "# a, b; c\n\"1\",\"2.5\"\n-3e4,4\n",
            "# a, b; c\n1 2.5\n-3e4 4\n",
        ] {
            assert_eq!(numbers(text), expected, "{text:?}");
        }
    }

    #[test]
    fn names_line_and_column() {
        for (text, line, field, found) in [
            ("1,2\n3,x\n", 2, Some(2), "\"x\""),
            ("1,2\n\n# c\n3,\n", 4, Some(2), "an empty field"),
            ("1 2\n3 4 5\n", 2, None, "3 columns"),
            ("1 2\n3 inf\n", 2, Some(2), "inf"),
            ("nan;2\n", 1, Some(1), "NaN"),
            ("1,5;2,5\n", 1, Some(1), "\"1,5\""),
        ] {
            let flaw = parse(text.as_bytes()).unwrap_err();
            let place = crate::files::Place::Line { line, field };
            assert_eq!(
                (&flaw.place, flaw.found.as_str()),
                (&place, found),
                "{text:?}"
            );
        }
    }
}
