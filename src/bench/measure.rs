//! Steps against the clock.

use super::Subject;
use super::peaks::pool;
use crate::accuracy::errors;
use crate::error::{Error, Result};
use crate::problem::Problem;
use crate::run::dofs;
use crate::state::State;
use crate::step::phase::{PARTS, PHASES};
use crate::step::{Loss, Motion, Phases};
use cpu_time::ProcessTime;
use std::time::{Duration, Instant};

/// How long a measurement is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Length {
    /// Until the wave has run its way, once.
    Wave,
    /// So many steps.
    Steps(usize),
    /// Until so many seconds have passed on the clock.
    Seconds(f64),
}

impl Length {
    /// Of a number of steps or of seconds, where one is given.
    ///
    /// # Errors
    /// A number that is not above 0.
    pub fn of(steps: Option<usize>, seconds: Option<f64>) -> Result<Self> {
        match (steps, seconds) {
            (Some(0), _) => Err(Error::input("--steps is 0", "give a number of steps from 1")),
            (Some(steps), _) => Ok(Self::Steps(steps)),
            (_, Some(s)) if s.is_finite() && s > 0.0 => Ok(Self::Seconds(s)),
            (_, Some(s)) => Err(Error::input(format!("--seconds is {s}"), "give a number above 0")),
            _ => Ok(Self::Wave),
        }
    }
}

/// What was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Threads.
    pub threads: usize,
    /// Grid unknowns.
    pub dofs: usize,
    /// Cells.
    pub cells: usize,
    /// Material points (nodes where a method has none).
    pub points: usize,
    /// Stages of a step.
    pub stages: usize,
    /// Steps that were timed.
    pub steps: usize,
    /// CPU seconds of all threads.
    pub cpu: f64,
    /// Seconds on the clock.
    pub wall: f64,
    /// Seconds per phase, summed over threads: those of the quietest step times the steps. (Phases are timed on the clock,
    /// which runs on while others have the processor.)
    pub phases: Phases,
    /// Bytes of operators, state and work.
    pub bytes: usize,
    /// The standard error where the wave has run its way, or of the last state where it has not.
    pub error: f64,
}

impl Measured {
    /// DoF-updates per CPU second.
    pub fn rate(&self) -> f64 {
        (self.dofs * self.stages * self.steps) as f64 / self.cpu
    }

    /// Cell-steps per CPU second.
    pub fn cell_steps(&self) -> f64 {
        (self.cells * self.steps) as f64 / self.cpu
    }

    /// Particle-steps per CPU second.
    pub fn particle_steps(&self) -> f64 {
        (self.points * self.steps) as f64 / self.cpu
    }
}

/// The steps of a problem and what they have cost so far.
struct Clocked<'a> {
    subject: &'a Subject,
    motion: Motion,
    quietest: Phases,
    steps: usize,
    cpu: Duration,
    wall: Duration,
}

impl Clocked<'_> {
    /// Back to the start.
    fn rewind(&mut self) -> std::result::Result<(), Loss> {
        let Motion { state, survey, work, .. } = &mut self.motion;
        let problem = &self.subject.problem;
        state.clone_from(&problem.state);
        problem.scheme.survey(state, work, survey)
    }

    /// One step and its survey; the last one of a wave ends at its end.
    fn step(&mut self) -> std::result::Result<(), Loss> {
        let Subject { problem: Problem { scheme, settings, .. }, h, .. } = self.subject;
        let Motion { state, survey, .. } = &self.motion;
        let dt = (settings.courant * h / survey.fastest).min(settings.end - state.time);
        self.motion.advance(scheme, dt)?;
        let phases = self.motion.work.take_phases();
        self.quietest.seconds.iter_mut().zip(phases.seconds).for_each(|(least, s)| *least = least.min(s));
        self.steps += 1;
        Ok(())
    }

    /// Whether the wave has run its way, to the rounding of its sum of steps.
    fn is_through(&self) -> bool {
        self.motion.state.time >= self.subject.problem.settings.end * (1.0 - 1e-12)
    }

    /// Timed steps until the wave is through or the length is reached; whether it is reached.
    fn pass(&mut self, length: Length) -> std::result::Result<bool, Loss> {
        let (cpu, wall) = (ProcessTime::now(), Instant::now());
        let mut reached = false;
        while !reached && !self.is_through() {
            self.step()?;
            reached = match length {
                Length::Wave => false,
                Length::Steps(steps) => self.steps >= steps,
                Length::Seconds(seconds) => (self.wall + wall.elapsed()).as_secs_f64() >= seconds,
            };
        }
        self.cpu += cpu.elapsed();
        self.wall += wall.elapsed();
        Ok(reached || length == Length::Wave)
    }
}

/// Before the first step.
const UNKNOWN: Phases = Phases { seconds: [f64::INFINITY; PHASES], parts: [0.0; PARTS] };

/// Steps a problem on threads of its own. The first step, which meets new memory, is not timed.
///
/// # Errors
/// Threads that cannot be started; a wave that loses stability.
pub fn measure(subject: &Subject, threads: usize, length: Length) -> Result<Measured> {
    pool(threads)?.install(|| {
        let Problem { scheme, state, .. } = &subject.problem;
        let (motion, zero) = (Motion::unsurveyed(scheme, state.clone()), Duration::ZERO);
        let mut clocked = Clocked { subject, motion, quietest: UNKNOWN, steps: 0, cpu: zero, wall: zero };
        let mut end = None;
        let outcome = steps(&mut clocked, length, &mut end);
        outcome.map_err(|loss| unstable(&loss, &clocked.motion.state))?;
        Ok(finish(clocked, threads, end.as_ref()))
    })
}

/// All passes; `end` keeps the state of the wave at its end.
fn steps(clocked: &mut Clocked, length: Length, end: &mut Option<State>) -> std::result::Result<(), Loss> {
    clocked.rewind()?;
    clocked.step()?;
    clocked.rewind()?;
    clocked.motion.work.take_phases();
    (clocked.steps, clocked.quietest) = (0, UNKNOWN);
    while !clocked.pass(length)? {
        end.get_or_insert_with(|| clocked.motion.state.clone());
        clocked.rewind()?;
        // The survey of the start belongs to no step.
        clocked.motion.work.take_phases();
    }
    Ok(())
}

fn finish(clocked: Clocked, threads: usize, end: Option<&State>) -> Measured {
    let Subject { problem: Problem { scheme, body, .. }, wave, points, .. } = clocked.subject;
    let mesh = &body.mesh;
    let error = errors(wave, mesh, scheme, end.unwrap_or(&clocked.motion.state), &body.material).standard;
    let seconds = clocked.quietest.seconds.map(|s| s * clocked.steps as f64);
    let phases = Phases { seconds, ..Phases::default() };
    let state = size_of_val(&clocked.motion.state.u[..]);
    Measured {
        threads,
        dofs: dofs(scheme),
        cells: mesh.cells.len(),
        points: *points,
        stages: scheme.stages(),
        steps: clocked.steps,
        cpu: clocked.cpu.as_secs_f64(),
        wall: clocked.wall.as_secs_f64(),
        phases,
        bytes: scheme.operators.bytes() + clocked.motion.work.bytes() + state,
        error,
    }
}

fn unstable(loss: &Loss, state: &State) -> Error {
    Error::Unstable {
        what: format!("{} in cell {} (from 0)", loss.kind, loss.cell),
        time: state.time,
        step: state.step + 1,
        remedy: "the wave is not resolved, or --set took the stability away: give more --cells".to_owned(),
    }
}
