//! Points moved across the surface, onto fits of their neighborhoods.

use super::Noise;
use super::crossing_fits::CrossingFits;
use super::crossing_sheets::CrossingSheets;
use super::sheet_fit::SheetFit;
use crate::balls::{BallTree, Near};
use crate::execute::Execute;
use crate::tuning::ProjectionTuning;
use crosscap_core::{PointCloud, Scalar, squared_distance};
use std::f64::consts::PI;

/// A cloud whose points were moved onto local fits, to take noise away.
///
/// Through the nearest points of each a sheet of quadratic heights is laid, with weights that fall to zero
/// at the farthest (moving least squares: Levin 2004; Alexa et al. 2003), and the point is moved across its
/// plane onto it. Where one sheet leaves more scatter than elsewhere, two sheets that cross are laid instead, and
/// the point goes to the nearer one; where these explain the points no better, the pair that was laid nearest does, if it is
/// near enough; otherwise the point stays: a fit that
/// mixes sheets is worse than none. Two or three rounds, each from where the last one ended. Points do not move along
/// the surface, so that boundaries stay where they are.
///
/// Two sheets may leave what one sheet left before anything was moved: the points about a crossing that were not moved yet
/// scatter as they did at first, however quiet the rest has become.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Projection {
    /// The points after the last round, in the order of the rows.
    pub cloud: PointCloud<f64>,
    /// Number of points of a fit.
    pub neighbors: usize,
    /// Number of rounds.
    pub rounds: usize,
    /// Root mean square of how far points were moved, unit of the data.
    pub moved: f64,
    /// Points of the last round that two crossing sheets explained.
    pub at_crossings: usize,
    /// Points of the last round that nothing explained, and that stayed where they were.
    pub unexplained: usize,
}

/// What a round makes of one point.
struct Step {
    row: u32,
    place: Vec<f64>,
    scatter: f64,
}

impl Projection {
    /// Moves the points of a noisy cloud. O(n log n) distances and a fit of O(k N) a point and round, for k
    /// points of a fit.
    pub fn of<S: Scalar>(
        cloud: &PointCloud<S>,
        noise: &Noise,
        tuning: &ProjectionTuning,
        execute: &dyn Execute,
    ) -> Self {
        let original = cloud.cast::<f64>();
        let wanted = PI * (tuning.reach * noise.of_spacing()).powi(2);
        let share = (tuning.most_share * cloud.len() as f64) as usize;
        let most = tuning.most_neighbors.min(share);
        let wanted = (wanted as usize).max(tuning.usual_neighbors);
        let neighbors = wanted.min(most).max(tuning.least_neighbors);
        let mut out = Self {
            cloud: original.clone(),
            neighbors,
            rounds: if noise.of_spacing() > tuning.loud {
                3
            } else {
                2
            },
            moved: 0.0,
            at_crossings: 0,
            unexplained: 0,
        };
        if 2 * neighbors >= cloud.len() {
            out.rounds = 0;
            return out;
        }
        let mut at_first = None;
        for _ in 0..out.rounds {
            let scatter = out.round(at_first, tuning, execute);
            at_first.get_or_insert(scatter);
        }
        let rows = original.iter().zip(out.cloud.iter());
        let sum: f64 = rows.map(|(a, b)| squared_distance(a, b)).sum();
        out.moved = (sum / cloud.len() as f64).sqrt();
        out
    }

    /// One round; the usual scatter about one sheet before it. `at_first` is that of the first round.
    fn round(
        &mut self,
        at_first: Option<f64>,
        tuning: &ProjectionTuning,
        execute: &dyn Execute,
    ) -> f64 {
        let tree = BallTree::new(self.cloud.dimension(), self.cloud.coordinates());
        let cloud = self.cloud.clone();
        let steps = tree.nearest_of_each(
            self.neighbors,
            |_| true,
            execute,
            |row, near| one_sheet(&cloud, row, near),
        );
        let mut scatters: Vec<f64> = steps.iter().flatten().map(|s| s.scatter).collect();
        scatters.sort_unstable_by(f64::total_cmp);
        let usual = scatters.get(scatters.len() / 2).copied().unwrap_or(0.0);
        let mut contested = vec![true; cloud.len()];
        let mut alone = vec![None; cloud.len()];
        for step in steps.into_iter().flatten() {
            let row = step.row as usize;
            contested[row] = step.scatter > tuning.one_sheet * usual;
            if !contested[row] {
                self.cloud.set_point(row, &step.place);
            } else if step.scatter <= tuning.unexplained * usual {
                alone[row] = Some(step.place);
            }
        }
        let limit = tuning.one_sheet * at_first.unwrap_or(usual);
        let laid = tree.nearest_of_each(
            2 * self.neighbors,
            |row| contested[row as usize],
            execute,
            |row, near| {
                let row = row as usize;
                let sheets = CrossingSheets::through(&cloud, row, near, limit, tuning);
                sheets.map(|sheets| (row, sheets))
            },
        );
        let fits = CrossingFits::of(&cloud, laid.into_iter().flatten());
        (self.at_crossings, self.unexplained) = (0, 0);
        for row in (0..cloud.len()).filter(|&row| contested[row]) {
            // A pair that was laid about the row itself is the nearest.
            let place = fits.projected(cloud.point(row), tuning.borrowed);
            self.at_crossings += usize::from(place.is_some());
            match place.or(alone[row].take()) {
                Some(place) => self.cloud.set_point(row, &place),
                None => self.unexplained += 1,
            }
        }
        usual
    }
}

