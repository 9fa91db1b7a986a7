//! What tiles are asked, and what they answer.

use super::cells;
use super::gathered::{Gathered, lost};
use super::greedy;
use super::tile::{CloudRow, ROUNDING, Tile};
use crate::certificate::distances_to_mesh;
use crate::execute::Serial;
use crate::tuning::CellTuning;
use crosscap_core::{CellNeighborhood, Complex, Error, Mesh, PointCloud, Row};
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
    /// Distance from which a point is far, unit of the data.
    pub far: f64,
    /// How many of its nearest others are wanted.
    pub company: usize,
}

/// What neighborhoods depend on beside the points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellQuestion {
    /// All landmarks, in their order.
    pub landmarks: Vec<CloudRow>,
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
    /// Neighborhoods.
    Cells(Vec<CellNeighborhood>),
    /// Nearest points of places, in no order, and the numbers of those places in the box whose nearest point may be
    /// beyond the halo.
    Nearest {
        /// The points.
        points: Gathered,
        /// Places without an answer.
        beyond: Vec<u32>,
    },
}

impl Tile {
    /// The answer to a question.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is larger than the halo lets this tile answer for,
    /// [`Error::SparseNeighborhood`] where the nearest neighbors of a point in a chart may be beyond the halo,
    /// [`Error::Shape`] for places of another dimension.
    pub fn answer(&self, question: &Question) -> Result<Answer, Error> {
        Ok(match question {
            Question::Copies => Answer::Points(self.copies()),
            Question::Landmarks { separation, taken } => {
                self.reaches("dl", *separation)?;
                let greedy::Round { chosen, open } = greedy::round(self, *separation, taken);
                Answer::Landmarks {
                    ranks: chosen.iter().map(|&row| self.rank(row)).collect(),
                    chosen: self.gathered(chosen),
                    open,
                }
            }
            Question::Cells(cells) => {
                let reach = cells::halo(cells.dl, cells.tri_eps, &cells.tuning);
                self.reaches("tri_eps", reach)?;
                Answer::Cells(cells::neighborhoods(self, cells)?)
            }
            Question::Nearest { places, alone } => self.nearest(&self.list(places)?, *alone),
            Question::Around { places, radius } => {
                Answer::Points(self.around(&self.list(places)?, *radius))
            }
            Question::Rows(rows) => {
                let own = rows.iter().filter_map(|&row| self.find(row));
                Answer::Points(self.gathered(own.filter(|&row| self.owns(row))))
            }
            Question::Behind(behind) => Answer::Points(self.behind(behind)?),
        })
    }

    /// # Errors
    /// [`Error::Parameter`] for a length that is larger than the halo.
    fn reaches(&self, name: &'static str, length: f64) -> Result<(), Error> {
        if length <= self.halo() {
            return Ok(());
        }
        Err(Error::Parameter {
            name,
            value: format!("such that points up to {length} away matter"),
            expected: format!("at most {}, the halo of the tile", self.halo()),
        })
    }

    /// # Errors
    /// [`Error::Shape`] for places of another dimension.
    fn list(&self, places: &[f64]) -> Result<PointCloud<f64>, Error> {
        PointCloud::new(self.points().dimension(), places.to_vec())
    }

    fn copies(&self) -> Gathered {
        let mut order: Vec<Row> = self.ids().filter(|&row| self.owns(row)).collect();
        // Negative and positive zero are equal.
        let place = |row: Row| self.place(row).iter().map(|x| x + 0.0);
        order.sort_by(|&a, &b| {
            let pairs = place(a).zip(place(b)).map(|(x, y)| x.total_cmp(&y));
            let first = pairs.into_iter().find(|order| order.is_ne());
            first.unwrap_or(a.cmp(&b))
        });
        let later = order
            .windows(2)
            .filter(|pair| place(pair[0]).eq(place(pair[1])));
        self.gathered(later.map(|pair| pair[1]))
    }

