//! What a step that several ranks share fetches from the others, and when.

use super::obstacles::Obstacles;
use super::tile_memory::Tiles;
use super::{Motion, Scheme, Totals, Work};
use crate::error::Result;
use crate::state::State;

/// Who has the whole state beside its part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Shown {
    #[default]
    Nobody,
    First,
    All,
}

impl Shown {
    fn of(on_all: bool) -> Self {
        if on_all { Self::All } else { Self::First }
    }
}

/// The whole state, for those who look at it.
#[derive(Default)]
pub(super) struct See {
    /// Known to all ranks alike.
    to: Shown,
    whole: Option<State>,
}

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
        // Forces and what looks at the whole body read it block by block.
        if outside.forces.is_some() || scheme.looks_at_all() {
            ranks.gather(&mut outside.entries, entry);
        } else {
            let own = ranks.own();
            outside.of_all = Some(ranks.sum(outside.sums_of(entry(own.start)..entry(own.end))));
        }
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

    /// Fetches the blocks of other ranks of the new state: into it, or, where it is a part, into another one.
    pub(super) fn fetch(&mut self, scheme: &Scheme) -> Option<State> {
        let Work { tiles: Tiles { ranks, .. }, next, speed, corrections, scratch, .. } = self;
        let ranks = ranks.as_deref_mut().filter(|ranks| !ranks.whole)?;
        if ranks.parts {
            return ranks.whole_of(scheme, next, true);
        }
        ranks.state(scheme, next, speed);
        let memory = corrections.as_deref_mut()?;
        let own = ranks.own();
        let foreign = |block: &usize| !own.contains(block);
        for block in (0..scheme.operators.blocks.len()).filter(foreign) {
            memory.worst[block] = scheme.worst_of_block(next, block, scratch, &mut speed[block]);
        }
        None
    }

    /// Memory for the state after a step from `state`: for that of the own blocks, where states are parts.
    pub(super) fn next_of(tiles: &Tiles, scheme: &Scheme, state: &State) -> State {
        match tiles.ranks.as_ref().filter(|ranks| ranks.parts && !state.part.is_part) {
            Some(ranks) => ranks.part_of(scheme, state),
            None => state.clone(),
        }
    }
}

impl Scheme {
    /// Whether something of each step looks at the whole body.
    pub(super) fn looks_at_all(&self) -> bool {
        let looks = !self.corrections.is_empty() || self.rescue.is_some();
        looks || self.contacts.is_some() || self.bodies.is_some() || Obstacles::is_asked_for(self)
    }
}

impl Motion {
    /// Whether several ranks step the body.
    pub fn is_shared(&self) -> bool {
        self.work.is_shared()
    }

    /// Fetches what other ranks know of the state, into it. All ranks call it at the same step.
    pub fn make_whole(&mut self, scheme: &Scheme) {
        let Self { state, survey, work, shown, .. } = self;
        *shown = See::default();
        let Some(ranks) = work.tiles.ranks.as_deref_mut().filter(|ranks| !ranks.whole) else { return };
        if !ranks.parts {
            return ranks.state(scheme, state, &mut survey.speed);
        }
        if let Some(whole) = ranks.whole_of(scheme, state, true) {
            *state = whole;
        }
        ranks.gather(&mut survey.speed, |block| block);
        ranks.whole = true;
    }

    /// Leaves each rank with its part of a whole state, which is shown on rank 0, or on all ranks, until the next step. States that
    /// steps make are parts.
    pub fn keep_own(&mut self, scheme: &Scheme, on_all: bool) {
        let Self { state, work, shown, .. } = self;
        let Some(ranks) = work.tiles.ranks.as_deref_mut().filter(|ranks| ranks.parts && ranks.whole) else { return };
        let part = ranks.part_of(scheme, state);
        let whole = Some(std::mem::replace(state, part));
        *shown = See { to: Shown::of(on_all), whole: whole.filter(|_| on_all || ranks.is_first()) };
        ranks.whole = false;
    }

    /// Fetches what other ranks know of the state for those who look at it ([`Motion::seen`]): on rank 0, or on all ranks. All ranks
    /// call it at the same step.
    pub fn show(&mut self, scheme: &Scheme, on_all: bool) {
        let Self { state, survey, work, shown, .. } = self;
        let Some(ranks) = work.tiles.ranks.as_deref_mut().filter(|ranks| !ranks.whole) else { return };
        if !ranks.parts {
            return ranks.state(scheme, state, &mut survey.speed);
        }
        let wanted = Shown::of(on_all);
        if shown.to < wanted {
            *shown = See { to: wanted, whole: ranks.whole_of(scheme, state, on_all) };
            ranks.gather(&mut survey.speed, |block| block);
        }
    }

    /// [`Scheme::totals`] of the state, to which each rank adds its own blocks. All ranks call it.
    pub fn totals(&mut self, scheme: &Scheme) -> Totals {
        self.work.totals(scheme, &self.state)
    }

    /// The whole state after [`Motion::show`], where it is shown, or where this rank has it; else the part of this rank.
    pub fn seen(&self) -> &State {
        self.shown.whole.as_ref().unwrap_or(&self.state)
    }

    /// Makes a state that was kept whole, where it is a part. All ranks call it for the state of the same step.
    pub fn complete(&mut self, scheme: &Scheme, kept: &mut State) {
        let Some(ranks) = self.work.tiles.ranks.as_deref_mut().filter(|_| kept.part.is_part) else { return };
        if let Some(whole) = ranks.whole_of(scheme, kept, true) {
            *kept = whole;
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
