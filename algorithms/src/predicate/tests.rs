use super::*;
use crosscap_core::Landmark;
use proptest::prelude::*;

fn triangle(corners: [u32; 3], places: [[f64; 2]; 3]) -> ChartTriangle {
    ChartTriangle {
        corners: corners.map(Landmark::from),
        places,
    }
}

fn both_ways(a: &ChartTriangle, b: &ChartTriangle) -> Meeting {
    let meeting = PlanarPredicate.meeting(a, b);
    assert_eq!(meeting, PlanarPredicate.meeting(b, a), "{a:?} {b:?}");
    meeting
}

/// A lattice triangle; a landmark is named by its place, so equal places are shared corners.
fn lattice(p: [[i32; 2]; 3]) -> ChartTriangle {
    triangle(
        p.map(|[x, y]| (100 * (x + 50) + y + 50) as u32),
        p.map(|p| p.map(f64::from)),
    )
}

type Rational = (i128, i128);

/// Reference in integers: all points in which the sides of the two meet, and corners of one in
/// the other, generate the intersection; it is compared with the hull of the shared corners.
fn reference(a: [[i32; 2]; 3], b: [[i32; 2]; 3]) -> Meeting {
    let area = |p: [i128; 2], q: [i128; 2], r: [i128; 2]| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let ccw = |t: [[i32; 2]; 3]| {
        let t = t.map(|p| p.map(i128::from));
        if area(t[0], t[1], t[2]) < 0 {
            [t[0], t[2], t[1]]
        } else {
            t
        }
    };
    let (a, b) = (ccw(a), ccw(b));
    // Points are homogeneous (x, y, w), w > 0.
    let inside = |t: [[i128; 2]; 3], (x, y, w): (i128, i128, i128)| {
        (0..3).all(|i| {
            let (p, q) = (t[i], t[(i + 1) % 3]);
            (q[0] - p[0]) * (y - p[1] * w) - (q[1] - p[1]) * (x - p[0] * w) >= 0
        })
    };
    let mut common = vec![];
    for (s, t) in [(a, b), (b, a)] {
        common.extend(s.iter().map(|p| (p[0], p[1], 1)).filter(|&p| inside(t, p)));
    }
    for i in 0..3 {
        for j in 0..3 {
            let (p, q, r, s) = (a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
            let (d, e) = ([q[0] - p[0], q[1] - p[1]], [s[0] - r[0], s[1] - r[1]]);
            let mut w = d[0] * e[1] - d[1] * e[0];
            if w == 0 {
                continue;
            }
            let mut n = (r[0] - p[0]) * e[1] - (r[1] - p[1]) * e[0];
            if w < 0 {
                (w, n) = (-w, -n);
            }
            let point = (p[0] * w + d[0] * n, p[1] * w + d[1] * n, w);
            if inside(a, point) && inside(b, point) {
                common.push(point);
            }
        }
    }
    let shared: Vec<_> = a.iter().filter(|p| b.contains(p)).collect();
    let in_hull = |&(x, y, w): &(i128, i128, i128)| match shared[..] {
        [] => false,
        [p] => (x, y) == (p[0] * w, p[1] * w),
        [p, q] => {
            let on = (q[0] - p[0]) * (y - p[1] * w) == (q[1] - p[1]) * (x - p[0] * w);
            let between = |k: usize, c: i128| {
                let range: Rational = (p[k].min(q[k]), p[k].max(q[k]));
                range.0 * w <= c && c <= range.1 * w
            };
            on && between(0, x) && between(1, y)
        }
        _ => true,
    };
    if common.is_empty() {
        Meeting::Disjoint
    } else if common.iter().all(in_hull) {
        Meeting::CommonFace
    } else {
        Meeting::Overlap
    }
}

fn flat(t: [[i32; 2]; 3]) -> bool {
    let [p, q, r] = t;
    (q[0] - p[0]) * (r[1] - p[1]) == (q[1] - p[1]) * (r[0] - p[0])
}

fn corner(most: i32) -> impl Strategy<Value = [i32; 2]> {
    [0..=most, 0..=most]
}

fn pair() -> impl Strategy<Value = ([[i32; 2]; 3], [[i32; 2]; 3])> {
    prop_oneof![Just(2), Just(4), Just(9)].prop_flat_map(|m| {
        (
            [corner(m), corner(m), corner(m)],
            [corner(m), corner(m), corner(m)],
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, max_global_rejects: 8000, ..ProptestConfig::default() })]

    #[test]
    fn agrees_with_integer_arithmetic((a, b) in pair()) {
        if !flat(a) && !flat(b) {
            prop_assert_eq!(both_ways(&lattice(a), &lattice(b)), reference(a, b));
        }
    }

    #[test]
    fn does_not_depend_on_scale_place_or_order(
        (a, b) in pair(),
        exponent in -300_i32..300,
        shift in [-1000_i32..1000, -1000_i32..1000],
        turn in 0_usize..3,
        mirror in any::<bool>(),
    ) {
        let meeting = both_ways(&lattice(a), &lattice(b));
        let moved = |t: [[i32; 2]; 3]| {
            let mut t = lattice(t);
            let scale = f64::from(exponent).exp2();
            for p in &mut t.places {
                *p = [0, 1].map(|k| (p[k] + f64::from(shift[k])) * scale);
                if mirror {
                    p.swap(0, 1);
                }
            }
            t.corners.rotate_left(turn);
            t.places.rotate_left(turn);
            t
        };
        prop_assert_eq!(both_ways(&moved(a), &moved(b)), meeting);
        prop_assert_eq!(both_ways(&lattice(a), &lattice(b)), meeting);
    }

    #[test]
    fn flat_triangles_touch_or_do_not(
        (mut a, b) in pair(),
        at in 0_usize..3,
    ) {
        // A flat triangle is the segment of its outermost corners.
        a[at] = a[(at + 1) % 3];
        let (p, q) = (a[(at + 1) % 3], a[(at + 2) % 3]);
        let same = {
            let set = |t: [[i32; 2]; 3]| { let mut t = t.to_vec(); t.sort(); t.dedup(); t };
            set(a) == set(b)
        };
        prop_assume!(!flat(b) && !same);
        let side = |r: [i32; 2], s: [i32; 2], x: [i32; 2]| {
            ((s[0] - r[0]) * (x[1] - r[1]) - (s[1] - r[1]) * (x[0] - r[0])).signum()
        };
        let orientation = side(b[0], b[1], b[2]);
        let inside = |x| (0..3).all(|i| side(b[i], b[(i + 1) % 3], x) * orientation >= 0);
        let on = |r: [i32; 2], s: [i32; 2], x: [i32; 2]| {
            side(r, s, x) == 0 && (0..2).all(|k| r[k].min(s[k]) <= x[k] && x[k] <= r[k].max(s[k]))
        };
        let cross = |r, s| {
            side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0
                || on(p, q, r) || on(p, q, s) || on(r, s, p) || on(r, s, q)
        };
        let touches = inside(p) || inside(q) || (0..3).any(|i| cross(b[i], b[(i + 1) % 3]));
        let expected = if touches { Meeting::Overlap } else { Meeting::Disjoint };
        prop_assert_eq!(both_ways(&lattice(a), &lattice(b)), expected);
    }

    #[test]
    fn one_unit_in_the_last_place_decides(
        x in 0.1_f64..0.9, slope in -3.0_f64..3.0, exponent in -9_i32..9,
    ) {
        // A corner on the common side, or next to it by the smallest possible step.
        let s = 10_f64.powi(exponent);
        let (p, q) = ([0.0, 0.0], [s, slope * s]);
        let below = triangle([0, 1, 2], [p, q, [0.5 * s, -9.0 * s]]);
        let on = [x * s, slope * x * s];
        for (end, y) in [(0, on[1]), (1, on[1].next_up()), (2, on[1].next_down())] {
            let above = triangle([3, 4, 5], [[on[0], y], [0.2 * s, 9.0 * s], [0.8 * s, 9.0 * s]]);
            let exact = turn(p, q, [on[0], y]);
            let expected = if exact > 0.0 { Meeting::Disjoint } else { Meeting::Overlap };
            prop_assert_eq!(both_ways(&below, &above), expected, "{}", end);
        }
    }
}

#[test]
fn named_cases() {
    let base = lattice([[0, 0], [4, 0], [0, 4]]);
    let cases = [
        ([[5, 5], [6, 5], [5, 6]], Meeting::Disjoint),
        ([[4, 0], [0, 4], [4, 4]], Meeting::CommonFace),
        ([[4, 0], [8, 0], [8, 1]], Meeting::CommonFace),
        ([[0, 4], [4, 0], [0, 0]], Meeting::CommonFace),
        ([[1, 1], [2, 1], [1, 2]], Meeting::Overlap),
        ([[2, 2], [4, 4], [4, 3]], Meeting::Overlap), // corner on a side
        ([[4, 0], [0, 4], [1, 0]], Meeting::Overlap), // same side of the shared side
        ([[4, 0], [2, 2], [4, 4]], Meeting::Overlap), // shared corner and a T-junction
        ([[0, 0], [3, 3], [4, 4]], Meeting::Overlap), // flat, shares a corner
        ([[-1, 5], [5, -1], [6, 6]], Meeting::Overlap), // sides overlap in a stretch
    ];
    for (t, expected) in cases {
        assert_eq!(both_ways(&base, &lattice(t)), expected, "{t:?}");
    }
    // A copy with other landmarks is an overlap, not a common face.
    let copy = triangle([7, 8, 9], base.places);
    assert_eq!(both_ways(&base, &copy), Meeting::Overlap);
}

#[test]
fn contradictions_are_overlaps() {
    let a = triangle([0, 1, 2], [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let far = [[5.0, 5.0], [6.0, 5.0], [5.0, 6.0]];
    assert_eq!(both_ways(&a, &triangle([2, 3, 4], far)), Meeting::Overlap);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut places = far;
        places[1][1] = bad;
        assert_eq!(
            both_ways(&a, &triangle([3, 4, 5], places)),
            Meeting::Overlap
        );
    }
}
