//! What each of the numbers that decide the method is good for: every one taken out, halved and doubled, and how
//! many surfaces still come out right.
//!
//! ```text
//! cargo bench --bench ablation                       # all numbers, all clouds, one seed
//! cargo bench --bench ablation -- --seeds 3
//! cargo bench --bench ablation -- --small            # without the clouds of more than 30,000 points
//! cargo bench --bench ablation -- shrink bridge      # the numbers whose name holds one of these words
//! ```
//!
//! A run is a success when its mesh is verified and has the Betti numbers of the surface over Q and over Z/2. The
//! clouds are the paper's nine surfaces with the paper's parameters, and a dozen others. One thread: the table is the
//! same for any machine.

use crosscap::prelude::*;
use crosscap_algorithms::stratify::Tuning;
use crosscap_algorithms::surfaces::RingConformations;
use std::error::Error;
use std::fmt::Write;

/// A cloud with what is known about it.
struct Cloud {
    name: String,
    points: PointCloud<f64>,
    parameters: Parameters,
    betti: [usize; 3],
    betti_mod_2: [usize; 3],
}

impl Cloud {
    fn succeeds(&self, tuning: &Tuning) -> bool {
        let run = || {
            Pipeline::new(self.parameters.clone())
                .map(|pipeline| pipeline.tuning(tuning.clone()))
                .and_then(|mut pipeline| pipeline.reconstruct(&self.points))
        };
        // A number far from what it is meant to be may break what a stage relies on.
        let made = std::panic::catch_unwind(std::panic::AssertUnwindSafe(run));
        made.is_ok_and(|made| {
            made.is_ok_and(|outcome| {
                outcome.is_verified()
                    && outcome.homology.betti_rational == self.betti
                    && outcome.homology.betti_mod2 == self.betti_mod_2
            })
        })
    }
}

/// Eight of the paper's nine surfaces; the ninth are the conformations of cyclo-octane.
const NINE: [&str; 8] = [
    "sphere",
    "torus",
    "double_torus",
    "moebius",
    "klein_r5",
    "two_spheres",
    "klein_immersion",
    "henneberg",
];

fn paper(name: &str, seed: u64) -> Result<Cloud, Box<dyn Error>> {
    let surface = SampleSurface::find(name)?;
    let paper = surface.paper().ok_or("one of the paper's examples")?;
    let sample = surface.sample(&surface.default_sampling(seed))?;
    let usual = Parameters::new(paper.epsilon, paper.landmark_separation);
    let parameters = Parameters {
        dt: paper.dimension_tolerance.unwrap_or(usual.dt),
        dp: paper.fit_tolerance.unwrap_or(usual.dp),
        ep: paper.curve_tolerance.unwrap_or(usual.ep),
        tri_eps: paper.triangulation_epsilon,
        surface: paper.surface,
        boundary: if paper.boundary_given {
            sample.boundary
        } else {
            Vec::new()
        },
        ..usual
    };
    Ok(known(&surface, name, sample.points, parameters, seed))
}

fn known(
    surface: &SampleSurface,
    name: &str,
    points: PointCloud<f64>,
    parameters: Parameters,
    seed: u64,
) -> Cloud {
    Cloud {
        name: name.into(),
        points,
        parameters: Parameters {
            seed,
            threads: Some(1),
            ..parameters
        },
        betti: surface.truth().betti,
        betti_mod_2: surface.truth().betti_mod_2,
    }
}

fn cyclo_octane(seed: u64) -> Result<Cloud, Box<dyn Error>> {
    let sample = RingConformations::cyclo_octane().sample(30_000, seed)?;
    Ok(Cloud {
        name: "cyclo_octane".into(),
        points: sample.points,
        parameters: Parameters {
            dp: 0.1,
            ep: 0.04,
            seed,
            threads: Some(1),
            ..Parameters::new(0.35, 0.2)
        },
        betti: [1, 1, 2],
        betti_mod_2: [1, 1, 2],
    })
}

/// A cloud that is not the paper's.
struct Other {
    surface: &'static str,
    points: usize,
    eps: f64,
    dl: f64,
    models: &'static [ModelName],
    /// Standard deviation, as a share of dl.
    noise: f64,
    /// Whether the boundary is given, and no curve looked for.
    surface_with_boundary: bool,
}

const fn other(
    surface: &'static str,
    points: usize,
    eps: f64,
    dl: f64,
    models: &'static [ModelName],
) -> Other {
    Other {
        surface,
        points,
        eps,
        dl,
        models,
        noise: 0.0,
        surface_with_boundary: false,
    }
}

use ModelName::{
    Boundary, Curve, CurveOnSheet, CurveThroughSheet, IsolatedCrossing, TriplePoint, TwoPlanes,
    YJunction,
};

