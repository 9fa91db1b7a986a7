//! Balls, tile by tile: their dimensions, and what models see in those that are 2-dimensional.

use super::known::UpToHalo;
use super::question::{BallQuestion, BallsOfTile, LookQuestion};
use super::tile::Tile;
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::metric::Euclidean;
use crate::moments::MomentTree;
use crate::space::Space;
use crate::stratify::{AnalysisOptions, Analyzer, Looks};
use crate::tuning::Tuning;
use crosscap_core::{BallDimension, Error, Row, Table};

/// The balls of the points in the box. Those about points of the halo are cut, and looked at only as far as they are in a ball of the box.
///
/// # Errors
/// Those of [`MomentTree::settled_dimensions`] and of [`Analyzer::look_at_sheets`].
pub(super) fn of_tile(tile: &Tile, question: &BallQuestion) -> Result<BallsOfTile, Error> {
    let mut found = BallsOfTile::default();
    let balls = match question.surface {
        true => None,
        false => Some(dimensions(tile, question)?),
    };
    let own = |row: &Row| tile.owns(*row);
    let mut flat: Table<Row, bool> = tile.ids().map(|row| own(&row)).collect();
    if let Some(balls) = &balls {
        for row in tile.ids().filter(own) {
            let ball = balls[row];
            if (ball.neighbors as usize) < question.least && found.sparse.is_none() {
                found.sparse = Some((tile.cloud_row(row), ball.neighbors));
            }
            found.neighbors += u64::from(ball.neighbors);
            flat[row] = ball.dimension == 2;
        }
    }
    // Whoever asked goes no further where a ball is sparse.
    let looks = (question.looks.as_ref()).filter(|_| found.sparse.is_none());
    let mut seen = Vec::new();
    if let Some(looks) = looks {
        let looks = looked(tile, question, looks, &flat)?;
        (seen, found.models) = (looks.seen, looks.models);
    }
    let mut seen = seen.into_iter().peekable();
    let mut centers: Vec<Row> = Vec::new();
    for row in tile.ids().filter(own) {
        let shown = seen.next_if(|x| x.0 == row).map(|x| x.1);
        if shown.is_some() || !flat[row] {
            let ball = balls.as_ref().map_or(FLAT, |balls| balls[row]);
            centers.push(row);
            found.balls.push([ball.neighbors, ball.dimension]);
            found.seen.push(shown);
        }
    }
    found.centers = tile.gathered(centers);
    Ok(found)
}

/// A ball that is 2-dimensional on trust.
const FLAT: BallDimension = BallDimension {
    neighbors: 0,
    dimension: 2,
};

/// Number of points and dimension of the balls about points in the box.
fn dimensions(tile: &Tile, question: &BallQuestion) -> Result<Table<Row, BallDimension>, Error> {
    let near: Vec<usize> = (tile.ids())
        .filter(|&row| tile.bounds().reach(tile.place(row), question.eps))
        .map(Row::index)
        .collect();
    let part = tile.points().select(&near);
    let tree = MomentTree::with(&part, &Serial)?;
    let balls = tree.settled_dimensions(question.eps, question.dt, &Serial)?;
    // A value above the dimension of the space is an error of chance.
    let most = part.dimension().min(u8::MAX.into()) as u32;
    let mut all = Table::filled(tile.len(), FLAT);
    for (row, ball) in near.into_iter().map(Row::new).zip(balls) {
        all[row] = BallDimension {
            dimension: ball.dimension.min(most),
            ..ball
        };
    }
    Ok(all)
}

/// What models see in the balls that are `flat`.
fn looked(
    tile: &Tile,
    question: &BallQuestion,
    looks: &LookQuestion,
    flat: &Table<Row, bool>,
) -> Result<Looks, Error> {
    let tuning = &Tuning {
        analysis: looks.analysis.clone(),
        models: looks.tuning,
        ..Tuning::MEASURED
    };
    let models = looks.models.iter();
    let models = models.map(|name| name.tuned(looks.dp, looks.ep, &tuning.models));
    let models: Vec<_> = models.collect::<Result<_, _>>()?;
    let metric = Euclidean::new(tile.points().clone());
    let oracle = UpToHalo::new(tile);
    let estimator = PrincipalComponents::new(question.dt)?;
    let analyzer = Analyzer {
        space: Space::new(&metric, &oracle),
        estimator: &estimator,
        models: &models,
        execute: &Serial,
        tuning,
    };
    let options = AnalysisOptions {
        eps: question.eps,
        radii: None,
        surface: question.surface,
        boundary: Vec::new(),
    };
    let found = analyzer.look_at_sheets(&options, flat);
    oracle.sufficed()?;
    found.map_err(|mut error| {
        if let Error::Law { point, .. } = &mut error {
            *point = tile.cloud_row(Row::new(*point)).index();
        }
        error
    })
}
