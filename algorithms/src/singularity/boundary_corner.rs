//! A corner of the boundary of a surface, found where nobody names it.

use super::curve_end::CurveEnd;
use super::patch::{PATCH_POINTS, QuadraticPatch};
use super::tolerance::{Tolerance, at_least, vectors};
use super::wedge::{Evidence, Laid, Wedge};
use crate::tuning::BoundaryCornerTuning;
use crosscap_core::{
    Decomposition, Error, Link, LinkKind, LocalPoints, Located, Rejection, SingularityModel,
};
use nalgebra::Vector3;

/// A sheet that ends in two curves, which meet at an angle: a corner, convex or reflex.
///
/// The sheet is laid out in its tangent plane. Of all curves with one kink that have the points on one side, the lowest is fitted, a linear
/// program for every place of the kink; and so is the lowest of the smooth curves, quartic parabolas that do not bend as sharply
/// as a corner does. The corner is believed when the smooth curve leaves so much more of the ball empty that, at the density of the points,
/// this is no chance. A boundary that bends in less than 0.4 radii counts as a corner.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryCorner {
    tolerance: Tolerance,
    tuning: BoundaryCornerTuning,
}

/// Labels: the corner, the arms, the cell.
const POINT: u8 = 0;
const ARMS: [u8; 2] = [1, 2];
const CELL: u8 = 3;

impl BoundaryCorner {
    /// Model with fit tolerance `dp` (of the sheet) and curve tolerance `ep`, unit of the data: a point nearer than `ep` to
    /// the boundary is on it.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless both are positive and finite.
    pub fn new(dp: f64, ep: f64) -> Result<Self, Error> {
        Ok(Self {
            tolerance: Tolerance::new(dp, ep)?,
            tuning: BoundaryCornerTuning::MEASURED,
        })
    }

    /// The same, believed under other conditions.
    pub fn tuned(self, tuning: BoundaryCornerTuning) -> Self {
        Self { tuning, ..self }
    }

    fn fit(&self, local: &LocalPoints<'_>) -> Result<Fit, Rejection> {
        at_least(PATCH_POINTS, local)?;
        let all: Vec<Vector3<f64>> = vectors(local);
        let radius = local.radius;
        let points = &all[..local.fitted];
        let middle = all[local.middle];
        let (sheet, residual) = self.sheet(points, radius)?;
        let laid = |x: &Vector3<f64>| [x.x - middle.x, x.y - middle.y].map(|x| x / radius);
        let laid: Vec<[f64; 2]> = points.iter().map(laid).collect();
        let seen = Laid {
            points: &laid,
            tuning: &self.tuning,
        };
        let wedge = seen.wedge().ok_or(Rejection::NoRealSolution)?;
        self.believe(&wedge, &seen.evidence(&wedge))?;
        let mut fit = Fit {
            all,
            fitted: local.fitted,
            sheet,
            middle,
            radius,
            corner: Vector3::zeros(),
            wedge,
            residual,
            ep: self.tolerance.ep,
            witness: self.tuning.witness,
        };
        fit.corner = fit.lifted(fit.wedge.kink.corner());
        Ok(fit)
    }

    /// Whether there is enough to say for a corner.
    fn believe(&self, wedge: &Wedge, found: &Evidence) -> Result<(), Rejection> {
        let tuning = &self.tuning;
        let [t, v] = wedge.kink.corner();
        if t.hypot(v) > tuning.reach {
            return Err(Rejection::NoRealSolution);
        }
        if found.turn < 0.0 && found.below_arm > tuning.arm {
            return Err(Rejection::NoRealSolution);
        }
        // A tip that one point alone holds is an outlier.
        let [first, second] = found.in_tip;
        let bare = first > tuning.tip || second > 2.0 * tuning.tip;
        if bare || found.missing < tuning.missing {
            return Err(Rejection::EmptyStratum {
                stratum: 0,
                found: found.missing.max(0.0) as usize,
            });
        }
        Ok(())
    }

    /// The sheet through the points, with what it leaves.
    fn sheet(
        &self,
        points: &[Vector3<f64>],
        radius: f64,
    ) -> Result<(QuadraticPatch, f64), Rejection> {
        let mut sheet =
            QuadraticPatch::plane(Vector3::zeros(), [Vector3::x(), Vector3::y(), Vector3::z()]);
        if !sheet.fit(points.iter().copied(), radius) {
            return Err(Rejection::NoRealSolution);
        }
        let off = points.iter().map(|x| sheet.signed_distance(x).powi(2));
        let residual = self.tolerance.residual(off.sum(), points.len())?;
        Ok((sheet, residual))
    }
}

/// A neighborhood with its corner.
struct Fit {
    all: Vec<Vector3<f64>>,
    fitted: usize,
    sheet: QuadraticPatch,
    /// Of the ball.
    middle: Vector3<f64>,
    radius: f64,
    corner: Vector3<f64>,
    wedge: Wedge,
    residual: f64,
    ep: f64,
    witness: f64,
}

