//! `dgmpm regrid`: a stopped run on another grid, in a folder that `run` goes on from.

use super::keep::keep;
use super::print::say;
use crate::error::{Error, Result};
use crate::format::{count, shell};
use crate::io::read_mesh;
use crate::problem::{Stopped, changes};
use crate::regrid::points::Policy;
use crate::run::Folder;
use std::path::{Path, PathBuf};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square
    run: PathBuf,
    /// The new mesh: any file that `dgmpm mesh` reads
    #[arg(long, value_name = "FILE")]
    mesh: PathBuf,
    /// The step whose snapshot is taken [default: the last one]
    #[arg(long, value_name = "N")]
    step: Option<usize>,
    /// What becomes of the points: keep, enrich or layout
    #[arg(long, value_name = "NAME", default_value = "keep")]
    points: String,
    /// Folder for the result [default: the run's name with -regrid]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace results of an earlier run
    #[arg(long)]
    force: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let unknown =
        || Error::input(format!("there is no --points {}", args.points), format!("give {}", Policy::listed()));
    let (from, policy) = (Folder::new(&args.run), Policy::named(&args.points).ok_or_else(unknown)?);
    let stopped = Stopped::read(&from, args.step)?;
    let mesh = read_mesh(&args.mesh)?;
    let to = Folder::new(&args.out.clone().unwrap_or_else(|| renamed(&args.run)));
    stopped.check_target(&to, &args.mesh, args.force)?;
    keep(&to.scene(), args.force)?;
    let (problem, totals) = stopped.on(mesh, policy)?;
    changes(&totals).iter().for_each(say);
    problem.write_start(&to)?;
    let (cells, root, scene) = (count(problem.body.mesh.cells.len(), "cell"), to.root.display(), to.scene());
    let on = format!("dgmpm run {} --out {} --force", shell(scene.display()), shell(&root));
    say(format!("the state on {cells} is in {root}; go on by: {on}"));
    Ok(())
}

/// `runs/square-regrid` for `runs/square`.
fn renamed(run: &Path) -> PathBuf {
    let mut name = run.file_name().unwrap_or_default().to_owned();
    name.push("-regrid");
    run.with_file_name(name)
}
