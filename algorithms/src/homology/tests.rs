use super::shapes::*;
use super::*;
use num_traits::{One, ToPrimitive};
use proptest::prelude::*;

/// Homology with the cross-checks that hold for every complex.
fn checked(complex: &Complex) -> Homology {
    let h = homology(complex).unwrap();
    let [b0, b1, b2] = h.betti_rational.map(|b| b as i64);
    assert_eq!(b0 - b1 + b2, complex.euler_characteristic());
    assert_eq!(h.euler, complex.euler_characteristic());
    assert!(h.torsion.iter().all(|x| !x.is_one()));
    assert!(h.torsion.windows(2).all(|w| (&w[1] % &w[0]).is_zero()));
    assert_eq!(h.betti_mod2, h.betti_mod(2).unwrap());
    for p in [2, 3, 5, 7, 18_446_744_073_709_551_557] {
        let direct = betti_by_elimination(complex, p).unwrap();
        assert_eq!(h.betti_mod(p).unwrap(), direct, "modulo {p}");
    }
    h
}

fn known(complex: &Complex, betti: [usize; 3], torsion: &[u64]) {
    let h = checked(complex);
    assert_eq!(h.betti_rational, betti);
    let found: Vec<u64> = h.torsion.iter().map(|x| x.to_u64().unwrap()).collect();
    assert_eq!(found, torsion);
}

fn sphere() -> Complex {
    discs_along_a_circle(2)
}

#[test]
fn closed_surfaces() {
    known(&sphere(), [1, 0, 1], &[]);
    known(&glued_rectangle(4, 5, false), [1, 2, 1], &[]);
    known(&glued_rectangle(5, 4, true), [1, 1, 0], &[2]);
    known(&presentation(1, &[vec![1, 1]]), [1, 0, 0], &[2]);
    // Genus 2, and three crosscaps.
    known(
        &presentation(4, &[vec![1, 2, -1, -2, 3, 4, -3, -4]]),
        [1, 4, 1],
        &[],
    );
    known(&presentation(3, &[vec![1, 1, 2, 2, 3, 3]]), [1, 2, 0], &[2]);
}

#[test]
fn surfaces_with_boundary() {
    known(&strip(5, true), [1, 1, 0], &[]);
    known(&strip(5, false), [1, 1, 0], &[]);
    known(&discs_along_a_circle(1), [1, 0, 0], &[]);
}

#[test]
fn non_manifold_complexes() {
    known(
        &wedge(&sphere(), &glued_rectangle(4, 4, false)),
        [1, 2, 2],
        &[],
    );
    known(&discs_along_a_circle(3), [1, 0, 2], &[]);
    known(&discs_along_a_circle(4), [1, 0, 3], &[]);
    known(&discs_along_a_circle(9), [1, 0, 8], &[]);
    known(&three_spheres(), [1, 0, 7], &[]);
    known(&sphere_and_klein_bottle(), [1, 1, 2], &[]);
    // The dunce hat is contractible, and has no free edge to start from.
    known(&presentation(1, &[vec![1, 1, -1]]), [1, 0, 0], &[]);
}

#[test]
fn torsion_of_moore_spaces() {
    for n in 1..=12usize {
        let expected: &[u64] = if n == 1 { &[] } else { &[n as u64] };
        known(&presentation(1, &[vec![1; n]]), [1, 0, 0], expected);
    }
    // Two discs: Z/gcd, and one cycle.
    known(&presentation(1, &[vec![1; 4], vec![1; 6]]), [1, 0, 1], &[2]);
    // Z/4 + Z/6 = Z/2 + Z/12; a third generator is free.
    let two = presentation(3, &[vec![1; 4], vec![2; 6]]);
    known(&two, [1, 1, 0], &[2, 12]);
    let both = disjoint_union(&two, &presentation(1, &[vec![1; 9]]));
    known(&both, [2, 1, 0], &[6, 36]);
    assert_eq!(checked(&both).betti_mod(3).unwrap(), [2, 3, 2]);
}

#[test]
fn large_torsion_stays_exact() {
    // Relations 3 x_i = x_{i+1} and 3 x_k = 0 give Z/3^k; beyond k = 39 the entries leave i64
    // on the way.
    for k in [39, 40, 60] {
        let mut words: Vec<Vec<i32>> = (1..k).map(|i| vec![i, i, i, -(i + 1)]).collect();
        words.push(vec![k; 3]);
        let h = checked(&presentation(k as usize, &words));
        assert_eq!(h.torsion, vec![BigUint::from(3u32).pow(k as u32)]);
        assert_eq!(h.betti_rational, [1, 0, 0]);
    }
}

