//! Which columns of a file are coordinates.
//!
//! Files of points carry more than positions: normals, colors, intensities, a number for every
//! row. A column that is taken for a coordinate by accident makes another surface, in another
//! space, which may even be verified. So columns that a header calls x, y, z are taken alone;
//! files of positions by custom (`.xyz`, `.asc`, `.pts`) lose normals and colors; and what looks
//! like no coordinate, but is taken, is told.

use super::error::{Flaw, Parsed};
use super::npy::Numbers;
use super::remark::{Meaning, Remark};
use std::fmt;
use std::str::FromStr;

/// Which columns of a table, an array or a record are the coordinates of a point.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ColumnChoice {
    /// Columns that are named x, y, z, when there are such names. Else all, except that normals
    /// and colors are left out of files which are positions by custom: `.xyz`, `.asc`, `.pts`.
    #[default]
    Automatic,
    /// All of them.
    All,
    /// These, in this order.
    Chosen(Vec<ColumnName>),
}

/// A column by its number or by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ColumnName {
    /// Counted from 0.
    Number(usize),
    /// As the header has it; case does not matter.
    Name(String),
}

impl fmt::Display for ColumnName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(k) => write!(f, "{k}"),
            Self::Name(name) => write!(f, "{name:?}"),
        }
    }
}

impl FromStr for ColumnChoice {
    type Err = String;

    /// Numbers (from 0), ranges and names between commas, or `all`.
    ///
    /// ```
    /// use crosscap_backends::files::{ColumnChoice, ColumnName};
    /// let chosen: ColumnChoice = "3-4,height".parse().unwrap();
    /// let height = ColumnName::Name("height".into());
    /// assert_eq!(
    ///     chosen,
    ///     ColumnChoice::Chosen(vec![ColumnName::Number(3), ColumnName::Number(4), height])
    /// );
    /// assert!("1,,2".parse::<ColumnChoice>().is_err());
    /// ```
    fn from_str(text: &str) -> Result<Self, String> {
        /// More columns than any table here has; a longer range is a slip.
        const MOST: usize = 1 << 20;
        if text.trim() == "all" {
            return Ok(Self::All);
        }
        let mut chosen = Vec::new();
        for item in text.split(',').map(str::trim) {
            let number = |t: &str| t.trim().parse::<usize>().ok();
            let range = item
                .split_once('-')
                .and_then(|(a, b)| number(a).zip(number(b)));
            match (number(item), range) {
                (Some(k), _) => chosen.push(ColumnName::Number(k)),
                (None, Some((a, b))) if a <= b && b < MOST => {
                    chosen.extend((a..=b).map(ColumnName::Number));
                }
                (None, None) if !item.is_empty() => chosen.push(ColumnName::Name(item.into())),
                _ => {
                    return Err(format!(
                        "found {item:?}, expected a number from 0, a range such as 0-2, or a name"
                    ));
                }
            }
        }
        Ok(Self::Chosen(chosen))
    }
}

/// What kind of file the columns stand in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Custom {
    /// Positions first, by custom: `.xyz`, `.asc`.
    Positions,
    /// Positions first, by the definition of the format: `.pts`.
    Scan,
    /// A table of anything, as text.
    Table,
    /// An array: its writer knew what it holds.
    Array,
}

/// Columns that are taken, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Picked {
    pub(crate) kept: Vec<usize>,
    pub(crate) why: Why,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Why {
    /// They were asked for, one by one or all.
    Asked,
    /// Their names are x, y, z.
    Named,
    /// There was nothing to tell.
    Untold,
}

/// The columns to take of `total`, as far as names and wishes tell.
pub(crate) fn pick(
    names: Option<&[String]>,
    total: usize,
    wanted: &ColumnChoice,
) -> Parsed<Picked> {
    let chosen = match wanted {
        ColumnChoice::All => {
            return Ok(Picked {
                kept: (0..total).collect(),
                why: Why::Asked,
            });
        }
        ColumnChoice::Automatic => {
            let named = names.and_then(positions);
            return Ok(Picked {
                why: if named.is_some() {
                    Why::Named
                } else {
                    Why::Untold
                },
                kept: named.unwrap_or_else(|| (0..total).collect()),
            });
        }
        ColumnChoice::Chosen(chosen) => chosen,
    };
    let mut kept = Vec::with_capacity(chosen.len());
    for column in chosen {
        let Some(k) = position_of(column, names, total) else {
            let there = match names {
                Some(names) => format!("{total} columns: {}", names.join(", ")),
                None => format!("{total} columns without names"),
            };
            return Err(Flaw::new(
                there,
                format!("column {column} of --columns (numbers count from 0)"),
            ));
        };
        if kept.contains(&k) {
            return Err(Flaw::new(
                format!("column {column} twice in --columns"),
                "each column once",
            ));
        }
        kept.push(k);
    }
    Ok(Picked {
        kept,
        why: Why::Asked,
    })
}

/// Where the column of a number or a name stands: the column of that very name, else the first of that name with a unit behind it.
fn position_of(column: &ColumnName, names: Option<&[String]>, total: usize) -> Option<usize> {
    match column {
        ColumnName::Number(k) => Some(*k).filter(|&k| k < total),
        ColumnName::Name(name) => {
            let names = names?;
            let same = |n: &String| n.trim().eq_ignore_ascii_case(name);
            let begins = |n: &String| plain(n) == name.to_lowercase();
            let exact = names.iter().position(same);
            exact.or_else(|| names.iter().position(begins))
        }
    }
}

/// A name without its unit, in lower case: `X [m]` is `x`.
fn plain(name: &str) -> String {
    let name = name.trim().trim_start_matches(['/', '#', '"']).trim_start();
    let end = name.find(|c: char| c.is_whitespace() || "[(\"".contains(c));
    name[..end.unwrap_or(name.len())].to_lowercase()
}

