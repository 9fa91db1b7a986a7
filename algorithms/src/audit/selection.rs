//! Landmarks.

use super::{broken, slack};
use crate::execute::{self, Execute};
use crosscap_core::{Error, Neighbor, NeighborhoodOracle, Scalar};
use std::sync::atomic::{AtomicBool, Ordering};

/// Landmarks that a job takes at a time.
const LANDMARKS_AT_ONCE: usize = 64;

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
    execute: &dyn Execute,
    question: &Question<'_>,
    chosen: &[usize],
) -> Result<(), Error> {
    let Question {
        plugin,
        candidates,
        taken,
        separation,
    } = *question;
    let mut landmark = chosen_once(oracle.len(), plugin, candidates, chosen)?;
    taken.iter().for_each(|&i| landmark[i] = true);
    let covered: Vec<AtomicBool> = (0..oracle.len()).map(|_| AtomicBool::new(false)).collect();
    let all: Vec<usize> = chosen.iter().chain(taken).copied().collect();
    let close = execute::map_blocks(
        execute,
        LANDMARKS_AT_ONCE,
        all.len(),
        || (Vec::new(), Vec::new()),
        |(indices, near), k| {
            let others = cover(oracle, all[k], separation, &landmark, &covered, indices);
            // Taken points may be closer to each other: they are others' choice.
            if others && k < chosen.len() {
                too_close(oracle, all[k], separation, &landmark, near)
            } else {
                None
            }
        },
    );
    let mut close = all.iter().zip(close);
    if let Some((i, other)) = close.find_map(|(&i, close)| Some((i, close?))) {
        let detail = format!(
            "landmark {} at distance {}, separation {separation}",
            other.index,
            other.distance.as_f64()
        );
        let law = "separation: two landmarks are at distance at least the separation";
        return broken(plugin, law, i, detail);
    }
    let covered = |i: usize| covered[i].load(Ordering::Relaxed);
    match candidates.iter().find(|&&i| !covered(i)) {
        None => Ok(()),
        Some(&i) => broken(
            plugin,
            "covering: a candidate that is not chosen has a landmark closer than the separation",
            i,
            format!("no landmark within {separation}"),
        ),
    }
}

/// What rounding may add to a separation, or take from it.
fn rounding<S: Scalar>(separation: f64) -> f64 {
    separation * slack::<S>()
}

/// Marks the points that a landmark covers; whether another landmark is among them. `indices` is scratch.
fn cover<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    i: usize,
    separation: f64,
    landmark: &[bool],
    covered: &[AtomicBool],
    indices: &mut Vec<u32>,
) -> bool {
    let reach = separation + rounding::<S>(separation);
    oracle.indices_within(i, S::of(reach), indices);
    let mut others = false;
    for &x in indices.iter() {
        covered[x as usize].store(true, Ordering::Relaxed);
        others |= landmark[x as usize] && x as usize != i;
    }
    others
}

/// Another landmark that is closer than the separation by more than rounding. `near` is scratch.
fn too_close<S: Scalar>(
    oracle: &dyn NeighborhoodOracle<Scalar = S>,
    i: usize,
    separation: f64,
    landmark: &[bool],
    near: &mut Vec<Neighbor<S>>,
) -> Option<Neighbor<S>> {
    let rounding = rounding::<S>(separation);
    oracle.within(i, S::of(separation + rounding), near);
    let close = |x: &&Neighbor<S>| {
        let distance = x.distance.as_f64();
        distance < separation - rounding && x.index != i && landmark[x.index]
    };
    near.iter().find(close).copied()
}

/// Which of so many points are chosen, each a candidate and once.
fn chosen_once(
    count: usize,
    plugin: &str,
    candidates: &[usize],
    chosen: &[usize],
) -> Result<Vec<bool>, Error> {
    let mut free = vec![false; count];
    candidates.iter().for_each(|&i| free[i] = true);
    let mut landmark = vec![false; count];
    for &i in chosen {
        let law = "landmarks are different candidates";
        if free.get(i) != Some(&true) {
            broken(plugin, law, i, format!("point {i} is no candidate"))?;
        }
        if landmark[i] {
            broken(plugin, law, i, format!("point {i} is chosen twice"))?;
        }
        landmark[i] = true;
    }
    Ok(landmark)
}
