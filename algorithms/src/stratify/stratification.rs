//! A waist, and what ties it to the points.

use super::analysis::ModelCounts;
use crosscap_core::{Error, Landmark, Link, Row, Scalar, StratifiedLandmarks, Table};
use serde::{Deserialize, Serialize};

/// What the stratification counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StratifyCounts {
    /// Landmarks.
    pub landmarks: usize,
    /// Landmarks on curves and points.
    pub curve_landmarks: usize,
    /// Landmarks that are points where curves end.
    pub corners: usize,
    /// Chain edges.
    pub curve_edges: usize,
    /// Edges of the neighbor graph that the labels cut.
    pub cut_edges: usize,
    /// Mean number of members of a neighborhood.
    pub mean_members: f64,
}

/// A landmark at a 0-stratum, with what meets there by the model that found it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointStratum {
    /// The landmark.
    pub landmark: Landmark,
    /// Number of curves that end there.
    pub curves: usize,
    /// Number of cells that have it at their rim.
    pub cells: usize,
    /// Its link, where the model knows it.
    pub link: Option<Link>,
}

/// The waist, and what ties it to the points.
#[derive(Clone, Debug)]
pub struct Stratification<S> {
    /// What the triangulator takes.
    pub waist: StratifiedLandmarks<S>,
    /// Row of the input that each landmark stands for.
    pub rows: Table<Landmark, Row>,
    /// The 0-strata that a model found.
    pub points: Vec<PointStratum>,
    /// Counts for the report.
    pub counts: StratifyCounts,
    /// What became of every model that was asked after the analysis; nothing where none was.
    pub models: Vec<ModelCounts>,
}

impl<S: Scalar> Stratification<S> {
    /// A waist and the rows that its landmarks stand for, counted.
    pub fn new(waist: StratifiedLandmarks<S>, rows: Table<Landmark, Row>) -> Self {
        let members: usize = waist
            .neighborhoods()
            .iter()
            .map(|x| x.members().len())
            .sum();
        let of = |least: u8| waist.strata().iter().filter(|&&d| d <= least).count();
        Self {
            counts: StratifyCounts {
                landmarks: rows.len(),
                curve_landmarks: of(1),
                corners: of(0),
                curve_edges: waist.curve_edges().len(),
                cut_edges: 0,
                mean_members: members as f64 / waist.neighborhoods().len().max(1) as f64,
            },
            waist,
            rows,
            points: Vec::new(),
            models: Vec::new(),
        }
    }

    /// Whether this can be what a producer of waists named `plugin` makes of so many `points`: every landmark stands for a
    /// row of its own, and strata of dimension 0 are at landmarks. What the waist itself must satisfy it does, or there were none.
    ///
    /// # Errors
    /// [`Error::Law`] for the first landmark of which it is not true.
    pub fn check(&self, plugin: &str, points: usize) -> Result<(), Error> {
        let broken = |landmark: Landmark, detail: String| {
            Err(Error::Law {
                plugin: plugin.into(),
                law: "answer: every landmark stands for a row of its own, and points are at landmarks",
                point: landmark.index(),
                detail,
            })
        };
        let count = self.waist.strata().len();
        if self.rows.len() != count {
            let detail = format!("{} rows for {count} landmarks", self.rows.len());
            return broken(Landmark::default(), detail);
        }
        let mut seen: Table<Row, bool> = Table::filled(points, false);
        for (k, &row) in self.rows.each() {
            match seen.get_mut(row) {
                Some(taken) if !*taken => *taken = true,
                Some(_) => return broken(k, format!("row {row} has a landmark already")),
                None => return broken(k, format!("row {row} of {points}")),
            }
        }
        let stray = self.points.iter().find(|p| {
            let stratum = self.waist.strata().get(p.landmark);
            stratum != Some(&0)
        });
        match stray {
            Some(p) => {
                let k = p.landmark;
                broken(
                    k,
                    format!("a point at landmark {k} of {count}, which is none"),
                )
            }
            None => Ok(()),
        }
    }
}
