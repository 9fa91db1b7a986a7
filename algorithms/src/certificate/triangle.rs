//! One triangle of a mesh.

use crosscap_core::Mesh;

/// Places of the corners of a triangle.
pub(super) fn corners(mesh: &Mesh, t: u32) -> [&[f64]; 3] {
    mesh.complex.triangles[t as usize].map(|v| mesh.vertices.point(v as usize))
}

/// Area of a triangle of R^N, through the height over the longest side of the first corner:
/// accurate for needles as well.
pub(super) fn area([a, b, c]: [&[f64]; 3]) -> f64 {
    let dot = |p: &[f64], q: &[f64]| -> f64 {
        p.iter()
            .zip(q)
            .zip(a)
            .map(|((p, q), a)| (p - a) * (q - a))
            .sum()
    };
    let (bb, cc, bc) = (dot(b, b), dot(c, c), dot(b, c));
    let (base, along, from, to) = if bb >= cc {
        (bb, bc, b, c)
    } else {
        (cc, bc, c, b)
    };
    if base == 0.0 {
        return 0.0;
    }
    let k = along / base;
    let height: f64 = (0..a.len())
        .map(|i| {
            let h = (to[i] - a[i]) - k * (from[i] - a[i]);
            h * h
        })
        .sum();
    0.5 * (base * height).sqrt()
}
