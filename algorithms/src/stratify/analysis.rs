//! Which stratum every point of the cloud is in.

use crate::execute::{self, Execute};
use crate::moments::LocalDimension;
use crate::principal::PrincipalFrame;
use crate::singularity::OneSheet;
use crosscap_core::{
    Decomposition, DimensionEstimator, Error, LocalPoints, MetricSpace, Neighbor, Neighborhood,
    NeighborhoodOracle, PointCloud, Scalar, SingularityModel, squared_distance,
};

/// What a point of the cloud is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Inside a cell.
    Regular,
    /// On a curve that a singularity model found.
    Curve,
    /// On a given boundary.
    Boundary,
    /// On a given boundary and on a found curve: where a double curve ends.
    Corner,
}

/// Parameters of the analysis.
#[derive(Clone, Debug)]
pub struct AnalysisOptions {
    /// Radius of the neighborhoods (strict), unit of the data.
    pub eps: f64,
    /// A radius for every point instead (strict), unit of the data: see
    /// [`NeighborhoodPolicy`](crate::neighborhood::NeighborhoodPolicy).
    pub radii: Option<Vec<f64>>,
    /// Take every point as 2-dimensional and look for no curve.
    pub surface: bool,
    /// Rows that lie on the boundary.
    pub boundary: Vec<usize>,
}

/// The engines and models that the analysis is made with.
pub struct Analyzer<'a, S: Scalar> {
    /// The points.
    pub cloud: &'a PointCloud<S>,
    /// The metric of the neighborhoods.
    pub metric: &'a dyn MetricSpace<Scalar = S>,
    /// Neighborhoods in that metric.
    pub oracle: &'a dyn NeighborhoodOracle<Scalar = S>,
    /// Local dimension.
    pub dimensions: Dimensions<'a, S>,
    /// Models that compete for neighborhoods that are not 2-dimensional.
    pub models: &'a [Box<dyn SingularityModel>],
    /// What runs the points.
    pub execute: &'a dyn Execute,
}

/// Where local dimensions come from.
#[derive(Clone, Copy)]
pub enum Dimensions<'a, S: Scalar> {
    /// From an estimator, asked neighborhood by neighborhood.
    Estimator(&'a dyn DimensionEstimator<Scalar = S>),
    /// Known beforehand for the radius of the analysis, one a point.
    Known(&'a [LocalDimension]),
}

/// What the analysis found out about every point.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Role of every point.
    pub roles: Vec<Role>,
    /// Local dimension of every point; 2 throughout where `surface` was set.
    pub dimensions: Vec<u8>,
    /// Places of the points, those on curves moved onto the curve.
    pub places: PointCloud<f64>,
    /// How far each point was moved.
    pub offsets: Vec<f64>,
    /// For points on curves, the radius at which the model was fitted.
    pub radii: Vec<f64>,
    /// For points on curves, which model.
    pub model: Vec<u8>,
    /// For points on curves, how many cells meet there.
    pub cells: Vec<u8>,
    /// Mean number of points in a neighborhood; 0 where `surface` was set.
    pub mean_neighbors: f64,
    /// Points whose neighborhood is not 2-dimensional.
    pub candidates: usize,
    /// Points whose neighborhood no model explained at any radius.
    pub unexplained: Vec<usize>,
    /// Points near a curve but not on it, with their place on it.
    pub(super) witnesses: Vec<Witness>,
}

/// A point of a cell whose neighborhood shows a curve close by.
#[derive(Clone, Debug)]
pub(super) struct Witness {
    pub(super) row: usize,
    pub(super) place: Vec<f64>,
    pub(super) offset: f64,
    pub(super) radius: f64,
    pub(super) model: u8,
    pub(super) cells: u8,
}

impl Analysis {
    /// Enters what a point turned out to be.
    fn take(&mut self, i: usize, kind: Kind, places: &mut [f64], boundary: bool) {
        match kind {
            Kind::Regular => {}
            Kind::Unexplained => self.unexplained.push(i),
            Kind::Near(witness) => self.witnesses.push(witness),
            Kind::Singular(w) => {
                let width = w.place.len();
                places[i * width..(i + 1) * width].copy_from_slice(&w.place);
                self.offsets[i] = w.offset;
                self.radii[i] = w.radius;
                self.model[i] = w.model;
                self.cells[i] = w.cells;
                self.roles[i] = if boundary { Role::Corner } else { Role::Curve };
            }
        }
    }

