//! One run: a cloud, its reconstruction, and what is to be said about it.

use crate::even::even;
use crate::truth::{self, Distance};
use crosscap::auto::Input;
use crosscap::backends::interrupt::Interrupt;
use crosscap::prelude::*;
use crosscap_algorithms::surfaces::{Drawing, Feature, FeatureCloud, Random};
use crosscap_backends::files::write_points;
use crosscap_core::squared_distance;
use std::error::Error as AnyError;
use std::fmt;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Where the lengths come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// By the density, one attempt.
    Density,
    /// At random.
    Random,
    /// The program does as it likes.
    Auto,
}

impl Rule {
    const ALL: [Self; 3] = [Self::Density, Self::Random, Self::Auto];

    pub fn named(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|rule| rule.to_string() == name);
        found.ok_or_else(|| format!("{name}: none of density, random, auto"))
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Density => "density",
            Self::Random => "random",
            Self::Auto => "auto",
        })
    }
}

/// What all runs have in common.
pub struct Settings {
    pub seed: u64,
    pub rule: Option<Rule>,
    /// Fewest and most points.
    pub points: [usize; 2],
    /// Least and greatest size of the feature, in mean spacings.
    pub sizes: [f64; 2],
    /// Whether points are thinned, so that they are about as far from each other everywhere.
    pub even: bool,
    /// Time for one run.
    pub limit: Duration,
    /// Where clouds of wrong meshes go.
    pub keep: Option<PathBuf>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    Right,
    Wrong,
    Refused,
    Late,
}

/// A run that was made.
pub struct Run {
    number: usize,
    seed: u64,
    pub feature: Feature,
    pub rule: Rule,
    pub end: End,
    /// Size of the feature in spacings of the points about it.
    pub size: f64,
    /// The landmark separation of the mesh beside the feature.
    pub coarse: f64,
    pub seconds: f64,
    ratio: f64,
    noise: f64,
    points: usize,
    betti: Option<[usize; 3]>,
    distance: Option<Distance>,
    /// Why it was refused, and the arguments that repeat it.
    words: String,
}

/// Share of the runs whose density varies, and share of those with noise.
const VARIED: f64 = 1.0 / 3.0;
/// Greatest ratio of densities, and greatest noise in spacings.
const RATIO: f64 = 30.0;
const NOISE: f64 = 0.5;
/// Random dl, in mean spacings, and random eps, in dl.
const SEPARATION: [f64; 2] = [2.0, 6.0];
const RADIUS: [f64; 2] = [1.6, 3.0];

/// What the reconstruction of a cloud gave.
struct Made {
    outcome: Result<Outcome, Error>,
    verified: bool,
    arguments: String,
    why: String,
}

/// What the truth says about it.
struct Told {
    end: End,
    /// The landmark separation of the mesh beside the feature.
    coarse: f64,
    betti: Option<[usize; 3]>,
    distance: Option<Distance>,
}

impl Made {
    fn told(
        &self,
        feature: &Feature,
        cloud: &FeatureCloud,
        drawing: &Drawing,
    ) -> Result<Told, Error> {
        let mut told = Told {
            end: End::Refused,
            coarse: f64::NAN,
            betti: None,
            distance: None,
        };
        match &self.outcome {
            Err(Error::Interrupted) => told.end = End::Late,
            Err(_) => {}
            Ok(outcome) => {
                told.coarse = outcome.report.parameters.dl / cloud.size;
                told.betti = Some(outcome.homology.betti_rational);
                if self.verified {
                    let found = truth::distance(feature, cloud, drawing, outcome)?;
                    let right = told.betti == Some(feature.betti) && found.is_near();
                    told.end = if right { End::Right } else { End::Wrong };
                    told.distance = Some(found);
                }
            }
        }
        Ok(told)
    }
}

impl Run {
    /// Makes run `number`.
    pub fn made(
        features: &[Feature],
        number: usize,
        settings: &Settings,
    ) -> Result<Self, Box<dyn AnyError>> {
        let feature = features[number % features.len()];
        let mut random = Random::stream(settings.seed, 7 + number as u64);
        let drawing = drawing(settings, &mut random);
        let turn = Rule::ALL[number / features.len() % Rule::ALL.len()];
        let rule = settings.rule.unwrap_or(turn);
        let cloud = if settings.even {
            even(&feature, &drawing)?
        } else {
            feature.draw(&drawing)?
        };
        let since = Instant::now();
        let made = within(settings.limit, |interrupt| {
            reconstruct(&cloud, &drawing, rule, interrupt, &mut random)
        })?;
        let seconds = since.elapsed().as_secs_f64();
        let told = made.told(&feature, &cloud, &drawing)?;
        let mut words = made.why;
        if let Some(folder) = &settings.keep {
            let name = format!("{}_{}_{number}.npy", feature.name, settings.seed);
            let path = folder.join(name);
            write_points(&path, &cloud.points)?;
            words += &format!(
                "\n  crosscap reconstruct {}{}",
                path.display(),
                made.arguments
            );
        } else {
            words += &format!("\n ...{}", made.arguments);
        }
        Ok(Self {
            number,
            seed: settings.seed,
            feature,
            rule,
            end: told.end,
            size: cloud.resolved,
            coarse: told.coarse,
            seconds,
            ratio: drawing.ratio,
            noise: drawing.noise,
            points: cloud.points.len(),
            betti: told.betti,
            distance: told.distance,
            words,
        })
    }

    pub fn is_wrong(&self) -> bool {
        self.end == End::Wrong
    }

