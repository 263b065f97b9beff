//! What is measured, and everything that a step of it needs.

use super::wave::{self, Wave};
use crate::error::{Error, Result};
use crate::lane::Kernel;
use crate::mesh::{self, Mesh};
use crate::problem::room::Wanted;
use crate::problem::{self, Problem};
use crate::registry::{LAYOUTS, Method};
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// The mesh of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// Equal square cells, so many per direction, on a rectangle 1 m wide.
    Cells([usize; 2]),
    /// A mesh file of a rectangle whose sides match.
    File(PathBuf),
}

/// What is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// The method.
    pub method: Method,
    /// N = N_T.
    pub degree: usize,
    /// The mesh.
    pub domain: Domain,
    /// Layout of the material points of ADER-DGMPM; none: that of the degree.
    pub layout: Option<String>,
    /// The law, with the constants of the paper's steel.
    pub law: String,
    /// The instruction set.
    pub kernel: Kernel,
    /// Further `--set KEY=VALUE` of the scene, such as `curl.control=off`.
    pub sets: Vec<String>,
}

/// A setup that is ready to step.
pub struct Subject {
    /// Mesh, scheme and initial state.
    pub problem: Problem,
    /// Number of material points; of nodes, where a method has none.
    pub points: usize,
    /// The exact solution.
    pub wave: Wave,
    /// min_e h_e, m.
    pub h: f64,
}

impl Setup {
    /// Mesh, operators, scheme and initial state.
    ///
    /// # Errors
    /// Bad input; a size that this machine's memory cannot hold.
    pub fn build(&self) -> Result<Subject> {
        let (mesh, scene) = self.mesh()?;
        let exact = scene.build_exact().ok_or_else(|| Error::input("the scene has no [exact]", "keep that table"))?;
        let wave = Wave::new(exact);
        let mut setup = problem::Setup::of(&scene).mesh(mesh).kernel(self.kernel);
        let body = setup.body()?;
        let problem = setup.build_from(body, |mesh, scheme| Ok(wave.state(mesh, scheme)))?;
        let nodes = problem.body.mesh.cells.len() * problem.scheme.operators.nodes();
        let points = if scene.scheme.method.has_points() { problem.places() } else { nodes };
        let h = problem.body.mesh.smallest_h();
        Ok(Subject { problem, points, wave, h })
    }

    /// The mesh, once it is known to fit, and the scene on it.
    fn mesh(&self) -> Result<(Mesh, Scene)> {
        match &self.domain {
            Domain::Cells(cells) => {
                let size = [1.0, cells[1] as f64 / cells[0].max(1) as f64];
                let scene = self.scene([[0.0; 2], size])?;
                self.check_memory(cells[0].saturating_mul(cells[1]), &scene)?;
                Ok((mesh::rectangle(size, *cells)?, scene))
            }
            Domain::File(path) => {
                let mesh = wave::periodic(crate::io::read_mesh(path)?, path)?;
                let scene = self.scene(wave::extent(&mesh))?;
                self.check_memory(mesh.cells.len(), &scene)?;
                Ok((mesh, scene))
            }
        }
    }

    /// The scene; what the user names goes in as `--set`, so that messages are those of a run.
    fn scene(&self, extent: [[f64; 2]; 2]) -> Result<Scene> {
        let mut sets = vec![
            format!("scheme.method={}", self.method.name()),
            format!("scheme.degree={}", self.degree),
            format!("material.0.law={}", self.law),
        ];
        sets.extend(self.layout.as_ref().map(|layout| format!("cloud.layout={layout}")));
        sets.extend(self.sets.iter().cloned());
        Scene::parse(&wave::scene(extent), Path::new("bench.toml"), &sets)
    }

    /// Refuses what would not fit: a machine that swaps measures its disk.
    fn check_memory(&self, cells: usize, scene: &Scene) -> Result<()> {
        let layout = self.layout.as_deref().and_then(|name| LAYOUTS.find(name));
        let wanted = Wanted {
            cells,
            points: scene.cloud.per_direction.pow(2) as f64,
            own_points: self.method.has_points() && layout.is_some_and(|entry| !entry.build.is_lattice),
            own_shape: matches!(self.domain, Domain::File(_)),
        };
        match wanted.lacks(scene) {
            None => Ok(()),
            Some([needed, available]) => Err(Error::input(
                format!("{cells} cells need about {needed:.1} GiB, {available:.1} GiB are free"),
                "give fewer --cells, a lower --degree, or a lattice as --layout",
            )),
        }
    }
}
