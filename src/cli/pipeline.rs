//! The stages of the pipeline, as commands share them: from files where they are given, else from the scene.

use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::cloud_file::{self, More};
use crate::io::{mesh_file, operators_file};
use crate::lane::Kernel;
use crate::mesh::{Mesh, map};
use crate::observe::{Solution, export};
use crate::operators::carry::Deficient;
use crate::operators::certificate::{Certificate, Class, certify};
use crate::operators::{Blocks, Line, Operators, Sampling, Stored};
use crate::run::Folder;
use crate::scene::regrid::NewMesh;
use crate::scene::{Scene, build, portable, read_points};
use crate::state::State;
use crate::step::{Loss, Scheme};
use std::borrow::Cow;
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
    /// The material points; the scheme samples at [`Body::places`].
    pub cloud: Cloud,
    /// Whether each of them is virtual; empty where none is.
    pub virtual_points: Vec<bool>,
    /// The cells that have virtual points in place of those given, and those that sample on others than their points.
    pub deficient: Vec<Deficient>,
    /// The number of the material of each cell.
    pub material: Vec<usize>,
}

impl Body {
    /// Where the scheme samples: the material points, or the Gauss nodes.
    pub fn places(&self, scene: &Scene) -> Cow<'_, Cloud> {
        scene.places(&self.cloud, &self.material)
    }

    /// Certificates of all cells at the points where the method samples (nodes for RK), without dt.
    ///
    /// # Errors
    /// As for the fit of a cell.
    pub fn certificates(&self, scene: &Scene) -> Result<Vec<Certificate>> {
        let places = self.places(scene);
        let sampling = scene.needs(&places).sampling.unwrap_or(Sampling::Nodes);
        let mut all = certify(&self.mesh, &Line::new(scene.scheme.degree), sampling)?;
        if let Sampling::Cloud(_) = sampling {
            let on_nodes = scene.on_nodes(&self.material);
            for (cell, certificate) in all.iter_mut().enumerate() {
                if on_nodes.get(cell) == Some(&true) {
                    certificate.class = Class::Nodes;
                } else if self.virtual_points.get(self.cloud.first[cell]) == Some(&true) && certificate.points > 0 {
                    certificate.class = Class::Deficient;
                }
            }
        }
        Ok(all)
    }
}

impl Files {
    /// Reads or makes the mesh.
    pub fn mesh(&self, scene: &Scene) -> Result<Mesh> {
        let Some(path) = &self.mesh else { return scene.build_mesh() };
        let mesh = build::read_mesh(path)?;
        scene.check_groups(&mesh.groups, &mesh.edge_groups)?;
        scene.check_exact_materials(&mesh)?;
        Ok(mesh)
    }

    /// Reads or makes mesh and cloud, with virtual points where the cloud cannot carry the degree.
    pub fn body(&self, scene: &Scene) -> Result<Body> {
        if let (Some(path), true) = (&self.cloud, scene.initial.from_cloud) {
            let what = "the initial state comes from the cloud of the scene, and another is given by --cloud";
            return Err(scene.error("initial.from", what, format!("give --set cloud.path={} instead", path.display())));
        }
        let mesh = self.mesh(scene)?;
        let given = match &self.cloud {
            Some(path) => read_points(path, &mesh)?,
            None => scene.given_points(&mesh)?,
        };
        let sampled = scene.sample(&mesh, given.cloud)?;
        let mut virtual_points = sampled.virtual_points;
        // Points that were virtual before they came into a file still are.
        if given.virtual_points.iter().any(|is| *is) {
            virtual_points.resize(sampled.cloud.len(), false);
            let at = |p: usize| sampled.source.get(p).copied().unwrap_or(p);
            virtual_points.iter_mut().enumerate().for_each(|(p, is)| *is |= given.virtual_points[at(p)]);
        }
        let material = scene.material_of_cells(&mesh);
        Ok(Body { mesh, cloud: sampled.cloud, virtual_points, deficient: sampled.deficient, material })
    }
}

/// Where stored matrices may be found, and where new ones go.
pub struct Store<'a> {
    /// Files to look into, in this order.
    pub look: &'a [&'a Path],
    /// The file that new ones are written to.
    pub write: &'a Path,
}

