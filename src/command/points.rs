//! How points are taken from a file that leaves a choice: arrays, and frames of a molecule.

use super::failure::Failure;
use super::terminal::complain;
use clap::{Args, ValueEnum};
use crosscap_algorithms::alignment::Alignment;
use crosscap_backends::files::{
    AnyCloud, Atom, Molecule, PointOptions, read_molecule, read_points,
};
use std::path::{Path, PathBuf};

/// A smallest margin that is worth a warning: beyond it the rotation swings by about twenty times the motion of an atom.
const NARROW_MARGIN: f64 = 0.05;

/// How the frames of a molecule are brought into one position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AlignName {
    /// Least squares over the atoms, all equal
    Kabsch,
    /// Least squares weighted by atomic mass: Eckart's conditions
    Eckart,
    /// As they stand in the file
    None,
}

#[derive(Args, Debug)]
pub struct PointArguments {
    /// Which array of a .npz of points, which variable of a .mat [default: points, vertices, or the only one]
    #[arg(long, value_name = "NAME")]
    array: Option<String>,

    /// The points are the columns of the array or table
    #[arg(long)]
    transpose: bool,

    /// Atoms of a molecule to take, in the order of the file: numbers from 1 (1-8,10), names (CA), element:C, heavy, all
    #[arg(long, value_name = "ATOMS")]
    atoms: Option<String>,

    /// Center every frame of a molecule and turn it next to a reference conformation [default: none, or kabsch with
    /// --reference]
    #[arg(long, value_name = "HOW", value_enum)]
    align: Option<AlignName>,

    /// The reference conformation: frame:K of the points, from 1, or a file whose first frame it is [default: frame:1]
    #[arg(long, value_name = "FRAME|FILE")]
    reference: Option<String>,
}

impl PointArguments {
    /// Reads the points.
    pub fn read(&self, path: &Path) -> Result<AnyCloud, Failure> {
        let options = PointOptions {
            array: self.array.clone(),
            transpose: self.transpose,
        };
        let align = match (self.align, &self.reference) {
            (Some(AlignName::None), Some(_)) => {
                return Err(Failure::usage(
                    "--reference is for frames that are aligned: leave it out, or --align none",
                ));
            }
            (None, Some(_)) => AlignName::Kabsch,
            (align, _) => align.unwrap_or(AlignName::None),
        };
        if self.atoms.is_none() && align == AlignName::None {
            return Ok(read_points(path, &options)?);
        }
        let molecule = self.chosen(read_molecule(path, &options)?, path)?;
        if align == AlignName::None {
            return Ok(AnyCloud::F64(molecule.frames));
        }
        let reference = self.reference_for(&molecule, path)?;
        let weights = match align {
            AlignName::Eckart => masses(&molecule.atoms, path)?,
            _ => vec![1.0; molecule.atoms.len()],
        };
        let of = |path: &Path, error: &dyn std::fmt::Display| {
            Failure::usage(format!("{}: {error}", path.display()))
        };
        let aligned = Alignment::new(&reference, &weights)
            .and_then(|alignment| alignment.align_all(&molecule.frames))
            .map_err(|error| of(path, &error))?;
        if aligned.margin < NARROW_MARGIN {
            complain(format!(
                "{}: the rotation of frame {} towards the reference is nearly undetermined (margin {:.1e} of 1), so \
                 frames like it may be torn apart: another --reference may do better",
                path.display(),
                aligned.row + 1,
                aligned.margin
            ));
        }
        Ok(AnyCloud::F64(aligned.points))
    }

    fn chosen(&self, molecule: Molecule, path: &Path) -> Result<Molecule, Failure> {
        match &self.atoms {
            None => Ok(molecule),
            Some(text) => {
                let chosen = molecule.chosen(text).map_err(|message| {
                    Failure::usage(format!("{}: --atoms {text}: {message}", path.display()))
                })?;
                Ok(molecule.select(&chosen))
            }
        }
    }

    /// The places of the reference conformation.
    fn reference_for(&self, molecule: &Molecule, path: &Path) -> Result<Vec<[f64; 3]>, Failure> {
        let places = |row: &[f64]| row.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let text = self.reference.as_deref().unwrap_or("frame:1");
        if let Some(number) = text.strip_prefix("frame:") {
            let count = molecule.frames.len();
            let found: Option<usize> = number.parse().ok().filter(|k| (1..=count).contains(k));
            let Some(number) = found else {
                return Err(Failure::usage(format!(
                    "--reference {text}: expected frame:1 to frame:{count}, as {} has {count} frames",
                    path.display()
                )));
            };
            return Ok(places(molecule.frames.point(number - 1)));
        }
        let file = PathBuf::from(text);
        let count = molecule.atoms.len();
        let given = match file.extension().and_then(|e| e.to_str()) {
            Some("pdb" | "xyz") => read_molecule(&file, &PointOptions::default())?,
            _ => {
                // One row an atom, or one row in all.
                let points = read_points(&file, &PointOptions::default())?.into_f64();
                if points.dimension() == 3 && points.len() == count {
                    return Ok(places(points.coordinates()));
                }
                let atoms = vec![Atom::default(); points.dimension() / 3];
                Molecule {
                    atoms,
                    frames: points,
                }
            }
        };
        // A reference of all atoms is thinned as the frames are; one of the chosen atoms is taken as it is.
        let given = if given.atoms.len() == count {
            given
        } else {
            self.chosen(given, &file)?
        };
        if given.frames.dimension() != 3 * count {
            return Err(Failure::usage(format!(
                "{}: found {} coordinates in a frame, expected {}, three for each of {count} atoms",
                file.display(),
                given.frames.dimension(),
                3 * count
            )));
        }
        Ok(places(given.frames.point(0)))
    }
}

/// Masses of atoms.
fn masses(atoms: &[Atom], path: &Path) -> Result<Vec<f64>, Failure> {
    let mass = |(k, atom): (usize, &Atom)| {
        atom.mass().ok_or_else(|| {
            Failure::usage(format!(
                "{}: found {:?} for the element of atom {} ({:?}), expected one with a mass: --align kabsch \
                 needs none",
                path.display(),
                atom.element,
                k + 1,
                atom.name
            ))
        })
    };
    atoms.iter().enumerate().map(mass).collect()
}
