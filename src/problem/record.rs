//! A run whose results are kept in a folder, as `dgmpm run` keeps them.

use super::{Checkpoints, Ended, Files, Outcome, Problem, Solve, check_folder, write_input};
use crate::error::{Error, Result};
use crate::observe::Observer;
use crate::run::{Folder, Report};
use std::sync::atomic::AtomicBool;

impl Problem {
    /// Makes the outputs and quantities of the scene in a private folder, and drops them.
    ///
    /// # Errors
    /// One that cannot be made, such as a line outside of the body.
    pub fn check_outputs(&self) -> Result<()> {
        let private = tempfile::tempdir().map_err(|why| Error::output(&std::env::temp_dir(), why))?;
        self.observers(&Folder::new(private.path()))?;
        self.gauge().map(drop)
    }

    /// Steps to the end, and writes input, outputs and summary into a folder; results of an earlier run in it are removed.
    ///
    /// # Errors
    /// Files that cannot be written; a run that lost stability, whose last good state is then among the snapshots.
    pub fn run_in(&mut self, folder: &Folder) -> Result<Report> {
        let files = Files::default();
        let _lock = folder.lock()?;
        check_folder((&self.scene, &self.body), &files, None, folder)?;
        folder.clear_results()?;
        write_input(self, &files, folder, self.body.certificates.clone())?;
        let never = AtomicBool::new(false);
        let (report, result) = self.record(folder, vec![], [&never; 2], |_, _| {});
        result.map(|()| report)
    }

    /// Steps to the end with the outputs of the scene and `more` observers, and writes the summary; the report, and how it ended.
    /// `look` sees the outcome before it is written, and whether the run came to its end. `asked` are set from outside to stop after the
    /// step under way, and to keep the run and go on.
    pub fn record(
        &mut self,
        folder: &Folder,
        more: Vec<Box<dyn Observer>>,
        [interrupt, save]: [&AtomicBool; 2],
        look: impl FnOnce(&Outcome, bool),
    ) -> (Report, Result<()>) {
        let mut report = Report::default();
        let mut gauge = None;
        let ready = self.observers(folder).and_then(|observers| {
            gauge = self.gauge()?;
            Ok(observers)
        });
        let ended = ready.map_err(Into::into).and_then(|observers| {
            // In this order: `effects` names the clocks of observers by it.
            let mut observers: Vec<Box<dyn Observer + '_>> =
                observers.into_iter().map(|observer| observer as _).collect();
            observers.extend(gauge.as_mut().map(|gauge| Box::new(gauge) as Box<dyn Observer + '_>));
            let own = observers.len();
            observers.extend(more.into_iter().map(|observer| observer as Box<dyn Observer>));
            let checkpoints = Checkpoints::new(&self.scene, folder, save);
            self.solve(Solve { folder: Some(folder), observers, own, interrupt, checkpoints }, &mut report)
        });
        let Ended { status, loss, result } = Ended::of(ended, self, &report, folder);
        report.finish(&self.scheme, &self.state);
        let quantities = gauge.map(|gauge| gauge.measured()).unwrap_or_default();
        let outcome = Outcome { quantities, ..Outcome::new(self, &report) };
        look(&outcome, result.is_ok());
        let written = outcome.write(folder, status, loss);
        (report, result.and(written))
    }
}
