//! Many points explained by few fits: the fit of a neighborhood says for all points near its
//! center what a fit of their own would say.

use super::explain::Verdict;
use super::fitter::{Fitter, Scratch};
use super::options::AnalysisOptions;
use crate::execute;
use crosscap_core::{Row, Scalar, Table};

/// Fits that a job takes at a time.
pub(super) const FITS_AT_ONCE: usize = 8;

/// A row that is to be explained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Asked {
    pub(super) row: Row,
    /// Fits are made about the points of the fullest neighborhoods first: those in the middle
    /// of a crossing, where both sheets show best.
    pub(super) neighbors: usize,
}

impl<S: Scalar> Fitter<'_, S> {
    /// Explains rows of one local `dimension`, `(row, verdict)` for each in any order. With `thorough` every row
    /// for which no fit of another speaks gets its own; without, it is left out.
    pub(super) fn explain_all(
        &self,
        mut asked: Vec<Asked>,
        dimension: usize,
        options: &AnalysisOptions,
        thorough: bool,
    ) -> Vec<(Row, Verdict)> {
        self.sort(&mut asked);
        let mut out = Vec::with_capacity(asked.len());
        let mut place_of = Table::filled(self.cloud.len(), u32::MAX);
        // A curve alone is not what fits speak for.
        let spacings = if dimension > 2 {
            &self.tuning.analysis.fit_spacings[..]
        } else {
            &[]
        };
        for spacing in spacings {
            let groups = self.groups(&asked, spacing * options.eps, &mut place_of);
            let found = execute::map_blocks(
                self.execute,
                FITS_AT_ONCE,
                groups.len(),
                Scratch::default,
                |scratch, g| {
                    let Group { center, others } = &groups[g];
                    self.explain(*center, others, dimension, options, scratch)
                },
            );
            let mut open = Vec::new();
            for (group, (verdict, others)) in groups.iter().zip(found) {
                if verdict.is_unexplained() {
                    open.extend(&group.others);
                }
                out.push((group.center, verdict));
                for (&row, verdict) in group.others.iter().zip(others) {
                    match verdict {
                        Some(verdict) => out.push((row, verdict)),
                        None => open.push(row),
                    }
                }
            }
            let mut left: Table<Row, bool> = Table::filled(self.cloud.len(), false);
            open.iter().for_each(|&row| left[row] = true);
            asked.retain(|a| left[a.row]);
        }
        if thorough {
            let alone = execute::map_blocks(
                self.execute,
                FITS_AT_ONCE,
                asked.len(),
                Scratch::default,
                |scratch, k| {
                    self.explain(asked[k].row, &[], dimension, options, scratch)
                        .0
                },
            );
            out.extend(asked.iter().map(|a| a.row).zip(alone));
        }
        out
    }

    /// Fullest first, and by what neither a motion nor the order of the rows changes.
    fn sort(&self, asked: &mut [Asked]) {
        let mut mean = vec![0.0; self.cloud.dimension()];
        for a in asked.iter() {
            for (m, x) in mean.iter_mut().zip(self.cloud.point(a.row.index())) {
                *m += x.as_f64() / asked.len() as f64;
            }
        }
        let far = |a: &Asked| -> f64 {
            let place = self.cloud.point(a.row.index()).iter().map(|x| x.as_f64());
            place.zip(&mean).map(|(x, m)| (x - m) * (x - m)).sum()
        };
        asked.sort_by_cached_key(|a| {
            // Nonnegative numbers order like their bits.
            (std::cmp::Reverse(a.neighbors), far(a).to_bits(), a.row)
        });
    }

    /// Centers in the order of `asked`, no two of them closer than `spacing`, each with the rows to
    /// which it is the nearest.
    fn groups(&self, asked: &[Asked], spacing: f64, place_of: &mut Table<Row, u32>) -> Vec<Group> {
        for (k, a) in asked.iter().enumerate() {
            place_of[a.row] = k as u32;
        }
        let mut owner = vec![(f64::INFINITY, u32::MAX); asked.len()];
        let mut groups: Vec<Group> = Vec::new();
        let mut near = Vec::new();
        for k in 0..asked.len() {
            if owner[k].1 != u32::MAX {
                continue;
            }
            let center = asked[k].row;
            let oracle = self.space.oracle();
            oracle.indices_within(center.index(), S::of(spacing), &mut near);
            for row in near.iter().copied().map(Row::from) {
                let at = place_of[row];
                if at == u32::MAX {
                    continue;
                }
                let square = self.square(center, row);
                if square < owner[at as usize].0 {
                    owner[at as usize] = (square, groups.len() as u32);
                }
            }
            owner[k] = (0.0, groups.len() as u32);
            groups.push(Group {
                center,
                others: Vec::new(),
            });
        }
        for (a, &(_, g)) in asked.iter().zip(&owner) {
            place_of[a.row] = u32::MAX;
            let group = &mut groups[g as usize];
            if group.center != a.row {
                group.others.push(a.row);
            }
        }
        groups
    }
}

/// A center with the rows that its fit is asked about.
struct Group {
    center: Row,
    others: Vec<Row>,
}
