//! Laser scans, `.las` of versions 1.0 to 1.4, and `.laz`, the same packed: places alone. Read only; unpacked by the crate
//! `laz`.

use super::error::{Flaw, Parsed};
use super::npy::{Array, Numbers};
use laz::{LasZipDecompressor, LazVlr};
use std::io::{Cursor, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Bytes of the shortest header.
const SHORTEST_HEADER: usize = 227;
/// Bytes before the content of a variable length record.
const RECORD_HEADER: usize = 54;
/// Owner and number of the record that says how points are packed.
const LASZIP: (&[u8], usize) = (b"laszip encoded", 22_204);
/// Bytes that are unpacked at a time.
const BLOCK: usize = 1 << 20;

/// What a header says of the points.
struct Points {
    start: usize,
    record: usize,
    count: usize,
    scale: [f64; 3],
    offset: [f64; 3],
}

impl Points {
    /// Adds the places of whole records.
    fn places(&self, records: &[u8], numbers: &mut Vec<f64>) {
        for point in records.chunks_exact(self.record) {
            for (k, &x) in point[..12].as_chunks::<4>().0.iter().enumerate() {
                numbers.push(f64::from(i32::from_le_bytes(x)) * self.scale[k] + self.offset[k]);
            }
        }
    }
}

/// Reads the places: integers, with a scale and an offset for each axis.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Array> {
    if !bytes.starts_with(b"LASF") {
        return Err(Flaw::new(
            "something else",
            "a laser scan, which starts with LASF",
        ));
    }
    if bytes.len() < SHORTEST_HEADER {
        return Err(Flaw::new(
            format!("{} bytes", bytes.len()),
            format!("a header of {SHORTEST_HEADER} or more"),
        ));
    }
    let word = |at: usize| {
        u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]) as usize
    };
    let double = |at: usize| f64::from_bits(word(at) as u64 | (word(at + 4) as u64) << 32);
    let (start, record) = (
        word(96),
        usize::from(bytes[105]) | usize::from(bytes[106]) << 8,
    );
    let mut count = word(107);
    if count == 0 && (bytes[24], bytes[25]) >= (1, 4) && bytes.len() >= 255 {
        count = usize::try_from(word(247) as u64 | (word(251) as u64) << 32).unwrap_or(usize::MAX);
    }
    let axis = |at: usize| [double(at), double(at + 8), double(at + 16)];
    let (scale, offset) = (axis(131), axis(155));
    if let Some(bad) = scale.iter().chain(&offset).find(|x| !x.is_finite()) {
        return Err(Flaw::new(
            format!("a scale or offset of {bad}"),
            "finite numbers",
        ));
    }
    let points = Points {
        start,
        record,
        count,
        scale,
        offset,
    };
    let mut numbers = Vec::new();
    if bytes[104] & 0xc0 == 0 {
        points.places(points.records(bytes)?, &mut numbers);
    } else {
        points.unpack(bytes, &mut numbers)?;
    }
    Ok(Array::new(vec![count, 3], Numbers::F64(numbers)))
}

impl Points {
    fn checked(&self, bytes: &[u8], size: Option<usize>) -> Parsed<usize> {
        size.filter(|_| self.record >= 12).ok_or_else(|| {
            Flaw::new(
                format!("{} bytes of points", bytes.len().saturating_sub(self.start)),
                format!(
                    "{} points of {} bytes, as the header promises, 12 or more each",
                    self.count, self.record
                ),
            )
        })
    }