/// The point on the sheet of its neighborhood, and the scatter of the others about it.
fn one_sheet(cloud: &PointCloud<f64>, row: u32, near: &[Near]) -> Option<Step> {
    let mut near: Vec<Near> = near.to_vec();
    near.sort_unstable();
    let own = cloud.point(row as usize);
    let limit = near.last()?.square();
    let mut points = own.to_vec();
    let mut weights = vec![1.0];
    for x in &near {
        points.extend_from_slice(cloud.point(x.index() as usize));
        let share = if limit > 0.0 { x.square() / limit } else { 0.0 };
        weights.push((1.0 - share).powi(2));
    }
    let mut fit = SheetFit::new(cloud.dimension());
    if !fit.fit(&points, &weights) {
        return None;
    }
    let mut offset = Vec::new();
    let (mut sum, mut total) = (0.0, 0.0);
    for (x, w) in points.chunks_exact(cloud.dimension()).zip(&weights) {
        sum += w * fit.distance(x, f64::INFINITY, &mut offset).powi(2);
        total += w;
    }
    let mut place = own.to_vec();
    fit.project(&mut place, &mut offset);
    Some(Step {
        row,
        place,
        scatter: (sum / total).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::Serial;
    use crate::surfaces::{RigidMotion, SampleSurface, Sampling};
    use crate::tuning::NoiseTuning;

    fn sample(name: &str, count: usize, noise: f64) -> PointCloud<f64> {
        let sampling = Sampling {
            noise,
            ..Sampling::new(count, 4)
        };
        let surface = SampleSurface::find(name).unwrap();
        surface.sample(&sampling).unwrap().points
    }

    fn projection(cloud: &PointCloud<f64>) -> Projection {
        let noise = Noise::of(cloud, &NoiseTuning::MEASURED, &Serial).unwrap();
        Projection::of(cloud, &noise, &ProjectionTuning::MEASURED, &Serial)
    }

    fn off(cloud: &PointCloud<f64>, distance: impl Fn(&[f64]) -> f64) -> f64 {
        let sum: f64 = cloud.iter().map(|x| distance(x).powi(2)).sum();
        (sum / cloud.len() as f64).sqrt()
    }

    fn norm(x: &[f64]) -> f64 {
        squared_distance(x, &vec![0.0; x.len()]).sqrt()
    }

    #[test]
    fn noise_on_a_sphere_and_its_half_is_taken_away() {
        for (name, count) in [("sphere", 3000), ("hemisphere", 2000)] {
            for noise in [0.015, 0.06] {
                let cloud = sample(name, count, noise);
                let distance = |x: &[f64]| (norm(x) - 1.0).abs();
                let found = projection(&cloud);
                let (before, after) = (off(&cloud, distance), off(&found.cloud, distance));
                assert!(after < 0.45 * before, "{name} {noise}: {after} of {before}");
                assert!(found.unexplained < count / 50, "{name} {noise}: {found:?}");
            }
        }
    }

    #[test]
    fn sheets_that_cross_are_kept_apart() {
        let noise = 0.015;
        let cloud = sample("two_spheres", 6000, noise);
        let centers = two_centers();
        let distance = |x: &[f64]| {
            let from = centers.map(|c| (squared_distance(x, &c).sqrt() - 1.0).abs());
            from[0].min(from[1])
        };
        let found = projection(&cloud);
        assert!(found.at_crossings > 100);
        let after = off(&found.cloud, distance);
        assert!(after < 0.4 * noise, "{after}");
        let worst = found.cloud.iter().map(distance).fold(0.0, f64::max);
        assert!(worst < 2.5 * noise, "{worst}");
        // Next to the circle both sheets are near, and points stay apart all the same.
        assert!(found.unexplained < 6, "{found:?}");
    }

    /// Centers of the two unit spheres, from their own points.
    fn two_centers() -> [[f64; 3]; 2] {
        let surface = SampleSurface::find("two_spheres").unwrap();
        let sample = surface.sample(&Sampling::new(4000, 1)).unwrap();
        [0, 1].map(|piece| {
            let own: Vec<&[f64]> = (sample.points.iter().zip(&sample.pieces))
                .filter(|x| *x.1 == piece)
                .map(|x| x.0)
                .collect();
            // The middle of the bounding box, to the spacing of the points, then of opposite points.
            [0, 1, 2].map(|k| {
                let low = own.iter().map(|x| x[k]).fold(f64::INFINITY, f64::min);
                let high = own.iter().map(|x| x[k]).fold(f64::NEG_INFINITY, f64::max);
                0.5 * (low + high)
            })
        })
    }

    #[test]
    fn points_of_a_plane_stay() {
        let cloud = sample("square", 1500, 0.0);
        let moved = RigidMotion::random(3, 2.0, 1).apply(&cloud).unwrap();
        let noise = Noise {
            deviation: 0.02,
            spacing: 0.05,
            neighbors: 24,
        };
        let found = Projection::of(&moved, &noise, &ProjectionTuning::MEASURED, &Serial);
        assert!(found.moved < 1e-7, "{}", found.moved);
    }
}
