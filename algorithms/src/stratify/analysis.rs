//! Which stratum every point of the cloud is in.

use super::net::{Asked, SPEAKS_FOR};
use crate::audit::{self, Faults};
use crate::balls::BallTree;
use crate::execute::{self, Execute};
use crate::moments::LocalDimension;
use crate::principal::PrincipalFrame;
use crate::singularity::OneSheet;
use crosscap_core::{
    Decomposition, DimensionEstimator, Error, LocalPoints, Located, MetricSpace, Neighbor,
    Neighborhood, NeighborhoodOracle, PointCloud, Scalar, SingularityModel, squared_distance,
};

/// What a point of the cloud is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Inside a cell.
    Regular,
    /// On a curve that a singularity model found.
    Curve,
    /// On a boundary, given or found.
    Boundary,
    /// At a point: where a found curve ends on a boundary, or a 0-stratum that a model found.
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
    /// Dimension tolerance dt at radii smaller than `eps`: share of variance (strict).
    pub dt: f64,
}

impl AnalysisOptions {
    /// Radius of the neighborhood of a row.
    pub(super) fn radius(&self, row: usize) -> f64 {
        self.radii.as_ref().map_or(self.eps, |radii| radii[row])
    }
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
    /// Points whose neighborhood shows a 0-stratum, with its place.
    pub(super) apexes: Vec<Witness>,
    /// What models returned that cannot be used.
    pub(super) faults: Faults,
}

/// A point whose neighborhood shows a curve or a 0-stratum close by.
#[derive(Clone, Debug)]
pub(super) struct Witness {
    stratum: OnStratum,
    pub(super) row: usize,
    pub(super) place: Vec<f64>,
    pub(super) offset: f64,
    pub(super) radius: f64,
    pub(super) model: u8,
    pub(super) cells: u8,
}

impl Analysis {
    /// Enters what a point turned out to be.
    fn take(&mut self, i: usize, verdict: Verdict, boundary: bool) {
        self.apexes.extend(verdict.apex);
        match verdict.kind {
            Kind::Regular => {}
            Kind::Unexplained => self.unexplained.push(i),
            Kind::Near(witness) => self.witnesses.push(witness),
            Kind::Singular(w) => {
                self.places.set_point(i, &w.place);
                self.enter(&w, boundary);
            }
        }
    }

    /// Enters a point on a stratum of dimension 0 or 1, but for its place.
    fn enter(&mut self, w: &Witness, boundary: bool) {
        self.offsets[w.row] = w.offset;
        // A boundary has one cell, and needs no labels to tell cells apart.
        self.radii[w.row] = if w.stratum == OnStratum::Boundary {
            0.0
        } else {
            w.radius
        };
        self.model[w.row] = w.model;
        self.cells[w.row] = w.cells;
        self.roles[w.row] = match w.stratum {
            OnStratum::Point => Role::Corner,
            OnStratum::Boundary => Role::Boundary,
            OnStratum::Curve if boundary => Role::Corner,
            OnStratum::Curve => Role::Curve,
        };
    }

