//! How many cells a limiter and the rescue have changed in a run.

use crate::error::Result;
use crate::format::{Row, row};
use crate::step::{Counts, Scheme};
use crate::words::{Saved, Words};
use serde_json::{Value, json};

/// Sums over the steps of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Treated {
    /// Steps.
    steps: usize,
    /// Steps that were done again for some cells.
    rescues: usize,
    /// Shares of the cells, summed over steps: marked by corrections, changed by them, rescued.
    shares: [f64; 3],
    /// The largest of them in a step.
    most: [f64; 3],
}

impl Treated {
    /// For a scheme that treats cells; none else.
    pub(super) fn of(scheme: &Scheme) -> Option<Self> {
        (!scheme.corrections.is_empty() || scheme.rescue.is_some()).then(Self::default)
    }

    /// Adds a step on so many cells.
    pub(super) fn count(&mut self, counts: Counts, cells: usize) {
        self.steps += 1;
        self.rescues += usize::from(counts.rescued > 0);
        for (k, count) in [counts.marked, counts.corrected, counts.rescued].into_iter().enumerate() {
            let share = count as f64 / cells as f64;
            self.shares[k] += share;
            self.most[k] = self.most[k].max(share);
        }
    }

    pub(super) fn save(&self, to: &mut Words) {
        to.count(self.steps).count(self.rescues).reals(&self.shares).reals(&self.most);
    }

    pub(super) fn restored(from: &mut Saved) -> Result<Self> {
        let (steps, rescues) = (from.count()?, from.count()?);
        from.count()?;
        let shares = from.array()?;
        from.count()?;
        Ok(Self { steps, rescues, shares, most: from.array()? })
    }

    /// The mean share of a kind over the steps.
    fn mean(&self, k: usize) -> f64 {
        self.shares[k] / self.steps.max(1) as f64
    }

    /// As rows of a table.
    pub(super) fn rows(&self) -> Vec<Row> {
        let words =
            |k: usize| format!("{:.2} % of the cells, at most {:.2} %", 100.0 * self.mean(k), 100.0 * self.most[k]);
        let mut rows = vec![row("marked by the limiter", words(0)), row("changed by it", words(1))];
        if self.rescues > 0 {
            rows.push(row("rescued", format!("in {} steps; {}", self.rescues, words(2))));
        }
        rows
    }

    /// For `summary.json`.
    pub(super) fn json(&self) -> Value {
        let of = |k: usize| json!({ "mean": self.mean(k), "most": self.most[k] });
        json!({ "marked": of(0), "corrected": of(1), "rescued": of(2), "steps_with_rescue": self.rescues })
    }
}
