//! A model under test: the cases it is put, and what it makes of them.

use super::answers::{Answer, same, well_formed};
use crate::laws::instances::{Draw, Instance};
use crate::laws::motion::{Motion, motions};
use crate::laws::trial::{Outcome, ensure};
use crate::{Decomposition, SingularityModel};
use proptest::collection::vec;
use proptest::prelude::*;
use std::ops::RangeInclusive;

/// Exact instances of what a model describes, given by its author.
pub struct Instances<'a> {
    /// Draws one; all its randomness from [`Draw`], about [`Draw::points`] points.
    pub draw: &'a dyn Fn(&mut Draw) -> Instance,
    /// How many points instances have.
    pub points: RangeInclusive<usize>,
    /// Largest residual on exact data, as a share of the radius.
    pub exact: f64,
    /// Least noise that must show in the residual, as a share of the radius; twice and four times as
    /// much is tried as well.
    pub noise: f64,
}

impl<'a> Instances<'a> {
    /// Instances of 100 to 300 points, exact to a millionth, with noise of half a percent and more.
    pub fn new(draw: &'a dyn Fn(&mut Draw) -> Instance) -> Self {
        Self {
            draw,
            points: 100..=300,
            exact: 1e-6,
            noise: 0.005,
        }
    }
}

/// Which instance, and what is done with it.
#[derive(Clone, Debug)]
pub(super) struct Case {
    seed: u64,
    points: usize,
    /// A share of the radius.
    noise: f64,
    motion: Motion,
    /// Whether each axis is turned round.
    signs: Vec<bool>,
}

/// A model, and the instances that it is asked about.
pub(super) struct Asked<'t> {
    pub model: &'t dyn SingularityModel,
    pub instances: &'t Instances<'t>,
}

impl Asked<'_> {
    /// Instances with up to so much noise.
    pub fn cases(&self, noise: f64) -> impl Strategy<Value = Case> + use<> {
        let noise = prop_oneof![Just(0.0), 0.0..noise.max(f64::MIN_POSITIVE)];
        let signs = vec(any::<bool>(), self.model.local_dimension());
        let points = self.instances.points.clone();
        (any::<u64>(), points, noise, motions(), signs).prop_map(
            |(seed, points, noise, motion, signs)| Case {
                seed,
                points,
                noise,
                motion,
                signs,
            },
        )
    }

    /// The instance of a case, in the coordinates in which its author drew it.
    pub fn draw(&self, case: &Case) -> Result<Instance, String> {
        let instance = (self.instances.draw)(&mut Draw::new(case.seed, case.points));
        let dimension = self.model.local_dimension();
        ensure!(
            instance.dimension == dimension,
            "instances have {} coordinates, the model wants {dimension}",
            instance.dimension
        );
        Ok(instance.with_noise(case.seed, case.noise))
    }

    /// A few points on a lattice, which no model need explain.
    pub fn poor(&self, rows: &[[i8; 12]], fitted: usize) -> Instance {
        let dimension = self.model.local_dimension();
        let all = rows.iter();
        let coordinates = all.flat_map(|row| (0..dimension).map(|k| f64::from(row[k % 12]) / 3.0));
        Instance {
            dimension,
            coordinates: coordinates.collect(),
            fitted,
            center: 0,
            radius: 1.5,
            truth: vec![],
        }
    }

    /// What the model says, if it can be true.
    pub fn ask(&self, instance: &Instance) -> Result<Answer, String> {
        let answer = self.model.decompose(&instance.local());
        if let Ok(d) = &answer {
            well_formed(d, instance, self.model)?;
        }
        Ok(answer)
    }

    /// What the model says of a case without noise, which it must accept.
    pub fn accepted(&self, case: &Case) -> Result<(Instance, Decomposition), String> {
        let exact = Case {
            noise: 0.0,
            ..case.clone()
        };
        let instance = self.draw(&exact)?.principal();
        let fit = self
            .ask(&instance)?
            .map_err(|r| format!("rejected with {r:?}"))?;
        Ok((instance, fit))
    }

    /// Whether the answer moves with the data.
    pub fn moved(&self, case: &Case) -> Outcome {
        let dimension = self.model.local_dimension();
        let raw = self.draw(case)?;
        let first = raw.principal();
        // Signs by themselves, to the bit.
        let mut mirrored = first.clone();
        for row in mirrored.coordinates.chunks_exact_mut(dimension) {
            for (x, &turned) in row.iter_mut().zip(&case.signs) {
                *x = if turned { -*x } else { *x };
            }
        }
        let before = self.ask(&first)?;
        let all = || (0..first.len()).map(|k| (k, k));
        same(
            &before,
            &self.ask(&mirrored)?,
            all(),
            &case.signs,
            raw.radius,
        )?;
        let mut moved = raw.clone();
        case.motion.apply(dimension, &mut moved.coordinates);
        let moved = moved.principal();
        let (p, q) = (first.local(), moved.local());
        let signs: Vec<bool> = (0..dimension)
            .map(|axis| {
                let products = (0..raw.len()).map(|k| p.point(k)[axis] * q.point(k)[axis]);
                products.sum::<f64>() < 0.0
            })
            .collect();
        // Principal directions of nearly equal variance are not determined: nothing to compare.
        let unturned = (0..raw.len()).all(|k| {
            (0..dimension).all(|a| {
                let x = p.point(k)[a];
                let x = if signs[a] { -x } else { x };
                (x - q.point(k)[a]).abs() < 1e-9 * raw.radius
            })
        });
        if unturned {
            same(&before, &self.ask(&moved)?, all(), &signs, raw.radius)?;
        }
        Ok(())
    }

    /// Whether the residual grows with the noise.
    pub fn grows(&self, case: &Case) -> Outcome {
        let mut before = 0.0;
        for noise in [1.0, 2.0, 4.0].map(|k| k * self.instances.noise) {
            let noisy = Case {
                noise,
                ..case.clone()
            };
            let instance = self.draw(&noisy)?.principal();
            let Ok(d) = self.ask(&instance)? else {
                return Ok(());
            };
            let least = if before == 0.0 {
                0.1 * noise * instance.radius
            } else {
                1.3 * before
            };
            ensure!(
                d.residual >= least,
                "with noise of {noise} radii the residual is {}, expected {least} or more",
                d.residual
            );
            before = d.residual;
        }
        Ok(())
    }
}
