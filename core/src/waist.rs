//! The narrow waist: stratified landmark neighborhoods with sparse distances.
//!
//! Whatever produces this type can be triangulated, whatever triangulates it can be
//! swapped. It holds no coordinates: a laboratory that measures distances can fill it.

use crate::{CurveEdge, Error, Scalar};
use serde::{Deserialize, Serialize};

/// Symmetric sparse distances in compressed rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SparseDistances<S> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<S>,
}

impl<S: Scalar> SparseDistances<S> {
    /// Builds the matrix of `count` landmarks from entries `(a, b, distance)`; each pair
    /// may be given once or several times, in either order; the first one counts.
    ///
    /// # Errors
    /// [`Error::Index`] for an index not below `count`, [`Error::NotFinite`] for a
    /// distance that is NaN, infinite or negative.
    pub fn new(
        count: usize,
        entries: impl IntoIterator<Item = (u32, u32, S)>,
    ) -> Result<Self, Error> {
        let mut all: Vec<(u32, u32, S)> = Vec::new();
        for (a, b, d) in entries {
            for i in [a, b] {
                if i as usize >= count {
                    return Err(Error::Index {
                        what: "landmark",
                        index: i as usize,
                        limit: count,
                    });
                }
            }
            if !d.is_finite() || d < S::zero() {
                return Err(Error::NotFinite {
                    row: a as usize,
                    column: b as usize,
                });
            }
            if a != b {
                all.push((a, b, d));
                all.push((b, a, d));
            }
        }
        all.sort_by_key(|&(a, b, _)| (a, b));
        all.dedup_by_key(|&mut (a, b, _)| (a, b));
        let mut starts = vec![0usize; count + 1];
        for &(a, _, _) in &all {
            starts[a as usize + 1] += 1;
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
        mut distance: impl FnMut(u32, u32) -> S,
    ) -> Result<Self, Error> {
        let mut holders = vec![0usize; count + 1];
        for &m in neighborhoods.iter().flat_map(|x| &x.members) {
            if m as usize >= count {
                return Err(Error::Index {
                    what: "landmark",
                    index: m as usize,
                    limit: count,
                });
            }
            holders[m as usize + 1] += 1;
        }
        for k in 0..count {
            holders[k + 1] += holders[k];
        }
        let mut next = holders.clone();
        let mut holding = vec![0u32; holders[count]];
        for (k, near) in neighborhoods.iter().enumerate() {
            for &m in &near.members {
                holding[next[m as usize]] = k as u32;
                next[m as usize] += 1;
            }
        }
        let mut matrix = Self {
            starts: Vec::with_capacity(count + 1),
            columns: Vec::new(),
            values: Vec::new(),
        };
        matrix.starts.push(0);
        let mut seen = vec![u32::MAX; count];
        let mut row: Vec<u32> = Vec::new();
        // Pairs are symmetric: row b has the rows behind it in the order in which they ask for theirs.
        let mut asked: Vec<usize> = vec![0; count];
        for a in 0..count as u32 {
            let holding = &holding[holders[a as usize]..holders[a as usize + 1]];
            let members = |k: &u32| &neighborhoods[*k as usize].members;
            let most = holding.iter().map(|k| members(k).len()).sum();
            row.resize(row.len().max(most), 0);
            let mut length = 0;
            seen[a as usize] = a;
            for &b in holding.iter().flat_map(members) {
                // Written in any case and kept if new: a branch would be guessed wrong half of the time.
                row[length] = b;
                length += usize::from(seen[b as usize] != a);
                seen[b as usize] = a;
            }
            let from = matrix.columns.len();
            matrix.columns.extend_from_slice(&row[..length]);
            matrix.columns[from..].sort_unstable();
            asked[a as usize] = from + matrix.columns[from..].partition_point(|&b| b < a);
            for at in from..matrix.columns.len() {
                let b = matrix.columns[at];
                let d = if b > a {
                    distance(a, b)
                } else {
                    let there = &mut asked[b as usize];
                    *there += 1;
                    matrix.values[*there - 1]
                };
                if !d.is_finite() || d < S::zero() {
                    return Err(Error::NotFinite {
                        row: a as usize,
                        column: b as usize,
                    });
                }
                matrix.values.push(d);
            }
            matrix.starts.push(matrix.columns.len());
        }
        Ok(matrix)
    }

    /// Number of landmarks.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there is no landmark.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The distance of two landmarks, where it is kept. O(log k), k the entries of a row.
    pub fn get(&self, a: u32, b: u32) -> Option<S> {
        if a == b {
            return Some(S::zero());
        }
        let range = self.starts[a as usize]..self.starts[a as usize + 1];
        let at = self.columns[range.clone()].binary_search(&b).ok()?;
        Some(self.values[range.start + at])
    }

    /// The landmarks to which the distance from `a` is kept, increasing, with the distances.
    pub fn row(&self, a: u32) -> impl Iterator<Item = (u32, S)> + '_ {
        let range = self.starts[a as usize]..self.starts[a as usize + 1];
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

/// What lies around one landmark inside one cell.
///
/// A landmark on a 2-stratum has one; a landmark on a curve has one for each cell that meets there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellNeighborhood {
    /// The landmark.
    pub center: u32,
    /// The landmarks of the cell near it, and those on the curves at the rim of the cell;
    /// the center is the first, then by increasing distance.
    pub members: Vec<u32>,
}

/// Stratified landmark neighborhoods with sparse distances: all that a triangulator knows.
///
/// # Invariants
/// Indices are below `strata.len()`; the distance of every two members of a neighborhood is kept;
/// ends of curve edges are landmarks of stratum dimension 0 or 1. [`StratifiedLandmarks::check`]
/// tells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StratifiedLandmarks<S> {
    /// For each landmark the dimension of its stratum: 0, 1 or 2.
    pub strata: Vec<u8>,
    /// The chains: edges along the curves.
    pub curve_edges: Vec<CurveEdge>,
    /// Neighborhoods, one for each landmark and cell.
    pub neighborhoods: Vec<CellNeighborhood>,
    /// Distances within the neighborhoods.
    pub distances: SparseDistances<S>,
}

