//! Pages: the half sheets that meet in a curve, read from the points around it.

use crate::tuning::PagesTuning;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

/// Nearest points that a normal is estimated from, the point itself among them.
const NEAREST: usize = 8;
/// Fewest normals.
const LEAST_NORMALS: usize = 12;
/// Rounds of finding the curve, each with less weight for normals that disagree with it.
const ROUNDS: usize = 4;

/// The line in which pages meet, and where they lie about it.
#[derive(Clone, Debug)]
pub(super) struct Pages {
    /// A place on the line.
    pub(super) place: Vector3<f64>,
    /// Unit direction of the line.
    pub(super) along: Vector3<f64>,
    /// Unit directions from the line into the pages, at right angles to it.
    pub(super) out: Vec<Vector3<f64>>,
    /// How they were read.
    pub(super) tuning: PagesTuning,
}

/// A piece of a page: where it is and its unit normal.
struct Element {
    place: Vector3<f64>,
    normal: Vector3<f64>,
    weight: f64,
}

impl Pages {
    /// The pages that points within `radius` of their middle show; `None` where they do not lie about a line.
    ///
    /// Normals of small pieces are all at right angles to the line, and the line goes through all their planes:
    /// two least squares problems, in turn with weights that leave out pieces of which they are not true. About
    /// the line the points then lie in a few directions, with gaps between.
    ///
    /// O(k^2) for k points.
    pub(super) fn read(points: &[Vector3<f64>], radius: f64, tuning: &PagesTuning) -> Option<Self> {
        let mut elements = elements(points, tuning.flat);
        if elements.len() < LEAST_NORMALS {
            return None;
        }
        let mut line = axis(&elements, tuning.across)?;
        for _ in 1..ROUNDS {
            let (place, axes) = line;
            for e in &mut elements {
                let aside = e.normal.dot(&(e.place - place)) / (tuning.aside * radius);
                let tilt = e.normal.dot(&axes[0]) / tuning.tilt;
                e.weight = 1.0 / ((1.0 + aside * aside) * (1.0 + tilt * tilt));
            }
            line = axis(&elements, tuning.across)?;
        }
        let (place, [along, first, second]) = line;
        let out = directions(points, &place, [first, second], radius, tuning)?;
        Some(Self {
            place,
            along,
            out,
            tuning: *tuning,
        })
    }

    /// Pairs of pages that are one sheet, those that are straightest first, each page once.
    pub(super) fn pairs(&self) -> Vec<[usize; 2]> {
        let pairs = self.pairs_within(self.tuning.straight);
        match (pairs.len(), self.out.len()) {
            (0, 3) => self.pairs_within(self.tuning.bent),
            _ => pairs,
        }
    }

    /// Those that are straight up to an angle.
    fn pairs_within(&self, most: f64) -> Vec<[usize; 2]> {
        let mut straight: Vec<(f64, [usize; 2])> = Vec::new();
        for (b, second) in self.out.iter().enumerate() {
            for (a, first) in self.out[..b].iter().enumerate() {
                let bend = PI - first.angle(second);
                if bend < most {
                    straight.push((bend, [a, b]));
                }
            }
        }
        straight.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut used = vec![false; self.out.len()];
        straight.retain(|(_, pair)| {
            let free = pair.iter().all(|&p| !used[p]);
            pair.iter().for_each(|&p| used[p] |= free);
            free
        });
        straight.into_iter().map(|x| x.1).collect()
    }
}

/// Pieces about the points, where they are flat.
fn elements(points: &[Vector3<f64>], flat: f64) -> Vec<Element> {
    let mut out = Vec::with_capacity(points.len());
    for center in points {
        let mut near = [(f64::INFINITY, 0usize); NEAREST];
        for (k, x) in points.iter().enumerate() {
            let square = (x - center).norm_squared();
            if square < near[NEAREST - 1].0 {
                let at = near.partition_point(|n| n.0 <= square);
                near.copy_within(at..NEAREST - 1, at + 1);
                near[at] = (square, k);
            }
        }
        let own = near.iter().filter(|n| n.0.is_finite()).map(|n| points[n.1]);
        out.extend(element(own, flat));
    }
    out
}

/// The plane of a few points; `None` where they lie in none.
fn element(own: impl Iterator<Item = Vector3<f64>> + Clone, flat: f64) -> Option<Element> {
    let count = own.clone().count() as f64;
    let place = own.clone().sum::<Vector3<f64>>() / count;
    let mut spread = Matrix3::zeros();
    for x in own {
        let d = x - place;
        spread += d * d.transpose();
    }
    let (values, axes) = ordered(spread);
    (values[0] <= flat * values[1]).then(|| Element {
        place,
        normal: axes[0],
        weight: 1.0,
    })
}

/// Eigenvalues in rising order, with their unit vectors.
fn ordered(matrix: Matrix3<f64>) -> ([f64; 3], [Vector3<f64>; 3]) {
    let eigen = matrix.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    (
        order.map(|k| eigen.eigenvalues[k]),
        order.map(|k| eigen.eigenvectors.column(k).into()),
    )
}

