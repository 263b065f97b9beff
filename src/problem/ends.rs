//! The ends that a run had one after the other, so that its steps are repeated as they were: the last two steps before an end are evened
//! out to meet it, also where the run was extended later.

use crate::error::Result;
use crate::io::checkpoint::{self, Checkpoint};
use crate::observe::{Observer, Schedule, View, When};
use crate::run::{Folder, Report};
use crate::scene::Scene;
use serde_json::Value;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Cuts the steps of a run to meet the end that it had at each of them.
pub(super) struct Ends {
    /// The step from which on the run had an end, the end, s, and the stop there.
    parts: Vec<(usize, f64, Schedule)>,
    /// The step that is done next, which another observer sets.
    pub now: Arc<AtomicUsize>,
}

impl Ends {
    /// Those of a run that began at the step `start`: by its summary, by its last checkpoint, or by its scene. Also the first step at
    /// which it was given an earlier end than it had: from there on it is not repeated.
    ///
    /// # Errors
    /// A checkpoint that cannot be read.
    pub fn of(folder: &Folder, summary: &Value, scene: &Scene, start: usize) -> Result<(Self, Option<usize>)> {
        let mut all: Vec<(usize, f64)> = serde_json::from_value(summary["ends"].clone()).unwrap_or_default();
        if let (true, Some((step, path))) = (all.is_empty(), checkpoint::list(&folder.checkpoints())?.last()) {
            let report = Checkpoint::read(path)?.parts.remove(crate::run::keep::REPORT).unwrap_or_default();
            all = Report::restored(&mut report.saved(), None)?.ends;
            // It was killed before it has kept a state under its last end.
            if all.last().is_some_and(|(_, end)| *end != scene.end) {
                all.push((*step, scene.end));
            }
        }
        if all.is_empty() {
            all.push((start, scene.end));
        }
        let shortened = all.windows(2).position(|pair| pair[1].1 < pair[0].1).map(|at| all[at + 1].0);
        all.retain(|(step, _)| shortened.is_none_or(|at| *step < at));
        let part = |(step, end): (usize, f64)| (step, end, Schedule::new(When::At(vec![end]), true));
        let parts = all.into_iter().map(part).collect();
        Ok((Self { parts, now: Arc::new(AtomicUsize::new(start)) }, shortened))
    }

    /// The last end, s.
    pub fn last(&self) -> f64 {
        self.parts.last().map_or(0.0, |(_, end, _)| *end)
    }
}

impl Observer for Ends {
    fn schedule(&mut self) -> &mut Schedule {
        let now = self.now.load(Ordering::Relaxed);
        let begun = self.parts.partition_point(|(step, ..)| *step <= now);
        // `Ends::of` has made one at least.
        &mut self.parts[begun.saturating_sub(1)].2
    }

    fn observe(&mut self, _: &View) -> Result<()> {
        Ok(())
    }
}
