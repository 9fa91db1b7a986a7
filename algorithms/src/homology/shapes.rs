//! Complexes with known homology, for tests.

use crosscap_core::{Complex, CurveEdge};

/// A complex under construction from discs and annuli whose rims run along given vertices.
#[derive(Default)]
pub struct Builder {
    pub vertices: u32,
    pub triangles: Vec<[u32; 3]>,
}

impl Builder {
    pub fn vertex(&mut self) -> u32 {
        self.vertices += 1;
        self.vertices - 1
    }

    pub fn path(&mut self, count: usize) -> Vec<u32> {
        (0..count).map(|_| self.vertex()).collect()
    }

    /// A ring of as many new vertices as the closed walk `rim` has, and the annulus between them.
    /// The walk may run over vertices and edges as often as it likes.
    pub fn collar(&mut self, rim: &[u32]) -> Vec<u32> {
        let ring = self.path(rim.len());
        self.band(rim, &ring);
        ring
    }

    /// The annulus between two closed walks of equal length.
    pub fn band(&mut self, rim: &[u32], ring: &[u32]) {
        for i in 0..rim.len() {
            let next = (i + 1) % rim.len();
            self.triangles.push([rim[i], rim[next], ring[i]]);
            self.triangles.push([rim[next], ring[i], ring[next]]);
        }
    }

    /// A disc along the closed walk `rim`.
    pub fn disc(&mut self, rim: &[u32]) {
        let ring = self.collar(rim);
        let center = self.vertex();
        for i in 0..ring.len() {
            self.triangles
                .push([ring[i], ring[(i + 1) % ring.len()], center]);
        }
    }

    /// An annulus between two closed walks of equal length.
    pub fn annulus(&mut self, rim: &[u32], other: &[u32]) {
        let ring = self.collar(rim);
        let second = self.collar(other);
        self.band(&ring, &second);
    }

    pub fn build(self) -> Complex {
        Complex::new(self.vertices as usize, self.triangles, vec![]).unwrap()
    }
}

/// The 2-complex of a group presentation: for each generator a circle of three edges through
/// vertex 0, there even if no word runs along it, and a disc for each word. Words are of
/// letters `1, -1, 2, -2, ..`.
pub fn presentation(generators: usize, words: &[Vec<i32>]) -> Complex {
    let mut b = Builder::default();
    b.vertex();
    let loops: Vec<[u32; 2]> = (0..generators).map(|_| [b.vertex(), b.vertex()]).collect();
    for word in words {
        let letters = word
            .iter()
            .map(|&x| (loops[x.unsigned_abs() as usize - 1], x > 0));
        let rim: Vec<u32> = letters
            .flat_map(|([p, q], forward)| if forward { [0, p, q] } else { [0, q, p] })
            .collect();
        b.disc(&rim);
    }
    let circles = loops
        .iter()
        .flat_map(|&[p, q]| [(0, p), (p, q), (0, q)])
        .map(|(p, q)| CurveEdge::new(p, q, 0));
    Complex::new(b.vertices as usize, b.triangles, circles.collect()).unwrap()
}

/// A rectangle of `m` by `n` squares, columns glued by `i -> i + m`, rows by `j -> j + n` with
/// the other coordinate mirrored where asked for.
pub fn glued_rectangle(m: usize, n: usize, mirror: bool) -> Complex {
    let at = |i: usize, j: usize| {
        let i = if j == n && mirror { 2 * m - i } else { i };
        ((i % m) * n + j % n) as u32
    };
    let mut triangles = Vec::new();
    for i in 0..m {
        for j in 0..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, c, d]]);
        }
    }
    Complex::new(m * n, triangles, vec![]).unwrap()
}

/// A strip of `m` squares closed to an annulus, or to a Moebius strip.
pub fn strip(m: u32, twisted: bool) -> Complex {
    let at = |i: u32, side: u32| 2 * (i % m) + if twisted && i == m { 1 - side } else { side };
    let triangles = (0..m).flat_map(|i| {
        let [a, b, c, d] = [at(i, 0), at(i, 1), at(i + 1, 0), at(i + 1, 1)];
        [[a, b, c], [b, c, d]]
    });
    Complex::new(2 * m as usize, triangles.collect(), vec![]).unwrap()
}

