//! What the ranks of a run say to each other. A rank is one of several programs that step a body together, each its own blocks.
//!
//! The step needs few calls, so that any engine can have them: MPI in a crate of its own, threads in the tests. All of them are
//! collective: every rank makes the same calls in the same order. A call does not fail: where a message cannot come the engine ends
//! all ranks, since a rank that is told of it alone cannot tell the others.

use std::fmt::Debug;

/// The ranks of a run, seen from one of them.
pub trait Exchange: Debug + Send + Sync {
    /// The number of this rank, from 0.
    fn rank(&self) -> usize;

    /// How many there are.
    fn ranks(&self) -> usize;

    /// Sends `send[r]` to each rank r, and receives from it as many numbers as `receive[r]` has. What is empty is not sent; lengths
    /// agree.
    fn swap(&self, send: &[Vec<f64>], receive: &mut [Vec<f64>]);

    /// Gives all ranks what each of them has: rank r has the numbers `first[r]..first[r + 1]` of `all`; `first` is the same
    /// everywhere.
    fn gather(&self, all: &mut [f64], first: &[usize]);
}
