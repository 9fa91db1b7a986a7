//! Conformations of a molecule: chemical `.xyz` and `.pdb`.
//!
//! Every frame is one point: the coordinates of its atoms one after the other, three an atom.

use super::error::{Flaw, Parsed, excerpt};
use super::table::{Table, number, text};

/// Frames with the same atoms in the same order.
#[derive(Default)]
struct Frames {
    elements: Vec<String>,
    numbers: Vec<f64>,
    frames: usize,
    /// Atoms seen in the current frame.
    atoms: usize,
}

impl Frames {
    fn atom(&mut self, line: usize, element: &str, place: [f64; 3]) -> Parsed<()> {
        if self.frames == 0 {
            self.elements.push(element.into());
        } else if self.elements.get(self.atoms).map(String::as_str) != Some(element) {
            let expected = match self.elements.get(self.atoms) {
                Some(known) => format!("{known} as in the first frame"),
                None => format!(
                    "the end of the frame after {} atoms as in the first",
                    self.elements.len()
                ),
            };
            return Err(Flaw::line(
                line,
                format!("{} as atom {}", excerpt(element), self.atoms + 1),
                expected,
            ));
        }
        self.numbers.extend(place);
        self.atoms += 1;
        Ok(())
    }

    fn end(&mut self, line: usize) -> Parsed<()> {
        if self.atoms == 0 {
            return Ok(());
        }
        if self.atoms != self.elements.len() {
            return Err(Flaw::line(
                line,
                format!("a frame of {} atoms", self.atoms),
                format!("{} as in the first", self.elements.len()),
            ));
        }
        self.frames += 1;
        self.atoms = 0;
        Ok(())
    }

    fn into_table(self) -> Parsed<Table> {
        if self.frames == 0 {
            return Err(Flaw::new("no frame with an atom", "at least one"));
        }
        Ok(Table {
            columns: 3 * self.elements.len(),
            numbers: self.numbers,
        })
    }
}

/// Whether a text starts as chemical `.xyz` does: a line with the number of atoms, alone.
pub(crate) fn is_chemical(bytes: &[u8]) -> bool {
    text(bytes).is_ok_and(|text| {
        text.lines()
            .map(str::trim)
            .find(|line| !line.is_empty())
            .is_some_and(|line| line.parse::<usize>().is_ok())
    })
}

/// Reads frames of a count line, a comment, and lines `element x y z`.
pub(crate) fn parse_xyz(bytes: &[u8]) -> Parsed<Table> {
    let mut lines = text(bytes)?.lines().enumerate().map(|(at, l)| (at + 1, l));
    let mut frames = Frames::default();
    while let Some((line, first)) = lines.next() {
        if first.trim().is_empty() {
            continue;
        }
        let count: usize = first
            .trim()
            .parse()
            .ok()
            .filter(|&count| count > 0)
            .ok_or_else(|| Flaw::line(line, excerpt(first), "the number of atoms of a frame"))?;
        let truncated = |line: usize, atoms: usize| {
            Flaw::line(
                line,
                format!("the end of the file after {atoms} atoms"),
                format!("{count} atoms"),
            )
        };
        let mut last = line;
        if lines.next().is_none() {
            return Err(truncated(last, 0));
        }
        for atom in 0..count {
            let Some((line, row)) = lines.next() else {
                return Err(truncated(last, atom));
            };
            last = line;
            let mut fields = row.split_whitespace();
            let Some(element) = fields.next() else {
                return Err(Flaw::line(line, "an empty line", "element x y z"));
            };
            let mut place = [0.0; 3];
            for (k, x) in place.iter_mut().enumerate() {
                let field = fields.next().ok_or_else(|| {
                    Flaw::line(line, format!("{} fields", k + 1), "element x y z")
                })?;
                *x = number(field, line, k + 2)?;
            }
            frames.atom(line, element, place)?;
        }
        frames.end(last)?;
    }
    frames.into_table()
}