    /// The records of points that are not packed.
    fn records<'a>(&self, bytes: &'a [u8]) -> Parsed<&'a [u8]> {
        let size = self.count.checked_mul(self.record);
        let there = bytes.get(self.start..).unwrap_or_default();
        let size = self.checked(bytes, size.filter(|&size| size <= there.len()))?;
        Ok(&there[..size])
    }

    /// The places of packed points. What comes out is the points that are there: nothing is taken for a promise.
    fn unpack(&self, bytes: &[u8], numbers: &mut Vec<f64>) -> Parsed<()> {
        self.checked(bytes, (self.start < bytes.len()).then_some(0))?;
        let damaged = |what: &dyn std::fmt::Display| {
            Flaw::new(
                format!("packed points that do not unpack: {what}"),
                "a whole .laz file",
            )
        };
        let how = laszip(bytes).ok_or_else(|| damaged(&"the record that says how is missing"))?;
        let how = LazVlr::from_buffer(how).map_err(|error| damaged(&error))?;
        if how.items_size() != self.record as u64 {
            return Err(damaged(&format!(
                "records of {} bytes, where the header says {}",
                how.items_size(),
                self.record
            )));
        }
        // The crate takes memory for as many pieces as it is promised; a piece has a byte at least.
        if pieces(bytes, self.start).is_some_and(|count| count > bytes.len()) {
            return Err(damaged(&"more pieces than bytes"));
        }
        // The crate relies on its input in places: what is broken must not end the program.
        let unpacked = catch_unwind(AssertUnwindSafe(|| -> Parsed<()> {
            let mut source = Cursor::new(bytes);
            source
                .seek(SeekFrom::Start(self.start as u64))
                .map_err(|error| damaged(&error))?;
            let mut points = LasZipDecompressor::new(source, how).map_err(|e| damaged(&e))?;
            let at_a_time = (BLOCK / self.record).max(1);
            let mut block = vec![0; at_a_time.min(self.count) * self.record];
            let mut left = self.count;
            while left > 0 {
                let some = &mut block[..left.min(at_a_time) * self.record];
                points.decompress_many(some).map_err(|e| damaged(&e))?;
                self.places(some, numbers);
                left -= some.len() / self.record;
            }
            Ok(())
        }));
        unpacked.unwrap_or_else(|_| Err(damaged(&"they are damaged")))
    }
}

/// How many pieces the packed points that begin here have, as the table says to which they point, from their beginning or from
/// the end of the file.
fn pieces(bytes: &[u8], start: usize) -> Option<usize> {
    let place = |at: usize| {
        let told = i64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?);
        usize::try_from(told).ok().filter(|&table| table > start)
    };
    let table = place(start).or_else(|| place(bytes.len().checked_sub(8)?))?;
    let count = bytes.get(table.checked_add(4)?..table.checked_add(8)?)?;
    Some(u32::from_le_bytes(count.try_into().ok()?) as usize)
}

