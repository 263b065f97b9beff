//! The whole pipeline of a scene into a run folder.

use super::args::SceneArgs;
use super::interrupt::{self, INTERRUPT, SAVE};
use super::output::{RunArgs, kept_files};
use super::print::say;
use super::progress::Progress;
use super::read::read;
use super::report::report;
use super::{ranks, summary, threads};
use crate::error::Result;
use crate::problem::{Files, Problem, Setup, Store, write_input};
use crate::run::Folder;
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
    let begin = |certificates| {
        kept_files(&folder.clear_results()?);
        write_input(&problem, files, &folder, certificates)
    };
    // All ranks drop them before the run.
    let begin = |all| match problem.writes() {
        true => begin(all),
        false => {
            drop(all);
            Ok(())
        }
    };
    problem.agree(begin(certificates))?;
    solve(problem, &folder)
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
