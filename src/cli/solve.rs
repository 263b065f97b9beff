//! `dgmpm solve`: steps the conservation laws.

use super::args::{FileArgs, RunArgs, SceneArgs};
use super::interrupt::{self, INTERRUPT};
use super::print::{say, warn};
use super::progress::Progress;
use super::report::report;
use super::{summary, threads};
use crate::error::{Error, Place, Result};
use crate::problem::{Files, Problem, Setup, Store, write_input};
use crate::run::Folder;
use std::path::{Path, PathBuf};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: FileArgs,
    /// Stored matrices of `preprocess`; where they belong to other input, new ones go to the run folder
    #[arg(long, value_name = "FILE")]
    operators: Option<PathBuf>,
    #[command(flatten)]
    run: RunArgs,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    all(&args.scene, &args.files.files(), args.operators.as_deref(), &args.run)
}

/// The whole pipeline into a run folder; `operators` is used if it was built from the same input.
pub fn all(scene: &SceneArgs, files: &Files, operators: Option<&Path>, run: &RunArgs) -> Result<()> {
    run.start_threads()?;
    let kernel = threads::kernel(run.kernel.as_deref())?;
    let scene = scene.load()?;
    scene.warnings().iter().for_each(warn);
    let folder = run.folder(&scene);
    // All that can be wrong is found before results on the disk are changed.
    if !run.force {
        folder.refuse_results()?;
    }
    scene.settings()?;
    let body = files.body(&scene)?;
    scene.check_lines(&body.mesh)?;
    scene.check_regrids(&body.mesh)?;
    if let Some(missing) = operators.filter(|path| !path.exists()) {
        return Err(Error::at(Place::file(missing), "there is no such file", "make it by `dgmpm preprocess`"));
    }
    let own = folder.operators();
    let look: Vec<&Path> = operators.into_iter().chain([own.as_path()]).collect();
    let problem = Setup::of(&scene).kernel(kernel).store(Store { look: &look, write: &own }).build_on(body)?;
    say(&scene.title);
    let certificates = report(&problem)?;
    say(&problem.origin);
    folder.clear_results()?;
    write_input(&problem, files, &folder, certificates)?;
    solve(problem, &folder)
}

/// Steps to the end, and says what came of it.
fn solve(mut problem: Problem, folder: &Folder) -> Result<()> {
    interrupt::listen();
    let progress = Box::new(Progress::new(problem.settings.end));
    let (_, result) = problem.record(folder, vec![progress], &INTERRUPT, |outcome, is_done| {
        summary::print(outcome);
        if is_done && outcome.report.watch.warned() {
            let made = &outcome.report.watch.made;
            warn(format!("{made}: do not trust these results; `energy_made` in summary.json"));
        }
    });
    say(format!("results in {}", folder.root.display()));
    result
}
