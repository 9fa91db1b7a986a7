//! Laws of what comes out: the complex, whatever made it.

use super::inputs::{cloud, ranks};
use super::motion::{Motion, motions};
use super::trial::ensure;
use super::{Failures, Findings, Law, LawBroken, Settings};
use crate::{Complex, PointCloud};
use proptest::prelude::*;
use std::fmt::Debug;
use std::ops::RangeInclusive;

const SUBJECT: &str = "a reconstruction";

/// Motion of the input.
static MOTION: Law = Law {
    subject: SUBJECT,
    name: "motion",
    says: "the same complex after a rigid motion of the points",
    look_for: "a decision made by coordinates rather than distances; one that rounding can turn: a \
               point at exactly eps from another, two candidates of equal rank (a sample on a lattice \
               has many)",
};

/// Scaling of the input.
static SCALE: Law = Law {
    subject: SUBJECT,
    name: "scale",
    says: "the same complex when points and all lengths among the parameters are scaled",
    look_for: "an absolute tolerance; a parameter that is a length and was not scaled, or is none and \
               was",
};

/// Embedding of the input.
static EMBEDDING: Law = Law {
    subject: SUBJECT,
    name: "embedding",
    says: "the same complex after an isometric embedding in a larger space",
    look_for: "the dimension of the space in a formula; a part for R^3 alone that decides differently",
};

/// Random choices.
static SEED: Law = Law {
    subject: SUBJECT,
    name: "seed",
    says: "the same Betti numbers whatever the seed of the random choices",
    look_for: "a mesh that was taken without looking at its certificate; landmarks too far apart for the \
               bends of the surface, or a sample too thin in places: what a seed meets by chance",
};

/// Fineness of the mesh.
static SEPARATION: Law = Law {
    subject: SUBJECT,
    name: "separation",
    says: "the same Betti numbers for every landmark separation of a range",
    look_for: "a range that reaches beyond what the surface allows: handles and holes narrower than three \
               separations are lost, and below three spacings of the sample there are holes",
};

/// Names of the vertices.
static RELABELLING: Law = Law {
    subject: "a quantity of complexes",
    name: "relabelling",
    says: "the same value whatever the vertices are called",
    look_for: "an orientation read off the order of corners; a traversal that starts at vertex 0 and \
               ends in one component",
};

/// Euler-Poincare.
static EULER_POINCARE: Law = Law {
    subject: "Betti numbers",
    name: "Euler-Poincare",
    says: "b0 - b1 + b2 equals vertices - edges + triangles, over every field",
    look_for: "vertices without an edge, which are components of their own; edges without a triangle; \
               ranks computed in floating point or modulo a prime and called rational",
};

pub(super) static ALL: [&Law; 7] = [
    &MOTION,
    &SCALE,
    &EMBEDDING,
    &SEED,
    &SEPARATION,
    &RELABELLING,
    &EULER_POINCARE,
];

/// Laws of [`reconstruction()`].
static INVARIANCES: [&Law; 3] = [&MOTION, &SCALE, &EMBEDDING];
/// Laws of [`topology()`].
static CHOICES: [&Law; 2] = [&SEED, &SEPARATION];

/// Asks whether Betti numbers can be those of a complex.
///
/// # Errors
/// The law 'Euler-Poincare' when they cannot.
///
/// ```
/// use crosscap_core::{Complex, laws};
/// let sides = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3]]; // three sides of a tetrahedron
/// let disc = Complex::new(4, sides, vec![]).unwrap();
/// laws::euler_poincare(&disc, [1, 0, 0]).unwrap();
/// laws::euler_poincare(&disc, [1, 0, 1]).unwrap_err();
/// ```
pub fn euler_poincare(complex: &Complex, betti: [usize; 3]) -> Result<(), LawBroken> {
    let [b0, b1, b2] = betti.map(|b| b as i64);
    let (alternating, euler) = (b0 - b1 + b2, complex.euler_characteristic());
    if alternating == euler {
        return Ok(());
    }
    Err(LawBroken {
        law: &EULER_POINCARE,
        input: format!(
            "{} vertices, {} edges, {} triangles",
            complex.vertices,
            complex.edges().len(),
            complex.triangles.len()
        ),
        found: format!("{b0} - {b1} + {b2} is {alternating}, the Euler characteristic is {euler}"),
        seed: None,
    })
}

