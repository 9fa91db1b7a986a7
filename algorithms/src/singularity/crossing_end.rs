//! A double curve that ends where the boundaries of its two sheets cross.

use super::curve_end::{self, CurveEnd, REACH};
use super::flats::Flat;
use super::patch::PATCH_POINTS;
use super::rim::Rim;
use super::sheets::Sheets;
use super::tolerance::{Tolerance, at_least, vectors};
use super::two_planes::PlanePair;
use crosscap_core::{
    Decomposition, Error, Link, LinkKind, LocalPoints, Located, Rejection, SingularityModel,
};
use nalgebra::Vector3;

/// Two sheets that cross, and end: a double curve that ends where their boundaries cross.
///
/// The sheets are the quadratic patches of [`TwoPlanes`](super::TwoPlanes). Each is laid out in its tangent plane
/// at the curve, and its boundary is the lowest parabola that has all points of the sheet on one side, as
/// [`Boundary`](super::Boundary) finds it. The curve ends where it meets both; a curve that meets them in two
/// different points ends on one sheet, inside the other, and is none of these.
#[derive(Clone, Copy, Debug)]
pub struct CrossingEnd {
    tolerance: Tolerance,
}

/// Least share of the points that each of the four cells holds.
const LEAST_CELL_SHARE: f64 = 0.03;
/// Least sine of the angle of the sheets where they end, 20 degrees: at a pinch point it goes to zero.
const LEAST_SINE: f64 = 0.34;
/// Least cosine of the angle of the double curve and the way out of a sheet.
const LEAST_CROSSING: f64 = 0.5;
/// The curve meets the two boundaries at most so many ep apart: each runs inside the true one by as much as
/// the points are apart, about 1.5 ep at 150 points in a neighborhood.
const MOST_APART: f64 = 3.0;
/// Farthest that the center is from the double curve, as a share of the radius.
const LARGEST_STEP: f64 = 0.6;

/// Labels: the point, the double curve, the boundary of each cell, then the cells.
const POINT: u8 = 0;
const DOUBLE: u8 = 1;
const FIRST_RIM: u8 = 2;
const FIRST_CELL: u8 = 6;

impl CrossingEnd {
    /// Model with fit tolerance `dp` and curve tolerance `ep`, unit of the data: a point nearer than
    /// `ep` to both sheets is on the double curve, nearer than that to the end of its sheet on the boundary.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
        })
    }

    /// The sheets and their boundaries.
    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(2 * PATCH_POINTS, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let points = &all[..local.fitted];
        let center = all[local.center];
        let sheets = two_sheets(&all, local.fitted, local.radius, &center)?;
        let residual = self.follow(&sheets, points, local.radius)?;
        let meet = |x: Vector3<f64>| sheets.meet(&[0, 1], 2, x, LARGEST_STEP * local.radius);
        let near = meet(center).ok_or(Rejection::NoRealSolution)?;
        let rims = [0, 1].map(|k| {
            let own = points.iter().zip(&sheets.owner);
            let own = own.filter(|x| usize::from(*x.1) == k).map(|x| *x.0);
            let way = curve_direction(&sheets, &near)?;
            // The mean of the points is the origin.
            let out = if way.dot(&near) < 0.0 { -way } else { way };
            Rim::of(&sheets.patches[k], own.collect(), near, out, local.radius)
        });
        let [first, second] = rims;
        let rims = [first?, second?];
        let out = rims.each_ref().map(|rim| rim.crossing(LEAST_CROSSING));
        let [Some(one), Some(other)] = out else {
            return Err(Rejection::NoRealSolution);
        };
        if (one - other).norm() > MOST_APART * self.tolerance.ep {
            return Err(Rejection::NoRealSolution);
        }
        let end = meet((one + other) / 2.0).ok_or(Rejection::NoRealSolution)?;
        let sine = sheets.sine(&end);
        if (end - center).norm() > REACH * local.radius || sine < LEAST_SINE {
            return Err(Rejection::NoRealSolution);
        }
        let fit = Fit {
            all,
            sheets,
            rims,
            end,
            residual,
            ep: self.tolerance.ep,
            radius: local.radius,
        };
        fit.has_four_cells(local.fitted)?;
        Ok(fit)
    }

    /// The residual of two sheets that the points follow, better than one.
    fn follow(
        &self,
        sheets: &Sheets,
        points: &[Vector3<f64>],
        radius: f64,
    ) -> Result<f64, Rejection> {
        let off = |x: &Vector3<f64>| {
            let [a, b] = [0, 1].map(|k| sheets.patches[k].signed_distance(x).abs());
            a.min(b)
        };
        let sum = points.iter().map(|x| off(x).powi(2)).sum();
        let residual = self.tolerance.residual(sum, points.len())?;
        curve_end::gains(residual, points, radius)?;
        curve_end::follows(points.iter().map(off), residual, self.tolerance.ep)?;
        Ok(residual)
    }
}

