//! What a refused reconstruction leaves behind: lines, report, picture, the neighborhood of the worst place.

use super::failure::Failure;
use super::findings::pretty;
use super::outcome::{findings, report};
use super::terminal::complain;
use super::{overlay, picture};
use crosscap::refusal::{FaultKind, Refusal};
use crosscap_backends::euclidean::EuclideanOracle;
use crosscap_backends::files::{write_bytes_whole, write_points};
use crosscap_core::{NeighborhoodOracle, PointCloud};
use serde_json::{Value, json};
use std::path::Path;

/// Points that are cut out around the worst place: ten spacings around.
const CUT_OUT: usize = 1500;

/// A line for every kind of fault, and what to do, with the options to do it by where they were tried.
pub fn tell(refusal: &Refusal, options: Option<&str>) {
    for fault in &refusal.faults {
        complain(fault);
    }
    match options {
        Some(options) => complain(format_args!(
            "what to do: {}; give {options}",
            refusal.advice
        )),
        None => complain(format_args!("what to do: {}", refusal.advice)),
    }
}

/// The report of a refusal, with everything that is known of the mesh where there is one.
pub fn write_report(
    path: &Path,
    refusal: &Refusal,
    options: Option<&str>,
    input: Value,
    search: &Value,
) -> Result<(), Failure> {
    let mut all = match &refusal.outcome {
        Ok(outcome) => report(outcome, input),
        Err(error) => json!({
            "version": env!("CARGO_PKG_VERSION"),
            "input": input,
            "error": error.to_string(),
        }),
    };
    if let (Value::Object(all), Value::Object(search)) = (&mut all, search) {
        all.extend(search.clone());
        all.insert("verified".into(), json!(false));
        all.insert(
            "refusal".into(),
            json!({
                "faults": refusal.faults,
                "advice": refusal.advice,
                "advice_in_words": refusal.advice.to_string(),
                "options": options,
            }),
        );
    }
    Ok(write_bytes_whole(path, pretty(&all).as_bytes())?)
}

/// The mesh as it is, with the places of the faults marked.
pub fn write_picture(
    path: &Path,
    title: &str,
    refusal: &Refusal,
    points: Option<&PointCloud<f64>>,
) -> Result<(), Failure> {
    let Ok(outcome) = &refusal.outcome else {
        complain(format_args!(
            "{}: not written, as there is no mesh to draw",
            path.display()
        ));
        return Ok(());
    };
    let mut scene = picture::scene(title, &findings(outcome), "refused", None)?;
    for fault in &refusal.faults {
        scene.facts.push(("fault".into(), fault.to_string()));
    }
    if let Some(points) = points {
        if picture::is_page(path) {
            overlay::add_points(&mut scene, &outcome.mesh, points)?;
        }
        let faults = refusal.faults.iter();
        let marks: Vec<_> = faults.map(|f| (f.rows.clone(), f.to_string())).collect();
        overlay::mark(&mut scene, &outcome.mesh, points, &marks)?;
    }
    Ok(write_bytes_whole(
        path,
        &picture::bytes(path, &scene, picture::SIZE)?,
    )?)
}

/// The points around the worst place, as a small file for a report of the failure.
pub fn write_cut_out(
    path: &Path,
    refusal: &Refusal,
    points: &PointCloud<f64>,
) -> Result<(), Failure> {
    let worst = refusal.worst().and_then(|spot| spot.row);
    let Some(row) = worst.filter(|&row| row < points.len()) else {
        complain(format_args!(
            "{}: not written, as no place stands out",
            path.display()
        ));
        return Ok(());
    };
    let oracle = EuclideanOracle::new(points.clone())?;
    let mut near = Vec::new();
    oracle.nearest(row, CUT_OUT, &mut near);
    let mut rows: Vec<usize> = near.iter().map(|x| x.index).collect();
    // The order of the file, so that rows keep their neighbors.
    rows.sort_unstable();
    Ok(write_points(path, &points.select(&rows))?)
}

/// Whether a further search may help: not where the points themselves are no surface.
pub fn may_be_helped(refusal: &Refusal) -> bool {
    let hopeless = |kind| {
        use FaultKind::{Dimension, Precision, TwoReadings, Unconfirmed};
        matches!(kind, Dimension | TwoReadings | Unconfirmed | Precision)
    };
    refusal
        .faults
        .first()
        .is_none_or(|fault| !hopeless(fault.kind))
}