impl Fit {
    /// The place of the sheet over one of its tangent plane, which is given in the axes of the wedge and in radii.
    fn lifted(&self, place: [f64; 2]) -> Vector3<f64> {
        let [x, y] = self.wedge.axes.back(place).map(|x| x * self.radius);
        let below = Vector3::new(self.middle.x + x, self.middle.y + y, 0.0);
        below - Vector3::z() * self.sheet.height(&below).0
    }

    /// A place of the tangent plane in the axes of the wedge.
    fn laid(&self, x: &Vector3<f64>) -> [f64; 2] {
        let from = [x.x - self.middle.x, x.y - self.middle.y];
        self.wedge.axes.plane(from.map(|x| x / self.radius))
    }
}

impl CurveEnd for Fit {
    fn strata(&self) -> &[u8] {
        &[0, 1, 1, 2]
    }

    fn cells(&self) -> &[u8] {
        &[1, 1]
    }

    // The sheet, the arms and their corner.
    fn parameters(&self) -> usize {
        14
    }

    fn points(&self) -> &[Vector3<f64>] {
        &self.all
    }

    fn end(&self) -> Vector3<f64> {
        self.corner
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn ep(&self) -> f64 {
        self.ep
    }

    fn witness(&self) -> f64 {
        self.witness
    }

    fn locate(&self, row: usize) -> (u8, Vector3<f64>, u8) {
        let x = self.all[row];
        if (x - self.corner).norm() < self.ep {
            return (POINT, self.corner, 0);
        }
        let place = self.laid(&x);
        let far = |p: [f64; 2]| (p[0] - place[0]).hypot(p[1] - place[1]);
        let feet = [0, 1].map(|arm| self.wedge.kink.foot(arm, place));
        let arm = usize::from(far(feet[1]) < far(feet[0]));
        // Beyond the neighborhood the arms are mere extrapolation.
        let known = row < self.fitted || (x - self.middle).norm() < self.radius;
        let on_arm = known && far(feet[arm]) * self.radius < self.ep;
        let label = if on_arm { ARMS[arm] } else { CELL };
        (label, self.lifted(feet[arm]), 1)
    }
}

impl SingularityModel for BoundaryCorner {
    fn local_dimension(&self) -> usize {
        3
    }

    fn applies_to(&self, _dimension: usize) -> bool {
        false
    }

    fn finds_boundary(&self) -> bool {
        true
    }

    fn explains_ends(&self) -> bool {
        true
    }

    fn link(&self) -> Option<Link> {
        LinkKind::Arc.link()
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
        "boundary-corner"
    }
}

#[cfg(test)]
mod tests {
    use super::super::about_first;
    use super::*;
    use crosscap_core::laws::{Draw, Instance};

    const RADIUS: f64 = 1.0;

    /// A plane grid of points where `inside` holds, in a ball about the first point, which is the one nearest to the origin; about their mean.
    fn plate(inside: impl Fn([f64; 2]) -> bool) -> Vec<f64> {
        // Turned, so that no edge runs along the grid.
        let (s, c) = 0.37_f64.sin_cos();
        let step = 0.07;
        let grid = (-22..=22).flat_map(|i| (-22..=22).map(move |j| [f64::from(i), f64::from(j)]));
        let places = grid.map(|[i, j]| [step * (c * i - s * j), step * (s * i + c * j)]);
        let mut places: Vec<[f64; 2]> = places.filter(|&p| inside(p)).collect();
        let far = |p: &[f64; 2]| p[0].hypot(p[1]);
        places.sort_by(|a, b| far(a).total_cmp(&far(b)));
        let first = places[0];
        places.retain(|p| (p[0] - first[0]).hypot(p[1] - first[1]) < RADIUS);
        let mean = [0, 1].map(|k| places.iter().map(|p| p[k]).sum::<f64>() / places.len() as f64);
        let shifted = places
            .iter()
            .flat_map(|p| [p[0] - mean[0], p[1] - mean[1], 0.0]);
        shifted.collect()
    }

    fn decompose(coordinates: &[f64]) -> Result<Decomposition, Rejection> {
        let model = BoundaryCorner::new(0.1, 0.08).unwrap();
        model.decompose(&about_first(coordinates, RADIUS))
    }

    /// A sector of the plane of so many degrees about the origin.
    fn sector(degrees: f64) -> Vec<f64> {
        plate(|p| p[1].atan2(p[0]).abs().to_degrees() < degrees / 2.0)
    }

