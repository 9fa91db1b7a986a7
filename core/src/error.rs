//! What can go wrong, each with the place, the value and what to change.

use thiserror::Error;

/// Why a computation gave no answer.
///
/// Two families: *bad input* ([`Error::is_input`]), which no parameter but the
/// offending one can mend, and *failure of the method on this data*, which names
/// where it failed and which parameter to move.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// An array has the wrong shape.
    #[error("found {found}, expected {expected}")]
    Shape {
        /// What was given.
        found: String,
        /// What was expected instead.
        expected: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("row {row}, column {column} is not a finite number")]
    NotFinite {
        /// Row of the offending coordinate (the point), counted from 0.
        row: usize,
        /// Column of the offending coordinate, counted from 0.
        column: usize,
    },
    /// A parameter is outside the range in which it has a meaning.
    #[error("parameter {name} is {value}, expected {expected}")]
    Parameter {
        /// Name of the parameter as the user gives it.
        name: &'static str,
        /// The value that was given.
        value: String,
        /// The range that would be accepted.
        expected: String,
    },
    /// An index points outside the data.
    #[error("{what} {index} is out of range, there are {limit}")]
    Index {
        /// What is indexed.
        what: &'static str,
        /// The offending index.
        index: usize,
        /// How many there are.
        limit: usize,
    },
    /// A neighborhood holds too few points to say anything.
    #[error(
        "point {point} has {found} points within its neighborhood, at least {needed} are needed: \
         increase {parameter} or sample more densely"
    )]
    SparseNeighborhood {
        /// Index of the point.
        point: usize,
        /// Number of points found, the point itself included.
        found: usize,
        /// Number of points needed.
        needed: usize,
        /// The parameter to change.
        parameter: &'static str,
    },
    /// Too many neighborhoods that are neither 2-dimensional nor explained by a singularity model.
    #[error(
        "the neighborhoods of {count} points look like no surface and no crossing \
         (first: point {point}, local dimension {dimension}): change {parameter}"
    )]
    Dimension {
        /// The first such point.
        point: usize,
        /// Its dimension estimate.
        dimension: usize,
        /// How many such points there are.
        count: usize,
        /// The parameter to change.
        parameter: &'static str,
    },
    /// The triangulation could not be completed.
    #[error("{reason} at landmark {landmark}{}: change {parameter}", .point.map_or(String::new(), |p| format!(" (point {p})")))]
    Triangulation {
        /// What went wrong.
        reason: String,
        /// The landmark at which it went wrong.
        landmark: usize,
        /// Row of the input that the landmark stands for, if it is one.
        point: Option<usize>,
        /// The parameter to change.
        parameter: &'static str,
    },
    /// A plug-in returned something that breaks the law of its trait.
    #[error("plug-in {plugin} broke the law '{law}' at point {point}: {detail}")]
    Law {
        /// Name of the plug-in.
        plugin: String,
        /// The law, as the trait's documentation words it.
        law: &'static str,
        /// The point at which it happened.
        point: usize,
        /// What was returned.
        detail: String,
    },
    /// What is kept outside of memory could not be fetched: a tile in a file, say.
    #[error("cannot fetch {what}: {reason}")]
    Storage {
        /// What was wanted.
        what: String,
        /// What the system said.
        reason: String,
    },
    /// The run was stopped from outside before it had a result.
    #[error("stopped before there was a result")]
    Interrupted,
}

/// The value of a parameter that is a length, if it is one: positive and finite.
///
/// # Errors
/// [`Error::Parameter`] with the name otherwise.
///
/// ```
/// use crosscap_core::positive_length;
/// assert_eq!(positive_length("eps", 0.25)?, 0.25);
/// let error = positive_length("eps", f64::NAN).unwrap_err();
/// assert!(error.to_string().contains("eps"), "{error}");
/// # Ok::<(), crosscap_core::Error>(())
/// ```
pub fn positive_length(name: &'static str, value: f64) -> Result<f64, Error> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(Error::Parameter {
        name,
        value: value.to_string(),
        expected: "a positive length".into(),
    })
}

impl Error {
    /// Whether the input or a parameter is at fault, rather than the method on this data.
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Shape { .. }
                | Self::NotFinite { .. }
                | Self::Parameter { .. }
                | Self::Index { .. }
        )
    }
}