/// Quadratic patches from the two-plane quadric.
fn two_sheets(
    all: &[Vector3<f64>],
    fitted: usize,
    radius: f64,
    center: &Vector3<f64>,
) -> Result<Sheets, Rejection> {
    let pair = PlanePair::direct(all[..fitted].iter().copied(), radius)?;
    let (_, origin) = pair.line(center).ok_or(Rejection::NoRealSolution)?;
    let planes = pair.normals.map(|normal| Flat {
        origin,
        normals: vec![normal],
    });
    Ok(Sheets::new(&planes, all, fitted, radius, |_, d, _| d))
}

/// Unit direction of the curve in which two sheets meet.
fn curve_direction(sheets: &Sheets, place: &Vector3<f64>) -> Result<Vector3<f64>, Rejection> {
    let [a, b] = [0, 1].map(|k| sheets.patches[k].height(place).1);
    (a.cross(&b).try_normalize(1e-9)).ok_or(Rejection::NoRealSolution)
}

/// A neighborhood with its sheets.
struct Fit {
    all: Vec<Vector3<f64>>,
    sheets: Sheets,
    /// The boundary of each sheet.
    rims: [Rim; 2],
    /// Where the double curve ends.
    end: Vector3<f64>,
    residual: f64,
    ep: f64,
    radius: f64,
}

impl Fit {
    /// Which of the four cells a row is in.
    fn cell(&self, row: usize) -> u8 {
        let own = self.sheets.owner[row];
        let other = &self.sheets.patches[usize::from(1 - own)];
        2 * own + u8::from(other.signed_distance(&self.all[row]) >= 0.0)
    }

    /// Refuses a crossing of which a cell is missing.
    fn has_four_cells(&self, fitted: usize) -> Result<(), Rejection> {
        let mut held = [0usize; 4];
        for row in 0..fitted {
            held[usize::from(self.cell(row))] += 1;
        }
        let least = LEAST_CELL_SHARE * fitted as f64;
        match held.iter().position(|&h| (h as f64) < least) {
            Some(cell) => Err(Rejection::EmptyStratum {
                stratum: usize::from(FIRST_CELL) + cell,
                found: held[cell],
            }),
            None => Ok(()),
        }
    }
}

impl CurveEnd for Fit {
    const STRATA: &'static [u8] = &[0, 1, 1, 1, 1, 1, 2, 2, 2, 2];
    const CELLS: &'static [u8] = &[4, 1, 1, 1, 1];
    // Two patches and the parabolas at their ends.
    const PARAMETERS: usize = 2 * 6 + 2 * 3;

    fn points(&self) -> &[Vector3<f64>] {
        &self.all
    }

