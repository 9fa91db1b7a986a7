//! Two spheres that cross: the double curve, the pieces, and the surface with its crossing undone.
//!
//! `cargo run --release --example two_spheres_pieces`

use crosscap::algorithms::homology::homology;
use crosscap::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let surface = SampleSurface::find("two_spheres")?;
    let sample = surface.sample(&Sampling {
        thinning: Some(0.02),
        ..Sampling::new(60_000, 1)
    })?;
    let parameters = Parameters {
        dp: 0.05,
        ep: 0.05,
        ..Parameters::new(0.25, 0.1)
    };
    let mut pipeline = Pipeline::new(parameters)?.on_stage(|stage| eprintln!("{stage}"));
    let outcome = pipeline.reconstruct(&sample.points)?;
    println!("verified: {}", outcome.is_verified());
    for failure in &outcome.failures {
        println!("  {failure}");
    }
    // As a space: two spheres glued along a circle enclose three chambers.
    println!("Betti numbers {:?}", outcome.homology.betti_rational);
    // As an immersed surface: what was glued is taken apart again.
    let pieces = outcome.pieces?;
    println!("{pieces}");
    for piece in &pieces.pieces {
        println!(
            "  {}: Euler characteristic {}, area {:.2}",
            piece.name, piece.euler, piece.area
        );
    }
    for curve in &pieces.curves {
        println!(
            "  double curve of length {:.2} between pieces {:?}",
            curve.length,
            curve.pieces()
        );
    }
    let apart = homology(&pieces.normalization.complex)?;
    println!(
        "Betti numbers of the normalization {:?}",
        apart.betti_rational
    );
    Ok(())
}