    fn nearest(&self, places: &PointCloud<f64>, alone: bool) -> Answer {
        let mut found = vec![false; self.len()];
        let mut beyond = Vec::new();
        let counts = |row: Row| !alone || self.owns(row);
        for (k, place) in (0..).zip(places.iter()) {
            if !alone && !self.bounds().hold(place) {
                continue;
            }
            let least = if alone {
                let own = self.ids().filter(|&row| self.owns(row));
                let squares =
                    own.map(|row| crosscap_core::squared_distance(place, self.place(row)));
                squares.min_by(f64::total_cmp)
            } else {
                self.tree().nearest(place, |_| true).map(|near| near.1)
            };
            let Some(square) = least.filter(|s| alone || s.sqrt() <= self.halo()) else {
                beyond.extend((!alone).then_some(k));
                continue;
            };
            // What is as near within rounding is as near for someone who sums in another order.
            let reach = square.sqrt() * (1.0 + ROUNDING) + f64::MIN_POSITIVE;
            self.tree()
                .within(place, reach * (1.0 + ROUNDING), |row, _| {
                    found[row as usize] |= counts(Row::from(row));
                });
        }
        let points = self.gathered(self.ids().filter(|row| found[row.index()]));
        Answer::Nearest { points, beyond }
    }

    fn around(&self, places: &PointCloud<f64>, radius: f64) -> Gathered {
        let mut found = vec![false; self.len()];
        let near = places
            .iter()
            .filter(|place| self.bounds().reach(place, radius));
        for place in near {
            self.tree()
                .within(place, radius * (1.0 + ROUNDING), |row, _| {
                    found[row as usize] = true;
                });
        }
        self.gathered(
            self.ids()
                .filter(|&row| found[row.index()] && self.owns(row)),
        )
    }
}

impl Tile {
    /// # Errors
    /// [`Error::SparseNeighborhood`] where the nearest others of a point may be beyond the halo; those of a mesh that is none.
    fn behind(&self, question: &BehindQuestion) -> Result<Gathered, Error> {
        let vertices = self.list(&question.vertices)?;
        let complex = Complex::new(vertices.len(), question.triangles.clone(), Vec::new())?;
        let named = vec![-1; vertices.len()];
        let heights = distances_to_mesh(&Mesh::new(complex, vertices, named)?, self.points());
        let far = |row: Row| self.owns(row) && heights[row.index()] > question.far;
        let company = question.company;
        let near = self.tree().nearest_of_each(
            company,
            |k| far(Row::from(k)),
            &Serial,
            |k, near| {
                let last = near.last().map_or(f64::INFINITY, |x| x.square().sqrt());
                (Row::from(k), near.len(), last)
            },
        );
        let mut found = vec![false; self.len()];
        for (row, count, last) in near {
            if count < company || last > self.known(row) {
                return Err(Error::SparseNeighborhood {
                    point: self.cloud_row(row).index(),
                    found: count,
                    needed: company,
                    parameter: "dl",
                });
            }
            let reach = last * (1.0 + ROUNDING) + f64::MIN_POSITIVE;
            self.tree()
                .within(self.place(row), reach * (1.0 + ROUNDING), |k, _| {
                    found[k as usize] = true;
                });
        }
        Ok(self.gathered(self.ids().filter(|row| found[row.index()])))
    }
}

/// How far the points of a tile have to go beyond its box for all questions about a surface with these lengths.
pub fn halo(dl: f64, tri_eps: f64, tuning: &CellTuning) -> f64 {
    cells::halo(dl, tri_eps, tuning).max(dl)
}

/// Whoever has the tiles of a cloud: threads of this process, or other machines.
pub trait Tiles {
    /// Number of points of the cloud.
    fn points(&self) -> usize;

    /// Number of coordinates.
    fn dimension(&self) -> usize;

    /// How far the points of every tile go beyond its box.
    fn halo(&self) -> f64;

    /// The answers of all tiles to a question, in any order that is the same at every call.
    ///
    /// # Errors
    /// Those of [`Tile::answer`], and what keeps a tile from being asked.
    fn ask(&self, question: &Question) -> Result<Vec<Answer>, Error>;

    /// The points that all tiles answer with, in the order of their rows, each once.
    ///
    /// # Errors
    /// Those of [`ask`](Self::ask).
    fn gather(&self, question: &Question) -> Result<Gathered, Error> {
        let mut all = Gathered::new(self.dimension());
        for answer in self.ask(question)? {
            if let Answer::Points(points) | Answer::Nearest { points, .. } = &answer {
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
