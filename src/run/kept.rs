//! States of the recent past that a run which loses stability can be restarted from.
//!
//! The state before the death of a run is nearly dead itself: nothing that is changed then saves it. So a run keeps two
//! states and, at a loss, hands over one that was healthy some time before. Nothing is copied: a step leaves the old state
//! in a buffer that the next one writes over; a state that is kept stays in it, and the buffer of a state that nobody needs
//! any more takes its place.

use crate::state::State;
use crate::step::{Loss, Survey};

/// Steps between two looks at the start of a run.
const LEAST: usize = 8;
/// Later there are this many looks in the time that the run has taken so far: a loss comes between 1/32 and 3/32 of it
/// after the state that is handed over. (Instabilities that take 10 steps in a short run take 1000 in a long one.)
const LOOKS: usize = 16;
/// A state with a smaller J is kept only where its J has not halved since the last look.
const SOUND_J: f64 = 0.1;

/// A step that lost stability.
#[derive(Debug)]
pub struct Lost {
    /// What was lost, and where.
    pub loss: Loss,
    /// The number of the step that failed.
    pub step: usize,
    /// Time at its start, s.
    pub time: f64,
    /// Its size, s.
    pub dt: f64,
    /// The step at which the run got the grid that it lost stability on (its first one, or that of a regrid).
    pub since: usize,
    /// A state that was healthy by all tests some steps before, on the same grid.
    pub kept: State,
}

/// What a look at a state tells.
#[derive(Debug, Clone, Copy)]
struct Look {
    step: usize,
    min_j: f64,
    fastest: f64,
}

impl Look {
    fn at(state: &State, survey: &Survey) -> Self {
        Self { step: state.step, min_j: survey.min_j, fastest: survey.fastest }
    }

    /// Whether a state is far from a loss: its J is sound or falls slowly, and its waves (which get faster with any F that
    /// grows without bound) have not doubled their speed since the look `before`.
    fn is_sound_after(&self, before: &Look) -> bool {
        (self.min_j >= SOUND_J || self.min_j >= 0.5 * before.min_j) && self.fastest <= 2.0 * before.fastest
    }
}

/// Two states on one grid.
#[derive(Debug)]
pub struct Kept {
    /// Where the grid came in.
    since: usize,
    /// The last look, at a state that was kept or was not.
    last: Look,
    /// The state that was kept last.
    newer: State,
    /// The one before it; in the beginning the same.
    older: State,
}

impl Kept {
    /// Keeps the state that a run starts with on a grid.
    pub fn new(state: &State, survey: &Survey) -> Self {
        Self { since: state.step, last: Look::at(state, survey), newer: state.clone(), older: state.clone() }
    }

    /// Whether it looks at a state.
    pub fn is_due(&self, state: &State) -> bool {
        state.step >= self.last.step + Self::interval(state.step - self.since)
    }

    /// After a step that went well: `old` is the buffer with the state before it, whose survey this is, and is written over by
    /// the next step. From time to time the state stays, and another buffer takes its place.
    pub fn look(&mut self, old: &mut State, survey: &Survey) {
        if !self.is_due(old) {
            return;
        }
        let look = Look::at(old, survey);
        if look.is_sound_after(&self.last) {
            std::mem::swap(&mut self.older, old);
            std::mem::swap(&mut self.older, &mut self.newer);
        }
        self.last = look;
    }

    /// Steps between two looks after so many steps.
    fn interval(steps: usize) -> usize {
        LEAST.max(steps / LOOKS)
    }

    /// The step of `dt` from `state` lost stability: it, and the latest state that is not too near.
    pub fn lost(self, loss: Loss, state: &State, dt: f64) -> Lost {
        let step = state.step + 1;
        let near = 2 * (step - self.newer.step) < Self::interval(state.step - self.since);
        let kept = if near { self.older } else { self.newer };
        Lost { loss, step, time: state.time, dt, since: self.since, kept }
    }

    /// The earlier of both states.
    pub fn earlier(self) -> State {
        self.older
    }

    /// Bytes of the states that are held for a run of states like `state`.
    pub fn bytes(state: &State) -> usize {
        2 * (size_of_val(&state.u[..]) + size_of_val(&state.internal[..]) + size_of_val(&state.creep[..]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::{LossKind, Site};

    const LOSS: Loss = Loss { cell: 0, site: Site::Node(0), kind: LossKind::NotFinite };

    fn state(step: usize) -> State {
        State { time: step as f64, step, components: 6, ..State::default() }
    }

    fn survey(min_j: f64, fastest: f64) -> Survey {
        Survey { min_j, fastest, ..Survey::default() }
    }

    /// A run to `end` steps, whose state n has a survey; what is handed over when the next step fails, and the buffers met.
    fn run(end: usize, of: impl Fn(usize) -> Survey) -> Lost {
        let (mut old, mut now) = (state(0), state(0));
        let mut kept = Kept::new(&now, &of(0));
        for step in 0..end {
            (old.step, old.time) = (step + 1, (step + 1) as f64);
            std::mem::swap(&mut old, &mut now);
            kept.look(&mut old, &of(step));
        }
        kept.lost(LOSS, &now, 1.0)
    }

    #[test]
    fn the_state_that_is_handed_over_lies_between_1_and_3_thirty_seconds_of_the_run_before_the_loss() {
        for end in [0, 1, 3, 5, 20, 63, 64, 100, 1000, 12345] {
            let lost = run(end, |_| survey(0.9, 1.0));
            let before = lost.step - lost.kept.step;
            let interval = Kept::interval(end);
            assert_eq!(lost.step, end + 1);
            // Half an interval, unless the run is shorter; and no more than an interval and a half, and the step itself.
            assert!(2 * before >= interval.min(2 * end), "{end}: {before} steps before");
            assert!(2 * before <= 3 * interval + 2, "{end}: {before} steps before");
        }
    }

    #[test]
    fn a_state_on_the_way_to_a_loss_is_not_kept_and_one_that_lives_at_a_small_j_is() {
        // Halved every three steps, from step 1000 on: the looks from there see it fall, or below the sound J.
        let falling = run(1100, |step| survey(0.9 * 0.5_f64.powf(step.saturating_sub(1000) as f64 / 3.0), 1.0));
        assert!(falling.kept.step <= 1010, "{}", falling.kept.step);
        let rising = run(1200, |step| survey(0.9, 2_f64.powf(step.saturating_sub(1000) as f64 / 20.0)));
        assert!(rising.kept.step <= 1060, "{}", rising.kept.step);
        let dense = run(1100, |_| survey(0.02, 1.0));
        assert!(dense.kept.step > 960, "{}", dense.kept.step);
    }
}