const OTHERS: [Other; 13] = [
    other(
        "three_spheres",
        60_000,
        0.25,
        0.1,
        &[TwoPlanes, TriplePoint],
    ),
    other("double_bubble", 40_000, 0.25, 0.1, &[YJunction]),
    other(
        "planes_r4",
        10_000,
        0.25,
        0.1,
        &[IsolatedCrossing, Boundary],
    ),
    other(
        "line_disc",
        5_000,
        0.35,
        0.15,
        &[Curve, CurveThroughSheet, CurveOnSheet, Boundary],
    ),
    other("hemisphere", 5_000, 0.25, 0.1, &[Boundary]),
    other("annulus", 5_000, 0.2, 0.08, &[Boundary]),
    other("boy_surface", 40_000, 0.15, 0.08, &[TwoPlanes, TriplePoint]),
    other("torus_sphere", 40_000, 0.35, 0.17, &[TwoPlanes]),
    other("two_tori", 60_000, 0.3, 0.15, &[TwoPlanes]),
    Other {
        surface_with_boundary: true,
        ..other("swiss_roll", 8_000, 0.3, 0.12, &[])
    },
    Other {
        surface_with_boundary: true,
        ..other("cylinder", 5_000, 0.4, 0.2, &[])
    },
    // Few points, and points that lie beside the surface.
    other("two_spheres", 12_000, 0.35, 0.18, &[TwoPlanes]),
    Other {
        noise: 0.05,
        ..other("torus_sphere", 30_000, 0.4, 0.2, &[TwoPlanes])
    },
];

impl Other {
    fn cloud(&self, seed: u64) -> Result<Cloud, Box<dyn Error>> {
        let surface = SampleSurface::find(self.surface)?;
        let sample = surface.sample(&Sampling {
            noise: self.noise * self.dl,
            boundary: self.surface_with_boundary,
            ..Sampling::new(self.points, seed)
        })?;
        let usual = Parameters::new(self.eps, self.dl);
        let parameters = Parameters {
            models: self.models.to_vec(),
            surface: self.surface_with_boundary,
            boundary: if self.surface_with_boundary {
                sample.boundary
            } else {
                Vec::new()
            },
            ..usual
        };
        let noise = if self.noise > 0.0 { ", noise" } else { "" };
        let name = format!("{} {}{noise}", self.surface, self.points);
        Ok(known(&surface, &name, sample.points, parameters, seed))
    }
}

