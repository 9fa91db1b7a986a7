//! What a tile answers.

use super::balls;
use super::cells;
use super::gathered::Gathered;
use super::greedy;
use super::question::{Answer, BehindQuestion, Question};
use super::tile::{ROUNDING, Tile};
use crate::balls::BallTree;
use crate::certificate::distances_to_mesh;
use crate::execute::Serial;
use crate::tuning::CellTuning;
use crosscap_core::{Complex, Error, Mesh, PointCloud, Row, squared_distance};

/// With so many places about which points are looked for, or more, points are gone through instead of places.
const MANY_PLACES: usize = 1000;

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
                let (found, radii) = cells::neighborhoods(self, cells)?;
                Answer::Cells(found, radii)
            }
            Question::Balls(balls) => {
                self.reaches("eps", balls.eps)?;
                Answer::Balls(balls::of_tile(self, balls)?)
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
                let squares = own.map(|row| squared_distance(place, self.place(row)));
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
        let reach = radius * (1.0 + ROUNDING);
        let near = (places.iter()).filter(|place| self.bounds().reach(place, radius));
        let near: Vec<&[f64]> = near.collect();
        if near.len() < MANY_PLACES {
            for place in near {
                (self.tree()).within(place, reach, |row, _| found[row as usize] = true);
            }
        } else {
            // Whose balls overlap: a point is asked once.
            let tree = BallTree::new(places.dimension(), &near.concat());
            for row in self.ids() {
                found[row.index()] = tree.any_within(self.place(row), reach, |_, _| true);
            }
        }
        let own = self.ids().filter(|&row| found[row.index()]);
        self.gathered(own.filter(|&row| self.owns(row)))
    }
}

impl Tile {
    /// # Errors
    /// [`Error::SparseNeighborhood`] where the nearest others of a point may be beyond the halo; those of a mesh that is none.
    fn behind(&self, question: &BehindQuestion) -> Result<Gathered, Error> {
        let vertices = self.list(&question.vertices)?;
        let triangles = question.triangles.clone();
        let complex = Complex::new(vertices.len(), triangles, question.curve_edges.clone())?;
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