#[test]
fn vertices_and_bare_edges() {
    known(&Complex::default(), [0, 0, 0], &[]);
    known(&Complex::new(5, vec![], vec![]).unwrap(), [5, 0, 0], &[]);
    known(
        &disjoint_union(&sphere(), &Complex::new(3, vec![], vec![]).unwrap()),
        [4, 0, 1],
        &[],
    );
    // No relation: a bouquet of circles of edges without a triangle.
    known(&presentation(2, &[]), [1, 2, 0], &[]);
    let mut handle = sphere();
    // A rim vertex and the center of a disc.
    let [a, b] = [0, 6];
    assert!(handle.edges().binary_search(&[a, b]).is_err());
    handle.curve_edges = vec![crosscap_core::CurveEdge::new(a, b, 0)];
    known(&handle, [1, 1, 1], &[]);
}

#[test]
fn refuses_composite_characteristic_and_broken_complexes() {
    let h = homology(&sphere()).unwrap();
    for p in [0, 1, 4, 9, u64::MAX] {
        assert_eq!(h.betti_mod(p), Err(NotPrime(p)));
        assert!(betti_by_elimination(&sphere(), p).is_err());
    }
    let mut broken = sphere();
    broken.triangles[2] = [0, 1, 99];
    assert!(homology(&broken).is_err());
    assert!(betti_by_elimination(&broken, 2).is_err());
}

