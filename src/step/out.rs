//! What a step makes, handed out to those who make it.

use super::balance::Sums;
use super::history::Histories;
use crate::lane::{self, F8};

/// What a step makes of some blocks that follow each other.
#[derive(Default)]
pub(super) struct Out<'a> {
    /// The first of them.
    pub first: usize,
    /// New unknowns.
    pub u: &'a mut [F8],
    /// New internal variables.
    pub internal: &'a mut [F8],
    /// New wave speeds.
    pub speed: &'a mut [F8],
    /// The balance of the blocks; none where it is off.
    pub balance: Option<&'a mut [Sums]>,
}

impl<'a> Out<'a> {
    /// Asks for what will be written of a block, if it is there. (A store to a line that is not there waits as a load does.)
    #[inline]
    pub fn ask_for(&self, block: usize, stride: usize) {
        let at = block - self.first;
        if let Some(u) = self.u.get(stride * at..stride * (at + 1)) {
            lane::prefetch(u);
            lane::prefetch(&self.speed[at..=at]);
        }
    }

    /// Where a block's balance is kept; none where it is off.
    #[inline]
    pub fn sums(&mut self, block: usize) -> Option<&mut Sums> {
        self.balance.as_mut()?.get_mut(block - self.first)
    }

    /// The same for a shorter time.
    pub fn again(&mut self) -> Out<'_> {
        let balance = self.balance.as_deref_mut();
        Out { first: self.first, u: self.u, internal: self.internal, speed: self.speed, balance }
    }

    /// Those before a block, and the rest.
    pub fn split(self, block: usize, histories: &Histories) -> (Self, Self) {
        let blocks = block - self.first;
        let stride = self.u.len().checked_div(self.speed.len()).unwrap_or(0);
        let history = histories.before(block) - histories.before(self.first);
        let (u, u2) = self.u.split_at_mut(blocks * stride);
        let (internal, internal2) = self.internal.split_at_mut(history);
        let (speed, speed2) = self.speed.split_at_mut(blocks);
        let (balance, balance2) = self.balance.map(|sums| sums.split_at_mut(blocks)).unzip();
        let left = Out { first: self.first, u, internal, speed, balance };
        (left, Out { first: block, u: u2, internal: internal2, speed: speed2, balance: balance2 })
    }
}
