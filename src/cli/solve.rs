//! `dgmpm solve`: steps the conservation laws.

use super::lost::{self, Case};
use super::pipeline::{self, Files, Store};
use super::print::{say, warn};
use super::progress::{Progress, energy_made};
use super::rebuild::{self, Built, Regrids};
use super::summary::Outcome;
use super::{RunArgs, SceneArgs, preprocess};
use crate::error::{Error, Place, Result};
use crate::io::snapshot::GridFiles;
use crate::lane::Kernel;
use crate::observe;
use crate::run::{End, Folder, Report, Run, Settings, Stop};
use crate::scene::Scene;
use crate::state::State;
use crate::step::EnergyMade;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that was ended by a second Ctrl-C, as shells have it: nothing was saved.
const KILLED: i32 = 130;
/// Set by the first Ctrl-C.
static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: Files,
    /// Stored matrices of `preprocess`; where they belong to other input, new ones go to the run folder
    #[arg(long, value_name = "FILE")]
    operators: Option<PathBuf>,
    #[command(flatten)]
    run: RunArgs,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    all(&args.scene, &args.files, args.operators.as_deref(), &args.run)
}

/// The whole pipeline into a run folder; `operators` is used if it was built from the same input.
pub fn all(scene_args: &SceneArgs, files: &Files, operators: Option<&Path>, run: &RunArgs) -> Result<()> {
    run.start_threads()?;
    let kernel = super::kernel(run.kernel.as_deref())?;
    let scene = Scene::load(&scene_args.scene, &scene_args.sets)?;
    scene.warnings().iter().for_each(warn);
    let folder = run.folder(&scene);
    // All that can be wrong is found before results on the disk are changed.
    if !run.force {
        folder.refuse_results()?;
    }
    let settings = scene.settings()?;
    let body = files.body(&scene)?;
    scene.check_lines(&body.mesh)?;
    scene.check_regrids(&body.mesh)?;
    if let Some(missing) = operators.filter(|path| !path.exists()) {
        return Err(Error::at(Place::file(missing), "there is no such file", "make it by `dgmpm preprocess`"));
    }
    let own = folder.operators();
    let look: Vec<&Path> = operators.into_iter().chain([own.as_path()]).collect();
    let (operators, origin) = pipeline::operators(&scene, &body, &Store { look: &look, write: &own })?;
    let scheme = pipeline::scheme(&scene, &body, operators, kernel);
    let state = scene.initial_state(&body.mesh, &scheme)?;
    say(&scene.title);
    let certificates = preprocess::report(&scene, &body, &scheme, &state, settings)?;
    say(origin);
    folder.clear_results()?;
    pipeline::write_input(&scene, files, &body, &folder, certificates, (&scheme, &state))?;
    let built = Built { body, scheme, files: GridFiles::default() };
    Solve { scene: &scene, folder: &folder, kernel, settings }.run(built, state)
}

struct Solve<'a> {
    scene: &'a Scene,
    folder: &'a Folder,
    kernel: Kernel,
    settings: Settings,
}

impl Solve<'_> {
    fn run(&self, mut built: Built, mut state: State) -> Result<()> {
        // A second handler (in a test that runs twice in one process) is no reason to stop.
        let _ = ctrlc::set_handler(|| {
            if INTERRUPT.swap(true, Ordering::Relaxed) {
                std::process::exit(KILLED);
            }
        });
        let mut report = Report::default();
        let ended = match self.advance(&mut built, &mut state, &mut report) {
            Ok(()) => Ended { status: "done", loss: None, result: Ok(()) },
            Err(stop) => self.stopped(stop, &built, &state, &report),
        };
        report.finish(&built.scheme, &state);
        let outcome = Outcome::new(self.scene, &built.body, &built.scheme, &state, &report);
        outcome.print();
        if let (true, Ok(())) = (report.watch.warned(), &ended.result) {
            warn(format!(
                "{}: do not trust these results; `energy_made` in summary.json",
                energy_made(&report.watch.made)
            ));
        }
        let written = outcome.write(self.folder, ended.status, ended.loss);
        say(format!("results in {}", self.folder.root.display()));
        ended.result.and(written)
    }

    /// Steps to the end, from grid to grid.
    fn advance(&self, built: &mut Built, state: &mut State, report: &mut Report) -> std::result::Result<(), Stop> {
        let (scene, folder, settings) = (self.scene, self.folder, self.settings);
        let mut observers = scene.observers(&built.body.mesh, folder)?;
        observers.push(Box::new(Progress::new(settings.end)));
        let mut regrids = Regrids::new(scene, folder, self.kernel, &built.body, state)?;
        loop {
            let (mesh, scheme) = (&built.body.mesh, &built.scheme);
            let mut run = Run { mesh, scheme, settings, observers, interrupt: &INTERRUPT };
            if run.advance_until(&mut regrids, state, report)? == End::Done {
                return Ok(());
            }
            observers = run.observers;
            let totals = regrids.rebuild(built, state).map_err(|why| rebuild::at_step(why, state))?;
            if let Some([before, after]) = totals {
                report.regrid(&before, &after);
                for observer in &mut observers {
                    observer.regrid(&built.news()).map_err(|why| rebuild::at_step(why, state))?;
                }
            }
        }
    }

    /// Keeps a good state and says why the run ended.
    fn stopped(&self, stop: Stop, built: &Built, state: &State, report: &Report) -> Ended {
        // That before a step which lost stability is nearly lost itself.
        let good = match &stop {
            Stop::Unstable(lost) => &lost.kept,
            Stop::EnergyMade(made) => &made.1,
            _ => state,
        };
        let kept = built
            .keep_files(self.folder)
            .and_then(|()| observe::write(&built.scheme, good, &built.files, &self.folder.snapshots()));
        let ended = |status, error| Ended { status, loss: None, result: Err(error) };
        match stop {
            Stop::Output(error) => ended("failed", error),
            Stop::Interrupted => {
                let place = match &kept {
                    Ok(path) => format!("the last good state is in {}", path.display()),
                    Err(why) => format!("the last good state could not be kept: {why}"),
                };
                let at = format!("at step {}, t = {:.6e} s; {place}", state.step, state.time);
                ended("interrupted", Error::Interrupted(at))
            }
            Stop::EnergyMade(made) => ended("unstable", too_much(&made.0, &kept)),
            Stop::Unstable(lost) => {
                let case = Case { scene: self.scene, built, state, report, lost: &lost };
                let (loss, error) = (Some(case.json()), case.error(&lost::kept(&lost, &kept)));
                let status = if let Error::Unstable { .. } = error { "unstable" } else { "failed" };
                Ended { status, loss, result: Err(error) }
            }
        }
    }
}

/// The error of a run that made so much energy that it was stopped.
fn too_much(made: &EnergyMade, kept: &Result<PathBuf>) -> Error {
    let place = match kept {
        Ok(path) => format!("a state of some steps before is in {}", path.display()),
        Err(why) => format!("the state of some steps before could not be kept: {why}"),
    };
    Error::Unstable {
        what: format!("the body has energy that nothing gave to it: {}", energy_made(made)),
        time: made.time,
        step: made.step,
        remedy: format!(
            "{place}; see ledger.csv for when it began; [watch] energy = {:.0e} or \"off\" lets it go on; another [curl] control, \
             points on the Gauss nodes ([cloud] layout = \"gauss\") or a finer mesh may hold it",
            10.0 * made.share
        ),
    }
}

/// How a run ended.
struct Ended {
    /// For `summary.json`.
    status: &'static str,
    /// What is known of a loss of stability, for `summary.json`.
    loss: Option<Value>,
    result: Result<()>,
}
