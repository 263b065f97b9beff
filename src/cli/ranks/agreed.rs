//! What ranks agree on, so that all of them go on or none.

use super::{exchange, writes};
use crate::error::{Error, Result};
use crate::exchange::{self, first_that_differs, numbers_of_all};

/// The result where all ranks have got on, see [`exchange::agree`].
pub fn agree<T>(result: Result<T>) -> Result<T> {
    match exchange() {
        Some(exchange) => exchange::agree(&*exchange, result),
        None => result,
    }
}

/// Refuses ranks that see another `what` than rank 0, by a number of it.
pub fn check_same(number: f64, what: &str) -> Result<()> {
    let differs = exchange().and_then(|exchange| first_that_differs(&*exchange, number));
    let fail = |(rank, _)| Error::input(format!("rank {rank} has another {what} than rank 0"), "start all ranks alike");
    differs.map_or(Ok(()), |found| Err(fail(found)))
}

/// Lets rank 0 do something, for which all others wait.
pub fn alone(work: impl FnOnce() -> Result<()>) -> Result<()> {
    let outcome = if writes() { work() } else { Ok(()) };
    if let Some(exchange) = exchange() {
        exchange.wait();
    }
    outcome
}

/// The outcome of a command that all ranks carry out: the first one that has failed by itself has the message.
pub fn first_to_fail(outcome: Result<()>) -> Result<()> {
    let Some(exchange) = exchange() else { return outcome };
    let is_own = outcome.as_ref().is_err_and(|error| !matches!(error, Error::OtherRank { .. }));
    let own = if is_own { outcome.as_ref().err().map_or(0, Error::exit_code) } else { 0 };
    let all = numbers_of_all(&*exchange, f64::from(own));
    match all.iter().position(|code| *code != 0.0) {
        Some(rank) if rank != exchange.rank() => Err(Error::OtherRank { rank, code: all[rank] as u8 }),
        _ => outcome,
    }
}
