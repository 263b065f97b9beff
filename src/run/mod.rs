//! The time loop.

mod folder;
pub mod keep;
mod kept;
mod lock;
mod norms;
mod report;
mod rows;
mod saved;
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
use crate::observe::{Observer, View};
use crate::state::State;
use crate::step::{Balance, EnergyMade, Motion, Scheme, Survey};
use crate::words::{Saved, Words};
use cpu_time::ProcessTime;
use std::sync::atomic::{AtomicBool, Ordering};
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
        let end = self.go(pause, keep, &mut motion, report);
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
        let mut kept = Kept::new(&motion.state, &motion.survey);
        let h = self.mesh.smallest_h();
        while motion.state.time < self.settings.end {
            let (time, stops) = (motion.state.time, motion.any(self.interrupt.load(Ordering::Relaxed)));
            if let Some(keep) = keep.as_deref_mut()
                && motion.any(keep.due(&motion.state, stops))
            {
                motion.make_whole(self.scheme);
                self.keep(keep, (pause, motion), report)?;
            }
            let stop = pause.stop(time).unwrap_or(f64::INFINITY).min(self.next_stop(time));
            let stable = self.settings.stable_step(h, motion.survey.fastest);
            let dt = step_size(stop - time, stable);
            let next = end_of_step(time, dt, stop);
            check_advance([time, next, self.settings.end], [stable, dt], h)?;
            if motion.is_shared() && (pause.looks() || kept.is_due(&motion.state) || self.observes(&motion.state, dt)) {
                motion.make_whole(self.scheme);
            }
            self.observe(motion, report, dt)?;
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
            if motion.is_shared() && report.looks() {
                motion.make_whole(self.scheme);
            }
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
        if let Some(keep) = keep.filter(|keep| keep.at_end()) {
            self.keep(keep, (pause, motion), report)?;
        }
        report.see(&last);
        self.observe(motion, report, 0.0)?;
        Ok(End::Done)
    }

    /// Keeps the run at the state of `motion`, before anybody has observed it.
    fn keep(
        &mut self,
        keep: &mut dyn Keep,
        (pause, motion): (&mut dyn Pause, &Motion),
        report: &Report,
    ) -> Result<(), Error> {
        let parts = keep::parts(motion, report, pause, &mut self.observers)?;
        keep.keep(&Moment { scheme: self.scheme, state: &motion.state, parts })
    }

    /// The time that a step must not pass: the end, or an exact output before it.
    fn next_stop(&mut self, time: f64) -> f64 {
        self.observers.iter_mut().filter_map(|o| o.schedule().stop(time)).fold(self.settings.end, f64::min)
    }

    /// Whether somebody waits for the state.
    fn observes(&mut self, state: &State, dt: f64) -> bool {
        let due = |observer: &mut Box<dyn Observer + '_>| observer.schedule().clone().due(state.step, state.time, dt);
        self.observers.iter_mut().any(due)
    }

    /// Shows the state to those who wait for it.
    fn observe(&mut self, motion: &Motion, report: &mut Report, dt: f64) -> Result<(), Error> {
        let view = view(self.mesh, self.scheme, motion, report.balance.as_ref(), dt);
        report.observed.resize(self.observers.len(), (0.0, 0));
        for (observer, (seconds, count)) in self.observers.iter_mut().zip(&mut report.observed) {
            if observer.schedule().due(view.state.step, view.state.time, dt) {
                let clock = ProcessTime::now();
                observer.observe(&view)?;
                *seconds += clock.elapsed().as_secs_f64();
                *count += 1;
            }
        }
        Ok(())
    }
}

/// What observers and pauses see before a step of `dt`.
fn view<'a>(mesh: &'a Mesh, scheme: &'a Scheme, motion: &'a Motion, balance: Option<&'a Balance>, dt: f64) -> View<'a> {
    let treated = motion.work.treated();
    View { mesh, scheme, state: &motion.state, survey: &motion.survey, balance, treated, dt }
}

/// The time after a step: one that is meant to end at the end of the run or at an exact time ends there to the last bit.
fn end_of_step(time: f64, dt: f64, stop: f64) -> f64 {
    let end = time + dt;
    if (stop - end).abs() < 1e-9 * dt { stop } else { end }
}

/// Steps of a run that no machine does.
const ENDLESS: f64 = 1e13;

impl Settings {
    /// The largest step for cells of size `h`, m, and waves of speed `fastest`, m/s.
    fn stable_step(&self, h: f64, fastest: f64) -> f64 {
        let of_waves = self.courant * h / fastest;
        // Without damping to the last bit what it is without this line.
        if self.decay == 0.0 { of_waves } else { 1.0 / (1.0 / of_waves + self.decay) }
    }
}

/// Refuses a step of `dt` to the time `next` that does not lead to the end: not to a later time, or with a stable step of next to nothing.
///
/// # Errors
/// Bad input: cells without a size, a limit of the step of nothing, or a time whose own rounding is larger than the step.
fn check_advance([time, next, end]: [f64; 3], [stable, dt]: [f64; 2], h: f64) -> Result<(), Error> {
    let (advance, endless) = (next - time, (end - time) / stable > ENDLESS);
    // A hundredth of a step lost by rounding is no noise any more.
    if dt > 0.0 && advance > 0.0 && (advance - dt).abs() <= 0.01 * dt && !endless {
        return Ok(());
    }
    let what = format!("at t = {time:e} s the next step is {dt:e} s: the run would not get to its end at {end:e} s");
    let remedy = match (h > 0.0, stable > 0.0 && !endless) {
        (false, _) => {
            format!("the smallest cell has the size {h:e} m: give a mesh without collapsed or inverted cells")
        }
        (true, false) => format!(
            "the step is a share of {h:e} m, the size of the smallest cell, over the wave speed: give larger cells, a larger cfl or safety, or a smaller `rate` \
             where a [[source]] damps"
        ),
        (true, true) => "times have 16 digits: let [time] start nearer to 0, or give a larger cfl or safety".to_owned(),
    };
    Err(Error::input(what, remedy))
}

/// The stable step, shortened evenly over the last ones before a time that lies `rest` ahead.
fn step_size(rest: f64, stable: f64) -> f64 {
    let steps = (rest / stable - 1e-9).ceil();
    // Two steps suffice for evenness: none is shorter than half of the stable one.
    if steps <= 2.0 { rest / steps.max(1.0) } else { stable }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of size up to `stable` through `rest`.
    fn steps(rest: f64, stable: f64) -> Vec<f64> {
        let (mut left, mut out) = (rest, Vec::new());
        while left > 1e-9 * stable {
            out.push(step_size(left, stable));
            left -= out.last().unwrap();
        }
        out
    }

    #[test]
    fn as_few_steps_as_the_limit_allows_and_the_last_two_are_even() {
        for rest in [0.3, 1.0, 1.2, 2.0, 2.01, 3.0, 7.001, 7.999, 8.0, 41.5] {
            let all = steps(rest, 1.0);
            assert_eq!(all.len(), f64::ceil(rest) as usize, "{rest}: {all:?}");
            // The limit may be passed by the rounding that `step_size` forgives.
            assert!(all.iter().all(|dt| *dt <= 1.0 + 1e-9), "{rest}: {all:?}");
            if let [.., a, b] = all[..] {
                // Roundings of sums of up to 42 steps; neither is shorter than half of the stable step.
                assert!((a - b).abs() < 1e-12 && b > 0.5, "{rest}: {all:?}");
            }
        }
    }
}