/// Where x, y, z stand among names; the ways to write them that spreadsheets, scanners and
/// viewers have.
fn positions(names: &[String]) -> Option<Vec<usize>> {
    const WAYS: [[&str; 3]; 7] = [
        ["x", "y", "z"],
        ["points:0", "points:1", "points:2"],
        ["points_0", "points_1", "points_2"],
        ["pos_x", "pos_y", "pos_z"],
        ["position_x", "position_y", "position_z"],
        ["x_coord", "y_coord", "z_coord"],
        ["coord_x", "coord_y", "coord_z"],
    ];
    let plain: Vec<String> = names.iter().map(|n| plain(n)).collect();
    // Four coordinates that are called so, and nothing else, are a place in R^4.
    if plain == ["x", "y", "z", "w"] {
        return Some(vec![0, 1, 2, 3]);
    }
    WAYS.iter().find_map(|way| {
        way.iter()
            .map(|wanted| {
                let mut at = (0..plain.len()).filter(|&k| plain[k] == *wanted);
                // A name that is there twice tells nothing.
                at.next().filter(|_| at.next().is_none())
            })
            .collect()
    })
}

/// Rows of numbers whose columns are not settled yet.
pub(crate) struct Grid<'a> {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    pub(crate) numbers: &'a Numbers,
}

/// The columns to keep of those that were picked for want of a reason, and what is to be told.
pub(crate) fn inspect(grid: &Grid<'_>, custom: Custom, remarks: &mut Vec<Remark>) -> Vec<usize> {
    let all: Vec<usize> = (0..grid.columns).collect();
    // Fewer rows than this look like anything.
    const FEWEST: usize = 4;
    if grid.rows < FEWEST {
        return all;
    }
    let total = grid.columns;
    let behind = (4..=12)
        .contains(&total)
        .then(|| grid.attributes())
        .flatten();
    match (custom, behind) {
        (Custom::Scan, meanings) if total > 3 => {
            remarks.push(Remark::FirstThree {
                columns: total,
                meanings: meanings.unwrap_or_default(),
            });
            return vec![0, 1, 2];
        }
        (Custom::Positions, Some(meanings)) => {
            remarks.push(Remark::FirstThree {
                columns: total,
                meanings,
            });
            return vec![0, 1, 2];
        }
        (_, Some(meanings)) => remarks.push(Remark::Suspect {
            columns: total,
            meanings,
        }),
        (Custom::Positions, None) if (4..=7).contains(&total) => {
            remarks.push(Remark::Many { columns: total });
        }
        (Custom::Table, None) if (6..=7).contains(&total) => {
            remarks.push(Remark::Many { columns: total });
        }
        _ => {}
    }
    all
}

/// Tells of columns among those kept that number the rows or never change.
pub(crate) fn idle(grid: &Grid<'_>, kept: &[usize], remarks: &mut Vec<Remark>) {
    // Wide arrays have constant columns for good reasons: a molecule that was put into place.
    const MOST: usize = 12;
    if grid.rows < 3 || grid.columns > MOST {
        return;
    }
    for (k, &column) in kept.iter().enumerate() {
        let at = |row: usize| grid.numbers.at(row * grid.columns + k);
        let first = at(0);
        if (1..grid.rows).all(|row| at(row) == first) {
            remarks.push(Remark::Constant {
                column,
                value: first,
            });
        } else if (first == 0.0 || first == 1.0)
            && (1..grid.rows).all(|row| at(row) == first + row as f64)
        {
            remarks.push(Remark::Counts { column });
        }
    }
}

impl Grid<'_> {
    fn triple(&self, row: usize, from: usize) -> [f64; 3] {
        std::array::from_fn(|k| self.numbers.at(row * self.columns + from + k))
    }

    /// What the columns behind the third are, when they can only be normals or colors, with one
    /// more number at most.
    fn attributes(&self) -> Option<Vec<Meaning>> {
        let mut meanings = Vec::new();
        let (mut at, mut loose) = (3, 0);
        while at < self.columns {
            let three = at + 3 <= self.columns;
            if three && self.all_normals(at) {
                meanings.push(Meaning::Normals { from: at });
                at += 3;
            } else if three && self.all_colors(at) {
                meanings.push(Meaning::Colors { from: at });
                at += 3;
            } else {
                loose += 1;
                at += 1;
            }
        }
        (!meanings.is_empty() && loose <= 1).then_some(meanings)
    }

    /// Vectors of length one; where an estimate failed, programs write zeros.
    fn all_normals(&self, from: usize) -> bool {
        /// What three decimals leave of a unit vector's length.
        const ROUNDED: f64 = 2e-3;
        /// Largest part of rows without a normal.
        const FAILED: f64 = 0.1;
        let mut zeros = 0;
        let unit = (0..self.rows).all(|row| {
            let square: f64 = self.triple(row, from).iter().map(|x| x * x).sum();
            zeros += usize::from(square == 0.0);
            square == 0.0 || (square.sqrt() - 1.0).abs() <= ROUNDED
        });
        unit && zeros as f64 <= FAILED * self.rows as f64
    }

    /// Whole numbers from 0 to 255 beside positions that are no such numbers, not all of them 0 or 1.
    fn all_colors(&self, from: usize) -> bool {
        let byte = |x: f64| (0.0..=255.0).contains(&x) && x == x.trunc();
        let rows = 0..self.rows;
        rows.clone()
            .all(|r| self.triple(r, from).into_iter().all(byte))
            && rows
                .clone()
                .any(|r| self.triple(r, from).into_iter().any(|x| x > 1.0))
            && rows
                .clone()
                .any(|r| !self.triple(r, 0).into_iter().all(byte))
    }
}
