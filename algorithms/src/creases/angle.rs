//! The angle at which two sheets meet.

use super::ground::{Ground, Walk};
use crate::orthogonal::dot;
use crate::prepare::SheetFit;
use nalgebra::Matrix2;

/// Rounds in which points that a sheet does not explain come to count less.
const ROUNDS: usize = 3;
/// Distance from which they do, in middle distances.
const FAR: f64 = 3.0;
/// Distance at which no point counts less, in edges of the mesh: that of points without noise is rounding.
const EXACT: f64 = 1e-6;
/// Rounds of projecting a place onto both sheets in turn.
const STEPS: usize = 24;
/// Sheets at less than this angle meet in no direction that can be told, degrees.
const FLAT: f64 = 15.0;

/// Where two sheets meet.
#[derive(Clone, Debug)]
pub(super) struct Meeting {
    /// A place on both.
    pub(super) place: Vec<f64>,
    /// The angle between them, degrees: 180 where they continue each other.
    pub(super) angle: f64,
    /// By how much both sheets together turn within an edge of the mesh from the place, degrees.
    pub(super) bend: f64,
}

impl Meeting {
    /// Where the sheets of two faces meet between two vertices, each of which is on one of them; `None` where points are too few.
    ///
    /// Each sheet is fitted to the points of its own face, from its own side: on a surface that bends they continue each other, up to what
    /// a quadratic leaves of a bend. Points are those of the nearest vertex, and those of the vertices at a seam are on either face: the
    /// angle is that of the sheets beyond them where there are enough, and of all points those farther off than most count less.
    pub(super) fn of(
        ground: &Ground<'_>,
        [v, w]: [u32; 2],
        face: &[Option<u32>],
        at_seam: &[bool],
        walk: &mut Walk,
    ) -> Option<Self> {
        let own = |vertex: u32| move |x: u32| face[x as usize] == face[vertex as usize];
        let near = [v, w].map(|vertex| ground.about(vertex, own(vertex), walk));
        let beyond = [v, w].map(|vertex| {
            let counts = |x: u32| !at_seam[x as usize];
            ground.about_counting(vertex, own(vertex), counts, walk)
        });
        let start = ground.mean(&[v, w]);
        let offset = &mut walk.offset;
        let few = |points: &Vec<f64>| points.len() < ground.limits.enough * start.len();
        let meeting = Self::of_sheets(ground, &near, &start, offset)?;
        if beyond.iter().any(few) {
            return Some(meeting);
        }
        // A bend of a small radius has flat sheets beyond it: it is told by how the sheets turn next to the place.
        let far = Self::of_sheets(ground, &beyond, &start, offset)?;
        let share = |m: &Self| m.bend / (180.0 - m.angle).max(f64::EPSILON);
        let bend = share(&meeting).max(share(&far)) * (180.0 - far.angle);
        Some(Self { bend, ..far })
    }

    /// Where the sheets through two sets of points meet, beginning at a place between them.
    fn of_sheets(
        ground: &Ground<'_>,
        points: &[Vec<f64>; 2],
        start: &[f64],
        offset: &mut Vec<f64>,
    ) -> Option<Self> {
        let [one, other] = points;
        let sheets = [sheet(ground, one, offset)?, sheet(ground, other, offset)?];
        let mut place = start.to_vec();
        for _ in 0..STEPS {
            sheets.iter().for_each(|s| s.project(&mut place, offset));
        }
        // Sheets that continue each other meet anywhere.
        let moved = start.iter().zip(&place).map(|(a, b)| (a - b).powi(2));
        if moved.sum::<f64>() > ground.edge.powi(2) {
            place = start.to_vec();
        }
        let Wedge { angle, ways } = wedge(&sheets, &place, offset)?;
        let bend = (sheets.iter().zip(ways.iter().flatten()))
            .map(|(sheet, way)| turn(sheet, &place, way, ground.edge, offset))
            .sum();
        Some(Self { place, angle, bend })
    }
}

