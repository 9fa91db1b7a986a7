//! Frames of a molecule, atom by atom: chemical `.xyz` and `.pdb`.

use super::error::{Flaw, Parsed, excerpt};
use super::table::{number, text};
use mendeleev::Element;

/// An atom of a molecule as its file calls it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Atom {
    /// The label of `.xyz` (mostly the element), the atom name of `.pdb` (`CA`, `HB2`); empty when the
    /// coordinates came from a table.
    pub name: String,
    /// Symbol of the chemical element, empty when it cannot be told.
    pub element: String,
}

impl Atom {
    /// Standard atomic weight of the element (the conventional value of the IUPAC commission, daltons), by the crate
    /// `mendeleev`; `None` when the element is not known.
    pub fn mass(&self) -> Option<f64> {
        Element::iter()
            .find(|e| e.symbol() == self.element)
            .map(|e| f64::from(e.atomic_weight()))
    }
}

/// Coordinates of the atoms, a row a frame.
#[derive(Debug)]
pub(crate) struct Coordinates {
    pub(crate) columns: usize,
    pub(crate) numbers: Vec<f64>,
}

/// Frames with the same atoms in the same order.
#[derive(Default)]
pub(crate) struct Frames {
    pub(crate) atoms_of_all: Vec<Atom>,
    numbers: Vec<f64>,
    frames: usize,
    /// Atoms seen in the current frame.
    atoms: usize,
}

