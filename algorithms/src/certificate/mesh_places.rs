//! Places all over a mesh, at which it is asked how far the points are.

use super::geometry::corners;
use crosscap_core::{Mesh, squared_distance};

/// Barycentric steps of a triangle whose sides are sampled at the latter's middle at least.
pub(super) fn steps(corners: [&[f64]; 3], separation: f64) -> usize {
    let longest = (0..3)
        .map(|k| squared_distance(corners[k], corners[(k + 1) % 3]))
        .fold(0.0, f64::max)
        .sqrt();
    let pieces = (longest / (2.0 * separation)).ceil();
    2 * (pieces.min(12.0) as usize).max(1)
}

/// Places inside an edge, as shares of the way.
pub(super) fn shares(pieces: usize) -> impl Iterator<Item = f64> {
    (1..pieces).map(move |i| i as f64 / pieces as f64)
}

/// Places of a triangle, as weights of its corners, which are none of them; whether each is inside.
pub(super) fn weights(pieces: usize) -> impl Iterator<Item = ([f64; 3], bool)> {
    let grid =
        (0..=pieces).flat_map(move |i| (0..=pieces - i).map(move |j| [i, j, pieces - i - j]));
    let weighed = grid.filter_map(move |steps| {
        let zeros = steps.iter().filter(|&&x| x == 0).count();
        (zeros < 2).then(|| (steps.map(|x| x as f64 / pieces as f64), zeros == 0))
    });
    std::iter::once(([1.0 / 3.0; 3], true)).chain(weighed)
}

/// The places of the mesh whose nearest points are asked for, one after the other, where the landmark separation is the
/// same everywhere.
pub(super) fn places(mesh: &Mesh, bare: &[[u32; 2]], separation: f64) -> Vec<f64> {
    let mut all = mesh.vertices.coordinates().to_vec();
    for &ends in bare {
        let [p, q] = ends.map(|v| mesh.vertices.point(v as usize));
        for t in shares(steps([p, q, q], separation)) {
            all.extend(p.iter().zip(q).map(|(p, q)| p * (1.0 - t) + q * t));
        }
    }
    for t in 0..mesh.complex.triangles.len() as u32 {
        let c = corners(mesh, t);
        for (w, _) in weights(steps(c, separation)) {
            let place = (0..c[0].len()).map(|k| w[0] * c[0][k] + w[1] * c[1][k] + w[2] * c[2][k]);
            all.extend(place);
        }
    }
    all
}
