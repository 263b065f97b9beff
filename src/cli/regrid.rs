//! `dgmpm regrid`: a stopped run on another grid, in a folder that `run` goes on from.

use super::keep;
use super::pipeline::{self, Body};
use super::print::say;
use super::rebuild::{internal, place_points, scale};
use crate::error::{Error, Result};
use crate::io::cloud_file::{self, More};
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::io::{mesh_file, pending};
use crate::lane::Kernel;
use crate::observe;
use crate::operators::Operators;
use crate::regrid::points::Policy;
use crate::regrid::{self, Field, Grid};
use crate::run::Folder;
use crate::scene::{Scene, build};
use crate::state::{State, UNKNOWNS};
use crate::step::{Scheme, Totals};
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
    let old = read_body(&scene, &from, &snapshot.grid)?;
    let mesh = build::read_mesh(&args.mesh)?;
    scene.check_mesh(&mesh)?;
    let folder = Folder::new(&args.out.clone().unwrap_or_else(|| beside(&args.run)));
    if folder.root == from.root {
        return Err(Error::input("--out is the folder of the run itself", "give another folder"));
    }
    keep(&folder.scene(), args.force)?;
    let scheme = build_scheme(&scene, &old)?;
    let state = state_of(&snapshot, &scheme)?;
    let (body, after, new) = moved(&scene, &old, &scheme, &state, mesh, policy)?;
    report(&scheme.totals(&state), &after.totals(&new));
    folder.clear_results()?;
    mesh_file::write_mesh(&folder.mesh(), &body.mesh)?;
    let more = More { virtual_points: body.virtual_points.clone(), ..More::default() };
    cloud_file::write_with(&folder.cloud(), &body.cloud, &body.mesh, &more)?;
    let initial = folder.root.join("initial.h5");
    let files = GridFiles::default();
    let path = observe::write(&after, &new, &files, &folder.snapshots())?;
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

fn read_body(scene: &Scene, from: &Folder, files: &GridFiles) -> Result<Body> {
    let mesh = mesh_file::read_mesh(&from.root.join(&files.mesh))?;
    let (cloud, more) = cloud_file::read_with(&from.root.join(&files.cloud), &mesh)?;
    scene.check_mesh(&mesh)?;
    let material = scene.material_of_cells(&mesh);
    Ok(Body { mesh, cloud, virtual_points: more.virtual_points, deficient: vec![], material })
}

fn build_scheme(scene: &Scene, body: &Body) -> Result<Scheme> {
    let links = scene.links(&body.mesh)?;
    let operators = Operators::build(&body.mesh, &links, &body.material, &scene.needs(&body.places(scene)))?;
    Ok(pipeline::scheme(scene, body, operators, Kernel::widest()))
}

fn state_of(snapshot: &Snapshot, scheme: &Scheme) -> Result<State> {
    let blocks = &scheme.operators.blocks;
    if snapshot.cells() != blocks.slot.len() || snapshot.degree != scheme.operators.degree {
        let what = "the snapshot does not belong to the scene and mesh of this run";
        return Err(Error::input(what, "run the scene again with --force"));
    }
    let components = if snapshot.displacement.is_empty() { UNKNOWNS } else { UNKNOWNS + 2 };
    let state = State::pack(blocks, scheme.operators.nodes(), components, &snapshot.unknowns(components));
    let unheld = blocks.pack(&snapshot.unheld, snapshot.unheld_stride(), |_| 0.0);
    let mut state = State { time: snapshot.time, step: snapshot.step, unheld, ..state };
    scheme.set_internal(&mut state, &snapshot.internal);
    Ok(state)
}

/// Body, scheme and state on the new mesh.
fn moved(
    scene: &Scene,
    old: &Body,
    scheme: &Scheme,
    state: &State,
    mesh: crate::mesh::Mesh,
    policy: Policy,
) -> Result<(Body, Scheme, State)> {
    let material = scene.material_of_cells(&mesh);
    let (from, to) = (Grid { mesh: &old.mesh, material: &old.material }, Grid { mesh: &mesh, material: &material });
    let (n, components) = (scheme.operators.nodes(), state.components);
    let (unknowns, scale) = (state.unpack(&scheme.operators.blocks, n), scale(scheme));
    let field = Field { basis: &scheme.operators.line.basis, components, u: &unknowns, scale: &scale };
    let mut moved = regrid::transfer(&from, &to, &field)?;
    let placed = place_points(scene, &from, old, &to, &moved, policy, scheme)?;
    let (cloud, virtual_points) = (placed.cloud.clone(), placed.virtual_points.clone());
    let body = Body { mesh, cloud, virtual_points, deficient: vec![], material };
    let after = build_scheme(scene, &body)?;
    regrid::curl_free(&after, components, &moved.same, &mut moved.u);
    let new = State::pack(&after.operators.blocks, n, components, &moved.u);
    let mut new = State { time: state.time, step: state.step, ..new }.holding(state, &moved.same, n);
    let to = Grid { mesh: &body.mesh, material: &body.material };
    after.set_internal(&mut new, &internal((from, &old.cloud, scheme), state, (to, &after), &moved.same, &placed)?);
    Ok((body, after, new))
}

/// Totals before and after.
fn report(before: &Totals, after: &Totals) {
    say(format!("kinetic energy {:.9e} -> {:.9e} J/m", before.kinetic, after.kinetic));
    say(format!("strain energy {:.9e} -> {:.9e} J/m", before.strain, after.strain));
    let [a, b] = [before.momentum, after.momentum];
    say(format!("momentum ({:.9e}, {:.9e}) -> ({:.9e}, {:.9e}) kg/s", a[0], a[1], b[0], b[1]));
}
