//! `dgmpm info`: what a file holds.

use super::print::result;
use crate::error::Result;
use crate::info::Info;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A mesh, geometry, scene, .h5 file, table, summary or export, or the folder of a run or of a study
    file: PathBuf,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let info = Info::of(&args.file)?;
    result(&info.rows(), &info.json());
    Ok(())
}
