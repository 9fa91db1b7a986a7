//! The numbers of an array, however they are stored.

use crate::files::error::{Flaw, Parsed, excerpt};
use crate::files::npy::{self, Numbers};
use crate::files::npz::LARGEST_INFLATION;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use roxmltree::Node;
use std::io::Read;

/// How the binary arrays of a file are encoded.
pub(super) struct Encoding<'a> {
    pub big: bool,
    pub wide: bool,
    pub compressor: Option<&'a str>,
    pub appended: &'a [u8],
    pub raw: bool,
}

/// Number of components, and the numbers.
pub(super) fn data_array(node: Node<'_, '_>, encoding: &Encoding<'_>) -> Parsed<(usize, Numbers)> {
    let components = match node.attribute("NumberOfComponents") {
        Some(n) => n
            .parse()
            .map_err(|_| Flaw::new(excerpt(n), "a number of components"))?,
        None => 1,
    };
    let kind = match node.attribute("type") {
        Some("Float64") => "f8",
        Some("Float32") => "f4",
        Some("Int64") => "i8",
        Some("Int32") => "i4",
        Some("Int16") => "i2",
        Some("Int8") => "i1",
        Some("UInt64") => "u8",
        Some("UInt32") => "u4",
        Some("UInt16") => "u2",
        Some("UInt8" | "String") => "u1",
        other => {
            return Err(Flaw::new(
                format!("type {}", excerpt(other.unwrap_or(""))),
                "a type of number",
            ));
        }
    };
    let content = node.text().unwrap_or("");
    let numbers = match node.attribute("format") {
        Some("ascii") if kind.starts_with('f') => Numbers::F64(ascii(content)?),
        Some("ascii") => Numbers::Integer(ascii(content)?),
        Some("binary") => {
            let packed: String = content.split_ascii_whitespace().collect();
            binary(packed.as_bytes(), false, kind, encoding)?
        }
        Some("appended") => {
            let offset = node.attribute("offset").unwrap_or("");
            let at = offset.parse::<usize>().ok();
            let data = at
                .and_then(|at| encoding.appended.get(at..))
                .ok_or_else(|| {
                    Flaw::new(
                        format!("offset {}", excerpt(offset)),
                        format!("one of {} bytes of appended data", encoding.appended.len()),
                    )
                })?;
            binary(data, encoding.raw, kind, encoding)?
        }
        other => {
            return Err(Flaw::new(
                format!("format {}", excerpt(other.unwrap_or(""))),
                "ascii, binary or appended",
            ));
        }
    };
    Ok((components, numbers))
}

fn ascii<T: std::str::FromStr>(content: &str) -> Parsed<Vec<T>> {
    content
        .split_ascii_whitespace()
        .map(|field| {
            field
                .parse()
                .map_err(|_| Flaw::new(excerpt(field), "a number"))
        })
        .collect()
}

/// The numbers of an array of this kind that is stored in base64 or raw.
fn binary(data: &[u8], raw: bool, kind: &str, encoding: &Encoding<'_>) -> Parsed<Numbers> {
    let packing = Packing {
        data,
        raw,
        width: if encoding.wide { 8 } else { 4 },
        big: encoding.big,
    };
    let bytes = match encoding.compressor {
        None => packing.plain()?,
        Some("vtkZLibDataCompressor") => packing.zlib()?,
        Some(other) => {
            return Err(Flaw::new(
                format!("data packed by {}", excerpt(other)),
                "zlib, or none: save it again with another compressor",
            ));
        }
    };
    let one = usize::from(kind.as_bytes()[1] - b'0');
    if !bytes.len().is_multiple_of(one) {
        return Err(Flaw::new(
            format!("{} bytes of data", bytes.len()),
            format!("a multiple of {one}"),
        ));
    }
    npy::decode(kind, encoding.big, &bytes)
}

/// Words that tell sizes, then the bytes of the numbers, in base64 or raw.
struct Packing<'a> {
    data: &'a [u8],
    raw: bool,
    /// Bytes of a word.
    width: usize,
    big: bool,
}

