//! The whole pipeline of a scene into a run folder.

use super::args::SceneArgs;
use super::interrupt::{self, INTERRUPT, SAVE};
use super::output::{RunArgs, kept_files};
use super::print::{say, warn};
use super::progress::Progress;
use super::report::report;
use super::{ranks, summary, threads};
use crate::error::Result;
use crate::problem::{Body, Files, Problem, Setup, Store, check_folder, check_run, write_input};
use crate::run::{Folder, Lock};
use crate::scene::Scene;
use std::path::Path;

/// Makes and runs it; `operators` is used if it was built from the same input.
pub fn run(scene: &SceneArgs, files: &Files, operators: Option<&Path>, run: &RunArgs) -> Result<()> {
    let (scene, body, folder, _lock) = ranks::agree(read(scene, files, operators, run))?;
    let own = folder.operators();
    let look: Vec<&Path> = operators.into_iter().chain([own.as_path()]).collect();
    let store = Store { look: &look, write: ranks::writes().then_some(&own) };
    let setup = ranks::set_up(Setup::of(&scene).store(store));
    let built = threads::kernel(run.kernel.as_deref()).and_then(|kernel| setup.kernel(kernel).build_on(body));
    let problem = ranks::agree(built)?;
    problem.check_ranks()?;
    say(&problem.scene.title);
    let certificates = report(&problem)?;
    // Quantities that the start of the run has not.
    problem.gauge()?;
    say(&problem.origin);
    let begin = || {
        kept_files(&folder.clear_results()?);
        write_input(&problem, files, &folder, certificates)
    };
    problem.agree(if problem.writes() { begin() } else { Ok(()) })?;
    solve(problem, &folder)
}

/// Scene, body and folder: all that can be wrong is found before results on the disk are changed.
fn read(
    scene: &SceneArgs,
    files: &Files,
    operators: Option<&Path>,
    run: &RunArgs,
) -> Result<(Scene, Body, Folder, Option<Lock>)> {
    threads::start(run.threads)?;
    threads::kernel(run.kernel.as_deref())?;
    let scene = scene.load()?;
    scene.warnings().iter().for_each(warn);
    let (folder, writes) = (run.folder(&scene), ranks::writes());
    let refuse = || if run.force || !writes { Ok(()) } else { folder.refuse_results() };
    refuse()?;
    scene.settings()?;
    let body = files.body(&scene)?;
    check_run(&scene, &body, operators)?;
    let take = || check_folder((&scene, &body), files, operators, &folder).and_then(|()| folder.lock());
    let lock = writes.then(take).transpose()?;
    // Another run may have begun and ended in the meantime.
    refuse()?;
    Ok((scene, body, folder, lock))
}

/// Steps to the end, and says what came of it.
pub fn solve(mut problem: Problem, folder: &Folder) -> Result<()> {
    interrupt::listen();
    let progress = Progress::new([problem.scene.start, problem.settings.end]);
    let more = if problem.writes() { vec![Box::new(progress) as _] } else { vec![] };
    let (_, result) = problem.record(folder, more, [&INTERRUPT, &SAVE], summary::print);
    say(format!("results in {}", folder.root.display()));
    result
}