    /// Turns witnesses into points on the curve where it has no points within `spacing`: a band
    /// narrower than the spacing of the data leaves gaps in the curve. In the same way points at
    /// 0-strata that none is within `apart` of. Returns how many on curves.
    pub(super) fn fill_curves(&mut self, spacing: f64, apart: f64) -> usize {
        let mut apexes = std::mem::take(&mut self.apexes);
        apexes.sort_by(|a, b| a.offset.total_cmp(&b.offset).then(a.row.cmp(&b.row)));
        let mut points: Vec<usize> = (0..self.roles.len())
            .filter(|&i| self.roles[i] == Role::Corner)
            .collect();
        for w in apexes {
            let covered = points
                .iter()
                .any(|&r| squared_distance(self.places.point(r), &w.place) < apart * apart);
            if covered {
                continue;
            }
            self.places.set_point(w.row, &w.place);
            self.enter(&w, false);
            points.push(w.row);
        }
        let mut witnesses = std::mem::take(&mut self.witnesses);
        witnesses.sort_by(|a, b| a.offset.total_cmp(&b.offset).then(a.row.cmp(&b.row)));
        // Witnesses are many, and those that fill anything few.
        let there: Vec<usize> = (0..self.roles.len())
            .filter(|&i| self.roles[i] != Role::Regular)
            .collect();
        let mut places = Vec::with_capacity(there.len() * self.places.dimension());
        for &row in &there {
            places.extend_from_slice(self.places.point(row));
        }
        let tree = BallTree::new(self.places.dimension(), &places);
        let mut added: Vec<usize> = Vec::new();
        for w in witnesses {
            if self.roles[w.row] != Role::Regular {
                continue;
            }
            let own = if w.stratum == OnStratum::Boundary {
                Role::Boundary
            } else {
                Role::Curve
            };
            let counts = |row: usize| self.roles[row] == own || self.roles[row] == Role::Corner;
            let mut covered = added.iter().any(|&row| {
                counts(row)
                    && squared_distance(self.places.point(row), &w.place) < spacing * spacing
            });
            if !covered {
                tree.within(&w.place, spacing, |k, _| {
                    covered |= counts(there[k as usize])
                });
            }
            if covered {
                continue;
            }
            self.places.set_point(w.row, &w.place);
            self.enter(&w, false);
            added.push(w.row);
        }
        added.len()
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

/// A curve is looked for this close to its points where the dimension does not show it, as a share
/// of the radius.
const BESIDE: f64 = 0.5;
/// Share of the radius of the ball that is asked what its center is on, when the whole one is explained by
/// no model of a curve.
const HALF: f64 = 0.5;
/// A point farther than this share of the radius from a curve says nothing about it.
const WITNESS_REACH: f64 = 0.4;
/// A point farther than this share of the radius from a 0-stratum does not stand for it.
const APEX_REACH: f64 = 0.5;

/// What one point turned out to be.
#[derive(Debug)]
pub(super) struct Verdict {
    kind: Kind,
    apex: Option<Witness>,
}

impl Verdict {
    const UNEXPLAINED: Self = Self {
        kind: Kind::Unexplained,
        apex: None,
    };
    const REGULAR: Self = Self {
        kind: Kind::Regular,
        apex: None,
    };

    pub(super) fn is_unexplained(&self) -> bool {
        matches!(self.kind, Kind::Unexplained)
    }
}

#[derive(Debug)]
enum Kind {
    Regular,
    Unexplained,
    Near(Witness),
    Singular(Witness),
}

/// Which kind of stratum a singular point is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OnStratum {
    Point,
    Boundary,
    Curve,
}

/// Buffers of one thread.
#[derive(Default)]
pub(super) struct Scratch<S> {
    pub(super) near: Vec<Neighbor<S>>,
    rest: Vec<Neighbor<S>>,
    pub(super) local: Vec<f64>,
    /// Where faults of models are told.
    faults: Faults,
}

impl<S> Scratch<S> {
    pub(super) fn reporting(faults: &Faults) -> Self {
        Self {
            near: Vec::new(),
            rest: Vec::new(),
            local: Vec::new(),
            faults: faults.clone(),
        }
    }
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
        let mut boundary = vec![false; n];
        for &row in &options.boundary {
            *boundary.get_mut(row).ok_or(Error::Index {
                what: "boundary row",
                index: row,
                limit: n,
            })? = true;
        }
        let mut out = Analysis {
            roles: boundary
                .iter()
                .map(|&b| if b { Role::Boundary } else { Role::Regular })
                .collect(),
            dimensions: vec![2; n],
            places: self.cloud.cast(),
            offsets: vec![0.0; n],
            radii: vec![0.0; n],
            model: vec![0; n],
            cells: vec![0; n],
            mean_neighbors: 0.0,
            candidates: 0,
            unexplained: Vec::new(),
            witnesses: Vec::new(),
            apexes: Vec::new(),
            faults: Faults::default(),
        };
        audit::oracle(self.oracle, self.metric, options.eps)?;
        audit::metric(self.metric, self.oracle)?;
        for model in self.models {
            audit::local_dimension(model.as_ref())?;
        }
        let faults = out.faults.clone();
        let scratch = || Scratch::reporting(&faults);
        let looked_at = !options.surface || self.models.iter().any(|m| m.finds_boundary());
        if looked_at {
            let found = execute::map(self.execute, n, scratch, |scratch, i| {
                self.first_look(i, options, boundary[i], scratch)
                    .map_err(Box::new)
            });
            let mut total = 0usize;
            let mut asked: Vec<(u8, Asked)> = Vec::new();
            for (row, found) in found.into_iter().enumerate() {
                let (neighbors, dimension, verdict) = found.map_err(|error| *error)?;
                total += neighbors;
                out.dimensions[row] = dimension;
                out.candidates += usize::from(dimension != 2);
                match verdict {
                    Some(verdict) => out.take(row, *verdict, boundary[row]),
                    None if dimension == 2 => {}
                    None => asked.push((dimension, Asked { row, neighbors })),
                }
            }
            asked.sort_by_key(|a| a.0);
            for same in asked.chunk_by(|a, b| a.0 == b.0) {
                let rows = same.iter().map(|a| a.1).collect();
                for (i, verdict) in self.explain_all(rows, same[0].0.into(), options, true, &faults)
                {
                    out.take(i, verdict, boundary[i]);
                }
            }
            let again = self.beside_curves(&out, options);
            for (i, verdict) in self.explain_all(again, 3, options, false, &faults) {
                if !verdict.is_unexplained() {
                    out.take(i, verdict, boundary[i]);
                }
            }
            out.apexes.sort_by_key(|w| w.row);
            out.witnesses.sort_by_key(|w| w.row);
            out.unexplained.sort_unstable();
            out.faults.none()?;
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
        Ok(out)
    }

