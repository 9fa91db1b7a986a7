//! The header of a NumPy array: a Python literal of three entries.

use super::error::{Flaw, Parsed, excerpt};

/// Longest header that is believed; real ones have about 100 bytes, records with many fields some
/// thousand.
pub(crate) const LONGEST: usize = 1 << 16;

/// Deepest nesting of brackets: fields of records within records, and their shapes.
const DEEPEST: usize = 8;

/// Most bytes that one entry may take, all fields of a record together.
const WIDEST: usize = 1 << 20;

/// A number, or something else, of every entry.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    /// Its name, empty for an array that is no record.
    pub(crate) name: String,
    /// NumPy's name of the type without the byte order: `f8`, `i4`, `S10`, ...
    pub(crate) kind: String,
    /// Whether the most significant byte comes first.
    pub(crate) big: bool,
    /// How many of it there are in an entry.
    pub(crate) count: usize,
    /// Bytes of one of them.
    pub(crate) width: usize,
}

/// What the header says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Header {
    /// The fields of an entry: one without a name, or those of a record.
    pub(crate) fields: Vec<Field>,
    /// Whether an entry is a record.
    pub(crate) record: bool,
    /// Whether the first index runs fastest.
    pub(crate) fortran: bool,
    /// Number of entries along each axis.
    pub(crate) shape: Vec<usize>,
}

impl Header {
    /// Bytes of an entry.
    pub(crate) fn entry(&self) -> usize {
        self.fields.iter().map(|f| f.count * f.width).sum()
    }
}

/// Reads the header; the second value is what follows it.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<(Header, &[u8])> {
    let not_an_array = || {
        Flaw::new(
            "something else",
            "a NumPy array, which starts with \\x93NUMPY",
        )
    };
    let truncated = || Flaw::new("a truncated header", "a NumPy array");
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err(not_an_array());
    }
    let (start, length) = match bytes.get(6..12) {
        Some(&[1, _, a, b, _, _]) => (10, u16::from_le_bytes([a, b]) as usize),
        Some(&[2 | 3, _, a, b, c, d]) => (12, u32::from_le_bytes([a, b, c, d]) as usize),
        Some(&[version, ..]) => {
            return Err(Flaw::new(
                format!("a header of version {version}"),
                "a NumPy array of version 1, 2 or 3",
            ));
        }
        _ => return Err(truncated()),
    };
    if length > LONGEST {
        return Err(Flaw::new(
            format!("a header of {length} bytes"),
            format!("at most {LONGEST}"),
        ));
    }
    let text = bytes.get(start..start + length).ok_or_else(truncated)?;
    let text = std::str::from_utf8(text)
        .map_err(|_| Flaw::new("a header that is no text", "a NumPy array"))?;
    let mut cursor = Cursor { rest: text };
    let literal = cursor.literal(0)?;
    if !cursor.rest.trim().is_empty() {
        return Err(bad(cursor.rest, "the end of the header"));
    }
    let Literal::Dictionary(entries) = literal else {
        return Err(bad(text, "a dictionary"));
    };
    Ok((header(&entries)?, &bytes[start + length..]))
}

fn bad(found: &str, expected: &str) -> Flaw {
    Flaw::new(
        format!("a bad header ({}, no {expected})", excerpt(found.trim())),
        "a NumPy array",
    )
}

fn header(entries: &[(String, Literal)]) -> Parsed<Header> {
    let get = |name: &str| {
        let mut found = entries.iter().filter(|(key, _)| key == name);
        found
            .next()
            .map(|(_, value)| value)
            .ok_or_else(|| bad("", &format!("entry {name}")))
    };
    let Literal::Truth(fortran) = *get("fortran_order")? else {
        return Err(bad("fortran_order", "True or False"));
    };
    let shape = sizes(get("shape")?)?;
    let (fields, record) = match get("descr")? {
        Literal::Text(kind) => (vec![field("", kind, 1)?], false),
        Literal::List(fields) => {
            let mut all = Vec::new();
            record("", fields, &mut all)?;
            (all, true)
        }
        _ => return Err(bad("descr", "type")),
    };
    // Widths are believed only when the entry is of a size that occurs.
    fields
        .iter()
        .try_fold(0_usize, |sum, f| {
            sum.checked_add(f.count.checked_mul(f.width)?)
                .filter(|&sum| sum <= WIDEST)
        })
        .ok_or_else(|| {
            Flaw::new(
                "entries of more bytes than there can be",
                format!("at most {WIDEST} bytes an entry"),
            )
        })?;
    Ok(Header {
        fields,
        record,
        fortran,
        shape,
    })
}

