//! `dgmpm regrid`: a stopped run on another grid, in a folder that `run` goes on from.

use super::args::keep;
use super::print::say;
use crate::error::{Error, Result};
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::io::{pending, read_mesh};
use crate::observe;
use crate::problem::Problem;
use crate::regrid::points::Policy;
use crate::run::Folder;
use crate::scene::Scene;
use crate::step::Totals;
use std::path::{Path, PathBuf};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square
    run: PathBuf,
    /// The new mesh: Gmsh, or .h5 of `dgmpm mesh`
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
    let from = Folder::new(&args.run);
    let policy = policy(&args.points)?;
    let source = snapshot_of(&from, args.step)?;
    let snapshot = Snapshot::read(&source)?;
    let scene = Scene::load(&from.scene(), &[])?;
    let mesh = read_mesh(&args.mesh)?;
    let folder = Folder::new(&args.out.clone().unwrap_or_else(|| beside(&args.run)));
    if folder.root == from.root {
        return Err(Error::input("--out is the folder of the run itself", "give another folder"));
    }
    keep(&folder.scene(), args.force)?;
    let mut problem = Problem::of_snapshot(&scene, &from, &snapshot)?;
    let before = problem.scheme.totals(&problem.state);
    problem.regrid(mesh, policy)?;
    report(&before, &problem.scheme.totals(&problem.state));
    let Problem { body, scheme, state, .. } = &problem;
    folder.clear_results()?;
    let files = GridFiles::default();
    body.write(&folder, &files)?;
    let initial = folder.root.join("initial.h5");
    let path = observe::write(scheme, state, &files, &folder.snapshots())?;
    Snapshot::read(&path)?.write(&initial)?;
    pending::write_text(&folder.scene(), &scene.portable_from("initial.h5"))?;
    let (root, scene) = (folder.root.display(), folder.scene());
    say(format!(
        "the state on {} cells is in {root}; go on by: dgmpm run {} --out {root} --force",
        body.mesh.cells.len(),
        scene.display()
    ));
    Ok(())
}

fn policy(name: &str) -> Result<Policy> {
    let known = Policy::NAMES.iter().find(|(known, _)| *known == name).map(|(_, policy)| *policy);
    let names: Vec<&str> = Policy::NAMES.iter().map(|(name, _)| *name).collect();
    known.ok_or_else(|| Error::input(format!("there is no --points {name}"), format!("give {}", names.join(", "))))
}

/// `runs/square-regrid` for `runs/square`.
fn beside(run: &Path) -> PathBuf {
    let mut name = run.file_name().unwrap_or_default().to_owned();
    name.push("-regrid");
    run.with_file_name(name)
}

fn snapshot_of(from: &Folder, step: Option<usize>) -> Result<PathBuf> {
    let root = from.root.display();
    if !from.scene().is_file() {
        let what = format!("{root} is not the folder of a run: it holds no scene.toml");
        return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
    }
    let files = if from.snapshots().is_dir() { snapshot::list(&from.snapshots())? } else { vec![] };
    let found = match step {
        None => files.last(),
        Some(step) => files.iter().find(|(known, _)| *known == step),
    };
    let steps: Vec<String> = files.iter().map(|(step, _)| step.to_string()).collect();
    let remedy = match steps[..] {
        [] => "run a scene with an [[output]] of kind = \"fields\"".to_owned(),
        _ => format!("there are those of the steps {}", steps.join(", ")),
    };
    found.map(|(_, path)| path.clone()).ok_or_else(|| Error::input(format!("{root} holds no such snapshot"), remedy))
}

/// Totals before and after.
fn report(before: &Totals, after: &Totals) {
    say(format!("kinetic energy {:.9e} -> {:.9e} J/m", before.kinetic, after.kinetic));
    say(format!("strain energy {:.9e} -> {:.9e} J/m", before.strain, after.strain));
    let [a, b] = [before.momentum, after.momentum];
    say(format!("momentum ({:.9e}, {:.9e}) -> ({:.9e}, {:.9e}) kg/s", a[0], a[1], b[0], b[1]));
}
