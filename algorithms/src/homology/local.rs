//! Homology of the neighborhoods of the vertices.

use super::homology;
use super::sides::check_order;
use crate::execute::{Execute, map};
use crosscap_core::{Complex, CurveEdge, Error, Neighbor, NeighborhoodOracle, Scalar};
use petgraph::unionfind::UnionFind;
use serde::Serialize;

/// A neighborhood that is not contractible.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct LocalFailure {
    /// The vertex at its center.
    pub vertex: u32,
    /// Number of its vertices.
    pub members: usize,
    /// Betti numbers over the rational numbers.
    pub betti_rational: [usize; 3],
    /// Betti numbers over Z/2.
    pub betti_mod2: [usize; 3],
}

/// What [`local_homology`] found.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LocalHomology {
    /// Radius of the neighborhoods, unit of the data.
    pub radius: f64,
    /// Number of neighborhoods, one a vertex.
    pub neighborhoods: usize,
    /// Median number of vertices of a neighborhood.
    pub median_members: usize,
    /// Number of vertices with another part of the mesh in their ball, one that does not hang together with theirs
    /// within it.
    pub other_sheets: usize,
    /// The neighborhoods whose Betti numbers over Q or Z/2 are not 1, 0, 0, by vertex.
    pub failures: Vec<LocalFailure>,
}

/// Betti numbers of the neighborhood of every vertex: the paper's check (section 5) that each of them is
/// 1, 0, 0, as a small piece of a surface is contractible, crossing or not.
///
/// The ball of a vertex spans the subcomplex *induced* by the vertices at distance less than `radius` (strictly) from
/// it, in the metric of the oracle, whose points are the vertices: all triangles and edges with all their corners among
/// them. The neighborhood is the part of it that hangs together with the vertex; the vertices whose ball spans other parts
/// too are counted. Where there are none this is the check of the paper to the letter, which does not say what
/// complex it took. Where sheets cross at an angle a below 90 degrees there are always some, at a distance from the
/// curve between `radius` and `radius / sin(a)`, however good the mesh is.
///
/// The check asks the mesh and nothing else, and is sound for what the mesh should be: in a Delaunay
/// triangulation of a flat piece the vertices in a ball are those whose lifts to the paraboloid are on one side of a
/// plane, and what a convex polyhedral surface's vertices on one side of a plane span is contractible. It fails where a
/// triangle is missing, where there is a handle too many, and where the ball is too large for the surface and holds a tunnel
/// or a closed piece.
///
/// A radius below the length of an edge says nothing, as all neighborhoods are single vertices then.
///
/// O(V k log k) with k the number of vertices in a neighborhood; the result does not depend on `execute`.
///
/// # Errors
/// [`Error::Shape`] when the oracle has not as many points as the complex has vertices; [`Error::Law`] when a center is
/// not in its own neighborhood, as for a radius of 0; those of [`homology`].
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::homology::local_homology;
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
/// use crosscap_core::{Complex, PointCloud};
/// // The rim of a square: within reach of all four corners it has a hole.
/// let places = PointCloud::new(2, vec![0., 0., 1., 0., 1., 1., 0., 1.]).unwrap();
/// let edges = [[0, 1], [1, 2], [2, 3], [0, 3]];
/// let edges = edges.map(|[a, b]| crosscap_core::CurveEdge::new(a, b, 0)).to_vec();
/// let rim = Complex::new(4, vec![], edges).unwrap();
/// let oracle = BruteForceOracle::new(Euclidean::new(places.clone()));
/// let small = local_homology(&rim, &oracle, 1.2, &Serial).unwrap();
/// assert!(small.failures.is_empty());
/// let large = local_homology(&rim, &oracle, 1.5, &Serial).unwrap();
/// assert_eq!(large.failures.len(), 4);
/// assert_eq!(large.failures[0].betti_rational, [1, 1, 0]);
/// ```
pub fn local_homology<O: NeighborhoodOracle>(
    complex: &Complex,
    oracle: &O,
    radius: O::Scalar,
    execute: &dyn Execute,
) -> Result<LocalHomology, Error> {
    check_order(complex)?;
    let count = complex.vertices;
    if oracle.len() != count {
        return Err(Error::Shape {
            found: format!("an oracle over {} points", oracle.len()),
            expected: format!("{count}, the vertices"),
        });
    }
    let balls = Balls::new(complex);
    let found = map(
        execute,
        count,
        || Scratch::new(count),
        |scratch, center| {
            oracle.within(center, radius, &mut scratch.neighbors);
            balls.about(center, scratch)?.ok_or_else(|| Error::Law {
                plugin: "neighborhood oracle".into(),
                law: "the center is in its neighborhood",
                point: center,
                detail: format!("not within {} of itself", radius.as_f64()),
            })
        },
    );
    let found: Vec<Found> = found.into_iter().collect::<Result<_, Error>>()?;
    let mut sizes: Vec<usize> = found.iter().map(|f| f.members).collect();
    sizes.sort_unstable();
    let contractible = |f: &Found| f.betti_rational == [1, 0, 0] && f.betti_mod2 == [1, 0, 0];
    let each = found.iter().enumerate();
    let failures = each
        .filter(|(_, f)| !contractible(f))
        .map(|(v, f)| LocalFailure {
            vertex: v as u32,
            members: f.members,
            betti_rational: f.betti_rational,
            betti_mod2: f.betti_mod2,
        });
    Ok(LocalHomology {
        radius: radius.as_f64(),
        neighborhoods: count,
        median_members: sizes.get(count / 2).copied().unwrap_or(0),
        other_sheets: found.iter().filter(|f| f.others).count(),
        failures: failures.collect(),
    })
}

