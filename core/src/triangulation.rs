//! From the waist to the complex.

use crate::{Complex, Error, Landmark, Scalar, StratifiedLandmarks};
use serde::{Deserialize, Serialize};

/// A star that stayed open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Incomplete {
    /// The landmark.
    pub landmark: Landmark,
}

/// What a triangulation counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TriangulationCounts {
    /// Stars visited, with repetitions.
    pub visits: usize,
    /// Repairs: stars that could not be closed at once.
    pub repairs: usize,
    /// Landmarks given up.
    pub dropped: usize,
}

/// What a triangulator makes of a waist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangulation {
    /// The complex on the landmarks: vertex k is landmark k, and one that was dropped is an isolated vertex.
    pub complex: Complex,
    /// Landmarks given up, in increasing order.
    pub dropped: Vec<Landmark>,
    /// Stars that stayed open, in increasing order of their landmarks.
    pub incomplete: Vec<Incomplete>,
    /// Counts for the report; zeros where nothing was counted.
    pub counts: TriangulationCounts,
}

/// Puts triangles on landmarks.
///
/// # Why it has this shape
/// A triangulator sees the waist and nothing else: no coordinates, no points between the landmarks, no model that said
/// where a curve is. Whatever it needs beside that (how stars are laid out, which triangle is tried first) is its own
/// affair and lies in its fields, since another method has other parts: the
/// advancing front asks a chart, a compatibility test and a triangle rule, a method that fills holes in a Rips complex
/// asks none of them. It is generic over the scalar of the distances, because it has no data of its own in which to fix one.
///
/// A triangulator may fail to close a star, and says so instead of closing it badly: the certificate judges the
/// mesh in any case, but only the triangulator knows which landmark it was stuck at, and a refusal that
/// names the place is worth more than a hole. An error is for what ends everything: a chart that breaks its laws.
///
/// # Laws
/// - *answer*: the complex is on the landmarks of the waist and has its curve edges; the corners of every triangle are
///   together in one neighborhood; what was dropped is a corner of nothing;
/// - *reproducible*: the same answer for the same waist;
/// - *scale*: the same complex when all distances are multiplied by one number;
/// - *told*: where no landmark was dropped and no star is called open, every landmark inside a cell has a closed
///   star: its link is one circle.
pub trait Triangulator<S: Scalar>: Sync {
    /// Triangulates.
    ///
    /// # Errors
    /// What a part of it breaks ([`Error::Law`], whose point is a landmark).
    fn triangulate(&self, waist: &StratifiedLandmarks<S>) -> Result<Triangulation, Error>;

    /// Short name for reports.
    fn name(&self) -> &str;
}

impl Triangulation {
    /// Whether this can be what a triangulator named `plugin` makes of `waist`: its law *answer*.
    ///
    /// O(t k) for t triangles and k neighborhoods that a landmark is in.
    ///
    /// # Errors
    /// [`Error::Law`] for the first landmark at which it cannot.
    pub fn check<S: Scalar>(
        &self,
        waist: &StratifiedLandmarks<S>,
        plugin: &str,
    ) -> Result<(), Error> {
        let broken = |law: &'static str, landmark: Landmark, detail: String| {
            Err(Error::Law {
                plugin: plugin.into(),
                law,
                point: landmark.index(),
                detail,
            })
        };
        let (complex, count) = (&self.complex, waist.strata().len());
        if complex.vertices != count {
            let law = "answer: the complex is on the landmarks";
            let detail = format!("{} vertices for {count} landmarks", complex.vertices);
            return broken(law, Landmark::default(), detail);
        }
        let mut told = [&complex.curve_edges[..], waist.curve_edges()].map(|edges| {
            let mut sorted: Vec<_> = edges.iter().map(|e| (e.ends, e.cells)).collect();
            sorted.sort_unstable();
            sorted.into_iter()
        });
        let [found, expected] = &mut told;
        loop {
            match (found.next(), expected.next()) {
                (None, None) => break,
                (a, b) if a == b => {}
                (a, b) => {
                    let law = "answer: the curve edges are those of the waist";
                    let at = a.or(b).map_or(0, |edge| edge.0[0]);
                    return broken(law, at.into(), format!("{a:?} in place of {b:?}"));
                }
            }
        }
        let homes = Homes::of(waist);
        for corners in &complex.triangles {
            if !homes.share(corners.map(Landmark::from)) {
                let law = "answer: the corners of a triangle are together in one neighborhood";
                return broken(law, corners[0].into(), format!("the triangle {corners:?}"));
            }
        }
        self.names_landmarks(count).or_else(|(landmark, detail)| {
            let law = "answer: what was dropped is a corner of nothing, what is open a landmark";
            broken(law, landmark, detail)
        })
    }

    fn names_landmarks(&self, count: usize) -> Result<(), (Landmark, String)> {
        let open: Vec<Landmark> = self.incomplete.iter().map(|i| i.landmark).collect();
        for named in [&self.dropped, &open] {
            let rises = named.is_sorted_by(|a, b| a < b);
            let last = named.last().copied().unwrap_or_default();
            if !rises || last.index() >= count.max(1) {
                let named: Vec<usize> = named.iter().map(|k| k.index()).collect();
                return Err((last, format!("{named:?} of {count} landmarks, in order")));
            }
        }
        let corners = self.complex.triangles.iter().flatten();
        let mut corners = corners.copied().map(Landmark::from);
        match corners.find(|c| self.dropped.binary_search(c).is_ok()) {
            Some(c) => Err((c, format!("landmark {c} was dropped and has a triangle"))),
            None => Ok(()),
        }
    }
}

/// The neighborhoods that every landmark is in, by landmark.
struct Homes {
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl Homes {
    fn of<S: Scalar>(waist: &StratifiedLandmarks<S>) -> Self {
        let mut starts = vec![0u32; waist.strata().len() + 1];
        let members = || waist.neighborhoods().iter().map(|near| near.members());
        for &m in members().flatten() {
            starts[m.index() + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut free = starts.clone();
        let mut list = vec![0u32; members().map(<[_]>::len).sum()];
        for (home, members) in (0..).zip(members()) {
            for &m in members {
                list[free[m.index()] as usize] = home;
                free[m.index()] += 1;
            }
        }
        Self { starts, list }
    }

    fn at(&self, landmark: Landmark) -> &[u32] {
        let k = landmark.index();
        &self.list[self.starts[k] as usize..self.starts[k + 1] as usize]
    }

    /// Whether one neighborhood holds all three.
    fn share(&self, corners: [Landmark; 3]) -> bool {
        let [a, b, c] = corners.map(|corner| self.at(corner));
        let in_both = |home: &&u32| b.binary_search(home).is_ok() && c.binary_search(home).is_ok();
        a.iter().any(|home| in_both(&home))
    }
}
