//! Tables of numbers in a text: `.csv`, `.tsv`, `.txt`, `.dat`, `.asc`, `.pts`, plain `.xyz`.
//!
//! The columns are separated by semicolons, tabs, commas or white space, whichever the first row
//! shows (in that order). `#`, `%` and `//` start a comment. Up to two rows of names, none of which
//! is or begins like a number, are a header; so is a comment right before the first row that has
//! a name for every column. A first row of one whole number is the number of rows.

use super::columns::{ColumnChoice, Picked, pick};
use super::error::{Flaw, Parsed, excerpt};
use crosscap_core::{PointCloud, Scalar};
use std::fmt::Write;

/// Most rows of names before the numbers: names, and units or a system of coordinates.
const MOST_HEADERS: usize = 2;

/// A table: rows of equal length in row order.
#[derive(Debug, PartialEq)]
pub(crate) struct Table {
    /// Columns that were kept.
    pub(crate) columns: usize,
    pub(crate) numbers: Vec<f64>,
    /// Names of all columns of the file.
    pub(crate) names: Option<Vec<String>>,
    /// Which columns of the file were kept, and why.
    pub(crate) picked: Picked,
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

/// Reads a table, of its columns those that are wanted.
pub(crate) fn parse(bytes: &[u8], wanted: &ColumnChoice) -> Parsed<Table> {
    let mut reader = Reader {
        wanted,
        separator: None,
        headers: Vec::new(),
        comment: None,
        promised: None,
        point: false,
        comma: false,
        total: 0,
        table: None,
    };
    let mut fields = Vec::new();
    for (at, line) in text(bytes)?.lines().enumerate() {
        let row = without_comment(line);
        if row.is_empty() {
            if reader.table.is_none() && !line.trim().is_empty() {
                reader.comment = Some(line);
            }
            continue;
        }
        let separator = *reader.separator.get_or_insert_with(|| Separator::of(row));
        separator.split(row, &mut fields);
        reader.row(at + 1, &fields)?;
    }
    reader.finish()
}

fn without_comment(line: &str) -> &str {
    let line = line.trim_matches([' ', '\r']);
    if line.trim_start().starts_with('%') || line.trim_start().starts_with("//") {
        return "";
    }
    let row = line.split('#').next().unwrap_or("");
    // Tabs at the end are empty fields; a row of nothing else is none.
    if row.trim().is_empty() { "" } else { row }
}

/// What stands between two columns.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Separator {
    White,
    Char(char),
}

impl Separator {
    /// The separator that a first row shows.
    fn of(row: &str) -> Self {
        let mut fields = Vec::new();
        let mut split = |separator: Self| {
            separator.split(row, &mut fields);
            fields.clone()
        };
        if row.contains(';') {
            return Self::Char(';');
        }
        if row.contains('\t') {
            let by_tab = split(Self::Char('\t'));
            let mixed = |f: &&str| f.ends_with(',') || (f.contains(' ') && !is_name(f));
            if by_tab.len() > 1 && !by_tab.iter().any(mixed) {
                return Self::Char('\t');
            }
        }
        if row.contains(',') {
            let by_comma = split(Self::Char(','));
            let spaced = by_comma
                .iter()
                .any(|f| f.contains(char::is_whitespace) && !is_name(f));
            // 1,5 2,5 are two numbers with a decimal comma.
            if !(spaced && split(Self::White).iter().all(|f| with_comma(f).is_some())) {
                return Self::Char(',');
            }
        }
        Self::White
    }

    /// The fields of a row, without white space and quotes around them.
    fn split<'a>(self, row: &'a str, fields: &mut Vec<&'a str>) {
        fields.clear();
        let quoted = row.contains('"');
        match self {
            Self::White if !quoted => fields.extend(row.split_whitespace()),
            // A row that has no tab is not taken for one field.
            Self::Char('\t') if !row.contains('\t') => Self::White.split(row, fields),
            Self::Char(c) if !quoted => fields.extend(row.split(c).map(str::trim)),
            _ => {
                let mut open = false;
                let parts = row.split(|c: char| {
                    open ^= c == '"';
                    !open
                        && match self {
                            Self::White => c.is_whitespace(),
                            Self::Char(separator) => c == separator,
                        }
                });
                fields.extend(
                    parts
                        .filter(|part| self != Self::White || !part.is_empty())
                        .map(|part| part.trim().trim_matches('"').trim()),
                );
            }
        }
    }
}

/// A number with a decimal comma, as text with a point.
fn with_comma(field: &str) -> Option<String> {
    let once = field.bytes().filter(|&b| b == b',').count() <= 1 && !field.contains('.');
    let text = field.replace(',', ".");
    (once && text.parse::<f64>().is_ok()).then_some(text)
}