/// What is found about one neighborhood.
struct Found {
    members: usize,
    others: bool,
    betti_rational: [usize; 3],
    betti_mod2: [usize; 3],
}

/// No number: of a vertex outside of a ball.
const OUTSIDE: u32 = u32::MAX;

/// Buffers of one thread.
struct Scratch<S: Scalar> {
    neighbors: Vec<Neighbor<S>>,
    /// Number of a vertex in the ball, [`OUTSIDE`] for the others.
    number: Vec<u32>,
    members: Vec<u32>,
}

impl<S: Scalar> Scratch<S> {
    fn new(vertices: usize) -> Self {
        Self {
            neighbors: Vec::new(),
            number: vec![OUTSIDE; vertices],
            members: Vec::new(),
        }
    }
}

/// The triangles and edges of a complex by their first corner.
struct Balls<'c> {
    complex: &'c Complex,
    edges: Vec<[u32; 2]>,
    first_triangle: Vec<usize>,
    first_edge: Vec<usize>,
}

/// What the vertices in a ball span, by their numbers in it.
struct Spanned {
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
}

impl<'c> Balls<'c> {
    fn new(complex: &'c Complex) -> Self {
        let (count, edges) = (complex.vertices, complex.edges());
        // Both lists are sorted: the simplices whose first corner is v are consecutive.
        Self {
            complex,
            first_triangle: starts(count, complex.triangles.iter().map(|t| t[0])),
            first_edge: starts(count, edges.iter().map(|e| e[0])),
            edges,
        }
    }

    /// What is in the ball of a vertex, whose neighbors have been found; `None` where it is not among them.
    fn about<S: Scalar>(
        &self,
        center: usize,
        scratch: &mut Scratch<S>,
    ) -> Result<Option<Found>, Error> {
        let Scratch {
            neighbors,
            number,
            members,
        } = scratch;
        members.clear();
        members.extend(neighbors.iter().map(|n| n.index as u32));
        members.sort_unstable();
        for (k, &v) in members.iter().enumerate() {
            number[v as usize] = k as u32;
        }
        let spanned = self.spanned(members, number);
        for &v in members.iter() {
            number[v as usize] = OUTSIDE;
        }
        let Ok(own) = members.binary_search(&(center as u32)) else {
            return Ok(None);
        };
        let local = spanned.part(own as u32, members.len())?;
        let h = homology(&local)?;
        Ok(Some(Found {
            members: local.vertices,
            others: local.vertices < members.len(),
            betti_rational: h.betti_rational,
            betti_mod2: h.betti_mod2,
        }))
    }

    /// All triangles and edges with all their corners among the members.
    fn spanned(&self, members: &[u32], number: &[u32]) -> Spanned {
        let (mut triangles, mut edges) = (Vec::new(), Vec::new());
        for &v in members {
            let at = |starts: &[usize]| starts[v as usize]..starts[v as usize + 1];
            for t in &self.complex.triangles[at(&self.first_triangle)] {
                let t = t.map(|v| number[v as usize]);
                if t.iter().all(|&k| k != OUTSIDE) {
                    triangles.push(t);
                }
            }
            for e in &self.edges[at(&self.first_edge)] {
                let e = e.map(|v| number[v as usize]);
                if e[1] != OUTSIDE {
                    edges.push(e);
                }
            }
        }
        Spanned { triangles, edges }
    }
}

impl Spanned {
    /// The part that hangs together with one of `count` vertices, its vertices numbered anew in their order.
    fn part(mut self, own: u32, count: usize) -> Result<Complex, Error> {
        let mut parts = UnionFind::<u32>::new(count);
        for &[a, b] in &self.edges {
            parts.union(a, b);
        }
        let own = parts.find(own);
        let mut names = vec![OUTSIDE; count];
        let mut size = 0;
        for k in 0..count as u32 {
            if parts.find(k) == own {
                names[k as usize] = size;
                size += 1;
            }
        }
        let here = |k: u32| names[k as usize] != OUTSIDE;
        self.triangles.retain(|t| here(t[0]));
        self.edges.retain(|e| here(e[0]));
        let named = |k: u32| names[k as usize];
        let triangles = self.triangles.iter().map(|t| t.map(named)).collect();
        let edges = self.edges.iter().map(|e| e.map(named));
        let edges = edges.map(|[a, b]| CurveEdge::new(a, b, 0)).collect();
        Complex::new(size as usize, triangles, edges)
    }
}