    /// Turns witnesses into points on the curve where it has no points within `spacing`: a band
    /// narrower than the spacing of the data leaves gaps in the curve. Returns how many.
    pub(super) fn fill_curves(
        &mut self,
        spacing: f64,
        mut near: impl FnMut(usize, f64, &mut Vec<usize>),
    ) -> usize {
        let mut witnesses = std::mem::take(&mut self.witnesses);
        witnesses.sort_by(|a, b| a.offset.total_cmp(&b.offset).then(a.row.cmp(&b.row)));
        let slack = witnesses
            .last()
            .map_or(0.0, |w| w.offset)
            .max(self.offsets.iter().copied().fold(0.0, f64::max));
        let mut rows = Vec::new();
        let mut filled = 0;
        for w in witnesses {
            near(w.row, spacing + w.offset + slack, &mut rows);
            let covered = rows.iter().any(|&r| {
                matches!(self.roles[r], Role::Curve | Role::Corner)
                    && squared_distance(self.places.point(r), &w.place) < spacing * spacing
            });
            if covered || self.roles[w.row] != Role::Regular {
                continue;
            }
            self.places.set_point(w.row, &w.place);
            self.roles[w.row] = Role::Curve;
            self.offsets[w.row] = w.offset;
            self.radii[w.row] = w.radius;
            self.model[w.row] = w.model;
            self.cells[w.row] = w.cells;
            filled += 1;
        }
        filled
    }
}

/// Fewest points of a neighborhood.
const LEAST_NEIGHBORS: usize = 8;
/// Factor by which a neighborhood shrinks when no model fits, and how often.
const SHRINK: f64 = 0.75;
const SHRINKS: usize = 4;
/// A model with a curve must leave at most this share of the residual of one sheet.
const GAIN: f64 = 0.5;
/// Share of unexplained points from which the radius is declared unfit.
const UNEXPLAINED_SHARE: f64 = 0.05;

/// A point farther than this share of the radius from a curve says nothing about it.
const WITNESS_REACH: f64 = 0.4;

/// What one point turned out to be.
struct Found {
    dimension: u8,
    neighbors: usize,
    kind: Kind,
}
enum Kind {
    Regular,
    Unexplained,
    Near(Witness),
    Singular(Witness),
}

/// Buffers of one thread.
#[derive(Default)]
pub(super) struct Scratch<S> {
    pub(super) near: Vec<Neighbor<S>>,
    rest: Vec<Neighbor<S>>,
    pub(super) local: Vec<f64>,
}

