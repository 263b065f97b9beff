//! `dgmpm run`: all stages in one go.

use super::args::SceneArgs;
use super::output::RunArgs;
use super::print::say;
use super::{pipeline, ranks, resume, threads};
use crate::error::Result;
use crate::problem::{Again, Files};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    run: RunArgs,
    /// Go on where the folder has a checkpoint of this scene, otherwise begin: the same command serves again and again
    #[arg(long, conflicts_with = "force")]
    resume: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let begin = |run: &RunArgs| pipeline::run(&args.scene, &Files::default(), None, run);
    if !args.resume {
        return begin(&args.run);
    }
    let look = || {
        threads::start(args.run.threads)?;
        let scene = args.scene.load()?;
        let folder = args.run.folder(&scene);
        Ok((Again::look(&scene, &folder)?, folder))
    };
    let (again, folder) = ranks::agree(look())?;
    ranks::check_same(again.number(), "state of the folder of the run")?;
    match again {
        Again::Begins { replaces } => begin(&RunArgs { force: replaces, ..args.run.clone() }),
        Again::GoesOn(scene) => resume::go_on(&folder, args.run.kernel.as_deref(), |_| Ok(*scene)),
        Again::Done(words) => {
            say(words);
            Ok(())
        }
    }
}