impl<S: Scalar> StratifiedLandmarks<S> {
    /// Checks the invariants.
    ///
    /// # Errors
    /// [`Error::Index`] or [`Error::Shape`] for the first one that does not hold.
    pub fn check(&self) -> Result<(), Error> {
        let count = self.strata.len();
        let in_range = |index: u32| {
            if (index as usize) < count {
                Ok(())
            } else {
                Err(Error::Index {
                    what: "landmark",
                    index: index as usize,
                    limit: count,
                })
            }
        };
        if self.distances.len() != count {
            return Err(Error::Shape {
                found: format!("distances of {} landmarks", self.distances.len()),
                expected: format!("{count}"),
            });
        }
        for edge in &self.curve_edges {
            for end in edge.ends {
                in_range(end)?;
                if self.strata[end as usize] > 1 {
                    return Err(Error::Shape {
                        found: format!(
                            "curve edge {:?} at landmark {end} of a surface cell",
                            edge.ends
                        ),
                        expected: "ends on a curve or a point".into(),
                    });
                }
            }
        }
        // The neighborhood that a landmark was in last, and its position there.
        let mut round = vec![u64::MAX; count];
        for (k, near) in self.neighborhoods.iter().enumerate() {
            if near.members.first() != Some(&near.center) {
                return Err(Error::Shape {
                    found: format!(
                        "a neighborhood of {} that starts with {:?}",
                        near.center,
                        near.members.first()
                    ),
                    expected: "the center first".into(),
                });
            }
            for &m in &near.members {
                in_range(m)?;
            }
            let first = (k as u64) << 32;
            for (i, &m) in (0_u64..).zip(&near.members) {
                round[m as usize] = first + i;
            }
            // Every member's row is gone through once, rather than searched for every other.
            for (i, &a) in near.members.iter().enumerate() {
                let before = |b: u32| round[b as usize].wrapping_sub(first) < i as u64;
                let kept: usize = (self.distances.row(a))
                    .map(|x| usize::from(before(x.0)))
                    .sum();
                if kept == i {
                    continue;
                }
                for &b in &near.members[..i] {
                    if self.distances.get(a, b).is_none() {
                        return Err(Error::Shape {
                            found: format!("no distance between landmarks {a} and {b}"),
                            expected: format!("one, as both are near landmark {}", near.center),
                        });
                    }
                }
            }
        }
        Ok(())
    }
}
