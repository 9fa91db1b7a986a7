//! Decomposition of a neighborhood into points, curves and cells.

use crate::{Label, LocalPoints};
use serde::{Deserialize, Serialize};

/// One stratum of a decomposed neighborhood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stratum {
    /// 0: a point (triple point, end of a double curve); 1: a curve (double curve, boundary);
    /// 2: a cell, an open piece of surface that no curve runs through.
    pub dimension: u8,
}

/// A neighborhood cut into strata, with every point labelled.
///
/// # Invariants
/// `labels[k]` is an index into `strata`: points, curves and cells partition the neighborhood. What else must agree,
/// [`Decomposition::check`] says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Decomposition {
    /// The strata, those of lowest dimension first.
    pub strata: Vec<Stratum>,
    /// For each point of the neighborhood, the stratum it is in.
    pub labels: Vec<Label>,
    /// For each curve (in the order of `strata`) the number of cells that meet in it: the
    /// number of triangles that an edge along it must have.
    pub cells_at_curve: Vec<u8>,
    /// Root mean squared distance of the fitted points to the model, in the unit of the data.
    pub residual: f64,
    /// Number of free parameters of the fit, what a comparison of models penalizes.
    pub parameters: usize,
    /// Places of the strata of dimension 0, in the order of `strata`, in local coordinates; no farther
    /// from the center than twice the radius of the neighborhood.
    pub points: Vec<Vec<f64>>,
    /// The center moved onto the stratum it belongs to, in local coordinates. A center inside a cell
    /// is moved onto the first curve, where there is one that it tells about; elsewhere it stays.
    pub center: Vec<f64>,
    /// Distance of the unmoved center to that place; infinite for a center inside a cell that
    /// tells nothing about a curve.
    pub center_offset: f64,
}

impl Decomposition {
    /// The stratum that a label names.
    fn stratum(&self, label: Label) -> Stratum {
        self.strata[label.index()]
    }

    /// Whether a label names a stratum of this dimension.
    pub fn is_of(&self, label: Label, dimension: u8) -> bool {
        self.stratum(label).dimension == dimension
    }

    /// The labels that name a stratum of this dimension.
    pub fn labels_of(&self, dimension: u8) -> impl Iterator<Item = Label> {
        let all = (0..self.strata.len()).map(Label::new);
        all.filter(move |&label| self.is_of(label, dimension))
    }

    /// Dimension of the stratum that point `k` of the neighborhood lies in.
    pub fn dimension_of(&self, k: usize) -> u8 {
        self.stratum(self.labels[k]).dimension
    }

    /// Number of cells that meet in the curve that `label` names; `None` when it names no curve.
    pub fn cells_at(&self, label: Label) -> Option<u8> {
        let first = self.strata.iter().filter(|s| s.dimension == 0).count();
        (self.strata.get(label.index())?.dimension == 1)
            .then(|| self.cells_at_curve.get(label.index() - first).copied())
            .flatten()
    }

    /// What is said of the center, which is row `k`.
    pub fn located(&self, k: usize) -> Located {
        Located {
            dimension: self.dimension_of(k),
            cells: match self.dimension_of(k) {
                0 => 0,
                1 => self.cells_at(self.labels[k]).unwrap_or(0),
                _ => self.cells_at_curve.first().copied().unwrap_or(0),
            },
            place: self.center.clone(),
            offset: self.center_offset,
        }
    }
}

/// What is wrong with a decomposition: see [`Decomposition::check`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// The law that does not hold.
    pub law: &'static str,
    /// What was found instead.
    pub found: String,
}

/// Lengths that are said to be equal may differ by this share of the radius.
const ROUNDING: f64 = 1e-6;
/// Strata of dimension 0 lie within this many radii of the center: the ball of a neighborhood is about one of
/// its points, and the center may be another one.
const REACH: f64 = 2.0;

fn require(
    holds: bool,
    law: &'static str,
    found: impl FnOnce() -> String,
) -> Result<(), Contradiction> {
    if holds {
        return Ok(());
    }
    Err(Contradiction {
        law,
        found: found(),
    })
}

