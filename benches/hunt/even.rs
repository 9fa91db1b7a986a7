//! Clouds whose points are spread evenly.

use crosscap::prelude::*;
use crosscap_algorithms::surfaces::{Drawing, Feature, FeatureCloud, thin_randomly};

/// How many times as many points are drawn as are left when they are thinned.
const THINNED: usize = 12;
/// Least distance of thinned points, in their spacing: no more points find room where they are that dense (random sequential adsorption
/// of discs covers 0.547 of the plane).
const APART: f64 = 0.834;

/// A cloud of thinned points: about as many as asked for, and about as far from each other everywhere.
///
/// # Errors
/// As for [`Feature::draw`].
pub fn even(feature: &Feature, drawing: &Drawing) -> Result<FeatureCloud, Error> {
    let finer = (THINNED as f64).sqrt();
    let many = feature.draw(&Drawing {
        count: THINNED * drawing.count,
        size: finer * drawing.size,
        noise: finer * drawing.noise,
        ..*drawing
    })?;
    let rows = thin_randomly(&many.points, APART * finer * many.spacing, drawing.seed)?;
    let kept: Vec<f64> = (rows.iter())
        .flat_map(|&row| many.points.point(row).iter().copied())
        .collect();
    let wider = ((THINNED * drawing.count) as f64 / rows.len() as f64).sqrt();
    Ok(FeatureCloud {
        points: PointCloud::new(3, kept)?,
        spacing: wider * many.spacing,
        thinnest: wider * many.thinnest,
        size: many.size,
        resolved: many.resolved / wider,
    })
}
