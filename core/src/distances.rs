//! Distances of some pairs of landmarks, or of points.

use crate::{CellNeighborhood, Error, Id, Landmark, Scalar, Table};
use serde::{Deserialize, Serialize};

/// Symmetric sparse distances in compressed rows: of landmarks, as a waist has them, or of whatever else has ids.
///
/// What is read from a file is checked as [`SparseDistances::new`] would: rows that are not sorted,
/// not symmetric or not within each other are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    try_from = "Rows<S, I>",
    bound(deserialize = "S: Scalar + Deserialize<'de>, I: Id + Deserialize<'de>")
)]
pub struct SparseDistances<S, I = Landmark> {
    starts: Vec<usize>,
    columns: Vec<I>,
    values: Vec<S>,
}

impl<S: Scalar, I: Id> SparseDistances<S, I> {
    /// Builds the matrix of `count` ids from entries `(a, b, distance)`; each pair
    /// may be given once or several times, in either order; the first one counts.
    ///
    /// # Errors
    /// [`Error::Index`] for an index not below `count`, [`Error::NotFinite`] for a
    /// distance that is NaN, infinite or negative.
    pub fn new(count: usize, entries: impl IntoIterator<Item = (I, I, S)>) -> Result<Self, Error> {
        let mut all: Vec<(I, I, S)> = Vec::new();
        for (a, b, d) in entries {
            for i in [a, b] {
                if i.index() >= count {
                    return Err(Error::Index {
                        what: "landmark",
                        index: i.index(),
                        limit: count,
                    });
                }
            }
            sound(d, a, b)?;
            if a != b {
                all.push((a, b, d));
                all.push((b, a, d));
            }
        }
        all.sort_by_key(|&(a, b, _)| (a, b));
        all.dedup_by_key(|&mut (a, b, _)| (a, b));
        let mut starts = vec![0usize; count + 1];
        for &(a, _, _) in &all {
            starts[a.index() + 1] += 1;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        Ok(Self {
            starts,
            columns: all.iter().map(|&(_, b, _)| b).collect(),
            values: all.iter().map(|&(_, _, d)| d).collect(),
        })
    }

    /// Number of ids.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The distance of two of them, where it is kept. O(log k), k the entries of a row.
    pub fn get(&self, a: I, b: I) -> Option<S> {
        if a == b {
            return Some(S::zero());
        }
        let range = self.starts[a.index()]..self.starts[a.index() + 1];
        let at = self.columns[range.clone()].binary_search(&b).ok()?;
        Some(self.values[range.start + at])
    }

    /// Those to which the distance from `a` is kept, increasing, with the distances.
    pub fn row(&self, a: I) -> impl Iterator<Item = (I, S)> + '_ {
        let range = self.starts[a.index()]..self.starts[a.index() + 1];
        self.columns[range.clone()]
            .iter()
            .copied()
            .zip(self.values[range].iter().copied())
    }

    /// Number of pairs kept.
    pub fn pairs(&self) -> usize {
        self.columns.len() / 2
    }
}

impl<S: Scalar> SparseDistances<S> {
    /// The matrix of `count` landmarks that keeps the distances of all members of each
    /// neighborhood, `distance(a, b)` asked for once for every pair, `a < b`.
    ///
    /// O(sum of k^2 over neighborhoods of k members), in memory for the result alone.
    ///
    /// # Errors
    /// Those of [`SparseDistances::new`].
    pub fn within(
        count: usize,
        neighborhoods: &[CellNeighborhood],
        mut distance: impl FnMut(Landmark, Landmark) -> S,
    ) -> Result<Self, Error> {
        let holders = Holders::of(count, neighborhoods)?;
        let mut matrix = Self {
            starts: Vec::with_capacity(count + 1),
            columns: Vec::new(),
            values: Vec::new(),
        };
        matrix.starts.push(0);
        // The row that a landmark was seen in last, counted from 1.
        let mut seen: Table<Landmark, usize> = Table::filled(count, 0);
        let mut row: Vec<Landmark> = Vec::new();
        // Pairs are symmetric: row b has the rows behind it in the order in which they ask for theirs.
        let mut asked: Table<Landmark, usize> = Table::filled(count, 0);
        for a in seen.ids() {
            let members = |k: &u32| neighborhoods[*k as usize].members();
            let holding = holders.at(a);
            let most = holding.iter().map(|k| members(k).len()).sum();
            row.resize(row.len().max(most), a);
            let (mut length, round) = (0, a.index() + 1);
            seen[a] = round;
            for &b in holding.iter().flat_map(members) {
                // Written in any case and kept if new: a branch would be guessed wrong half of the time.
                row[length] = b;
                length += usize::from(seen[b] != round);
                seen[b] = round;
            }
            let from = matrix.columns.len();
            matrix.columns.extend_from_slice(&row[..length]);
            matrix.columns[from..].sort_unstable();
            asked[a] = from + matrix.columns[from..].partition_point(|&b| b < a);
            for at in from..matrix.columns.len() {
                let b = matrix.columns[at];
                let d = if b > a {
                    distance(a, b)
                } else {
                    let there = &mut asked[b];
                    *there += 1;
                    matrix.values[*there - 1]
                };
                sound(d, a, b)?;
                matrix.values.push(d);
            }
            matrix.starts.push(matrix.columns.len());
        }
        Ok(matrix)
    }
}

/// # Errors
/// [`Error::NotFinite`] for a distance that is none.
fn sound<S: Scalar, I: Id>(d: S, a: I, b: I) -> Result<(), Error> {
    if d.is_finite() && d >= S::zero() {
        return Ok(());
    }
    Err(Error::NotFinite {
        row: a.index(),
        column: b.index(),
    })
}

