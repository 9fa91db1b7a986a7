//! Normals at the corners of triangles, and light.

use nalgebra::Vector3;

/// Above this many triangles around a vertex its corners are not smoothed: the work grows
/// with the square, and such a fan is no smooth surface.
const WIDEST_FAN: usize = 64;

/// Corners are smoothed over triangles whose normals differ by less than 60 degrees.
const CREASE: f64 = 0.5;

/// A unit normal for each corner of each triangle; zero for a triangle without area.
///
/// The triangles around a vertex are averaged, weighted by area, as far as they hang together
/// without stepping over one of the sorted `curve_edges`. Signs are made to agree with the
/// triangle at hand rather than along the surface, which need not be orientable.
pub(super) fn corner_normals(
    places: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    curve_edges: &[[u32; 2]],
    smooth: bool,
) -> Vec<[Vector3<f64>; 3]> {
    let area: Vec<Vector3<f64>> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| places[v as usize]);
            (b - a).cross(&(c - a))
        })
        .collect();
    let unit: Vec<Vector3<f64>> = area
        .iter()
        .map(|n| super::view::unit(*n).unwrap_or_default())
        .collect();
    let mut normals: Vec<[Vector3<f64>; 3]> = unit.iter().map(|n| [*n; 3]).collect();
    if !smooth {
        return normals;
    }
    let (starts, around) = fans(places.len(), triangles);
    let mut group = Vec::new();
    for v in 0..places.len() {
        let fan = &around[starts[v]..starts[v + 1]];
        if fan.len() > WIDEST_FAN {
            continue;
        }
        join(fan, v as u32, triangles, curve_edges, &mut group);
        for (i, &(t, k)) in fan.iter().enumerate() {
            let mut sum = Vector3::zeros();
            for (j, &(s, _)) in fan.iter().enumerate() {
                let agreement = unit[t].dot(&unit[s]);
                if group[i] == group[j] && agreement.abs() > CREASE {
                    sum += area[s] * agreement.signum();
                }
            }
            if let Some(n) = super::view::unit(sum) {
                normals[t][k] = n;
            }
        }
    }
    normals
}

/// A triangle, and which of its corners.
type Corner = (usize, usize);

/// The corners at every vertex, one vertex after the other, and where those of each begin.
fn fans(vertices: usize, triangles: &[[u32; 3]]) -> (Vec<usize>, Vec<Corner>) {
    let mut starts = vec![0usize; vertices + 1];
    for t in triangles {
        for &v in t {
            starts[v as usize + 1] += 1;
        }
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut fill = starts.clone();
    let mut around = vec![(0, 0); triangles.len() * 3];
    for (t, corners) in triangles.iter().enumerate() {
        for (k, &v) in corners.iter().enumerate() {
            around[fill[v as usize]] = (t, k);
            fill[v as usize] += 1;
        }
    }
    (starts, around)
}

/// Which triangles about a vertex hang together across edges that are on no curve: those of one group have one number.
fn join(
    fan: &[Corner],
    v: u32,
    triangles: &[[u32; 3]],
    curve_edges: &[[u32; 2]],
    group: &mut Vec<usize>,
) {
    group.clear();
    group.extend(0..fan.len());
    for i in 0..fan.len() {
        for j in 0..i {
            let linked = triangles[fan[i].0].iter().any(|&w| {
                w != v
                    && triangles[fan[j].0].contains(&w)
                    && curve_edges.binary_search(&[v.min(w), v.max(w)]).is_err()
            });
            if linked && group[i] != group[j] {
                let (from, to) = (group[i].max(group[j]), group[i].min(group[j]));
                group
                    .iter_mut()
                    .filter(|g| **g == from)
                    .for_each(|g| *g = to);
            }
        }
    }
}

/// The color of a surface in light from the upper left and a weaker one from the right, the
/// same from both sides, darker towards the rim so that sheets stand out from each other.
///
/// `normal` and `eye` (towards the viewer, of length one) are in camera coordinates. Returns the color and
/// the cosine between the two.
pub(super) fn shade(color: [u8; 3], normal: Vector3<f64>, eye: Vector3<f64>) -> ([f32; 3], f64) {
    let length = normal.norm();
    let mut n = if length > 0.0 { normal / length } else { eye };
    let mut facing = n.dot(&eye);
    if facing < 0.0 {
        n = -n;
        facing = -facing;
    }
    let key = Vector3::new(-0.4137, 0.5976, 0.6870);
    let fill = Vector3::new(0.8137, -0.1162, 0.5695);
    let diffuse = 0.40 + 0.60 * n.dot(&key).max(0.0) + 0.14 * n.dot(&fill).max(0.0);
    let half = (key + eye).normalize();
    let shine = 255.0 * 0.16 * n.dot(&half).max(0.0).powi(36);
    let rim = (1.0 - facing).clamp(0.0, 1.0).powi(3);
    let light = diffuse * (1.0 - 0.5 * rim);
    (
        color.map(|c| (f64::from(c) * light + shine).clamp(0.0, 255.0) as f32),
        facing,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooths_over_edges_but_not_over_curves() {
        // A roof of two faces, tilted by 20 degrees each, with opposite orientation.
        let h = 20.0_f64.to_radians().tan();
        let places = [
            Vector3::new(0.0, 0.0, h),
            Vector3::new(0.0, 1.0, h),
            Vector3::new(1.0, 0.0, 0.0),
            Vector3::new(-1.0, 0.0, 0.0),
        ];
        let triangles = [[0, 1, 2], [0, 1, 3]];
        let smooth = corner_normals(&places, &triangles, &[], true);
        assert!((smooth[0][0].z.abs() - 1.0).abs() < 1e-9);
        assert!(smooth[0][2].z.abs() < 0.95);
        let creased = corner_normals(&places, &triangles, &[[0, 1]], true);
        assert!((creased[0][0] - creased[0][2]).norm() < 1e-9);
        let flat = corner_normals(&places, &triangles, &[], false);
        assert_eq!(flat, creased);
    }

    #[test]
    fn both_sides_are_lit_alike() {
        let eye = Vector3::z();
        let n = Vector3::new(0.3, 0.2, 0.9);
        assert_eq!(
            shade([200, 100, 50], n, eye),
            shade([200, 100, 50], -n, eye)
        );
        assert!(shade([9; 3], Vector3::zeros(), eye).0[0].is_finite());
    }
}
