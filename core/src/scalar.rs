//! The real number types a cloud may be stored in.

use nalgebra::RealField;
use num_traits::{FromPrimitive, ToPrimitive};

/// A real number that coordinates and distances may be stored in: `f32` or `f64`.
///
/// Storage is generic, arithmetic that decides something (moments, eigenvalues,
/// predicates) is done in `f64`: squares of `f32` coordinates lose the tail of a
/// spectrum that the dimension estimate depends on.
pub trait Scalar:
    RealField + Copy + FromPrimitive + ToPrimitive + Default + Send + Sync + 'static
{
    /// The number as `f64` (exact for `f32` and `f64`).
    fn as_f64(self) -> f64;
    /// The nearest representable number.
    fn of(value: f64) -> Self;
    /// Name of the type in files and reports.
    const NAME: &'static str;
}

impl Scalar for f32 {
    #[inline]
    fn as_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline]
    fn of(value: f64) -> Self {
        value as f32
    }
    const NAME: &'static str = "f32";
}

impl Scalar for f64 {
    #[inline]
    fn as_f64(self) -> f64 {
        self
    }
    #[inline]
    fn of(value: f64) -> Self {
        value
    }
    const NAME: &'static str = "f64";
}
