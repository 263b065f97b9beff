//! The table at the end of a run.

use super::print::{table, warn};
use crate::problem::Outcome;

/// Prints steps, dt, seconds per phase, DoF-updates per second, memory, energy, momentum and errors; a warning where a run
/// that got to its end has made energy.
pub fn print(outcome: &Outcome, got_to_its_end: bool) {
    table(&outcome.rows());
    let watch = &outcome.report.watch;
    if watch.warned() && got_to_its_end {
        warn(format!("{}: do not trust these results; `energy_made` in summary.json", watch.made));
    }
}