/// The neighborhoods that every landmark is in.
struct Holders {
    starts: Vec<usize>,
    holding: Vec<u32>,
}

impl Holders {
    fn of(count: usize, neighborhoods: &[CellNeighborhood]) -> Result<Self, Error> {
        let mut starts = vec![0usize; count + 1];
        for &m in neighborhoods.iter().flat_map(|x| x.members()) {
            if m.index() >= count {
                return Err(Error::Index {
                    what: "landmark",
                    index: m.index(),
                    limit: count,
                });
            }
            starts[m.index() + 1] += 1;
        }
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut holding = vec![0u32; starts[count]];
        for (k, near) in (0..).zip(neighborhoods) {
            for &m in near.members() {
                holding[next[m.index()]] = k;
                next[m.index()] += 1;
            }
        }
        Ok(Self { starts, holding })
    }

    fn at(&self, landmark: Landmark) -> &[u32] {
        let k = landmark.index();
        &self.holding[self.starts[k]..self.starts[k + 1]]
    }
}

/// The matrix as it is in a file, before anything is known about it.
#[derive(Deserialize)]
struct Rows<S, I> {
    starts: Vec<usize>,
    columns: Vec<I>,
    values: Vec<S>,
}

impl<S: Scalar, I: Id> TryFrom<Rows<S, I>> for SparseDistances<S, I> {
    type Error = Error;

    /// O(e log k) for e entries, k of them in a row.
    fn try_from(rows: Rows<S, I>) -> Result<Self, Error> {
        let Rows {
            starts,
            columns,
            values,
        } = rows;
        let whole = starts.first() == Some(&0)
            && starts.is_sorted()
            && starts.last() == Some(&columns.len())
            && columns.len() == values.len();
        if !whole {
            return Err(Error::Shape {
                found: format!(
                    "rows from {:?} to {:?} of {} columns and {} distances",
                    starts.first(),
                    starts.last(),
                    columns.len(),
                    values.len()
                ),
                expected:
                    "rows one after the other from 0 to the number of columns, a distance for each"
                        .into(),
            });
        }
        let matrix = Self {
            starts,
            columns,
            values,
        };
        (0..matrix.len()).try_for_each(|a| matrix.check_row(I::new(a)))?;
        Ok(matrix)
    }
}

impl<S: Scalar, I: Id> SparseDistances<S, I> {
    /// Whether a row that was read has increasing columns in range, and distances that are the same back.
    fn check_row(&self, a: I) -> Result<(), Error> {
        let wrong = |found: String, expected: &str| {
            Err(Error::Shape {
                found,
                expected: expected.into(),
            })
        };
        let (count, row) = (self.len(), a.index());
        let range = self.starts[row]..self.starts[row + 1];
        let columns = &self.columns[range.clone()];
        if !columns.is_sorted_by(|x, y| x < y) {
            let columns: Vec<usize> = columns.iter().map(|b| b.index()).collect();
            let found = format!("row {row} with the columns {columns:?}");
            return wrong(found, "increasing ones");
        }
        if let Some(&b) = columns.last().filter(|b| b.index() >= count) {
            return Err(Error::Index {
                what: "landmark",
                index: b.index(),
                limit: count,
            });
        }
        for (&b, &d) in columns.iter().zip(&self.values[range]) {
            sound(d, a, b)?;
            if b == a {
                let found = format!("a distance of landmark {row} from itself");
                return wrong(found, "distances of two landmarks");
            }
            if self.get(b, a) != Some(d) {
                let (d, b) = (d.as_f64(), b.index());
                let found = format!("the distance {d} from {row} to {b}, not back");
                return wrong(found, "the same in both directions");
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, from_value, json, to_value};

    fn line() -> SparseDistances<f64> {
        let pairs = [(0, 1, 1.0), (1, 2, 0.1 + 0.2), (0, 2, 1.5)];
        let named = pairs.map(|(a, b, d)| (Landmark::new(a), Landmark::new(b), d));
        SparseDistances::new(4, named).unwrap()
    }

    #[test]
    fn a_file_gives_back_what_was_written() {
        for matrix in [line(), SparseDistances::new(0, []).unwrap()] {
            let file = to_value(&matrix).unwrap();
            assert_eq!(from_value::<SparseDistances<f64>>(file).unwrap(), matrix);
        }
    }

    /// Each of these would have been found by a panic, or not at all.
    #[test]
    fn a_broken_file_is_refused() {
        let with = |change: fn(&mut Value)| {
            let mut file = to_value(line()).unwrap();
            change(&mut file);
            let read = from_value::<SparseDistances<f64>>(file);
            read.unwrap_err().to_string()
        };
        let says = |change, part: &str| {
            let error = with(change);
            assert!(error.contains(part), "{error}");
        };
        says(|f| f["starts"] = json!([]), "rows from None");
        says(|f| f["starts"][4] = json!(5), "to Some(5) of 6 columns");
        says(|f| f["starts"][1] = json!(99), "rows one after the other");
        says(
            |f| drop(f["values"].as_array_mut().unwrap().pop()),
            "5 distances",
        );
        says(|f| f["columns"][1] = json!(7), "landmark 7 is out of range");
        says(|f| f["columns"][0] = json!(2), "increasing");
        says(|f| f["columns"][0] = json!(0), "from itself");
        says(|f| f["columns"][1] = json!(3), "both directions");
        says(|f| f["values"][0] = json!(1.25), "both directions");
        says(|f| f["values"][0] = json!(-1.0), "row 0, column 1");
        // Beyond what single precision holds.
        let mut file = to_value(line()).unwrap();
        file["values"][0] = json!(1e300);
        assert!(from_value::<SparseDistances<f32>>(file).is_err());
    }
}
