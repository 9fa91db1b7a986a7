//! From points to a verified mesh in ten lines, and the mesh into a file.
//!
//! `cargo run --release --example reconstruct_sphere`

use crosscap::backends::files::{MeshExtras, write_mesh};
use crosscap::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Your own points: PointCloud::new(3, coordinates), row after row.
    let sample = SampleSurface::find("sphere")?.sample(&Sampling::new(4000, 7))?;
    let parameters = Parameters::new(0.4, 0.2).surface();
    let outcome = Pipeline::new(parameters)?.reconstruct(&sample.points)?;
    println!("{}", outcome.certificate);
    println!("Betti numbers {:?}", outcome.homology.betti_rational);
    if !outcome.is_verified() {
        return Err("not verified: the lines above say where and what to change".into());
    }
    let path = std::env::temp_dir().join("crosscap-sphere.ply");
    write_mesh(&path, &outcome.mesh, &MeshExtras::default(), None)?;
    println!("{}", path.display());
    Ok(())
}
