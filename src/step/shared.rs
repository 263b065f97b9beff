//! What a step that several ranks share fetches from the others, and when.

use super::obstacles::Obstacles;
use super::tile_memory::Tiles;
use super::{Motion, Scheme, Work};
use crate::error::Result;

impl Work {
    /// Whether several ranks step the body.
    pub(crate) fn is_shared(&self) -> bool {
        self.tiles.ranks.is_some()
    }

    /// Gives all ranks what each of them has metered in a step; all of the new state where the scheme looks at it in each step.
    pub(super) fn share(&mut self, scheme: &Scheme) {
        let Work { tiles: Tiles { ranks, .. }, outside, balance, meetings, .. } = self;
        let Some(ranks) = ranks else { return };
        ranks.whole = false;
        let entry = |block: usize| outside.first[block] as usize;
        ranks.gather(&mut outside.entries, entry);
        if let Some(forces) = &mut outside.forces {
            ranks.gather(forces, entry);
        }
        if let Some(torques) = &mut outside.torques {
            ranks.gather(torques, entry);
        }
        if let Some(balance) = balance {
            ranks.gather(balance, |block| block);
        }
        if let Some(received) = meetings.as_deref_mut().and_then(|meetings| meetings.received.as_mut()) {
            ranks.add_up(received);
        }
        if scheme.looks_at_all() {
            self.fetch(scheme);
        }
    }

    /// The state that is at hand is the one before a step again, of which this rank may know its own blocks only.
    pub(super) fn forget_others(&mut self) {
        if let Some(ranks) = &mut self.tiles.ranks {
            ranks.whole = false;
        }
    }

    /// Fetches the blocks of other ranks of the new state.
    pub(super) fn fetch(&mut self, scheme: &Scheme) {
        let Work { tiles: Tiles { ranks, .. }, next, speed, corrections, scratch, .. } = self;
        let Some(ranks) = ranks.as_deref_mut().filter(|ranks| !ranks.whole) else { return };
        ranks.state(scheme, next, speed);
        let Some(memory) = corrections.as_deref_mut() else { return };
        let own = ranks.own();
        let foreign = |block: &usize| !own.contains(block);
        for block in (0..scheme.operators.blocks.len()).filter(foreign) {
            memory.worst[block] = scheme.worst_of_block(next, block, scratch, &mut speed[block]);
        }
    }
}

impl Scheme {
    /// Whether something of each step looks at the whole body.
    fn looks_at_all(&self) -> bool {
        let looks = !self.corrections.is_empty() || self.rescue.is_some();
        looks || self.contacts.is_some() || self.bodies.is_some() || Obstacles::is_asked_for(self)
    }
}

impl Motion {
    /// Whether several ranks step the body.
    pub fn is_shared(&self) -> bool {
        self.work.is_shared()
    }

    /// Fetches what other ranks know of the state. All ranks call it at the same step.
    pub fn make_whole(&mut self, scheme: &Scheme) {
        let Self { state, survey, work, .. } = self;
        if let Some(ranks) = work.tiles.ranks.as_deref_mut().filter(|ranks| !ranks.whole) {
            ranks.state(scheme, state, &mut survey.speed);
        }
    }

    /// To each question whether any rank says yes; without other ranks what is said.
    pub fn any<const N: usize>(&self, yes: [bool; N]) -> [bool; N] {
        self.work.tiles.ranks.as_ref().map_or(yes, |ranks| ranks.any(yes))
    }

    /// The result of this rank, where no other one has failed.
    ///
    /// # Errors
    /// The error of this rank, or that another one has failed.
    pub fn agree<T>(&self, result: Result<T>) -> Result<T> {
        match &self.work.tiles.ranks {
            Some(ranks) => ranks.agree(result),
            None => result,
        }
    }
}
