//! Progress: a bar with ETA on a terminal, a line a second elsewhere.

use super::print::say;
use crate::error::Result;
use crate::observe::{Observer, Schedule, View, When};
use crate::step::EnergyMade;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Positions of the bar.
const TICKS: u64 = 1000;

/// Shows how far the run is.
pub struct Progress {
    schedule: Schedule,
    end: f64,
    start: Instant,
    shown: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// For a run to time `end`, s.
    pub fn new(end: f64) -> Self {
        let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {msg} eta {eta}");
        let bar = std::io::stderr().is_terminal().then(|| ProgressBar::new(TICKS));
        if let (Some(bar), Ok(style)) = (&bar, style) {
            bar.set_style(style);
        }
        let now = Instant::now();
        Self { schedule: Schedule::new(When::EverySteps(1), false), end, start: now, shown: now, bar }
    }
}

impl Observer for Progress {
    fn energy_made(&mut self, made: &EnergyMade) {
        let text = format!("warning: {made}; the run goes on");
        match &self.bar {
            // Above the bar, which stays.
            Some(bar) => bar.println(text),
            None => drop(writeln!(std::io::stderr(), "{text}")),
        }
    }

    fn notice(&mut self, text: &str) {
        say(text);
    }

    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<()> {
        let pause = if self.bar.is_some() { Duration::from_millis(100) } else { Duration::from_secs(1) };
        let done = view.state.time >= self.end;
        if self.shown.elapsed() < pause && !(done && self.bar.is_some()) {
            return Ok(());
        }
        self.shown = Instant::now();
        let share = view.state.time / self.end;
        let message = format!(
            "step {} t {:.4e} s dt {:.3e} s min J {:.4}",
            view.state.step, view.state.time, view.dt, view.survey.min_j
        );
        match &self.bar {
            Some(bar) => {
                bar.set_message(message);
                bar.set_position((share * TICKS as f64) as u64);
                if done {
                    bar.finish_and_clear();
                }
            }
            None => {
                let rest = self.start.elapsed().as_secs_f64() * (1.0 - share) / share.max(1e-9);
                // Nobody may read along: a closed pipe is no reason to stop a run.
                let _ = writeln!(std::io::stderr(), "{:5.1} % {message} eta {rest:.0} s", 100.0 * share);
            }
        }
        Ok(())
    }
}
