//! Drawing a cloud from a sample surface.

use super::curves::RimWalk;
use super::sampling::Sampling;
use super::surface::SampleSurface;
use super::{Piece, Random, place_at, thin};
use crosscap_core::{Error, PointCloud};

/// A cloud with what is known about every point. Rows are in random order.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The points.
    pub points: PointCloud<f64>,
    /// For each point its parameters on its piece (see the piece for what they mean).
    pub parameters: Vec<[f64; 2]>,
    /// For each point the piece it was drawn from, an index into [`super::Truth::pieces`].
    pub pieces: Vec<u32>,
    /// Rows that were put exactly on the boundary, increasing.
    pub boundary: Vec<usize>,
}

struct Row {
    piece: u32,
    parameters: [f64; 2],
    boundary: bool,
}

impl SampleSurface {
    /// Draws a sample. O(count) for the drawing, see [`super::thin`] for the thinning.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a count of 0, a spacing that is not positive, a noise that is negative
    /// or not finite.
    pub fn sample(&self, sampling: &Sampling) -> Result<Sample, Error> {
        draw(self, sampling)
    }
}

fn draw(surface: &SampleSurface, sampling: &Sampling) -> Result<Sample, Error> {
    sampling.check()?;
    let dimension = surface.ambient_dimension();
    let pieces = surface.pieces();
    let counts = allot(surface, sampling);
    let mut rows: Vec<Row> = Vec::with_capacity(sampling.count);
    let mut coordinates = Vec::with_capacity(sampling.count * dimension);
    for (k, (piece, &count)) in pieces.iter().zip(&counts).enumerate() {
        let mut random = Random::stream(sampling.seed, 2 + k as u64);
        let drawn = piece.draw(count, sampling.law, &mut random);
        coordinates.extend(drawn.coordinates);
        rows.extend(drawn.parameters.into_iter().map(|parameters| Row {
            piece: k as u32,
            parameters,
            boundary: false,
        }));
    }
    let mut random = Random::stream(sampling.seed, 1);
    let mut points = PointCloud::new(dimension, coordinates)?;
    let mut order = random.permutation(rows.len());
    if let Some(spacing) = sampling.thinning {
        points = points.select(&order);
        let kept = thin(&points, spacing)?;
        order = kept.iter().map(|&k| order[k]).collect();
        points = points.select(&kept);
    } else {
        points = points.select(&order);
    }
    let mut rows = in_order(rows, &order);
    if sampling.boundary && surface.has_boundary() {
        let spacing = 0.9 * (surface.area() / rows.len() as f64).sqrt();
        let mut coordinates = points.coordinates().to_vec();
        add_rims(pieces, spacing, &mut rows, &mut coordinates);
        points = PointCloud::new(dimension, coordinates)?;
        let order = random.permutation(rows.len());
        points = points.select(&order);
        rows = in_order(rows, &order);
    }
    if sampling.noise > 0.0 {
        let moved = points
            .coordinates()
            .iter()
            .map(|x| x + sampling.noise * random.normal())
            .collect();
        points = PointCloud::new(dimension, moved)?;
    }
    Ok(Sample {
        points,
        boundary: (0..rows.len()).filter(|&k| rows[k].boundary).collect(),
        parameters: rows.iter().map(|r| r.parameters).collect(),
        pieces: rows.iter().map(|r| r.piece).collect(),
    })
}

/// Rows in another order, those that it leaves out dropped.
fn in_order(rows: Vec<Row>, order: &[usize]) -> Vec<Row> {
    let mut rows: Vec<Option<Row>> = rows.into_iter().map(Some).collect();
    order.iter().filter_map(|&k| rows[k].take()).collect()
}

/// Points on the boundary circles of the surfaces among the pieces, about `spacing` apart along each, at least three.
fn add_rims(
    pieces: &[Box<dyn Piece>],
    spacing: f64,
    rows: &mut Vec<Row>,
    coordinates: &mut Vec<f64>,
) {
    let surfaces = pieces.iter().enumerate();
    for (k, piece) in surfaces.filter(|(_, p)| p.dimension() == 2) {
        for rim in piece.rims() {
            let walk = RimWalk::new(piece.as_ref(), &rim);
            let count = ((walk.length() / spacing).round() as usize).max(3);
            for step in 0..count {
                let parameters = walk.parameters(walk.length() * step as f64 / count as f64);
                coordinates.extend(place_at(piece.as_ref(), parameters));
                rows.push(Row {
                    piece: k as u32,
                    parameters,
                    boundary: true,
                });
            }
        }
    }
}

/// How many points each piece gets: curves as many as the mean spacing of the surface asks for, and the
/// rest at random by area.
fn allot(surface: &SampleSurface, sampling: &Sampling) -> Vec<usize> {
    let pieces = surface.pieces();
    let mut counts = vec![0; pieces.len()];
    let mut areas: Vec<f64> = pieces.iter().map(|p| p.area()).collect();
    let total: f64 = (0..areas.len())
        .filter(|&k| pieces[k].dimension() == 2)
        .map(|k| areas[k])
        .sum();
    let mut rest = sampling.count;
    for (k, piece) in pieces
        .iter()
        .enumerate()
        .filter(|(_, p)| p.dimension() == 1)
    {
        debug_assert_eq!(piece.dimension(), 1);
        let per_length = (sampling.count as f64 / total).sqrt();
        counts[k] = ((areas[k] * per_length).round() as usize).min(rest);
        rest -= counts[k];
        areas[k] = 0.0;
    }
    let mut random = Random::stream(sampling.seed, 0);
    for _ in 0..rest {
        let mut mark = random.uniform() * total;
        let k = areas
            .iter()
            .position(|&area| {
                mark -= area;
                mark < 0.0
            })
            .unwrap_or(areas.len() - 1);
        counts[k] += 1;
    }
    counts
}
