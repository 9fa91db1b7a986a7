//! A point in the plane at which curves end, with points along them: what tests of the skeleton are asked on.

use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::metric::{BruteForceOracle, Euclidean};
use crate::space::Space;
use crate::stratify::analysis::{Analysis, Analyzer};
use crate::stratify::curve_ends::EndRegion;
use crate::stratify::site::{FitUsed, On, StratumKind};
use crate::stratify::strata::Strata;
use crate::tuning::Tuning;
use crosscap_core::{Decomposition, Label, PointCloud, Row, Stratum};

/// A place in the plane.
pub(super) type Place = [f64; 2];

/// A point that was found on a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) place: Place,
    /// What the fit about the point at the origin calls it, if that knows it.
    pub(super) label: Option<Label>,
    /// How many cells meet in its curve.
    pub(super) cells: u8,
}

/// A point at the origin, row 0, and the points of curves about it.
pub(super) struct AboutPoint {
    cloud: PointCloud<f64>,
    strata: Strata,
}

impl AboutPoint {
    /// The fit about the point counts the point, label 0, a curve for each of `cells`, labels 1 and on, in which that many cells meet, and
    /// one cell, whose label is the last; it reaches as far as `reach`.
    pub(super) fn new(kind: StratumKind, cells: &[u8], found: &[Found], reach: f64) -> Self {
        let places = found.iter().flat_map(|x| x.place);
        let cloud = PointCloud::new(2, [0.0; 2].into_iter().chain(places).collect()).unwrap();
        let labels =
            (found.iter().enumerate()).filter_map(|(k, x)| Some((Row::new(1 + k), x.label?)));
        let own = (Row::new(0), Label::default());
        let labels = [std::iter::once(own).chain(labels).collect(), Vec::new()];
        let of = |dimension, count| std::iter::repeat_n(Stratum { dimension }, count);
        let fit = Decomposition {
            strata: of(0, 1).chain(of(1, cells.len())).chain(of(2, 1)).collect(),
            labels: Vec::new(),
            cells_at_curve: cells.to_vec(),
            residual: 0.0,
            parameters: 0,
            points: vec![vec![0.0, 0.0]],
            center: vec![0.0, 0.0],
            center_offset: 0.0,
        };
        let used = FitUsed {
            model: 0,
            radius: reach,
        };
        let mut strata = Strata::as_found(&Analysis::of_surface(cloud.len()), Some(&cloud));
        for (k, row) in strata.rows().enumerate() {
            let point = k.checked_sub(1).map(|k| &found[k]);
            let on = On {
                kind: point.map_or(StratumKind::Point, |_| kind),
                place: None,
                moved: 0.0,
                fit: point.is_none().then_some(used),
                cells: point.map_or(0, |x| x.cells),
            };
            strata.enter(&cloud, row, Some(on));
        }
        strata.add_region(EndRegion::new(labels, fit, vec![0.0; 2], reach, used));
        Self { cloud, strata }
    }

    /// Asks with the numbers as they were measured.
    pub(super) fn ask<T>(&self, ask: impl FnOnce(&Analyzer<'_, f64>, &Strata) -> T) -> T {
        let metric = Euclidean::new(self.cloud.clone());
        let oracle = BruteForceOracle::new(&metric);
        let analyzer = Analyzer {
            space: Space::new(&metric, &oracle),
            estimator: &PrincipalComponents::new(0.05).unwrap(),
            models: &[],
            execute: &Serial,
            tuning: &Tuning::MEASURED,
        };
        ask(&analyzer, &self.strata)
    }
}
