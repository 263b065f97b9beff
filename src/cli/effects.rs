//! `dgmpm effects`: what a scene can ask for, and what it costs.

use super::print::{answer, say};
use crate::effects;
use crate::error::Result;
use crate::io::pending;
use crate::lane::Kernel;
use crate::study::machine;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Measure the costs on this scene instead, meshes/square_impact.toml for the stored ones (a minute or two)
    #[arg(long, value_name = "SCENE", requires = "out")]
    measure: Option<PathBuf>,
    /// Where the measured costs go, as CSV
    #[arg(long, value_name = "FILE", requires = "measure")]
    out: Option<PathBuf>,
    /// The commit that is measured, in words
    #[arg(long, value_name = "TEXT", default_value = "unknown")]
    commit: String,
    /// Folder for the files of the runs
    #[arg(long, value_name = "FOLDER", default_value = "runs/effects")]
    folder: PathBuf,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let (Some(scene), Some(out)) = (&args.measure, &args.out) else {
        effects::lines().iter().for_each(answer);
        return Ok(());
    };
    let costs = effects::measure(scene, &args.folder, &|line| say(line))?;
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    let head = [
        format!("scene {name} on one thread, commit {}", args.commit),
        machine(Kernel::widest()).split(", threads").next().unwrap_or_default().to_owned(),
    ];
    pending::write_text(out, &effects::text(&costs, &head))
}