#[test]
fn serializes_torsion_as_decimals() {
    let h = homology(&presentation(1, &[vec![1; 6]])).unwrap();
    let tokens = serde_json::to_string(&h).unwrap();
    assert!(tokens.contains(r#""torsion":["6"]"#), "{tokens}");
}

/// d2 as a dense matrix, brought into Smith normal form the textbook way.
fn naive_torsion(complex: &Complex) -> Vec<i128> {
    let edges = complex.edges();
    let mut a = vec![vec![0i128; complex.triangles.len()]; edges.len()];
    for (t, &[x, y, z]) in complex.triangles.iter().enumerate() {
        for (ends, sign) in [([y, z], 1), ([x, z], -1), ([x, y], 1)] {
            a[edges.binary_search(&ends).unwrap()][t] = sign;
        }
    }
    let (m, n) = (a.len(), complex.triangles.len());
    let mut torsion = Vec::new();
    let mut k = 0;
    while k < m.min(n) {
        let Some((i, j)) = (k..m)
            .flat_map(|i| (k..n).map(move |j| (i, j)))
            .filter(|&(i, j)| a[i][j] != 0)
            .min_by_key(|&(i, j)| a[i][j].abs())
        else {
            break;
        };
        a.swap(k, i);
        a.iter_mut().for_each(|row| row.swap(k, j));
        let pivot = a[k][k];
        for i in k + 1..m {
            let q = a[i][k] / pivot;
            let row = a[k].clone();
            a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= q * y);
        }
        for j in k + 1..n {
            let q = a[k][j] / pivot;
            for row in &mut a[k..] {
                row[j] -= q * row[k];
            }
        }
        let clear = (k + 1..m).all(|i| a[i][k] == 0) && (k + 1..n).all(|j| a[k][j] == 0);
        if !clear {
            continue;
        }
        if let Some(i) = (k + 1..m).find(|&i| a[i][k..].iter().any(|x| x % pivot != 0)) {
            let row = a[i].clone();
            a[k].iter_mut().zip(&row).for_each(|(x, y)| *x += y);
            continue;
        }
        if pivot.abs() > 1 {
            torsion.push(pivot.abs());
        }
        k += 1;
    }
    torsion
}

/// Any complex on seven vertices: each triangle is there or not, so are bare edges.
fn any_complex() -> impl Strategy<Value = Complex> {
    (0.1..0.9f64).prop_flat_map(|density| {
        let triangles = prop::collection::vec(prop::bool::weighted(density), 35);
        let edges = prop::collection::vec(prop::bool::weighted(0.2), 21);
        (triangles, edges).prop_map(|(triangles, edges)| {
            let all_triangles = (0..7u32)
                .flat_map(|a| (a + 1..7).flat_map(move |b| (b + 1..7).map(move |c| [a, b, c])));
            let all_edges = (0..7u32).flat_map(|a| (a + 1..7).map(move |b| [a, b]));
            let kept = all_triangles.zip(triangles).filter(|x| x.1).map(|x| x.0);
            let curve = all_edges.zip(edges).filter(|x| x.1);
            let curve = curve.map(|([a, b], _)| crosscap_core::CurveEdge::new(a, b, 0));
            Complex::new(7, kept.collect(), curve.collect()).unwrap()
        })
    })
}

/// Presentations with two generators, rich in torsion.
fn any_presentation() -> impl Strategy<Value = Complex> {
    let letter = prop_oneof![Just(1), Just(-1), Just(2), Just(-2)];
    let letter = prop_oneof![3 => Just(1), 2 => Just(2), 2 => letter];
    let word = prop::collection::vec(letter, 1..7);
    prop::collection::vec(word, 0..4).prop_map(|words| presentation(2, &words))
}

fn any() -> impl Strategy<Value = Complex> {
    prop_oneof![
        any_complex(),
        any_presentation(),
        (any_complex(), any_presentation()).prop_map(|(a, b)| wedge(&a, &b)),
    ]
}

/// Two or three surfaces of tens of vertices, some vertices of which are made one at random: edges with
/// three, four and more triangles, pinched vertices, curves shared by several surfaces; with bare
/// edges and isolated vertices on top.
fn any_identified() -> impl Strategy<Value = Complex> {
    let surface = (3usize..6, 3usize..6, 0..5u8).prop_map(|(m, n, kind)| match kind {
        0 => glued_rectangle(m, n, false),
        1 => glued_rectangle(m, n, true),
        2 => strip(m as u32, true),
        3 => presentation(1, &[vec![1; m - 1]]),
        _ => discs_along_a_circle(n - 2),
    });
    let index = proptest::arbitrary::any::<prop::sample::Index>;
    let pairs = prop::collection::vec((index(), index()), 0..14);
    let bare = prop::collection::vec((index(), index()), 0..5);
    let parts = prop::collection::vec(surface, 1..4);
    (parts, pairs, bare, 0usize..3).prop_map(|(parts, pairs, bare, isolated)| {
        let all = parts.iter().skip(1);
        let all = all.fold(parts[0].clone(), |all, part| disjoint_union(&all, part));
        let count = all.vertices;
        let mut names: Vec<u32> = (0..count as u32).collect();
        for (a, b) in pairs {
            let (kept, lost) = (names[a.index(count)], names[b.index(count)]);
            names
                .iter_mut()
                .filter(|n| **n == lost)
                .for_each(|n| *n = kept);
        }
        let named = |t: &[u32; 3]| {
            let mut t = t.map(|v| names[v as usize]);
            t.sort_unstable();
            t
        };
        let mut triangles: Vec<[u32; 3]> = all.triangles.iter().map(named).collect();
        triangles.retain(|t| t[0] < t[1] && t[1] < t[2]);
        triangles.sort_unstable();
        triangles.dedup();
        let ends = bare
            .iter()
            .map(|(a, b)| [a.index(count) as u32, b.index(count) as u32]);
        let mut curve: Vec<_> = ends
            .filter(|[a, b]| a != b)
            .map(|[a, b]| crosscap_core::CurveEdge::new(a, b, 0))
            .collect();
        curve.sort_unstable();
        curve.dedup();
        Complex::new(count + isolated, triangles, curve).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn identified_surfaces_agree_with_plain_elimination(complex in any_identified()) {
        checked(&complex);
        let found = homology(&complex).unwrap().torsion;
        let found: Vec<i128> = found.iter().map(|x| x.to_i128().unwrap()).collect();
        prop_assert_eq!(found, naive_torsion(&complex));
    }

    #[test]
    fn euler_poincare_and_universal_coefficients(complex in any()) {
        checked(&complex);
    }

    #[test]
    fn torsion_agrees_with_the_textbook(complex in any()) {
        let found = homology(&complex).unwrap().torsion;
        let found: Vec<i128> = found.iter().map(|x| x.to_i128().unwrap()).collect();
        prop_assert_eq!(found, naive_torsion(&complex));
    }

    #[test]
    fn subdivision_changes_nothing(complex in any()) {
        let (h, fine) = (homology(&complex).unwrap(), homology(&subdivided(&complex)).unwrap());
        prop_assert_eq!(h, fine);
    }

    #[test]
    fn names_change_nothing(
        (complex, order) in any().prop_flat_map(|c| {
            let names = Just((0..c.vertices as u32).collect::<Vec<_>>()).prop_shuffle();
            (Just(c), names)
        })
    ) {
        let other = relabelled(&complex, complex.vertices, |v| order[v as usize]);
        prop_assert_eq!(homology(&complex).unwrap(), homology(&other).unwrap());
    }

    #[test]
    fn boundary_of_boundary_is_zero(complex in any()) {
        let sides = Sides::new(&complex).unwrap();
        let mut sums = std::collections::BTreeMap::new();
        for (e, &[a, b]) in sides.edges.iter().enumerate() {
            for &side in sides.at(e) {
                let sign = if runs_backward(side) { -1 } else { 1 };
                *sums.entry((side / 3, b)).or_insert(0) += sign;
                *sums.entry((side / 3, a)).or_insert(0) -= sign;
            }
        }
        prop_assert_eq!(sums.len(), 3 * complex.triangles.len());
        prop_assert!(sums.values().all(|&sum| sum == 0));
    }
}

/// Run by hand, for the time: a torus of a million vertices, names scattered.
#[test]
#[ignore = "a measurement of time and no check"]
fn a_million_vertices() {
    let torus = glued_rectangle(1000, 1000, false);
    let scattered = relabelled(&torus, torus.vertices, |v| {
        (u64::from(v) * 617_003 % 1_000_000) as u32
    });
    for complex in [&torus, &scattered] {
        let start = std::time::Instant::now();
        assert_eq!(homology(complex).unwrap().betti_rational, [1, 2, 1]);
        println!("{:?}", start.elapsed());
    }
}
