//! A problem that is ready to run: mesh, points, matrices, scheme and state, made from a scene.
//!
//! [`Problem::load`] reads a scene file and makes all of it; [`Problem::run`] steps to the end. [`Setup`] makes a problem of
//! a scene in which something is given from outside: the mesh, the points, the instruction set, stored matrices. The program,
//! studies, benches and tests all build their problems here. Nothing is printed: progress and notices go to observers.
//!
//! ```no_run
//! use dgmpm::Problem;
//!
//! let mut problem = Problem::load("meshes/square_impact.toml".as_ref(), &[])?;
//! let report = problem.run()?;
//! println!("{} steps, energy {} of the start", report.steps, report.energy_ratio());
//! # Ok::<(), dgmpm::Error>(())
//! ```

mod again;
mod belongs;
mod body;
mod build;
pub mod certificates;
mod checkpoints;
mod differences;
pub mod draft;
mod cost;
mod cost_rows;
mod culprit;
pub mod effects;
mod ended;
mod ends;
mod exact;
mod first;
mod from_cloud;
mod from_fields;
mod from_snapshot;
mod grids;
mod export;
mod groups;
mod input;
mod loads;
mod lost;
mod moved;
pub mod notices;
mod outcome;
mod outputs;
mod points;
mod quantities;
mod ranks;
mod rebuild;
mod record;
mod resume;
pub mod room;
pub mod series;
mod solve;
mod source_notices;
mod start;
mod stopped;
mod store;
mod summary;
mod verify;

use ranks::divided;

pub use again::Again;
pub use body::{Body, Files};
pub use checkpoints::{Checkpoints, Resumed};
pub use cost::Cost;
pub use culprit::Culprit;
pub use ended::Ended;
pub use export::Export;
pub use first::First;
pub use input::{check_folder, check_run, write_input};
pub use moved::Moved;
pub use points::{Given, Sampled, read_points};
pub use rebuild::Regrids;
pub use resume::{Later, Newest};
pub use solve::Solve;
pub use stopped::{Stopped, changes};
pub use store::{Recent, Store};
pub use summary::Outcome;
pub use verify::{Repeated, kernel_of_run, look, repeat};

use crate::built;
use crate::error::{Error, Result};
use crate::exchange::Exchange;
use crate::io::operators_file;
use crate::io::snapshot::GridFiles;
use crate::lane::Kernel;
use crate::mesh::Mesh;
use crate::observe::NewGrid;
use crate::operators::Operators;
use crate::run::{Folder, Settings};
use crate::scene::Scene;
use crate::state::State;
use crate::step::{Correction, Loss, Scheme};
use std::path::Path;
use std::sync::Arc;

/// A problem that is ready to run.
pub struct Problem {
    /// What it was made from.
    pub scene: Scene,
    /// Mesh and material points.
    pub body: Body,
    /// All that stays the same from step to step on this grid.
    pub scheme: Scheme,
    /// The state: the initial one, and after a run the last good one.
    pub state: State,
    /// End and step size.
    pub settings: Settings,
    /// Files of mesh and points in the folder of the run.
    pub files: GridFiles,
    /// Where the matrices come from, in words; empty where they were built and not stored.
    pub origin: String,
    /// What a run goes on from beside the state; none where it begins.
    pub resumed: Option<Resumed>,
}

/// A problem under construction: what is not given is made from the scene.
pub struct Setup<'a> {
    scene: &'a Scene,
    mesh: Option<Mesh>,
    points: Option<Given>,
    corrections: Vec<Arc<dyn Correction>>,
    kernel: Kernel,
    store: Option<Store<'a>>,
    exchange: Option<Arc<dyn Exchange>>,
}

impl<'a> Setup<'a> {
    /// Everything from the scene, on the widest instruction set of this processor.
    pub fn of(scene: &'a Scene) -> Self {
        let (corrections, kernel) = (vec![], Kernel::widest());
        Self { scene, mesh: None, points: None, corrections, kernel, store: None, exchange: None }
    }

    /// On this mesh, whose groups are those of the scene.
    #[must_use]
    pub fn mesh(self, mesh: Mesh) -> Self {
        Self { mesh: Some(mesh), ..self }
    }

    /// With these material points.
    #[must_use]
    pub fn points(self, points: Given) -> Self {
        Self { points: Some(points), ..self }
    }

    /// With a correction of the new state after each step, after those that are there.
    #[must_use]
    pub fn correction(mut self, correction: Arc<dyn Correction>) -> Self {
        self.corrections.push(correction);
        self
    }

    /// On this instruction set.
    #[must_use]
    pub fn kernel(self, kernel: Kernel) -> Self {
        Self { kernel, ..self }
    }

    /// With stored matrices where they belong to this problem.
    #[must_use]
    pub fn store(self, store: Store<'a>) -> Self {
        Self { store: Some(store), ..self }
    }

    /// Stepped together with other ranks, each of which builds this problem.
    #[must_use]
    pub fn exchange(self, exchange: Arc<dyn Exchange>) -> Self {
        Self { exchange: Some(exchange), ..self }
    }

    /// Mesh and material points alone.
    ///
    /// # Errors
    /// Bad input, with its place.
    pub fn body(&mut self) -> Result<Body> {
        let mesh = match self.mesh.take() {
            Some(mesh) => {
                let mesh = self.scene.cut_mesh(mesh)?;
                self.scene.check_exact_materials(&mesh)?;
                mesh
            }
            None => self.scene.build_mesh()?,
        };
        let given = self.points.take().map_or_else(|| self.scene.given_points(&mesh), Ok)?;
        Body::new(self.scene, mesh, given)
    }

