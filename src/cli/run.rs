//! `dgmpm run`: all stages in one go.

use super::args::SceneArgs;
use super::output::RunArgs;
use super::pipeline;
use crate::error::Result;
use crate::problem::Files;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    run: RunArgs,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    pipeline::run(&args.scene, &Files::default(), None, &args.run)
}
