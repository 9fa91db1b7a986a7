use super::super::about_first;
use super::*;
use crosscap_core::{Label, LinkKind};
use std::f64::consts::{PI, TAU};

const RADIUS: f64 = 1.0;

/// Half planes about the third axis at the given turns, up to the given heights, in a ball about the origin,
/// which is the first point; moved so that their mean is the origin.
fn pages(all: &[(f64, f64)]) -> Vec<f64> {
    // The last points are close to the end.
    let steps = |count: usize, at: f64| (0..count).map(move |k| (k as f64 + at) / count as f64);
    let page = |&(turn, top): &(f64, f64)| {
        let (s, c) = turn.sin_cos();
        let tall = ((1.0 + top) * 14.0) as usize;
        steps(14, 0.4)
            .flat_map(move |r| steps(tall, 0.9).map(move |z| [r * c, r * s, (1.0 + top) * z - 1.0]))
    };
    let places: Vec<[f64; 3]> = std::iter::once([0.0; 3])
        .chain(all.iter().flat_map(page))
        .filter(|p| p.iter().map(|x| x * x).sum::<f64>() < RADIUS * RADIUS)
        .collect();
    let mean = |k: usize| places.iter().map(|p| p[k]).sum::<f64>() / places.len() as f64;
    let mean = [0, 1, 2].map(mean);
    let shifted = places.iter().map(|p| [0, 1, 2].map(|k| p[k] - mean[k]));
    shifted.flatten().collect()
}

fn decompose(coordinates: &[f64]) -> Result<Decomposition, Rejection> {
    model().decompose(&about_first(coordinates, RADIUS))
}

fn model() -> BookEnd {
    BookEnd::new(0.2, 0.1).unwrap()
}

#[test]
fn ends_of_all_kinds_of_books() {
    let even = |count: usize, tops: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        (0..count)
            .map(|k| (TAU * k as f64 / count as f64, tops(k)))
            .collect()
    };
    let t = |lying: f64| vec![(0.0, lying), (1.5, 0.0), (PI, lying)];
    let shallow = [0.0, 0.6, PI, PI + 0.6].map(|turn| (turn, 0.0)).to_vec();
    let kinds = [
        (even(4, &|_| 0.0), LinkKind::DoubleEnd),
        (shallow, LinkKind::DoubleEnd),
        (
            even(4, &|k| f64::from(k as u8 % 2)),
            LinkKind::RimThroughSheet,
        ),
        (even(3, &|_| 0.0), LinkKind::JunctionEnd),
        (t(0.0), LinkKind::JunctionEnd),
        (t(1.0), LinkKind::SideSheetEnd),
        (even(5, &|_| 0.0), LinkKind::BookEnd),
    ];
    for (book, kind) in kinds {
        let places = pages(&book);
        let fit = decompose(&places).unwrap_or_else(|e| panic!("{book:?}: {e:?}"));
        let off = (0..3)
            .map(|k| (fit.points[0][k] - places[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(off < 0.06, "{book:?}: {off}");
        let link = model().link_of(&fit).unwrap();
        assert_eq!(link.kind(), kind, "{book:?}");
        let degrees = (0..link.nodes() as u8).map(|node| link.degree(node));
        assert_eq!(degrees.max(), Some(book.len()));
        for label in (0..fit.strata.len()).map(Label::new) {
            assert!(fit.labels.contains(&label), "{book:?}: {label}");
        }
    }
}

#[test]
fn what_does_not_end_so_is_none() {
    let crossing = |angle: f64, top: f64| [0.0, angle, PI, PI + angle].map(|turn| (turn, top));
    // Both go on; they meet at too small an angle.
    for book in [&crossing(1.5, 1.0)[..], &crossing(0.2, 0.0)] {
        assert!(decompose(&pages(book)).is_err(), "{book:?}");
    }
}
