use super::*;

const RADIUS: f64 = 0.35;

/// What a ball at `height` over a disc holds of it and of a segment across it, coordinates about the mean.
/// The segment comes first, the center before all.
fn ball(height: f64, segment: usize, disc: usize) -> Vec<f64> {
    let step = 2.0 * RADIUS / segment as f64;
    let cap = (RADIUS * RADIUS - height * height).max(0.0).sqrt();
    let mut points = vec![[height, 0.0, 0.0]];
    points.extend((0..segment).map(|k| [height - RADIUS + (k as f64 + 0.5) * step, 0.0, 0.0]));
    points.extend((0..disc).map(|k| {
        let r = cap * ((k as f64 + 0.5) / disc as f64).sqrt();
        let angle = 2.4 * k as f64;
        [0.0, r * angle.cos(), r * angle.sin()]
    }));
    let count = points.len() as f64;
    let mean: Vec<f64> = (0..3)
        .map(|i| points.iter().map(|x| x[i]).sum::<f64>() / count)
        .collect();
    points
        .iter()
        .flat_map(|x| [0, 1, 2].map(|i| x[i] - mean[i]))
        .collect()
}

fn local(coordinates: &[f64], fitted: usize) -> LocalPoints<'_> {
    LocalPoints {
        dimension: 3,
        coordinates,
        fitted,
        center: 0,
        middle: 0,
        radius: RADIUS,
    }
}

#[test]
fn the_sheet_does_not_bend_to_the_curve() {
    let model = CurveOnSheet::new(RADIUS / 5.0, RADIUS / 10.0).unwrap();
    for tenth in 1..9 {
        // Farther out the segment spreads more than the part of the disc.
        let height = 0.1 * f64::from(tenth) * RADIUS;
        let disc = (160.0 * (1.0 - (height / RADIUS).powi(2))) as usize;
        let mut points = ball(height, 36, disc);
        // Without the arc on the other side.
        let below = points
            .chunks(3)
            .skip(1)
            .take(36)
            .filter(|x| points[0] - x[0] > height)
            .count();
        points.drain(3..3 * (1 + below));
        let fit = model.decompose(&local(&points, points.len() / 3)).unwrap();
        assert!(
            fit.dimension_of(0) < 2,
            "height {height}: the center is in the sheet"
        );
        assert!(
            fit.center_offset < 1e-6 || fit.dimension_of(0) == 0,
            "{height}"
        );
        let apex = &fit.points[0];
        assert!(
            (apex[0] - points[0] + height).abs() < 1e-6,
            "{height}: {apex:?}"
        );
    }
}

#[test]
fn an_arc_that_is_not_fitted_is_there() {
    let mut points = ball(0.0, 40, 160);
    // The arc above goes to the end.
    let above: Vec<f64> = points.drain(3 * 21..3 * 41).collect();
    points.extend(above);
    let fitted = points.len() / 3 - 20;
    let on = CurveOnSheet::new(RADIUS / 5.0, RADIUS / 10.0).unwrap();
    let through = CurveThroughSheet::new(RADIUS / 5.0, RADIUS / 10.0).unwrap();
    assert!(on.decompose(&local(&points, fitted)).is_err());
    assert!(through.decompose(&local(&points, fitted)).is_ok());
    assert!(on.decompose(&local(&points[..3 * fitted], fitted)).is_ok());
    assert!(
        through
            .decompose(&local(&points[..3 * fitted], fitted))
            .is_err()
    );
}
