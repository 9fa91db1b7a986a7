//! Ends that are near to each other: a row belongs to the region of one.

use super::region::{EndRegion, Settled};
use crosscap_core::{Label, PointCloud, Row, Scalar};

/// What a model says about the end of a curve.
pub(super) struct Answer {
    pub(super) region: EndRegion,
    pub(super) settled: Vec<Settled>,
    /// Radius of the analysis there.
    pub(super) eps: f64,
}

/// Regions that overlap reach half of the way to the other's point, or more where the other does not come
/// as near: a row belongs to one region alone. Labels reach `overlap` radii of the analysis farther than that.
pub(super) fn part<S: Scalar>(cloud: &PointCloud<S>, answers: &mut [Answer], overlap: f64) {
    let limits: Vec<f64> = (0..answers.len())
        .map(|k| {
            let own = &answers[k].region;
            let others = answers.iter().enumerate().filter(|x| x.0 != k);
            let limits = others.map(|(_, a)| {
                let apart = own.distance(&a.region.place);
                (apart / 2.0).max(apart - a.region.reach)
            });
            limits.fold(own.reach, f64::min)
        })
        .collect();
    for (answer, limit) in answers.iter_mut().zip(limits) {
        answer.cut(cloud, limit, overlap);
    }
}

impl Answer {
    /// Cuts the region where another curve begins that its model knows nothing of: farther from the point than the radius of
    /// the analysis, where the model says that a row is inside a cell, and the analysis, which did not see the end from there, that it is on a
    /// curve.
    pub(super) fn keep_clear<S: Scalar>(
        &mut self,
        cloud: &PointCloud<S>,
        is_on_curve: impl Fn(Row) -> bool,
        overlap: f64,
    ) {
        let inside = self
            .settled
            .iter()
            .filter(|x| x.on.is_none() && x.beside.is_none());
        let on_another = inside.filter(|x| is_on_curve(x.row));
        let far = on_another.map(|x| self.region.far(cloud, x.row));
        let limit = far
            .filter(|&far| far > self.eps)
            .fold(f64::INFINITY, f64::min);
        self.cut(cloud, limit, overlap);
    }

    /// Leaves of the region what is nearer than `limit` to its point.
    pub(super) fn cut<S: Scalar>(&mut self, cloud: &PointCloud<S>, limit: f64, overlap: f64) {
        let region = &mut self.region;
        if limit >= region.reach {
            return;
        }
        let far = |x: &(Row, Label)| region.far(cloud, x.0);
        let (own, mut beyond): (Vec<_>, Vec<_>) =
            (region.known().into_iter()).partition(|x| far(x) < limit);
        beyond.retain(|x| far(x) < limit + overlap * self.eps);
        (region.labels, region.beyond) = (own, beyond);
        region.reach = limit;
        self.settled.retain(|x| region.label(x.row).is_some());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stratify::site::FitUsed;
    use crosscap_core::{Decomposition, Stratum};

    /// A region about a place on a line of points one tenth apart.
    fn answer(cloud: &PointCloud<f64>, at: f64, reach: f64) -> Answer {
        let fit = Decomposition {
            strata: vec![Stratum { dimension: 2 }],
            labels: Vec::new(),
            cells_at_curve: Vec::new(),
            residual: 0.0,
            parameters: 0,
            points: vec![vec![at]],
            center: vec![at],
            center_offset: 0.0,
        };
        let used = FitUsed {
            model: 0,
            radius: 1.0,
        };
        let mut region = EndRegion::new([Vec::new(), Vec::new()], fit, vec![at], reach, used);
        let rows: Vec<Row> = (0..cloud.len())
            .map(Row::new)
            .filter(|&r| region.far(cloud, r) < reach)
            .collect();
        region.labels = rows.iter().map(|&r| (r, Label::new(0))).collect();
        let settled = |&row: &Row| Settled {
            row,
            on: None,
            beside: None,
        };
        Answer {
            settled: rows.iter().map(settled).collect(),
            region,
            eps: reach,
        }
    }

    #[test]
    fn a_region_ends_where_another_curve_begins() {
        let cloud = PointCloud::new(1, (0..31).map(|k| f64::from(k) / 10.0).collect()).unwrap();
        let reach_with = |on: &dyn Fn(usize) -> bool| {
            let mut answer = answer(&cloud, 1.52, 1.5);
            answer.eps = 0.5;
            answer.keep_clear(&cloud, |row| on(row.index()), 0.2);
            let rows = answer.region.rows();
            assert!(rows.eq(answer.settled.iter().map(|x| x.row)));
            answer.region.reach
        };
        // What is said of rows near the point was said by balls that hold it.
        for near in [12, 15, 20] {
            assert_eq!(reach_with(&|row| row == near), 1.5);
        }
        assert!((reach_with(&|row| row == 6 || row == 26) - 0.92).abs() < 1e-12);
    }

    #[test]
    fn no_row_is_in_two_regions() {
        let cloud = PointCloud::new(1, (0..31).map(|k| f64::from(k) / 10.0).collect()).unwrap();
        let all = [(0.51, 0.7), (1.53, 0.7), (2.8, 0.4)];
        let mut answers = all.map(|(at, reach)| answer(&cloud, at, reach));
        part(&cloud, &mut answers, 0.5);
        let reaches = answers.each_ref().map(|a| a.region.reach);
        // The first two meet half way; the third is clear of both.
        for (found, expected) in reaches.iter().zip([0.51, 0.51, 0.4]) {
            assert!((found - expected).abs() < 1e-12, "{reaches:?}");
        }
        for row in (0..cloud.len()).map(Row::new) {
            let holding = answers.iter().filter(|a| a.region.label(row).is_some());
            assert!(holding.count() <= 1, "{row}");
        }
        for a in &answers {
            assert_eq!(a.settled.len(), a.region.labels.len());
            assert!(!a.settled.is_empty());
        }
        // Those next to the cut are known to both.
        let known = answers.each_ref().map(|a| a.region.known());
        for row in [9, 11] {
            assert!(
                known[..2]
                    .iter()
                    .all(|k| k.contains(&(Row::new(row), Label::new(0)))),
                "{row}"
            );
        }
        assert_eq!(known[2].len(), answers[2].region.labels.len());
    }
}
