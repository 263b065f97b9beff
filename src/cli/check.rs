//! `dgmpm check`: all of a run but its steps and its files.

use super::args::{FileArgs, SceneArgs};
use super::print::say;
use super::report::report;
use crate::error::Result;
use crate::problem::Setup;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: FileArgs,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let scene = args.scene.load()?;
    scene.settings()?;
    let body = args.files.files().body(&scene)?;
    let problem = Setup::of(&scene).build_on(body)?;
    report(&problem)?;
    problem.check_outputs()?;
    say("the scene is complete: `dgmpm run` steps it");
    Ok(())
}
