//! `dgmpm resume`: goes on with a run from its last checkpoint, as if it had never stopped.

use super::pipeline::solve;
use super::print::{say, warn};
use super::{ranks, threads};
use crate::error::Result;
use crate::problem::Newest;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square
    run: PathBuf,
    /// Override title, time.end, [watch] or [checkpoint]: a later end extends a run that is done
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Threads [default: all processors]; the results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Instruction set; it has to be that of the run
    #[arg(long, value_name = "NAME")]
    kernel: Option<String>,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    ranks::agree(threads::start(args.threads))?;
    let scene = |folder: &Folder| Scene::load(&folder.scene(), &args.sets);
    go_on(&Folder::new(&args.run), args.kernel.as_deref(), scene)
}

/// Goes on with the run of a folder, with a scene.
pub fn go_on(folder: &Folder, kernel: Option<&str>, scene: impl FnOnce(&Folder) -> Result<Scene>) -> Result<()> {
    let ready = || {
        let kernel = kernel.map(|name| threads::kernel(Some(name))).transpose()?;
        // A folder without a run is not locked, which would make it; and another run may have gone on until the lock was had.
        Newest::read(folder)?;
        let lock = ranks::writes().then(|| folder.lock()).transpose()?;
        let newest = Newest::read(folder)?;
        newest.damaged.iter().for_each(warn);
        let (at, path) = (newest.at(), newest.path.clone());
        let (problem, later) = newest.open(folder, scene(folder)?, kernel, ranks::exchange())?;
        Ok((problem, later, (at, path), lock))
    };
    let (problem, later, ((time, step), path), _lock) = ranks::agree(ready())?;
    problem.check_ranks()?;
    problem.agree(if problem.writes() { later.remove(folder, &problem.scene) } else { Ok(()) })?;
    say(&problem.scene.title);
    say(format!("resumed at step {step}, t = {time:.6e} s, from {}", path.display()));
    solve(problem, folder)
}