/// `count` discs along one circle.
pub fn discs_along_a_circle(count: usize) -> Complex {
    let mut b = Builder::default();
    let circle = b.path(3);
    for _ in 0..count {
        b.disc(&circle);
    }
    b.build()
}

/// Three spheres, any two of which cross in a circle, all circles through two triple points.
pub fn three_spheres() -> Complex {
    let mut b = Builder::default();
    let (p, q) = (b.vertex(), b.vertex());
    // arcs[k]: the two halves of the circle that the spheres other than k have in common.
    let arcs: Vec<[Vec<u32>; 2]> = (0..3).map(|_| [b.path(2), b.path(2)]).collect();
    for sphere in 0..3 {
        let (x, y) = (&arcs[(sphere + 1) % 3], &arcs[(sphere + 2) % 3]);
        let around = [&x[0], &y[0], &x[1], &y[1]];
        for k in 0..4 {
            let (go, back) = (around[k], around[(k + 1) % 4]);
            b.disc(&[p, go[0], go[1], q, back[1], back[0]]);
        }
    }
    b.build()
}

/// A Klein bottle and a sphere that meet in two circles, both one-sided on the Klein bottle.
pub fn sphere_and_klein_bottle() -> Complex {
    let mut b = Builder::default();
    let circles = [b.path(3), b.path(3)];
    let twice = |c: &[u32]| [c, c].concat();
    b.annulus(&twice(&circles[0]), &twice(&circles[1]));
    b.annulus(&circles[0], &circles[1]);
    b.disc(&circles[0]);
    b.disc(&circles[1]);
    b.build()
}

/// One next to the other.
pub fn disjoint_union(a: &Complex, b: &Complex) -> Complex {
    let shift = a.vertices as u32;
    let triangles = b.triangles.iter().map(|t| t.map(|v| v + shift));
    let edges = b.curve_edges.iter();
    let edges = edges.map(|e| CurveEdge::new(e.ends[0] + shift, e.ends[1] + shift, e.cells));
    Complex::new(
        a.vertices + b.vertices,
        a.triangles.iter().copied().chain(triangles).collect(),
        a.curve_edges.iter().copied().chain(edges).collect(),
    )
    .unwrap()
}

/// Joined at vertex 0 of both.
pub fn wedge(a: &Complex, b: &Complex) -> Complex {
    let apart = disjoint_union(a, b);
    let shift = a.vertices as u32;
    let name = |v: u32| match v.cmp(&shift) {
        std::cmp::Ordering::Less => v,
        std::cmp::Ordering::Equal => 0,
        std::cmp::Ordering::Greater => v - 1,
    };
    relabelled(&apart, apart.vertices - 1, name)
}

/// The same complex with other names of vertices.
pub fn relabelled(c: &Complex, vertices: usize, name: impl Fn(u32) -> u32) -> Complex {
    let triangles = c.triangles.iter().map(|t| t.map(&name)).collect();
    let edges = c.curve_edges.iter();
    let edges = edges.map(|e| CurveEdge::new(name(e.ends[0]), name(e.ends[1]), e.cells));
    Complex::new(vertices, triangles, edges.collect()).unwrap()
}

/// The first barycentric subdivision.
pub fn subdivided(c: &Complex) -> Complex {
    let edges = c.edges();
    let middle = |a: u32, b: u32| {
        let at = edges.binary_search(&[a.min(b), a.max(b)]).unwrap();
        (c.vertices + at) as u32
    };
    let mut triangles = Vec::new();
    for (t, &[x, y, z]) in c.triangles.iter().enumerate() {
        let center = (c.vertices + edges.len() + t) as u32;
        for (a, b) in [(x, y), (y, z), (x, z)] {
            triangles.extend([[a, middle(a, b), center], [b, middle(a, b), center]]);
        }
    }
    let curves = c.curve_edges.iter().flat_map(|e| {
        let m = middle(e.ends[0], e.ends[1]);
        e.ends.map(|v| CurveEdge::new(v, m, e.cells))
    });
    Complex::new(
        c.vertices + edges.len() + c.triangles.len(),
        triangles,
        curves.collect(),
    )
    .unwrap()
}
