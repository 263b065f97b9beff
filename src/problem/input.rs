//! The input of a run in its folder, so that the folder can be moved and run again.

use super::{Body, Files, Problem};
use crate::error::{Error, Place, Result};
use crate::io::cloud_file::{self, Extras};
use crate::io::{mesh_file, pending, seal};
use crate::observe::{Solution, export};
use crate::operators::Certificate;
use crate::registry::grids::copy;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::Path;

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
    let fields = match scene.initial.from_cloud {
        true => {
            let solution = Solution::of_state(scheme, state, &body.material);
            export::point_fields(&body.mesh, &body.cloud, &solution, &scene.fields_of_points(&solution))
        }
        false => vec![],
    };
    let more = Extras { virtual_points: body.virtual_points.clone(), fields, certificates };
    cloud_file::write_with(&folder.cloud(), &body.cloud, &body.mesh, &more)?;
    let text = scene.portable_toml(files.mesh.is_some(), files.cloud.is_some());
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