    /// Right, but for an end that is further off than any other place may be.
    pub fn is_off_at_end(&self) -> bool {
        let off = self.distance.as_ref().is_some_and(|d| !d.is_near_at_ends());
        self.end == End::Right && off
    }
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = match self.end {
            End::Right if self.is_off_at_end() => "right (off at an end)",
            End::Right => "right",
            End::Wrong => "WRONG",
            End::Refused => "refused",
            End::Late => "late",
        };
        write!(
            f,
            "{end} --seed {} --only {}: {}, {}, {:.2} spacings, dl {:.2} of it, {} points, density 1:{:.1}, noise {:.2}, {:.1} s",
            self.seed,
            self.number,
            self.feature.name,
            self.rule,
            self.size,
            self.coarse,
            self.points,
            self.ratio,
            self.noise,
            self.seconds
        )?;
        if let Some(betti) = self.betti {
            write!(f, ", Betti numbers {betti:?} of {:?}", self.feature.betti)?;
        }
        if let Some(distance) = &self.distance {
            write!(f, ", {distance}")?;
        }
        write!(f, "{}", self.words)
    }
}

fn drawing(settings: &Settings, random: &mut Random) -> Drawing {
    let mut between = |[low, high]: [f64; 2]| low * (high / low).powf(random.uniform());
    let count = between(settings.points.map(|n| n as f64)) as usize;
    let size = between(settings.sizes);
    let ratio = between([1.0, RATIO]);
    let noise = NOISE * random.uniform();
    Drawing {
        count,
        size,
        ratio: if random.uniform() < VARIED && !settings.even {
            ratio
        } else {
            1.0
        },
        noise: if random.uniform() < VARIED {
            noise
        } else {
            0.0
        },
        seed: random.below(1 << 30) as u64,
    }
}

/// Does `work`, which is asked to stop after some time.
fn within<T>(limit: Duration, work: impl FnOnce(Interrupt) -> T) -> T {
    let (done, wait) = mpsc::channel::<()>();
    let interrupt = Interrupt::default();
    std::thread::scope(|scope| {
        let request = interrupt.clone();
        scope.spawn(move || {
            if wait.recv_timeout(limit) == Err(mpsc::RecvTimeoutError::Timeout) {
                request.request();
            }
        });
        let result = work(interrupt);
        drop(done);
        result
    })
}

fn reconstruct(
    cloud: &FeatureCloud,
    drawing: &Drawing,
    rule: Rule,
    interrupt: Interrupt,
    random: &mut Random,
) -> Result<Made, Error> {
    let seed = random.below(1000) as u64;
    let (dl, eps) = (random.uniform(), random.uniform());
    let (pinned, arguments) = asked(cloud, drawing, rule, seed, [dl, eps]);
    let mut make = |parameters| Ok(Pipeline::new(parameters)?.interrupt(interrupt.clone()));
    let search = match Auto::new(pinned).search(Input::Points(&cloud.points), &mut make) {
        Ok(search) => search,
        Err(error) => {
            return Ok(Made {
                why: format!("\n  {error}"),
                outcome: Err(error),
                verified: false,
                arguments,
            });
        }
    };
    let verified = search.is_verified();
    let ends = search
        .attempts
        .iter()
        .map(|a| format!("\n  {}: {:?}", a.reason, a.end));
    let mut why: String = ends.collect();
    if let Ok(outcome) = &search.outcome {
        why.extend(outcome.certificate.violations().map(|v| format!("\n  {v}")));
    }
    why.extend(search.doubt.map(|doubt| format!("\n  {doubt}")));
    Ok(Made {
        outcome: search.outcome,
        verified,
        arguments,
        why,
    })
}

/// What a rule asks for, and the arguments that say so; `chance` are two numbers from 0 to 1, for dl and eps.
fn asked(
    cloud: &FeatureCloud,
    drawing: &Drawing,
    rule: Rule,
    seed: u64,
    chance: [f64; 2],
) -> (Pinned, String) {
    let mut pinned = Pinned {
        seed: Some(seed),
        threads: Some(1),
        ..Pinned::default()
    };
    let mut arguments = format!(" --seed {seed} --threads 1");
    if rule == Rule::Auto {
        return (pinned, arguments);
    }
    let (dl, eps) = if rule == Rule::Density {
        let eps = sixtieth(&cloud.points);
        (eps / 2.0, eps)
    } else {
        let [low, high] = SEPARATION;
        let dl = cloud.spacing * low * (high / low).powf(chance[0]);
        (dl, dl * (RADIUS[0] + (RADIUS[1] - RADIUS[0]) * chance[1]))
    };
    arguments += &format!(" --eps {eps} --dl {dl} --models auto");
    pinned.dl = Some(dl);
    pinned.eps = Some(eps);
    pinned.models = Some(ModelName::AUTO.to_vec());
    if drawing.noise > 0.0 {
        arguments += " --prepare on";
        pinned.prepare = Some(true);
    }
    (pinned, arguments)
}

/// The 99 percent quantile of the distance to the 60th neighbor, over 400 of the points.
fn sixtieth(points: &PointCloud<f64>) -> f64 {
    let mut all = Vec::new();
    let mut squares = Vec::new();
    for p in points.iter().step_by(points.len().div_ceil(400)) {
        squares.clear();
        squares.extend(points.iter().map(|q| squared_distance(p, q)));
        squares.sort_unstable_by(f64::total_cmp);
        all.push(squares[60.min(squares.len() - 1)].sqrt());
    }
    all.sort_unstable_by(f64::total_cmp);
    all[all.len() * 99 / 100]
}