    /// Points that passed for 2-dimensional close to a point on a curve.
    ///
    /// Where sheets cross at a small angle the share of variance that tells a crossing is near the
    /// tolerance, and single points fall below it: a curve that was found on both sides of such a
    /// point is looked for there too.
    fn beside_curves(&self, analysis: &Analysis, options: &AnalysisOptions) -> Vec<Asked> {
        let mut near = Vec::new();
        let mut covered = vec![false; analysis.roles.len()];
        let mut beside = vec![false; analysis.roles.len()];
        for i in 0..covered.len() {
            if analysis.roles[i] != Role::Curve || covered[i] {
                continue;
            }
            let eps = options.radius(i);
            self.oracle
                .indices_within(i, S::of(BESIDE * eps), &mut near);
            for &x in &near {
                let x = x as usize;
                if analysis.roles[x] == Role::Curve {
                    let square = squared_distance(self.cloud.point(i), self.cloud.point(x));
                    covered[x] |= square < (0.25 * eps).powi(2);
                } else if analysis.dimensions[x] == 2 {
                    beside[x] = true;
                }
            }
        }
        (0..beside.len())
            .filter(|&row| beside[row])
            .map(|row| Asked { row, neighbors: 0 })
            .collect()
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
                let dimension = audit::dimension(
                    estimator.name(),
                    i,
                    &estimate,
                    found,
                    self.cloud.dimension(),
                )?;
                (found, dimension)
            }
        };
        Ok((neighbors, dimension.min(255) as u8))
    }

    /// Number of points in a neighborhood, its dimension, and what the point is unless it is
    /// regular, or fits in competition with one sheet must tell.
    fn first_look(
        &self,
        i: usize,
        options: &AnalysisOptions,
        boundary: bool,
        scratch: &mut Scratch<S>,
    ) -> Result<(usize, u8, Option<Box<Verdict>>), Error> {
        let (neighbors, dimension) = if options.surface {
            // Taken on trust: only a boundary is looked for.
            (0, 2)
        } else {
            self.dimension_at(i, options.radius(i), scratch)?
        };
        let asked = self
            .models
            .iter()
            .any(|m| m.applies_to(dimension.into()) && !(boundary && m.finds_boundary()));
        let verdict = match dimension {
            2 if asked => Some(self.second_thought(i, options, boundary, scratch)),
            2 => None,
            _ if asked => None,
            _ => Some(Verdict::UNEXPLAINED),
        };
        Ok((neighbors, dimension, verdict.map(Box::new)))
    }

    /// Whether a model knows of curves that no surface touches.
    fn knows_bare_curves(&self) -> bool {
        self.models.iter().any(|m| m.applies_to(1))
    }

    /// What models say that ask for 2-dimensional neighborhoods.
    fn second_thought(
        &self,
        i: usize,
        options: &AnalysisOptions,
        boundary: bool,
        scratch: &mut Scratch<S>,
    ) -> Verdict {
        let eps = options.radius(i);
        let Some(view) = self.view(i, eps, eps, scratch) else {
            return Verdict::REGULAR;
        };
        let mut best: Option<(f64, usize, Decomposition)> = None;
        for (m, model) in self.models.iter().enumerate() {
            let silent = if model.finds_boundary() {
                boundary
            } else {
                options.surface
            };
            if silent || !model.applies_to(2) {
                continue;
            }
            let faults = scratch.faults.clone();
            let local = self.local(&view, model.as_ref(), scratch);
            let found = model.decompose(&local);
            if let Some(fit) = audit::sound(found, &local, model.as_ref(), i, &faults) {
                let score = score(&fit, eps);
                if best.as_ref().is_none_or(|b| score < b.0) {
                    best = Some((score, m, fit));
                }
            }
        }
        if best.is_none() && self.knows_bare_curves() {
            // Where the rim of the ball cuts another stratum, the half ball shows the own one.
            let half = S::of(HALF * eps);
            let near = scratch.near[..view.fitted].iter();
            let rows = near.filter(|x| x.distance < half).map(|x| x.index);
            if PrincipalFrame::of(self.cloud, rows).dimension(options.dt) == 1 {
                let (verdict, _) = self.explain(i, &[], 1, options, scratch);
                return match &verdict.kind {
                    Kind::Singular(w) if w.cells == 0 => verdict,
                    _ => Verdict::REGULAR,
                };
            }
        }
        best.map_or(Verdict::REGULAR, |(_, m, fit)| {
            let local = self.local(&view, self.models[m].as_ref(), scratch);
            let located = fit.located(view.center);
            self.verdict(i, m, &fit, &view, local.point(view.center), located)
        })
    }

    /// Lets the models compete, at smaller and smaller radii: a radius at which the sheets
    /// bend too much for any model is too large there, whatever it is elsewhere.
    ///
    /// The fit speaks for the rows `others` as well, where they are close enough: `None` for those that
    /// it says nothing about.
    pub(super) fn explain(
        &self,
        i: usize,
        others: &[usize],
        dimension: usize,
        options: &AnalysisOptions,
        scratch: &mut Scratch<S>,
    ) -> (Verdict, Vec<Option<Verdict>>) {
        let mut radius = options.radius(i);
        let mut dimension = dimension;
        for shrunk in 0..=SHRINKS {
            let Some(view) = self.view(i, radius, radius, scratch) else {
                break;
            };
            if !self.knows_bare_curves() {
                scratch.near.truncate(view.fitted);
            }
            let first = scratch.near.len();
            scratch.near.extend(others.iter().map(|&index| Neighbor {
                index,
                distance: S::zero(),
            }));
            if shrunk > 0 {
                // A smaller ball of a crossing may pass for a sheet; models decide.
                dimension = match view.frame.dimension(options.dt) {
                    0 | 1 => 1,
                    more => more.max(3),
                };
            }
            let plain = match OneSheet.decompose(&self.local(&view, &OneSheet, scratch)) {
                Ok(fit) => fit.residual,
                // A curve needs fewer points than a sheet, and is not compared with one.
                Err(_) if dimension == 1 => f64::INFINITY,
                Err(_) => break,
            };
            let rows: Vec<usize> = (first..scratch.near.len()).collect();
            let mut best: Option<(f64, usize, Decomposition, Vec<Option<Located>>)> = None;
            for (m, model) in self.models.iter().enumerate() {
                if !model.applies_to(dimension) || model.finds_boundary() {
                    continue;
                }
                if view.frame.spreads_beyond(model.local_dimension()) {
                    continue;
                }
                let faults = scratch.faults.clone();
                let local = self.local(&view, model.as_ref(), scratch);
                // One model alone need not be asked twice.
                let found = if self.models.len() == 1 {
                    model.decompose_about(&local, &rows)
                } else {
                    model.decompose(&local).map(|fit| (fit, Vec::new()))
                };
                let (found, located) = match found {
                    Ok((fit, located)) => (Ok(fit), located),
                    Err(rejection) => (Err(rejection), Vec::new()),
                };
                let Some(fit) = audit::sound(found, &local, model.as_ref(), i, &faults) else {
                    continue;
                };
                let score = score(&fit, radius);
                // A line is as near to a sheet as to itself.
                let better = dimension < 3 || fit.residual < GAIN * plain;
                if better && best.as_ref().is_none_or(|b| score < b.0) {
                    best = Some((score, m, fit, located));
                }
            }
            let close = |row: usize| {
                let square = squared_distance(self.cloud.point(i), self.cloud.point(row));
                square < (SPEAKS_FOR * radius).powi(2)
            };
            if let Some((_, m, fit, located)) = best {
                let model = self.models[m].as_ref();
                let faults = scratch.faults.clone();
                let local = self.local(&view, model, scratch);
                let located = if located.len() == rows.len() {
                    located
                } else {
                    match model.decompose_about(&local, &rows) {
                        Ok((_, located)) => located,
                        Err(_) => vec![None; rows.len()],
                    }
                };
                let located = audit::placed(located, &local, model, i, &faults);
                let own = fit.located(view.center);
                let own = self.verdict(i, m, &fit, &view, local.point(view.center), own);
                let kinds = located
                    .into_iter()
                    .zip(others)
                    .zip(&rows)
                    .map(|((found, &row), &k)| {
                        let found = found.filter(|_| close(row))?;
                        Some(self.verdict(row, m, &fit, &view, local.point(k), found))
                    })
                    .collect();
                return (own, kinds);
            }
            let curve = dimension == 1 && self.models.iter().any(|m| m.applies_to(1));
            if !curve && plain < FLAT * radius {
                let kinds = others
                    .iter()
                    .map(|&row| close(row).then_some(Verdict::REGULAR))
                    .collect();
                return (Verdict::REGULAR, kinds);
            }
            radius *= SHRINK;
            if view.within < 2 * LEAST_NEIGHBORS {
                break;
            }
        }
        (Verdict::UNEXPLAINED, Vec::new())
    }

    /// What a fit makes of a row, which is at `from` in the coordinates of the model, and the
    /// 0-stratum that it shows near it.
    fn verdict(
        &self,
        row: usize,
        model: usize,
        fit: &Decomposition,
        view: &View,
        from: &[f64],
        located: Located,
    ) -> Verdict {
        let witness = |stratum: OnStratum, to: &[f64], offset: f64, cells: u8| {
            let shift: Vec<f64> = to.iter().zip(from).map(|(a, b)| a - b).collect();
            let place = view
                .frame
                .lift_vector(&shift)
                .iter()
                .zip(self.cloud.point(row))
                .map(|(d, x)| x.as_f64() + d)
                .collect();
            Witness {
                stratum,
                row,
                place,
                offset,
                radius: view.radius,
                model: model as u8,
                cells,
            }
        };
        let apex = fit
            .points
            .iter()
            .map(|p| (squared_distance(p, from).sqrt(), p))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|&(offset, _)| offset < APEX_REACH * view.radius)
            .map(|(offset, p)| witness(OnStratum::Point, p, offset, 0));
        let curve = if self.models[model].finds_boundary() {
            OnStratum::Boundary
        } else {
            OnStratum::Curve
        };
        let moved = |stratum| witness(stratum, &located.place, located.offset, located.cells);
        let kind = match located.dimension {
            0 => Kind::Singular(moved(OnStratum::Point)),
            1 => Kind::Singular(moved(curve)),
            _ if located.offset > WITNESS_REACH * view.radius => Kind::Regular,
            _ => Kind::Near(moved(curve)),
        };
        Verdict { kind, apex }
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
            within,
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

    /// The decomposition of the ball of a point on a curve, with the rows it labels and the radius.
    pub(super) fn decomposition(
        &self,
        analysis: &Analysis,
        i: usize,
        scratch: &mut Scratch<S>,
    ) -> Option<(Decomposition, Vec<usize>, f64)> {
        let mut radius = analysis.radii[i];
        let known = analysis.model[i] as usize;
        for _ in 0..=SHRINKS {
            let view = self.view(i, radius, LABEL_MARGIN * radius, scratch)?;
            let mut fit_by = |model: &dyn SingularityModel| {
                let local = self.local(&view, model, scratch);
                let found = model.decompose(&local);
                audit::sound(found, &local, model, i, &analysis.faults)
            };
            let mut best = fit_by(self.models[known].as_ref());
            if best.is_none() {
                let others = self
                    .models
                    .iter()
                    .filter(|m| m.applies_to(3) && !m.finds_boundary());
                best = others
                    .filter_map(|m| fit_by(m.as_ref()))
                    .min_by(|a, b| score(a, radius).total_cmp(&score(b, radius)));
            }
            if let Some(fit) = best {
                let rows = scratch.near.iter().map(|x| x.index).collect();
                return Some((fit, rows, radius));
            }
            // The fit of a neighbor may have spoken for this point; its own ball can hold more.
            radius *= SHRINK;
        }
        None
    }
}

/// A ball with its frame.
struct View {
    frame: PrincipalFrame,
    center: usize,
    fitted: usize,
    /// Points in the ball.
    within: usize,
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
