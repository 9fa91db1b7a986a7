//! A surface with one feature, and clouds of it.

use crate::surfaces::Random;
use crosscap_core::{Error, PointCloud};

/// A place of R^3.
pub type Spot = [f64; 3];

/// A random place on a curve, where the feature has a size.
type Walk = fn(&mut Random, f64) -> Spot;

/// A surface with one feature of variable size.
///
/// The functions take the size, in the unit of the surface, which measures about two across.
#[derive(Clone, Copy, Debug)]
pub struct Feature {
    /// Name, as on the command line.
    pub name: &'static str,
    /// Betti numbers over Q.
    pub betti: [usize; 3],
    /// Greatest size that the surface has room for.
    pub(super) most: f64,
    /// Area, curves left aside.
    pub(super) area: fn(f64) -> f64,
    /// A random place by area; none where the draw is to be made again.
    pub(super) place: fn(&mut Random, f64) -> Option<Spot>,
    /// Places at which the feature is, enough to find the one with the thinnest points.
    pub(super) spots: fn(f64) -> Vec<Spot>,
    /// A curve beside the surface: its length, and a random place on it.
    pub(super) curve: Option<(f64, Walk)>,
}

/// How to draw a cloud. Same values, same points, on every platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawing {
    /// Points on the surface; those of curves come on top, two to a spacing.
    pub count: usize,
    /// Size of the feature in mean spacings, which are sqrt(area / count); the feature is smaller where the surface has no
    /// room for it.
    pub size: f64,
    /// Greatest density beside the least: it grows steadily along a random direction.
    pub ratio: f64,
    /// Standard deviation of normal noise added to every coordinate, in mean spacings.
    pub noise: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A cloud around one feature.
#[derive(Clone, Debug)]
pub struct FeatureCloud {
    /// The points.
    pub points: PointCloud<f64>,
    /// Mean spacing of the points, sqrt(area / count), unit of the surface.
    pub spacing: f64,
    /// Spacing of the points where they are thinnest, unit of the surface.
    pub thinnest: f64,
    /// Size of the feature, unit of the surface.
    pub size: f64,
    /// The same in spacings of the points where they are thinnest about it, without what noise takes off
    /// on its two sides.
    pub resolved: f64,
}

/// Draws for a point until a surface is held for one that has no such places.
const PATIENCE: usize = 4000;
/// Rounds that find the size, on which the area depends a little.
const ROUNDS: usize = 60;
/// Places of the surface that the mean density is estimated from.
const WEIGHED: usize = 4000;
/// Standard deviations of the noise by which a feature is smaller than drawn: one on each side.
const BLUR: f64 = 2.0;

impl Feature {
    /// Draws a cloud.
    ///
    /// # Errors
    /// [`Error::Parameter`] where the surface has no places at that size, or a value is no finite positive number
    /// (the noise may be zero). O(count) but for rejected draws.
    pub fn draw(&self, drawing: &Drawing) -> Result<FeatureCloud, Error> {
        drawing.check()?;
        let (size, spacing) = self.lengths(drawing);
        let mut random = Random::stream(drawing.seed, 0);
        let slope = Slope::new(&mut random, drawing.ratio);
        let mut rows = Vec::with_capacity(3 * drawing.count);
        let mut least = 1.0_f64;
        while rows.len() < 3 * drawing.count {
            let p = self.one(&mut random, size)?;
            if random.uniform() < slope.weight(p) {
                least = least.min(slope.weight(p));
                rows.extend(p);
            }
        }
        if let Some((length, place)) = self.curve {
            let count = (2.0 * length / spacing) as usize;
            rows.extend((0..count).flat_map(|_| place(&mut random, size)));
        }
        for x in &mut rows {
            *x += drawing.noise * spacing * random.normal();
        }
        let mut mean = 0.0;
        for _ in 0..WEIGHED {
            mean += slope.weight(self.one(&mut random, size)?) / WEIGHED as f64;
        }
        let at = |weight: f64| spacing * (mean / weight).sqrt();
        let spots = (self.spots)(size).into_iter();
        let about = spots.map(|p| at(slope.weight(p))).fold(0.0, f64::max);
        Ok(FeatureCloud {
            points: PointCloud::new(3, rows)?,
            spacing,
            thinnest: at(least),
            size,
            resolved: (size - BLUR * drawing.noise * spacing) / about,
        })
    }

    /// Places of the surface itself and of its curves, without noise, uniform: what a mesh is compared with.
    ///
    /// # Errors
    /// As for [`Feature::draw`].
    pub fn places(&self, size: f64, count: usize, seed: u64) -> Result<Vec<Spot>, Error> {
        let mut random = Random::stream(seed, 1);
        let mut places = Vec::with_capacity(count);
        for _ in 0..count {
            places.push(self.one(&mut random, size)?);
        }
        if let Some((length, place)) = self.curve {
            let spacing = ((self.area)(size) / count as f64).sqrt();
            let more = (2.0 * length / spacing) as usize;
            places.extend((0..more).map(|_| place(&mut random, size)));
        }
        Ok(places)
    }

    /// Size of the feature and mean spacing.
    pub(super) fn lengths(&self, drawing: &Drawing) -> (f64, f64) {
        let spacing = |size: f64| ((self.area)(size) / drawing.count as f64).sqrt();
        // the area may vanish with the size
        let mut size = 1.0;
        for _ in 0..ROUNDS {
            size = self.most.min(drawing.size * spacing(size));
        }
        (size, spacing(size))
    }

    fn one(&self, random: &mut Random, size: f64) -> Result<Spot, Error> {
        let mut draws = (0..PATIENCE).filter_map(|_| (self.place)(random, size));
        draws.next().ok_or_else(|| Error::Parameter {
            name: "size",
            value: size.to_string(),
            expected: format!("a size at which {} has places", self.name),
        })
    }
}

impl Drawing {
    fn check(&self) -> Result<(), Error> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let faults = [
            ("count", self.count as f64, self.count > 0),
            ("size", self.size, positive(self.size)),
            (
                "ratio",
                self.ratio,
                self.ratio >= 1.0 && self.ratio.is_finite(),
            ),
            (
                "noise",
                self.noise,
                self.noise == 0.0 || positive(self.noise),
            ),
        ];
        match faults.into_iter().find(|fault| !fault.2) {
            Some((name, value, _)) => Err(Error::Parameter {
                name,
                value: value.to_string(),
                expected: "a finite number above 0 (ratio: from 1, noise: 0 too)".into(),
            }),
            None => Ok(()),
        }
    }
}

/// A density that grows along a direction.
struct Slope {
    along: Spot,
    ratio: f64,
}

impl Slope {
    fn new(random: &mut Random, ratio: f64) -> Self {
        Self {
            along: direction(random),
            ratio,
        }
    }

    /// Density at a place beside the greatest one, which is reached one unit from the origin.
    fn weight(&self, p: Spot) -> f64 {
        let t: f64 = (0..3).map(|k| self.along[k] * p[k]).sum();
        libm::pow(self.ratio, (t.clamp(-1.0, 1.0) - 1.0) / 2.0)
    }
}

/// A random place of the unit sphere.
pub(super) fn direction(r: &mut Random) -> Spot {
    loop {
        let p: Spot = std::array::from_fn(|_| r.between(-1.0, 1.0));
        let size = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        if size > 0.1 && size < 1.0 {
            return p.map(|x| x / size);
        }
    }
}