impl<S: Scalar> Analyzer<'_, S> {
    /// Analyzes every point.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a radius that is not positive, [`Error::Index`] for a boundary row
    /// out of range, [`Error::SparseNeighborhood`] where a neighborhood holds fewer than 8 points,
    /// [`Error::Dimension`] where more than 5 % of the points are explained by no model.
    ///
    /// O(n k N^2) for k points in a neighborhood.
    pub fn analyze(&self, options: &AnalysisOptions) -> Result<Analysis, Error> {
        let n = self.cloud.len();
        if !(options.eps > 0.0 && options.eps.is_finite()) {
            return Err(Error::Parameter {
                name: "eps",
                value: options.eps.to_string(),
                expected: "a positive length".into(),
            });
        }
        if let Some(radii) = &options.radii
            && radii.len() != n
        {
            return Err(Error::Shape {
                found: format!("{} radii", radii.len()),
                expected: format!("{n}, one a point"),
            });
        }
        let radius = |i: usize| options.radii.as_ref().map_or(options.eps, |r| r[i]);
        let mut boundary = vec![false; n];
        for &row in &options.boundary {
            *boundary.get_mut(row).ok_or(Error::Index {
                what: "boundary row",
                index: row,
                limit: n,
            })? = true;
        }
        let mut places = self.cloud.cast::<f64>().coordinates().to_vec();
        let width = self.cloud.dimension();
        let mut out = Analysis {
            roles: boundary
                .iter()
                .map(|&b| if b { Role::Boundary } else { Role::Regular })
                .collect(),
            dimensions: vec![2; n],
            places: PointCloud::new(width, Vec::new())?,
            offsets: vec![0.0; n],
            radii: vec![0.0; n],
            model: vec![0; n],
            cells: vec![0; n],
            mean_neighbors: 0.0,
            candidates: 0,
            unexplained: Vec::new(),
            witnesses: Vec::new(),
        };
        if !options.surface {
            let found = execute::map(self.execute, n, Scratch::default, |scratch, i| {
                self.point(i, radius(i), scratch)
            });
            let mut total = 0usize;
            for (i, found) in found.into_iter().enumerate() {
                let found = found?;
                total += found.neighbors;
                out.dimensions[i] = found.dimension;
                out.candidates += usize::from(found.dimension != 2);
                out.take(i, found.kind, &mut places, boundary[i]);
            }
            let again = self.beside_curves(&out, radius);
            let more = execute::map(self.execute, again.len(), Scratch::default, |scratch, k| {
                self.explain(again[k], radius(again[k]), scratch)
            });
            for (&i, kind) in again.iter().zip(more) {
                if !matches!(kind, Kind::Unexplained) {
                    out.take(i, kind, &mut places, boundary[i]);
                }
            }
            out.mean_neighbors = total as f64 / n.max(1) as f64;
            if out.unexplained.len() as f64 > UNEXPLAINED_SHARE * n as f64 {
                let point = out.unexplained[0];
                return Err(Error::Dimension {
                    point,
                    dimension: out.dimensions[point] as usize,
                    count: out.unexplained.len(),
                    parameter: "eps",
                });
            }
        }
        out.places = PointCloud::new(width, places)?;
        Ok(out)
    }

    /// Points that passed for 2-dimensional within the radius of a point on a curve.
    ///
    /// Where sheets cross at a small angle the share of variance that tells a crossing is near the
    /// tolerance, and single points fall below it: a curve that was found on both sides of such a
    /// point is looked for there too.
    fn beside_curves(&self, analysis: &Analysis, radius: impl Fn(usize) -> f64) -> Vec<usize> {
        let mut near = Vec::new();
        let mut asked = vec![false; analysis.roles.len()];
        let mut out = Vec::new();
        for i in 0..asked.len() {
            if analysis.roles[i] != Role::Curve || asked[i] {
                continue;
            }
            let eps = radius(i);
            self.oracle.within(i, S::of(eps), &mut near);
            for x in &near {
                if analysis.roles[x.index] == Role::Curve {
                    asked[x.index] |= x.distance.as_f64() < 0.25 * eps;
                } else if analysis.dimensions[x.index] == 2 {
                    out.push(x.index);
                }
            }
        }
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Number of points in the neighborhood of `i` and its dimension.
    pub(super) fn dimension_at(
        &self,
        i: usize,
        eps: f64,
        scratch: &mut Scratch<S>,
    ) -> Result<(usize, u8), Error> {
        let enough = |found: usize| {
            if found >= LEAST_NEIGHBORS {
                return Ok(found);
            }
            Err(Error::SparseNeighborhood {
                point: i,
                found,
                needed: LEAST_NEIGHBORS,
                parameter: "eps",
            })
        };
        let (neighbors, dimension) = match self.dimensions {
            Dimensions::Known(known) => {
                let known = known.get(i).ok_or_else(|| Error::Shape {
                    found: format!("{} known dimensions", known.len()),
                    expected: format!("{}, one a point", self.cloud.len()),
                })?;
                (enough(known.count as usize)?, known.dimension as usize)
            }
            Dimensions::Estimator(estimator) => {
                self.oracle.within(i, S::of(eps), &mut scratch.near);
                let found = enough(scratch.near.len())?;
                let estimate = estimator.estimate(&Neighborhood {
                    center: i,
                    radius: eps,
                    neighbors: &scratch.near,
                    metric: self.metric,
                    cloud: Some(self.cloud),
                })?;
                if !estimate.value.is_finite() || estimate.dimension > self.cloud.dimension() {
                    return Err(Error::Law {
                        plugin: estimator.name().into(),
                        law: "a dimension between 0 and that of the space",
                        point: i,
                        detail: format!("{} ({})", estimate.dimension, estimate.value),
                    });
                }
                (found, estimate.dimension)
            }
        };
        Ok((neighbors, dimension.min(255) as u8))
    }

    fn point(&self, i: usize, eps: f64, scratch: &mut Scratch<S>) -> Result<Found, Error> {
        let (neighbors, dimension) = self.dimension_at(i, eps, scratch)?;
        let kind = match dimension {
            2 => Kind::Regular,
            0 | 1 => Kind::Unexplained,
            _ => self.explain(i, eps, scratch),
        };
        Ok(Found {
            dimension,
            neighbors,
            kind,
        })
    }

    /// Lets the models compete, at smaller and smaller radii: a radius at which the sheets
    /// bend too much for any model is too large there, whatever it is elsewhere.
    fn explain(&self, i: usize, eps: f64, scratch: &mut Scratch<S>) -> Kind {
        let mut radius = eps;
        for _ in 0..=SHRINKS {
            let Some(view) = self.view(i, radius, radius, scratch) else {
                break;
            };
            let plain = match OneSheet.decompose(&self.local(&view, &OneSheet, scratch)) {
                Ok(fit) => fit.residual,
                Err(_) => break,
            };
            let mut best: Option<(f64, usize, Decomposition)> = None;
            for (m, model) in self.models.iter().enumerate() {
                let local = self.local(&view, model.as_ref(), scratch);
                let Ok(fit) = model.decompose(&local) else {
                    continue;
                };
                let score = score(&fit, radius);
                if fit.residual < GAIN * plain && best.as_ref().is_none_or(|b| score < b.0) {
                    best = Some((score, m, fit));
                }
            }
            if let Some((_, m, fit)) = best {
                let on_curve = fit.dimension_of(view.center) < 2;
                if !on_curve && fit.center_offset > WITNESS_REACH * radius {
                    return Kind::Regular;
                }
                let local = self.local(&view, self.models[m].as_ref(), scratch);
                let shift: Vec<f64> = fit
                    .center
                    .iter()
                    .zip(local.point(view.center))
                    .map(|(a, b)| a - b)
                    .collect();
                let place = view
                    .frame
                    .lift_vector(&shift)
                    .iter()
                    .zip(self.cloud.point(i))
                    .map(|(d, x)| x.as_f64() + d)
                    .collect();
                let witness = Witness {
                    row: i,
                    place,
                    offset: fit.center_offset,
                    radius,
                    model: m as u8,
                    cells: fit.cells_at_curve.first().copied().unwrap_or(0),
                };
                return if on_curve {
                    Kind::Singular(witness)
                } else {
                    Kind::Near(witness)
                };
            }
            if plain < FLAT * radius {
                return Kind::Regular;
            }
            radius *= SHRINK;
            if scratch.near.len() < 2 * LEAST_NEIGHBORS {
                break;
            }
        }
        Kind::Unexplained
    }

    /// The ball of radius `reach` around `i` in the frame of the ball of `radius`.
    ///
    /// The rows that are fitted come first: all of the smaller ball, or every few of it by
    /// distance, since a fit does not get better for more than a few hundred points.
    fn view(&self, i: usize, radius: f64, reach: f64, scratch: &mut Scratch<S>) -> Option<View> {
        self.oracle.within(i, S::of(reach), &mut scratch.near);
        let within = {
            let radius = S::of(radius);
            // Neighbors come sorted by distance.
            scratch.near.partition_point(|x| x.distance < radius)
        };
        let stride = within.div_ceil(MOST_FITTED);
        if stride > 1 {
            scratch.rest.clear();
            let mut kept = 0;
            for k in 0..scratch.near.len() {
                let x = scratch.near[k];
                if k < within && k % stride == 0 {
                    scratch.near[kept] = x;
                    kept += 1;
                } else {
                    scratch.rest.push(x);
                }
            }
            scratch.near.truncate(kept);
            scratch.near.extend_from_slice(&scratch.rest);
        }
        let fitted = within.div_ceil(stride.max(1));
        let rows = scratch.near[..fitted].iter().map(|x| x.index);
        Some(View {
            frame: PrincipalFrame::of(self.cloud, rows),
            center: scratch.near.iter().position(|x| x.index == i)?,
            fitted,
            radius,
        })
    }

    /// The points of a view in the coordinates that a model works in.
    fn local<'s>(
        &self,
        view: &View,
        model: &dyn SingularityModel,
        scratch: &'s mut Scratch<S>,
    ) -> LocalPoints<'s> {
        let dimension = model.local_dimension();
        scratch.local.clear();
        for x in &scratch.near {
            view.frame
                .project(self.cloud.point(x.index), dimension, &mut scratch.local);
        }
        LocalPoints {
            dimension,
            coordinates: &scratch.local,
            fitted: view.fitted,
            center: view.center,
            radius: view.radius,
        }
    }

    /// The decomposition of the ball of a point on a curve, with the rows it labels.
    pub(super) fn decomposition(
        &self,
        analysis: &Analysis,
        i: usize,
        scratch: &mut Scratch<S>,
    ) -> Option<(Decomposition, Vec<usize>)> {
        let radius = analysis.radii[i];
        let model = self.models[analysis.model[i] as usize].as_ref();
        let view = self.view(i, radius, LABEL_MARGIN * radius, scratch)?;
        let fit = model.decompose(&self.local(&view, model, scratch)).ok()?;
        Some((fit, scratch.near.iter().map(|x| x.index).collect()))
    }
}

/// A ball with its frame.
struct View {
    frame: PrincipalFrame,
    center: usize,
    fitted: usize,
    radius: f64,
}

/// Most points that a model is fitted to.
const MOST_FITTED: usize = 256;

/// Points are labelled up to this many radii from a curve point, so that an edge across the
/// limit of belief finds labels at both ends.
const LABEL_MARGIN: f64 = 1.4;

/// One sheet is believed when its residual is below this share of the radius.
const FLAT: f64 = 0.06;

/// What models are compared by: the logarithm of the residual, penalized for parameters.
fn score(fit: &Decomposition, radius: f64) -> f64 {
    let count = fit.labels.len().max(2) as f64;
    2.0 * count * (fit.residual / radius).max(1e-12).ln() + fit.parameters as f64 * count.ln()
}
