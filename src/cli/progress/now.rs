//! Where a run is.

use crate::observe::View;
use serde_json::{Value, json};

/// What progress says of a run between two steps.
pub struct Now {
    /// The share of its time that is done.
    pub share: f64,
    /// Steps done.
    pub step: usize,
    /// Time, s.
    pub time: f64,
    /// The next step, s.
    pub dt: f64,
    /// The smallest J.
    pub min_j: f64,
}

impl Now {
    /// Of a run from `start` to `end`, s.
    pub fn of(view: &View, [start, end]: [f64; 2]) -> Self {
        let share = ((view.state.time - start) / (end - start)).clamp(0.0, 1.0);
        Self { share, step: view.state.step, time: view.state.time, dt: view.dt, min_j: view.survey.min_j }
    }

    /// In at most 54 columns, up to a million steps.
    pub fn words(&self) -> String {
        let Self { step, time, dt, min_j, .. } = self;
        format!("step {step} t {time:.3e} s dt {dt:.2e} s min J {min_j:.3}")
    }

    /// As an object, `rest` s before the end.
    pub fn json(&self, rest: f64) -> Value {
        let Self { share, step, time, dt, min_j } = self;
        json!({ "share": share, "step": step, "t": time, "dt": dt, "min_j": min_j, "seconds_left": rest })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_fits_into_a_line_of_80_columns() {
        let now = Now { share: 0.5, step: 999_999, time: 1.234e-10, dt: 1.234e-10, min_j: -1.234 };
        // A bar of 12, ` 100 % ` and ` eta 59m`: the longest that a terminal of 80 columns shows on one line.
        let line = format!("{} {:>3} % {} eta 59m", "#".repeat(12), 100, now.words());
        assert!(line.len() <= 80, "{}: {line}", line.len());
        let line = format!("{:5.1} % {} eta {:.0} s", 100.0, now.words(), 99_999.0);
        assert!(line.len() <= 80, "{}: {line}", line.len());
    }
}
