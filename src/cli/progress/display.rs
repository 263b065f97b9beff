//! Where progress is shown: a bar on a terminal, a line a second elsewhere, an object of JSON, or nowhere. A line of it has at most
//! 80 columns.

use super::Now;
use crate::cli::print::{Manner, event, manner};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::time::Duration;

/// Positions of the bar.
const TICKS: u64 = 1000;

/// Standard error, with a bar where it is a terminal.
pub struct Display {
    bar: Option<ProgressBar>,
}

impl Display {
    /// A bar at its beginning, or nothing yet.
    pub fn new() -> Self {
        let style = ProgressStyle::with_template("{bar:12} {percent:>3} % {msg} eta {eta}");
        let has_bar = std::io::stderr().is_terminal() && manner() == Manner::Plain;
        let bar = has_bar.then(|| ProgressBar::new(TICKS));
        if let (Some(bar), Ok(style)) = (&bar, style) {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Whether it is shown at a time, the time since it was shown last, and whether the run is at its end: a bar is shown there
    /// in any case.
    pub fn is_due(&self, since: Duration, done: bool) -> bool {
        let pause = if self.bar.is_some() { Duration::from_millis(100) } else { Duration::from_secs(1) };
        manner() != Manner::Quiet && (since >= pause || (done && self.bar.is_some()))
    }

    /// Shows how far a run is, `rest` s before its end.
    pub fn show(&self, now: &Now, done: bool, rest: f64) {
        match &self.bar {
            Some(bar) => {
                bar.set_message(now.words());
                bar.set_position((now.share * TICKS as f64) as u64);
                if done {
                    bar.finish_and_clear();
                }
            }
            None if manner() == Manner::Json => event("progress", now.json(rest)),
            // Nobody may read along: a closed pipe is no reason to stop a run.
            None => drop(writeln!(std::io::stderr(), "{:5.1} % {} eta {rest:.0} s", 100.0 * now.share, now.words())),
        }
    }

    /// Runs what prints above the bar.
    pub fn above(&self, print: impl FnOnce()) {
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }
}
