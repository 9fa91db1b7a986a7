//! The published method as a configuration of the pipeline.

use crosscap::prelude::*;

/// Parameters of the paper's example, or others, with the published method.
fn published(eps: f64, dl: f64, seed: u64) -> Parameters {
    let mut parameters = Parameters::new(eps, dl);
    parameters.method = Method::Paper;
    parameters.seed = seed;
    parameters
}

fn reconstruct(parameters: Parameters, surface: &str, sampling: &Sampling) -> Outcome {
    let sample = SampleSurface::find(surface)
        .unwrap()
        .sample(sampling)
        .unwrap();
    Pipeline::new(parameters)
        .unwrap()
        .reconstruct(&sample.points)
        .unwrap()
}

fn describe(outcome: &Outcome) -> String {
    format!(
        "verified {}, Betti {:?}, L {}, k {:.1}, {:?}, {}",
        outcome.is_verified(),
        outcome.homology.betti_rational,
        outcome.report.landmarks.landmarks,
        outcome.report.landmarks.mean_members,
        outcome.failures.first().map(ToString::to_string),
        outcome.certificate.verdict(),
    )
}

#[test]
fn a_sphere_comes_out_for_some_seed_and_is_never_silently_wrong() {
    // Charts of 4 dl as in the paper's example, and of 2 dl, which hide many conflicts.
    let mut verified = [0, 0];
    for seed in 0..4 {
        for (k, dl) in [0.125, 0.25].into_iter().enumerate() {
            let parameters = published(0.5, dl, seed).surface();
            let outcome = reconstruct(parameters, "sphere", &Sampling::new(4000, seed));
            assert_eq!(outcome.report.added_landmarks, 0);
            assert_eq!(outcome.report.triangulation.repairs, 0);
            // A conflict ends the run, so there is at most one.
            assert!(outcome.failures.len() <= 1);
            println!("{}", describe(&outcome));
            if outcome.is_verified() {
                verified[k] += 1;
                assert_eq!(outcome.homology.betti_rational, [1, 0, 1]);
            }
        }
    }
    println!("verified at 4 dl, 2 dl: {verified:?} of 4");
    assert!(verified[0] > 0);
}

#[test]
fn two_spheres_are_refused_or_right() {
    for seed in 0..3 {
        let mut parameters = published(0.35, 0.15, seed);
        (parameters.dp, parameters.ep) = (0.05, 0.05);
        let outcome = reconstruct(parameters, "two_spheres", &Sampling::new(8000, seed));
        assert!(outcome.report.landmarks.curve_landmarks > 0);
        println!("two_spheres seed {seed}: {}", describe(&outcome));
        if outcome.is_verified() {
            assert_eq!(outcome.homology.betti_rational, [1, 0, 3]);
        }
    }
}

/// Prints success counts with the paper's parameters.
#[test]
#[ignore = "a measurement, not a check; run with --ignored --nocapture"]
fn success_counts() {
    for name in ["sphere", "torus"] {
        let surface = SampleSurface::find(name).unwrap();
        let paper = *surface.paper().unwrap();
        let mut verified = 0;
        for seed in 0..20 {
            let mut parameters = published(paper.epsilon, paper.landmark_separation, seed);
            parameters.surface = paper.surface;
            let outcome = reconstruct(parameters, name, &surface.default_sampling(seed));
            verified += usize::from(outcome.is_verified());
            println!("{name} seed {seed}: {}", describe(&outcome));
        }
        println!("{name}: {verified} of 20");
    }
}
