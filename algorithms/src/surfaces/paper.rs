//! The nine surfaces of Martin & Watson (2011), with the paper's parameters and results.

use super::curves::{circle_of_spheres, henneberg_arcs, klein_circle};
use super::surface::SampleSurface;
use super::truth::{ANNULUS, GENUS_2, KLEIN, MOEBIUS, PROJECTIVE, SPHERE, TORUS, crossing, plain};
use super::{
    CurveKind, Henneberg, KleinFigureEight, MoebiusStrip, PaperExample, Piece, ProjectivePlane,
    SamplingLaw, SphereCap, Torus, Truth, TwoHoledTorus,
};
use std::f64::consts::SQRT_2;

/// The nine, in the paper's order.
pub(super) fn paper_surfaces() -> Vec<SampleSurface> {
    vec![
        sphere(),
        torus(),
        double_torus(),
        moebius(),
        klein_r5(),
        rp2_r6(),
        two_spheres(),
        klein_immersion(),
        henneberg(),
    ]
}

/// A sphere.
fn sphere() -> SampleSurface {
    SampleSurface::new(
        "sphere",
        "the unit sphere",
        vec![Box::new(SphereCap::sphere("sphere", [0.0; 3], 1.0))],
        plain([1, 0, 1], &[SPHERE], 0),
        0,
    )
    .paper_example(manifold(10_000, 0.4, 0.1, 886, 36, [1, 0, 1], [1.7, 368.2]))
}

/// A torus.
fn torus() -> SampleSurface {
    SampleSurface::new(
        "torus",
        "a torus, tube and hole of radius 1",
        vec![Box::new(Torus::new(
            "torus",
            [0.0; 3],
            [0.0, 0.0, 1.0],
            2.0,
            1.0,
        ))],
        plain([1, 2, 1], &[TORUS], 0),
        0,
    )
    .paper_example(manifold(10_000, 1.0, 0.3, 667, 28, [1, 2, 1], [1.1, 220.5]))
}

/// Two holes.
fn double_torus() -> SampleSurface {
    SampleSurface::new(
        "double_torus",
        "a surface of genus 2, two tori side by side smoothly joined",
        vec![Box::new(TwoHoledTorus)],
        plain([1, 4, 1], &[GENUS_2], 0),
        0,
    )
    .also(&["genus_2", "two_holed_torus"])
    .paper_example(manifold(20_000, 1.2, 0.3, 813, 26, [1, 4, 1], [3.7, 263.1]))
}

/// One side and one boundary.
fn moebius() -> SampleSurface {
    SampleSurface::new(
        "moebius",
        "the Moebius strip",
        vec![Box::new(MoebiusStrip)],
        plain([1, 1, 0], &[MOEBIUS], 1),
        0,
    )
    .also(&["mobius", "moebius_strip"])
    .paper_example(PaperExample {
        boundary_given: true,
        ..manifold(10_000, 0.4, 0.1, 416, 23, [1, 1, 0], [0.9, 123.7])
    })
}

/// A Klein bottle that does not cross itself.
fn klein_r5() -> SampleSurface {
    SampleSurface::new(
        "klein_r5",
        "the Klein bottle embedded in R^5",
        vec![Box::new(KleinFigureEight::embedded())],
        Truth {
            betti_mod_2: [1, 2, 1],
            torsion: &[2],
            ..plain([1, 1, 0], &[KLEIN], 0)
        },
        0,
    )
    .also(&["klein_fig8_r5", "klein_embedded"])
    .paper_example(manifold(
        10_000,
        1.0,
        0.25,
        1940,
        33,
        [1, 1, 0],
        [3.8, 778.0],
    ))
}

/// A projective plane that does not cross itself.
fn rp2_r6() -> SampleSurface {
    SampleSurface::new(
        "rp2_r6",
        "the real projective plane embedded in R^6",
        vec![Box::new(ProjectivePlane)],
        Truth {
            betti_mod_2: [1, 1, 1],
            torsion: &[2],
            ..plain([1, 0, 0], &[PROJECTIVE], 0)
        },
        0,
    )
    .also(&["rp2", "projective_plane"])
    .paper_example(manifold(
        100_000,
        0.35,
        0.1,
        753,
        35,
        [1, 0, 0],
        [11.7, 302.0],
    ))
}

