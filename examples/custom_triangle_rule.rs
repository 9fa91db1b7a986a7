//! A triangle rule of one's own: the roundest triangle first.
//!
//! `cargo run --release --example custom_triangle_rule`

use crosscap_core::TriangleRule;
use crosscap_core::laws::{self, Settings};

/// Perimeter squared over area: least for the equilateral triangle, the same at every scale.
struct Roundest;

impl TriangleRule for Roundest {
    fn rank(&self, edge: f64, a: f64, b: f64) -> f64 {
        let perimeter = edge + a + b;
        let half = perimeter / 2.0;
        let square = half * (half - edge) * (half - a) * (half - b);
        // Written so that NaN and what rounding left of a flat triangle rank last.
        if square > 1e-14 * half.powi(4) {
            perimeter * perimeter / square.sqrt()
        } else {
            f64::INFINITY
        }
    }

    fn name(&self) -> &str {
        "roundest"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::rule(&Settings::default(), &Roundest)?;
    println!("{} obeys the laws of TriangleRule", Roundest.name());

    use crosscap::prelude::*;
    let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(4000, 7))?;
    let outcome = Pipeline::new(Parameters::new(0.4, 0.2).surface())?
        .rule(Box::new(Roundest))
        .reconstruct(&sample.points)?;
    let repairs = outcome.report.triangulation.repairs;
    println!("verified: {}, {repairs} repairs", outcome.is_verified());
    Ok(())
}
