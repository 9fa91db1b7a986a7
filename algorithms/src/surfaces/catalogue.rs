//! The catalogue of sample surfaces.

use super::faceted::faceted_surfaces;
use super::foam::foam;
use super::further::further_surfaces;
use super::higher::higher_surfaces;
use super::minimal::minimal_surfaces;
use super::paper::paper_surfaces;
use super::plates::plates;
use super::singular::singular_surfaces;
use super::surface::SampleSurface;
use crosscap_core::Error;

/// Every sample surface: the paper's nine first, in the paper's order.
pub fn catalogue() -> Vec<SampleSurface> {
    let mut all = paper_surfaces();
    all.extend(further_surfaces());
    all.extend(singular_surfaces());
    all.extend(faceted_surfaces());
    all.extend(plates());
    all.push(foam());
    all.extend(minimal_surfaces());
    all.extend(higher_surfaces());
    all
}

impl SampleSurface {
    /// The surface of the given name or alias; letters' case and the difference of `-` and `_` do not matter.
    ///
    /// # Errors
    /// [`Error::Parameter`] that lists the names there are.
    pub fn find(name: &str) -> Result<Self, Error> {
        let plain = |s: &str| s.to_ascii_lowercase().replace('-', "_");
        let wanted = plain(name);
        let mut all = catalogue();
        let at = all.iter().position(|s| {
            plain(s.name()) == wanted || s.aliases().iter().any(|a| plain(a) == wanted)
        });
        match at {
            Some(at) => Ok(all.swap_remove(at)),
            None => Err(Error::Parameter {
                name: "surface",
                value: name.into(),
                expected: format!(
                    "one of {}",
                    all.iter().map(|s| s.name()).collect::<Vec<_>>().join(", ")
                ),
            }),
        }
    }
}