impl Packing<'_> {
    fn word(&self, bytes: &[u8]) -> u64 {
        bytes.iter().enumerate().fold(0_u64, |sum, (k, &byte)| {
            let place = if self.big { self.width - 1 - k } else { k };
            sum | u64::from(byte) << (8 * place)
        })
    }

    /// The first bytes. They stand alone in base64 when packed data follow.
    fn head(&self, bytes: usize) -> Parsed<Vec<u8>> {
        let data = self.data;
        let short = || {
            Flaw::new(
                format!("{} bytes", data.len()),
                format!("{bytes} bytes that say how many follow"),
            )
        };
        if self.raw {
            return data.get(..bytes).map(Vec::from).ok_or_else(short);
        }
        let characters = data.get(..4 * bytes.div_ceil(3)).ok_or_else(short)?;
        let mut decoded = decode(characters)?;
        if decoded.len() < bytes {
            return Err(short());
        }
        decoded.truncate(bytes);
        Ok(decoded)
    }

    /// The bytes behind one word that says how many they are.
    fn plain(&self) -> Parsed<Vec<u8>> {
        let &Self {
            data, raw, width, ..
        } = self;
        let size = self.word(&self.head(width)?);
        let short = |there: usize| {
            Flaw::new(
                format!("{} bytes of data", there.saturating_sub(width)),
                format!("{size}, as their header promises"),
            )
        };
        let needed = usize::try_from(size)
            .ok()
            .and_then(|s| s.checked_add(width));
        let there = if raw { data.len() } else { data.len() / 4 * 3 };
        let needed = needed.filter(|&n| n <= there).ok_or_else(|| short(there))?;
        let mut all = if raw {
            data[..needed].to_vec()
        } else {
            let end = (4 * needed.div_ceil(3)).min(data.len());
            decode(&data[..end])?
        };
        if all.len() < needed {
            return Err(short(all.len()));
        }
        all.truncate(needed);
        Ok(all.split_off(width))
    }

    /// The bytes of blocks that are packed by zlib: how many there are, their size, that of the last one, the packed size of each.
    fn zlib(&self) -> Parsed<Vec<u8>> {
        let &Self {
            data, raw, width, ..
        } = self;
        let blocks = self.word(&self.head(width)?) as usize;
        if blocks > data.len() {
            return Err(Flaw::new(
                format!("a promise of {blocks} blocks in {} bytes", data.len()),
                "blocks that are there",
            ));
        }
        let header = (3 + blocks) * width;
        let head = self.head(header)?;
        let words: Vec<u64> = head.chunks_exact(width).map(|w| self.word(w)).collect();
        let sizes = &words[3..];
        if raw {
            return inflate(&data[header..], sizes);
        }
        let size = sizes.iter().fold(0_u64, |sum, &s| sum.saturating_add(s));
        let from = 4 * header.div_ceil(3);
        let length = usize::try_from(size).unwrap_or(usize::MAX).div_ceil(3);
        let to = from
            .saturating_add(length.saturating_mul(4))
            .min(data.len());
        inflate(&decode(&data[from..to])?, sizes)
    }
}

fn decode(characters: &[u8]) -> Parsed<Vec<u8>> {
    STANDARD
        .decode(characters)
        .map_err(|e| Flaw::new(format!("bad base64 ({e})"), "binary data"))
}

/// Blocks of these sizes, one after the other.
fn inflate(packed: &[u8], sizes: &[u64]) -> Parsed<Vec<u8>> {
    let mut all = Vec::new();
    let mut rest = packed;
    for (k, &size) in sizes.iter().enumerate() {
        let block = usize::try_from(size)
            .ok()
            .and_then(|s| rest.split_at_checked(s));
        let (block, behind) = block.ok_or_else(|| {
            Flaw::new(
                format!("{} bytes for block {k}", rest.len()),
                format!("{size}"),
            )
        })?;
        rest = behind;
        let limit = (block.len() as u64).saturating_mul(LARGEST_INFLATION);
        ZlibDecoder::new(block)
            .take(limit)
            .read_to_end(&mut all)
            .map_err(|e| Flaw::new(format!("bad packed data ({e})"), "blocks packed by zlib"))?;
    }
    Ok(all)
}
