//! What tiles are asked, what they answer, and who asks them.

use super::gathered::{Gathered, lost};
use super::row::CloudRow;
use crate::singularity::ModelName;
use crate::stratify::{ModelCounts, Seen};
use crate::tuning::{AnalysisTuning, CellTuning, ModelTuning};
use crosscap_core::{CellNeighborhood, CurveEdge, Error, Landmark};
use serde::{Deserialize, Serialize};

/// A question that every tile is asked. It holds all that is needed beside the points, so that a tile keeps nothing from
/// one question to the next: whoever lost an answer asks again, and whoever lost a tile makes it anew.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Question {
    /// Points in the box at the place of one with a smaller row.
    Copies,
    /// Which points in the box are landmarks at this separation, as far as it follows from those that are `taken`. Answered
    /// by [`Answer::Landmarks`].
    Landmarks {
        /// Landmark separation dl, unit of the data.
        separation: f64,
        /// Landmarks that are known.
        taken: Gathered,
    },
    /// The neighborhoods of the landmarks in the box. Answered by [`Answer::Cells`].
    Cells(CellQuestion),
    /// Which points in the box have a ball in which there is more than a sheet. Answered by [`Answer::Balls`].
    Balls(BallQuestion),
    /// The nearest point of each of some places, and others that are as near within rounding; for places in the box, of
    /// all points of the cloud that the tile knows. With `alone` for all places, of the points in the box.
    Nearest {
        /// The places, one after the other.
        places: Vec<f64>,
        /// Whether points in the box alone are looked at.
        alone: bool,
    },
    /// The points in the box at most `radius` from one of some places.
    Around {
        /// The places, one after the other.
        places: Vec<f64>,
        /// How far, unit of the data.
        radius: f64,
    },
    /// The points in the box with these rows of the cloud, given in order.
    Rows(Vec<CloudRow>),
    /// The points in the box that are far from a mesh, and the nearest others of each.
    Behind(BehindQuestion),
}

/// What is asked about points that a mesh leaves behind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BehindQuestion {
    /// Places of the vertices, one after the other.
    pub vertices: Vec<f64>,
    /// The triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Edges along curves.
    pub curve_edges: Vec<CurveEdge>,
    /// Distance from which a point is far, unit of the data.
    pub far: f64,
    /// How many of its nearest others are wanted.
    pub company: usize,
}

/// Which balls are asked about, when they count as 2-dimensional, by principal components, and what is looked for in those that are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallQuestion {
    /// Their radius (strict), unit of the data.
    pub eps: f64,
    /// Share of the variance that may lie outside the dimension (strict).
    pub dt: f64,
    /// Fewest points, the center among them, that a ball must hold.
    pub least: usize,
    /// Take every ball as 2-dimensional: nothing is asked but what models of boundaries see.
    pub surface: bool,
    /// What is looked for in balls that are 2-dimensional; nothing where no model asks for them.
    pub looks: Option<Box<LookQuestion>>,
}

/// What is looked for in balls that are 2-dimensional. Models have names, so that whoever has a tile can make them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LookQuestion {
    /// The models that compete.
    pub models: Vec<ModelName>,
    /// Fit tolerance, unit of the data.
    pub dp: f64,
    /// Curve tolerance, unit of the data.
    pub ep: f64,
    /// The numbers that decide which stratum a point is in.
    pub analysis: AnalysisTuning,
    /// When the models believe a fit.
    pub tuning: ModelTuning,
}

/// What neighborhoods depend on beside the points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellQuestion {
    /// All landmarks, in their order.
    pub landmarks: Vec<CloudRow>,
    /// Those whose neighborhoods are not wanted, in order: curves come near them.
    pub elsewhere: Vec<Landmark>,
    /// Landmark separation dl, unit of the data.
    pub dl: f64,
    /// Radius of the charts, unit of the data.
    pub tri_eps: f64,
    /// The numbers that decide.
    pub tuning: CellTuning,
}

/// What a tile answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answer {
    /// Some points, in no order.
    Points(Gathered),
    /// Landmarks that were not known, and what is still open.
    Landmarks {
        /// The landmarks.
        chosen: Gathered,
        /// Their places in the random order of the cloud.
        ranks: Vec<u32>,
        /// How many points in the box are neither landmarks nor close to one, as far as is known.
        open: usize,
    },
    /// Neighborhoods, and the radii of their charts, unit of the data.
    Cells(Vec<CellNeighborhood>, Vec<f64>),
    /// Balls.
    Balls(BallsOfTile),
    /// Nearest points of places, in no order, and the numbers of those places in the box whose nearest point may be
    /// beyond the halo.
    Nearest {
        /// The points.
        points: Gathered,
        /// Places without an answer.
        beyond: Vec<u32>,
    },
}

