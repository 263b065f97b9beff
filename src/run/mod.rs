//! The time loop.

mod folder;
pub mod keep;
mod kept;
mod lock;
mod norms;
mod report;
mod rows;
mod saved;
mod step_size;
mod treated;
mod watch;
mod whole;

pub use folder::Folder;
pub use keep::{Keep, Moment};
pub use kept::{Kept, Lost};
pub use lock::Lock;
pub use norms::norms;
pub use report::{Report, dofs, peak_memory_mib};
pub use treated::Treated;
pub use watch::{Limits, Watch};
pub use whole::Whole;

use crate::built;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::observe::{Observer, Sight, View};
use crate::state::State;
use crate::step::{Balance, EnergyMade, Motion, Scheme, Survey};
use crate::words::{Saved, Words};
use cpu_time::ProcessTime;
use std::sync::atomic::{AtomicBool, Ordering};
use step_size::{check_advance, end_of_step, step_size};
use watch::Alarm;

/// How far and in what steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// End time, s.
    pub end: f64,
    /// dt = courant min_e h_e / c_max, c_max the largest current speed.
    pub courant: f64,
    /// What damping takes of the step, 1/s: 1/dt is that of waves and this; see [`crate::step::cfl::DECAY`].
    pub decay: f64,
    /// What the watch over the energy does at which shares; none where it is off.
    pub watch: Option<Limits>,
}

/// Why a run stopped before its end; the state is then the one before the step that failed.
#[derive(Debug)]
pub enum Stop {
    /// A step lost stability.
    Unstable(Box<Lost>),
    /// The body has energy that nothing gave to it; with a state of some steps before.
    EnergyMade(Box<(EnergyMade, State)>),
    /// The user asked for it.
    Interrupted,
    /// An output could not be written.
    Output(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Stop::Output(error)
    }
}

impl From<Lost> for Stop {
    fn from(lost: Lost) -> Self {
        Stop::Unstable(Box::new(lost))
    }
}

/// A run: what stays the same, and the observers.
pub struct Run<'a, 'o> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The scheme.
    pub scheme: &'a Scheme,
    /// End and step.
    pub settings: Settings,
    /// Who looks on; may be empty.
    pub observers: Vec<Box<dyn Observer + 'o>>,
    /// Set from outside to stop after the step under way.
    pub interrupt: &'a AtomicBool,
}

/// When a run pauses between two steps, for instance for another grid.
pub trait Pause {
    /// The next time after `time` at which a step has to end for it.
    fn stop(&self, time: f64) -> Option<f64>;

    /// Whether the run pauses at this state.
    fn due(&mut self, view: &View) -> bool;

    /// Whether [`Pause::due`] may look at the state.
    fn looks(&self) -> bool {
        true
    }

    /// Saves what it needs to go on in a run that is resumed. By default nothing.
    ///
    /// # Errors
    /// A file that the disk does not take.
    fn save(&mut self, _: &mut Words) -> Result<(), Error> {
        Ok(())
    }

    /// Goes on from what [`Pause::save`] has saved.
    ///
    /// # Errors
    /// What was saved by something else.
    fn restore(&mut self, _: &mut Saved) -> Result<(), Error> {
        Ok(())
    }
}

/// Never.
struct Never;

impl Pause for Never {
    fn stop(&self, _: f64) -> Option<f64> {
        None
    }
    fn due(&mut self, _: &View) -> bool {
        false
    }
    fn looks(&self) -> bool {
        false
    }
}

/// Where a run has got to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// To its end time.
    Done,
    /// To a pause; it goes on by another call.
    Paused,
}

impl Run<'_, '_> {
    /// Steps `state` to the end; where the run stops before, it stays at the state before the step that failed.
    ///
    /// # Errors
    /// See [`Stop`].
    pub fn advance(&mut self, state: &mut State, report: &mut Report) -> Result<(), Stop> {
        self.advance_until(&mut Never, state, report).map(|_| ())
    }

    /// Steps `state` to the end or to a pause, after what is due at that state has been observed.
    ///
    /// # Errors
    /// See [`Stop`].
    pub fn advance_until(
        &mut self,
        pause: &mut dyn Pause,
        state: &mut State,
        report: &mut Report,
    ) -> Result<End, Stop> {
        self.advance_kept(pause, None, state, report)
    }

