//! A compatibility test of one's own: one triangle clipped by the other.
//!
//! `cargo run --release --example custom_compatibility`

use crosscap_core::laws::{self, Settings};
use crosscap_core::{ChartTriangle, CompatibilityTest, Landmark, Meeting};

/// What two triangles have in common, by clipping, compared with the hull of their shared corners.
///
/// Within a tolerance of the size of the pair; the default of the pipeline is exact instead.
struct Clipping;

/// Of the size of the pair.
const TOLERANCE: f64 = 1e-9;

type Place = [f64; 2];

fn cross(a: Place, b: Place, c: Place) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Distance of `x` from the segment `ab`, which may be a point.
fn distance(x: Place, a: Place, b: Place) -> f64 {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
    let square = d[0] * d[0] + d[1] * d[1];
    let t = if square > 0.0 {
        ((d[0] * e[0] + d[1] * e[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (e[0] - t * d[0]).hypot(e[1] - t * d[1])
}

/// The part of a polygon left of the line from `a` to `b`, what is nearer to it than `slack` included.
fn left_part(polygon: &[Place], a: Place, b: Place, slack: f64) -> Vec<Place> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let height = |x: Place| cross(a, b, x) / length + slack;
    let mut part = Vec::new();
    for (k, &p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (f, g) = (height(p), height(q));
        if f >= 0.0 {
            part.push(p);
        }
        if (f < 0.0) != (g < 0.0) {
            let t = f / (f - g);
            part.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
        }
    }
    part
}

impl CompatibilityTest for Clipping {
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
        let shared: Vec<Place> = (0..3)
            .filter(|&k| b.corners.contains(&a.corners[k]))
            .map(|k| a.places[k])
            .collect();
        if shared.len() == 3 {
            return Meeting::CommonFace;
        }
        // The same answer for both orders: the clipped one is the one with the smaller corners.
        let (a, b) = if a.corners <= b.corners {
            (a, b)
        } else {
            (b, a)
        };
        let all = || a.places.iter().chain(&b.places);
        let size = all()
            .flat_map(|p| all().map(move |q| (p[0] - q[0]).hypot(p[1] - q[1])))
            .fold(0.0, f64::max);
        let slack = TOLERANCE * size;
        let [p, q, r] = b.places;
        let sides = if cross(p, q, r) > 0.0 {
            [(p, q), (q, r), (r, p)]
        } else {
            [(q, p), (p, r), (r, q)]
        };
        let mut common = a.places.to_vec();
        for (from, to) in sides {
            common = left_part(&common, from, to, slack);
        }
        if common.is_empty() {
            return Meeting::Disjoint;
        }
        let (Some(&first), Some(&last)) = (shared.first(), shared.last()) else {
            return Meeting::Overlap;
        };
        // Clipping at a small angle moves a corner by more than the slack.
        if common
            .iter()
            .all(|&x| distance(x, first, last) <= 1e4 * slack)
        {
            Meeting::CommonFace
        } else {
            Meeting::Overlap
        }
    }

    fn name(&self) -> &str {
        "clipping"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::compatibility(&Settings::default(), &Clipping)?;
    println!("{} obeys the laws of CompatibilityTest", Clipping.name());

    let below = ChartTriangle {
        corners: [0, 1, 2].map(Landmark::new),
        places: [[0.0, 0.0], [2.0, 0.0], [1.0, -1.0]],
    };
    let above = ChartTriangle {
        corners: [0, 1, 3].map(Landmark::new),
        places: [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]],
    };
    println!("{:?}", Clipping.meeting(&below, &above));

    use crosscap::prelude::*;
    let sample = SampleSurface::find("torus")?.sample(&Sampling::new(4000, 7))?;
    let outcome = Pipeline::new(Parameters::new(1.0, 0.4).surface())?
        .compatibility(Box::new(Clipping))
        .reconstruct(&sample.points)?;
    println!(
        "verified: {}, Betti numbers {:?}",
        outcome.is_verified(),
        outcome.homology.betti_rational
    );
    assert!(outcome.is_verified());
    Ok(())
}
