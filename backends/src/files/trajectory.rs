//! Trajectories of molecules without the names of their atoms: `.xtc` (GROMACS) by the crate `molly`, and `.dcd` (CHARMM,
//! NAMD, X-PLOR). Read only.

use super::error::{Flaw, Parsed};
use super::frames::Coordinates;
use molly::{Frame, XTCReader};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Nanometers, the unit of `.xtc`, in Angstrom, that of the other formats of molecules.
const ANGSTROM: f64 = 10.0;
/// Bytes of the header of a frame of `.xtc`, up to the number of its atoms, which is said twice.
const XTC_HEADER: usize = 56;
/// Where the number of bytes of packed coordinates stands.
const XTC_PACKED: usize = XTC_HEADER + 32;

/// Reads the frames of a `.xtc`, in Angstrom.
pub(crate) fn parse_xtc(bytes: &[u8]) -> Parsed<Coordinates> {
    let mut source = Cursor::new(bytes);
    let mut all = Coordinates {
        columns: 0,
        numbers: Vec::new(),
    };
    let mut number = 0;
    while (source.position() as usize) < bytes.len() {
        number += 1;
        let rest = &bytes[source.position() as usize..];
        let atoms = atoms_of_xtc(rest).ok_or_else(|| damaged(number, &"no header of a frame"))?;
        check_atoms(number, 3 * atoms, &mut all)?;
        // The crate relies on its input in places: what is broken must not end the program.
        let read = catch_unwind(AssertUnwindSafe(|| {
            let mut frame = Frame {
                step: 0,
                time: 0.0,
                boxvec: Default::default(),
                precision: 0.0,
                positions: Vec::new(),
            };
            let mut reader = XTCReader::new(&mut source);
            reader.read_frame(&mut frame).map(|()| frame)
        }));
        let frame = read
            .map_err(|_| damaged(number, &"its coordinates do not unpack"))?
            .map_err(|error| damaged(number, &error))?;
        if frame.positions.len() != 3 * atoms {
            return Err(damaged(number, &"its coordinates do not unpack"));
        }
        let places = frame.positions.iter().map(|&x| f64::from(x) * ANGSTROM);
        all.numbers.extend(places);
    }
    Ok(all)
}

/// Number of atoms of the frame that begins here; `None` where none does, or where it could not be whole: packed
/// coordinates take a byte an atom at least.
fn atoms_of_xtc(rest: &[u8]) -> Option<usize> {
    let word = |at: usize| Some(u32::from_be_bytes(rest.get(at..at + 4)?.try_into().ok()?));
    let atoms = word(4)?;
    let said_twice = word(XTC_HEADER - 4)? == atoms;
    // The number of packed bytes stands behind the header, the precision, six bounds and an index.
    // Files of 2023 have it in eight bytes.
    let packed = match (atoms > 9, word(0)?) {
        (false, _) => 0,
        (true, 1995) => word(XTC_PACKED)?,
        (true, _) => word(XTC_PACKED)?.max(word(XTC_PACKED + 4)?),
    };
    let whole = (atoms as usize) < rest.len() && (packed as usize) < rest.len();
    (matches!(word(0)?, 1995 | 2023) && said_twice && whole && atoms > 0).then_some(atoms as usize)
}

fn damaged(frame: usize, what: &dyn std::fmt::Display) -> Flaw {
    Flaw::new(
        format!("a frame that cannot be read, number {frame}: {what}"),
        "whole frames",
    )
}

/// Every frame has as many coordinates as the first.
fn check_atoms(frame: usize, columns: usize, all: &mut Coordinates) -> Parsed<()> {
    if frame == 1 {
        all.columns = columns;
    }
    if columns != all.columns {
        return Err(Flaw::new(
            format!("{} atoms in frame {frame}", columns / 3),
            format!("{}, as in the first", all.columns / 3),
        ));
    }
    Ok(())
}

/// Records of Fortran: a length, the content, the length again, in either byte order.
struct Records<'a> {
    rest: &'a [u8],
    big: bool,
}

