//! The preprocessing of Martin & Watson (2011) to the letter, for comparison.
//!
//! What the paper does not say is decided here as follows.
//! - A neighborhood of dimension 0, 1 or more than 3, or of dimension 3 whose fit is rejected, stays
//!   undivided: B0 is empty and B1 is all of it.
//! - A fit is rejected when the planes are not real, when there are fewer than 10 points (the quadric
//!   has 9 degrees of freedom), or when the *root* mean squared distance to the nearer plane exceeds dp.
//! - Where the triangulation has a radius of its own, planes are fitted to the ball of eps and
//!   divide the larger ball; which points are on curves is decided with eps alone.
//! - A landmark on a curve is laid out in its own B0 where that holds it, otherwise in the B0 of the
//!   nearest point whose B0 holds it. It is joined to the nearest landmark on either side in the
//!   chart, unless an edge leads to that side already. A side without landmarks stays free.
//! - A given boundary point counts as a curve point, its B0 is the boundary points in its ball,
//!   and an edge between two boundary landmarks bounds one cell. Any other curve edge bounds four.

use super::analysis::{Analysis, Analyzer, Role, Scratch};
use super::waist::{Stratification, StratifyCounts, lengths};
use crate::execute;
use crate::principal::PrincipalFrame;
use crate::singularity::PlanePair;
use crosscap_core::{
    CellNeighborhood, CurveEdge, Error, LandmarkSelector, LocalChart, MetricSpace, Scalar,
    SparseDistances, StratifiedLandmarks,
};
use nalgebra::Vector3;

/// Parameters of the published method, lengths in the unit of the data.
///
/// [`analyze`](Self::analyze) finds the points on curves, [`stratify`](Self::stratify) draws landmarks
/// and describes their surroundings; triangulate with
/// [`Rules::PAPER`](crate::triangulate::Rules::PAPER),
/// [`MinimumCircumradius`](crate::triangulate::MinimumCircumradius) and without repair.
///
/// ```
/// use crosscap_algorithms::chart::ClassicalScaling;
/// use crosscap_algorithms::dimension::PrincipalComponents;
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::landmarks::RandomGreedy;
/// use crosscap_algorithms::metric::{BruteForceOracle, Euclidean};
/// use crosscap_algorithms::stratify::{Analyzer, Dimensions, Published};
/// use crosscap_core::PointCloud;
/// let grid = (0..100).flat_map(|k| [f64::from(k % 10), f64::from(k / 10), 0.0]);
/// let cloud = PointCloud::new(3, grid.collect())?;
/// let metric = Euclidean::new(cloud.clone());
/// let oracle = BruteForceOracle::new(&metric);
/// let estimator = PrincipalComponents::new(0.05)?;
/// let analyzer = Analyzer {
///     cloud: &cloud, metric: &metric, oracle: &oracle,
///     dimensions: Dimensions::Estimator(&estimator), models: &[], execute: &Serial,
/// };
/// let method = Published {
///     eps: 3.0, tri_eps: 3.0, dp: 0.1, ep: 0.1, dl: 1.5, seed: 1, surface: false, boundary: vec![],
/// };
/// let analysis = method.analyze(&analyzer)?;
/// let waist = method.stratify(&analyzer, &analysis, None, &RandomGreedy::new(), &ClassicalScaling)?;
/// assert_eq!(waist.counts.curve_landmarks, 0);
/// # Ok::<(), crosscap_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Published {
    /// Radius of the neighborhoods of dimension estimate and fit (strict).
    pub eps: f64,
    /// Radius of the neighborhoods that are triangulated (strict); eps in all but one of the
    /// paper's examples.
    pub tri_eps: f64,
    /// Largest root mean squared distance of a neighborhood to its planes.
    pub dp: f64,
    /// A point closer than this to both planes is on the curve (strict).
    pub ep: f64,
    /// Landmark separation.
    pub dl: f64,
    /// Seed of the landmark selection.
    pub seed: u64,
    /// Take every point as 2-dimensional and look for no curve.
    pub surface: bool,
    /// Rows that lie on the boundary.
    pub boundary: Vec<usize>,
}

