//! Mesh and material points of a problem, and what each cell can carry.

use super::points::{Given, read_points};
use crate::cloud::Cloud;
use crate::error::Result;
use crate::io::cloud_file::{self, Extras};
use crate::io::snapshot::GridFiles;
use crate::io::{has_own_names, mesh_file, read_tagged};
use crate::mesh::Mesh;
use crate::operators::carry::Deficient;
use crate::operators::certificate::{Certificate, Class, certify};
use crate::operators::{Line, Sampling};
use crate::run::Folder;
use crate::scene::Scene;
use std::borrow::Cow;
use std::path::PathBuf;

/// Files of earlier stages; what is not given is made from the scene.
#[derive(Debug, Default, Clone)]
pub struct Files {
    /// A mesh file in place of the scene's.
    pub mesh: Option<PathBuf>,
    /// A cloud file in place of the scene's.
    pub cloud: Option<PathBuf>,
}

impl Files {
    /// Reads or makes the mesh.
    ///
    /// # Errors
    /// A mesh that cannot be read, or whose groups are not those of the scene.
    pub fn mesh(&self, scene: &Scene) -> Result<Mesh> {
        let Some(path) = &self.mesh else { return scene.build_mesh() };
        // Numbers of groups mean the same in it, and the lines of the scene are those of another mesh.
        let tags = if has_own_names(path)? { Default::default() } else { scene.tags(None) };
        let mesh = scene.cut_mesh(read_tagged(path, &tags)?)?;
        scene.check_exact_materials(&mesh)?;
        Ok(mesh)
    }

    /// Reads or makes mesh and cloud, with virtual points where the cloud cannot carry the degree.
    ///
    /// # Errors
    /// A file that cannot be read or does not fit the scene.
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
        Body::new(scene, mesh, given)
    }
}

/// Mesh and material points.
#[derive(Debug, Clone, PartialEq)]
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
    /// What the scheme samples on in each cell (nodes for Runge-Kutta), without dt; empty of a body that was read or rebuilt.
    pub certificates: Vec<Certificate>,
}

impl Body {
    /// A mesh with points, and virtual points where these cannot carry the degree of the scene.
    ///
    /// # Errors
    /// A part of the body without any point.
    pub fn new(scene: &Scene, mesh: Mesh, given: Given) -> Result<Self> {
        let sampled = scene.sample(&mesh, given.cloud)?;
        let mut virtual_points = sampled.virtual_points;
        // Points that were virtual before they came into a file still are.
        if given.virtual_points.iter().any(|is| *is) {
            virtual_points.resize(sampled.cloud.len(), false);
            let at = |p: usize| sampled.source.get(p).copied().unwrap_or(p);
            virtual_points.iter_mut().enumerate().for_each(|(p, is)| *is |= given.virtual_points[at(p)]);
        }
        let mut certificates = sampled.certificates;
        for (cell, certificate) in certificates.iter_mut().enumerate() {
            let is_virtual = virtual_points.get(sampled.cloud.first[cell]) == Some(&true);
            if is_virtual && certificate.class != Class::Nodes {
                certificate.class = Class::Deficient;
            }
        }
        let material = scene.material_of_cells(&mesh);
        Ok(Self { mesh, cloud: sampled.cloud, virtual_points, deficient: sampled.deficient, material, certificates })
    }

    /// A mesh with points as they are.
    pub fn as_placed(mesh: Mesh, cloud: Cloud, virtual_points: Vec<bool>, material: Vec<usize>) -> Self {
        Self { mesh, cloud, virtual_points, deficient: vec![], material, certificates: vec![] }
    }

    /// A grid of a run folder.
    ///
    /// # Errors
    /// Files that cannot be read, or whose groups are not those of the scene.
    pub fn read(scene: &Scene, folder: &Folder, files: &GridFiles) -> Result<Self> {
        let mesh = mesh_file::read_mesh(&folder.root.join(&files.mesh))?;
        let (cloud, more) = cloud_file::read_with(&folder.root.join(&files.cloud), &mesh)?;
        scene.check_mesh(&mesh)?;
        let material = scene.material_of_cells(&mesh);
        Ok(Self { certificates: more.certificates, ..Self::as_placed(mesh, cloud, more.virtual_points, material) })
    }

    /// Finds the certificates of all cells at the points where the scheme samples (nodes for Runge-Kutta).
    ///
    /// # Errors
    /// As for the fit of a cell.
    pub fn certify(&mut self, scene: &Scene) -> Result<()> {
        let places = self.places(scene);
        let sampling = scene.needs(&places).sampling.unwrap_or(Sampling::Nodes);
        let mut all = certify(&self.mesh, &Line::new(scene.scheme.degree), sampling)?;
        if let Sampling::Cloud(_) = sampling {
            let on_nodes = scene.on_nodes(&self.material);
            for (cell, certificate) in all.iter_mut().enumerate() {
                if on_nodes.get(cell) == Some(&true) {
                    certificate.class = Class::Nodes;
                } else if self.virtual_points.get(self.cloud.first[cell]) == Some(&true) {
                    certificate.class = Class::Deficient;
                }
            }
        }
        self.certificates = all;
        Ok(())
    }

    /// Writes mesh and points into a run folder.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, folder: &Folder, files: &GridFiles) -> Result<()> {
        mesh_file::write_mesh(&folder.root.join(&files.mesh), &self.mesh)?;
        let more = Extras { virtual_points: self.virtual_points.clone(), ..Extras::default() };
        cloud_file::write_with(&folder.root.join(&files.cloud), &self.cloud, &self.mesh, &more)
    }

    /// Writes mesh and points into a run folder where they are not there yet.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn keep(&self, folder: &Folder, files: &GridFiles) -> Result<()> {
        match folder.root.join(&files.mesh).exists() && folder.root.join(&files.cloud).exists() {
            true => Ok(()),
            false => self.write(folder, files),
        }
    }

    /// Where the scheme samples: the material points, or the Gauss nodes.
    pub fn places(&self, scene: &Scene) -> Cow<'_, Cloud> {
        scene.places(&self.cloud, &self.material)
    }
}
