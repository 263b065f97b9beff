//! The input of a run in its folder, so that the folder can be moved and run again.

use super::{Body, Files, Problem};
use crate::error::{Error, Place, Result};
use crate::io::cloud_file::{self, Extras};
use crate::io::snapshot::Snapshot;
use crate::io::{mesh_file, pending, read_mesh, regular, seal};
use crate::observe::{Solution, export};
use crate::operators::Certificate;
use crate::registry::grids::copy;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// Checks what a run of the scene will ask for later: the places of its lines and quantities, its later grids and a file of `operators`.
///
/// # Errors
/// Bad input, with its place.
pub fn check_run(scene: &Scene, body: &Body, operators: Option<&Path>) -> Result<()> {
    scene.check_lines(&body.mesh)?;
    scene.check_quantities(&body.mesh)?;
    scene.check_regrids(&body.mesh)?;
    match operators.filter(|path| !path.exists()) {
        Some(missing) => Err(Error::at(Place::file(missing), "there is no such file", "make it by `dgmpm preprocess`")),
        None => Ok(()),
    }
}

/// Refuses a folder in which a run would write over files that are not its own, or remove files that it starts from. Changes nothing.
///
/// # Errors
/// Bad input, which names the file.
pub fn check_folder(
    (scene, body): (&Scene, &Body),
    files: &Files,
    operators: Option<&Path>,
    folder: &Folder,
) -> Result<()> {
    let text = scene.folder_toml(files.mesh.is_some(), files.cloud.is_some());
    let sources = sources(scene, files, operators, folder);
    let same = |name: &str| match name {
        "scene.toml" => std::fs::read_to_string(folder.scene()).is_ok_and(|there| there == text),
        "mesh.h5" => mesh_file::read_mesh(&folder.mesh()).is_ok_and(|there| there == body.mesh),
        // Matrices of another problem are refused where they would be replaced.
        "operators.h5" => true,
        // Written only for a scene that names such a file.
        _ if name.starts_with("initial") || name.starts_with("boundary_") || name.starts_with("regrid_") => {
            sources.iter().all(|source| source.target != folder.root.join(name))
        }
        _ => false,
    };
    if let Some(name) = folder.foreign().into_iter().find(|name| !same(name)) {
        return Err(foreign(folder, &name));
    }
    let is_same = |a: &Path, b: &Path| a.canonicalize().ok().is_some_and(|a| b.canonicalize().ok() == Some(a));
    match sources.iter().find(|source| !is_same(&source.path, &source.target) && folder.takes(&source.path)) {
        None => Ok(()),
        Some(source) => {
            let (path, root) = (source.path.display(), folder.root.display());
            let what = format!("{path} lies in {root}, where this run removes it or writes another file");
            let remedy = "give another folder by --out, or copy the file out of this folder and name the copy";
            Err(scene.error(&source.key, what, remedy))
        }
    }
}

/// Refuses a scene whose mesh, points or files are not those that the run in a folder began with.
///
/// # Errors
/// The file that differs, at the key that names it.
pub(super) fn check_same_input(scene: &Scene, body: &Body, folder: &Folder) -> Result<()> {
    let fail = |key: &str, name: &str| {
        let what = format!("this is not what the run in {} began with: its {name} differs", folder.root.display());
        Err(scene.error(key, what, "give another folder by --out, or the input of that run"))
    };
    if mesh_file::read_mesh(&folder.mesh())? != body.mesh {
        return fail("mesh", "mesh.h5");
    }
    if cloud_file::read_with(&folder.cloud(), &body.mesh)?.0 != body.cloud {
        return fail("cloud", "cloud.h5");
    }
    let text = |path: &Path| {
        let text =
            regular::text(path, u64::MAX).map_err(|why| Error::at(Place::file(path), why, "give a text file"))?;
        Ok::<_, Error>(seal::unsealed(&text).trim_end().to_owned())
    };
    for Source { key, path, target } in sources(scene, &Files::default(), None, folder) {
        let name = target.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let same = match &name[..] {
            "mesh.h5" | "cloud.h5" => true,
            "initial.h5" => Snapshot::read(&path)?.bits() == Snapshot::read(&target)?.bits(),
            "initial.vtu" => scene.same_fields(&target)?,
            _ if name.ends_with(".h5") => read_mesh(&path)? == read_mesh(&target)?,
            _ => text(&path)? == text(&target)?,
        };
        if !same {
            return fail(&key, &name);
        }
    }
    Ok(())
}

/// The error of a file that is not the run's to replace.
pub(super) fn foreign(folder: &Folder, name: &str) -> Error {
    let path = folder.root.join(name);
    if !folder.has_list() && folder.scene().is_file() && folder.summary().is_file() {
        let what = format!(
            "{} is in the way: the folder has no list of files (.dgmpm), as runs of earlier versions",
            path.display()
        );
        return Error::input(
            what,
            "give another folder by --out; or remove this one yourself, if nothing in it is needed",
        );
    }
    let what =
        format!("{} is in the way: it is not on the list of the files that dgmpm has made there", path.display());
    Error::input(what, "give another folder by --out, or move the file (also --force leaves files of others alone)")
}

