//! `dgmpm study`: what accuracy costs in time.

mod compared;

use super::args::SceneArgs;
use super::keep::keep;
use super::print::say;
use super::threads::start_threads;
use crate::error::Result;
use crate::study::Session;
use compared::Compared;
use std::path::{Path, PathBuf};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    compared: Compared,
    /// Runs of a case that takes less than half a second; the fastest counts
    #[arg(long, value_name = "N", default_value_t = 3)]
    repeat: usize,
    /// Folder for table and plots [default: runs/<scene name>-study]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results of an earlier study
    #[arg(long)]
    force: bool,
    /// Threads; one by default, so that seconds are CPU seconds
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    start_threads(args.threads)?;
    let scene = args.scene.load()?;
    let plan = args.compared.request().plan(&scene)?;
    let out = args.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{}-study", scene.name())));
    keep(&out.join("study.csv"), args.force)?;
    Session::new(&scene, plan, args.repeat, out, &|text| say(text))?.run()
}
