//! The ranks that step a run together. In the program that runs alone there are none.

mod agreed;

pub use agreed::{agree, alone, check_same, first_to_fail};

use crate::exchange::Exchange;
use crate::problem::Setup;
use std::sync::{Arc, OnceLock};

/// What the engine gives to a rank: the way to the others, and how many threads it has where nobody names a number.
static RANKS: OnceLock<(Arc<dyn Exchange>, usize)> = OnceLock::new();

/// Makes this process one of several ranks, for all that follows.
pub fn join(exchange: Arc<dyn Exchange>, threads: usize) {
    RANKS.get_or_init(|| (exchange, threads));
}

/// The way to the others.
pub fn exchange() -> Option<Arc<dyn Exchange>> {
    RANKS.get().map(|(exchange, _)| exchange.clone())
}

/// The threads of a rank.
pub fn threads() -> Option<usize> {
    RANKS.get().map(|(_, threads)| *threads)
}

/// The number of this rank, from 0; 0 where it runs alone.
pub fn number() -> usize {
    RANKS.get().map_or(0, |(exchange, _)| exchange.rank())
}

/// Whether this rank prints and writes files.
pub fn writes() -> bool {
    number() == 0
}

/// The setup with the ranks in it.
pub fn set_up(setup: Setup) -> Setup {
    match exchange() {
        Some(exchange) => setup.exchange(exchange),
        None => setup,
    }
}
