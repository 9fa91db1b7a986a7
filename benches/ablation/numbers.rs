//! The numbers, each by its name, with what takes it out.

use crosscap_algorithms::stratify::Tuning;

/// A number of the tuning.
enum Place<'t> {
    Length(&'t mut f64),
    Count(&'t mut usize),
    /// What something is multiplied with: what it is above or below 1 is halved and doubled.
    Factor(&'t mut f64),
}

/// A number by its name, and its value where what it does is taken out, if there is one.
pub struct Number {
    pub name: &'static str,
    place: fn(&mut Tuning) -> Place<'_>,
    pub out: Option<f64>,
}

macro_rules! numbers {
    (@out) => { None };
    (@out $out:expr) => { Some($out) };
    ($($kind:ident $stage:ident.$field:ident $(.$inner:ident)* $([$index:literal])? $(out $out:expr)?;)+) => {
        &[$(Number {
            name: concat!(stringify!($stage), ".", stringify!($field) $(, ".", stringify!($inner))* $(, "[", stringify!($index), "]")?),
            place: |tuning| Place::$kind(&mut tuning.$stage.$field$(.$inner)*$([$index])?),
            out: numbers!(@out $($out)?),
        }),+]
    };
}

/// Every number that decides something about a surface.
pub const NUMBERS: &[Number] = numbers! {
    Count analysis.least_neighbors out 3.0;
    Count analysis.most_fitted out 1e6;
    Factor analysis.shrink;
    Count analysis.shrinks out 0.0;
    Length analysis.gain out 1.0;
    Length analysis.flat out 0.0;
    Length analysis.unexplained_share out 1.0;
    Length analysis.beside out 0.0;
    Length analysis.beside_spacing out 0.0;
    Length analysis.inner_ball;
    Length analysis.witness_reach out 0.0;
    Length analysis.apex_reach out 0.0;
    Length analysis.fit_spacings[0];
    Length analysis.fit_spacings[1];
    Length analysis.speaks_for out 0.0;
    Factor analysis.label_margin out 1.0;
    Length ends.shift out 0.0;
    Length ends.radii[0];
    Length ends.radii[1];
    Length ends.radii[2];
    Length ends.radii[3];
    Length ends.radii[4];
    Length ends.radii[5];
    Length ends.behind;
    Length ends.widest;
    Factor ends.spare out 1.0;
    Length ends.off_center;
    Count ends.attempts out 1.0;
    Length ends.gap out 0.0;
    Length ends.overlap out 0.0;
    Length ends.innermost out 1e6;
    Length skeleton.node_spacing;
    Length skeleton.reach;
    Length skeleton.bare_reach;
    Length skeleton.bridge out 0.0;
    Length skeleton.end_separation;
    Length skeleton.join out 0.0;
    Count skeleton.stretches out 1.0;
    Length skeleton.bare_gap;
    Length skeleton.bare_chance out 0.0;
    Length skeleton.beside_way;
    Length skeleton.stretch_step;
    Length skeleton.label_spacing;
    Length cells.label_reach;
    Count cells.contacts out 1.0;
    Length cells.contact_reach;
    Length cells.curve_gap;
    Count cells.least_members out 0.0;
    Factor cells.widening;
    Count cells.widenings out 0.0;
    Length refinement.stray;
    Length refinement.separation out 0.0;
    Length refinement.look;
    Factor refinement.growth;
    Count refinement.rounds out 0.0;
    Length refinement.behind;
    Count refinement.company out 1.0;
    Length refinement.nearer out 0.0;
    Count refinement.mends out 0.0;
    Length refinement.open_share out 1.0;
    Length cells.flat out 0.0;
    Count front.drops out 0.0;
    Count front.attempts out 0.0;
    Count front.curve_passes out 0.0;
    Count front.shortcut_steps out 0.0;
    Length models.two_planes.cell_share out 0.0;
    Length models.two_planes.narrowness out 0.0;
    Length models.two_planes.astray out 1.0;
    Length models.two_planes.step;
    Length models.two_planes.support;
    Length models.two_planes.witness out 0.0;
    Length models.two_planes.sine out 0.0;
    Length models.y_junction.plane;
    Length models.y_junction.along out 1.0;
    Length models.y_junction.sine out 0.0;
    Length models.y_junction.beyond out 1.0;
    Length models.triple_point.plane;
    Length models.triple_point.sheet_share out 0.0;
    Length models.triple_point.determinant out 0.0;
    Length models.triple_point.reach;
    Count models.triple_point.cells out 0.0;
    Length models.isolated_crossing.plane;
    Length models.isolated_crossing.sheet_share out 0.0;
    Length models.isolated_crossing.determinant out 0.0;
    Length models.isolated_crossing.reach;
    Length models.isolated_crossing.fourth out 0.0;
    Length models.boundary.shift out 0.0;
    Length models.boundary.breadth out 0.0;
    Length models.boundary.missing out 0.0;
    Length models.boundary.bend out 1e6;
    Length models.boundary.step;
    Length models.boundary.witness out 0.0;
    Length models.curve_and_sheet.plane;
    Length models.curve_and_sheet.reach;
    Length models.curve_and_sheet.clear out 0.0;
    Count models.curve_and_sheet.arc;
    Length models.pinch_point.end.astray out 1.0;
    Length models.pinch_point.end.reach;
    Length models.pinch_point.end.witness out 0.0;
    Length models.pinch_point.fold_length out 0.0;
    Length models.pinch_point.fold out 0.0;
    Length models.book.astray out 1.0;
    Length models.book.share out 0.0;
    Length models.book.step;
    Length models.book.witness out 0.0;
    Length models.book.support out 1.0;
    Length models.book.pages.flat out 1.0;
    Length models.book.pages.aside out 0.0;
    Length models.book.pages.tilt out 1.0;
    Length models.book.pages.across out 0.0;
    Length models.book.pages.near out 0.0;
    Length models.book.pages.gap;
    Length models.book.pages.widest out 7.0;
    Length models.book.pages.share out 0.0;
    Length models.book.pages.straight out 0.0;
    Length models.book.pages.sine out 0.0;
    Length models.book.pages.out;
    Length models.book_end.end.astray out 1.0;
    Length models.book_end.end.reach;
    Length models.book_end.end.witness out 0.0;
    Length models.book_end.pages.flat out 1.0;
    Length models.book_end.pages.aside out 0.0;
    Length models.book_end.pages.tilt out 1.0;
    Length models.book_end.pages.across out 0.0;
    Length models.book_end.pages.near out 0.0;
    Length models.book_end.pages.gap;
    Length models.book_end.pages.widest out 7.0;
    Length models.book_end.pages.share out 0.0;
    Length models.book_end.pages.straight out 0.0;
    Length models.book_end.pages.sine out 0.0;
    Length models.book_end.pages.out;
    Length models.book_end.rim.missing out 0.0;
    Length models.book_end.rim.bend out 1e6;
    Length models.book_end.rim.open;
    Length models.book_end.crossing out 0.0;
    Length models.book_end.apart;
    Length models.book_end.apart_ep;
    Length models.book_end.step;
    Length models.cone_point.sharpness;
    Length models.cone_point.reach;
    Length models.cone_point.neck;
    Length models.cone_point.astray out 1.0;
    Length models.boundary_corner.reach out 10.0;
    Length models.boundary_corner.arm_bend;
    Length models.boundary_corner.smooth[0];
    Length models.boundary_corner.smooth[1];
    Length models.boundary_corner.smooth[2];
    Length models.boundary_corner.missing out 0.0;
    Length models.boundary_corner.tip out 1e6;
    Length models.boundary_corner.arm out 1e6;
    Length models.boundary_corner.witness out 0.0;
};

impl Number {
    /// What the program runs with.
    pub fn value(&self) -> f64 {
        match (self.place)(&mut Tuning::MEASURED.clone()) {
            Place::Length(x) | Place::Factor(x) => *x,
            Place::Count(n) => *n as f64,
        }
    }

    /// The tuning with the number multiplied.
    pub fn times(&self, factor: f64) -> Tuning {
        match (self.place)(&mut Tuning::MEASURED.clone()) {
            Place::Factor(x) => self.at(1.0 + (*x - 1.0) * factor),
            _ => self.at(self.value() * factor),
        }
    }

    /// The tuning with the number replaced.
    pub fn at(&self, value: f64) -> Tuning {
        let mut tuning = Tuning::MEASURED;
        self.set(&mut tuning, value);
        tuning
    }

    /// Takes what the number does out of a tuning, if it can be.
    pub fn take_out(&self, tuning: &mut Tuning) {
        if let Some(value) = self.out {
            self.set(tuning, value);
        }
    }

    fn set(&self, tuning: &mut Tuning, value: f64) {
        match (self.place)(tuning) {
            Place::Length(x) | Place::Factor(x) => *x = value,
            Place::Count(n) => *n = value.round() as usize,
        }
    }
}