/// A number of the tuning.
enum Place<'t> {
    Length(&'t mut f64),
    Count(&'t mut usize),
    /// What something is multiplied with: what it is above or below 1 is halved and doubled.
    Factor(&'t mut f64),
}

/// A number by its name, and its value where what it does is taken out, if there is one.
struct Number {
    name: &'static str,
    place: fn(&mut Tuning) -> Place<'_>,
    out: Option<f64>,
}

macro_rules! numbers {
    (@out) => { None };
    (@out $out:expr) => { Some($out) };
    ($($kind:ident $stage:ident.$field:ident $(.$inner:ident)? $([$index:literal])? $(out $out:expr)?;)+) => {
        &[$(Number {
            name: concat!(stringify!($stage), ".", stringify!($field) $(, ".", stringify!($inner))? $(, "[", stringify!($index), "]")?),
            place: |tuning| Place::$kind(&mut tuning.$stage.$field$(.$inner)?$([$index])?),
            out: numbers!(@out $($out)?),
        }),+]
    };
}

const NUMBERS: &[Number] = numbers! {
    Count analysis.least_neighbors out 3.0;
    Count analysis.most_fitted out 1e6;
    Factor analysis.shrink;
    Count analysis.shrinks out 0.0;
    Length analysis.gain out 1.0;
    Length analysis.flat out 0.0;
    Length analysis.unexplained_share out 1.0;
    Length analysis.beside out 0.0;
    Length analysis.beside_spacing out 0.0;
    Length analysis.inner_ball;
    Length analysis.witness_reach out 0.0;
    Length analysis.apex_reach out 0.0;
    Length analysis.fit_spacings[0];
    Length analysis.fit_spacings[1];
    Length analysis.speaks_for out 0.0;
    Factor analysis.label_margin out 1.0;
    Length skeleton.node_spacing;
    Length skeleton.reach;
    Length skeleton.bare_reach;
    Length skeleton.bridge out 0.0;
    Length skeleton.end_separation;
    Length skeleton.join out 0.0;
    Count skeleton.stretches out 1.0;
    Length skeleton.bare_gap;
    Length skeleton.bare_chance out 0.0;
    Length skeleton.beside_way;
    Length skeleton.stretch_step;
    Length skeleton.label_spacing;
    Length cells.label_reach;
    Count cells.contacts out 1.0;
    Length cells.contact_reach;
    Length cells.curve_gap;
    Count cells.least_members out 0.0;
    Factor cells.widening;
    Count cells.widenings out 0.0;
    Length refinement.stray;
    Length refinement.separation out 0.0;
    Length refinement.look;
    Factor refinement.growth;
    Count refinement.rounds out 0.0;
    Length refinement.open_share out 1.0;
    Length cells.flat out 0.0;
    Count front.drops out 0.0;
    Count front.attempts out 0.0;
    Count front.curve_passes out 0.0;
    Count front.shortcut_steps out 0.0;
    Length models.two_planes.cell_share out 0.0;
    Length models.two_planes.narrowness out 0.0;
    Length models.two_planes.astray out 1.0;
    Length models.two_planes.step;
    Length models.two_planes.support;
    Length models.two_planes.witness out 0.0;
    Length models.two_planes.sine out 0.0;
    Length models.y_junction.plane;
    Length models.y_junction.along out 1.0;
    Length models.y_junction.sine out 0.0;
    Length models.y_junction.beyond out 1.0;
    Length models.y_junction.cell_share out 0.0;
    Length models.triple_point.plane;
    Length models.triple_point.sheet_share out 0.0;
    Length models.triple_point.determinant out 0.0;
    Length models.triple_point.reach;
    Count models.triple_point.cells out 0.0;
    Length models.isolated_crossing.plane;
    Length models.isolated_crossing.sheet_share out 0.0;
    Length models.isolated_crossing.determinant out 0.0;
    Length models.isolated_crossing.reach;
    Length models.isolated_crossing.fourth out 0.0;
    Length models.boundary.shift out 0.0;
    Length models.boundary.breadth out 0.0;
    Length models.boundary.missing out 0.0;
    Length models.boundary.bend out 1e6;
    Length models.boundary.step;
    Length models.boundary.witness out 0.0;
    Length models.curve_and_sheet.plane;
    Length models.curve_and_sheet.reach;
    Length models.curve_and_sheet.sine out 0.0;
    Length models.curve_and_sheet.clear out 0.0;
    Length models.curve_and_sheet.steepest out 1e6;
    Count models.curve_and_sheet.arc;
    Length models.curve_and_sheet.length out 0.0;
};

impl Number {
    fn value(&self) -> f64 {
        match (self.place)(&mut Tuning::MEASURED.clone()) {
            Place::Length(x) | Place::Factor(x) => *x,
            Place::Count(n) => *n as f64,
        }
    }

    fn times(&self, factor: f64) -> Tuning {
        match (self.place)(&mut Tuning::MEASURED.clone()) {
            Place::Factor(x) => self.at(1.0 + (*x - 1.0) * factor),
            _ => self.at(self.value() * factor),
        }
    }

    fn at(&self, value: f64) -> Tuning {
        let mut tuning = Tuning::MEASURED;
        match (self.place)(&mut tuning) {
            Place::Length(x) | Place::Factor(x) => *x = value,
            Place::Count(n) => *n = value.round() as usize,
        }
        tuning
    }
}

/// What failed of what succeeds with the numbers that the program has, in words.
fn told(clouds: &[Cloud], usual: &[bool], tuning: &Tuning) -> String {
    let mut lost = Vec::new();
    let mut right = 0;
    for (cloud, &before) in clouds.iter().zip(usual) {
        let now = cloud.succeeds(tuning);
        right += usize::from(now);
        if before && !now {
            lost.push(format!("−{}", cloud.name));
        }
        if now && !before {
            lost.push(format!("+{}", cloud.name));
        }
    }
    let mut text = right.to_string();
    if !lost.is_empty() {
        // Writing to a string cannot fail.
        let _ = write!(text, " ({})", lost.join(", "));
    }
    text
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    words.retain(|word| word != "--bench");
    let small = words.iter().any(|word| word == "--small");
    words.retain(|word| word != "--small");
    let mut seeds = 1;
    if let Some(at) = words.iter().position(|word| word == "--seeds") {
        seeds = words.get(at + 1).ok_or("--seeds needs a number")?.parse()?;
        words.drain(at..at + 2);
    }
    let mut clouds = Vec::new();
    for seed in 0..seeds {
        for name in NINE {
            clouds.push(paper(name, seed)?);
        }
        clouds.push(cyclo_octane(seed)?);
        for other in &OTHERS {
            clouds.push(other.cloud(seed)?);
        }
    }
    clouds.retain(|cloud| !small || cloud.points.len() < 30_000);
    let usual: Vec<bool> = (clouds.iter())
        .map(|cloud| cloud.succeeds(&Tuning::MEASURED))
        .collect();
    let right = usual.iter().filter(|&&good| good).count();
    println!("{right} of {} clouds come out right", clouds.len());
    for (cloud, _) in clouds.iter().zip(&usual).filter(|(_, good)| !**good) {
        println!("not right as it is: {}", cloud.name);
    }
    println!("\n| number | value | taken out | half | double |\n| --- | ---: | --- | --- | --- |");
    for number in NUMBERS {
        if !words.is_empty() && !words.iter().any(|word| number.name.contains(word.as_str())) {
            continue;
        }
        let with = |tuning: Tuning| told(&clouds, &usual, &tuning);
        println!(
            "| `{}` | {} | {} | {} | {} |",
            number.name,
            number.value(),
            number
                .out
                .map_or("·".into(), |value| with(number.at(value))),
            with(number.times(0.5)),
            with(number.times(2.0))
        );
    }
    Ok(())
}
