//! Amounts of memory as they are typed and shown.

/// Units by the letters behind a number, in lower case.
const UNITS: [(&str, u64); 10] = [
    ("", 1),
    ("b", 1),
    ("kb", 1_000),
    ("kib", 1 << 10),
    ("mb", 1_000_000),
    ("mib", 1 << 20),
    ("gb", 1_000_000_000),
    ("gib", 1 << 30),
    ("tb", 1_000_000_000_000),
    ("tib", 1 << 40),
];

/// Bytes: a number with a unit, `2GiB`, `1.5 GB`, `800MiB`.
pub fn bytes(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let letters = text.find(|c: char| c.is_ascii_alphabetic());
    let (number, unit) = text.split_at(letters.unwrap_or(text.len()));
    let unit = unit.to_ascii_lowercase();
    let unit = UNITS.iter().find(|known| known.0 == unit);
    let number = number.trim().parse::<f64>().ok();
    match (number, unit) {
        (Some(number), Some(&(_, size))) if number > 0.0 && number.is_finite() => {
            Ok((number * size as f64) as u64)
        }
        _ => Err("expected a number with a unit: 2GiB, 1.5GB, 800MiB".into()),
    }
}

/// An amount in a fitting unit.
pub fn shown(bytes: u64) -> String {
    let mebibytes = bytes as f64 / f64::from(1 << 20);
    if mebibytes < 1024.0 {
        format!("{mebibytes:.0} MiB")
    } else {
        format!("{:.1} GiB", mebibytes / 1024.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_told_apart() {
        assert_eq!(bytes("2GiB"), Ok(2 << 30));
        assert_eq!(bytes("2 GB"), Ok(2_000_000_000));
        assert_eq!(bytes("1.5mib"), Ok(3 << 19));
        assert_eq!(bytes("4096"), Ok(4096));
        for wrong in ["", "GiB", "2 giga", "-1GiB", "0", "nan", "infMiB", "2G"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
        assert_eq!(shown(300 << 20), "300 MiB");
        assert_eq!(shown(1536 << 20), "1.5 GiB");
    }
}
