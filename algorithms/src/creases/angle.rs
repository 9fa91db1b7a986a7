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
}

impl Meeting {
    /// Where the sheets of two faces meet between two vertices, each of which is on one of them; `None` where points are too few.
    ///
    /// Each sheet is fitted to the points of its own face, from its own side: on a surface that bends they continue each other, up to what
    /// a quadratic leaves of a bend. Points are those of the nearest vertex, and next to a crease some are on the other face: those
    /// farther off than most count less.
    pub(super) fn of(
        ground: &Ground<'_>,
        [v, w]: [u32; 2],
        face: &[Option<u32>],
        walk: &mut Walk,
    ) -> Option<Self> {
        let mut side = |vertex: u32| {
            let own = face[vertex as usize];
            let points = ground.about(vertex, |x| face[x as usize] == own, walk);
            sheet(ground, &points, &mut walk.offset)
        };
        let sheets = [side(v)?, side(w)?];
        let mut place = ground.mean(&[v, w]);
        let start = place.clone();
        for _ in 0..STEPS {
            sheets
                .iter()
                .for_each(|s| s.project(&mut place, &mut walk.offset));
        }
        // Sheets that continue each other meet anywhere.
        let moved = start.iter().zip(&place).map(|(a, b)| (a - b).powi(2));
        if moved.sum::<f64>() > ground.edge.powi(2) {
            place = start;
        }
        let angle = angle(&sheets, &place, &mut walk.offset)?;
        Some(Self { place, angle })
    }
}

/// A sheet through most of the points.
fn sheet(ground: &Ground<'_>, points: &[f64], offset: &mut Vec<f64>) -> Option<SheetFit> {
    let dimension = ground.mesh.vertices.dimension();
    let count = points.len() / dimension;
    let mut weights = vec![1.0; count];
    let mut fit = SheetFit::new(dimension);
    for round in 0..=ROUNDS {
        if !fit.fit(points, &weights) {
            return None;
        }
        if round < ROUNDS {
            let off: Vec<f64> = (points.chunks_exact(dimension))
                .map(|x| fit.distance(x, f64::INFINITY, offset))
                .collect();
            let mut sorted = off.clone();
            let middle = *sorted.select_nth_unstable_by(count / 2, f64::total_cmp).1;
            let far = FAR * middle + EXACT * ground.edge;
            for (weight, off) in weights.iter_mut().zip(&off) {
                let share = off / far;
                *weight = 1.0 / (1.0 + share * share).powi(2);
            }
        }
    }
    Some(fit)
}

/// The angle between two sheets at a place, degrees. The half planes that touch them are at right angles to the direction that
/// the planes have in common, or nearly, and go to where the points of each sheet are.
fn angle(sheets: &[SheetFit; 2], place: &[f64], offset: &mut Vec<f64>) -> Option<f64> {
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
        return Some(if opposite { 180.0 - acute } else { acute });
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
    Some(dot(&one, &other).clamp(-1.0, 1.0).acos().to_degrees())
}