/// Whether a field can head a column: no number, and nothing that was meant as one.
fn is_name(field: &str) -> bool {
    field.parse::<f64>().is_err()
        && !field.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// A table that is being read.
struct Reader<'a> {
    wanted: &'a ColumnChoice,
    separator: Option<Separator>,
    headers: Vec<Vec<String>>,
    /// The last comment before the first row.
    comment: Option<&'a str>,
    /// The line and the number of rows that it promises.
    promised: Option<(usize, usize)>,
    /// Whether a decimal point was seen, and a decimal comma.
    point: bool,
    comma: bool,
    /// Columns of the file.
    total: usize,
    table: Option<Table>,
}

impl Reader<'_> {
    fn row(&mut self, line: usize, fields: &[&str]) -> Parsed<()> {
        if self.table.is_none() {
            if self.headers.len() < MOST_HEADERS && fields.iter().all(|f| is_name(f)) {
                self.headers
                    .push(fields.iter().map(ToString::to_string).collect());
                // A title shows nothing of the rows.
                self.separator = None;
                return Ok(());
            }
            if let ([count], None) = (fields, self.promised)
                && let Ok(count) = count.parse()
            {
                self.promised = Some((line, count));
                // The next row shows what separates the columns.
                self.separator = None;
                return Ok(());
            }
            if let Some((_, alone)) = self.promised
                && fields.len() == 1
            {
                // No count but a table of one column.
                self.begin(line, 1)?;
                self.number(line - 1, 1, &alone.to_string())?;
                self.promised = None;
            } else {
                let trailing = fields.len() > 2 && fields.last() == Some(&"");
                self.begin(line, fields.len() - usize::from(trailing))?;
            }
        }
        let fields = match fields {
            [all @ .., ""] if all.len() == self.total => all,
            all => all,
        };
        if fields.len() != self.total {
            return Err(Flaw::line(
                line,
                format!("{} columns", fields.len()),
                format!("{} as in the first row", self.total),
            ));
        }
        let kept = self.table.as_ref().map_or(0, |t| t.columns);
        for k in 0..kept {
            let column = self.table.as_ref().map_or(0, |t| t.picked.kept[k]);
            self.number(line, column + 1, fields[column])?;
        }
        Ok(())
    }

    fn number(&mut self, line: usize, column: usize, field: &str) -> Parsed<()> {
        let point = field.contains('.');
        let comma = if field.contains(',') && !matches!(self.separator, Some(Separator::Char(',')))
        {
            with_comma(field)
        } else {
            None
        };
        self.point |= point;
        self.comma |= comma.is_some();
        if self.point && self.comma {
            return Err(Flaw::field(
                line,
                column,
                excerpt(field),
                "decimal commas alone, or decimal points alone",
            ));
        }
        let x = number(comma.as_deref().unwrap_or(field), line, column).map_err(|flaw| {
            let expected = format!(
                "{}: leave the row out, or the column (--columns)",
                flaw.expected
            );
            Flaw { expected, ..flaw }
        })?;
        if let Some(table) = &mut self.table {
            table.numbers.push(x);
        }
        Ok(())
    }

    /// The first row of numbers is there: which columns are wanted?
    fn begin(&mut self, line: usize, total: usize) -> Parsed<()> {
        let names = self.names(line, total)?;
        let picked = pick(names.as_deref(), total, self.wanted)?;
        self.total = total;
        self.table = Some(Table {
            columns: picked.kept.len(),
            numbers: vec![],
            names,
            picked,
        });
        Ok(())
    }

    /// Names of all columns, from the header or from the comment before the first row.
    fn names(&self, line: usize, total: usize) -> Parsed<Option<Vec<String>>> {
        if let Some(header) = self.headers.first() {
            let mut names = header.clone();
            if names.len() == total + 1 && names.last().is_some_and(String::is_empty) {
                names.pop();
            }
            // Where rows have names, their column often has none.
            if names.len() + 1 == total {
                names.insert(0, String::new());
            }
            // Two words are a heading of the table, and name no column.
            if names.len() == total || self.separator == Some(Separator::White) {
                return Ok((names.len() == total).then_some(names));
            }
            return Err(Flaw::line(
                line,
                format!("{total} columns"),
                format!("{}, as there are names", names.len()),
            ));
        }
        let words = self
            .comment
            .map(|c| c.trim_start_matches(['#', '%', '/', ' ', '\t']));
        Ok(words.and_then(|words| {
            let names: Vec<String> = words
                .split(|c: char| c.is_whitespace() || ",;".contains(c))
                .filter(|w| !w.is_empty())
                .map(String::from)
                .collect();
            (names.len() == total).then_some(names)
        }))
    }

    fn finish(self) -> Parsed<Table> {
        let Some(table) = self.table else {
            return Err(Flaw::new(
                match (self.headers.is_empty(), self.promised) {
                    (_, Some((_, alone))) => format!("one number, {alone}"),
                    (true, None) => "no row of numbers".into(),
                    (false, None) => "a header and no row of numbers".into(),
                },
                "at least one point",
            ));
        };
        let rows = table.numbers.len() / table.columns.max(1);
        match self.promised {
            Some((line, count)) if count != rows => Err(Flaw::line(
                line,
                format!("the promise of {count} rows"),
                format!("{rows}, as there are"),
            )),
            _ => Ok(table),
        }
    }
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
mod tests;
