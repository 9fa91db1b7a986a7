//! Homology of complexes: Betti numbers over Q and prime fields, integral torsion, exactly.
//!
//! # Method
//! Write d1 and d2 for the boundary maps of edges and triangles. Over any field the rank of d1
//! is the number of vertices minus the number of components. Everything else is in the Smith
//! normal form of d2: its rank over Q is the number of nonzero invariant factors, its rank over
//! Z/p the number of those that p does not divide, and the factors above 1 are the torsion of H1
//! (edge chains modulo cycles embed in vertex chains by d1, so they are free, and the cokernel of
//! d2 is H1 plus a free summand). H0 and H2 of a 2-complex are free.
//!
//! The Smith normal form is that of a much smaller matrix. An entry +-1 may serve as a pivot: the
//! rest of the matrix is replaced by its Schur complement and one invariant factor is 1. Nothing
//! but this step is used, so the reduction is right for every 2-complex:
//! 1. An edge with exactly two triangles, not yet joined, merges them into one column. All such
//!    merges leave one column for each *region*, the signed sum of its triangles; a union-find
//!    with signs does it. The other edges of this kind inside a region keep a 0, or a 2 when the
//!    region is not orientable.
//! 2. A region with an edge that has no other triangle is eliminated by it.
//! 3. Edges with three or more triangles become rows over the regions that are left. Along a
//!    double curve they are all alike; each is kept once.
//! 4. Sparse elimination with unit pivots, then arbitrary precision for what has no unit.
//!
//! Time O(v + t log d) with d the largest number of triangles at a vertex, plus step 4, whose
//! matrix has the size of the list of regions and of ways in which they meet; memory linear. A
//! torus of 2 million triangles takes 0.15 to 0.35 seconds (`benches/homology.rs`), a foam of 32^3 cubes (all edges inside with
//! four triangles) a third. Step 4 has no bound on its fill: a random complex of 4400
//! triangles on 100 vertices, near the threshold where its H2 appears, takes 3 seconds.

mod elimination;
mod local;
mod prime;
pub(crate) mod sides;
pub(crate) mod signed_union;
mod smith;

pub use elimination::betti_by_elimination;
pub use local::{LocalFailure, LocalHomology, local_homology};

use crosscap_core::{Complex, Error};
use num_bigint::BigUint;
use num_traits::Zero;
use serde::{Serialize, Serializer};
use sides::{Sides, runs_backward};
use signed_union::{Joined, SignedUnion};

/// A number that was given as the characteristic of a field and is not a prime.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} is not a prime number: give the characteristic of the field, such as 2, 3 or 5")]
pub struct NotPrime(pub u64);

/// Why Betti numbers over a prime field were not computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BettiError {
    /// The characteristic is not a prime.
    #[error(transparent)]
    NotPrime(#[from] NotPrime),
    /// The complex is not as [`Complex::new`] leaves it.
    #[error(transparent)]
    Complex(#[from] Error),
}

/// The homology of a complex of dimension at most 2, exactly.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Homology {
    /// Ranks of H0, H1, H2: Betti numbers over the rational numbers.
    pub betti_rational: [usize; 3],
    /// Betti numbers over Z/2.
    pub betti_mod2: [usize; 3],
    /// Torsion of H1 over the integers: invariant factors above 1, each dividing the next.
    /// Serialized as decimal strings.
    #[serde(serialize_with = "as_decimals")]
    pub torsion: Vec<BigUint>,
    /// Vertices minus edges plus triangles.
    pub euler: i64,
}

impl Homology {
    /// Betti numbers over Z/p, by the universal coefficient theorem: every torsion factor that p
    /// divides adds one to b1 and one to b2.
    ///
    /// # Errors
    /// [`NotPrime`] when `p` is not a prime.
    ///
    /// ```
    /// use crosscap_algorithms::homology::homology;
    /// use crosscap_core::Complex;
    /// // The projective plane on six vertices.
    /// let triangles = vec![
    ///     [0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 1, 5],
    ///     [1, 2, 4], [2, 4, 5], [2, 3, 5], [1, 3, 5], [1, 3, 4],
    /// ];
    /// let plane = homology(&Complex::new(6, triangles, vec![]).unwrap()).unwrap();
    /// assert_eq!(plane.betti_rational, [1, 0, 0]);
    /// assert_eq!(plane.betti_mod(2).unwrap(), [1, 1, 1]);
    /// assert_eq!(plane.torsion[0], 2u32.into());
    /// assert!(plane.betti_mod(4).is_err());
    /// ```
    pub fn betti_mod(&self, p: u64) -> Result<[usize; 3], NotPrime> {
        if !prime::is_prime(p) {
            return Err(NotPrime(p));
        }
        Ok(with_torsion(self.betti_rational, &self.torsion, p))
    }
}

/// Betti numbers over Z/p from those over Q and the torsion of H1; `p` is prime.
fn with_torsion([b0, b1, b2]: [usize; 3], torsion: &[BigUint], p: u64) -> [usize; 3] {
    let divided = torsion.iter().filter(|&x| (x % p).is_zero()).count();
    [b0, b1 + divided, b2 + divided]
}

fn as_decimals<S: Serializer>(torsion: &[BigUint], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(torsion.iter().map(BigUint::to_string))
}