/// The place and the axes of the line that the planes of all pieces have in common: its direction comes first. `across` is the least
/// mean square of the normals in the second direction.
fn axis(elements: &[Element], across: f64) -> Option<(Vector3<f64>, [Vector3<f64>; 3])> {
    let mut spread = Matrix3::zeros();
    let mut total = 0.0;
    for e in elements {
        spread += e.normal * e.normal.transpose() * e.weight;
        total += e.weight;
    }
    let (values, axes) = ordered(spread / total);
    if values[1] < across {
        return None;
    }
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for e in elements {
        let n = e.normal - axes[0] * axes[0].dot(&e.normal);
        normal += n * n.transpose() * e.weight;
        right += n * (n.dot(&e.place) * e.weight);
    }
    // Along the line nothing is asked for; the place stays at the height of the middle.
    normal += axes[0] * axes[0].transpose() * total;
    Some((normal.try_inverse()? * right, axes))
}

/// Directions about a line in which the points lie.
fn directions(
    points: &[Vector3<f64>],
    place: &Vector3<f64>,
    [first, second]: [Vector3<f64>; 2],
    radius: f64,
    tuning: &PagesTuning,
) -> Option<Vec<Vector3<f64>>> {
    let flat = points.iter().map(|x| {
        let d = x - place;
        [first.dot(&d), second.dot(&d)]
    });
    let mut turns: Vec<f64> = flat
        .filter(|[x, y]| x.hypot(*y) > tuning.near * radius)
        .map(|[x, y]| y.atan2(x))
        .collect();
    turns.sort_by(f64::total_cmp);
    let count = turns.len();
    // Starting behind a gap no page goes over the end.
    let next = |k: usize| turns[(k + 1) % count] + if k + 1 == count { TAU } else { 0.0 };
    let from = (0..count).find(|&k| next(k) - turns[k] > tuning.gap)? + 1;
    turns.rotate_left(from % count);
    let start = turns[0];
    turns
        .iter_mut()
        .for_each(|t| *t = start + (*t - start).rem_euclid(TAU));
    let pages = turns.chunk_by(|a, b| b - a <= tuning.gap);
    let least = tuning.share * count as f64;
    let mut out = Vec::new();
    for page in pages.filter(|page| page.len() as f64 >= least) {
        if page[page.len() - 1] - page[0] > tuning.widest {
            return None;
        }
        let (s, c) = libm::sincos(page[page.len() / 2]);
        out.push(first * c + second * s);
    }
    (out.len() > 2).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half planes about the third axis through a place, in a ball of radius 1 about the origin.
    fn book(turns: &[f64], place: [f64; 2]) -> Vec<Vector3<f64>> {
        let steps = || (0..14).map(|k| (f64::from(k) + 0.37) / 14.0);
        let page = |t: f64| {
            let (s, c) = t.sin_cos();
            steps().flat_map(move |r| {
                steps().map(move |z| {
                    let r = 1.4 * r;
                    Vector3::new(place[0] + r * c, place[1] + r * s, 2.0 * z - 1.0)
                })
            })
        };
        (turns.iter().flat_map(|&t| page(t)))
            .filter(|x| x.norm() < 1.0)
            .collect()
    }

    #[test]
    fn reads_as_many_pages_as_there_are() {
        for count in [3usize, 4, 5, 6, 8] {
            let turns: Vec<f64> = (0..count)
                .map(|k| 0.3 + TAU * k as f64 / count as f64)
                .collect();
            let pages =
                Pages::read(&book(&turns, [0.05, -0.1]), 1.0, &PagesTuning::MEASURED).unwrap();
            assert_eq!(pages.out.len(), count);
            assert!(pages.along.z.abs() > 0.999);
            assert!((pages.place - Vector3::new(0.05, -0.1, pages.place.z)).norm() < 0.02);
            for t in turns {
                let way = Vector3::new(t.cos(), t.sin(), 0.0);
                assert!(
                    pages.out.iter().any(|out| out.angle(&way) < 0.05),
                    "{count} {t}"
                );
            }
            assert_eq!(
                pages.pairs().len(),
                if count % 2 == 0 { count / 2 } else { 0 }
            );
        }
        // One sheet that stands on another.
        let pages = Pages::read(
            &book(&[0.0, 1.6, PI], [0.0; 2]),
            1.0,
            &PagesTuning::MEASURED,
        )
        .unwrap();
        assert_eq!((pages.out.len(), pages.pairs().len()), (3, 1));
    }

    #[test]
    fn one_sheet_and_three_that_cross_in_a_point_have_no_line() {
        let flat = book(&[0.0, PI], [0.0; 2]);
        assert!(Pages::read(&flat, 1.0, &PagesTuning::MEASURED).is_none());
        let turned = |x: &Vector3<f64>| Vector3::new(x.z, x.x, x.y);
        let mut three = flat.clone();
        three.extend(flat.iter().map(turned));
        three.extend(flat.iter().map(|x| turned(&turned(x))));
        assert!(Pages::read(&three, 1.0, &PagesTuning::MEASURED).is_none());
    }
}