impl Decomposition {
    /// Whether what it says of `local` can be true at all: every point has a label that names a stratum, the
    /// numbers of cells at curves go with the cells there are, places lie in the neighborhood, and
    /// labels, places and offsets agree with each other.
    ///
    /// Both the law kit and the pipeline ask this. O(points + strata).
    ///
    /// # Errors
    /// The first [`Contradiction`], in this order.
    pub fn check(&self, local: &LocalPoints<'_>) -> Result<(), Contradiction> {
        self.partitions(local)?;
        self.counts_cells()?;
        self.places_points(local)?;
        let residual = self.residual;
        require(
            residual >= 0.0 && residual.is_finite(),
            "the residual is finite and at least 0",
            || residual.to_string(),
        )?;
        let own = local.point(local.center);
        let center = Located {
            dimension: self.dimension_of(local.center),
            cells: 0,
            place: self.center.clone(),
            offset: self.center_offset,
        };
        center.check(own, local.radius)?;
        if center.dimension == 0 {
            let point = &self.points[self.labels[local.center].index()];
            require(
                distance(point, &self.center) <= ROUNDING * local.radius,
                "a center on a stratum of dimension 0 is moved to its point",
                || format!("it is moved to {:?}, the point is {point:?}", self.center),
            )?;
        }
        Ok(())
    }

    fn partitions(&self, local: &LocalPoints<'_>) -> Result<(), Contradiction> {
        let law = "partition: every point has exactly one label";
        let (labels, points) = (self.labels.len(), local.len());
        require(labels == points, law, || {
            format!("{labels} labels for {points} points")
        })?;
        let strata = self.strata.len();
        let wild = self.labels.iter().find(|l| l.index() >= strata);
        require(wild.is_none(), law, || {
            let wild = wild.copied().unwrap_or_default();
            format!("the label {wild} of {strata} strata")
        })?;
        let dimensions: Vec<u8> = self.strata.iter().map(|s| s.dimension).collect();
        require(
            dimensions.is_sorted() && dimensions.iter().all(|&d| d <= 2),
            "strata of lowest dimension first, none above 2",
            || format!("the strata have the dimensions {dimensions:?}"),
        )
    }

    /// A cell of a ball meets a curve that goes through the ball from one side; where a curve ends in a
    /// point it may meet it from two.
    fn counts_cells(&self) -> Result<(), Contradiction> {
        let of = |dimension: u8| {
            let same = self.strata.iter().filter(|s| s.dimension == dimension);
            same.count()
        };
        let (points, curves, cells) = (of(0), of(1), of(2));
        let said = &self.cells_at_curve;
        let law = "cells_at_curve: the number of cells at every curve, of those there are";
        require(said.len() == curves, law, || {
            format!("{said:?} for {curves} curves")
        })?;
        let sides = if points == 0 { 1 } else { 2 };
        let most = sides * cells;
        require(said.iter().all(|&k| usize::from(k) <= most), law, || {
            format!("{said:?} with {cells} cells")
        })?;
        let total: usize = said.iter().map(|&k| usize::from(k)).sum();
        let apart = points > 0 || curves == 0 || cells < 2;
        require(apart || total >= cells, law, || {
            format!("{said:?}: nothing else tells {cells} cells apart")
        })
    }

    fn places_points(&self, local: &LocalPoints<'_>) -> Result<(), Contradiction> {
        let strata = self.strata.iter().filter(|s| s.dimension == 0).count();
        let (places, dimension) = (&self.points, local.dimension);
        let placed = |p: &Vec<f64>| p.len() == dimension && p.iter().all(|x| x.is_finite());
        require(
            places.len() == strata && places.iter().all(placed),
            "points: a place for every stratum of dimension 0",
            || format!("{places:?} for {strata} strata, in {dimension} coordinates"),
        )?;
        let own = local.point(local.center);
        let far = |p: &&Vec<f64>| distance(p, own) > REACH * local.radius * (1.0 + ROUNDING);
        let beyond = places.iter().find(far);
        require(
            beyond.is_none(),
            "points: no farther from the center than twice the radius",
            || {
                let away = beyond.map_or(0.0, |p| distance(p, own));
                format!("{away} away, the radius is {}", local.radius)
            },
        )
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    crate::squared_distance(a, b).sqrt()
}

/// Where a decomposition puts a point of its neighborhood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Located {
    /// Dimension of the stratum that the point is in.
    pub dimension: u8,
    /// Number of cells that meet in the curve that it is on, or that is near.
    pub cells: u8,
    /// As [`Decomposition::center`].
    pub place: Vec<f64>,
    /// As [`Decomposition::center_offset`].
    pub offset: f64,
}

