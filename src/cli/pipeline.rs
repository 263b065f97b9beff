//! The whole pipeline of a scene into a run folder.

use super::args::SceneArgs;
use super::interrupt::{self, INTERRUPT, SAVE};
use super::output::{RunArgs, kept_files};
use super::print::{say, warn};
use super::progress::Progress;
use super::report::report;
use super::{summary, threads};
use crate::error::Result;
use crate::problem::{Files, Problem, Setup, Store, check_folder, check_run, write_input};
use crate::run::Folder;
use std::path::Path;

/// Makes and runs it; `operators` is used if it was built from the same input.
pub fn run(scene: &SceneArgs, files: &Files, operators: Option<&Path>, run: &RunArgs) -> Result<()> {
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
    check_run(&scene, &body, operators)?;
    check_folder((&scene, &body), files, operators, &folder)?;
    let _lock = folder.lock()?;
    // Another run may have begun and ended in the meantime.
    if !run.force {
        folder.refuse_results()?;
    }
    let own = folder.operators();
    let look: Vec<&Path> = operators.into_iter().chain([own.as_path()]).collect();
    let problem = Setup::of(&scene).kernel(kernel).store(Store { look: &look, write: &own }).build_on(body)?;
    say(&scene.title);
    let certificates = report(&problem)?;
    // Quantities that the start of the run has not.
    problem.gauge()?;
    say(&problem.origin);
    kept_files(&folder.clear_results()?);
    write_input(&problem, files, &folder, certificates)?;
    solve(problem, &folder)
}

/// Steps to the end, and says what came of it.
pub fn solve(mut problem: Problem, folder: &Folder) -> Result<()> {
    interrupt::listen();
    let progress = Box::new(Progress::new([problem.scene.start, problem.settings.end]));
    let (_, result) = problem.record(folder, vec![progress], [&INTERRUPT, &SAVE], summary::print);
    say(format!("results in {}", folder.root.display()));
    result
}