impl<'a> Records<'a> {
    fn word(&self, bytes: &[u8]) -> u32 {
        let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
        if self.big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        }
    }

    fn next(&mut self, what: &str) -> Parsed<&'a [u8]> {
        let flaw = || Flaw::new(format!("{what} that is cut off"), "a whole .dcd file");
        let length = self.word(self.rest.get(..4).ok_or_else(flaw)?) as usize;
        let content = self.rest.get(4..4 + length).ok_or_else(flaw)?;
        let again = self.rest.get(4 + length..8 + length).ok_or_else(flaw)?;
        if self.word(again) as usize != length {
            return Err(Flaw::new(
                format!("{what} with two lengths"),
                "a whole .dcd file with markers of 32 bits",
            ));
        }
        self.rest = &self.rest[8 + length..];
        Ok(content)
    }

    fn floats(&mut self, what: &str, count: usize) -> Parsed<impl Iterator<Item = f64> + use<'a>> {
        let content = self.next(what)?;
        if content.len() != 4 * count {
            return Err(Flaw::new(
                format!("{} bytes in {what}", content.len()),
                format!("{}, four for each of {count} atoms", 4 * count),
            ));
        }
        let big = self.big;
        Ok(content.as_chunks::<4>().0.iter().map(move |&x| {
            f64::from(if big {
                f32::from_be_bytes(x)
            } else {
                f32::from_le_bytes(x)
            })
        }))
    }
}

