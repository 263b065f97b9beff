//! Where progress is shown: a bar on a terminal, a line a second elsewhere.

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
        let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {msg} eta {eta}");
        let bar = std::io::stderr().is_terminal().then(|| ProgressBar::new(TICKS));
        if let (Some(bar), Ok(style)) = (&bar, style) {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Whether it is shown at a time, the time since it was shown last, and whether the run is at its end: a bar is shown there
    /// in any case.
    pub fn is_due(&self, since: Duration, done: bool) -> bool {
        let pause = if self.bar.is_some() { Duration::from_millis(100) } else { Duration::from_secs(1) };
        since >= pause || (done && self.bar.is_some())
    }

    /// Shows a share of the run with a message, and `rest`, the seconds that are left, where there is no bar that knows them.
    pub fn show(&self, share: f64, message: String, done: bool, rest: f64) {
        match &self.bar {
            Some(bar) => {
                bar.set_message(message);
                bar.set_position((share * TICKS as f64) as u64);
                if done {
                    bar.finish_and_clear();
                }
            }
            // Nobody may read along: a closed pipe is no reason to stop a run.
            None => drop(writeln!(std::io::stderr(), "{:5.1} % {message} eta {rest:.0} s", 100.0 * share)),
        }
    }

    /// A line above the bar, which stays.
    pub fn line(&self, text: String) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => drop(writeln!(std::io::stderr(), "{text}")),
        }
    }
}