    /// The same, kept by `keep`.
    ///
    /// # Errors
    /// See [`Stop`].
    pub fn advance_kept(
        &mut self,
        pause: &mut dyn Pause,
        keep: Option<&mut dyn Keep>,
        state: &mut State,
        report: &mut Report,
    ) -> Result<End, Stop> {
        let wants = |what: fn(&dyn Observer) -> bool| self.observers.iter().any(|observer| what(&**observer));
        let (forces, balance) = (wants(|observer| observer.wants_forces()), wants(|observer| observer.wants_balance()));
        built::refuse(&[(built::FORCES, forces, "forces"), (built::BALANCE, balance, "the balance of energy")])?;
        let mut motion = Motion::unsurveyed(self.scheme, std::mem::take(state));
        if balance {
            motion = motion.with_balance(self.scheme);
        }
        // What nobody reads is not carried on: it would stand still.
        match forces {
            true => motion = motion.with_forces(self.scheme),
            false => motion.state.received = vec![],
        }
        let mut end = self.go(pause, keep, &mut motion, report);
        match &mut end {
            Err(Stop::Unstable(lost)) => motion.complete(self.scheme, &mut lost.kept),
            Err(Stop::EnergyMade(made)) => motion.complete(self.scheme, &mut made.1),
            _ => {}
        }
        motion.make_whole(self.scheme);
        *state = motion.state;
        end
    }

