//! The narrow waist: stratified landmark neighborhoods with sparse distances.
//!
//! Whatever produces this type can be triangulated, whatever triangulates it can be
//! swapped. It holds no coordinates: a laboratory that measures distances can fill it.

use crate::{CellNeighborhood, CurveEdge, Error, Landmark, Scalar, SparseDistances, Table};
use serde::{Deserialize, Serialize};

/// Stratified landmark neighborhoods with sparse distances: all that a triangulator knows.
///
/// # Invariants
/// There is a distance entry for every landmark, and none is on a stratum above dimension 2; ends of curve edges are landmarks of
/// stratum dimension 0 or 1; members of a neighborhood are landmarks, each once, and the distance of every two of them is kept.
///
/// There is no waist without them: [`StratifiedLandmarks::new`] checks, nothing changes a waist that is made, and one that
/// is read from a file is checked on the way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    try_from = "Unchecked<S>",
    bound(deserialize = "S: Scalar + Deserialize<'de>")
)]
pub struct StratifiedLandmarks<S> {
    strata: Table<Landmark, u8>,
    curve_edges: Vec<CurveEdge>,
    neighborhoods: Vec<CellNeighborhood>,
    distances: SparseDistances<S>,
}

impl<S: Scalar> StratifiedLandmarks<S> {
    /// A waist of landmarks on strata of these dimensions, 0, 1 or 2, with chains along the curves, a neighborhood for each landmark
    /// and cell, and the distances within them.
    ///
    /// O(k) for every neighborhood, k the distances that its members have.
    ///
    /// # Errors
    /// [`Error::Index`] or [`Error::Shape`] for the first invariant that does not hold.
    ///
    /// ```
    /// use crosscap_core::{CellNeighborhood, Landmark, SparseDistances, StratifiedLandmarks};
    /// let corners = [0, 1, 2].map(Landmark::new);
    /// let triangle = vec![CellNeighborhood::new(corners[0], corners)];
    /// let even = SparseDistances::within(3, &triangle, |_, _| 1.0)?;
    /// let with = |distances| StratifiedLandmarks::new(vec![2; 3].into(), vec![], triangle.clone(), distances);
    /// assert_eq!(with(even)?.strata().len(), 3);
    /// let error = with(SparseDistances::new(3, [(corners[0], corners[1], 1.0)])?).unwrap_err();
    /// assert!(error.to_string().contains("no distance between landmarks 2 and 0"));
    /// # Ok::<(), crosscap_core::Error>(())
    /// ```
    pub fn new(
        strata: Table<Landmark, u8>,
        curve_edges: Vec<CurveEdge>,
        neighborhoods: Vec<CellNeighborhood>,
        distances: SparseDistances<S>,
    ) -> Result<Self, Error> {
        let waist = Self {
            strata,
            curve_edges,
            neighborhoods,
            distances,
        };
        waist.check()?;
        Ok(waist)
    }

    /// For each landmark the dimension of its stratum: 0, 1 or 2.
    pub fn strata(&self) -> &Table<Landmark, u8> {
        &self.strata
    }

    /// The chains: edges along the curves.
    pub fn curve_edges(&self) -> &[CurveEdge] {
        &self.curve_edges
    }

    /// Neighborhoods, one for each landmark and cell.
    pub fn neighborhoods(&self) -> &[CellNeighborhood] {
        &self.neighborhoods
    }

    /// Distances within the neighborhoods.
    pub fn distances(&self) -> &SparseDistances<S> {
        &self.distances
    }

    fn check(&self) -> Result<(), Error> {
        let count = self.strata.len();
        if self.distances.len() != count {
            return Err(Error::Shape {
                found: format!("distances of {} landmarks", self.distances.len()),
                expected: format!("{count}"),
            });
        }
        if let Some((k, d)) = self.strata.each().find(|x| *x.1 > 2) {
            return Err(Error::Shape {
                found: format!("landmark {k} on a stratum of dimension {d}"),
                expected: "0, 1 or 2".into(),
            });
        }
        self.check_edges()?;
        // The neighborhood that a landmark was in last, and its position there.
        let mut round: Table<Landmark, u64> = Table::filled(count, u64::MAX);
        for (k, near) in (0_u64..).zip(&self.neighborhoods) {
            let members = near.members().iter();
            members.copied().try_for_each(|m| self.in_range(m))?;
            self.check_distances(near, k << 32, &mut round)?;
        }
        Ok(())
    }

    fn in_range(&self, landmark: Landmark) -> Result<(), Error> {
        match self.strata.get(landmark) {
            Some(_) => Ok(()),
            None => Err(Error::Index {
                what: "landmark",
                index: landmark.index(),
                limit: self.strata.len(),
            }),
        }
    }

