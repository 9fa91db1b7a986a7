//! The clouds: the paper's nine surfaces, a dozen others, and some with curves that end.

use crosscap::prelude::*;
use crosscap_algorithms::stratify::Tuning;
use crosscap_algorithms::surfaces::RingConformations;
use std::error::Error;

/// A cloud with what is known about it.
pub struct Cloud {
    pub name: String,
    pub points: PointCloud<f64>,
    parameters: Parameters,
    betti: [usize; 3],
    betti_mod_2: [usize; 3],
}

impl Cloud {
    /// Whether the mesh is verified and has the right Betti numbers.
    pub fn succeeds(&self, tuning: &Tuning) -> bool {
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

/// Surfaces whose curves end, with the lengths that the program chooses by itself; all models compete.
const SINGULAR: [Other; 7] = [
    other("cross_cap", 10_000, 0.089, 0.0445, &ModelName::AUTO),
    other("whitney_umbrella", 5_000, 0.223, 0.112, &ModelName::AUTO),
    other("book_5", 8_000, 0.228, 0.114, &ModelName::AUTO),
    other("double_cone", 6_000, 0.244, 0.122, &ModelName::AUTO),
    other("t_junction", 5_000, 0.233, 0.117, &ModelName::AUTO),
    other("three_squares", 5_000, 0.343, 0.172, &ModelName::AUTO),
    other("plate_on_plate", 5_000, 0.219, 0.11, &ModelName::AUTO),
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

/// All clouds of one seed.
pub fn all(seed: u64) -> Result<Vec<Cloud>, Box<dyn Error>> {
    let mut clouds = Vec::new();
    for name in NINE {
        clouds.push(paper(name, seed)?);
    }
    clouds.push(cyclo_octane(seed)?);
    for other in OTHERS.iter().chain(&SINGULAR) {
        clouds.push(other.cloud(seed)?);
    }
    Ok(clouds)
}
