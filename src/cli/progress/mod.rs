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
    span: [f64; 2],
    start: Instant,
    shown: Instant,
    display: Display,
}

impl Progress {
    /// For a run from `span[0]` to `span[1]`, s.
    pub fn new(span: [f64; 2]) -> Self {
        let (schedule, now) = (Schedule::new(When::EverySteps(1), false), Instant::now());
        Self { schedule, span, start: now, shown: now, display: Display::new() }
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
        let (state, [start, end]) = (view.state, self.span);
        let (share, done) = (((state.time - start) / (end - start)).clamp(0.0, 1.0), state.time >= end);
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
