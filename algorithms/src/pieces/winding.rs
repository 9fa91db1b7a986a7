//! The order of corners that tells the two sides of a triangle apart.

use super::gluing::{FREE, Gluing};
use crate::homology::sides::runs_backward;
use crate::homology::signed_union::{Joined, SignedUnion};
use crosscap_core::{Error, Mesh};

/// The triangles of a mesh, in their order, each with its corners in an order that agrees with
/// its neighbors: two triangles that continue each other run through their common edge in opposite
/// directions.
///
/// A complex keeps the corners of a triangle sorted, which says nothing about sides. Programs that
/// draw, print or measure a surface ask for more: seen from outside, corners run counter-clockwise.
/// - Every orientable piece (see [`pieces`](super::pieces())) is wound consistently, also through
///   its double curves.
/// - A closed one in R^3 encloses a positive volume, the sum over its triangles of the signed
///   volumes of the tetrahedra with one point; a piece in R^2 has positive area. Otherwise the first
///   triangle of a piece keeps its corners sorted.
/// - A piece that is not orientable is wound along a tree of its triangles; some edges must
///   disagree.
///
/// Where the sheets at double curves cannot be told apart, a piece ends at these curves.
/// Time O(t log t), linear memory.
///
/// # Errors
/// [`Error::Shape`] or [`Error::Index`] when the mesh is not as [`crosscap_core::Complex::new`] and
/// [`Mesh::new`] leave it.
///
/// ```
/// use crosscap_algorithms::pieces::wound_triangles;
/// use crosscap_core::{Complex, Mesh, PointCloud};
/// // The boundary of a tetrahedron.
/// let triangles = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
/// let places = PointCloud::new(3, vec![0., 0., 0.,  1., 0., 0.,  0., 1., 0.,  0., 0., 1.]).unwrap();
/// let mesh = Mesh::new(Complex::new(4, triangles, vec![]).unwrap(), places, vec![-1; 4]).unwrap();
/// assert_eq!(wound_triangles(&mesh).unwrap(), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
/// ```
pub fn wound_triangles(mesh: &Mesh) -> Result<Vec<[u32; 3]>, Error> {
    let gluing = match Gluing::new(mesh) {
        Ok(gluing) => gluing,
        Err(_) => Gluing::across_plain_edges(mesh)?,
    };
    let triangles = &mesh.complex.triangles;
    let mut regions = SignedUnion::new(triangles.len());
    // By representative: whether the piece has no boundary, and can be oriented.
    let (mut free, mut twisted) = (Vec::new(), Vec::new());
    for s in 0..3 * triangles.len() as u32 {
        let t = gluing.partner[s as usize];
        if t == FREE {
            free.push(s / 3);
        } else if s < t {
            let opposite = runs_backward(s) == runs_backward(t);
            if regions.join(s / 3, t / 3, opposite) == Joined::Contradiction {
                twisted.push(s / 3);
            }
        }
    }
    let dimension = mesh.vertices.dimension();
    let mut measured = vec![matches!(dimension, 2 | 3); triangles.len()];
    let open = if dimension == 3 { &free[..] } else { &[] };
    for &t in open.iter().chain(&twisted) {
        measured[regions.find(t).0 as usize] = false;
    }
    let mut content = vec![0.0; triangles.len()];
    for t in 0..triangles.len() {
        let (piece, turned) = regions.find(t as u32);
        if measured[piece as usize] {
            let signed = signed_content(mesh, triangles[t], triangles[piece as usize][0]);
            content[piece as usize] += if turned { -signed } else { signed };
        }
    }
    let wound = |(t, &[a, b, c]): (usize, &[u32; 3])| {
        let (piece, turned) = regions.find(t as u32);
        if turned != (content[piece as usize] < 0.0) {
            [a, c, b]
        } else {
            [a, b, c]
        }
    };
    Ok(triangles.iter().enumerate().map(wound).collect())
}