/// The value in the middle, 0 for none.
fn middle(values: &mut [f64]) -> f64 {
    match values.len() {
        0 => 0.0,
        count => *values.select_nth_unstable_by(count / 2, f64::total_cmp).1,
    }
}

/// A sheet through most of the points.
fn sheet(ground: &Ground<'_>, points: &[f64], offset: &mut Vec<f64>) -> Option<SheetFit> {
    let dimension = ground.mesh.vertices.dimension();
    let count = points.len() / dimension;
    let mut weights = vec![1.0; count];
    let mut fit = SheetFit::new(dimension);
    for _ in 0..=ROUNDS {
        if !fit.fit(points, &weights) {
            return None;
        }
        let off: Vec<f64> = (points.chunks_exact(dimension))
            .map(|x| fit.distance(x, f64::INFINITY, offset))
            .collect();
        let far = FAR * middle(&mut off.clone()) + EXACT * ground.edge;
        for (weight, off) in weights.iter_mut().zip(&off) {
            let share = off / far;
            *weight = 1.0 / (1.0 + share * share).powi(2);
        }
    }
    Some(fit)
}

/// By how much a sheet turns on the way from a place, degrees: a bend of a small radius turns as much beside the place as there.
fn turn(sheet: &SheetFit, place: &[f64], way: &[f64], length: f64, offset: &mut Vec<f64>) -> f64 {
    let mut there: Vec<f64> = place.iter().zip(way).map(|(p, w)| p + length * w).collect();
    sheet.project(&mut there, offset);
    let [one, other] = sheet.touching(&there, offset);
    let kept = dot(&one, way).hypot(dot(&other, way));
    kept.clamp(0.0, 1.0).acos().to_degrees()
}

/// Two sheets where they meet.
struct Wedge {
    /// The angle between them, degrees.
    angle: f64,
    /// Unit directions from the place into each; none where they continue each other.
    ways: Option<[Vec<f64>; 2]>,
}

/// The angle between two sheets at a place. The half planes that touch them are at right angles to the direction that
/// the planes have in common, or nearly, and go to where the points of each sheet are.
fn wedge(sheets: &[SheetFit; 2], place: &[f64], offset: &mut Vec<f64>) -> Option<Wedge> {
    let planes = sheets.each_ref().map(|s| s.touching(place, offset));
    let between = Matrix2::from_fn(|i, j| dot(&planes[0][i], &planes[1][j]));
    let parts = between.svd(true, true);
    let (first, second) = (parts.u?, parts.v_t?);
    let least = usize::from(parts.singular_values[1] < parts.singular_values[0]);
    let acute = parts.singular_values[least]
        .clamp(0.0, 1.0)
        .acos()
        .to_degrees();
    let away = sheets
        .each_ref()
        .map(|sheet| -> Vec<f64> { sheet.mean().iter().zip(place).map(|(m, p)| m - p).collect() });
    if acute < FLAT {
        let opposite = dot(&away[0], &away[1]) < 0.0;
        let angle = if opposite { 180.0 - acute } else { acute };
        return Some(Wedge { angle, ways: None });
    }
    let turned = |plane: &[Vec<f64>; 2], by: [f64; 2], away: &[f64]| -> Vec<f64> {
        let out: Vec<f64> = (plane[0].iter().zip(&plane[1]))
            .map(|(a, b)| by[0] * a + by[1] * b)
            .collect();
        let sign = dot(&out, away).signum();
        out.iter().map(|x| sign * x).collect()
    };
    let one = turned(&planes[0], [first[(0, least)], first[(1, least)]], &away[0]);
    let other = turned(
        &planes[1],
        [second[(least, 0)], second[(least, 1)]],
        &away[1],
    );
    Some(Wedge {
        angle: dot(&one, &other).clamp(-1.0, 1.0).acos().to_degrees(),
        ways: Some([one, other]),
    })
}
