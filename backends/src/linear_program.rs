//! The paper's linear program (6), on microlp.

use crosscap_core::{ChartTriangle, CompatibilityTest, Landmark, Meeting};
use microlp::{ComparisonOp, Error, LinearExpr, OptimizationDirection, Problem};

/// A maximum above this is an overlap.
const POSITIVE: f64 = 1e-6;

/// How two triangles of a chart meet, decided by the linear program (6) of Martin & Watson
/// (2011, section 2): the reference for the exact test
/// [`PlanarPredicate`](crosscap_algorithms::predicate::PlanarPredicate), whose documentation
/// defines the relation, and some hundreds of times slower.
///
/// For triangles with corners `u_i` and `v_j`, over `alpha, beta >= 0`:
///
/// ```text
/// maximize    sum of beta_j over the corners of the second that the first does not have
/// subject to  sum alpha_i u_i = sum beta_j v_j,   sum alpha_i = sum beta_j = 1
/// ```
///
/// No solution: disjoint. Maximum 0: only common faces meet. Positive: overlap. One term is
/// added here, the sum of `alpha_i` over the corners that the second does not have. For two
/// triangles with an interior it changes no answer, and it makes the test symmetric.
///
/// The chart is first moved to its centroid and scaled to unit size, since the solver's
/// tolerance (1e-7) is absolute: what is nearer than about 1e-6 of the size of the pair counts
/// as touching. Should the solver fail, the answer is the careful one, an overlap; so it is for
/// a landmark at two places and for coordinates that are not finite.
///
/// ```
/// use crosscap_backends::linear_program::LinearProgramTest;
/// use crosscap_core::{ChartTriangle, CompatibilityTest, Landmark, Meeting};
/// let below = ChartTriangle { corners: [0, 1, 2].map(Landmark::new), places: [[0.0, 0.0], [2.0, 0.0], [1.0, -1.0]] };
/// let above = ChartTriangle { corners: [1, 0, 3].map(Landmark::new), places: [[2.0, 0.0], [0.0, 0.0], [1.0, 1.0]] };
/// assert_eq!(LinearProgramTest.meeting(&below, &above), Meeting::CommonFace);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinearProgramTest;

impl CompatibilityTest for LinearProgramTest {
    fn meeting(&self, a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
        if contradictory(a, b) {
            return Meeting::Overlap;
        }
        let Some([u, v]) = normalized(a, b) else {
            return Meeting::Overlap;
        };
        let own = |t: &ChartTriangle, c: Landmark| if t.corners.contains(&c) { 0.0 } else { 1.0 };
        let mut problem = Problem::new(OptimizationDirection::Maximize);
        let alpha = a.corners.map(|c| problem.add_var(own(b, c), (0.0, 1.0)));
        let beta = b.corners.map(|c| problem.add_var(own(a, c), (0.0, 1.0)));
        for weights in [alpha, beta] {
            problem.add_constraint(weights.map(|w| (w, 1.0)), ComparisonOp::Eq, 1.0);
        }
        for axis in 0..2 {
            let mut balance = LinearExpr::empty();
            for i in 0..3 {
                balance.add(alpha[i], u[i][axis]);
                balance.add(beta[i], -v[i][axis]);
            }
            problem.add_constraint(balance, ComparisonOp::Eq, 0.0);
        }
        let shared = a.corners.iter().any(|c| b.corners.contains(c));
        let solution = match problem.solve() {
            Err(Error::Infeasible) if !shared => return Meeting::Disjoint,
            Err(_) => return Meeting::Overlap,
            Ok(outcome) => outcome.into_solution(),
        };
        match solution {
            Ok(solution) if solution.objective() <= POSITIVE => Meeting::CommonFace,
            _ => Meeting::Overlap,
        }
    }

    fn name(&self) -> &str {
        "linear program"
    }
}

fn contradictory(a: &ChartTriangle, b: &ChartTriangle) -> bool {
    let moved = |i: usize, j: usize| a.corners[i] == b.corners[j] && a.places[i] != b.places[j];
    let finite = |t: &ChartTriangle| t.places.iter().flatten().all(|x| x.is_finite());
    !finite(a) || !finite(b) || (0..3).any(|i| (0..3).any(|j| moved(i, j)))
}

