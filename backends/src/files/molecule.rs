//! Conformations of a molecule: chemical `.xyz` and `.pdb`.
//!
//! Every frame is one point: the coordinates of its atoms one after the other, three an atom.

use super::error::{FileError, Flaw};
use super::frames::{Atom, Coordinates, frames_of_pdb, frames_of_xyz, is_chemical};
use super::points::{PointOptions, read_points};
use super::whole::{packed_extension, read_bytes};
use crosscap_core::PointCloud;
use std::path::Path;

/// Frames with the same atoms in the same order.
#[derive(Clone, Debug, PartialEq)]
pub struct Molecule {
    /// The atoms.
    pub atoms: Vec<Atom>,
    /// The frames, 3 coordinates an atom: x, y, z of the first, of the second, ..; the unit of the file (Angstrom).
    pub frames: PointCloud<f64>,
}

impl Molecule {
    /// The same frames with the atoms of a topology: another file of the same molecule that names them.
    ///
    /// # Errors
    /// A sentence with both numbers, where the topology has another number of atoms.
    pub fn with_atoms(self, topology: &Self) -> Result<Self, String> {
        let (found, expected) = (topology.atoms.len(), self.atoms.len());
        if found != expected {
            return Err(format!(
                "found {found} atoms, expected {expected}, as many as the trajectory has"
            ));
        }
        Ok(Self {
            atoms: topology.atoms.clone(),
            frames: self.frames,
        })
    }

    /// Some atoms of every frame, in the given order.
    ///
    /// # Panics
    /// When there is no such atom.
    pub fn select(&self, atoms: &[usize]) -> Self {
        let rows = self.frames.iter();
        let some = rows.flat_map(|p| {
            atoms
                .iter()
                .flat_map(|&a| [p[3 * a], p[3 * a + 1], p[3 * a + 2]])
        });
        Self {
            atoms: atoms.iter().map(|&a| self.atoms[a].clone()).collect(),
            frames: PointCloud::new(3 * atoms.len().max(1), some.collect())
                .expect("whole rows of finite numbers"),
        }
    }

    /// Numbers (from 0, increasing, each once) of the atoms that a text names: items between commas, each of them
    ///
    /// | item | atoms |
    /// | --- | --- |
    /// | `5`, `1-8` | by their place in the file, counted from 1 |
    /// | `CA` | by name, as the file has it |
    /// | `element:C` | by element |
    /// | `heavy` | all but hydrogen |
    /// | `all` | all |
    ///
    /// # Errors
    /// A sentence that names the item which is no such thing, or which no atom is.
    ///
    /// ```
    /// use crosscap_backends::files::{Atom, Molecule};
    /// use crosscap_core::PointCloud;
    /// let atom = |name: &str, element: &str| Atom { name: name.into(), element: element.into() };
    /// let molecule = Molecule {
    ///     atoms: vec![atom("CA", "C"), atom("HA", "H"), atom("N", "N")],
    ///     frames: PointCloud::new(9, vec![0.0; 9]).unwrap(),
    /// };
    /// assert_eq!(molecule.chosen("heavy").unwrap(), [0, 2]);
    /// assert_eq!(molecule.chosen("2-3,CA").unwrap(), [0, 1, 2]);
    /// assert_eq!(molecule.chosen("element:H").unwrap(), [1]);
    /// assert!(molecule.chosen("4").unwrap_err().contains("expected 1 to 3"));
    /// ```
    pub fn chosen(&self, text: &str) -> Result<Vec<usize>, String> {
        let count = self.atoms.len();
        let mut chosen = vec![false; count];
        for item in text.split(',').map(str::trim) {
            let range = match item.split_once('-') {
                Some((from, to)) => from.trim().parse().ok().zip(to.trim().parse().ok()),
                None => item.parse().ok().map(|one: usize| (one, one)),
            };
            if let Some((from, to)) = range {
                if from < 1 || to > count || from > to {
                    return Err(format!(
                        "found atoms {item:?}, expected 1 to {count}, the smaller number first"
                    ));
                }
                chosen[from - 1..to].fill(true);
                continue;
            }
            let hydrogen = |a: &Atom| matches!(a.element.as_str(), "H" | "D");
            let is_meant = |a: &Atom| match item.split_once(':') {
                Some(("element", symbol)) => a.element.eq_ignore_ascii_case(symbol.trim()),
                _ => a.name == item || item == "all" || (item == "heavy" && !hydrogen(a)),
            };
            let mut any = false;
            for (a, chosen) in self.atoms.iter().zip(&mut chosen) {
                let meant = !item.is_empty() && is_meant(a);
                *chosen |= meant;
                any |= meant;
            }
            if !any {
                let mut names: Vec<&str> = self.atoms.iter().map(|a| a.name.as_str()).collect();
                names.sort_unstable();
                names.dedup();
                names.truncate(12);
                return Err(format!(
                    "found {item:?}, which no atom is called; expected numbers (1-{count}), names ({}), \
                     element:SYMBOL, heavy or all",
                    names.join(", ")
                ));
            }
        }
        Ok((0..count).filter(|&a| chosen[a]).collect())
    }
}

