//! Laws of finished meshes, for the surfaces of users, and of producers of waists.
//!
//! The laws of the traits of the core are in [`crosscap_core::laws`], as are those that need a complex alone; here is
//! what takes homology and links, and what is about whole clouds.

use crate::certificate::{CertificateOptions, SpecialPoint, certify};
use crate::homology::homology;
use crate::stratify::WaistProducer;
use crosscap_core::laws::{self, Failures, Findings, Law, LawBroken, Settings};
use crosscap_core::{Mesh, Row, Scalar};

static LINKS: Law = Law {
    subject: "a mesh",
    name: "links",
    says: "every vertex looks like a point of a surface that may cross itself: its link is of an \
           admissible kind, or declared",
    look_for: "two sheets that hang together in one vertex; a curve whose edges are not all marked; a \
               special point (pinch, isolated crossing) that is not declared",
};

static UNUSABLE: Law = Law {
    subject: "a mesh",
    name: "indices",
    says: "corners are vertices, triangles are different, and no two vertices are at one place",
    look_for: "arrays that were put together by hand: `Complex::new` and `Mesh::new` check them",
};

const PRODUCER: &str = "WaistProducer";

static ANSWER: Law = Law {
    subject: PRODUCER,
    name: "answer",
    says: "a waist that passes its check, every landmark of which stands for a row of its own",
    look_for: "a neighborhood without its center in front; a distance of two members that was left out; a row that was \
               chosen twice, by the selector and as an extra one",
};

static EXTRA: Law = Law {
    subject: PRODUCER,
    name: "extra",
    says: "a row that is asked for and may be added is a landmark",
    look_for: "extra rows that are put through the separation again; may_add and waist by different rules",
};

static INDEPENDENCE: Law = Law {
    subject: PRODUCER,
    name: "independence",
    says: "a waist does not depend on those that were made before",
    look_for: "landmarks that are kept in a cell of the producer; a generator of random numbers that goes on",
};

/// Puts a producer of waists of so many `points` through its laws, with up to four rows as extra landmarks.
///
/// # Errors
/// The laws that do not hold; an error of the producer breaks the first.
pub fn producer<S: Scalar>(
    settings: &Settings,
    producer: &dyn WaistProducer<S>,
    points: usize,
) -> Result<(), Failures> {
    let mut found = Findings::new(settings, &[&ANSWER, &EXTRA, &INDEPENDENCE]);
    let broken = |law: &'static Law, extra: &[Row], found: String| {
        let extra: Vec<usize> = extra.iter().map(|row| row.index()).collect();
        LawBroken {
            law,
            input: format!("{points} points, extra rows {extra:?}"),
            found,
            seed: None,
        }
    };
    let make = |extra: &[Row]| {
        let checked = producer.waist(extra).and_then(|waist| {
            waist.check("the producer", points)?;
            Ok(waist)
        });
        checked.map_err(|e| broken(&ANSWER, extra, e.to_string()))
    };
    let first = make(&[])?;
    let extra: Vec<Row> = (0..points)
        .map(Row::new)
        .filter(|&row| producer.may_add(row) && !first.rows.contains(&row))
        .step_by((points / 4).max(1))
        .collect();
    let more = make(&extra)?;
    if let Some(row) = extra.iter().find(|row| !more.rows.contains(row)) {
        let detail = format!("row {row} is no landmark");
        found.put(Err(broken(&EXTRA, &extra, detail)));
    }
    let again = make(&[])?;
    if again.rows != first.rows || again.waist != first.waist {
        let detail = "another waist than before the one with extra rows".to_string();
        found.put(Err(broken(&INDEPENDENCE, &[], detail)));
    }
    found.end()
}