    /// The problem.
    ///
    /// # Errors
    /// Bad input, with its place.
    pub fn build(mut self) -> Result<Problem> {
        let body = self.body()?;
        self.build_on(body)
    }

    /// The problem on a body of this scene.
    ///
    /// # Errors
    /// Bad input, with its place.
    pub fn build_on(self, body: Body) -> Result<Problem> {
        let scene = self.scene;
        scene.check_start(&body.mesh)?;
        self.build_from(body, |mesh, scheme| scene.initial_state(mesh, scheme))
    }

    /// The scheme on a body of this scene, and in words where its matrices come from.
    ///
    /// # Errors
    /// A cell whose points cannot carry the degree; stored matrices that cannot be written.
    pub fn scheme(self, body: &Body) -> Result<(Scheme, String)> {
        let Self { scene, corrections, kernel, store, exchange, .. } = self;
        let (operators, origin) = match store {
            Some(store) => store.operators(scene, body)?,
            None => (body.operators(scene)?, String::new()),
        };
        let build = |operators| {
            let mut scheme = scene.build_scheme(&body.mesh, operators, kernel)?;
            scheme.corrections.extend(corrections.iter().cloned());
            Ok(match &exchange {
                Some(exchange) => scheme.with_exchange(exchange.clone()),
                None => scheme,
            })
        };
        let scheme = divided(build(operators)?, scene, body, build)?;
        built::refuse(&[
            (built::SOURCES, !scheme.sources.is_empty(), "a source"),
            (built::CORRECTIONS, !scheme.corrections.is_empty() || scheme.rescue.is_some(), "a limiter or the rescue"),
            (built::CONTACT, scheme.has_contacts(), "contact"),
            (built::CURL, scheme.curl.is_some(), "the control of the curl"),
        ])?;
        Ok((scheme, origin))
    }

    /// The problem on a body of this scene, from another start than that of the scene.
    ///
    /// # Errors
    /// Bad input, with its place; what `start` says.
    pub fn build_from(self, body: Body, start: impl FnOnce(&Mesh, &Scheme) -> Result<State>) -> Result<Problem> {
        let scene = self.scene;
        let settings = scene.settings()?;
        let (scheme, origin) = self.scheme(&body)?;
        let state = start(&body.mesh, &scheme)?;
        Ok(Problem {
            scene: scene.clone(),
            body,
            scheme,
            state,
            settings,
            files: GridFiles::default(),
            origin,
            resumed: None,
        })
    }
}

impl Body {
    /// The matrices of the body for the method of the scene.
    ///
    /// # Errors
    /// A cell whose points cannot carry the degree; a boundary that is not wholly tagged.
    pub fn operators(&self, scene: &Scene) -> Result<Operators> {
        let places = self.places(scene);
        let needs = scene.needs(&places);
        let operators = Operators::build(&self.mesh, &scene.links(&self.mesh)?, &self.material, &needs)?;
        let periodic = scene.periodic_groups(&self.mesh);
        Ok(operators.with_key(operators_file::key(&self.mesh, &periodic, &self.material, &needs)))
    }
}

impl Problem {
    /// The problem of a scene file with overrides `key.path=value`.
    ///
    /// # Errors
    /// Bad input, with file, line and column.
    pub fn load(path: &Path, sets: &[String]) -> Result<Self> {
        Setup::of(&Scene::load(path, sets)?).build()
    }

    /// The problem of a scene.
    ///
    /// # Errors
    /// Bad input, with its place.
    pub fn new(scene: &Scene) -> Result<Self> {
        Setup::of(scene).build()
    }

    /// A loss of stability in words: what, in which cell and where in it, and its reference coordinates.
    pub fn describe(&self, loss: &Loss) -> String {
        let [x, y] = self.scheme.position_of(loss.cell, loss.site);
        let cell = self.body.mesh.number(loss.cell);
        format!("{} in cell {cell}, at {}, X = ({x:.6}, {y:.6})", loss.kind, loss.site)
    }

    /// The error of an initial state that is healthy at the nodes, and not at the points or faces that its polynomial is
    /// sampled at.
    pub fn lost_at_start(&self, loss: &Loss) -> Error {
        let what = format!("the initial state is lost: {}", self.describe(loss));
        match self.scene.initial.snapshot {
            Some(_) => self.scene.error("initial.snapshot", what, "give the snapshot of an earlier step"),
            None => {
                let remedy = "give a deformation that is smooth at the size of a cell, or a finer mesh";
                self.scene.error("initial.deformation", what, remedy)
            }
        }
    }

    /// Number of material points where the method has them, else of nodes.
    pub fn places(&self) -> usize {
        self.body.places(&self.scene).len()
    }

    /// What observers are told of its grid.
    pub fn grid(&self) -> NewGrid<'_> {
        NewGrid { mesh: &self.body.mesh, material: &self.body.material, files: &self.files }
    }

    /// Writes the files of its grid into the folder of the run where they are not there yet: a run that stops keeps its state
    /// on this grid.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn keep_files(&self, folder: &Folder) -> Result<()> {
        self.body.keep(folder, &self.files)
    }
}
