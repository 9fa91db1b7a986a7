//! The same cloud as a whole and in tiles.

use crosscap::prelude::*;
use crosscap_algorithms::certificate::Limits;
use crosscap_algorithms::execute::Serial;
use crosscap_algorithms::tiles::{Answer, CloudRow, Question, Tiles, TilesInMemory, Tiling};
use std::cell::RefCell;

/// Tiles that count what is asked of them.
struct Counted<'a> {
    tiles: TilesInMemory<'a>,
    asked: RefCell<Asked>,
}

/// What was asked.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// The names of the questions.
    pub names: Vec<&'static str>,
    /// How many points questions what is around some places were answered with.
    pub around: Vec<usize>,
}

impl Tiles for Counted<'_> {
    fn points(&self) -> usize {
        self.tiles.points()
    }

    fn dimension(&self) -> usize {
        self.tiles.dimension()
    }

    fn halo(&self) -> f64 {
        self.tiles.halo()
    }

    fn bar(&self, rows: &[CloudRow]) -> Result<(), Error> {
        self.tiles.bar(rows)
    }

    fn ask(&self, question: &Question) -> Result<Vec<Answer>, Error> {
        let name = match question {
            Question::Copies => "copies",
            Question::Landmarks { .. } => "landmarks",
            Question::Cells(_) => "cells",
            Question::Balls(_) => "balls",
            Question::Nearest { .. } => "nearest",
            Question::Around { .. } => "around",
            Question::Rows(_) => "rows",
            Question::Behind(_) => "behind",
        };
        let answers = self.tiles.ask(question)?;
        let mut asked = self.asked.borrow_mut();
        asked.names.push(name);
        if name == "around" {
            let points = answers.iter().map(|answer| match answer {
                Answer::Points(points) => points.len(),
                _ => 0,
            });
            let points: usize = points.sum();
            asked.around.push(points);
        }
        Ok(answers)
    }
}

/// All that must not depend on tiles.
fn told(outcome: &Outcome) -> String {
    let Outcome {
        mesh,
        homology,
        certificate,
        pieces,
        failures,
        report,
        ..
    } = outcome;
    let counts = [
        report.added_landmarks,
        report.candidates,
        report.curve_points,
        report.unexplained,
    ];
    format!(
        "{mesh:?} {homology:?} {certificate:?} {pieces:?} {failures:?} {:?} {:?} {:?} {:?} {counts:?}",
        report.landmarks, report.triangulation, report.chart_distortion, report.models
    )
}

/// Reconstructs a cloud as a whole and in so many tiles, and returns the outcome and what was asked of the tiles.
pub fn same(
    cloud: &PointCloud<f64>,
    parameters: &Parameters,
    looked_at: usize,
    tiles: &[usize],
) -> (Outcome, Asked) {
    let pipeline = || {
        let limits = Limits {
            points_tested: looked_at,
            ..Limits::default()
        };
        Pipeline::new(parameters.clone()).unwrap().limits(limits)
    };
    let whole = pipeline().reconstruct(cloud).unwrap();
    let mut asked = Asked::default();
    for &count in tiles {
        let halo = pipeline().tile_halo();
        let tiling = Tiling::new(cloud, count);
        assert_eq!(tiling.bounds().len(), count);
        let counted = Counted {
            tiles: TilesInMemory::new(cloud, &tiling, halo, parameters.seed, &Serial).unwrap(),
            asked: RefCell::default(),
        };
        let found = pipeline().reconstruct_tiles(&counted).unwrap();
        assert!(told(&found) == told(&whole), "{count} tiles");
        asked = counted.asked.into_inner();
    }
    (whole, asked)
}

pub fn sample(name: &str, count: usize, seed: u64) -> PointCloud<f64> {
    let surface = SampleSurface::find(name).unwrap();
    surface.sample(&Sampling::new(count, seed)).unwrap().points
}