/// Twice the signed area of a triangle in R^2, six times the signed volume of the tetrahedron with
/// `apex` in R^3.
fn signed_content(mesh: &Mesh, triangle: [u32; 3], apex: u32) -> f64 {
    let place = |v: u32| mesh.vertices.point(v as usize);
    let from = |o: u32, v: u32, k: usize| place(v)[k] - place(o)[k];
    let [a, b, c] = triangle;
    if mesh.vertices.dimension() == 2 {
        return from(a, b, 0) * from(a, c, 1) - from(a, b, 1) * from(a, c, 0);
    }
    let [u, v, w] = [a, b, c].map(|p| [0, 1, 2].map(|k| from(apex, p, k)));
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::{Complex, PointCloud};
    use std::collections::HashMap;
    use std::f64::consts::TAU;

    /// A grid of quadrilaterals, split: `i` around `n`, `j` around `m`, glued by `place`'s period;
    /// `flip` reverses `i` when `j` closes.
    fn grid(n: u32, m: u32, flip: bool, place: impl Fn(f64, f64) -> Vec<f64>) -> Mesh {
        let vertex = |i: u32, j: u32| {
            let i = if flip && j == m {
                (2 * n - i) % n
            } else {
                i % n
            };
            i + n * (j % m)
        };
        let mut triangles = Vec::new();
        for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
            let corner = |di, dj| vertex(i + di, j + dj);
            triangles.push([corner(0, 0), corner(1, 0), corner(0, 1)]);
            triangles.push([corner(1, 0), corner(1, 1), corner(0, 1)]);
        }
        let angles = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
        let places: Vec<f64> = angles
            .flat_map(|(i, j)| {
                place(
                    TAU * f64::from(i) / f64::from(n),
                    TAU * f64::from(j) / f64::from(m),
                )
            })
            .collect();
        let count = (n * m) as usize;
        let dimension = places.len() / count;
        Mesh::new(
            Complex::new(count, triangles, vec![]).unwrap(),
            PointCloud::new(dimension, places).unwrap(),
            vec![-1; count],
        )
        .unwrap()
    }

    fn torus(a: f64, b: f64) -> Vec<f64> {
        let r = 3.0 + a.cos();
        vec![r * b.cos(), r * b.sin(), a.sin()]
    }

    /// How often each edge is run through in its own direction, and backward.
    fn runs(triangles: &[[u32; 3]]) -> HashMap<[u32; 2], [u32; 2]> {
        let mut runs: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
        for &[a, b, c] in triangles {
            for [u, v] in [[a, b], [b, c], [c, a]] {
                runs.entry([u.min(v), u.max(v)]).or_default()[usize::from(u > v)] += 1;
            }
        }
        runs
    }

    fn volume(mesh: &Mesh, wound: &[[u32; 3]]) -> f64 {
        let each = wound.iter().map(|&t| signed_content(mesh, t, 0));
        each.sum::<f64>() / 6.0
    }

    #[test]
    fn a_torus_encloses_its_volume_whatever_its_numbering() {
        for mirror in [1.0, -1.0] {
            let mesh = grid(40, 60, false, |a, b| torus(a, mirror * b));
            let wound = wound_triangles(&mesh).unwrap();
            assert!(runs(&wound).values().all(|r| *r == [1, 1]));
            // 2 pi^2 R r^2; the polyhedron lies inside.
            let exact = 3.0 * TAU * TAU / 2.0;
            let found = volume(&mesh, &wound);
            assert!(found > 0.97 * exact && found < exact, "{found}, {exact}");
            for (t, w) in mesh.complex.triangles.iter().zip(&wound) {
                let mut sorted = *w;
                sorted.sort_unstable();
                assert_eq!(sorted, *t);
            }
        }
    }

    #[test]
    fn sheets_that_cross_are_wound_each_for_itself() {
        // Two tetrahedra with one edge in common, in which their sheets cross.
        let places = vec![
            0., 0., -1., 0., 0., 1., 2., 1., 0., 2., -1., 0., -2., 1., 0., -2., -1., 0.,
        ];
        let faces = |a, b| [[0, 1, a], [0, 1, b], [0, a, b], [1, a, b]];
        let mut triangles = faces(2, 3).to_vec();
        triangles.extend(faces(4, 5));
        let mesh = Mesh::new(
            Complex::new(6, triangles, vec![]).unwrap(),
            PointCloud::new(3, places).unwrap(),
            vec![-1; 6],
        )
        .unwrap();
        let wound = wound_triangles(&mesh).unwrap();
        let runs = runs(&wound);
        assert_eq!(runs[&[0, 1]], [2, 2]);
        assert!(runs.iter().all(|(e, r)| *e == [0, 1] || *r == [1, 1]));
    }

    #[test]
    fn one_sided_surfaces_disagree_on_a_curve_only() {
        // A Klein bottle in R^4.
        let mesh = grid(16, 24, true, |a, b| {
            let r = 3.0 + a.cos();
            vec![
                r * b.cos(),
                r * b.sin(),
                a.sin() * (b / 2.0).cos(),
                a.sin() * (b / 2.0).sin(),
            ]
        });
        let wound = wound_triangles(&mesh).unwrap();
        let wrong = runs(&wound).values().filter(|r| **r != [1, 1]).count();
        assert!(wrong > 0 && wrong < wound.len() / 4, "{wrong}");
    }

    #[test]
    fn a_plane_is_seen_from_above() {
        let places = PointCloud::new(2, vec![0., 0., 0., 1., 1., 0., 1., 1.]).unwrap();
        let complex = Complex::new(4, vec![[0, 1, 2], [1, 2, 3]], vec![]).unwrap();
        let mesh = Mesh::new(complex, places, vec![-1; 4]).unwrap();
        assert_eq!(wound_triangles(&mesh).unwrap(), [[0, 2, 1], [1, 2, 3]]);
    }
}