/// Puts a mesh through the laws that every result obeys: usable indices, Euler-Poincare over Q, Z/2
/// and Z/3, admissible links (`special` declares the others), and homology that does not depend on
/// the names of the vertices (16 other namings at most).
///
/// Holes, folds and distances to the points are for [`certify`].
///
/// # Errors
/// The laws that do not hold; where the indices cannot be used, that alone.
///
/// ```
/// use crosscap_algorithms::laws;
/// use crosscap_core::laws::Settings;
/// use crosscap_core::{Complex, Mesh, PointCloud};
/// let faces = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
/// let corners = vec![1., 1., 1., 1., -1., -1., -1., 1., -1., -1., -1., 1.];
/// let complex = Complex::new(4, faces, vec![]).unwrap();
/// let mesh = Mesh::new(complex, PointCloud::new(3, corners).unwrap(), vec![-1; 4]).unwrap();
/// laws::surface(&Settings::default(), &mesh, &[]).unwrap();
/// ```
pub fn surface(settings: &Settings, mesh: &Mesh, special: &[SpecialPoint]) -> Result<(), Failures> {
    let complex = &mesh.complex;
    let broken = |law: &'static Law, found: String| LawBroken {
        law,
        input: format!(
            "{} vertices, {} triangles, {} curve edges",
            complex.vertices,
            complex.triangles.len(),
            complex.curve_edges.len()
        ),
        found,
        seed: None,
    };
    let options = CertificateOptions {
        special_points: special,
        ..CertificateOptions::default()
    };
    let certificate = certify(mesh, &options);
    if let Some(first) = certificate.indices.violations.first() {
        return Err(broken(&UNUSABLE, first.to_string()).into());
    }
    let groups = homology(complex).map_err(|e| broken(&UNUSABLE, e.to_string()))?;
    let of_complexes = laws::all()
        .into_iter()
        .filter(|law| ["Betti numbers", "a quantity of complexes"].contains(&law.subject));
    let laws: Vec<&'static Law> = [&UNUSABLE, &LINKS]
        .into_iter()
        .chain(of_complexes)
        .collect();
    let mut found = Findings::new(settings, &laws);
    found.put(laws::euler_poincare(complex, groups.betti_rational));
    for p in [2, 3] {
        if let Ok(betti) = groups.betti_mod(p) {
            found.put(laws::euler_poincare(complex, betti));
        }
    }
    let links = certificate.links.unwrap_or_default();
    if let Some(first) = links.violations.first() {
        found.put(Err(broken(&LINKS, first.to_string())));
    }
    let few = Settings {
        cases: settings.cases.min(16),
        shrink_steps: settings.shrink_steps.min(64),
        ..settings.clone()
    };
    found.put(laws::relabelling(&few, complex, |renamed, _| {
        homology(renamed)
    }));
    found.end()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certificate::LinkKind;
    use crate::stratify::Stratification;
    use crosscap_core::{
        CellNeighborhood, Complex, Error, Landmark, PointCloud, SparseDistances,
        StratifiedLandmarks, Table,
    };
    use std::sync::Mutex;

    /// Two tetrahedra, with a vertex in common or without; `twice` puts two vertices at one place.
    fn tetrahedra(joined: bool, twice: bool) -> Mesh {
        let faces = |a: u32, b: u32| {
            [
                [a, b, b + 1],
                [a, b, b + 2],
                [a, b + 1, b + 2],
                [b, b + 1, b + 2],
            ]
        };
        let mut triangles = faces(0, 1).to_vec();
        triangles.extend(faces(if joined { 0 } else { 7 }, 4));
        let mut places = vec![0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.];
        places.extend([-1., 0., 0., 0., -1., 0., 0., 0., -1.]);
        if !joined {
            places.extend([-0.1, -0.1, -0.1]);
        }
        if twice {
            places.copy_within(3..6, 6);
        }
        let count = places.len() / 3;
        let complex = Complex::new(count, triangles, vec![]).unwrap();
        Mesh::new(
            complex,
            PointCloud::new(3, places).unwrap(),
            vec![-1; count],
        )
        .unwrap()
    }

    /// A waist of four rows of ten in one neighborhood, with what is wrong.
    struct Four(&'static str, Mutex<Vec<Row>>);

    impl WaistProducer<f64> for Four {
        fn waist(&self, extra: &[Row]) -> Result<Stratification<f64>, Error> {
            let mut rows = [2, 5, 6, 9].map(Row::new).to_vec();
            let mut kept = self.1.lock().unwrap();
            kept.extend(extra);
            match self.0 {
                "answer" => rows[1] = rows[0],
                "extra" => {}
                "independence" => rows.extend(kept.iter()),
                _ => rows.extend(extra),
            }
            let members: Vec<Landmark> = (0..rows.len()).map(Landmark::new).collect();
            let near = vec![CellNeighborhood::new(members[0], members)];
            let apart = |a: Landmark, b: Landmark| (a.index() + b.index()) as f64;
            let distances = SparseDistances::within(rows.len(), &near, apart)?;
            let strata = Table::filled(rows.len(), 2);
            let waist = StratifiedLandmarks::new(strata, vec![], near, distances)?;
            Ok(Stratification::new(waist, rows.into()))
        }

        fn may_add(&self, row: Row) -> bool {
            row.index() < 10
        }
    }

    #[test]
    fn a_producer_is_caught_by_its_law() {
        let put = |fault| producer(&Settings::default(), &Four(fault, Mutex::default()), 10);
        put("none").unwrap();
        for law in ["answer", "extra", "independence"] {
            let failures = put(law).unwrap_err();
            let first = failures.broken().next().unwrap();
            assert_eq!(
                (first.law.subject, first.law.name),
                (PRODUCER, law),
                "{first}"
            );
        }
    }

    #[test]
    fn what_is_wrong_is_caught_by_its_law() {
        let put =
            |mesh: &Mesh, special: &[SpecialPoint]| surface(&Settings::default(), mesh, special);
        put(&tetrahedra(false, false), &[]).unwrap();
        let joined = tetrahedra(true, false);
        let first = |found: Result<(), Failures>| {
            let failures = found.unwrap_err();
            failures.broken().next().unwrap().clone()
        };
        let broken = first(put(&joined, &[]));
        assert_eq!(broken.law.name, "links", "{broken}");
        assert!(broken.found.contains('0'), "{broken}");
        let declared = SpecialPoint {
            vertex: 0,
            link: LinkKind::IsolatedCrossing
                .link()
                .expect("two circles have a name"),
        };
        put(&joined, &[declared]).unwrap();
        let broken = first(put(&tetrahedra(false, true), &[]));
        assert_eq!(broken.law.name, "indices", "{broken}");
    }
}