/// Reads the frames of a `.dcd`, in its own unit (Angstrom).
pub(crate) fn parse_dcd(bytes: &[u8]) -> Parsed<Coordinates> {
    let big = bytes.starts_with(&84_u32.to_be_bytes());
    let mut records = Records { rest: bytes, big };
    let header = records.next("the header").ok();
    let header = header.filter(|h| h.len() == 84 && h.starts_with(b"CORD"));
    let header = header.ok_or_else(|| {
        Flaw::new(
            "something else",
            "a trajectory of CHARMM, NAMD or X-PLOR, whose first record is CORD",
        )
    })?;
    let control = |k: usize| records.word(&header[4 + 4 * k..8 + 4 * k]);
    // Only CHARMM has a cell or a fourth coordinate; it says its version last.
    let charmm = control(19) != 0;
    let (cell, fourth) = (charmm && control(10) != 0, charmm && control(11) != 0);
    let fixed = control(8);
    if fixed != 0 {
        return Err(Flaw::new(
            format!("{fixed} fixed atoms, which stand in the first frame alone"),
            "frames of all atoms: write the trajectory anew (mdconvert, VMD)",
        ));
    }
    records.next("the title")?;
    let count = records.next("the number of atoms")?;
    let atoms = match count.len() {
        4 => records.word(count) as usize,
        _ => 0,
    };
    let mut all = Coordinates {
        columns: 3 * atoms,
        numbers: Vec::new(),
    };
    if atoms == 0 {
        return Err(Flaw::new("no atom", "at least one"));
    }
    let mut number = 0;
    while !records.rest.is_empty() {
        number += 1;
        if cell {
            records.next("the cell of a frame")?;
        }
        let axes = ["x", "y", "z"].map(|axis| format!("{axis} of frame {number}"));
        let [x, y, z] = [&axes[0], &axes[1], &axes[2]].map(|axis| records.floats(axis, atoms));
        for ((x, y), z) in x?.zip(y?).zip(z?) {
            all.numbers.extend([x, y, z]);
        }
        if fourth {
            records.next("the fourth coordinate of a frame")?;
        }
    }
    if number == 0 {
        return Err(Flaw::new("no frame", "at least one"));
    }
    Ok(all)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use molly::XTCWriter;

    /// Frame `k` of so many atoms, in Angstrom, on the grid of .xtc.
    fn place(frame: usize, atom: usize) -> [f64; 3] {
        let x = (7 * frame + 3 * atom) % 50;
        [x as f64 / 10.0, atom as f64 / 5.0, -(frame as f64)]
    }

    pub(crate) fn xtc(frames: usize, atoms: usize) -> Vec<u8> {
        let mut writer = XTCWriter::new(Vec::new());
        for frame in 0..frames {
            let places = (0..atoms).flat_map(|atom| place(frame, atom));
            let frame = Frame {
                step: frame as u32,
                time: frame as f32,
                boxvec: [5.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 5.0],
                precision: 1000.0,
                positions: places.map(|x| (x / ANGSTROM) as f32).collect(),
            };
            writer.write_frame(&frame).unwrap();
        }
        writer.file
    }

    fn record(out: &mut Vec<u8>, content: &[u8], big: bool) {
        let length = content.len() as u32;
        let mark = if big {
            length.to_be_bytes()
        } else {
            length.to_le_bytes()
        };
        out.extend(mark);
        out.extend(content);
        out.extend(mark);
    }

    pub(crate) fn dcd(frames: usize, atoms: usize, big: bool, cell: bool) -> Vec<u8> {
        let word = |x: u32| {
            if big {
                x.to_be_bytes()
            } else {
                x.to_le_bytes()
            }
        };
        let mut header = b"CORD".to_vec();
        for k in 0..20 {
            header.extend(word(match k {
                0 => frames as u32,
                10 => u32::from(cell),
                19 => 24,
                _ => 0,
            }));
        }
        let mut out = Vec::new();
        record(&mut out, &header, big);
        record(&mut out, &[&word(1)[..], &[b' '; 80]].concat(), big);
        record(&mut out, &word(atoms as u32), big);
        for frame in 0..frames {
            if cell {
                record(&mut out, &[0; 48], big);
            }
            for axis in 0..3 {
                let numbers = (0..atoms).flat_map(|atom| {
                    let bits = (place(frame, atom)[axis] as f32).to_bits();
                    word(bits)
                });
                record(&mut out, &numbers.collect::<Vec<_>>(), big);
            }
        }
        out
    }

    fn expected(frames: usize, atoms: usize) -> Vec<f64> {
        let all = (0..frames).flat_map(|f| (0..atoms).map(move |a| (f, a)));
        all.flat_map(|(f, a)| place(f, a)).collect()
    }

    #[test]
    fn frames_come_back() {
        // Up to nine atoms .xtc does not pack.
        for atoms in [1, 9, 10, 300] {
            let mut all = vec![parse_xtc(&xtc(4, atoms)).unwrap()];
            for (big, cell) in [(false, false), (true, false), (false, true)] {
                all.push(parse_dcd(&dcd(4, atoms, big, cell)).unwrap());
            }
            for found in all {
                assert_eq!(found.columns, 3 * atoms);
                let wrong = found.numbers.iter().zip(expected(4, atoms));
                assert!(
                    wrong.clone().all(|(x, y)| (x - y).abs() < 1e-5),
                    "{wrong:?}"
                );
                assert_eq!(found.numbers.len(), 12 * atoms);
            }
        }
    }

    #[test]
    fn what_is_cut_or_lies_is_refused() {
        let (x, d) = (xtc(3, 40), dcd(3, 40, false, true));
        for cut in 1..60 {
            assert!(parse_xtc(&x[..x.len() - cut]).is_err(), "{cut}");
            assert!(parse_dcd(&d[..d.len() - cut]).is_err(), "{cut}");
        }
        for at in 0..d.len().min(300) {
            let mut broken = d.clone();
            broken[at] ^= 0x5a;
            // Any answer but a panic.
            let _ = parse_dcd(&broken);
        }
        for at in 0..x.len().min(300) {
            let mut broken = x.clone();
            broken[at] ^= 0x5a;
            let _ = parse_xtc(&broken);
        }
        let mut many = x.clone();
        many[4..8].copy_from_slice(&u32::MAX.to_be_bytes());
        many[52..56].copy_from_slice(&u32::MAX.to_be_bytes());
        assert!(parse_xtc(&many).unwrap_err().found.contains("number 1"));
        let mixed = [xtc(1, 40), xtc(1, 41)].concat();
        assert!(parse_xtc(&mixed).unwrap_err().expected.contains("40"));
        assert!(parse_dcd(b"CORD").is_err() && parse_xtc(b"\0\0\x07\xcb").is_err());
    }
}