/// The record that says how points are packed.
fn laszip(bytes: &[u8]) -> Option<&[u8]> {
    let short =
        |at: usize| Some(usize::from(*bytes.get(at)?) | usize::from(*bytes.get(at + 1)?) << 8);
    let mut at = short(94)?;
    let records = u32::from_le_bytes(bytes.get(100..104)?.try_into().ok()?);
    for _ in 0..records {
        let (owner, number, length) = (
            bytes.get(at + 2..at + 18)?,
            short(at + 18)?,
            short(at + 20)?,
        );
        let content = bytes.get(at + RECORD_HEADER..at + RECORD_HEADER + length)?;
        if owner.starts_with(LASZIP.0) && number == LASZIP.1 {
            return Some(content);
        }
        at += RECORD_HEADER + length;
    }
    None
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use laz::{LasZipCompressor, LazItemRecordBuilder, LazItemType};

    /// A scan with points of 20 bytes, steps of a hundredth and an offset of a thousand.
    pub(crate) fn file(points: &[[i32; 3]]) -> Vec<u8> {
        let mut bytes = b"LASF".to_vec();
        bytes.resize(SHORTEST_HEADER, 0);
        bytes[24..26].copy_from_slice(&[1, 2]);
        bytes[96..100].copy_from_slice(&(SHORTEST_HEADER as u32).to_le_bytes());
        bytes[105] = 20;
        bytes[107..111].copy_from_slice(&(points.len() as u32).to_le_bytes());
        for k in 0..3 {
            bytes[131 + 8 * k..139 + 8 * k].copy_from_slice(&0.01_f64.to_le_bytes());
            bytes[155 + 8 * k..163 + 8 * k].copy_from_slice(&1000_f64.to_le_bytes());
        }
        for point in points {
            bytes.extend(point.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 8]);
        }
        bytes
    }

    #[test]
    fn places_are_scaled_and_lies_refused() {
        let mut bytes = file(&[[1, -2, 300], [0, 0, 50]]);
        let numbers = parse(&bytes).unwrap().numbers.into_f64();
        assert_eq!(numbers, [1000.01, 999.98, 1003.0, 1000.0, 1000.0, 1000.5]);
        assert!(
            parse(&bytes[..bytes.len() - 1])
                .unwrap_err()
                .found
                .contains("39 bytes")
        );
        bytes[110] = 255;
        assert!(
            parse(&bytes)
                .unwrap_err()
                .expected
                .contains("header promises")
        );
        assert!(parse(b"LAS").is_err() && parse(b"LASF").is_err());
    }

    #[test]
    fn no_points_beyond_the_end_of_the_file_are_none() {
        let mut bytes = file(&[]);
        bytes[96..100].fill(255);
        assert!(parse(&bytes).unwrap().numbers.into_f64().is_empty());
    }

    /// The same packed.
    pub(crate) fn packed(points: &[[i32; 3]]) -> Vec<u8> {
        let plain = file(points);
        let items = LazItemRecordBuilder::new()
            .add_item(LazItemType::Point10)
            .build();
        let how = LazVlr::from_laz_items(items);
        let mut content = Vec::new();
        how.write_to(&mut content).unwrap();
        let mut bytes = plain[..SHORTEST_HEADER].to_vec();
        bytes[94..96].copy_from_slice(&(SHORTEST_HEADER as u16).to_le_bytes());
        bytes[100] = 1;
        bytes[104] = 0x80;
        let start = SHORTEST_HEADER + RECORD_HEADER + content.len();
        bytes[96..100].copy_from_slice(&(start as u32).to_le_bytes());
        let mut header = [0; RECORD_HEADER];
        header[2..16].copy_from_slice(LASZIP.0);
        header[18..20].copy_from_slice(&(LASZIP.1 as u16).to_le_bytes());
        header[20..22].copy_from_slice(&(content.len() as u16).to_le_bytes());
        bytes.extend(header);
        bytes.extend(content);
        let mut out = Cursor::new(bytes);
        out.seek(SeekFrom::End(0)).unwrap();
        let mut packer = LasZipCompressor::new(&mut out, how).unwrap();
        packer.compress_many(&plain[SHORTEST_HEADER..]).unwrap();
        packer.done().unwrap();
        drop(packer);
        out.into_inner()
    }

    #[test]
    fn packed_points_are_those_that_were_packed() {
        let all: Vec<[i32; 3]> = (0..9000).map(|k| [k, k * k % 1001, -7 * k]).collect();
        let (plain, bytes) = (file(&all), packed(&all));
        assert!(bytes.len() < plain.len());
        let [plain, found] = [&plain, &bytes].map(|b| parse(b).unwrap().numbers.into_f64());
        assert_eq!(plain, found);
        // Cut anywhere, or told of more points than there are: refused.
        for end in [300, 340, bytes.len() / 2] {
            assert!(parse(&bytes[..end]).is_err(), "{end}");
        }
        let mut lie = bytes.clone();
        lie[110] = 1;
        assert!(parse(&lie).unwrap_err().found.contains("unpack"));
        let mut other = bytes;
        other[SHORTEST_HEADER + 3] = b'x';
        assert!(parse(&other).unwrap_err().found.contains("missing"));
    }
}
