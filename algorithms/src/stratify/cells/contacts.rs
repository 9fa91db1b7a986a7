//! Which points of which cells touch which curve landmarks.

use super::NONE;
use super::flood::Flood;
use crate::space::Space;
use crate::stratify::atlas::Reference;
use crate::stratify::skeleton::Skeleton;
use crate::stratify::strata::Strata;
use crate::tuning::CellTuning;
use crosscap_core::{Neighbor, PointCloud, Scalar};

/// A flood, and what of the contacts it reached.
pub(super) struct Hits {
    pub(super) flood: Flood,
    counts: Vec<u32>,
    touched: Vec<u32>,
}

impl Hits {
    pub(super) fn new(contacts: &Contacts) -> Self {
        Self {
            flood: Flood::default(),
            counts: vec![0; contacts.groups.len()],
            touched: Vec::new(),
        }
    }

    /// The landmarks that the flood reached and the curve landmarks at its rim, without `center`.
    pub(super) fn members(
        &mut self,
        contacts: &Contacts,
        landmark_at: &[u32],
        center: usize,
        inside: impl Fn(usize) -> bool,
    ) -> Vec<u32> {
        let mut members = Vec::new();
        self.touched.clear();
        for &row in &self.flood.reached {
            let k = landmark_at[row as usize];
            if k != NONE && k as usize != center {
                members.push(k);
            }
            for &g in contacts.of(row as usize) {
                if self.counts[g as usize] == 0 {
                    self.touched.push(g);
                }
                self.counts[g as usize] += 1;
            }
        }
        for &g in &self.touched {
            let group = &contacts.groups[g as usize];
            let enough = 2 * self.counts[g as usize] as usize >= group.rows.len();
            self.counts[g as usize] = 0;
            if enough && group.landmark != center && inside(group.landmark) {
                members.push(group.landmark as u32);
            }
        }
        members.sort_unstable();
        members.dedup();
        members
    }
}

/// One cell at one curve landmark.
pub(super) struct ContactGroup {
    pub(super) landmark: usize,
    /// The points of the cell nearest to the landmark.
    pub(super) rows: Vec<u32>,
}

/// Which points of which cells touch which curve landmarks.
pub(in crate::stratify) struct Contacts {
    pub(super) groups: Vec<ContactGroup>,
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Contacts {
    /// The contacts of the curve landmarks of a skeleton.
    pub(in crate::stratify) fn new<S: Scalar>(
        space: &Space<'_, S>,
        strata: &Strata,
        skeleton: &Skeleton,
        tuning: &CellTuning,
        dl: f64,
    ) -> Self {
        let mut groups = Vec::new();
        if let Some(places) = strata.places() {
            let mut near = Vec::new();
            for (landmark, &row) in skeleton.rows().iter().enumerate() {
                let reach = tuning.contact_reach * dl + strata.moved(row);
                space.oracle().within(row, S::of(reach), &mut near);
                let fit = skeleton.labelling().find(|r| r.row == row);
                let mut cells = Self::cells(strata, places, fit, row, &near);
                if let Some(fit) = fit.filter(|_| landmark >= skeleton.corners()) {
                    // A fit may know of cells that do not touch this curve: those are farther away.
                    let own = fit.label(row).and_then(|l| fit.fit.cells_at(l));
                    cells.sort_by(|a, b| a[0].1.total_cmp(&b[0].1).then(a[0].0.cmp(&b[0].0)));
                    cells.truncate(own.unwrap_or(strata.cells(row)).into());
                    cells.sort_by_key(|cell| cell[0].0);
                }
                groups.extend(cells.iter().map(|cell| ContactGroup {
                    landmark,
                    rows: cell.iter().take(tuning.contacts).map(|x| x.2).collect(),
                }));
            }
        }
        Self::of_groups(groups, strata.len())
    }

    /// The regular points near a curve landmark, cell by cell: label, squared distance, row; nearest first.
    fn cells<S: Scalar>(
        strata: &Strata,
        places: &PointCloud<f64>,
        fit: Option<&Reference>,
        row: usize,
        near: &[Neighbor<S>],
    ) -> Vec<Vec<(u8, f64, u32)>> {
        let mut cells: Vec<(u8, f64, u32)> = near
            .iter()
            .filter(|x| strata.is_regular(x.index))
            .filter_map(|x| {
                let label = match fit {
                    None => 0,
                    Some(r) => r.label(x.index).filter(|&l| r.is_cell(l))?,
                };
                Some((label, places.squared_distance(row, x.index), x.index as u32))
            })
            .collect();
        cells.sort_by(|a, b| {
            (a.0.cmp(&b.0))
                .then(a.1.total_cmp(&b.1))
                .then(a.2.cmp(&b.2))
        });
        cells
            .chunk_by(|a, b| a.0 == b.0)
            .map(<[_]>::to_vec)
            .collect()
    }

    fn of_groups(groups: Vec<ContactGroup>, n: usize) -> Self {
        let mut pairs: Vec<(u32, u32)> = groups
            .iter()
            .enumerate()
            .flat_map(|(g, group)| group.rows.iter().map(move |&r| (r, g as u32)))
            .collect();
        pairs.sort_unstable();
        let mut starts = vec![0u32; n + 1];
        for &(r, _) in &pairs {
            starts[r as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        Self {
            groups,
            starts,
            entries: pairs.into_iter().map(|(_, g)| g).collect(),
        }
    }

    /// The groups that a row belongs to.
    fn of(&self, row: usize) -> &[u32] {
        &self.entries[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}
