//! One fit of a neighborhood that is asked about many of its points.

use crosscap_core::{Decomposition, Located, Rejection};
use nalgebra::Vector3;

/// A fit that does not depend on which of the points is the center.
///
/// The fit is what takes time, and what it says of one point is said in the same way of all: the center of the decomposition is only
/// the first that is asked for.
pub(super) trait OneFit: Sized {
    /// What is said of a row; `None` of one that is in the band of a stratum which cannot be found there.
    fn located(&self, row: usize) -> Option<Located>;

    /// The decomposition about a center of which this is said.
    fn decomposition(self, center: Located) -> Decomposition;

    /// The decomposition about the center, and what is said of `rows`.
    ///
    /// # Errors
    /// [`Rejection::NoRealSolution`] where nothing can be said of the center.
    fn about(
        self,
        center: usize,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        let center = self.located(center).ok_or(Rejection::NoRealSolution)?;
        let located = rows.iter().map(|&row| self.located(row)).collect();
        Ok((self.decomposition(center), located))
    }
}

/// What is said of the point `x`, on a stratum of a dimension that `cells` meet in: the place that it is moved to, or none where it
/// does not tell of any.
pub(super) fn located(
    x: Vector3<f64>,
    dimension: u8,
    cells: u8,
    place: Option<Vector3<f64>>,
) -> Located {
    Located {
        dimension,
        cells,
        place: place.unwrap_or(x).iter().copied().collect(),
        offset: place.map_or(f64::INFINITY, |p| (p - x).norm()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crosscap_core::{Label, Stratum};

    /// Points of a line that are moved to the origin, but for those beyond 1.
    struct Line(Vec<f64>);

    impl OneFit for Line {
        fn located(&self, row: usize) -> Option<Located> {
            let x = Vector3::x() * self.0[row];
            (x.norm() <= 1.0).then(|| located(x, 1, 4, Some(Vector3::zeros())))
        }

        fn decomposition(self, center: Located) -> Decomposition {
            Decomposition {
                strata: vec![Stratum { dimension: 1 }],
                labels: vec![Label::new(0); self.0.len()],
                cells_at_curve: vec![4],
                residual: 0.0,
                parameters: 1,
                points: Vec::new(),
                center: center.place,
                center_offset: center.offset,
            }
        }
    }

    #[test]
    fn the_center_is_told_as_every_other_row_is() {
        let line = || Line(vec![0.5, -0.25, 2.0]);
        let (fit, located) = line().about(1, &[0, 1, 2]).unwrap();
        assert_eq!(fit.center_offset, 0.25);
        let offsets: Vec<Option<f64>> =
            (located.iter().map(|x| x.as_ref().map(|x| x.offset))).collect();
        assert_eq!(offsets, [Some(0.5), Some(0.25), None]);
        assert!(matches!(
            line().about(2, &[0]),
            Err(Rejection::NoRealSolution)
        ));
    }
}
