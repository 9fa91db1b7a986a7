//! Which triangles stand at which edge.

use crosscap_core::{Complex, Error};

/// The sides of all triangles, grouped by the edge they lie on.
///
/// Side `3 t + k` is the side of triangle `t` opposite its corner `k`.
pub(crate) struct Sides {
    /// Edges that have a triangle, sorted, the smaller end first.
    pub edges: Vec<[u32; 2]>,
    starts: Vec<u32>,
    sides: Vec<u32>,
}

impl Sides {
    /// Groups the sides by edge: a counting sort by the smaller end, then each vertex's few
    /// sides by the larger end. O(v + t log d), d the largest number of sides at a vertex.
    ///
    /// # Errors
    /// Those of [`check_order`].
    pub fn new(complex: &Complex) -> Result<Self, Error> {
        check_order(complex)?;
        let triangles = &complex.triangles;
        let mut fill = vec![0u32; complex.vertices + 1];
        for &[a, b, _] in triangles {
            fill[a as usize + 1] += 2;
            fill[b as usize + 1] += 1;
        }
        for v in 0..complex.vertices {
            fill[v + 1] += fill[v];
        }
        // Larger end in the high half, side in the low half.
        let mut packed = vec![0u64; 3 * triangles.len()];
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            let t = 3 * t as u64;
            for (low, high, side) in [(b, c, t), (a, c, t + 1), (a, b, t + 2)] {
                let at = &mut fill[low as usize];
                packed[*at as usize] = u64::from(high) << 32 | side;
                *at += 1;
            }
        }
        let mut edges = Vec::with_capacity(packed.len() / 2 + 16);
        let mut starts = Vec::with_capacity(packed.len() / 2 + 17);
        let mut from = 0usize;
        for (v, &to) in fill[..complex.vertices].iter().enumerate() {
            let to = to as usize;
            let bucket = &mut packed[from..to];
            bucket.sort_unstable();
            let mut last = None;
            for (k, &entry) in bucket.iter().enumerate() {
                let high = (entry >> 32) as u32;
                if last != Some(high) {
                    edges.push([v as u32, high]);
                    starts.push((from + k) as u32);
                    last = Some(high);
                }
            }
            from = to;
        }
        starts.push(packed.len() as u32);
        Ok(Self {
            edges,
            starts,
            sides: packed.iter().map(|&entry| entry as u32).collect(),
        })
    }

    /// The sides on edge `e`, increasing.
    pub fn at(&self, e: usize) -> &[u32] {
        &self.sides[self.starts[e] as usize..self.starts[e + 1] as usize]
    }
}

/// Whether side `side` runs against its edge in the boundary of its triangle:
/// the boundary of abc is bc - ac + ab.
pub(crate) fn runs_backward(side: u32) -> bool {
    side % 3 == 1
}

/// Checks that the public fields of a complex keep what [`Complex::new`] promises, as a
/// complex that was read or edited need not.
///
/// # Errors
/// [`Error::Index`] for a vertex out of range, [`Error::Shape`] for what is out of order,
/// repeated, or more than can be indexed. O(t).
pub(crate) fn check_order(complex: &Complex) -> Result<(), Error> {
    // Sides and corners are counted, and one bit is kept for a sign.
    let most = (i32::MAX / 3) as usize;
    if complex.triangles.len() > most || complex.vertices > u32::MAX as usize {
        return Err(Error::Shape {
            found: format!(
                "{} vertices and {} triangles",
                complex.vertices,
                complex.triangles.len()
            ),
            expected: format!("at most {} vertices and {most} triangles", u32::MAX),
        });
    }
    let out_of_order = |what: String| Error::Shape {
        found: what,
        expected: "sorted triangles and curve edges with increasing corners, each once, as \
                   Complex::new leaves them"
            .into(),
    };
    let in_range = |v: u32| {
        if (v as usize) < complex.vertices {
            Ok(())
        } else {
            Err(Error::Index {
                what: "vertex",
                index: v as usize,
                limit: complex.vertices,
            })
        }
    };
    let mut previous = None;
    for t in &complex.triangles {
        in_range(t[2])?;
        if t[0] >= t[1] || t[1] >= t[2] || previous >= Some(t) {
            return Err(out_of_order(format!("triangle {t:?} after {previous:?}")));
        }
        previous = Some(t);
    }
    let mut previous = None;
    for edge in &complex.curve_edges {
        let ends = &edge.ends;
        in_range(ends[1])?;
        if ends[0] >= ends[1] || previous >= Some(ends) {
            return Err(out_of_order(format!(
                "curve edge {ends:?} after {previous:?}"
            )));
        }
        previous = Some(ends);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::CurveEdge;

    #[test]
    fn sides_of_two_triangles() {
        let c = Complex::new(4, vec![[0, 1, 2], [1, 2, 3]], vec![]).unwrap();
        let sides = Sides::new(&c).unwrap();
        assert_eq!(sides.edges, c.edges());
        assert_eq!(sides.at(2), &[0, 5]);
        assert_eq!(sides.at(0), &[2]);
    }

    #[test]
    fn refuses_what_complex_new_would_have_mended_or_refused() {
        let good = Complex::new(4, vec![[0, 1, 2], [1, 2, 3]], vec![CurveEdge::new(0, 1, 1)]);
        let good = good.unwrap();
        assert!(check_order(&good).is_ok());
        let mut bad = good.clone();
        bad.triangles.swap(0, 1);
        assert!(matches!(check_order(&bad), Err(Error::Shape { .. })));
        let mut bad = good.clone();
        bad.triangles[1][2] = 4;
        assert!(matches!(
            check_order(&bad),
            Err(Error::Index { index: 4, .. })
        ));
        let mut bad = good.clone();
        bad.triangles[0] = [1, 0, 2];
        assert!(check_order(&bad).is_err());
        let mut bad = good;
        bad.curve_edges.push(CurveEdge::new(0, 1, 4));
        assert!(check_order(&bad).is_err());
    }
}
