//! Temporary command line for measurements.
use crosscap::prelude::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let get = |k: &str| a.iter().position(|x| x == k).map(|i| a[i + 1].clone());
    let num = |k: &str| get(k).map(|x| x.parse::<f64>().unwrap());
    let cloud = crosscap::backends::files::read_points(&a[2], &Default::default())
        .unwrap()
        .into_f64();
    let mut p = Parameters::new(num("--eps").unwrap(), num("--dl").unwrap());
    if let Some(x) = num("--dt") {
        p.dt = x
    }
    if let Some(x) = num("--dp") {
        p.dp = x
    }
    if let Some(x) = num("--ep") {
        p.ep = x
    }
    p.tri_eps = num("--tri-eps");
    p.seed = num("--seed").unwrap_or(0.0) as u64;
    p.surface = a.contains(&"--surface".into());
    p.boundary = get("--boundary")
        .map(|f| crosscap::backends::files::read_indices(&f).unwrap())
        .unwrap_or_default();
    let mut pipe = Pipeline::new(p).unwrap();
    match pipe.reconstruct(&cloud) {
        Err(e) => {
            eprintln!("{e}");
            std::process::exit(1)
        }
        Ok(o) => {
            eprintln!("{}", serde_json::to_string(&o.report).unwrap());
            for f in &o.failures {
                eprintln!("{f}");
            }
            match o.certificate.verdict() {
                Verdict::Verified => {}
                v => eprintln!("{v}"),
            }
            if let Ok(p) = &o.pieces {
                eprintln!("{p}");
            }
            eprintln!("{:?}", o.homology.betti_rational);
            if o.is_verified() || a.contains(&"--keep-unverified".into()) {
                crosscap::backends::files::write_mesh(
                    get("-o").unwrap(),
                    &o.mesh,
                    &Default::default(),
                    None,
                )
                .unwrap();
            }
            if !o.is_verified() {
                std::process::exit(1)
            }
        }
    }
}
