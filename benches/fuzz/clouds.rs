//! Clouds that were made for nothing.

use crosscap::prelude::*;
use crosscap_algorithms::surfaces::Random;
use std::time::Duration;

/// A cloud of up to 80 points of one of many kinds.
fn cloud(random: &mut Random) -> Option<PointCloud<f64>> {
    let dimension = 1 + random.below(6);
    let count = random.below(80);
    let scale = match random.below(6) {
        0 => 1e300,
        1 => 1e-300,
        2 => 5e-324,
        _ => 1.0,
    };
    let offset = [0.0, 0.0, 1e8, -1e16][random.below(4)];
    let kind = random.below(10);
    let mut coordinates = Vec::with_capacity(count * dimension);
    for row in 0..count {
        let [u, v] = [random.uniform(), random.uniform()];
        let angle = std::f64::consts::TAU * u;
        for axis in 0..dimension {
            let value = match kind {
                0 => 0.5,
                1 => u * (axis + 1) as f64,
                2 => [u, v, 0.3 * u - v][axis % 3],
                3 => random.uniform(),
                4 => random.normal(),
                5 => (row / 4_usize.pow(axis.min(3) as u32) % 4) as f64,
                6 => [angle.cos(), angle.sin(), v][axis % 3],
                7 => [u, v * f64::from(row % 2 == 0), v * f64::from(row % 2 == 1)][axis % 3],
                8 => [f64::NAN, f64::INFINITY, 0.0, u][random.below(4)],
                _ => f64::from(row as u32 % 3) * 1e-3 + f64::from(axis == 0) * u,
            };
            coordinates.push(value * scale + offset);
        }
    }
    PointCloud::new(dimension, coordinates).ok()
}

/// A verified mesh, or in one word why there is none. With no parameters the program chooses them.
fn reconstruct(
    points: &PointCloud<f64>,
    parameters: Option<&Parameters>,
) -> Result<Mesh, &'static str> {
    let end = match parameters {
        Some(parameters) => Pipeline::new(parameters.clone())
            .and_then(|mut pipeline| pipeline.reconstruct(points))
            .map(Outcome::into_verified),
        None => Parameters::auto()
            .tries(2)
            .time_limit(Duration::from_secs(20))
            .reconstruct(points)
            .map(|search| Ok(search.into_verified(Some(points))?.mesh)),
    };
    let (why, words) = match end {
        Ok(Ok(mesh)) => return Ok(mesh),
        Ok(Err(refusal)) => ("refused", refusal.to_string()),
        Err(error) => ("error", error.to_string()),
    };
    assert!(!words.is_empty(), "a refusal is there to be read");
    Err(why)
}

/// Reconstructs a cloud, one in ten twice, and says what came of it.
pub fn run(random: &mut Random) -> &'static str {
    let Some(points) = cloud(random) else {
        return "no cloud";
    };
    let parameters = (random.below(2) == 0).then(|| {
        let dl = 10_f64.powf(random.between(-3.0, 1.0));
        let mut drawn = Parameters::new(dl * random.between(0.5, 4.0), dl);
        drawn.surface = random.below(2) == 0;
        drawn.seed = random.below(1000) as u64;
        drawn.threads = Some(1);
        if random.below(2) == 0 {
            drawn.models = ModelName::ALL.to_vec();
        }
        drawn
    });
    let first = reconstruct(&points, parameters.as_ref());
    if random.below(10) == 0 {
        assert!(
            first == reconstruct(&points, parameters.as_ref()),
            "the same bytes"
        );
    }
    match first {
        Ok(_) => "verified",
        Err(why) => why,
    }
}