impl Frames {
    fn atom(
        &mut self,
        line: usize,
        name: &str,
        element: impl FnOnce() -> String,
        place: [f64; 3],
    ) -> Parsed<()> {
        if self.frames == 0 {
            self.atoms_of_all.push(Atom {
                name: name.into(),
                element: element(),
            });
        } else if self.atoms_of_all.get(self.atoms).map(|a| a.name.as_str()) != Some(name) {
            let expected = match self.atoms_of_all.get(self.atoms) {
                Some(known) => format!("{} as in the first frame", known.name),
                None => format!(
                    "the end of the frame after {} atoms as in the first",
                    self.atoms_of_all.len()
                ),
            };
            return Err(Flaw::line(
                line,
                format!("{} as atom {}", excerpt(name), self.atoms + 1),
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
        if self.atoms != self.atoms_of_all.len() {
            return Err(Flaw::line(
                line,
                format!("a frame of {} atoms", self.atoms),
                format!("{} as in the first", self.atoms_of_all.len()),
            ));
        }
        self.frames += 1;
        self.atoms = 0;
        Ok(())
    }

    /// The frames without their atoms.
    pub(crate) fn into_coordinates(self) -> Parsed<Coordinates> {
        if self.frames == 0 {
            return Err(Flaw::new("no frame with an atom", "at least one"));
        }
        Ok(Coordinates {
            columns: 3 * self.atoms_of_all.len(),
            numbers: self.numbers,
        })
    }
}

/// The symbol of an element as tables have it, empty for what is none.
fn symbol(text: &str) -> String {
    let known = |s: &str| Element::iter().find(|e| e.symbol().eq_ignore_ascii_case(s));
    match known(text) {
        Some(element) => element.symbol().into(),
        // Heavy hydrogen has a symbol of its own in many files.
        None if text.eq_ignore_ascii_case("D") => "H".into(),
        None => String::new(),
    }
}

/// The element of a label of `.xyz`: a symbol, perhaps with a number behind it, or an atomic number.
fn element_of_label(label: &str) -> String {
    if let Ok(number) = label.parse::<usize>() {
        let element = number.checked_sub(1).and_then(|k| Element::iter().nth(k));
        return element.map_or_else(String::new, |e| e.symbol().into());
    }
    let letters = label.find(|c: char| !c.is_ascii_alphabetic());
    symbol(&label[..letters.unwrap_or(label.len())])
}

/// The element of a record of `.pdb`: characters 77 and 78, or else the atom name, whose first two characters are the
/// symbol, to the right.
fn element_of_record(row: &str) -> String {
    let given = symbol(row.get(76..78).unwrap_or("").trim());
    if !given.is_empty() {
        return given;
    }
    let name = row.get(12..16).unwrap_or("");
    let letters: String = name.chars().filter(char::is_ascii_alphabetic).collect();
    let first = symbol(letters.get(..1).unwrap_or(""));
    let to_the_left = name.starts_with(|c: char| c.is_ascii_alphabetic());
    // Four characters that begin with H are a hydrogen with a long name.
    if to_the_left && !(first == "H" && name.trim().len() == 4) {
        let both = symbol(letters.get(..2).unwrap_or(""));
        if !both.is_empty() {
            return both;
        }
    }
    first
}

/// Whether a text starts as chemical `.xyz` does: a line with the number of atoms, alone; and is
/// not a table behind a line with the number of its rows.
pub(crate) fn is_chemical(bytes: &[u8]) -> bool {
    let Ok(text) = text(bytes) else { return false };
    let mut rows = text.lines().map(str::trim).skip_while(|l| l.is_empty());
    let Some(count) = rows.next().and_then(|l| l.parse::<usize>().ok()) else {
        return false;
    };
    // Numbers in as many columns right behind the count, and no row more than was promised: a table.
    // Frames have a line of comment, often a blank one, before their atoms.
    let numbers = |row: Option<&str>| {
        let fields: Vec<&str> = row?.split_whitespace().collect();
        let all = fields.len() >= 2 && fields.iter().all(|f| f.parse::<f64>().is_ok());
        all.then_some(fields.len())
    };
    let first = numbers(rows.next());
    let alike = first.is_some() && (count < 2 || numbers(rows.clone().next()) == first);
    !(alike && rows.filter(|l| !l.is_empty()).count() + 1 == count)
}

/// Reads frames of a count line, a comment, and lines `element x y z`.
pub(crate) fn parse_xyz(bytes: &[u8]) -> Parsed<Coordinates> {
    frames_of_xyz(bytes)?.into_coordinates()
}

/// The frames of a chemical `.xyz`.
pub(crate) fn frames_of_xyz(bytes: &[u8]) -> Parsed<Frames> {
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
            frames.atom(line, element, || element_of_label(element), place)?;
        }
        frames.end(last)?;
    }
    Ok(frames)
}

/// Reads the ATOM and HETATM records of every MODEL.
pub(crate) fn parse_pdb(bytes: &[u8]) -> Parsed<Coordinates> {
    frames_of_pdb(bytes)?.into_coordinates()
}

/// The frames of a `.pdb`.
pub(crate) fn frames_of_pdb(bytes: &[u8]) -> Parsed<Frames> {
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
                let name = row.get(12..16).unwrap_or("").trim();
                frames.atom(line, name, || element_of_record(row), place)?;
            }
            _ => {}
        }
    }
    frames.end(last)?;
    Ok(frames)
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
    fn elements_are_told_from_names() {
        for (label, element) in [
            ("C", "C"),
            ("c1", "C"),
            ("CL", "Cl"),
            ("6", "C"),
            ("H12", "H"),
            ("D", "H"),
            ("X", ""),
            ("0", ""),
            ("999", ""),
            ("", ""),
        ] {
            assert_eq!(element_of_label(label), element, "{label:?}");
        }
        for (name, field, element) in [
            (" CA ", "", "C"),
            ("CA  ", "", "Ca"),
            ("HG11", "", "H"),
            ("1HB ", "", "H"),
            (" N  ", "N", "N"),
            ("CA  ", " C", "C"),
            ("FE  ", "", "Fe"),
            (" XX ", "", ""),
            ("    ", "", ""),
        ] {
            let row = format!("{:12}{name}{:60}{field:2}", "ATOM", "");
            assert_eq!(element_of_record(&row), element, "{row:?}");
        }
        let carbon = Atom {
            name: "CA".into(),
            element: "C".into(),
        };
        assert_eq!(carbon.mass(), Some(12.011));
        assert_eq!(Atom::default().mass(), None);
    }

    #[test]
    fn a_count_before_a_table_makes_no_molecule() {
        for (text, chemical) in [
            ("2\n1 2 3\n4 5 6\n", false),
            ("2\n6 1 2 3\n6 4 5 6\n", false),
            ("2\n\n6 1 2 3\n6 4 5 6\n", true),
            ("2\nwater\nO 1 2 3\nH 4 5 6\n", true),
            ("2\n0.5 7\nO 1 2 3\nH 4 5 6\n", true),
            ("2\n1 2 3\n4 5 6\n7 8 9\n", true),
            ("1 2\n3 4\n", false),
        ] {
            assert_eq!(is_chemical(text.as_bytes()), chemical, "{text:?}");
        }
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
