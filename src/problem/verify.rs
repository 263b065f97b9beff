//! The first steps of a run, done again beside its folder: whether this machine gives its bits.

use super::ends::Ends;
use super::{Body, Setup, Store, belongs};
use crate::error::{Error, Result};
use crate::io::checkpoint;
use crate::io::hdf5::peek_attribute;
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::lane::Kernel;
use crate::observe::{Observer, Schedule, View, When};
use crate::run::{Folder, Whole};
use crate::scene::Scene;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Steps that are done again where nobody says how many: up to the second row of the ledger, and at most so many.
const MOST: usize = 100;
/// At least so many.
const LEAST: usize = 10;

/// Looks at all files of a run: whether each is whole, of its kind and step, and of this run.
///
/// # Errors
/// A folder without a run, or with one that goes on; a scene that cannot be read.
pub fn look(folder: &Folder) -> Result<Whole> {
    let mut whole = Whole::look(folder)?;
    if whole.faults.is_empty() {
        whole.faults = belongs::faults(folder, &whole.summary)?;
    }
    Ok(whole)
}

/// What steps that were done again have shown.
#[derive(Debug, Default)]
pub struct Repeated {
    /// Steps done.
    pub steps: usize,
    /// Snapshots with the same bits, of the state at the start and of those behind it.
    pub snapshots: [usize; 2],
    /// Rows of tables with the same text, likewise.
    pub rows: [usize; 2],
    /// What a user should know of how the steps were done, a line each.
    pub notes: Vec<String>,
    /// What has other bits, a line each.
    pub differs: Vec<String>,
}

/// The instruction set that a run was stepped by: by its summary, a snapshot or a checkpoint.
///
/// # Errors
/// None of these is there; this processor lacks it.
pub fn kernel_of_run(folder: &Folder, summary: &Value) -> Result<Kernel> {
    let files = || {
        let snapshots = snapshot::list(&folder.snapshots()).unwrap_or_default();
        snapshots.into_iter().chain(checkpoint::list(&folder.checkpoints()).unwrap_or_default())
    };
    let name = summary["kernel"].as_str().map(str::to_owned);
    let name = name.or_else(|| files().find_map(|(_, path)| peek_attribute(&path, "kernel")));
    let Some(name) = name else {
        let what = format!("nothing in {} says on which instruction set the run was stepped", folder.root.display());
        return Err(Error::NotWhole(vec![what, "give --steps 0 to look at the files alone".to_owned()]));
    };
    let known = Kernel::NAMES.iter().find(|(known, _)| *known == name).map(|(_, kernel)| *kernel);
    known.filter(|kernel| kernel.is_available()).ok_or_else(|| {
        let what = format!("the files are whole, but the run was stepped by {name}, which this processor lacks");
        Error::NotWhole(vec![what, "its bits can be repeated on a processor that has it".to_owned()])
    })
}

/// Does the first steps of a run again, from its scene, mesh, points and matrices, in a private folder, and compares what comes out.
///
/// # Errors
/// Files of the run that cannot be used; steps that cannot be done.
pub fn repeat(folder: &Folder, summary: &Value, steps: Option<usize>, kernel: Kernel) -> Result<Repeated> {
    let private = tempfile::tempdir().map_err(|why| Error::output(&std::env::temp_dir(), why))?;
    let again = Folder::new(&private.path().join("again"));
    let scene = Scene::load(&folder.scene(), &[])?;
    let body = Body::read(&scene, folder, &GridFiles::default())?;
    again.clear_results()?;
    let (own, write) = (folder.operators(), again.operators());
    let store = Store { look: &[&own], write: Some(&write) };
    let mut problem = Setup::of(&scene).kernel(kernel).store(store).build_on(body)?;
    let start = problem.state.step;
    let mut out = Repeated::default();
    // A folder that `preprocess` or `--operators` has given no matrices is no fault.
    if !own.exists() {
        out.notes.push("the folder has no operators.h5: the matrices were built again".to_owned());
    }
    let (ends, shortened) = Ends::of(folder, summary, &scene, start)?;
    let mut steps = steps.unwrap_or_else(|| second_row(&folder.ledger(), start).clamp(LEAST, MOST));
    if let Some(step) = shortened.filter(|step| start + steps > *step) {
        steps = step.saturating_sub(start);
        out.notes.push(format!("steps are done again up to step {step}, at which the run was given an earlier end"));
    }
    problem.settings.end = ends.last();
    let stop = Arc::new(AtomicBool::new(steps == 0));
    let until = StopAfter {
        schedule: Schedule::new(When::EverySteps(1), false),
        last: start + steps,
        stop: stop.clone(),
        now: ends.now.clone(),
    };
    let never = AtomicBool::new(false);
    let (report, result) = problem.record(&again, vec![Box::new(until), Box::new(ends)], [&stop, &never], |_, _| {});
    match result {
        Ok(()) | Err(Error::Interrupted(_)) => {}
        Err(why) => return Err(why),
    }
    out.steps = report.steps;
    out.compare_snapshots(folder, &again, start)?;
    for table in tables(&again.root) {
        out.compare_table(folder, &again, &table);
    }
    Ok(out)
}