    #[test]
    fn corners_of_all_angles() {
        for degrees in [40.0, 60.0, 90.0, 110.0, 250.0, 270.0] {
            let places = sector(degrees);
            let fit = decompose(&places).unwrap_or_else(|e| panic!("{degrees}: {e:?}"));
            // The first point is near the corner.
            let off = (0..3).map(|k| (fit.points[0][k] - places[k]).powi(2));
            assert!(off.sum::<f64>().sqrt() < 0.15, "{degrees}");
            for label in 0..4 {
                assert!(
                    fit.labels.iter().any(|l| l.index() == label),
                    "{degrees}: {label}"
                );
            }
        }
    }

    #[test]
    fn a_narrow_notch_is_found_where_it_is_or_not_at_all() {
        let model = BoundaryCorner::new(0.1, 0.05).unwrap();
        let mut found = 0;
        for (degrees, seeds) in [(270.0, 0..20), (290.0, 20..60), (300.0, 60..160)] {
            for seed in seeds {
                let notched = notched(&mut Draw::new(seed, 700), degrees);
                let local = notched.local();
                if let Ok(fit) = model.decompose(&local) {
                    let off = crosscap_core::squared_distance(&fit.points[0], local.point(0));
                    // A notch of 60 degrees moved so far along its arm leaves twelve points out below the other: all that may be missing there.
                    assert!(off.sqrt() < 0.3, "{degrees}, {seed}: {}", off.sqrt());
                    found += 1;
                }
            }
        }
        assert!(found > 30, "{found}");
    }

    /// Random points of a sector about the first of them, in principal coordinates.
    fn notched(draw: &mut Draw, degrees: f64) -> Instance {
        let half = f64::to_radians(degrees) / 2.0;
        let mut points = vec![(vec![0.0; 3], None)];
        while points.len() < draw.points {
            let [x, y] = draw.disc();
            if y.atan2(x).abs() < half {
                points.push((vec![x, y, 0.0], None));
            }
        }
        Instance::new(3, RADIUS, &points).principal()
    }

    /// A tip of 53 degrees at the origin with a gap along one of its arms, in a ball about a point beside the gap; about their mean, with the tip.
    fn gap_beside_a_tip(draw: &mut Draw) -> (Vec<f64>, [f64; 2]) {
        let (sin, cos) = (0.5 * 53.0_f64).to_radians().sin_cos();
        let along_and_in = |p: [f64; 2]| [cos * p[0] + sin * p[1], sin * p[0] - cos * p[1]];
        let from = [0.64 * cos + 0.1 * sin, 0.64 * sin - 0.1 * cos];
        let mut places = vec![from];
        while places.len() < draw.points {
            let offset = draw.disc();
            let place = [0, 1].map(|k| from[k] + offset[k]);
            let [along, inward] = along_and_in(place);
            let in_gap = inward < 0.1 * (1.0 - ((along - 0.49) / 0.16).powi(2));
            if place[1].abs() * cos < place[0] * sin && !in_gap {
                places.push(place);
            }
        }
        let count = places.len() as f64;
        let mean = [0, 1].map(|k| places.iter().map(|p| p[k]).sum::<f64>() / count);
        let centered = (places.iter()).flat_map(|p| [p[0] - mean[0], p[1] - mean[1], 0.0]);
        (centered.collect(), mean.map(|m| -m))
    }

    #[test]
    fn a_gap_beside_a_tip_is_not_taken_for_the_tip() {
        let mut found = 0;
        for seed in 0..40 {
            let (places, tip) = gap_beside_a_tip(&mut Draw::new(seed, 200));
            if let Ok(fit) = decompose(&places) {
                let off = (0..2).map(|k| (fit.points[0][k] - tip[k]).powi(2));
                let off = off.sum::<f64>().sqrt();
                assert!(off < 0.3, "{seed}: {off}");
                found += 1;
            }
        }
        assert!(found > 30, "{found}");
    }

    #[test]
    fn a_point_that_lies_off_a_straight_boundary_is_no_corner() {
        let spike = plate(|p| p[0] > 0.25 || p[0].hypot(p[1]) < 0.01);
        let local = about_first(&spike, RADIUS);
        let model = BoundaryCorner::new(0.1, 0.08).unwrap();
        let found = model.decompose(&local);
        let bare = matches!(found, Err(Rejection::EmptyStratum { stratum: 0, .. }));
        assert!(bare, "{found:?}");
        // But for this one condition it is.
        let tip = f64::INFINITY;
        let tuning = BoundaryCornerTuning {
            tip,
            ..BoundaryCornerTuning::MEASURED
        };
        assert!(model.tuned(tuning).decompose(&local).is_ok());
    }

    #[test]
    fn a_boundary_that_bends_has_no_corner() {
        // Straight, and round from within and from without with a radius of 0.8.
        let round = |p: [f64; 2]| (p[0] - 0.8).hypot(p[1]) - 0.8;
        assert!(decompose(&plate(|p| p[0] > 0.0)).is_err());
        assert!(decompose(&plate(|p| round(p) < 0.0)).is_err());
        assert!(decompose(&plate(|p| round([-p[0], p[1]]) > 0.0)).is_err());
    }
}
