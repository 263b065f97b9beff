//! The stages of the pipeline, as commands share them: from files where they are given, else from the scene.

use crate::cloud::Cloud;
use crate::error::Result;
use crate::io::{cloud_file, mesh_file, operators_file};
use crate::lane::Kernel;
use crate::mesh::{Mesh, links};
use crate::operators::{Blocks, Line, Operators, Stored};
use crate::run::Folder;
use crate::scene::{Layout, Mesh as Source, Scene, build};
use crate::step::Scheme;
use std::path::{Path, PathBuf};

/// Files of earlier stages; what is not given is made from the scene.
#[derive(Debug, Default, clap::Args)]
pub struct Files {
    /// Mesh file in place of the scene's
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Cloud file in place of the scene's
    #[arg(long, value_name = "FILE")]
    pub cloud: Option<PathBuf>,
}

/// Mesh and cloud of a scene.
pub struct Body {
    /// The mesh.
    pub mesh: Mesh,
    /// Its material points.
    pub cloud: Cloud,
    /// The number of the material of each cell.
    pub material: Vec<usize>,
}

impl Files {
    /// Reads or makes the mesh.
    pub fn mesh(&self, scene: &Scene) -> Result<Mesh> {
        let Some(path) = &self.mesh else { return scene.build_mesh() };
        let mesh = build::read_mesh(path)?;
        scene.check_groups(&mesh.groups, &mesh.edge_groups)?;
        Ok(mesh)
    }

    /// Reads or makes mesh and cloud.
    pub fn body(&self, scene: &Scene) -> Result<Body> {
        let mesh = self.mesh(scene)?;
        let cloud = match &self.cloud {
            Some(path) => build::read_cloud(path, &mesh)?,
            None => scene.build_cloud(&mesh)?,
        };
        let material = scene.material_of_cells(&mesh);
        Ok(Body { mesh, cloud, material })
    }
}

/// Stored matrices from `path` if they were built from this very input, else built and, if it is given, written there.
///
/// The second result says whether they were reused.
pub fn operators(scene: &Scene, body: &Body, path: Option<&Path>) -> Result<(Operators, bool)> {
    let needs = scene.needs(&body.cloud);
    let links = links(&body.mesh)?;
    let (line, blocks) = (Line::new(needs.degree), Blocks::new(&body.material, &links));
    let key = operators_file::key(&body.mesh, &body.material, &needs);
    let found = match path {
        // A damaged file is built again: it is only a store of what follows from the input.
        Some(path) => operators_file::read(path, &key, &blocks, &needs).unwrap_or(None),
        None => None,
    };
    let reused = found.is_some();
    let stored = match found {
        Some(stored) => stored,
        None => {
            let stored = Stored::build(&body.mesh, &blocks, &line, &needs)?;
            if let Some(path) = path {
                operators_file::write(path, &key, &stored)?;
            }
            stored
        }
    };
    Ok((Operators::assemble(&body.mesh, line, blocks, &needs, stored), reused))
}

/// The scheme on the widest instruction set.
pub fn scheme(scene: &Scene, body: &Body, operators: Operators) -> Scheme {
    scene.build_scheme(&body.mesh, operators, Kernel::widest())
}

/// Writes scene, mesh and cloud into a run folder. Paths of the scene are replaced by those of the folder, so that the
/// folder can be moved and run again.
pub fn write_input(scene: &Scene, sets: &[String], body: &Body, folder: &Folder) -> Result<()> {
    mesh_file::write_mesh(&folder.mesh(), &body.mesh)?;
    cloud_file::write_cloud(&folder.cloud(), &body.cloud, &body.mesh)?;
    let mut sets = sets.to_vec();
    if matches!(scene.mesh, Source::File(_)) {
        sets.push("mesh.file=mesh.h5".to_owned());
    }
    if matches!(scene.cloud.layout, Layout::File(_)) {
        sets.push("cloud.path=cloud.h5".to_owned());
    }
    let text = Scene::load(scene.path(), &sets)?.to_toml();
    crate::io::pending::write_text(&folder.scene(), &text)
}
