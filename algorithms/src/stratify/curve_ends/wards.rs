//! Floods that keep to a cell about the end of a curve.

use crate::stratify::strata::Strata;
use crosscap_core::{Label, Row, Table};

/// Which cell of which region every row is in: a flood that starts well inside one does not come back to
/// the others by a way around the ends of the curves between them.
pub(in crate::stratify) struct Wards<'a> {
    strata: &'a Strata,
    /// Empty where there is no region.
    cells: Table<Row, Option<Ward>>,
    dl: f64,
}

/// A cell of a region.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::stratify) struct Ward {
    region: u32,
    cell: Label,
}

impl<'a> Wards<'a> {
    /// The wards of all regions; charts are laid over landmarks some `dl` apart.
    pub(in crate::stratify) fn new(strata: &'a Strata, dl: f64) -> Self {
        let mut cells = match strata.regions() {
            [] => Table::default(),
            _ => Table::filled(strata.len(), None),
        };
        for (name, region) in (0u32..).zip(strata.regions()) {
            for &(row, cell) in region.labels.iter().filter(|x| region.is_cell(x.1)) {
                cells[row] = Some(Ward { region: name, cell });
            }
        }
        Self { strata, cells, dl }
    }

    /// The cell that a flood from `row` that goes `about` the row of a landmark keeps to; `None` near the rim of its region, where
    /// all cells come together.
    pub(in crate::stratify) fn of(&self, about: Row, row: Row) -> Option<Ward> {
        let ward = (*self.cells.get(row)?)?;
        let region = &self.strata.regions()[ward.region as usize];
        let place = self.strata.places()?.point(about.index());
        (region.distance(place) < region.reach - self.dl).then_some(ward)
    }

    /// Whether a flood that keeps to a ward may reach `row`.
    pub(in crate::stratify) fn admits(&self, ward: Option<Ward>, row: Row) -> bool {
        let (Some(own), Some(Some(there))) = (ward, self.cells.get(row)) else {
            return true;
        };
        there.region != own.region || there.cell == own.cell
    }
}