fn record(prefix: &str, entries: &[Literal], fields: &mut Vec<Field>) -> Parsed<()> {
    for entry in entries {
        let Literal::List(parts) = entry else {
            return Err(bad("descr", "field (name, type)"));
        };
        let (name, kind, count) = match &parts[..] {
            [name, kind] => (name, kind, 1),
            [name, kind, shape] => {
                let product = sizes(shape)?
                    .into_iter()
                    .try_fold(1_usize, usize::checked_mul);
                (name, kind, product.unwrap_or(usize::MAX))
            }
            _ => return Err(bad("descr", "field (name, type)")),
        };
        // A field with a title is named by a pair.
        let name = match name {
            Literal::Text(name) => name,
            Literal::List(pair) => match pair.last() {
                Some(Literal::Text(name)) => name,
                _ => return Err(bad("descr", "name of a field")),
            },
            _ => return Err(bad("descr", "name of a field")),
        };
        let name = format!("{prefix}{name}");
        match kind {
            Literal::Text(kind) => fields.push(field(&name, kind, count)?),
            Literal::List(inner) if count == 1 => record(&format!("{name}."), inner, fields)?,
            _ => {
                return Err(Flaw::new(
                    format!("an array of records in the field {name:?}"),
                    "fields of numbers",
                ));
            }
        }
    }
    Ok(())
}

fn field(name: &str, descriptor: &str, count: usize) -> Parsed<Field> {
    let (big, kind) = match descriptor.split_at_checked(1) {
        Some(("<" | "|" | "=", kind)) => (false, kind),
        Some((">", kind)) => (true, kind),
        _ => (false, descriptor),
    };
    let digits = kind
        .find(|c: char| c.is_ascii_digit())
        .unwrap_or(kind.len());
    let (letter, number) = kind.split_at(digits);
    // Dates carry a unit in brackets; characters of U take four bytes.
    let number = number.split('[').next().unwrap_or("");
    let width: usize = match (letter, number) {
        ("O", _) => 8,
        (_, number) => number
            .parse()
            .map_err(|_| bad(descriptor, "name of a type with its width"))?,
    };
    Ok(Field {
        name: name.into(),
        kind: kind.into(),
        big,
        count,
        width: if letter == "U" {
            width.saturating_mul(4)
        } else {
            width
        },
    })
}

fn sizes(shape: &Literal) -> Parsed<Vec<usize>> {
    let one = |l: &Literal| match l {
        Literal::Integer(n) => Ok(*n),
        _ => Err(bad("shape", "number of entries")),
    };
    match shape {
        Literal::List(all) => all.iter().map(one).collect(),
        single => Ok(vec![one(single)?]),
    }
}

/// What can stand in a header. Lists and tuples are the same here.
#[derive(Debug)]
enum Literal {
    Text(String),
    Integer(usize),
    Truth(bool),
    List(Vec<Literal>),
    Dictionary(Vec<(String, Literal)>),
}

struct Cursor<'a> {
    rest: &'a str,
}

impl<'a> Cursor<'a> {
    fn skip(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn eat(&mut self, token: char) -> bool {
        self.skip();
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn word(&mut self, word: &str) -> bool {
        match self.rest.strip_prefix(word) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn text(&mut self) -> Parsed<String> {
        self.skip();
        self.word("u");
        self.word("b");
        let quote = match self.rest.chars().next() {
            Some(quote @ ('\'' | '"')) => quote,
            _ => return Err(bad(self.rest, "text in quotes")),
        };
        let inner = &self.rest[1..];
        let end = inner
            .find(quote)
            .ok_or_else(|| bad(inner, "closing quote"))?;
        self.rest = &inner[end + 1..];
        Ok(inner[..end].into())
    }

    fn literal(&mut self, depth: usize) -> Parsed<Literal> {
        if depth > DEEPEST {
            return Err(Flaw::new(
                "a header of nested brackets",
                "an array of numbers",
            ));
        }
        self.skip();
        if self.eat('{') {
            let mut entries = Vec::new();
            while !self.eat('}') {
                let key = self.text()?;
                if !self.eat(':') {
                    return Err(bad(self.rest, "colon"));
                }
                entries.push((key, self.literal(depth + 1)?));
                if !self.eat(',') && !self.rest.starts_with('}') {
                    return Err(bad(self.rest, "comma"));
                }
            }
            return Ok(Literal::Dictionary(entries));
        }
        for (open, close) in [('(', ')'), ('[', ']')] {
            if self.eat(open) {
                let mut all = Vec::new();
                while !self.eat(close) {
                    all.push(self.literal(depth + 1)?);
                    if !self.eat(',') && !self.rest.starts_with(close) {
                        return Err(bad(self.rest, "comma"));
                    }
                }
                return Ok(Literal::List(all));
            }
        }
        if self.word("True") {
            return Ok(Literal::Truth(true));
        }
        if self.word("False") {
            return Ok(Literal::Truth(false));
        }
        let digits = self.rest.bytes().take_while(u8::is_ascii_digit).count();
        if digits > 0 {
            let (number, rest) = self.rest.split_at(digits);
            self.rest = rest;
            // Old versions of Python write long integers with a letter behind.
            self.word("L");
            return number
                .parse()
                .map(Literal::Integer)
                .map_err(|_| bad(number, "number of entries that there can be"));
        }
        self.text().map(Literal::Text)
    }
}

#[cfg(test)]
mod tests;