/// Reads the ATOM and HETATM records of every MODEL.
pub(crate) fn parse_pdb(bytes: &[u8]) -> Parsed<Table> {
    let mut frames = Frames::default();
    let mut last = 0;
    for (at, row) in text(bytes)?.lines().enumerate() {
        let line = at + 1;
        last = line;
        match row.get(..6).unwrap_or(row).trim_end() {
            "MODEL" | "ENDMDL" | "END" => frames.end(line)?,
            "ATOM" | "HETATM" => {
                let mut place = [0.0; 3];
                for (k, x) in place.iter_mut().enumerate() {
                    let from = 30 + 8 * k;
                    let field = row.get(from..from + 8).ok_or_else(|| {
                        Flaw::line(
                            line,
                            format!("a record of {} characters", row.len()),
                            "x, y, z in the characters 31 to 54",
                        )
                    })?;
                    *x = number(field.trim(), line, from + 1)?;
                }
                frames.atom(line, row.get(12..16).unwrap_or("").trim(), place)?;
            }
            _ => {}
        }
    }
    frames.end(last)?;
    frames.into_table()
}

#[cfg(test)]
mod tests {
    use super::*;

    const XYZ: &str = "2\nfirst\nC 0 0 1\nH 1 2 3\n2\n\nC 4 5 6\nH 7 8 9e0\n\n";

    fn atom(name: &str, x: f64) -> String {
        format!(
            "ATOM      1 {name:<4} MOL A   1    {x:8.3}{:8.3}{:8.3}  1.00\n",
            2.0, 3.0
        )
    }

    #[test]
    fn a_frame_is_a_point() {
        assert!(is_chemical(XYZ.as_bytes()) && !is_chemical(b"1 2 3\n"));
        let table = parse_xyz(XYZ.as_bytes()).unwrap();
        assert_eq!(table.columns, 6);
        assert_eq!(table.numbers[6..], [4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    }

    #[test]
    fn models_are_points() {
        let (c, h) = (atom("C1", 1.5), atom("H1", -4.25));
        let pdb = format!("REMARK x\nMODEL 1\n{c}{h}ENDMDL\nMODEL 2\n{h}{c}ENDMDL\nEND\n");
        assert!(
            parse_pdb(pdb.as_bytes())
                .unwrap_err()
                .expected
                .contains("C1 as in")
        );
        let pdb = format!("MODEL 1\n{c}{h}TER\nENDMDL\nMODEL 2\n{c}{h}ENDMDL\nEND\n");
        let table = parse_pdb(pdb.as_bytes()).unwrap();
        assert_eq!(table.columns, 6);
        assert_eq!(table.numbers[..4], [1.5, 2.0, 3.0, -4.25]);
        assert_eq!(table.numbers.len(), 12);
    }

    #[test]
    fn refuses_frames_that_differ_and_truncation() {
        for bad in [
            "2\n\nC 0 0 1\n",
            "1\n\nC 0 0 1\n2\n\nC 0 0 1\nC 0 0 2\n",
            "1\n\nC 0 0\n",
            "1\n\nC 0 0 nan\n",
            "1\n\nC 0 0 1\nx\n",
            "1\n\nC 0 0 1\n1\n\nN 0 0 1\n",
            "1",
            "0\n\n",
            "99999999999999\n\nC 0 0 1\n",
        ] {
            assert!(parse_xyz(bad.as_bytes()).is_err(), "{bad:?}");
        }
        let (c, h) = (atom("C1", 1.5), atom("H1", 2.0));
        for bad in [
            format!("MODEL 1\n{c}{h}ENDMDL\nMODEL 2\n{c}ENDMDL\n"),
            c[..50].to_string(),
            "END\n".into(),
        ] {
            assert!(parse_pdb(bad.as_bytes()).is_err(), "{bad:?}");
        }
    }
}