/// Two spheres and their circle.
fn two_spheres() -> SampleSurface {
    let half = SQRT_2 / 2.0;
    let twin = [[-half, 0.0, 0.0], [half, 0.0, 0.0]];
    SampleSurface::new(
        "two_spheres",
        "two unit spheres that cross at a right angle",
        twin.iter()
            .zip(["left sphere", "right sphere"])
            .map(|(&c, name)| Box::new(SphereCap::sphere(name, c, 1.0)) as Box<dyn Piece>)
            .collect(),
        crossing([1, 0, 3], &[SPHERE, SPHERE], 1),
        0,
    )
    .singular(move |m| vec![circle_of_spheres(CurveKind::Double, twin, [1.0; 2], m)])
    .paper_example(PaperExample {
        count: 200_000,
        thinning: Some(0.01),
        count_after_thinning: Some(83_646),
        epsilon: 0.25,
        dimension_tolerance: Some(0.05),
        fit_tolerance: Some(0.05),
        curve_tolerance: Some(0.05),
        landmark_separation: 0.1,
        landmarks: 1588,
        mean_neighbors: 13,
        betti: [1, 0, 3],
        seconds: [446.4, 344.4],
        ..UNPRINTED
    })
}

/// A Klein bottle with a double curve.
fn klein_immersion() -> SampleSurface {
    SampleSurface::new(
        "klein_immersion",
        "the figure-8 Klein bottle immersed in R^3",
        vec![Box::new(KleinFigureEight::immersed())],
        crossing([1, 2, 1], &[KLEIN], 1),
        0,
    )
    .also(&["klein_fig8_r3", "klein_r3"])
    .singular(klein_circle)
    .law(SamplingLaw::Parameters)
    .paper_example(PaperExample {
        count: 100_000,
        thinning: Some(0.025),
        count_after_thinning: Some(61_440),
        epsilon: 0.2,
        triangulation_epsilon: Some(0.4),
        dimension_tolerance: Some(0.075),
        fit_tolerance: Some(0.05),
        curve_tolerance: Some(0.025),
        landmark_separation: 0.15,
        landmarks: 4566,
        mean_neighbors: 14,
        betti: [1, 2, 1],
        seconds: [295.7, 1183.3],
        ..UNPRINTED
    })
}

/// A minimal surface that crosses itself and its boundary.
fn henneberg() -> SampleSurface {
    SampleSurface::new(
        "henneberg",
        "a ring of Henneberg's minimal surface",
        vec![Box::new(Henneberg)],
        Truth {
            boundary_curves: 2,
            ..crossing([1, 5, 0], &[ANNULUS], 4)
        },
        0,
    )
    .singular(henneberg_arcs)
    .paper_example(PaperExample {
        count: 100_000,
        thinning: Some(0.25),
        count_after_thinning: Some(13_637),
        epsilon: 4.0,
        dimension_tolerance: Some(0.05),
        fit_tolerance: Some(1.0),
        curve_tolerance: Some(0.25),
        landmark_separation: 0.75,
        boundary_given: true,
        landmarks: 1463,
        mean_neighbors: 39,
        betti: [1, 5, 0],
        seconds: [40.9, 723.4],
        ..UNPRINTED
    })
}

/// What the paper does not print of an example.
const UNPRINTED: PaperExample = PaperExample {
    count: 0,
    thinning: None,
    count_after_thinning: None,
    epsilon: 0.0,
    triangulation_epsilon: None,
    dimension_tolerance: None,
    fit_tolerance: None,
    curve_tolerance: None,
    landmark_separation: 0.0,
    surface: false,
    boundary_given: false,
    landmarks: 0,
    mean_neighbors: 0,
    betti: [0; 3],
    seconds: [0.0; 2],
};

/// An example in which the paper takes every point as 2-dimensional.
const fn manifold(
    count: usize,
    epsilon: f64,
    landmark_separation: f64,
    landmarks: usize,
    mean_neighbors: usize,
    betti: [usize; 3],
    seconds: [f64; 2],
) -> PaperExample {
    PaperExample {
        count,
        epsilon,
        landmark_separation,
        landmarks,
        mean_neighbors,
        betti,
        seconds,
        surface: true,
        ..UNPRINTED
    }
}