    fn end(&self) -> Vector3<f64> {
        self.end
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn ep(&self) -> f64 {
        self.ep
    }

    fn locate(&self, row: usize) -> (u8, Vector3<f64>, u8) {
        let x = self.all[row];
        let own = usize::from(self.sheets.owner[row]);
        let rim = &self.rims[own];
        let inside = rim.depth(&x);
        let on_rim = rim.place(&self.sheets.patches[own], &x);
        let double = (self.sheets).meet(&[0, 1], 2, x, LARGEST_STEP * self.radius);
        let near_both = (0..2).all(|k| self.sheets.patches[k].signed_distance(&x).abs() < self.ep);
        let cell = self.cell(row);
        match (double, near_both, inside < self.ep) {
            (Some(_), true, true) => (POINT, self.end, 0),
            (Some(place), true, false) => (DOUBLE, place, 4),
            (_, _, true) => (FIRST_RIM + cell, on_rim, 1),
            (Some(place), _, _) if (place - x).norm() < inside => (FIRST_CELL + cell, place, 4),
            _ => (FIRST_CELL + cell, on_rim, 1),
        }
    }
}

impl SingularityModel for CrossingEnd {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, _dimension: usize) -> bool {
        false
    }

    fn explains_ends(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::DoubleEnd.link()
    }

    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        Ok(self.decompose_about(local, &[])?.0)
    }

    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        Ok(self.fit(local)?.decomposition(local, rows))
    }

    fn name(&self) -> &str {
        "crossing-end"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::Label;

    const RADIUS: f64 = 1.0;

    /// A grid on two sheets z = +-slope x, which end at y = 0 and y = `second`, in a ball about the origin.
    fn crossing(slope: f64, second: f64) -> Vec<f64> {
        let grid =
            |from: f64, to: f64| (0..=20).map(move |k| from + (to - from) * f64::from(k) / 20.0);
        let sheet = |sign: f64, end: f64| {
            grid(-1.0, 1.0).flat_map(move |x| {
                grid(-1.0, end).map(move |y| {
                    let z = sign * slope * (x + 0.004);
                    [x + 0.004, y, z]
                })
            })
        };
        let inside = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>() < RADIUS * RADIUS;
        let places: Vec<[f64; 3]> = std::iter::once([0.0; 3])
            .chain(sheet(1.0, 0.0))
            .chain(sheet(-1.0, second))
            .filter(inside)
            .collect();
        let mean = |k: usize| places.iter().map(|p| p[k]).sum::<f64>() / places.len() as f64;
        let mean = [mean(0), mean(1), mean(2)];
        let shifted = places.iter().map(|p| [0, 1, 2].map(|k| p[k] - mean[k]));
        shifted.flatten().collect()
    }

    fn decompose(coordinates: &[f64]) -> Result<Decomposition, Rejection> {
        CrossingEnd::new(0.2, 0.1).unwrap().decompose(&LocalPoints {
            dimension: 3,
            coordinates,
            fitted: coordinates.len() / 3,
            center: 0,
            radius: RADIUS,
        })
    }

    #[test]
    fn the_end_of_two_half_planes() {
        for slope in [1.0, 0.577, 0.268] {
            let places = crossing(slope, 0.0);
            let fit = decompose(&places).unwrap();
            let end: Vec<f64> = (0..3).map(|k| fit.points[0][k] - places[k]).collect();
            assert!(end.iter().all(|x| x.abs() < 0.02), "{slope}: {end:?}");
            assert_eq!(fit.labels[0], Label::from(POINT));
            for label in (0..10).map(Label::new) {
                assert!(fit.labels.contains(&label), "{slope}: {label}");
            }
        }
    }

    #[test]
    fn what_does_not_end_so_is_none() {
        // Both go on; one goes on; they meet at too small an angle.
        for (slope, ends) in [(1.0, [1.0, 1.0]), (1.0, [0.0, 1.0]), (0.1, [0.0, 0.0])] {
            let places = crossing(slope, ends[1]);
            let both = ends[0] > 0.0;
            let found = if both {
                // Turned over, so that the first sheet goes on too.
                let back: Vec<f64> = places
                    .chunks_exact(3)
                    .flat_map(|p| [p[0], -p[1], -p[2]])
                    .collect();
                decompose(&[places, back].concat())
            } else {
                decompose(&places)
            };
            assert!(found.is_err(), "{slope} {ends:?}");
        }
    }
}