    /// Surveys the state that the run begins or goes on with.
    fn begin(&self, keep: Option<&mut (dyn Keep + '_)>, motion: &mut Motion) -> Result<(), Stop> {
        if !motion.state.time.is_finite() {
            let what = format!("the time of the state is {} s", motion.state.time);
            return Err(Error::input(what, "give a state with a finite time").into());
        }
        if let Some(words) = keep.and_then(Keep::resumed) {
            return Ok(motion.restore(self.scheme, &mut words.saved())?);
        }
        motion
            .survey(self.scheme)
            .map_err(|loss| Kept::new(&motion.state, &Survey::default()).lost(loss, &motion.state, 0.0).into())
    }

    /// All steps to the end or to a pause.
    fn go(
        &mut self,
        pause: &mut dyn Pause,
        mut keep: Option<&mut dyn Keep>,
        motion: &mut Motion,
        report: &mut Report,
    ) -> Result<End, Stop> {
        self.begin(keep.as_deref_mut(), motion)?;
        report.start(self.scheme, motion, &self.settings);
        motion.keep_own(self.scheme, pause.looks());
        let mut kept = Kept::new(&motion.state, &motion.survey);
        let (h, height) = (self.mesh.smallest_h(), self.mesh.smallest_height());
        while motion.state.time < self.settings.end {
            let time = motion.state.time;
            let stops = self.keep_if_due((pause, keep.as_deref_mut()), motion, report)?;
            let stop = pause.stop(time).unwrap_or(f64::INFINITY).min(self.next_stop(time));
            let stable = self.settings.stable_step(self.scheme, [h, height], motion.survey.fastest);
            let dt = step_size(stop - time, stable);
            let next = end_of_step(time, dt, stop);
            check_advance([time, next, self.settings.end], [stable, dt], h)?;
            let looks = self.look_at(&motion.state, dt).filter(|_| motion.is_shared());
            if motion.is_shared() && (pause.looks() || looks == Some(Sight::Unknowns)) {
                motion.show(self.scheme, pause.looks());
            }
            let observed = self.observe(motion, report, dt);
            if looks > Some(Sight::Survey) { motion.agree(observed) } else { observed }?;
            if stops {
                return Err(Stop::Interrupted);
            }
            if pause.due(&view(self.mesh, self.scheme, motion, report.balance.as_ref(), dt)) {
                return Ok(End::Paused);
            }
            if let Err(loss) = motion.advance_to(self.scheme, dt, next) {
                return Err(kept.lost(loss, &motion.state, dt).into());
            }
            let (former, survey) = motion.former();
            kept.look(former, survey);
            match report.count(self.scheme, dt, motion) {
                Some(Alarm::Stop(made)) => return Err(Stop::EnergyMade(Box::new((made, kept.earlier())))),
                Some(Alarm::Warning(made)) => self.observers.iter_mut().for_each(|o| o.energy_made(&made)),
                None => {}
            }
        }
        motion.make_whole(self.scheme);
        // No step looks at the faces of the last state.
        let mut last = Survey::default();
        if let Err(loss) = self.scheme.survey_all(&motion.state, &motion.work, &mut last) {
            return Err(kept.lost(loss, &motion.state, 0.0).into());
        }
        let keep = keep.filter(|keep| keep.at_end());
        let ended = keep.map_or(Ok(()), |keep| self.keep(keep, (pause, motion), report));
        report.see(&last);
        let ended = ended.and_then(|()| self.observe(motion, report, 0.0));
        motion.agree(ended)?;
        Ok(End::Done)
    }

    /// Keeps the run where that is due; whether it is asked to stop. All ranks find the same.
    fn keep_if_due(
        &mut self,
        (pause, mut keep): (&mut dyn Pause, Option<&mut (dyn Keep + '_)>),
        motion: &mut Motion,
        report: &Report,
    ) -> Result<bool, Error> {
        let stops = self.interrupt.load(Ordering::Relaxed);
        let due = keep.as_deref_mut().is_some_and(|keep| keep.due(&motion.state, stops));
        // A rank that is asked to stop may be another one than that which keeps the run.
        let [stops, due, is_kept] = motion.any([stops, due, keep.is_some()]);
        if due || (stops && is_kept) {
            motion.show(self.scheme, false);
            let kept = keep.map_or(Ok(()), |keep| self.keep(keep, (pause, motion), report));
            motion.agree(kept)?;
        }
        Ok(stops)
    }

    /// Keeps the run at the state of `motion`, before anybody has observed it.
    fn keep(
        &mut self,
        keep: &mut dyn Keep,
        (pause, motion): (&mut dyn Pause, &Motion),
        report: &Report,
    ) -> Result<(), Error> {
        let parts = keep::parts(self.scheme, motion, report, pause, &mut self.observers)?;
        keep.keep(&Moment { scheme: self.scheme, state: motion.seen(), parts })
    }

    /// The time that a step must not pass: the end, or an exact output before it.
    fn next_stop(&mut self, time: f64) -> f64 {
        self.observers.iter_mut().filter_map(|o| o.schedule().stop(time)).fold(self.settings.end, f64::min)
    }

    /// The most that somebody who waits for the state looks at.
    fn look_at(&mut self, state: &State, dt: f64) -> Option<Sight> {
        let due = |observer: &mut Box<dyn Observer + '_>| {
            observer.schedule().clone().due(state.step, state.time, dt).then(|| observer.looks_at())
        };
        self.observers.iter_mut().filter_map(due).max()
    }

    /// Shows the state to those who wait for it.
    fn observe(&mut self, motion: &mut Motion, report: &mut Report, dt: f64) -> Result<(), Error> {
        report.observed.resize(self.observers.len(), (0.0, 0));
        let mut failed = Ok(());
        for (observer, (seconds, count)) in self.observers.iter_mut().zip(&mut report.observed) {
            if observer.schedule().due(motion.state.step, motion.state.time, dt) {
                let clock = ProcessTime::now();
                // All ranks add up, those too on which an observer has failed.
                let together = motion.is_shared() && observer.looks_at() == Sight::Totals;
                let totals = together.then(|| motion.totals(self.scheme));
                let view = View { totals, ..view(self.mesh, self.scheme, motion, report.balance.as_ref(), dt) };
                failed = failed.and_then(|()| observer.observe(&view));
                *seconds += clock.elapsed().as_secs_f64();
                *count += 1;
            }
        }
        failed
    }
}

/// What observers and pauses see before a step of `dt`.
fn view<'a>(mesh: &'a Mesh, scheme: &'a Scheme, motion: &'a Motion, balance: Option<&'a Balance>, dt: f64) -> View<'a> {
    let treated = motion.work.treated();
    View { mesh, scheme, state: motion.seen(), totals: None, survey: &motion.survey, balance, treated, dt }
}