/// Puts a whole reconstruction through the invariances that it inherits from its parts.
///
/// `reconstruct` gets the moved points and the factor that every length among its parameters is to be
/// multiplied with; all else, seeds as well, must be the same from call to call. A rejection counts as
/// an answer. At most 16 motions of each kind are tried.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// use crosscap_core::{Complex, Error, PointCloud};
/// // Joins points at less than 1.5 (times the factor); no triangles.
/// let reconstruct = |points: &PointCloud<f64>, factor: f64| -> Result<Complex, Error> {
///     let near = |a: usize, b: usize| points.squared_distance(a, b).sqrt() < 1.5 * factor;
///     let pairs = (0..4).flat_map(|b| (0..b).map(move |a| (a, b)));
///     let edges = pairs.filter(|&(a, b)| near(a, b));
///     let edges = edges.map(|(a, b)| crosscap_core::CurveEdge::new(a as u32, b as u32, 0));
///     Complex::new(4, vec![], edges.collect())
/// };
/// let line = PointCloud::new(1, vec![0.0, 1.0, 2.0, 3.0]).unwrap();
/// laws::reconstruction(&Settings::default(), &line, reconstruct).unwrap();
/// ```
pub fn reconstruction<E: Debug>(
    settings: &Settings,
    points: &PointCloud<f64>,
    reconstruct: impl Fn(&PointCloud<f64>, f64) -> Result<Complex, E>,
) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &INVARIANCES);
    let settings = Settings {
        shrink_steps: settings.shrink_steps.min(64),
        ..settings.at_most(16)
    };
    let short = |answer: Result<Complex, E>| answer.map_err(|e| format!("{e:?}"));
    let expected = short(reconstruct(points, 1.0));
    let compare = |image: &PointCloud<f64>, factor: f64| {
        let found = short(reconstruct(image, factor));
        if found == expected {
            return Ok(());
        }
        Err(match (&expected, &found) {
            (Ok(a), Ok(b)) => {
                let new = b
                    .triangles
                    .iter()
                    .filter(|t| a.triangles.binary_search(t).is_err());
                format!(
                    "{} vertices and {} triangles became {} and {}; new are {:?} and more",
                    a.vertices,
                    a.triangles.len(),
                    b.vertices,
                    b.triangles.len(),
                    new.take(3).collect::<Vec<_>>()
                )
            }
            (a, b) => {
                let told = |x: &Result<Complex, String>| x.as_ref().err().cloned();
                format!("{:?} became {:?} (None: a complex)", told(a), told(b))
            }
        })
    };
    let n = points.dimension();
    found.put(MOTION.holds(&settings, &motions(), |m| {
        compare(&m.image(points, n, 1.0), 1.0)
    }));
    found.put(SCALE.holds(&settings, &(-6..=6_i32), |exponent| {
        let factor = 10_f64.powi(*exponent);
        compare(&cloud(n, points.coordinates(), factor), factor)
    }));
    found.put(
        EMBEDDING.holds(&settings, &(motions(), 1..=5_usize), |(m, more)| {
            compare(&Motion::image(m, points, n + more, 1.0), 1.0)
        }),
    );
    found.end()
}

/// Asks whether the Betti numbers of a surface are those of the surface, and not of the choices made on the
/// way: `betti` gets a seed and a landmark separation within `separations`, and reconstructs with
/// all else as it was. A rejection counts as an answer. At most 16 of each are tried.
///
/// # Errors
/// The laws that do not hold ([`Failures`]).
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// // A torus, as long as the mesh is fine enough for its hole.
/// let betti = |_seed: u64, dl: f64| Ok::<_, ()>(if dl < 0.6 { [1, 2, 1] } else { [1, 0, 1] });
/// laws::topology(&Settings::default(), 0.2..=0.5, betti).unwrap();
/// laws::topology(&Settings::default(), 0.2..=2.0, betti).unwrap_err();
/// ```
pub fn topology<E: Debug>(
    settings: &Settings,
    separations: RangeInclusive<f64>,
    betti: impl Fn(u64, f64) -> Result<[usize; 3], E>,
) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &CHOICES);
    let settings = Settings {
        shrink_steps: settings.shrink_steps.min(16),
        ..settings.at_most(16)
    };
    let short = |answer: Result<[usize; 3], E>| answer.map_err(|e| format!("{e:?}"));
    let finest = *separations.start();
    let expected = short(betti(0, finest));
    let compare = |seed: u64, separation: f64| {
        let found = short(betti(seed, separation));
        ensure!(
            found == expected,
            "{found:?}, but {expected:?} with seed 0 and separation {finest}"
        );
        Ok(())
    };
    found.put(SEED.holds(&settings, &any::<u64>(), |&seed| compare(seed, finest)));
    found.put(SEPARATION.holds(&settings, &separations, |&separation| {
        compare(0, separation)
    }));
    found.end()
}

