use super::*;
use crate::laws::instances::flat_sheet;
use crate::laws::twins::{each_is_caught, quick};
use crate::{Decomposition, Label, LocalPoints, Located, Rejection, Stratum};

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    WildLabel,
    FarPlace,
    NoCells,
    NineCells,
    LostRow,
    CenterForAll,
    CenterIsMiddle,
    UncountedCell,
    FittedLabels,
    CurvesLast,
    Unchecked,
    SignOfAxis,
    FirstRowIsCenter,
    AllRowsFitted,
    Offset,
    Refusing,
    NoResidual,
    TwoCells,
}

/// One flat cell, and a curve without points.
struct Twin(Fault);

impl SingularityModel for Twin {
    fn local_dimension(&self) -> usize {
        3
    }
    fn decompose(&self, local: &LocalPoints<'_>) -> Result<Decomposition, Rejection> {
        let (fitted, radius) = (local.fitted, local.radius);
        if fitted < 4 && self.0 != Fault::Unchecked {
            return Err(Rejection::TooFewPoints {
                found: fitted,
                needed: 4,
            });
        }
        let counted = if self.0 == Fault::AllRowsFitted {
            local.len()
        } else {
            fitted
        };
        let heights: f64 = (0..counted).map(|k| local.point(k)[2].powi(2)).sum();
        let free = if self.0 == Fault::Unchecked {
            counted as f64 - 3.0
        } else {
            counted as f64
        };
        let mut residual = (heights / free).sqrt();
        let mut labels = vec![1; local.len()];
        let mut strata = vec![Stratum { dimension: 1 }, Stratum { dimension: 2 }];
        let mut center = local.point(local.center).to_vec();
        let (mut cells, mut offset) = (1, f64::INFINITY);
        let norm = |k: usize| local.point(k).iter().map(|x| x * x).sum::<f64>().sqrt();
        match self.0 {
            Fault::WildLabel => labels[0] = 2,
            Fault::FarPlace => center[0] += 5.0 * radius,
            Fault::NineCells => cells = 9,
            Fault::NoCells => {
                // Two cells, and a curve that none of them meets.
                strata.push(Stratum { dimension: 2 });
                cells = 0;
            }
            Fault::UncountedCell => {
                cells = 0;
                for (k, label) in labels.iter_mut().enumerate() {
                    *label = usize::from(norm(k) > 0.2 * radius);
                }
            }
            Fault::FittedLabels => labels.truncate(fitted),
            Fault::CurvesLast => {
                strata.reverse();
                labels.fill(0);
            }
            Fault::SignOfAxis => {
                for (k, label) in labels.iter_mut().enumerate() {
                    *label = usize::from(local.point(k)[0] < 0.3 * radius);
                }
            }
            Fault::FirstRowIsCenter => center = local.point(0).to_vec(),
            Fault::CenterIsMiddle => {
                let center = local.point(local.center);
                let far = |k: usize| crate::squared_distance(local.point(k), center);
                for (k, label) in labels.iter_mut().enumerate() {
                    *label = usize::from(far(k) > 0.25 * radius * radius);
                }
            }
            Fault::Offset => residual += 1e-4 * radius,
            Fault::NoResidual => residual = 0.0,
            Fault::TwoCells => {
                strata.push(Stratum { dimension: 2 });
                cells = 2;
                for (k, label) in labels.iter_mut().enumerate() {
                    *label = 1 + usize::from(norm(k) > 0.6 * radius);
                }
            }
            Fault::Refusing if heights < 1e-12 => return Err(Rejection::NoRealSolution),
            _ => {}
        }
        let labels: Vec<Label> = labels.into_iter().map(Label::new).collect();
        let own = labels.get(local.center).map(|l| l.index());
        if own.and_then(|l| strata.get(l)) == Some(&Stratum { dimension: 1 }) {
            offset = 0.0;
        }
        Ok(Decomposition {
            strata,
            labels,
            cells_at_curve: vec![cells],
            residual,
            parameters: 3,
            points: Vec::new(),
            center,
            center_offset: offset,
        })
    }
    fn decompose_about(
        &self,
        local: &LocalPoints<'_>,
        rows: &[usize],
    ) -> Result<(Decomposition, Vec<Option<Located>>), Rejection> {
        let fit = self.decompose(local)?;
        let located = rows.iter().map(|&row| {
            let as_center = LocalPoints {
                center: row,
                ..*local
            };
            let fit = self.decompose(&as_center).ok()?;
            (row < fit.labels.len()).then(|| fit.located(row))
        });
        let mut located: Vec<Option<Located>> = located.collect();
        match self.0 {
            Fault::LostRow => drop(located.pop()),
            Fault::CenterForAll => {
                let center = fit.located(local.center);
                located.fill(Some(center));
            }
            // As a model does whose fit is thought to be that of any center.
            Fault::CenterIsMiddle => {
                for (found, &row) in located.iter_mut().zip(rows) {
                    let (place, dimension) = (local.point(row).to_vec(), fit.dimension_of(row));
                    *found = Some(Located {
                        dimension,
                        cells: 1,
                        place,
                        offset: if dimension < 2 { 0.0 } else { f64::INFINITY },
                    });
                }
            }
            _ => {}
        }
        Ok((fit, located))
    }
    fn name(&self) -> &str {
        "twin"
    }
}

#[test]
fn every_fault_is_caught_by_its_law() {
    let put = |fault| model(&quick(), &Twin(fault), &Instances::new(&flat_sheet));
    let faults: &[(Fault, &Law)] = &[
        (Fault::WildLabel, &PARTITION),
        (Fault::FarPlace, &PARTITION),
        (Fault::NoCells, &PARTITION),
        (Fault::NineCells, &PARTITION),
        (Fault::LostRow, &ABOUT),
        (Fault::CenterForAll, &ABOUT),
        (Fault::CenterIsMiddle, &ABOUT),
        (Fault::UncountedCell, &CELLS),
        (Fault::FittedLabels, &PARTITION),
        (Fault::CurvesLast, &PARTITION),
        (Fault::Unchecked, &PARTITION),
        (Fault::SignOfAxis, &MOTION),
        (Fault::FirstRowIsCenter, &ORDER),
        (Fault::AllRowsFitted, &FITTED),
        (Fault::Offset, &EXACT),
        (Fault::Refusing, &EXACT),
        (Fault::NoResidual, &NOISE),
        (Fault::TwoCells, &TRUTH),
    ];
    each_is_caught(put, Fault::None, faults);
}