/// Both triangles about their common centroid, scaled so that the largest coordinate is 1.
fn normalized(a: &ChartTriangle, b: &ChartTriangle) -> Option<[[[f64; 2]; 3]; 2]> {
    let center = [0, 1].map(|k| {
        let all = a.places.iter().chain(&b.places);
        all.map(|p| p[k] / 6.0).sum::<f64>()
    });
    let mut both = [a.places, b.places];
    let mut size = 0.0_f64;
    for x in both.iter_mut().flatten() {
        for k in 0..2 {
            x[k] -= center[k];
            size = size.max(x[k].abs());
        }
    }
    if size > 0.0 {
        both.iter_mut().flatten().flatten().for_each(|x| *x /= size);
    }
    // Not finite when the places are too far apart for their differences to be numbers.
    (both.iter().flatten().flatten().all(|x| x.is_finite())).then_some(both)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_algorithms::predicate::PlanarPredicate;
    use proptest::prelude::*;

    /// One lattice step; perturbations are whole numbers of 1 / STEP of it.
    const STEP: i64 = 1 << 16;

    type Corner = [i64; 2];

    fn triangle(landmarks: [u32; 3], places: [Corner; 3]) -> ChartTriangle {
        ChartTriangle {
            corners: landmarks.map(Landmark::from),
            places: places.map(|p| p.map(|x| x as f64)),
        }
    }

    /// The two triangles, with equal corners shared; then moved and scaled by powers of two, which
    /// keeps exact what touches exactly.
    fn pair(corners: [Corner; 6], exponent: i32) -> (ChartTriangle, ChartTriangle) {
        let name = |p: &Corner| corners.iter().position(|q| q == p).unwrap() as u32;
        let [a, b] = [0, 3].map(|at| {
            let places: [Corner; 3] = std::array::from_fn(|i| corners[at + i]);
            let mut t = triangle([0, 1, 2].map(|i| name(&places[i])), places);
            let scale = f64::from(exponent).exp2();
            t.places = t.places.map(|p| p.map(|x| x * scale));
            t
        });
        (a, b)
    }

    /// Whether some corner is nearly, but not exactly, in line with two others: nearer than the
    /// tolerance of the solver can tell, so that only the exact test knows the answer.
    fn unclear(corners: &[Corner; 6]) -> bool {
        let size = (0..2)
            .map(|k| {
                let c = corners.map(|p| p[k]);
                c.iter().max().unwrap() - c.iter().min().unwrap()
            })
            .max()
            .unwrap() as f64;
        let mut found = false;
        for i in 0..6 {
            for j in 0..i {
                for k in 0..j {
                    let [p, q, r] = [corners[i], corners[j], corners[k]];
                    let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
                    let longest = [(p, q), (q, r), (r, p)]
                        .map(|(s, t)| (((s[0] - t[0]).pow(2) + (s[1] - t[1]).pow(2)) as f64).sqrt())
                        .into_iter()
                        .fold(0.0, f64::max);
                    found |= area != 0 && (area.abs() as f64) < 2e-6 * longest * size;
                }
            }
        }
        found
    }

    fn flat([p, q, r]: [Corner; 3]) -> bool {
        (q[0] - p[0]) * (r[1] - p[1]) == (q[1] - p[1]) * (r[0] - p[0])
    }

    fn agree(corners: [Corner; 6], exponent: i32) -> Result<(), TestCaseError> {
        let [p, q, r, s, t, u] = corners;
        if flat([p, q, r]) || flat([s, t, u]) || unclear(&corners) {
            return Ok(());
        }
        let (a, b) = pair(corners, exponent);
        let exact = PlanarPredicate.meeting(&a, &b);
        prop_assert_eq!(LinearProgramTest.meeting(&a, &b), exact);
        prop_assert_eq!(LinearProgramTest.meeting(&b, &a), exact);
        Ok(())
    }

    fn lattice(most: i64) -> impl Strategy<Value = [Corner; 6]> {
        let corner = [0..=most, 0..=most].prop_map(|p| p.map(|x| x * STEP));
        [
            corner.clone(),
            corner.clone(),
            corner.clone(),
            corner.clone(),
            corner.clone(),
            corner,
        ]
    }

    fn any_lattice() -> impl Strategy<Value = [Corner; 6]> {
        prop_oneof![Just(2), Just(4), Just(11)].prop_flat_map(lattice)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1500))]

        /// Shared sides and corners, T-junctions, copies, sides in one line.
        #[test]
        fn agrees_where_much_touches(corners in any_lattice(), exponent in -46_i32..14) {
            agree(corners, exponent)?;
        }

        /// The same, pulled apart or pushed together by a hundred-thousandth of the size.
        #[test]
        fn agrees_next_to_touching(
            mut corners in any_lattice(),
            steps in prop::collection::vec((0_usize..6, -3_i64..=3, -3_i64..=3), 1..4),
            exponent in -46_i32..14,
        ) {
            for (at, x, y) in steps {
                corners[at] = [corners[at][0] + x, corners[at][1] + y];
            }
            agree(corners, exponent)?;
        }

        /// Triangles ten thousand times longer than wide, crossing, touching or side by side.
        #[test]
        fn agrees_on_thin_triangles(
            mut corners in any_lattice(),
            exponent in -46_i32..14,
            which in 0_usize..2,
        ) {
            for p in &mut corners[..3 + 3 * which] {
                p[1] /= 1 << 13;
            }
            agree(corners, exponent)?;
        }

        #[test]
        fn agrees_in_general_position(
            places in prop::array::uniform6(prop::array::uniform2(-1.0_f64..1.0)),
            shared in 0_u32..=3,
            exponent in -9_i32..=9,
            shift in prop::array::uniform2(-10.0_f64..10.0),
        ) {
            let rounded = places.map(|p| p.map(|x| (x * 1e9) as i64));
            let [p, q, r, mut s, mut t, mut u] = rounded;
            if shared > 0 { s = p; }
            if shared > 1 { t = q; }
            if shared > 2 { u = r; }
            let corners = [p, q, r, s, t, u];
            if unclear(&corners) || flat([p, q, r]) || flat([s, t, u]) {
                return Ok(());
            }
            let (mut a, mut b) = pair(corners, -30);
            let scale = 10_f64.powi(exponent);
            for t in [&mut a, &mut b] {
                t.places = t.places.map(|p| [0, 1].map(|k| (p[k] + shift[k]) * scale));
            }
            prop_assert_eq!(LinearProgramTest.meeting(&a, &b), PlanarPredicate.meeting(&a, &b));
        }
    }

    #[test]
    fn the_pairs_of_the_properties_cover_every_answer() {
        // Otherwise agreement would say little.
        use proptest::strategy::ValueTree;
        use proptest::test_runner::TestRunner;
        let mut runner = TestRunner::deterministic();
        let mut seen = [0; 3];
        for _ in 0..1500 {
            let corners = any_lattice().new_tree(&mut runner).unwrap().current();
            let (a, b) = pair(corners, 0);
            seen[PlanarPredicate.meeting(&a, &b) as usize] += 1;
        }
        assert!(seen.iter().all(|&count| count > 40), "{seen:?}");
    }

    #[test]
    fn contradictions_are_overlaps() {
        let a = triangle([0, 1, 2], [[0, 0], [4, 0], [0, 4]]);
        let moved = triangle([2, 3, 4], [[9, 9], [10, 9], [9, 10]]);
        assert_eq!(LinearProgramTest.meeting(&a, &moved), Meeting::Overlap);
        let mut infinite = triangle([3, 4, 5], [[9, 9], [10, 9], [9, 10]]);
        infinite.places[0][0] = f64::INFINITY;
        assert_eq!(LinearProgramTest.meeting(&a, &infinite), Meeting::Overlap);
    }

    #[test]
    fn triangles_without_size_have_an_answer() {
        for place in [[0, 0], [7, -3]] {
            let point = triangle([0, 1, 2], [place; 3]);
            let other = triangle([2, 3, 4], [place; 3]);
            for test in [
                &LinearProgramTest as &dyn CompatibilityTest,
                &PlanarPredicate,
            ] {
                assert_eq!(test.meeting(&point, &point), Meeting::CommonFace);
                assert_eq!(test.meeting(&point, &other), Meeting::Overlap);
            }
        }
    }

    /// `cargo test -p crosscap-backends time_of_a_test -- --ignored --nocapture`
    #[test]
    #[ignore = "a measurement"]
    fn time_of_a_test() {
        use proptest::strategy::ValueTree;
        use proptest::test_runner::TestRunner;
        let mut runner = TestRunner::deterministic();
        let pairs: Vec<_> = (0..4000)
            .map(|_| pair(lattice(11).new_tree(&mut runner).unwrap().current(), 0))
            .collect();
        let tests: [&dyn CompatibilityTest; 2] = [&PlanarPredicate, &LinearProgramTest];
        for test in tests {
            let start = std::time::Instant::now();
            let overlaps = pairs.iter().filter(|(a, b)| !test.compatible(a, b)).count();
            let each = start.elapsed().as_secs_f64() / pairs.len() as f64;
            println!("{}: {:.3} us, {overlaps} overlaps", test.name(), each * 1e6);
        }
    }
}
