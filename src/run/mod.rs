//! The time loop.

mod folder;
mod norms;
mod report;

pub use folder::Folder;
pub use norms::norms;
pub use report::{Report, dofs};

use crate::error::Error;
use crate::mesh::Mesh;
use crate::observe::{Observer, View};
use crate::state::State;
use crate::step::{Loss, Scheme, Survey, Work};
use std::sync::atomic::{AtomicBool, Ordering};

/// How far and in what steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// End time, s.
    pub end: f64,
    /// dt = courant min_e h_e / c_max, c_max the largest current speed.
    pub courant: f64,
}

/// Why a run stopped before its end; the state is then the last good one.
#[derive(Debug)]
pub enum Stop {
    /// A step lost stability.
    Unstable(Loss),
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

/// A run: what stays the same, and the observers.
pub struct Run<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The scheme.
    pub scheme: &'a Scheme,
    /// End and step.
    pub settings: Settings,
    /// Who looks on; may be empty.
    pub observers: Vec<Box<dyn Observer + 'a>>,
    /// Set from outside to stop after the step under way.
    pub interrupt: &'a AtomicBool,
}

impl Run<'_> {
    /// Steps `state` to the end; it stays at the last good state where the run stops before.
    ///
    /// # Errors
    /// See [`Stop`].
    pub fn advance(&mut self, state: &mut State, report: &mut Report) -> Result<(), Stop> {
        let mut work = Work::new(self.scheme, state);
        let mut survey = Survey::default();
        self.scheme.survey(state, &work, &mut survey).map_err(Stop::Unstable)?;
        report.start(self.scheme, state, &work);
        let h = self.smallest_h();
        let mut next = survey.clone();
        while state.time < self.settings.end {
            let dt = self.step_size(state.time, self.settings.courant * h / survey.fastest);
            self.observe(state, &survey, dt)?;
            if self.interrupt.load(Ordering::Relaxed) {
                return Err(Stop::Interrupted);
            }
            self.scheme.step(state, dt, &survey, &mut work);
            // A step that ends at the end of the run ends there to the last bit.
            if self.settings.end - work.next.time < 1e-9 * dt {
                work.next.time = self.settings.end;
            }
            self.scheme.survey(&work.next, &work, &mut next).map_err(Stop::Unstable)?;
            std::mem::swap(state, &mut work.next);
            std::mem::swap(&mut survey, &mut next);
            report.count(dt, &survey, &mut work);
        }
        self.observe(state, &survey, f64::INFINITY)?;
        Ok(())
    }

    /// min_e h_e, m.
    fn smallest_h(&self) -> f64 {
        let operators = &self.scheme.operators;
        let blocks = operators.blocks.count.iter().zip(&operators.geometry.h);
        blocks.flat_map(|(&count, h)| &h.0[..count]).fold(f64::INFINITY, |a, b| a.min(*b))
    }

    /// The stable step, shortened evenly over the last ones before the end (or before an exact output).
    fn step_size(&mut self, time: f64, stable: f64) -> f64 {
        let stops = self.observers.iter_mut().filter_map(|o| o.schedule().stop());
        let stop = stops.filter(|&t| t > time * (1.0 + 1e-12)).fold(self.settings.end, f64::min);
        let steps = ((stop - time) / stable - 1e-9).ceil();
        // Two steps suffice for evenness: none is shorter than half of the stable one.
        if steps <= 2.0 { (stop - time) / steps.max(1.0) } else { stable }
    }

    /// Shows the state to those who wait for it.
    fn observe(&mut self, state: &State, survey: &Survey, dt: f64) -> Result<(), Error> {
        for observer in &mut self.observers {
            if observer.schedule().due(state.step, state.time, dt) {
                observer.observe(&View { mesh: self.mesh, scheme: self.scheme, state, survey, dt })?;
            }
        }
        Ok(())
    }
}
