//! Which points of which cells touch which curve landmarks.

use super::Rim;
use super::flood::Flood;
use crate::space::Space;
use crate::stratify::atlas::Reference;
use crate::stratify::skeleton::Skeleton;
use crate::stratify::strata::Strata;
use crate::tuning::CellTuning;
use crosscap_core::{Label, Landmark, Neighbor, PointCloud, Row, Scalar, Table};

/// A flood, and what of the contacts it reached.
pub(super) struct Hits {
    pub(super) flood: Flood,
    counts: Table<Rim, u32>,
    touched: Vec<Rim>,
}

impl Hits {
    pub(super) fn new(contacts: &Contacts) -> Self {
        Self {
            flood: Flood::default(),
            counts: Table::filled(contacts.groups.len(), 0),
            touched: Vec::new(),
        }
    }

    /// The landmarks that the flood reached and the curve landmarks at its rim, without `center`.
    pub(super) fn members(
        &mut self,
        contacts: &Contacts,
        landmark_at: &Table<Row, Option<Landmark>>,
        center: Landmark,
        inside: impl Fn(Landmark) -> bool,
    ) -> Vec<Landmark> {
        let mut members = Vec::new();
        self.touched.clear();
        for &row in &self.flood.reached {
            members.extend(landmark_at[row].filter(|&k| k != center));
            for &rim in contacts.of(row) {
                if self.counts[rim] == 0 {
                    self.touched.push(rim);
                }
                self.counts[rim] += 1;
            }
        }
        for &rim in &self.touched {
            let group = &contacts.groups[rim];
            let enough = 2 * self.counts[rim] as usize >= group.rows.len();
            self.counts[rim] = 0;
            if enough && group.landmark != center && inside(group.landmark) {
                members.push(group.landmark);
            }
        }
        members.sort_unstable();
        members.dedup();
        members
    }
}

/// One cell at one curve landmark.
pub(super) struct ContactGroup {
    pub(super) landmark: Landmark,
    /// The points of the cell nearest to the landmark.
    pub(super) rows: Vec<Row>,
}

/// Which points of which cells touch which curve landmarks.
pub(in crate::stratify) struct Contacts {
    pub(super) groups: Table<Rim, ContactGroup>,
    starts: Vec<u32>,
    entries: Vec<Rim>,
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
        let mut groups = Table::default();
        if let Some(places) = strata.places() {
            let mut near = Vec::new();
            for (landmark, &row) in skeleton.rows().each() {
                let reach = tuning.contact_reach * dl + strata.moved(row);
                space.oracle().within(row.index(), S::of(reach), &mut near);
                let fit = skeleton.labelling().find(|r| r.row == row);
                let mut cells = Self::cells(strata, places, fit, row, &near);
                if let Some(fit) = fit.filter(|_| landmark.index() >= skeleton.corners()) {
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
        row: Row,
        near: &[Neighbor<S>],
    ) -> Vec<Vec<(Label, f64, Row)>> {
        let mut cells: Vec<(Label, f64, Row)> = near
            .iter()
            .filter(|x| strata.is_regular(x.row()))
            .filter_map(|x| {
                let label = match fit {
                    None => Label::default(),
                    Some(r) => r.label(x.row()).filter(|&l| r.is_cell(l))?,
                };
                let square = places.squared_distance(row.index(), x.index);
                Some((label, square, x.row()))
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

    fn of_groups(groups: Table<Rim, ContactGroup>, n: usize) -> Self {
        let mut pairs: Vec<(Row, Rim)> = groups
            .each()
            .flat_map(|(rim, group)| group.rows.iter().map(move |&r| (r, rim)))
            .collect();
        pairs.sort_unstable();
        let mut starts = vec![0u32; n + 1];
        for &(r, _) in &pairs {
            starts[r.index() + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        Self {
            groups,
            starts,
            entries: pairs.into_iter().map(|(_, rim)| rim).collect(),
        }
    }

    /// The rows that touch a curve landmark, one after the other.
    pub(in crate::stratify) fn rows(&self) -> impl Iterator<Item = Row> {
        let groups = self.groups.iter();
        groups.flat_map(|group| group.rows.iter().copied())
    }

    /// The groups that a row belongs to.
    fn of(&self, row: Row) -> &[Rim] {
        let row = row.index();
        &self.entries[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}
