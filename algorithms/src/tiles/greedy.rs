//! Landmarks in random order, tile by tile.
//!
//! A greedy choice takes points in an order, each that keeps the separation from those before it. It looks sequential and
//! is not: a point is taken exactly if none of the points close to it that come earlier is. So the set does not
//! depend on who looks at a point, or when; a tile decides what follows from the points that it has, says what
//! stays open, and is asked again when others have decided more. This is the first maximal independent set in
//! the order (G. Blelloch, J. Fineman and J. Shun, *Greedy sequential maximal independent set and matching are
//! parallel on average*, SPAA 2012): for a random order chains of points that wait for each other are short.

use super::gathered::Gathered;
use super::tile::Tile;
use crosscap_core::{Row, Table};

/// What is known of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Nothing is against it so far.
    Open,
    /// A point that comes earlier and is close to it may be a landmark.
    Doubtful,
    /// It may be a landmark: what is close to it is not known, or in doubt.
    Unknown,
    /// It is a landmark, close to one, or barred.
    Decided,
}

/// What a tile decided.
pub(super) struct Round {
    /// Points in the box that are landmarks.
    pub(super) chosen: Vec<Row>,
    /// How many points in the box are still open.
    pub(super) open: usize,
}

/// Decides what follows from the landmarks that are known, `taken`, and from the points of the tile, at a separation that
/// is less than the halo.
pub(super) fn round(tile: &Tile, separation: f64, taken: &Gathered) -> Round {
    let state = |row: Row| match tile.is_barred(row) {
        true => State::Decided,
        false => State::Open,
    };
    let mut states: Table<Row, State> = tile.ids().map(state).collect();
    let reach = tile.halo() + separation;
    for (_, place) in taken.each().filter(|x| tile.bounds().reach(x.1, reach)) {
        tile.within(place, separation, |row| states[row] = State::Decided);
    }
    let mut order: Vec<Row> = tile.ids().filter(|&r| states[r] == State::Open).collect();
    order.sort_unstable_by_key(|&row| tile.rank(row));
    let mut found = Round {
        chosen: Vec::new(),
        open: 0,
    };
    for row in order {
        let own = tile.owns(row);
        match states[row] {
            State::Decided => continue,
            State::Open if tile.known(row) >= separation => {
                tile.within(tile.place(row), separation, |near| {
                    states[near] = State::Decided;
                });
                found.chosen.extend(own.then_some(row));
            }
            _ => {
                states[row] = State::Unknown;
                found.open += usize::from(own);
                tile.within(tile.place(row), separation, |near| {
                    if states[near] == State::Open {
                        states[near] = State::Doubtful;
                    }
                });
            }
        }
    }
    found
}