/// The operators, and in words where their matrices come from.
///
/// # Errors
/// A cell whose points cannot carry the degree; a file that cannot be written.
pub fn operators(scene: &Scene, body: &Body, store: &Store) -> Result<(Operators, String)> {
    let places = body.places(scene);
    let needs = scene.needs(&places);
    let links = scene.links(&body.mesh)?;
    let (line, blocks) = (Line::new(needs.degree), Blocks::new(&body.material, &links));
    let key = operators_file::key(&body.mesh, &scene.periodic_groups(&body.mesh), &body.material, &needs);
    let mut notes = Vec::new();
    for path in store.look.iter().filter(|path| path.exists()) {
        // A damaged file is built again: it only holds what follows from the input.
        match operators_file::read(path, &key, &blocks, &needs) {
            Ok(Some(stored)) => {
                let from = format!("matrices reused from {}", path.display());
                return Ok((Operators::assemble(&body.mesh, line, blocks, &needs, stored), from));
            }
            Ok(None) => notes.push(format!("{} belongs to other mesh, cloud, degree or method", path.display())),
            Err(_) => notes.push(format!("{} is damaged", path.display())),
        }
    }
    let stored = Stored::build(&body.mesh, &blocks, &line, &needs)?;
    operators_file::write(store.write, &key, &stored, &body.certificates(scene)?)?;
    notes.push(format!("matrices written to {}", store.write.display()));
    Ok((Operators::assemble(&body.mesh, line, blocks, &needs, stored), notes.join("; ")))
}

/// A loss of stability in words: what, cell, point and its reference coordinates.
pub fn describe(loss: &Loss, scheme: &Scheme, mesh: &Mesh) -> String {
    let xi = match &scheme.operators.points {
        Some(points) => {
            let (block, lane) = scheme.operators.blocks.slot[loss.cell];
            [0, 1].map(|k| points.parent[2 * (points.first[block] + loss.point) + k].0[lane])
        }
        None => scheme.operators.line.basis.node_2d(loss.point),
    };
    let x = map::position(&mesh.corners(loss.cell), xi);
    let cell = mesh.number(loss.cell);
    format!("{} in cell {cell}, point {}, at X = ({:.6}, {:.6})", loss.kind, loss.point, x[0], x[1])
}

/// The scheme on the widest instruction set.
pub fn scheme(scene: &Scene, body: &Body, operators: Operators, kernel: Kernel) -> Scheme {
    scene.build_scheme(&body.mesh, operators, kernel)
}

/// Writes scene, mesh and cloud into a run folder. Paths of the scene are replaced by those of the folder, so that the
/// folder can be moved and run again. `state`, the initial one, is written at the points where the scene takes it from there.
pub fn write_input(
    scene: &Scene,
    files: &Files,
    body: &Body,
    folder: &Folder,
    certificates: Vec<Certificate>,
    (scheme, state): (&Scheme, &State),
) -> Result<()> {
    mesh_file::write_mesh(&folder.mesh(), &body.mesh)?;
    for (rule, regrid) in scene.regrids.iter().enumerate() {
        match &regrid.grid {
            NewMesh::Files(files) => {
                for (k, file) in files.iter().enumerate() {
                    let mesh = build::read_mesh(&scene.resolve(file))?;
                    mesh_file::write_mesh(&folder.root.join(portable::regrid_file(rule, k)), &mesh)?;
                }
            }
            NewMesh::Geometry { path, .. } => {
                copy(&scene.resolve(path), &folder.root.join(portable::geometry_file(rule)))?
            }
            _ => {}
        }
    }
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
    let more = More { virtual_points: body.virtual_points.clone(), fields, certificates };
    cloud_file::write_with(&folder.cloud(), &body.cloud, &body.mesh, &more)?;
    let text = scene.portable_toml(files.mesh.is_some(), files.cloud.is_some());
    crate::io::pending::write_text(&folder.scene(), &text)
}

/// Copies a file, unless it is there already.
fn copy(from: &Path, to: &Path) -> Result<()> {
    if from.canonicalize().ok().is_some_and(|from| to.canonicalize().is_ok_and(|to| to == from)) {
        return Ok(());
    }
    std::fs::copy(from, to).map(drop).map_err(|why| Error::output(to, why))
}
