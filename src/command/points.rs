//! How points are taken from a file that leaves a choice: arrays, and frames of a molecule.

use super::failure::Failure;
use super::terminal::complain;
use clap::{Args, ValueEnum};
use crosscap_algorithms::alignment::Alignment;
use crosscap_backends::files::{
    AnyCloud, Atom, ColumnChoice, Molecule, PointOptions, read_molecule, read_point_file,
    read_points,
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
#[command(next_help_heading = "Reading points")]
pub struct PointArguments {
    /// Which array of a .npz of points, which variable of a .mat [default: points, vertices, or the only one]
    #[arg(long, hide_short_help = true, value_name = "NAME")]
    array: Option<String>,

    /// The points are the columns of the array or table
    #[arg(long, hide_short_help = true)]
    transpose: bool,

    /// Columns that are coordinates: numbers from 0 (0,1,2 or 0-2), names (x,y,z), or all [default: x, y, z where the
    /// file names them; else all, without the normals and colors of an .xyz, .asc or .pts]
    #[arg(long, hide_short_help = true, value_name = "COLUMNS")]
    columns: Option<ColumnChoice>,

    /// Atoms of a molecule to take, in the order of the file: numbers from 1 (1-8,10), names (CA), element:C, heavy, all
    #[arg(long, hide_short_help = true, value_name = "ATOMS")]
    atoms: Option<String>,

    /// Names of the atoms of a trajectory that has none (.xtc, .dcd): .pdb or .xyz with as many atoms
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    topology: Option<PathBuf>,

    /// Center every frame of a molecule and turn it next to a reference conformation [default: none, or kabsch with
    /// --reference]
    #[arg(long, hide_short_help = true, value_name = "HOW", value_enum)]
    align: Option<AlignName>,

    /// The reference conformation: frame:K of the points, from 1, or a file whose first frame it is [default: frame:1]
    #[arg(long, hide_short_help = true, value_name = "FRAME|FILE")]
    reference: Option<String>,
}

impl PointArguments {
    /// Whether the points are taken as they stand in their file.
    pub fn is_plain(&self) -> bool {
        let chosen = self.columns.is_some() || self.atoms.is_some() || self.topology.is_some();
        let aligned = self.align.is_some() || self.reference.is_some();
        !(self.array.is_some() || self.transpose || chosen || aligned)
    }

    /// Reads the points.
    pub fn read(&self, path: &Path) -> Result<AnyCloud, Failure> {
        let options = PointOptions {
            array: self.array.clone(),
            transpose: self.transpose,
            columns: self.columns.clone().unwrap_or_default(),
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
        if self.atoms.is_none() && self.topology.is_none() && align == AlignName::None {
            let file = read_point_file(path, &options)?;
            for remark in &file.remarks {
                complain(format!("{}: {remark}", path.display()));
            }
            return Ok(file.points);
        }
        let molecule = self.named(read_molecule(path, &options)?)?;
        let molecule = self.chosen(molecule, path)?;
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

    /// With the atoms of the topology, where one is given.
    fn named(&self, molecule: Molecule) -> Result<Molecule, Failure> {
        let Some(path) = &self.topology else {
            return Ok(molecule);
        };
        let topology = read_molecule(path, &PointOptions::default())?;
        molecule
            .with_atoms(&topology)
            .map_err(|message| Failure::usage(format!("{}: {message}", path.display())))
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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use crosscap_algorithms::surfaces::{Random, RingConformations};
    use crosscap_core::PointCloud;

    #[derive(Parser)]
    struct Only {
        #[command(flatten)]
        points: PointArguments,
    }

    /// The points of a file, with the arguments between white space.
    fn read(arguments: &str, path: &Path) -> PointCloud<f64> {
        let words = std::iter::once("read").chain(arguments.split_whitespace());
        let points = Only::try_parse_from(words).unwrap().points;
        points.read(path).unwrap().into_f64()
    }

    /// Conformations with a hydrogen outside of each carbon, every frame turned and carried away: `.xyz` and `.pdb`.
    fn trajectories(conformations: &PointCloud<f64>) -> [String; 2] {
        let (mut xyz, mut pdb) = (String::new(), String::new());
        let mut random = Random::new(3);
        for (k, p) in conformations.iter().enumerate() {
            let turn = nalgebra::Vector3::from([0; 3].map(|_| random.between(-2.0, 2.0)));
            let turn = nalgebra::Rotation3::new(turn);
            let shift = nalgebra::Vector3::from([0; 3].map(|_| random.between(-20.0, 20.0)));
            xyz += &format!("16\nframe {k}\n");
            pdb += &format!("MODEL     {:>4}\n", k + 1);
            for atom in 0..8 {
                for (element, stretch) in [("C", 1.0), ("H", 1.4)] {
                    let place = nalgebra::Vector3::from_column_slice(&p[3 * atom..3 * atom + 3]);
                    // Hydrogens lean to one side, so that masses matter.
                    let lean =
                        nalgebra::Vector3::new(0.0, 0.0, 0.3 * (stretch - 1.0) * atom as f64);
                    let q = turn * (place * stretch + lean) + shift;
                    let (x, y, z) = (q.x, q.y, q.z);
                    xyz += &format!("{element} {x:.9} {y:.9} {z:.9}\n");
                    pdb += &format!(
                        "HETATM{:>5}  {element}{atom}  RNG A   1    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00          {element:>2}\n",
                        2 * atom + 1,
                    );
                }
            }
            pdb += "ENDMDL\n";
        }
        [xyz, pdb]
    }

    fn farthest(a: &PointCloud<f64>, b: &PointCloud<f64>) -> f64 {
        assert_eq!((a.len(), a.dimension()), (b.len(), b.dimension()));
        let each = a.coordinates().iter().zip(b.coordinates());
        each.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    }

    /// Largest weighted sum of a coordinate over the atoms.
    fn off_center(cloud: &PointCloud<f64>, weights: [f64; 2]) -> f64 {
        let sum = |p: &[f64], c: usize| {
            let each = p.iter().skip(c).step_by(3).enumerate();
            each.map(|(atom, x)| weights[atom % 2] * x)
                .sum::<f64>()
                .abs()
        };
        let all = cloud.iter().flat_map(|p| (0..3).map(move |c| sum(p, c)));
        all.fold(0.0, f64::max)
    }

    /// All distances of points, for clouds of which one stands turned in its file: the shape is what is compared.
    fn distances(cloud: &PointCloud<f64>) -> PointCloud<f64> {
        let pairs = (0..cloud.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let all = pairs
            .map(|(a, b)| cloud.squared_distance(a, b).sqrt())
            .collect();
        PointCloud::new(1, all).unwrap()
    }

    #[test]
    fn frames_and_models_come_back_aligned() {
        let ring = RingConformations::new(8, 1.52, 130.0).unwrap();
        let drawn = ring.sample(300, 2).unwrap().points;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let [xyz, pdb] = trajectories(&drawn);
        std::fs::write(at("ring.xyz"), xyz).unwrap();
        std::fs::write(at("ring.pdb"), pdb).unwrap();
        let places: Vec<[f64; 3]> = drawn.point(6).as_chunks::<3>().0.to_vec();
        let known = Alignment::new(&places, &[1.0; 8]).unwrap();
        let known = known.align_all(&drawn).unwrap().points;
        let known = distances(&known);
        for (arguments, name, limit) in [
            ("--atoms element:C --reference frame:7", "ring.xyz", 1e-6),
            (
                "--atoms heavy --align kabsch --reference frame:7",
                "ring.xyz",
                1e-6,
            ),
            (
                "--atoms 1,3,5,7,9,11,13,15 --align kabsch --reference frame:7",
                "ring.pdb",
                5e-3,
            ),
            (
                "--atoms C0,C1,C2,C3,C4,C5,C6,C7 --align eckart --reference frame:7",
                "ring.pdb",
                5e-3,
            ),
        ] {
            let found = read(arguments, &at(name));
            assert!(farthest(&distances(&found), &known) < limit, "{arguments}");
            assert!(off_center(&found, [1.0, 1.0]) < 1e-8, "{arguments}");
        }
        // A reference from a table, one row an atom, brings all into its own position.
        let rows: Vec<String> = places
            .iter()
            .map(|[x, y, z]| format!("{x},{y},{z}"))
            .collect();
        std::fs::write(at("seventh.csv"), rows.join("\n")).unwrap();
        let reference = format!("--atoms C --reference {}", at("seventh.csv").display());
        let found = read(&reference, &at("ring.xyz"));
        let seventh = drawn.select(&[6]);
        assert!(farthest(&found.select(&[6]), &seventh) < 1e-8);
        assert!(farthest(&distances(&found), &known) < 1e-6);
        // Frames of 48 numbers with their hydrogens: the centers of mass and of the atoms differ.
        let eckart = read("--align eckart", &at("ring.xyz"));
        let kabsch = read("--align kabsch", &at("ring.xyz"));
        assert_eq!(eckart.dimension(), 48);
        assert!(off_center(&eckart, [12.011, 1.008]) < 1e-7);
        assert!(off_center(&kabsch, [1.0, 1.0]) < 1e-7);
        assert!(farthest(&eckart, &kabsch) > 1e-4);
        // As they stand frames are far apart.
        for plain in ["--atoms heavy", "--atoms heavy --align none"] {
            assert!(off_center(&read(plain, &at("ring.xyz")), [1.0, 1.0]) > 10.0);
        }
    }
}
