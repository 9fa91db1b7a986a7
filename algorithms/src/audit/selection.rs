//! Landmarks.

use super::{broken, slack};
use crosscap_core::{Error, NeighborhoodOracle, Scalar};

/// What was asked of a selector.
pub(crate) struct Question<'a> {
    /// Name of the selector.
    pub(crate) plugin: &'a str,
    /// Points that it could choose.
    pub(crate) candidates: &'a [usize],
    /// Points that are landmarks already.
    pub(crate) taken: &'a [usize],
    /// The separation.
    pub(crate) separation: f64,
}

/// Checks every landmark and every candidate. O(L) queries.
///
/// # Errors
/// [`Error::Law`] for a landmark that is no candidate or chosen twice, for two landmarks closer than the separation, and for
/// a candidate that has none so close.
pub(crate) fn selection<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    question: &Question<'_>,
    chosen: &[usize],
) -> Result<(), Error> {
    let Question {
        plugin,
        candidates,
        taken,
        separation,
    } = *question;
    let mut free = vec![false; oracle.len()];
    candidates.iter().for_each(|&i| free[i] = true);
    let mut landmark = vec![false; oracle.len()];
    for &i in chosen {
        let law = "landmarks are different candidates";
        if free.get(i) != Some(&true) {
            return broken(plugin, law, i, format!("point {i} is no candidate"));
        }
        if landmark[i] {
            return broken(plugin, law, i, format!("point {i} is chosen twice"));
        }
        landmark[i] = true;
    }
    taken.iter().for_each(|&i| landmark[i] = true);
    // Taken points may be closer to each other: they are others' choice.
    let mut near = Vec::new();
    let mut indices = Vec::new();
    let rounding = separation * slack::<S>();
    let mut covered = vec![false; oracle.len()];
    for (k, &i) in chosen.iter().chain(taken).enumerate() {
        let reach = S::of(separation + rounding);
        oracle.indices_within(i, reach, &mut indices);
        let mut others = false;
        for &x in &indices {
            covered[x as usize] = true;
            others |= landmark[x as usize] && x as usize != i;
        }
        if !others || k >= chosen.len() {
            continue;
        }
        oracle.within(i, reach, &mut near);
        for x in &near {
            let close = x.distance.as_f64() < separation - rounding;
            if close && x.index != i && landmark[x.index] {
                let detail = format!(
                    "landmark {} at distance {}, separation {separation}",
                    x.index,
                    x.distance.as_f64()
                );
                let law = "separation: two landmarks are at distance at least the separation";
                return broken(plugin, law, i, detail);
            }
        }
    }
    match candidates.iter().find(|&&i| !covered[i]) {
        None => Ok(()),
        Some(&i) => broken(
            plugin,
            "covering: a candidate that is not chosen has a landmark closer than the separation",
            i,
            format!("no landmark within {separation}"),
        ),
    }
}