/// Computes the homology of `complex`, which may be any 2-complex: no surface is assumed. Curve
/// edges without a triangle count as edges, `cells` is not looked at.
///
/// See the [module](self) for the method and its cost.
///
/// # Errors
/// [`Error::Shape`] or [`Error::Index`] when the fields of the complex are not as
/// [`Complex::new`] leaves them.
///
/// ```
/// use crosscap_algorithms::homology::homology;
/// use crosscap_core::Complex;
/// // Three triangles on one edge, closed by their other corner: two spheres share a disc.
/// let book = vec![[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 2, 3], [1, 2, 3], [0, 3, 4], [1, 3, 4]];
/// let h = homology(&Complex::new(5, book, vec![]).unwrap()).unwrap();
/// assert_eq!(h.betti_rational, [1, 0, 2]);
/// assert!(h.torsion.is_empty());
/// ```
pub fn homology(complex: &Complex) -> Result<Homology, Error> {
    let sides = Sides::new(complex)?;
    let bare = bare_edges(complex, &sides);
    let edges = sides.edges.len() + bare.len();
    let vertices = complex.vertices;
    let triangles = complex.triangles.len();

    let mut parts = SignedUnion::new(vertices);
    let mut components = vertices;
    // Two sides of a triangle connect its corners.
    let triangle_sides = complex
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [a, c]]);
    for [a, b] in triangle_sides.chain(bare) {
        if parts.join(a, b, false) == Joined::New {
            components -= 1;
        }
    }

    let (columns, rows, mut ones) = regions(triangles, &sides);
    let invariants = smith::invariants(columns, rows);
    ones += invariants.rank();
    let rank1 = vertices - components;
    let rank2 = ones;
    let betti_rational = [components, edges - rank1 - rank2, triangles - rank2];
    let torsion = invariants.torsion();
    Ok(Homology {
        betti_rational,
        betti_mod2: with_torsion(betti_rational, &torsion, 2),
        torsion,
        euler: vertices as i64 - edges as i64 + triangles as i64,
    })
}

/// Curve edges that are no side of a triangle.
pub(crate) fn bare_edges(complex: &Complex, sides: &Sides) -> Vec<[u32; 2]> {
    let curve = complex.curve_edges.iter().map(|e| e.ends);
    curve
        .filter(|ends| sides.edges.binary_search(ends).is_err())
        .collect()
}

/// The column of a region that a free side eliminates.
const OPEN: u32 = u32::MAX;

/// Reduces d2 to a matrix over the regions (steps 1 to 3 of the module's text): the number of
/// columns, the rows, and how many invariant factors 1 were split off on the way.
fn regions(triangles: usize, sides: &Sides) -> (usize, Vec<smith::Row>, usize) {
    let mut ones = 0;
    let mut sets = SignedUnion::new(triangles);
    let mut twisted: Vec<u32> = Vec::new();
    for e in 0..sides.edges.len() {
        if let &[s, t] = sides.at(e) {
            // The signed sum has no part on this edge, so equal directions need opposite signs.
            let opposite = runs_backward(s) == runs_backward(t);
            match sets.join(s / 3, t / 3, opposite) {
                Joined::New => ones += 1,
                Joined::Consistent => {}
                Joined::Contradiction => twisted.push(s / 3),
            }
        }
    }
    // Column of each region, at its representative.
    let mut column_of = vec![0u32; triangles];
    for e in 0..sides.edges.len() {
        if let &[s] = sides.at(e) {
            let (region, _) = sets.find(s / 3);
            if column_of[region as usize] != OPEN {
                column_of[region as usize] = OPEN;
                ones += 1;
            }
        }
    }
    let mut columns = 0;
    for (t, column) in column_of.iter_mut().enumerate() {
        if sets.find(t as u32).0 == t as u32 && *column != OPEN {
            *column = columns;
            columns += 1;
        }
    }
    let mut doubled: Vec<u32> = twisted
        .iter()
        .map(|&t| column_of[sets.find(t).0 as usize])
        .filter(|&c| c != OPEN)
        .collect();
    doubled.sort_unstable();
    doubled.dedup();
    let mut rows: Vec<smith::Row> = doubled.into_iter().map(|c| vec![(c, 2)]).collect();
    rows.extend(rows_at_curves(sides, &mut sets, &column_of));
    (columns as usize, rows, ones)
}

/// Different rows of edges with three or more triangles, in order.
fn rows_at_curves(sides: &Sides, sets: &mut SignedUnion, column_of: &[u32]) -> Vec<smith::Row> {
    // One after the other in a single block.
    let mut entries: Vec<(u32, i64)> = Vec::new();
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    let mut row: Vec<(u32, i64)> = Vec::new();
    for e in 0..sides.edges.len() {
        let at = sides.at(e);
        if at.len() < 3 {
            continue;
        }
        row.clear();
        for &side in at {
            let (region, flipped) = sets.find(side / 3);
            let column = column_of[region as usize];
            if column != OPEN {
                let backward = runs_backward(side) ^ flipped;
                row.push((column, if backward { -1 } else { 1 }));
            }
        }
        row.sort_unstable_by_key(|&(column, _)| column);
        let from = entries.len();
        for same in row.chunk_by(|x, y| x.0 == y.0) {
            let sum: i64 = same.iter().map(|&(_, sign)| sign).sum();
            if sum != 0 {
                entries.push((same[0].0, sum));
            }
        }
        // A row and its negative are one row.
        if entries.get(from).is_some_and(|&(_, first)| first < 0) {
            entries[from..].iter_mut().for_each(|(_, x)| *x = -*x);
        }
        if entries.len() > from {
            ranges.push((from, entries.len()));
        }
    }
    ranges.sort_unstable_by(|x, y| entries[x.0..x.1].cmp(&entries[y.0..y.1]));
    ranges.dedup_by(|x, y| entries[x.0..x.1] == entries[y.0..y.1]);
    let row = |&(from, to): &(usize, usize)| entries[from..to].to_vec();
    ranges.iter().map(row).collect()
}

#[cfg(test)]
pub(crate) mod shapes;
#[cfg(test)]
mod tests;
