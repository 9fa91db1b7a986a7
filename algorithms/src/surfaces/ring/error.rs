//! Why the conformations of a ring were not drawn.

use crosscap_core::Error;

/// Why the conformations of a ring were not drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// The number of bond lengths, angles or reference places is not that of the atoms.
    #[error(
        "found {found} {what} in a ring of {atoms} atoms: give one an atom, in the order of the ring"
    )]
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// Number of atoms, which is that of the bond lengths.
        atoms: usize,
    },
    /// The conformations are not a surface.
    #[error(
        "a ring of {atoms} atoms has 3 x {atoms} - 6 coordinates up to rigid motion; {atoms} bond lengths and \
         {angles} bond angles that are fixed leave {freedom} degrees of freedom, and a surface has 2: {}",
        advice(*atoms, *angles, *freedom)
    )]
    DegreesOfFreedom {
        /// Number of atoms, and of bonds.
        atoms: usize,
        /// Number of bond angles that are fixed.
        angles: usize,
        /// 2 atoms - 6 - angles.
        freedom: i64,
    },
    /// A bond length is not a positive finite number.
    #[error("bond {bond} (from 0) has length {value}: expected a positive finite number")]
    Length {
        /// The bond from atom `bond` to the next one.
        bond: usize,
        /// Its length.
        value: f64,
    },
    /// A bond angle is outside its range.
    #[error(
        "the bond angle at atom {atom} (from 0) is {value} degrees: expected between 0 and 180"
    )]
    Angle {
        /// The atom.
        atom: usize,
        /// The angle, degrees.
        value: f64,
    },
    /// One bond is longer than all others together.
    #[error(
        "bond {bond} (from 0) has length {length}, and the others have {others} together: the ring \
         cannot close, shorten it"
    )]
    LongBond {
        /// The bond.
        bond: usize,
        /// Its length.
        length: f64,
        /// Sum of the lengths of the others.
        others: f64,
    },
    /// The angles are too wide: a closed polygon turns by 360 degrees at least, and by more unless it is plane and
    /// convex (Fenchel 1929).
    #[error(
        "the bond angles let the ring turn by {turn} degrees in all, and a ring that is not rigid turns by \
         more than 360: make the bond angles smaller"
    )]
    TooStraight {
        /// Sum of 180 - angle over the atoms, 180 where the angle is free; degrees.
        turn: f64,
    },
    /// No closed ring was found.
    #[error(
        "none of {starts} random starts led to a closed ring; the best leaves a distance wrong by \
         {deviation:.2e} (unit of the bond lengths): change the bond lengths or angles"
    )]
    NotClosed {
        /// Number of starts.
        starts: usize,
        /// Smallest over the starts of the largest deviation of a fixed distance.
        deviation: f64,
    },
    /// The fixed distances depend on each other, so that there are more degrees of freedom than counted.
    #[error(
        "at {singular} of {starts} random conformations the fixed distances depend on each other: with these lengths \
         and angles the conformations are no surface there, change a length or an angle a little"
    )]
    Dependent {
        /// Conformations at which they do.
        singular: usize,
        /// Conformations looked at.
        starts: usize,
    },
    /// The reference conformation says nothing about the rotation.
    #[error(
        "the places of the reference conformation are on a line or not finite: a rotation towards it is not \
         determined, give another reference"
    )]
    Reference,
    /// There are conformations that two rotations turn equally near to the reference.
    #[error(
        "there are conformations whose rotation towards the reference is not determined (margin {margin:.1e} of 1): \
         the aligned conformations are no continuous surface, give another reference conformation"
    )]
    Unaligned {
        /// See [`super::RingConformations::alignment_margin`].
        margin: f64,
    },
    /// The solver gave up too often.
    #[error(
        "the solver gave up on {given_up:.3} of the draws: the surface is too strongly bent (nearly \
         pinched) for these lengths and angles, change one a little"
    )]
    TooBent {
        /// Share of the draws, 0 to 1.
        given_up: f64,
    },
    /// Another input at fault.
    #[error(transparent)]
    Input(#[from] Error),
}

impl From<RingError> for Error {
    fn from(error: RingError) -> Self {
        match error {
            RingError::Input(error) => error,
            other => Self::Parameter {
                name: "ring",
                value: "not drawn".into(),
                expected: other.to_string(),
            },
        }
    }
}

fn advice(atoms: usize, angles: usize, freedom: i64) -> String {
    let many = |count: i64| if count == 1 { "angle" } else { "angles" };
    let missing = freedom - 2;
    if missing <= 0 && angles as i64 >= -missing {
        format!("leave {} bond {} free", -missing, many(-missing))
    } else if missing > 0 && (angles as i64 + missing) <= atoms as i64 {
        format!("fix {missing} more bond {}", many(missing))
    } else {
        "take a ring of 4 to 8 atoms".into()
    }
}
