//! The points about the end of a curve.

use super::Answer;
use crate::stratify::site::On;
use crate::stratify::strata::Strata;
use crosscap_core::{Decomposition, Label, PointCloud, Row, Scalar, squared_distance};

/// A point at which a curve ends, with the points about it.
#[derive(Clone, Debug)]
pub(in crate::stratify) struct EndRegion {
    /// Rows of the region with their labels, by row.
    pub(in crate::stratify) labels: Vec<(Row, Label)>,
    /// Rows beyond it with the labels that they have by its fit.
    beyond: Vec<(Row, Label)>,
    /// The strata, without the labels.
    pub(in crate::stratify) fit: Decomposition,
    /// Place of the point.
    pub(in crate::stratify) place: Vec<f64>,
    /// How far from it the region reaches.
    pub(in crate::stratify) reach: f64,
}

/// What becomes of a row of a region.
pub(in crate::stratify) struct Settled {
    pub(in crate::stratify) row: Row,
    /// On which stratum it is, `None` inside a cell.
    pub(in crate::stratify) on: Option<On>,
    /// The curve that a row of a cell is near.
    pub(in crate::stratify) beside: Option<On>,
}

impl EndRegion {
    /// The rows nearer than `reach` to `place`, each with its label and by row, some beyond, and the strata that the
    /// labels name.
    pub(in crate::stratify) fn new(
        [labels, beyond]: [Vec<(Row, Label)>; 2],
        fit: Decomposition,
        place: Vec<f64>,
        reach: f64,
    ) -> Self {
        Self {
            labels,
            beyond,
            fit,
            place,
            reach,
        }
    }

    /// Rows with their labels, by row: those of the region, and those beyond.
    pub(in crate::stratify) fn known(&self) -> Vec<(Row, Label)> {
        let mut all = [&self.labels[..], &self.beyond[..]].concat();
        all.sort_unstable();
        all
    }

    /// The label of a row.
    pub(in crate::stratify) fn label(&self, row: Row) -> Option<Label> {
        let at = self.labels.binary_search_by_key(&row, |x| x.0).ok()?;
        Some(self.labels[at].1)
    }

    /// Its rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = Row> {
        self.labels.iter().map(|x| x.0)
    }

    /// Whether a label names a cell.
    pub(in crate::stratify) fn is_cell(&self, label: Label) -> bool {
        self.fit.is_of(label, 2)
    }

    /// How far a place is from the point.
    pub(super) fn distance(&self, place: &[f64]) -> f64 {
        squared_distance(&self.place, place).sqrt()
    }

    /// How far a row of the cloud is from the point.
    pub(super) fn far<S: Scalar>(&self, cloud: &PointCloud<S>, row: Row) -> f64 {
        let own = cloud.point(row.index()).iter().map(|x| x.as_f64());
        let squares = own.zip(&self.place).map(|(x, p)| (x - p) * (x - p));
        squares.sum::<f64>().sqrt()
    }
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
        let region = &mut answer.region;
        if limit < region.reach {
            let far = |x: &(Row, Label)| region.far(cloud, x.0);
            let (own, mut beyond): (Vec<_>, Vec<_>) =
                (region.known().into_iter()).partition(|x| far(x) < limit);
            beyond.retain(|x| far(x) < limit + overlap * answer.eps);
            (region.labels, region.beyond) = (own, beyond);
            region.reach = limit;
            answer.settled.retain(|x| region.label(x.row).is_some());
        }
    }
}

/// The regular row nearest to the point of every region in each of its cells, at most `within` from it, but as
/// clear of the curves as can be: without a landmark there the triangle between two curves would be that of
/// several cells.
pub(in crate::stratify) fn innermost(strata: &Strata, within: f64) -> Vec<Row> {
    let Some(places) = strata.places() else {
        return Vec::new();
    };
    let mut out = Vec::new();
    for region in strata.regions() {
        let on_curves: Vec<Row> = region.rows().filter(|&r| !strata.is_regular(r)).collect();
        let clear = |row: Row| {
            let squares = on_curves.iter();
            let squares = squares.map(|c| places.squared_distance(row.index(), c.index()));
            squares.fold(f64::INFINITY, f64::min)
        };
        for label in region.fit.labels_of(2) {
            let own = region.labels.iter().filter(|x| x.1 == label);
            let near = own.map(|x| x.0).filter(|&row| {
                strata.is_regular(row) && region.distance(places.point(row.index())) < within
            });
            let best = near.max_by(|&a, &b| clear(a).total_cmp(&clear(b)).then(b.cmp(&a)));
            out.extend(best);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::Stratum;

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
        let mut region = EndRegion::new([Vec::new(), Vec::new()], fit, vec![at], reach);
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
