//! Whether the files in the folder of a run are of their kind, of their step, and of this run: by what they say of themselves, whatever
//! name they bear.

use super::{Body, differences};
use crate::error::Result;
use crate::io::checkpoint::{self, Checkpoint};
use crate::io::fingerprint::Fingerprint;
use crate::io::hdf5::peek_attribute;
use crate::io::provenance::Provenance;
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::io::{cloud_file, mesh_file, operators_file, own};
use crate::operators::Line;
use crate::run::Folder;
use crate::scene::Scene;
use serde_json::Value;
use std::collections::BTreeMap;

/// A run, by its scene and its grids.
struct Run<'a> {
    folder: &'a Folder,
    scene: Scene,
    /// Hash of what the scene says.
    hash: String,
    /// What a state on a grid is made on, and the key of its matrices, by the names of its files; in words why a grid cannot be used.
    grids: BTreeMap<[String; 2], std::result::Result<(Fingerprint, String), String>>,
}

/// What is wrong with the files of a run that are whole, a line each with the name of the file.
///
/// # Errors
/// A scene that cannot be read.
pub(super) fn faults(folder: &Folder, summary: &Value) -> Result<Vec<String>> {
    let names: Vec<String> =
        own::read(&folder.root).into_iter().filter(|name| folder.root.join(name).is_file()).collect();
    let faults: Vec<String> = names.iter().filter_map(|name| other_kind(folder, name)).collect();
    if !faults.is_empty() {
        return Ok(faults);
    }
    let scene = Scene::load(&folder.scene(), &[])?;
    let hash = differences::hash(&scene);
    // Where no file has it, the run is of a version whose scenes have other keys: then hashes of scenes say nothing.
    let mut known = names.iter().filter(|name| name.ends_with(".h5"));
    let is_known = known
        .any(|name| peek_attribute(&folder.root.join(name), "scene_hash").is_some_and(|own| own == hash))
        || summary["provenance"]["scene_hash"] == *hash;
    let hash = if is_known { hash } else { String::new() };
    let mut run = Run { folder, hash, scene, grids: BTreeMap::new() };
    let mut faults = Vec::new();
    for name in &names {
        faults.extend(run.fault_of_file(name));
    }
    faults.extend(run.fault_of_matrices());
    faults.extend(run.fault_of_summary(summary));
    Ok(faults)
}

/// The format that a file of this name has; none of names that several formats may have.
fn format_of(name: &str) -> Option<&'static str> {
    let stem = name.strip_suffix(".h5")?;
    let of_folder =
        |folder: &str| stem.strip_prefix(folder).is_some_and(|step| step.bytes().all(|c| c.is_ascii_digit()));
    match stem {
        "operators" => Some(operators_file::FORMAT.name),
        "initial" => Some(snapshot::FORMAT.name),
        "mesh" => Some(mesh_file::FORMAT.name),
        "cloud" => Some(cloud_file::FORMAT.name),
        _ if of_folder("mesh_") => Some(mesh_file::FORMAT.name),
        _ if of_folder("cloud_") => Some(cloud_file::FORMAT.name),
        _ if of_folder("snapshots/") => Some(snapshot::FORMAT.name),
        _ if of_folder("checkpoints/") => Some(checkpoint::FORMAT.name),
        _ => None,
    }
}

fn other_kind(folder: &Folder, name: &str) -> Option<String> {
    let wanted = format_of(name)?;
    let found = peek_attribute(&folder.root.join(name), "format").unwrap_or_else(|| "no file of dgmpm".to_owned());
    (found != wanted).then(|| format!("{name} is a file of another kind: `{found}` instead of `{wanted}`"))
}

impl Run<'_> {
    /// What a state on a grid is made on, and the key of its matrices.
    fn grid(&mut self, grid: &GridFiles) -> &std::result::Result<(Fingerprint, String), String> {
        let Self { folder, scene, grids, .. } = self;
        grids.entry([grid.mesh.clone(), grid.cloud.clone()]).or_insert_with(|| {
            let body = Body::read(scene, folder, grid).map_err(|why| why.to_string())?;
            let places = body.places(scene);
            let nodes = Line::new(scene.scheme.degree).nodes();
            let made_on = Fingerprint::of_body(&body.mesh, &body.material, &scene.laws(), &nodes, &places);
            let periodic = scene.periodic_groups(&body.mesh);
            let key = operators_file::key(&body.mesh, &periodic, &body.material, &scene.needs(&places));
            Ok((made_on, key))
        })
    }

    /// What is wrong with a snapshot or a checkpoint.
    fn fault_of_file(&mut self, name: &str) -> Option<String> {
        let path = self.folder.root.join(name);
        let (step, read) = match name.split_once('/')? {
            ("snapshots", step) => (step, Snapshot::read(&path)),
            ("checkpoints", step) => (step, Checkpoint::read(&path).map(|checkpoint| checkpoint.snapshot)),
            _ => return None,
        };
        let state = match read {
            Ok(state) => state,
            Err(why) => return Some(format!("{name} cannot be read: {why}")),
        };
        let step: usize = step.strip_suffix(".h5")?.parse().ok()?;
        if state.step != step {
            return Some(format!("{name} is of another step: {} instead of {step}", state.step));
        }
        self.misfit(&state.grid, &state.made_on, &state.provenance).map(|what| format!("{name} {what}"))
    }

    /// What of a state is not of this run.
    fn misfit(&mut self, grid: &GridFiles, made_on: &Fingerprint, from: &Provenance) -> Option<String> {
        let differs = |own: &str, other: &str| !own.is_empty() && !other.is_empty() && own != other;
        if differs(&from.scene, &self.hash) {
            return Some("is not of this run: scene.toml is another scene than its own".to_owned());
        }
        let (here, key) = match self.grid(grid) {
            Ok((here, key)) => (here, key),
            Err(why) => return Some(format!("has a grid that cannot be used: {why}")),
        };
        let what = made_on.misfit(here).map(|(what, _)| what);
        let what = what.or_else(|| differs(&from.operators, key).then(|| "another input of its matrices".to_owned()));
        what.map(|what| format!("is not of this run: it was made on {what} than {} and {}", grid.mesh, grid.cloud))
    }

    /// What is wrong with the stored matrices.
    fn fault_of_matrices(&mut self) -> Option<String> {
        let key = peek_attribute(&self.folder.operators(), "key")?;
        let (_, wanted) = self.grid(&GridFiles::default()).as_ref().ok()?;
        let what = "operators.h5 is not of this run: its matrices belong to another mesh, cloud, degree or method";
        (key != *wanted).then(|| what.to_owned())
    }

    /// What is wrong with the summary: it says what the last grid is made on, which a run that changes its grid need not have kept.
    fn fault_of_summary(&mut self, summary: &Value) -> Option<String> {
        let text = |key: &str| summary["provenance"][key].as_str().unwrap_or_default().to_owned();
        let (mut made_on, from) =
            (Fingerprint::by(text), Provenance { operators: String::new(), ..Provenance::by(text) });
        if self.folder.regrids().exists() {
            (made_on.mesh, made_on.points) = (String::new(), String::new());
        }
        self.misfit(&GridFiles::default(), &made_on, &from).map(|what| format!("summary.json {what}"))
    }
}