/// Asks whether a quantity of a complex (its homology, a census, a verdict) is the same whatever the
/// vertices are called.
///
/// `of` gets the complex under other names, and the new name of every vertex.
///
/// # Errors
/// The law 'relabelling' when it is not.
///
/// ```
/// use crosscap_core::laws::{self, Settings};
/// use crosscap_core::Complex;
/// let disc = Complex::new(4, vec![[0, 1, 2], [0, 2, 3]], vec![]).unwrap();
/// laws::relabelling(&Settings::default(), &disc, |c, _| c.euler_characteristic()).unwrap();
/// laws::relabelling(&Settings::default(), &disc, |c, _| c.triangles[0]).unwrap_err();
/// ```
pub fn relabelling<T: PartialEq + Debug>(
    settings: &Settings,
    complex: &Complex,
    of: impl Fn(&Complex, &[u32]) -> T,
) -> Result<(), LawBroken> {
    let stay: Vec<u32> = (0..complex.vertices as u32).collect();
    let expected = of(complex, &stay);
    let keys = prop::collection::vec(any::<u16>(), complex.vertices);
    RELABELLING.holds(settings, &keys, |keys| {
        let names: Vec<u32> = ranks(keys).iter().map(|&k| k as u32).collect();
        let name = |v: u32| names[v as usize];
        let triangles = complex.triangles.iter().map(|t| t.map(name)).collect();
        let edges = complex.curve_edges.iter().map(|e| {
            let mut e = *e;
            e.ends = e.ends.map(name);
            e
        });
        let renamed = Complex::new(complex.vertices, triangles, edges.collect());
        let renamed = renamed.map_err(|e| format!("the complex is none: {e}"))?;
        let found = of(&renamed, &names);
        ensure!(
            found == expected,
            "{expected:?} became {found:?} by the names {names:?}"
        );
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::super::twins::{catches, quick};
    use super::*;
    use crate::{CurveEdge, Error};

    /// Joins points that are near; how near is what is spoiled.
    fn put(near: fn(&PointCloud<f64>, usize, usize, f64) -> bool) -> Result<(), Failures> {
        let points = PointCloud::new(2, vec![0.1, 0.0, 1.2, 0.3, 2.0, 1.0, 0.4, 1.9]).unwrap();
        reconstruction(&quick(), &points, |points, factor| {
            let pairs = (0..points.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
            let edges = pairs.filter(|&(a, b)| near(points, a, b, factor));
            let edges = edges.map(|(a, b)| CurveEdge::new(a as u32, b as u32, 0));
            Complex::new(points.len(), vec![], edges.collect()) as Result<_, Error>
        })
    }

    fn distance(points: &PointCloud<f64>, a: usize, b: usize) -> f64 {
        points.squared_distance(a, b).sqrt()
    }

    #[test]
    fn an_invariant_reconstruction_passes() {
        topology(&quick(), 0.1..=0.2, |_, _| Ok::<_, Error>([1, 2, 1])).unwrap();
        put(|points, a, b, factor| distance(points, a, b) < 1.6 * factor).unwrap();
    }

    #[test]
    fn every_fault_is_caught_by_its_law() {
        let along_x =
            put(|points, a, b, factor| (points.point(a)[0] - points.point(b)[0]).abs() < factor);
        catches(along_x, &MOTION);
        catches(put(|points, a, b, _| distance(points, a, b) < 1.6), &SCALE);
        let by_space = put(|points, a, b, factor| {
            distance(points, a, b) < 0.8 * factor * points.dimension() as f64
        });
        catches(by_space, &EMBEDDING);
        let lost =
            |seed: u64, _: f64| Ok::<_, Error>([1 + usize::from(!seed.is_multiple_of(7)), 0, 2]);
        catches(topology(&quick(), 0.1..=0.2, lost), &SEED);
        let closed = |_: u64, dl: f64| Ok::<_, Error>([1, usize::from(dl < 0.15), 0]);
        catches(topology(&quick(), 0.1..=0.2, closed), &SEPARATION);
        let disc = Complex::new(5, vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]], vec![]).unwrap();
        let at_zero = |c: &Complex, _: &[u32]| c.triangles.iter().filter(|t| t[0] == 0).count();
        catches(relabelling(&quick(), &disc, at_zero), &RELABELLING);
        euler_poincare(&disc, [1, 0, 0]).unwrap();
        catches(euler_poincare(&disc, [1, 1, 0]), &EULER_POINCARE);
    }
}
