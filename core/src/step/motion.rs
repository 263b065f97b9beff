//! A body in motion: its state, what the survey tells of it, and the memory of the steps.

use super::shared::See;
use super::{Loss, Scheme, Speeds, Survey, Work};
use crate::built;
use crate::error::Error;
use crate::lane::F8;
use crate::state::{Received, State};
use crate::words::{Saved, Words};

/// A state that goes from step to step.
///
/// The survey is always that of the state: it sets the next step size and the rate of the control of the curl.
pub struct Motion {
    /// The state.
    pub state: State,
    /// Its survey.
    pub survey: Survey,
    /// The memory of the steps.
    pub work: Work,
    /// The survey of the state that the last step made, or after it of the state before that step.
    other: Survey,
    /// The whole state where `state` is the part of a rank and somebody looks.
    pub(super) shown: See,
}

impl Motion {
    /// Begins with `state`, and surveys it at its points, nodes and faces.
    ///
    /// # Errors
    /// The first cell that has no stability in `state`.
    pub fn new(scheme: &Scheme, state: State) -> Result<Self, Loss> {
        let mut motion = Self::unsurveyed(scheme, state);
        motion.survey(scheme)?;
        Ok(motion)
    }

    /// Begins with a copy of a whole state; of several ranks each copies its part only.
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn of_copy(scheme: &Scheme, state: &State) -> Result<Self, Loss> {
        let is_ready = state.boundary.len() == scheme.boundary_memory.len() && scheme.has_room_for_creep(state);
        if scheme.exchange.is_none() || !is_ready {
            return Self::new(scheme, state.clone());
        }
        let work = Work::new(scheme, state);
        let (mut survey, own) = (Survey::default(), work.next.clone());
        scheme.survey_all(state, &work, &mut survey)?;
        Ok(Self { state: own, work, survey, other: Survey::default(), shown: See::default() })
    }

    /// Begins with `state`, which [`Motion::survey`] has to look at before the first step.
    pub fn unsurveyed(scheme: &Scheme, state: State) -> Self {
        let mut state = state;
        if state.boundary.len() != scheme.boundary_memory.len() {
            // A state that knows of no conditions: theirs is the memory of a start.
            scheme.set_boundary_memory(&mut state, &[]);
        }
        scheme.make_room_for_creep(&mut state);
        let work = Work::new(scheme, &state);
        Self { state, work, survey: Survey::default(), other: Survey::default(), shown: See::default() }
    }

    /// The same with a balance of energy, see [`Work::with_balance`].
    pub fn with_balance(mut self, scheme: &Scheme) -> Self {
        self.work = self.work.with_balance(scheme);
        self
    }

    /// The same with a meter of the forces at each boundary group and of each contact pair: [`State::received`] goes on from what the state has, or begins at 0.
    pub fn with_forces(mut self, scheme: &Scheme) -> Self {
        self.work = self.work.with_forces();
        self.state.received.resize(scheme.receivers(), Received::default());
        self
    }

    /// Surveys the state at its points, nodes and faces ([`Scheme::survey_all`]): for a state that no step has made.
    ///
    /// # Errors
    /// The first cell that has no stability.
    pub fn survey(&mut self, scheme: &Scheme) -> Result<(), Loss> {
        scheme.survey_all(&self.state, &self.work, &mut self.survey)
    }

    /// Saves what the next step and observers look at beside the state: its survey, and what corrections did in its cells.
    pub fn save(&self, scheme: &Scheme, to: &mut Words) {
        let speed = self.survey.speed.iter().flat_map(|speed| [speed.fastest, speed.prestress]);
        to.blocks(&scheme.in_first_order(&speed.collect::<Vec<_>>(), 2))
            .real(self.survey.fastest)
            .real(self.survey.min_j);
        let treated = self.work.treated();
        to.blocks(&scheme.in_first_order(treated, treated.len() / scheme.operators.blocks.len().max(1)));
    }

    /// Takes the place of [`Motion::survey`] for a state that was saved.
    ///
    /// # Errors
    /// Numbers of another grid or of other corrections.
    pub fn restore(&mut self, scheme: &Scheme, from: &mut Saved) -> crate::error::Result<()> {
        let (speed, fastest, min_j, treated) = (from.blocks()?, from.real()?, from.real()?, from.blocks()?);
        if speed.len() != 2 * scheme.operators.blocks.len() || treated.len() != self.work.treated().len() {
            let what = "the checkpoint is of another grid or of a run with another limiter";
            return Err(Error::input(what, "resume the run with its own scene and files"));
        }
        let (speed, many) = (scheme.in_own_order(&speed, 2), treated.len() / scheme.operators.blocks.len().max(1));
        let of = |[fastest, prestress]: &[F8; 2]| Speeds { fastest: *fastest, prestress: *prestress };
        self.survey = Survey { speed: speed.as_chunks().0.iter().map(of).collect(), fastest, min_j };
        self.work.set_treated(scheme.in_own_order(&treated, many));
        Ok(())
    }

    /// Does a step of `dt`, and surveys the result.
    ///
    /// # Errors
    /// The first cell that lost stability; the state is then the one before the step.
    pub fn advance(&mut self, scheme: &Scheme, dt: f64) -> Result<(), Loss> {
        self.advance_to(scheme, dt, self.state.time + dt)
    }

    /// Does a step of `dt` after which the time is `time`: t + dt, but for a rounding.
    ///
    /// # Errors
    /// As [`Motion::advance`].
    pub fn advance_to(&mut self, scheme: &Scheme, dt: f64, time: f64) -> Result<(), Loss> {
        self.make(scheme, dt, time)?;
        std::mem::swap(&mut self.state, &mut self.work.next);
        std::mem::swap(&mut self.survey, &mut self.other);
        Ok(())
    }

    /// Does a step of `dt` as [`Motion::advance`] does, and stays at the state before it.
    ///
    /// # Errors
    /// As [`Motion::advance`].
    pub fn attempt(&mut self, scheme: &Scheme, dt: f64) -> Result<(), Loss> {
        self.make(scheme, dt, self.state.time + dt)
    }

    /// Makes the state after a step, with cells rescued where the scheme says so.
    fn make(&mut self, scheme: &Scheme, dt: f64, time: f64) -> Result<(), Loss> {
        self.shown = See::default();
        let Self { state, survey, work, other, .. } = self;
        let result = match scheme.rescue {
            Some(rescue) if built::CORRECTIONS => scheme.step_with(rescue, (state, survey), (dt, time), work, other),
            _ => {
                scheme.step_to(state, survey, dt, time, work);
                scheme.surveyed(work, other)
            }
        };
        if result.is_err() {
            work.forget_others();
        }
        if built::FORCES {
            work.keep_angular_momentum(scheme, state);
            work.receive(scheme, &state.received);
        }
        result
    }

    /// The state before the last step, whose memory the next step writes over, and its survey.
    pub fn former(&mut self) -> (&mut State, &Survey) {
        (&mut self.work.next, &self.other)
    }
}