/// Reads the frames of a molecule with its atoms: chemical `.xyz`, `.pdb`; or, from any other format of points, rows
/// of three coordinates an atom, the atoms then without a name.
///
/// # Errors
/// Those of [`read_points`]; [`FileError::Content`] when the rows of a table are not of three coordinates an atom.
///
/// ```
/// use crosscap_backends::files::{PointOptions, read_molecule};
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("water.xyz");
/// std::fs::write(&path, "3\nwater\nO 0 0 0.12\nH 0 0.76 -0.47\nH 0 -0.76 -0.47\n").unwrap();
/// let water = read_molecule(&path, &PointOptions::default()).unwrap();
/// assert_eq!((water.frames.len(), water.frames.dimension()), (1, 9));
/// assert_eq!(water.atoms[0].mass(), Some(15.999));
/// ```
pub fn read_molecule(
    path: impl AsRef<Path>,
    options: &PointOptions,
) -> Result<Molecule, FileError> {
    let path = path.as_ref();
    let extension = packed_extension(path);
    let frames = match extension.as_str() {
        "pdb" => Some(frames_of_pdb(&read_bytes(path)?)),
        "xyz" => {
            let bytes = read_bytes(path)?;
            is_chemical(&bytes).then(|| frames_of_xyz(&bytes))
        }
        _ => None,
    };
    let Some(frames) = frames else {
        let frames = read_points(path, options)?.into_f64();
        if !frames.dimension().is_multiple_of(3) {
            let flaw = Flaw::new(
                format!("points of R^{}", frames.dimension()),
                "three coordinates an atom",
            );
            return Err(flaw.of(path));
        }
        let atoms = vec![Atom::default(); frames.dimension() / 3];
        return Ok(Molecule { atoms, frames });
    };
    let molecule = || {
        let frames = frames?;
        if options.transpose || options.array.is_some() {
            return Err(Flaw::new(
                "the option to transpose or to take an array",
                "none, as frames of a molecule are points",
            ));
        }
        let atoms = frames.atoms_of_all.clone();
        let Coordinates { columns, numbers } = frames.into_coordinates()?;
        Ok(Molecule {
            atoms,
            frames: super::any_cloud::points(columns, numbers)?,
        })
    };
    molecule().map_err(|flaw| flaw.of(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    const XYZ: &str = "2\nfirst\nC 0 0 1\nH 1 2 3\n2\n\nC 4 5 6\nH 7 8 9e0\n\n";

    #[test]
    fn atoms_are_chosen_by_number_name_and_element() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.xyz");
        std::fs::write(&path, XYZ).unwrap();
        let all = read_molecule(&path, &PointOptions::default()).unwrap();
        assert_eq!(all.frames.dimension(), 6);
        assert_eq!(all.chosen("all").unwrap(), [0, 1]);
        assert_eq!(all.chosen("heavy").unwrap(), [0]);
        assert_eq!(all.chosen(" H , 1").unwrap(), [0, 1]);
        for bad in ["", "0", "1-3", "2-1", "N", "element:N", "1,", "-1", "x-y"] {
            assert!(all.chosen(bad).is_err(), "{bad:?}");
        }
        let one = all.select(&[1]);
        assert_eq!(one.frames.coordinates(), &[1.0, 2.0, 3.0, 7.0, 8.0, 9.0]);
        assert_eq!(one.atoms[0].element, "H");
        let table = folder.path().join("a.csv");
        std::fs::write(&table, "1,2,3,4\n").unwrap();
        let error = read_molecule(&table, &PointOptions::default()).unwrap_err();
        assert!(
            error.to_string().contains("three coordinates an atom"),
            "{error}"
        );
    }
}
