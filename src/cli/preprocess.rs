//! `dgmpm preprocess`: all matrices, and what the run will cost.

use super::args::{FileArgs, SceneArgs};
use super::keep::keep_from;
use super::print::say;
use super::report::report;
use crate::error::Result;
use crate::io::operators_file;
use crate::problem::{Setup, Store, certificates};
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: FileArgs,
    /// Where to write; matrices that are there already are reused if they belong to the same input
    #[arg(long, value_name = "FILE", default_value = "operators.h5")]
    out: PathBuf,
    /// Build again, and replace the file whatever it is
    #[arg(long)]
    force: bool,
    /// Refuse cells whose points are beyond the limits ([cloud] face_lebesgue, condition), in place of virtual points
    #[arg(long)]
    strict: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let scene = args.scene.load()?;
    let force = args.force || operators_file::may_replace(&args.out);
    keep_from(&args.out, force, &args.files.files().inputs(&scene))?;
    scene.settings()?;
    let body = args.files.files().body(&scene)?;
    if args.strict {
        certificates::strict(&scene, &body)?;
    }
    let look = if args.force { vec![] } else { vec![args.out.as_path()] };
    let problem = Setup::of(&scene).store(Store { look: &look, write: Some(&args.out) }).build_on(body)?;
    report(&problem)?;
    say(&problem.origin);
    Ok(())
}
