//! Laser scans, `.las` of versions 1.0 to 1.4: places alone. Read only, without compression.

use super::error::{Flaw, Parsed};
use super::npy::{Array, Numbers};

/// Bytes of the shortest header.
const SHORTEST_HEADER: usize = 227;

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
    if bytes[104] & 0xc0 != 0 {
        return Err(Flaw::new(
            "packed points",
            "points as they are: unpack them first (laszip, or las2las -o points.las)",
        ));
    }
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
    let data = count
        .checked_mul(record)
        .and_then(|size| bytes.get(start..)?.get(..size))
        .filter(|_| record >= 12)
        .ok_or_else(|| {
            Flaw::new(
                format!("{} bytes of points", bytes.len().saturating_sub(start)),
                format!(
                    "{count} points of {record} bytes, as the header promises, 12 or more each"
                ),
            )
        })?;
    let mut numbers = Vec::with_capacity(3 * count);
    for point in data.chunks_exact(record) {
        for (k, &x) in point[..12].as_chunks::<4>().0.iter().enumerate() {
            numbers.push(f64::from(i32::from_le_bytes(x)) * scale[k] + offset[k]);
        }
    }
    Ok(Array::new(vec![count, 3], Numbers::F64(numbers)))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

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
        bytes[104] = 0x80;
        assert!(parse(&bytes).unwrap_err().found.contains("packed"));
        assert!(parse(b"LAS").is_err() && parse(b"LASF").is_err());
    }
}
