//! The time loop from grid to grid.

use super::checkpoints::OnGrid;
use super::{Checkpoints, Problem, Regrids, Resumed};
use crate::error::{Error, Result};
use crate::observe::{NewGrid, Observer};
use crate::run::keep::{self, Keep, MOTION, PAUSE, REPORT};
use crate::run::{End, Folder, Pause, Report, Run, Stop};
use crate::words::Saved;
use cpu_time::ProcessTime;
use std::sync::atomic::AtomicBool;

/// Who looks on, and where files go.
pub struct Solve<'a> {
    /// The folder of the run; none: regrids write no files.
    pub folder: Option<&'a Folder>,
    /// Who looks on; may be empty.
    pub observers: Vec<Box<dyn Observer + 'a>>,
    /// How many observers, from the first on, go on with what a checkpoint has of them.
    pub own: usize,
    /// Set from outside to stop after the step under way.
    pub interrupt: &'a AtomicBool,
    /// What keeps the run; none: nothing does.
    pub checkpoints: Option<Checkpoints<'a>>,
}

impl Problem {
    /// Steps to the end without outputs, from grid to grid where the scene has `[[regrid]]`.
    ///
    /// # Errors
    /// A run that lost stability ([`Error::Unstable`]); the state is then a good one of some steps before.
    pub fn run(&mut self) -> Result<Report> {
        let never = AtomicBool::new(false);
        let mut report = Report::default();
        let with = Solve { folder: None, observers: vec![], own: 0, interrupt: &never, checkpoints: None };
        let stop = self.solve(with, &mut report).err();
        let stop = stop.map(|stop| self.settle(stop));
        self.gather_shares(&mut report);
        report.finish(&self.scheme, &self.state);
        stop.map_or(Ok(report), Err)
    }

    /// Steps to the end, from grid to grid. Where the run stops before, the state is the one before the step that failed.
    ///
    /// # Errors
    /// See [`Stop`].
    pub fn solve(&mut self, with: Solve, report: &mut Report) -> std::result::Result<(), Stop> {
        let Solve { folder, mut observers, own, interrupt, mut checkpoints } = with;
        self.check_ranks()?;
        let resumed = self.resumed.take();
        let ready = Regrids::new(self, folder).and_then(|mut regrids| {
            let Some(resumed) = resumed else { return Ok(regrids) };
            *report = Report::restored(&mut resumed.part(REPORT)?.saved(), self.settings.watch)?;
            restore(&resumed, &mut observers[..own], &mut regrids, &self.grid())?;
            if let Some(checkpoints) = &mut checkpoints {
                checkpoints.observed = resumed.observed;
                checkpoints.motion = Some(resumed.part(MOTION)?.clone());
            }
            Ok(regrids)
        });
        let mut regrids = self.agree(ready)?;
        loop {
            let Self { body, scheme, settings, state, files, .. } = self;
            let mut run = Run { mesh: &body.mesh, scheme, settings: *settings, observers, interrupt };
            let mut keep = checkpoints.as_mut().map(|checkpoints| OnGrid { checkpoints, body, files });
            let keep = keep.as_mut().map(|keep| keep as &mut dyn Keep);
            if run.advance_kept(&mut regrids, keep, state, report)? == End::Done {
                return Ok(());
            }
            observers = run.observers;
            if let Some(checkpoints) = &mut checkpoints {
                checkpoints.observed = Some(self.state.step);
            }
            let (step, time) = (self.state.step, self.state.time);
            let named = |why| at_step(why, step, time);
            let clock = ProcessTime::now();
            let built = regrids.rebuild(self).map_err(named);
            let (words, totals) = self.agree(built)?;
            self.check_ranks()?;
            report.regrids = (report.regrids.0 + clock.elapsed().as_secs_f64(), report.regrids.1 + 1);
            observers.iter_mut().for_each(|observer| words.iter().for_each(|word| observer.notice(word)));
            if let Some([before, after]) = totals {
                report.regrid(&before, &after);
                let told = observers.iter_mut().try_for_each(|observer| observer.regrid(&self.grid()).map_err(named));
                self.agree(told)?;
            }
        }
    }

    /// Takes the last good state that a stop has kept; the stop as an error.
    pub(super) fn settle(&mut self, stop: Stop) -> Error {
        match stop {
            Stop::Output(error) => error,
            Stop::Interrupted => Error::Interrupted(format!("at step {}", self.state.step)),
            Stop::Unstable(lost) => {
                let (what, time, step) = (self.describe(&lost.loss), lost.time, lost.step);
                self.state = lost.kept;
                unstable(what, time, step)
            }
            Stop::EnergyMade(made) => {
                self.state = made.1;
                unstable(made.0.to_string(), made.0.time, made.0.step)
            }
        }
    }
}

/// Gives back what was saved of regrids and observers, which have been made for the present grid.
fn restore(
    resumed: &Resumed,
    observers: &mut [Box<dyn Observer + '_>],
    regrids: &mut Regrids,
    grid: &NewGrid,
) -> Result<()> {
    let whole =
        |mut saved: Saved, take: &mut dyn FnMut(&mut Saved) -> Result<()>| take(&mut saved).and_then(|()| saved.end());
    whole(resumed.part(PAUSE)?.saved(), &mut |from| {
        regrids.restore(from)?;
        if !regrids.writes() {
            // What is left is of the table.
            from.skip();
        }
        Ok(())
    })?;
    for (number, observer) in observers.iter_mut().enumerate() {
        observer.regrid(grid)?;
        whole(resumed.part(&keep::observer(number))?.saved(), &mut |from| {
            observer.schedule().resume(from.count()?);
            observer.restore(from)
        })?;
    }
    Ok(())
}

fn unstable(what: String, time: f64, step: usize) -> Error {
    let remedy = "the state is a good one of some steps before; a finer mesh or a smaller step may hold it".to_owned();
    Error::Unstable { what, time, step, remedy }
}

/// An error that names the regrid.
fn at_step(error: Error, step: usize, time: f64) -> Error {
    match error {
        Error::Input { what, place, remedy } => {
            Error::Input { what: format!("regrid at step {step}, t = {time:.6e} s: {what}"), place, remedy }
        }
        other => other,
    }
}