/// Where in a sorted list each vertex begins, and the end.
fn starts(count: usize, first: impl Iterator<Item = u32>) -> Vec<usize> {
    let mut starts = vec![0; count + 1];
    first.for_each(|v| starts[v as usize + 1] += 1);
    for v in 0..count {
        starts[v + 1] += starts[v];
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crosscap_core::PointCloud;
    use std::f64::consts::TAU;

    /// A tube of radius 1 along the z axis, `m` around and `n` + 1 along, squares of unit length.
    fn tube(m: u32, n: u32) -> (PointCloud<f64>, Complex) {
        let mut places = Vec::new();
        let step = 2.0 * (TAU / f64::from(m) / 2.0).sin();
        for j in 0..=n {
            for i in 0..m {
                let (s, c) = (TAU * f64::from(i) / f64::from(m)).sin_cos();
                places.extend([c, s, step * f64::from(j)]);
            }
        }
        let squares = (0..n).flat_map(|j| (0..m).map(move |i| (i, j)));
        let triangles = squares.flat_map(|(i, j)| {
            let [a, b] = [j * m + i, j * m + (i + 1) % m];
            [[a, b, a + m], [b, a + m, b + m]]
        });
        let complex = Complex::new(((n + 1) * m) as usize, triangles.collect(), vec![]).unwrap();
        (PointCloud::new(3, places).unwrap(), complex)
    }

    fn check(places: &PointCloud<f64>, complex: &Complex, radius: f64) -> LocalHomology {
        let oracle = BruteForceOracle::new(Euclidean::new(places.clone()));
        local_homology(complex, &oracle, radius, &Serial).unwrap()
    }

    #[test]
    fn balls_that_reach_around_a_tube_fail() {
        let (places, complex) = tube(24, 30);
        let small = check(&places, &complex, 0.9);
        assert_eq!(small.other_sheets, 0);
        assert_eq!((small.neighborhoods, small.failures.len()), (24 * 31, 0));
        assert!(small.median_members > 20, "{}", small.median_members);
        // A ball larger than the diameter holds a whole piece of the tube.
        let large = check(&places, &complex, 2.1);
        assert_eq!(large.failures.len(), 24 * 31);
        assert!(large.failures.iter().all(|f| f.betti_rational == [1, 1, 0]));
    }

    #[test]
    fn a_missing_triangle_is_found_where_it_is() {
        let (places, complex) = tube(24, 30);
        let mut triangles = complex.triangles.clone();
        let missing = triangles.remove(triangles.len() / 2);
        let holed = Complex::new(complex.vertices, triangles, vec![]).unwrap();
        let found = check(&places, &holed, 0.9);
        assert!(!found.failures.is_empty());
        for f in &found.failures {
            assert_eq!(f.betti_rational, [1, 1, 0]);
            let near = missing
                .iter()
                .any(|&c| places.squared_distance(c as usize, f.vertex as usize) < 0.81);
            assert!(near, "{f:?}");
        }
        for corner in missing {
            assert!(found.failures.iter().any(|f| f.vertex == corner));
        }
    }

    #[test]
    fn sheets_that_do_not_meet_are_other_sheets() {
        let (places, complex) = tube(24, 4);
        let mut both = places.coordinates().to_vec();
        both.extend(places.iter().flat_map(|p| [p[0], p[1], p[2] + 20.0]));
        // The second tube beside the first, 0.3 apart.
        for p in both[places.coordinates().len()..].chunks_exact_mut(3) {
            (p[0], p[2]) = (p[0] + 2.3, p[2] - 20.0);
        }
        let shift = complex.vertices as u32;
        let second = complex.triangles.iter().map(|t| t.map(|v| v + shift));
        let triangles = complex.triangles.iter().copied().chain(second).collect();
        let two = Complex::new(2 * complex.vertices, triangles, vec![]).unwrap();
        let places = PointCloud::new(3, both).unwrap();
        let found = check(&places, &two, 0.5);
        assert!(found.other_sheets > 0 && found.other_sheets < two.vertices);
        assert!(found.failures.is_empty());
        assert_eq!(check(&places, &two, 0.29).other_sheets, 0);
    }

    #[test]
    fn refuses_an_oracle_over_something_else() {
        let (places, _) = tube(6, 1);
        let oracle = BruteForceOracle::new(Euclidean::new(places.clone()));
        let other = Complex::new(3, vec![[0, 1, 2]], vec![]).unwrap();
        assert!(local_homology(&other, &oracle, 1.0, &Serial).is_err());
    }
}