    fn check_edges(&self) -> Result<(), Error> {
        for edge in &self.curve_edges {
            for end in edge.landmarks() {
                self.in_range(end)?;
                if self.strata[end] > 1 {
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
        Ok(())
    }

    /// Whether every member is there once, and the distances of all are kept. `first` and what follows it, one for each member,
    /// are numbers that `round` has had for none.
    fn check_distances(
        &self,
        near: &CellNeighborhood,
        first: u64,
        round: &mut Table<Landmark, u64>,
    ) -> Result<(), Error> {
        for (i, &m) in (0_u64..).zip(near.members()) {
            // Counted from `first` on, and so large for whatever was there before.
            if round[m].wrapping_sub(first) < i {
                return Err(Error::Shape {
                    found: format!("landmark {m} twice near landmark {}", near.center()),
                    expected: "every member once".into(),
                });
            }
            round[m] = first + i;
        }
        // Every member's row is gone through once, rather than searched for every other.
        for (i, &a) in near.members().iter().enumerate() {
            let before = |b: Landmark| round[b].wrapping_sub(first) < i as u64;
            let kept: usize = (self.distances.row(a))
                .map(|x| usize::from(before(x.0)))
                .sum();
            if kept == i {
                continue;
            }
            for &b in &near.members()[..i] {
                if self.distances.get(a, b).is_none() {
                    return Err(Error::Shape {
                        found: format!("no distance between landmarks {a} and {b}"),
                        expected: format!("one, as both are near landmark {}", near.center()),
                    });
                }
            }
        }
        Ok(())
    }
}

/// A waist as it is in a file, before anything is known about it.
#[derive(Deserialize)]
#[serde(bound(deserialize = "S: Scalar + Deserialize<'de>"))]
struct Unchecked<S> {
    strata: Table<Landmark, u8>,
    curve_edges: Vec<CurveEdge>,
    neighborhoods: Vec<CellNeighborhood>,
    distances: SparseDistances<S>,
}

impl<S: Scalar> TryFrom<Unchecked<S>> for StratifiedLandmarks<S> {
    type Error = Error;

    fn try_from(file: Unchecked<S>) -> Result<Self, Error> {
        Self::new(
            file.strata,
            file.curve_edges,
            file.neighborhoods,
            file.distances,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, from_value, json, to_value};

    /// Two triangles on an edge of a curve.
    fn waist() -> StratifiedLandmarks<f64> {
        let around = |center: u32| {
            let others = [0, 1].map(Landmark::new);
            CellNeighborhood::new(center.into(), others)
        };
        let neighborhoods = vec![around(2), around(3)];
        let apart = |a: Landmark, b: Landmark| (a.index() + b.index()) as f64;
        let distances = SparseDistances::within(4, &neighborhoods, apart).unwrap();
        let (strata, edges) = (vec![1, 1, 2, 2].into(), vec![CurveEdge::new(0, 1, 2)]);
        StratifiedLandmarks::new(strata, edges, neighborhoods, distances).unwrap()
    }

    #[test]
    fn a_file_gives_back_what_was_written() {
        let file = to_value(waist()).unwrap();
        assert_eq!(
            from_value::<StratifiedLandmarks<f64>>(file).unwrap(),
            waist()
        );
    }

    #[test]
    fn a_broken_file_is_refused() {
        let says = |change: fn(&mut Value), part: &str| {
            let mut file = to_value(waist()).unwrap();
            change(&mut file);
            let read = from_value::<StratifiedLandmarks<f64>>(file);
            let error = read.unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        };
        says(|f| f["strata"][3] = json!(3), "dimension 3");
        says(|f| f["strata"][0] = json!(2), "of a surface cell");
        says(
            |f| drop(f["strata"].as_array_mut().unwrap().pop()),
            "of 4 landmarks",
        );
        says(|f| f["curve_edges"][0]["ends"][1] = json!(9), "landmark 9");
        says(
            |f| f["neighborhoods"][0]["members"][1] = json!(9),
            "landmark 9",
        );
        says(
            |f| f["neighborhoods"][0]["members"][1] = json!(3),
            "no distance",
        );
        says(
            |f| f["neighborhoods"][0]["members"][1] = json!(1),
            "landmark 1 twice near landmark 2",
        );
        says(
            |f| f["neighborhoods"][0]["center"] = json!(1),
            "center first",
        );
        says(
            |f| f["neighborhoods"][0]["members"] = json!([]),
            "center first",
        );
        says(
            |f| f["distances"]["starts"][1] = json!(99),
            "rows one after the other",
        );
    }

    #[test]
    fn ends_of_an_edge_come_in_order_from_a_file() {
        let mut file = to_value(waist()).unwrap();
        file["curve_edges"][0]["ends"] = json!([1, 0]);
        let read: StratifiedLandmarks<f64> = from_value(file).unwrap();
        assert_eq!(read, waist());
    }
}