impl Answer {
    /// The points that were asked for, if they were.
    fn points(&self) -> Option<&Gathered> {
        match self {
            Self::Points(points) | Self::Nearest { points, .. } => Some(points),
            _ => None,
        }
    }
}

/// The balls of the points in a box.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BallsOfTile {
    /// The points whose balls are not 2-dimensional, or show more than a sheet.
    pub centers: Gathered,
    /// How many points these balls hold, and their dimensions.
    pub balls: Vec<[u32; 2]>,
    /// What models see in them, where they are 2-dimensional.
    pub seen: Vec<Option<Seen>>,
    /// What became of the models; nothing where none was asked.
    pub models: Vec<ModelCounts>,
    /// Sum of the numbers of points of all balls of the box; of 2-dimensional ones it may be the number of a ball close by.
    pub neighbors: u64,
    /// The first point whose ball holds fewer points than it must, and how many.
    pub sparse: Option<(CloudRow, u32)>,
}

/// Whoever has the tiles of a cloud: threads of this process, or other machines.
pub trait Tiles {
    /// Number of points of the cloud.
    fn points(&self) -> usize;

    /// Number of coordinates.
    fn dimension(&self) -> usize;

    /// How far the points of every tile go beyond its box.
    fn halo(&self) -> f64;

    /// The row of the input that a row of the cloud is: another number where copies were left out.
    fn input_row(&self, row: CloudRow) -> usize {
        row.index()
    }

    /// How many points of the input were left out, as they are at the place of another.
    fn left_out(&self) -> usize {
        0
    }

    /// Makes the random order of the points anew, without some rows of the cloud, given in order, which cannot be landmarks
    /// then: [`random_ranks_but`](crate::landmarks::random_ranks_but) of all points.
    ///
    /// # Errors
    /// What keeps tiles from being made anew.
    fn bar(&self, rows: &[CloudRow]) -> Result<(), Error>;

    /// The answers of all tiles to a question, in any order that is the same at every call.
    ///
    /// # Errors
    /// Those of [`Tile::answer`](super::Tile::answer), and what keeps a tile from being asked.
    fn ask(&self, question: &Question) -> Result<Vec<Answer>, Error>;

    /// The points that all tiles answer with, in the order of their rows, each once.
    ///
    /// # Errors
    /// Those of [`ask`](Self::ask).
    fn gather(&self, question: &Question) -> Result<Gathered, Error> {
        let answers = self.ask(question)?;
        let count = |answer: &Answer| answer.points().map_or(0, Gathered::len);
        let mut all = Gathered::with_room(self.dimension(), answers.iter().map(count).sum());
        // Whose points are taken is let go: they may be most of what is held.
        for answer in answers {
            if let Some(points) = answer.points() {
                all.extend(points);
            }
        }
        Ok(all.sorted())
    }

    /// The nearest points of all places, among them the first of those that are equally near.
    ///
    /// # Errors
    /// Those of [`ask`](Self::ask).
    fn nearest(&self, places: &[f64]) -> Result<Gathered, Error> {
        let width = self.dimension();
        let mut all = Gathered::new(width);
        let mut left = Vec::new();
        let question = Question::Nearest {
            places: places.to_vec(),
            alone: false,
        };
        for answer in self.ask(&question)? {
            if let Answer::Nearest { points, beyond } = answer {
                all.extend(&points);
                for k in beyond {
                    left.extend_from_slice(&places[k as usize * width..][..width]);
                }
            }
        }
        if !left.is_empty() {
            // Far from all points: every tile says which of its own is nearest.
            let question = Question::Nearest {
                places: left,
                alone: true,
            };
            all.extend(&self.gather(&question)?);
        }
        Ok(all.sorted())
    }

    /// The points of some rows, given in order.
    ///
    /// # Errors
    /// Those of [`ask`](Self::ask); [`Error::Shape`] for a row that no tile has.
    fn rows(&self, rows: Vec<CloudRow>) -> Result<Gathered, Error> {
        let question = Question::Rows(rows);
        let found = self.gather(&question)?;
        match &question {
            Question::Rows(rows) => match rows.iter().find(|&&row| found.find(row).is_none()) {
                None => Ok(found),
                Some(&row) => Err(lost(row)),
            },
            _ => Ok(found),
        }
    }
}
