//! `dgmpm solve`: steps the conservation laws.

use super::args::{FileArgs, SceneArgs};
use super::output::RunArgs;
use super::pipeline;
use crate::error::Result;
use std::path::PathBuf;

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
    pipeline::run(&args.scene, &args.files.files(), args.operators.as_deref(), &args.run)
}
