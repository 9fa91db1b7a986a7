//! Landmarks of a cloud in tiles.

use super::gathered::Gathered;
use super::question::{Answer, Question, Tiles};
use crosscap_core::Error;

/// The landmarks in cells, in the order in which a greedy choice takes them: what
/// [`RandomGreedy`](crate::landmarks::RandomGreedy) chooses among all points of the cloud that are not barred, with the seed of the tiles, beside
/// some landmarks that are `there`.
///
/// Tiles are asked until nothing is open, which takes a handful of rounds: as many as there are tiles that chains of points
/// that wait for each other pass through.
///
/// # Errors
/// Those of [`Tiles::ask`]; [`Error::Shape`] where rounds decide nothing, as tiles that do not hold all points do.
pub fn landmarks(tiles: &dyn Tiles, separation: f64, there: &Gathered) -> Result<Gathered, Error> {
    let mut taken = there.clone();
    let mut ranks: Vec<u32> = Vec::new();
    loop {
        let known = taken.len();
        let question = Question::Landmarks {
            separation,
            taken: taken.clone(),
        };
        let mut left = 0;
        for answer in tiles.ask(&question)? {
            if let Answer::Landmarks {
                chosen,
                ranks: own,
                open,
            } = answer
            {
                taken.extend(&chosen);
                ranks.extend(own);
                left += open;
            }
        }
        if left == 0 {
            break;
        }
        if taken.len() == known {
            return Err(Error::Shape {
                found: format!("{left} points that no tile can decide about"),
                expected: "every point of the cloud in the tile whose box holds it".into(),
            });
        }
    }
    let first = there.len();
    let mut order: Vec<usize> = (0..ranks.len()).collect();
    order.sort_unstable_by_key(|&k| ranks[k]);
    let mut sorted = Gathered::new(tiles.dimension());
    for k in order.into_iter().map(|k| first + k) {
        sorted.push(taken.rows()[k], taken.place(k));
    }
    Ok(sorted)
}
