//! A run whose results are kept in a folder, as `dgmpm run` keeps them.

use super::ranks::Silent;
use super::{Checkpoints, Ended, Files, Outcome, Problem, Solve, check_folder, write_input};
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::observe::Observer;
use crate::quantity::Gauge;
use crate::run::{Folder, Lock, Report, Stop};
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

    /// Steps to the end, and writes input, outputs and summary into a folder; results of an earlier run in it are removed. Of several
    /// ranks the first one writes.
    ///
    /// # Errors
    /// Files that cannot be written; a run that lost stability, whose last good state is then among the snapshots; what another
    /// rank has met.
    pub fn run_in(&mut self, folder: &Folder) -> Result<Report> {
        let begun = if self.writes() { self.begin_in(folder).map(Some) } else { Ok(None) };
        let _lock = self.agree(begun)?;
        let never = AtomicBool::new(false);
        let (report, result) = self.record(folder, vec![], [&never; 2], |_, _| {});
        result.map(|()| report)
    }

    /// Takes a folder, and writes the input of the run into it.
    fn begin_in(&self, folder: &Folder) -> Result<Lock> {
        let (files, lock) = (Files::default(), folder.lock()?);
        check_folder((&self.scene, &self.body), &files, None, folder)?;
        folder.clear_results()?;
        write_input(self, &files, folder, self.body.certificates.clone())?;
        Ok(lock)
    }

    /// Steps to the end with the outputs of the scene and `more` observers, and writes the summary; the report, and how it ended.
    /// `look` sees the outcome before it is written, and whether the run came to its end. `asked` are set from outside to stop after the
    /// step under way, and to keep the run and go on. Of several ranks the first one writes, and the `more` observers of each may not look
    /// at unknowns.
    pub fn record(
        &mut self,
        folder: &Folder,
        more: Vec<Box<dyn Observer>>,
        [interrupt, save]: [&AtomicBool; 2],
        look: impl FnOnce(&Outcome, bool),
    ) -> (Report, Result<()>) {
        let mut report = Report::default();
        let mut gauge = None;
        let ready = self.observers_of_rank(folder).and_then(|observers| {
            gauge = self.gauge()?;
            Ok(observers)
        });
        let writes = self.writes();
        let ended = self.agree(ready).map_err(Into::into).and_then(|observers| {
            self.forget_input();
            // In this order: `effects` names the clocks of observers by it.
            let mut observers: Vec<Box<dyn Observer + '_>> =
                observers.into_iter().map(|observer| observer as _).collect();
            let gauge = gauge.as_mut().map(|gauge| Box::new(gauge) as Box<dyn Observer + '_>);
            observers.extend(gauge.map(|gauge| if writes { gauge } else { Box::new(Silent(gauge)) }));
            let own = observers.len();
            observers.extend(more.into_iter().map(|observer| observer as Box<dyn Observer>));
            let checkpoints = match writes {
                true => Checkpoints::new(&self.scene, folder, save),
                false => Some(Checkpoints::silent(&self.scene, folder, save)),
            };
            let folder = writes.then_some(folder);
            self.solve(Solve { folder, observers, own, interrupt, checkpoints }, &mut report)
        });
        self.gather_shares(&mut report);
        let result = match writes {
            true => self.conclude(ended, &mut report, folder, gauge, look),
            false => ended.map_err(|stop| self.settle(stop)),
        };
        (report, self.agree(result))
    }

    /// Drops what is in the input that was written and no step looks at: the certificates, and the points on ranks that write nothing
    /// and change no grid.
    fn forget_input(&mut self) {
        self.body.certificates = vec![];
        if !self.writes() && self.scene.regrids.is_empty() {
            self.body.cloud = Cloud::default();
        }
    }

    /// Keeps what is to be kept of a run that has ended, and writes its summary; how it ended.
    fn conclude(
        &mut self,
        ended: std::result::Result<(), Stop>,
        report: &mut Report,
        folder: &Folder,
        gauge: Option<Gauge>,
        look: impl FnOnce(&Outcome, bool),
    ) -> Result<()> {
        let Ended { status, loss, result } = Ended::of(ended, self, report, folder);
        report.finish(&self.scheme, &self.state);
        let quantities = gauge.map(|gauge| gauge.measured()).unwrap_or_default();
        let outcome = Outcome { quantities, ..Outcome::new(self, report) };
        look(&outcome, result.is_ok());
        let written = outcome.write(folder, status, loss);
        result.and(written)
    }
}