/// Fewest points that a quadric of 9 degrees of freedom is fitted to.
const QUADRIC_POINTS: usize = 10;

/// A point of a neighborhood with its distances to the two planes.
struct Divided {
    row: usize,
    planes: [f64; 2],
}

impl Divided {
    fn on_curve(&self, ep: f64) -> bool {
        self.planes.iter().all(|&d| d < ep)
    }
}

impl Published {
    fn check(&self) -> Result<(), Error> {
        let lengths = [
            ("eps", self.eps),
            ("tri-eps", self.tri_eps),
            ("dp", self.dp),
            ("ep", self.ep),
            ("dl", self.dl),
        ];
        for (name, value) in lengths {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::Parameter {
                    name,
                    value: value.to_string(),
                    expected: "a positive length".into(),
                });
            }
        }
        Ok(())
    }

    /// Dimension of every neighborhood and the union of all B0 (the paper's sections 2.1, 2.2.1).
    /// No point is moved; the models of `analyzer` are not asked.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is not positive, [`Error::Index`] for a boundary row out
    /// of range, those of the dimension estimator.
    ///
    /// O(n k N^2) for k points in a neighborhood.
    pub fn analyze<S: Scalar>(&self, analyzer: &Analyzer<'_, S>) -> Result<Analysis, Error> {
        self.check()?;
        let n = analyzer.cloud.len();
        let mut boundary = vec![false; n];
        for &row in &self.boundary {
            *boundary.get_mut(row).ok_or(Error::Index {
                what: "boundary row",
                index: row,
                limit: n,
            })? = true;
        }
        let mut on_curve = vec![false; n];
        let mut dimensions = vec![2u8; n];
        let mut unexplained = Vec::new();
        let mut total = 0usize;
        if !self.surface {
            let found = execute::map(analyzer.execute, n, Scratch::default, |scratch, i| {
                self.point(analyzer, i, scratch)
            });
            for (i, found) in found.into_iter().enumerate() {
                let (dimension, neighbors, curve) = found?;
                dimensions[i] = dimension;
                total += neighbors;
                match curve {
                    Some(rows) => rows.iter().for_each(|&r| on_curve[r as usize] = true),
                    None if dimension != 2 => unexplained.push(i),
                    None => {}
                }
            }
        }
        let roles: Vec<Role> = boundary
            .iter()
            .zip(&on_curve)
            .map(|roles| match roles {
                (false, false) => Role::Regular,
                (false, true) => Role::Curve,
                (true, false) => Role::Boundary,
                (true, true) => Role::Corner,
            })
            .collect();
        Ok(Analysis {
            radii: on_curve
                .iter()
                .map(|&c| if c { self.eps } else { 0.0 })
                .collect(),
            roles,
            candidates: dimensions.iter().filter(|&&d| d != 2).count(),
            dimensions,
            places: analyzer.cloud.cast::<f64>(),
            offsets: vec![0.0; n],
            model: vec![0; n],
            cells: vec![4; n],
            mean_neighbors: total as f64 / n.max(1) as f64,
            unexplained,
            witnesses: Vec::new(),
            apexes: Vec::new(),
            faults: Default::default(),
        })
    }

    /// Dimension of a neighborhood, its number of points, and its B0 where it could be divided.
    fn point<S: Scalar>(
        &self,
        analyzer: &Analyzer<'_, S>,
        i: usize,
        scratch: &mut Scratch<S>,
    ) -> Result<(u8, usize, Option<Vec<u32>>), Error> {
        let (neighbors, dimension) = analyzer.dimension_at(i, self.eps, scratch)?;
        let curve = (dimension == 3)
            .then(|| self.divide(analyzer, i, self.eps, scratch))
            .flatten()
            .map(|parts| {
                let parts = parts.iter().filter(|p| p.on_curve(self.ep));
                parts.map(|p| p.row as u32).collect()
            });
        Ok((dimension, neighbors, curve))
    }

    /// The points within `reach` of point `i`, nearest first, with their distances to the two
    /// planes fitted to the ball of eps; `None` where the fit is rejected.
    fn divide<S: Scalar>(
        &self,
        analyzer: &Analyzer<'_, S>,
        i: usize,
        reach: f64,
        scratch: &mut Scratch<S>,
    ) -> Option<Vec<Divided>> {
        let Scratch { near, local, .. } = scratch;
        analyzer.oracle.within(i, S::of(reach.max(self.eps)), near);
        let fitted = near.partition_point(|x| x.distance < S::of(self.eps));
        if fitted < QUADRIC_POINTS {
            return None;
        }
        let frame = PrincipalFrame::of(analyzer.cloud, near[..fitted].iter().map(|x| x.index));
        local.clear();
        for x in near.iter() {
            frame.project(analyzer.cloud.point(x.index), 3, local);
        }
        let points = local.chunks_exact(3).map(Vector3::from_column_slice);
        let planes = PlanePair::direct(points.clone().take(fitted), self.eps).ok()?;
        let distances = |x: &Vector3<f64>| [0, 1].map(|k| planes.distance(k, x).abs());
        let sum: f64 = points
            .clone()
            .take(fitted)
            .map(|x| {
                let [a, b] = distances(&x);
                a.min(b).powi(2)
            })
            .sum();
        if (sum / fitted as f64).sqrt() > self.dp {
            return None;
        }
        Some(
            near.iter()
                .zip(points)
                .take_while(|(x, _)| x.distance < S::of(reach))
                .map(|(x, place)| Divided {
                    row: x.index,
                    planes: distances(&place),
                })
                .collect(),
        )
    }

    /// Landmarks (curves first), the edges along the curves and the landmark neighborhoods (the
    /// paper's section 2.2). `analysis` is that of [`Self::analyze`] with the same parameters.
    ///
    /// `metric` gives the distances inside the neighborhoods, `None` for Euclidean ones. Only
    /// landmarks off the curves get a neighborhood: others are never visited in two dimensions.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a length that is not positive, [`Error::Shape`] for an analysis of
    /// another cloud, [`Error::Law`] for a chart that is not finite, those of selector and chart.
    ///
    /// O(L k N^2) for L landmarks and k points in a neighborhood, plus selection and charts.
    pub fn stratify<S: Scalar>(
        &self,
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        metric: Option<&dyn MetricSpace<Scalar = S>>,
        selector: &dyn LandmarkSelector<Scalar = S>,
        chart: &dyn LocalChart,
    ) -> Result<Stratification<S>, Error> {
        self.check()?;
        let n = analyzer.cloud.len();
        if analysis.roles.len() != n {
            return Err(Error::Shape {
                found: format!("an analysis of {} points", analysis.roles.len()),
                expected: format!("{n} points, as in the cloud"),
            });
        }
        let (on_curves, others): (Vec<usize>, Vec<usize>) =
            (0..n).partition(|&i| analysis.roles[i] != Role::Regular);
        let mut rows = selector.select(analyzer.oracle, &on_curves, &[], self.dl, self.seed)?;
        let curve_landmarks = rows.len();
        let rest = selector.select(analyzer.oracle, &others, &rows, self.dl, self.seed)?;
        rows.extend(rest);
        let mut landmark_at = vec![None; n];
        for (k, &row) in rows.iter().enumerate() {
            landmark_at[row] = Some(k as u32);
        }

        let neighborhoods: Vec<Vec<u32>> = execute::map(
            analyzer.execute,
            rows.len(),
            Scratch::default,
            |scratch, k| {
                let near = if k < curve_landmarks {
                    self.along_curve(analyzer, analysis, rows[k], scratch)
                } else {
                    self.in_sheet(analyzer, analysis, rows[k], scratch)
                };
                let others = near.into_iter().filter(|&row| row != rows[k]);
                std::iter::once(k as u32)
                    .chain(others.filter_map(|row| landmark_at[row]))
                    .collect()
            },
        );
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for members in &neighborhoods {
            for (i, &a) in members.iter().enumerate() {
                pairs.extend(members[..i].iter().map(|&b| (a.min(b), a.max(b))));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let lengths = lengths(analyzer, metric.unwrap_or(analyzer.metric), &rows, &pairs);
        let distances = SparseDistances::new(
            rows.len(),
            pairs.iter().zip(&lengths).map(|(&(a, b), &d)| (a, b, d)),
        )?;
        let curve_edges = curve_edges(&neighborhoods[..curve_landmarks], &distances, chart)?
            .into_iter()
            .map(|(a, b)| {
                let bounds = [a, b].iter().all(|&k| {
                    let role = analysis.roles[rows[k as usize]];
                    matches!(role, Role::Boundary | Role::Corner)
                });
                CurveEdge::new(a, b, if bounds { 1 } else { 4 })
            })
            .collect::<Vec<_>>();
        let mut strata = vec![2u8; rows.len()];
        strata[..curve_landmarks].fill(1);
        let neighborhoods: Vec<CellNeighborhood> = neighborhoods
            .into_iter()
            .skip(curve_landmarks)
            .map(|members| CellNeighborhood {
                center: members[0],
                members,
            })
            .collect();
        let members: usize = neighborhoods.iter().map(|x| x.members.len()).sum();
        Ok(Stratification {
            counts: StratifyCounts {
                landmarks: rows.len(),
                curve_landmarks,
                corners: 0,
                curve_edges: curve_edges.len(),
                cut_edges: 0,
                mean_members: members as f64 / neighborhoods.len().max(1) as f64,
            },
            waist: StratifiedLandmarks {
                strata,
                curve_edges,
                neighborhoods,
                distances,
            },
            points: Vec::new(),
            rows,
        })
    }

    /// The points of B1 or B2, whichever holds point `i`, nearest first.
    fn in_sheet<S: Scalar>(
        &self,
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        i: usize,
        scratch: &mut Scratch<S>,
    ) -> Vec<usize> {
        if analysis.dimensions[i] == 3 {
            let parts = self.divide(analyzer, i, self.tri_eps, scratch);
            let own = parts.iter().flatten().find(|p| p.row == i);
            if let (Some(parts), Some(own)) = (&parts, own) {
                let [a, b] = own.planes;
                let (near, far) = if a <= b { (0, 1) } else { (1, 0) };
                return parts
                    .iter()
                    .filter(|p| p.planes[near] <= p.planes[far] || p.on_curve(self.ep))
                    .map(|p| p.row)
                    .collect();
            }
        }
        self.ball(analyzer, i, scratch)
    }

    /// The points of the B0 in which point `i` of a curve is laid out, nearest to the center of that
    /// B0 first.
    fn along_curve<S: Scalar>(
        &self,
        analyzer: &Analyzer<'_, S>,
        analysis: &Analysis,
        i: usize,
        scratch: &mut Scratch<S>,
    ) -> Vec<usize> {
        if matches!(analysis.roles[i], Role::Boundary | Role::Corner) {
            let mut rows = self.ball(analyzer, i, scratch);
            rows.retain(|&r| matches!(analysis.roles[r], Role::Boundary | Role::Corner));
            return rows;
        }
        analyzer
            .oracle
            .within(i, S::of(self.eps), &mut scratch.near);
        let centers: Vec<usize> = scratch
            .near
            .iter()
            .map(|x| x.index)
            .filter(|&j| analysis.dimensions[j] == 3)
            .collect();
        for j in centers {
            let reach = self.tri_eps.max(self.eps);
            let Some(mut parts) = self.divide(analyzer, j, reach, scratch) else {
                continue;
            };
            parts.retain(|p| p.on_curve(self.ep));
            if parts.iter().any(|p| p.row == i) {
                return parts.into_iter().map(|p| p.row).collect();
            }
        }
        Vec::new()
    }

    /// The points within tri_eps of point `i`, nearest first.
    fn ball<S: Scalar>(
        &self,
        analyzer: &Analyzer<'_, S>,
        i: usize,
        scratch: &mut Scratch<S>,
    ) -> Vec<usize> {
        analyzer
            .oracle
            .within(i, S::of(self.tri_eps), &mut scratch.near);
        scratch.near.iter().map(|x| x.index).collect()
    }
}

/// Joins every curve landmark to its neighbors in its 1-D chart, one landmark after another; pairs in
/// increasing order. The center is the first of each neighborhood.
fn curve_edges<S: Scalar>(
    neighborhoods: &[Vec<u32>],
    distances: &SparseDistances<S>,
    chart: &dyn LocalChart,
) -> Result<Vec<(u32, u32)>, Error> {
    let mut joined: Vec<Vec<u32>> = vec![Vec::new(); neighborhoods.len()];
    for (center, members) in neighborhoods.iter().enumerate() {
        let count = members.len();
        if count < 2 {
            continue;
        }
        let mut matrix = vec![0.0; count * count];
        for i in 0..count {
            for j in 0..i {
                let d = distances
                    .get(members[i], members[j])
                    .map_or(f64::INFINITY, Scalar::as_f64);
                matrix[i * count + j] = d;
                matrix[j * count + i] = d;
            }
        }
        let places = chart.chart(count, &matrix, 1)?.coordinates;
        if places.len() != count || places.iter().any(|x| !x.is_finite()) {
            return Err(Error::Law {
                plugin: chart.name().into(),
                law: "finite distances give finite coordinates",
                point: center,
                detail: format!("{} coordinates for {count} points", places.len()),
            });
        }
        for side in [-1.0, 1.0] {
            let ahead = |k: usize| side * (places[k] - places[0]);
            let beyond = || (1..count).filter(|&k| ahead(k) > 0.0);
            if beyond().any(|k| joined[center].contains(&members[k])) {
                continue;
            }
            let next = beyond().min_by(|&a, &b| ahead(a).total_cmp(&ahead(b)).then(a.cmp(&b)));
            if let Some(k) = next {
                joined[center].push(members[k]);
                joined[members[k] as usize].push(center as u32);
            }
        }
    }
    let mut edges: Vec<(u32, u32)> = joined
        .iter()
        .enumerate()
        .flat_map(|(a, ends)| ends.iter().map(move |&b| (a as u32, b)))
        .filter(|&(a, b)| a < b)
        .collect();
    edges.sort_unstable();
    edges.dedup();
    Ok(edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::ClassicalScaling;
    use crate::dimension::PrincipalComponents;
    use crate::execute::Serial;
    use crate::landmarks::RandomGreedy;
    use crate::metric::{BruteForceOracle, Euclidean};
    use crate::stratify::Dimensions;
    use crosscap_core::PointCloud;

    fn published() -> Published {
        Published {
            eps: 0.5,
            tri_eps: 0.5,
            dp: 0.05,
            ep: 0.05,
            dl: 0.2,
            seed: 3,
            surface: false,
            boundary: Vec::new(),
        }
    }

    /// Points of the planes z = 0 and x = 0, |x|, |y|, |z| <= 1, spacing 0.1, none on the line.
    fn cross() -> PointCloud<f64> {
        let mut rows = Vec::new();
        for i in 0..20 {
            for j in 0..20 {
                let (u, v) = (f64::from(i) * 0.1 - 0.95, f64::from(j) * 0.1 - 0.95);
                rows.extend([u, v, 0.0]);
                rows.extend([0.0, v + 0.03, u]);
            }
        }
        PointCloud::new(3, rows).unwrap()
    }

    fn run(
        method: &Published,
        cloud: &PointCloud<f64>,
    ) -> Result<(Analysis, Stratification<f64>), Error> {
        let metric = Euclidean::new(cloud.clone());
        let oracle = BruteForceOracle::new(&metric);
        let estimator = PrincipalComponents::new(0.05)?;
        let analyzer = Analyzer {
            cloud,
            metric: &metric,
            oracle: &oracle,
            dimensions: Dimensions::Estimator(&estimator),
            models: &[],
            execute: &Serial,
        };
        let analysis = method.analyze(&analyzer)?;
        let out = method.stratify(
            &analyzer,
            &analysis,
            None,
            &RandomGreedy::new(),
            &ClassicalScaling,
        )?;
        Ok((analysis, out))
    }

    #[test]
    fn crossing_planes_are_divided_at_their_line() {
        let cloud = cross();
        // 0.05 from the line, and the tolerance is strict.
        let method = Published {
            ep: 0.06,
            ..published()
        };
        let (analysis, out) = run(&method, &cloud).unwrap();
        for (i, x) in cloud.iter().enumerate() {
            let near = x[0].abs().max(x[2].abs()) < 0.06;
            assert_eq!(analysis.roles[i] == Role::Curve, near, "{x:?}");
        }
        let on_curve = |k: u32| out.waist.strata[k as usize] == 1;
        let mut divided = 0;
        for near in &out.waist.neighborhoods {
            assert!(!on_curve(near.center));
            if analysis.dimensions[out.rows[near.center as usize]] != 3 {
                continue;
            }
            divided += 1;
            let sheet = |k: u32| cloud.point(out.rows[k as usize])[2] == 0.0;
            for &m in &near.members {
                assert!(on_curve(m) || sheet(m) == sheet(near.center));
            }
        }
        assert!(divided > 10, "{divided}");
        out.waist.check().unwrap();
    }

    #[test]
    fn landmarks_keep_their_separation_and_curves_come_first() {
        let cloud = cross();
        let method = Published {
            ep: 0.06,
            ..published()
        };
        let (analysis, out) = run(&method, &cloud).unwrap();
        assert!(out.counts.curve_landmarks >= 5);
        for (k, &row) in out.rows.iter().enumerate() {
            assert_eq!(
                analysis.roles[row] == Role::Curve,
                k < out.counts.curve_landmarks
            );
            for &other in &out.rows[..k] {
                assert!(cloud.squared_distance(row, other).sqrt() >= 0.2);
            }
        }
    }

    #[test]
    fn a_rejected_fit_leaves_the_neighborhood_whole() {
        let cloud = cross();
        // No pair of planes comes within dp of points with noise.
        let method = Published {
            dp: 1e-12,
            ep: 0.06,
            ..published()
        };
        let noisy: Vec<f64> = cloud
            .coordinates()
            .iter()
            .enumerate()
            .map(|(k, x)| x + 1e-3 * ((k * 7919 % 101) as f64 / 101.0 - 0.5))
            .collect();
        let cloud = PointCloud::new(3, noisy).unwrap();
        let (analysis, out) = run(&method, &cloud).unwrap();
        assert!(analysis.roles.iter().all(|&r| r == Role::Regular));
        assert!(!analysis.unexplained.is_empty());
        assert_eq!(analysis.unexplained.len(), analysis.candidates);
        for near in &out.waist.neighborhoods {
            let ball = out.rows.iter().filter(|&&r| {
                cloud
                    .squared_distance(r, out.rows[near.center as usize])
                    .sqrt()
                    < 0.5
            });
            assert_eq!(near.members.len(), ball.count());
        }
    }

    #[test]
    fn a_given_boundary_becomes_one_ring_of_one_cell() {
        // A disk of radius 1 with 40 points on its rim.
        let mut rows = Vec::new();
        for k in 0..40 {
            let t = f64::from(k) * std::f64::consts::TAU / 40.0;
            rows.extend([t.cos(), t.sin()]);
        }
        for k in 0..300 {
            let (r, t) = (0.9 * (f64::from(k) / 300.0).sqrt(), f64::from(k) * 2.39996);
            rows.extend([r * t.cos(), r * t.sin()]);
        }
        let cloud = PointCloud::new(2, rows).unwrap();
        let method = Published {
            surface: true,
            boundary: (0..40).collect(),
            ..published()
        };
        let (analysis, out) = run(&method, &cloud).unwrap();
        assert_eq!(analysis.roles[0], Role::Boundary);
        let ring = out.counts.curve_landmarks;
        assert!(ring >= 10);
        assert_eq!(out.waist.curve_edges.len(), ring);
        for k in 0..ring as u32 {
            let edges = out.waist.curve_edges.iter();
            let own = edges.filter(|e| e.ends.contains(&k) && e.cells == 1);
            assert_eq!(own.count(), 2, "landmark {k}");
        }
    }

    #[test]
    fn what_has_no_meaning_is_refused() {
        let cloud = cross();
        for method in [
            Published {
                dl: 0.0,
                ..published()
            },
            Published {
                tri_eps: f64::NAN,
                ..published()
            },
            Published {
                boundary: vec![9999],
                ..published()
            },
        ] {
            assert!(run(&method, &cloud).unwrap_err().is_input());
        }
    }
}
