use super::*;
use crate::dimension::PrincipalComponents;
use crate::execute::Serial;
use crate::principal::PrincipalFrame;
use crate::surfaces::{RingConformations, SampleSurface, Sampling};
use crosscap_core::squared_distance;
use std::time::Instant;

/// `cargo test --release -p crosscap-algorithms time_of_the_first_step -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn time_of_the_first_step() {
    let spheres = two_spheres();
    measure("two spheres", &spheres, 0.25);
    let ring = RingConformations::cyclo_octane().sample(200_000, 1).unwrap().points;
    measure("cyclo-octane", &ring, 0.46);
}

fn two_spheres() -> PointCloud<f64> {
    let surface = SampleSurface::find("two-spheres").unwrap();
    surface.sample(&Sampling::new(87_081, 1)).unwrap().points
}

fn measure<S: Scalar>(name: &str, cloud: &PointCloud<S>, eps: f64) {
    let start = Instant::now();
    let tree = MomentTree::new(cloud).unwrap();
    let built = start.elapsed().as_secs_f64();
    let found = tree.dimensions(eps, 0.05, &Serial).unwrap();
    let all = start.elapsed().as_secs_f64();
    let mean = found.iter().map(|f| f64::from(f.count)).sum::<f64>() / found.len() as f64;
    let other = found.iter().filter(|f| f.dimension != 2).count();
    println!("{name}: {} points, {mean:.0} neighbors, {other} not 2-dimensional; tree {built:.3} s, all {all:.3} s", found.len());
    let mut wrong = 0;
    for i in (0..cloud.len()).step_by(cloud.len() / 200) {
        let members: Vec<usize> = (0..cloud.len()).filter(|&j| S::of(squared_distance(cloud.point(i), cloud.point(j)).sqrt()) < S::of(eps)).collect();
        let frame = PrincipalFrame::of(cloud, members.iter().copied());
        let expected = PrincipalComponents::<f64>::new(0.05).unwrap().dimension_of(&frame.variances).0;
        wrong += usize::from(found[i].count as usize != members.len() || found[i].dimension as usize != expected);
    }
    println!("{wrong} wrong in the sample");
}