impl Located {
    /// Whether this can be true of a point whose unmoved place is `own`, in a neighborhood of the given
    /// `radius`: the place is one, the offset is its distance, and a point on a curve or on a stratum of dimension 0 is
    /// moved by no more than the radius.
    ///
    /// # Errors
    /// The first [`Contradiction`].
    pub fn check(&self, own: &[f64], radius: f64) -> Result<(), Contradiction> {
        let (place, offset) = (&self.place, self.offset);
        require(
            place.len() == own.len() && place.iter().all(|x| x.is_finite()),
            "the center has finite coordinates, local_dimension of them",
            || format!("{place:?}"),
        )?;
        let on_it = self.dimension < 2;
        require(
            self.dimension <= 2 && offset >= 0.0 && (offset.is_finite() || !on_it),
            "the center offset is at least 0, and finite where the center is on a curve or point",
            || format!("{offset} on a stratum of dimension {}", self.dimension),
        )?;
        let moved = distance(place, own);
        let told = if offset.is_finite() { offset } else { 0.0 };
        require(
            (told - moved).abs() <= ROUNDING * (radius + moved),
            "the center offset is how far the center is moved, infinite where it stays in a cell",
            || format!("{offset}, while the place is {moved} away"),
        )?;
        require(
            !on_it || moved <= radius * (1.0 + ROUNDING),
            "the center offset of a center on a curve or point is at most the radius",
            || format!("{offset}, the radius is {radius}"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two half planes at a line through the first of four points.
    fn crease() -> Decomposition {
        Decomposition {
            strata: [1, 2, 2].map(|dimension| Stratum { dimension }).to_vec(),
            labels: [0, 1, 2, 1].map(Label::new).to_vec(),
            cells_at_curve: vec![2],
            center: vec![0.1, 0.0, 0.0],
            center_offset: 0.1,
            ..Decomposition::default()
        }
    }

    fn found(change: impl FnOnce(&mut Decomposition)) -> Result<(), &'static str> {
        let mut fit = crease();
        change(&mut fit);
        let rows = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.4, 0.0, 0.1]];
        let local = LocalPoints {
            dimension: 3,
            coordinates: rows.as_flattened(),
            fitted: 4,
            center: 0,
            middle: 0,
            radius: 1.0,
        };
        fit.check(&local).map_err(|c| c.law)
    }

    #[test]
    fn contradictions_are_found() {
        assert_eq!(found(|_| ()), Ok(()));
        let law = |change: fn(&mut Decomposition)| found(change).unwrap_err();
        for cells in [vec![0], vec![1], vec![3], vec![9], vec![], vec![2, 0]] {
            let says = found(|fit| fit.cells_at_curve = cells).unwrap_err();
            assert!(says.starts_with("cells_at_curve"));
        }
        let moved = law(|fit| fit.center = vec![5.0, 0.0, 0.0]);
        assert!(moved.starts_with("the center offset is how far"));
        let far = law(|fit| (fit.center, fit.center_offset) = (vec![5.0, 0.0, 0.0], 5.0));
        assert!(far.contains("at most the radius"));
        // In a cell, a curve may be far away, or unknown.
        let inside = |center: [f64; 3], offset: f64| {
            found(|fit| {
                fit.labels[0] = Label::new(1);
                (fit.center, fit.center_offset) = (center.to_vec(), offset);
            })
        };
        assert_eq!(inside([5.0, 0.0, 0.0], 5.0), Ok(()));
        assert_eq!(inside([0.0; 3], f64::INFINITY), Ok(()));
        assert!(inside([0.2, 0.0, 0.0], f64::INFINITY).is_err());
    }

    #[test]
    fn a_point_has_its_place() {
        let apex = |place: [f64; 3], center: [f64; 3], cells: u8| {
            found(|fit| {
                fit.strata.insert(0, Stratum { dimension: 0 });
                fit.cells_at_curve = vec![cells];
                fit.points = vec![place.to_vec()];
                fit.center = center.to_vec();
                fit.center_offset = distance(&center, &[0.0; 3]);
                fit.labels = [0, 2, 3, 2].map(Label::new).to_vec();
            })
        };
        assert_eq!(apex([0.1, 0.0, 0.0], [0.1, 0.0, 0.0], 4), Ok(()));
        assert_eq!(apex([0.1, 0.0, 0.0], [0.1, 0.0, 0.0], 0), Ok(()));
        assert!(apex([0.1, 0.0, 0.0], [0.1, 0.0, 0.0], 5).is_err());
        assert!(apex([0.1, 0.0, 0.0], [0.2, 0.0, 0.0], 4).is_err());
        let far = apex([5.0, 0.0, 0.0], [0.1, 0.0, 0.0], 4).unwrap_err();
        assert!(far.contains("twice the radius"));
    }
}
