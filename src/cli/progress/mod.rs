//! Progress: how far a run is, while it runs.

mod display;

use super::print::say;
use crate::error::Result;
use crate::observe::{Observer, Schedule, View, When};
use crate::step::EnergyMade;
use display::Display;
use std::time::Instant;

/// Shows how far the run is.
pub struct Progress {
    schedule: Schedule,
    end: f64,
    start: Instant,
    shown: Instant,
    display: Display,
}

impl Progress {
    /// For a run to time `end`, s.
    pub fn new(end: f64) -> Self {
        let (schedule, now) = (Schedule::new(When::EverySteps(1), false), Instant::now());
        Self { schedule, end, start: now, shown: now, display: Display::new() }
    }
}

impl Observer for Progress {
    fn energy_made(&mut self, made: &EnergyMade) {
        self.display.line(format!("warning: {made}; the run goes on"));
    }

    fn notice(&mut self, text: &str) {
        say(text);
    }

    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<()> {
        let (state, share) = (view.state, view.state.time / self.end);
        let done = state.time >= self.end;
        if self.display.is_due(self.shown.elapsed(), done) {
            self.shown = Instant::now();
            let (step, t, dt, min_j) = (state.step, state.time, view.dt, view.survey.min_j);
            let message = format!("step {step} t {t:.4e} s dt {dt:.3e} s min J {min_j:.4}");
            let rest = self.start.elapsed().as_secs_f64() * (1.0 - share) / share.max(1e-9);
            self.display.show(share, message, done, rest);
        }
        Ok(())
    }
}