impl Repeated {
    fn compare_snapshots(&mut self, run: &Folder, again: &Folder, start: usize) -> Result<()> {
        let last = snapshot::list(&run.snapshots())?.last().map_or(0, |(step, _)| *step);
        for (step, path) in snapshot::list(&again.snapshots())? {
            let there = snapshot::path(&run.snapshots(), step);
            if !there.exists() {
                // A run that was killed may not have got there, and the stop of the repeated one makes a snapshot of its own.
                if step < last && step != start + self.steps {
                    self.differs.push(format!("the snapshot of step {step} is missing"));
                }
                continue;
            }
            match Snapshot::read(&there)?.bits() == Snapshot::read(&path)?.bits() {
                true => self.snapshots[usize::from(step > start)] += 1,
                false => self.differs.push(format!("the snapshot of step {step} has other bits")),
            }
        }
        Ok(())
    }

    /// The rows of a table that both have.
    fn compare_table(&mut self, run: &Folder, again: &Folder, name: &Path) {
        let text = |folder: &Folder| std::fs::read_to_string(folder.root.join(name)).unwrap_or_default();
        let (run, again) = (text(run), text(again));
        for (number, (row, wanted)) in again.lines().zip(run.lines()).enumerate() {
            if row != wanted {
                self.differs.push(format!("{} differs from line {} on", name.display(), number + 1));
                return;
            }
            // The header, the row of the start, and others.
            if number > 0 {
                self.rows[usize::from(number > 1)] += 1;
            }
        }
    }
}

/// The tables of a run whose rows no clock has a part in.
fn tables(root: &Path) -> Vec<PathBuf> {
    let mut out = vec![PathBuf::from("ledger.csv")];
    for folder in ["lines", "tracks"] {
        let files = std::fs::read_dir(root.join(folder)).into_iter().flatten().flatten();
        out.extend(files.map(|file| Path::new(folder).join(file.file_name())));
    }
    out.sort();
    out
}

/// Steps from the start to the one behind the second row of a ledger.
fn second_row(ledger: &Path, start: usize) -> usize {
    let text = std::fs::read_to_string(ledger).unwrap_or_default();
    let step = text.lines().nth(2).and_then(|row| row.split(',').next()?.parse::<f64>().ok());
    step.map_or(MOST, |step| (step as usize).saturating_sub(start) + 1)
}

/// Asks the run to stop at a step.
struct StopAfter {
    schedule: Schedule,
    last: usize,
    stop: Arc<AtomicBool>,
    /// The step that comes next.
    now: Arc<AtomicUsize>,
}

impl Observer for StopAfter {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<()> {
        let next = view.state.step + 1;
        self.now.store(next, Ordering::Relaxed);
        // The run looks at this before it shows a state, and goes on with the step under way.
        self.stop.fetch_or(next >= self.last, Ordering::Relaxed);
        Ok(())
    }
}
