//! The table at the end of a run.

use super::print::{note, table, warn};
use crate::problem::Outcome;

/// Overlaps of bodies from this share of a cell on are said.
const WORTH_NAMING: f64 = 0.2;

/// The share of the energy that contact may take without a word.
const WORTH_SAYING: f64 = 0.1;

/// Prints steps, dt, seconds per phase, DoF-updates per second, memory, energy, momentum and errors; a warning where a run
/// that got to its end has made energy, or where bodies overlap.
pub fn print(outcome: &Outcome, got_to_its_end: bool) {
    table(&outcome.rows());
    let watch = &outcome.report.watch;
    if watch.warned() && got_to_its_end {
        warn(format!("{}: do not trust these results; `energy_made` in summary.json", watch.made));
    }
    if let Some(deepest) = outcome.report.in_obstacle.filter(|deepest| deepest.share > WORTH_NAMING) {
        let ([x, y], percent) = (deepest.x, 100.0 * deepest.share);
        warn(format!(
            "the body was {percent:.0} % of a cell deep in an obstacle, on the face at X = ({x:.4}, {y:.4}): an obstacle that is small beside the cells may go through it; \
             smaller cells help"
        ));
    }
    let share = outcome.report.taken_by_contact();
    if share > WORTH_SAYING {
        note(format!(
            "faces that act on each other took {:.0} % of the energy: what friction and cohesive edges do not take is lost where cells are coarse for the \
             place of contact; smaller cells or a higher degree lose less",
            100.0 * share
        ));
    }
    if let Some(overlap) = outcome.report.overlap.filter(|overlap| overlap.share > WORTH_NAMING) {
        let ([x, y], percent) = (overlap.x, 100.0 * overlap.share);
        warn(format!(
            "bodies overlap by {percent:.0} % of a cell at ({x:.4}, {y:.4}), and from 100 % on they pass through each other: smaller cells help where they are coarse for \
             the shapes there, and not where corners meet head-on, a body is thin or a soft one is hit at half of its wave speed; [limiter] kind = \"moment\" or degree = 1 \
             hold corners better"
        ));
    }
}