/// A file that a scene names.
struct Source {
    /// The key that names it.
    key: String,
    /// Where it is.
    path: PathBuf,
    /// Where its copy goes.
    target: PathBuf,
}

impl Files {
    /// All files that a scene is computed from with these, the scene among them.
    pub fn inputs(&self, scene: &Scene) -> Vec<PathBuf> {
        let folder = Folder::new(Path::new(""));
        let all = sources(scene, self, None, &folder).into_iter().map(|source| source.path);
        all.chain([scene.path().to_owned()]).collect()
    }
}

/// All files that a run starts from.
fn sources(scene: &Scene, files: &Files, operators: Option<&Path>, folder: &Folder) -> Vec<Source> {
    let source = |key: &str, path: PathBuf, target: PathBuf| Source { key: key.to_owned(), path, target };
    let mesh = files.mesh.clone().or_else(|| scene.mesh_path()).map(|path| source("mesh.file", path, folder.mesh()));
    let facets = scene.mesh_groups.facets.as_ref().filter(|_| files.mesh.is_none());
    let facets = facets.map(|path| source("mesh.facets", scene.resolve(path), folder.mesh()));
    let cloud = files.cloud.clone().or_else(|| scene.cloud_path());
    let cloud = cloud.map(|path| source("cloud.path", path, folder.cloud()));
    let snapshot = scene.initial.snapshot.as_ref();
    let snapshot = snapshot.map(|path| source("initial.snapshot", scene.resolve(path), folder.root.join("initial.h5")));
    let fields = scene.initial.fields.as_ref();
    let fields = fields.map(|f| source("initial.fields", scene.resolve(&f.path), folder.root.join("initial.vtu")));
    let operators = operators.map(|path| source("scheme", path.to_owned(), folder.operators()));
    let mut out: Vec<Source> = [mesh, facets, cloud, snapshot, fields, operators].into_iter().flatten().collect();
    for (number, boundary) in scene.boundaries.iter().enumerate() {
        for (parameter, file) in boundary.condition.files() {
            let target = folder.root.join(Scene::stored_loads(number, parameter.name));
            out.push(source(&format!("boundary.{number}.{}", parameter.name), scene.resolve(Path::new(file)), target));
        }
    }
    for (rule, regrid) in scene.regrids.iter().enumerate() {
        let (grid, Some(stored)) = (&regrid.grid, regrid.grid.build().files) else { continue };
        for (k, file) in grid.values.texts(grid.name()).iter().enumerate() {
            let (key, target) = (format!("regrid.{rule}.{}", grid.name()), folder.root.join((stored.name)(rule, k)));
            out.push(source(&key, scene.resolve(Path::new(file)), target));
        }
    }
    out
}

/// Writes scene, mesh and cloud into a run folder. Paths of the scene are replaced by those of the folder. The initial state is
/// written at the points where the scene takes it from there.
///
/// # Errors
/// Files that cannot be read or written.
pub fn write_input(problem: &Problem, files: &Files, folder: &Folder, certificates: Vec<Certificate>) -> Result<()> {
    let Problem { scene, body, scheme, state, .. } = problem;
    mesh_file::write_mesh(&folder.mesh(), &body.mesh)?;
    write_later_grids(problem, folder)?;
    scene.store_loads(folder)?;
    if let Some(snapshot) = &scene.initial.snapshot {
        copy(&scene.resolve(snapshot), &folder.root.join("initial.h5"))?;
    }
    scene.store_fields(&folder.root.join("initial.vtu"))?;
    let fields = match scene.initial.from_cloud {
        true => {
            let solution = Solution::of_state(scheme, state, &body.material);
            export::point_fields(&body.mesh, &body.cloud, &solution, &scene.fields_of_points(&solution))
        }
        false => vec![],
    };
    let more = Extras { virtual_points: body.virtual_points.clone(), fields, certificates };
    cloud_file::write_with(&folder.cloud(), &body.cloud, &body.mesh, &more)?;
    let text = scene.folder_toml(files.mesh.is_some(), files.cloud.is_some());
    pending::write_text(&folder.scene(), &seal::text(&text, seal::TOML))
}

/// The files that `[[regrid]]` names.
fn write_later_grids(problem: &Problem, folder: &Folder) -> Result<()> {
    let scene = &problem.scene;
    for (rule, regrid) in scene.regrids.iter().enumerate() {
        let (values, Some(stored)) = (&regrid.grid.values, regrid.grid.build().files) else { continue };
        for (k, file) in values.texts(regrid.grid.name()).iter().enumerate() {
            (stored.store)(&scene.resolve(Path::new(file)), &folder.root.join((stored.name)(rule, k)))?;
        }
    }
    Ok(())
}
