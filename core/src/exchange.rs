//! What the ranks of a run say to each other. A rank is one of several programs that step a body together, each its own blocks.
//!
//! The step needs few calls, so that any engine can have them: MPI in a crate of its own, threads in the tests. All of them are
//! collective: every rank makes the same calls in the same order. A call does not fail: where a message cannot come the engine ends
//! all ranks, since a rank that is told of it alone cannot tell the others.
//!
//! What only one rank knows (a full disk, a signal) becomes known to all by [`agree`] and [`numbers_of_all`].

use crate::error::{Error, Result};
use std::fmt::Debug;

/// The ranks of a run, seen from one of them.
pub trait Exchange: Debug + Send + Sync {
    /// The number of this rank, from 0.
    fn rank(&self) -> usize;

    /// How many there are.
    fn ranks(&self) -> usize;

    /// Sends `send[r]` to each rank r, does what there is to do `meanwhile`, and receives from each rank r as many numbers as `receive[r]`
    /// has. What is empty is not sent; lengths agree.
    fn swap(&self, send: &[Vec<f64>], receive: &mut [Vec<f64>], meanwhile: &mut (dyn FnMut() + Send));

    /// Gives all ranks what each of them has: rank r has the numbers `first[r]..first[r + 1]` of `all`; `first` is the same
    /// everywhere.
    fn gather(&self, all: &mut [f64], first: &[usize]);

    /// The part of each block, from 0 to below the number of ranks, such that parts are of nearly equal weight and few faces lie between
    /// them. `None`, as by default: runs of blocks in their order. Every rank finds the same.
    fn parts(&self, _: &BlockGraph) -> Option<Vec<usize>> {
        None
    }

    /// Waits until all ranks have come here, however long one of them works alone. By default it does nothing: the next call waits.
    fn wait(&self) {}
}

/// The graph of the blocks of a body, which each have eight cells: what ranks divide.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BlockGraph {
    /// Where the edges of each block begin in `near` and `faces`, and the end of the last ones.
    pub first: Vec<usize>,
    /// The block at the other end of each edge; each edge stands at both of its blocks.
    pub near: Vec<usize>,
    /// Of how many faces of cells the traces would be sent, if the blocks of an edge were of two ranks.
    pub faces: Vec<usize>,
    /// What each block costs in a step: an estimate, ns.
    pub weights: Vec<u64>,
}

/// A number of each rank, known to all of them.
pub fn numbers_of_all(exchange: &dyn Exchange, own: f64) -> Vec<f64> {
    let mut all = vec![0.0; exchange.ranks()];
    all[exchange.rank()] = own;
    exchange.gather(&mut all, &(0..=exchange.ranks()).collect::<Vec<_>>());
    all
}

/// The first rank whose number is another one than that of rank 0, with both numbers; none where all have the same.
pub fn first_that_differs(exchange: &dyn Exchange, own: f64) -> Option<(usize, [f64; 2])> {
    let all = numbers_of_all(exchange, own);
    let rank = all.iter().position(|number| *number != all[0])?;
    Some((rank, [all[rank], all[0]]))
}

/// The result of this rank where all ranks have got on. All ranks call it at the same place, and so all of them go on or none.
///
/// # Errors
/// The error of this rank; [`Error::OtherRank`] where only others have failed, with the first of them.
pub fn agree<T>(exchange: &dyn Exchange, result: Result<T>) -> Result<T> {
    let own = result.as_ref().err().map_or(0, Error::exit_code);
    let all = numbers_of_all(exchange, f64::from(own));
    let value = result?;
    match all.iter().position(|code| *code != 0.0) {
        Some(rank) => Err(Error::OtherRank { rank, code: all[rank] as u8 }),
        None => Ok(value),
    }
}
