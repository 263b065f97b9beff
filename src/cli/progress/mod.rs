//! Progress: how far a run is, while it runs.

mod display;
mod now;

use super::print::{say, warn};
use crate::error::Result;
use crate::observe::{Observer, Schedule, Sight, View, When};
use crate::step::EnergyMade;
use display::Display;
use now::Now;
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
        self.display.above(|| warn(format!("{made}; the run goes on")));
    }

    fn notice(&mut self, text: &str) {
        self.display.above(|| say(text));
    }

    fn looks_at(&self) -> Sight {
        Sight::Survey
    }

    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<()> {
        let now = Now::of(view, self.span);
        let done = view.state.time >= self.span[1];
        if self.display.is_due(self.shown.elapsed(), done) {
            self.shown = Instant::now();
            let rest = self.start.elapsed().as_secs_f64() * (1.0 - now.share) / now.share.max(1e-9);
            self.display.show(&now, done, rest);
        }
        Ok(())
    }
}
