//! The scene file: what is to be computed, as plain data, parsed and checked.
//!
//! [`Scene::load`] reads TOML, applies the overrides of `--set`, and checks types, ranges and names; what needs the
//! mesh is checked by [`Scene::check_mesh`]. Every message has file, line and column (or the `--set` at fault)
//! and lists what exists. A scene knows neither mesh nor solver: names become types elsewhere. Units are SI.

pub mod draft;
mod fields;
mod given;
mod groups;
mod load;
mod mesh;
mod names;
mod origin;
mod outputs;
mod points;
pub mod portable;
mod quantities;
mod read;
mod reader;
mod reference;
pub mod regrid;
pub mod schema;
mod sets;
mod tables;
mod times;
mod warnings;

use std::path::{Path, PathBuf};

use crate::error::{Error, Place, Result};
use crate::expression::Expression;
use crate::registry::controls::Control;
use crate::registry::{self, Chosen, Method, Sweeps, limiters};
pub use fields::Fields;
pub use mesh::{GroupName, Mesh, MeshGroups};
pub use names::Histories;
use origin::{Origin, Part};
pub use quantities::MEASURES;
pub use reference::{of_scheme, reference};
use serde::Serialize;
pub use times::Checkpoint;
use toml_edit::{Document, DocumentMut};

/// A whole scene.
#[derive(Debug, Clone, Serialize)]
pub struct Scene {
    /// What it shows, for people; default the name of the file.
    pub title: String,
    /// Where the mesh comes from.
    pub mesh: Mesh,
    /// What names its groups, where it comes from a file of another program.
    pub mesh_groups: MeshGroups,
    /// Where the material points stand, where a material does not say otherwise.
    pub cloud: Cloud,
    /// Beyond what the points of a cell are replaced.
    pub limits: Limits,
    /// The materials, at least one.
    pub materials: Vec<Material>,
    /// The state at the start.
    pub initial: Initial,
    /// The exact solution, where one is named.
    pub exact: Option<Exact>,
    /// The conditions on the groups of boundary edges.
    pub boundaries: Vec<Boundary>,
    /// Body forces.
    pub sources: Vec<Source>,
    /// The control of the curl of F.
    pub curl: Chosen<Control>,
    /// The limiter and the rescue of cells.
    pub limiter: Chosen<limiters::Kind>,
    /// Method, degrees, flux, step size.
    pub scheme: Scheme,
    /// Time of the initial state, in s; default 0.
    pub start: f64,
    /// End time, in s.
    pub end: f64,
    /// What is recorded when.
    pub outputs: Vec<Output>,
    /// The quantities of interest.
    pub quantities: Vec<Quantity>,
    /// The watch over the energy; none where it is off.
    pub watch: Option<Watch>,
    /// When the run is kept so that it can be resumed; none: only where a signal asks for it.
    pub checkpoint: Option<Checkpoint>,
    /// When the run gets another grid.
    pub regrids: Vec<regrid::Regrid>,
    #[serde(skip)]
    origin: Origin,
}

/// Where material points stand.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cloud {
    /// The pattern.
    pub layout: Chosen<registry::layouts::Layout>,
    /// Points per direction k (k^2 in a cell; in the mean, for a pattern of the body); without meaning for a file.
    pub per_direction: usize,
}

/// Limits for the points of a cell, where the scene gives them; beyond them virtual points take their place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Limits {
    /// Largest face Lebesgue constant.
    pub face_lebesgue: Option<f64>,
    /// Largest condition number of the fit.
    pub condition: Option<f64>,
}

/// A material on a group of cells.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Material {
    /// The cell group; `None`: all cells (then it is the only material).
    pub group: Option<String>,
    /// The law and its parameters, rho0 among them.
    pub law: Chosen<registry::laws::Build>,
    /// Where its points stand.
    pub cloud: Cloud,
    /// Where its internal variables stand; `None`: its law has none.
    pub histories: Option<Histories>,
}

/// The exact solution of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exact {
    /// The solution and its parameters.
    pub solution: Chosen<registry::solutions::Solution>,
    /// Whether it gives the initial state: where the scene has no `[initial]`.
    pub initial: bool,
}

/// The state at the start; its expressions depend on x and y only.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Initial {
    /// Whether it comes from the fields of the cloud file; the expressions are then without meaning.
    pub from_cloud: bool,
    /// v, in m/s; default 0.
    pub velocity: [Expression; 2],
    /// F11, F12, F21, F22; default the identity.
    pub deformation: [Expression; 4],
    /// A snapshot that the run goes on from, as written in the scene; nothing else then counts.
    pub snapshot: Option<PathBuf>,
    /// Fields of another program, which take the place of the expressions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fields: Option<Fields>,
}

/// The condition on a group of boundary edges.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Boundary {
    /// The group of edges.
    pub group: String,
    /// What holds there.
    pub condition: Chosen<registry::conditions::Condition>,
}

impl Boundary {
    /// Another group that this one is joined to or interacts with, after the key that names it.
    pub fn partner(&self) -> Option<(&'static str, &str)> {
        let condition = self.condition.build();
        let key = condition.joined.or(condition.between.as_ref().and_then(|between| between.other))?;
        let partner = self.condition.values.maybe_text(key)?;
        (self.is_joined() || partner != self.group).then_some((key, partner))
    }

    /// Whether the faces of the group are joined to those of its partner, as inner faces.
    pub fn is_joined(&self) -> bool {
        self.condition.build().joined.is_some()
    }

    /// Whether its condition presses where bodies touch.
    pub fn presses(&self) -> bool {
        self.condition.build().presses
    }

    /// The group, and that of its partner.
    pub fn groups(&self) -> impl Iterator<Item = &str> {
        [self.group.as_str()].into_iter().chain(self.partner().map(|(_, group)| group))
    }
}

/// A force on the volume.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Source {
    /// The cell group; `None`: everywhere.
    pub group: Option<String>,
    /// The force.
    pub source: Chosen<registry::sources::Build>,
}

/// Shares of energy made out of nothing at which the watch over the energy does something.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Watch {
    /// The program warns.
    pub warn: f64,
    /// The run stops.
    pub stop: f64,
}

/// Method, degrees, flux and step size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scheme {
    /// The method.
    pub method: Method,
    /// N, degree in space, 0 to 6.
    pub degree: usize,
    /// N_T, degree in time, 0 to 6; default N.
    pub time_degree: usize,
    /// The flux on inner faces; default dual, with a limiter rusanov.
    pub flux: Chosen<registry::fluxes::Flux>,
    /// The size of a step.
    pub step: Step,
    /// The predictor's sweeps; default ladder where N_T = N, else paper.
    pub sweeps: Sweeps,
    /// Whether each body keeps its angular momentum to rounding; default false.
    pub angular_momentum: bool,
    /// Whether faces give back what they creep ([`crate::riemann::creep`]); default false.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub springs: bool,
}

/// The size of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// The paper's: dt = cfl h / ((2N+1) c).
    Cfl(f64),
    /// A share of the measured limit: dt = safety limit(method, N) h / c; default 0.9.
    Safety(f64),
}

/// Something that is recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Output {
    /// Its name, unique, fit for a file name; default the kind.
    pub name: String,
    /// What.
    pub what: Chosen<registry::outputs::Output>,
    /// When.
    pub when: When,
    /// Whether steps are shortened to meet the times.
    pub exact_times: bool,
}

/// A quantity of interest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quantity {
    /// Its name in results, unique.
    pub name: String,
    /// What.
    pub what: Chosen<registry::quantities::Kind>,
    /// When.
    pub when: registry::quantities::When,
}

/// When something is recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum When {
    /// At these times, rising, in s.
    At(Vec<f64>),
    /// Every so many seconds.
    Every(f64),
    /// Every so many steps.
    EverySteps(usize),
}

impl Scene {
    /// Reads the text of a scene; `path` stands in messages, and relative paths start from its folder.
    pub fn parse(text: &str, path: &Path, sets: &[String]) -> Result<Self> {
        let original = document(text, path)?;
        let mut origin =
            Origin { path: path.to_owned(), text: text.to_owned(), run: text.to_owned(), ..Origin::default() };
        if !sets.is_empty() {
            let mut changed: DocumentMut = original.into_mut();
            for argument in sets {
                let (path, removed) = sets::apply(&mut changed, argument, &origin.sets)?;
                origin.sets.push((path, argument.clone()));
                let words = |key: String| format!("--set {argument}: takes the place of `{key}` in the scene file");
                origin.replaced.extend(removed.into_iter().map(words));
            }
            origin.run = changed.to_string();
        }
        let run = origin.run.clone();
        let scene = read::scene(&document(&run, path)?, origin)?;
        scene.check_exact()?;
        if let Mesh::Rectangle { .. } = scene.mesh {
            let edges = ["left", "right", "bottom", "top"].map(str::to_owned);
            scene.check_groups(&["body".to_owned()], &edges)?;
        }
        Ok(scene)
    }

    /// The scene with further overrides `key.path=value`.
    ///
    /// # Errors
    /// As for [`Scene::load`].
    pub fn with(&self, sets: &[String]) -> Result<Self> {
        Self::parse(&self.to_toml(), self.path(), sets)
    }

    /// The text as run: the file after overrides, with its comments.
    pub fn to_toml(&self) -> String {
        self.origin.run.clone()
    }

    /// The scene file.
    pub fn path(&self) -> &Path {
        &self.origin.path
    }

    /// The name of the scene file without its ending.
    pub fn name(&self) -> String {
        self.origin.path.file_stem().map_or_else(|| "scene".to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// A path of the scene, which is relative to the scene file.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.origin.path.parent().map_or_else(|| path.to_owned(), |folder| folder.join(path))
    }

    /// The file that a key names, which has to be there.
    ///
    /// # Errors
    /// There is no such file.
    pub(crate) fn existing(&self, key: &str, path: &Path) -> Result<PathBuf> {
        let file = self.resolve(path);
        match file.exists() {
            true => Ok(file),
            false => {
                let what = format!("there is no file {}", file.display());
                Err(self.error(key, what, "give the path of a file, relative to the scene file"))
            }
        }
    }

    /// Whether the scene gives a key such as `scheme.cfl`.
    pub(crate) fn gives(&self, key: &str) -> bool {
        self.origin.given().has(key)
    }

    /// The mesh file, if the mesh is one.
    pub fn mesh_path(&self) -> Option<PathBuf> {
        match &self.mesh {
            Mesh::File(path) => Some(self.resolve(path)),
            Mesh::Rectangle { .. } => None,
        }
    }

    /// The cloud file, if the cloud is one.
    pub fn cloud_path(&self) -> Option<PathBuf> {
        let layout = &self.cloud.layout;
        layout.build().is_file().then(|| self.resolve(Path::new(layout.values.text("path"))))
    }

    /// Whether the exact solution holds for the materials and until the end of the run.
    fn check_exact(&self) -> Result<()> {
        let Some(exact) = &self.exact else { return Ok(()) };
        let law = |material: &Material| (material.law.name(), (material.law.build())(&material.law.values));
        let laws: Vec<_> = self.materials.iter().map(law).collect();
        registry::solutions::check(&exact.solution, &laws, self.end)
            .map_err(|fault| self.error(&fault.key, fault.what, fault.remedy))
    }

    /// Where the value of a key such as `scheme.cfl` or `boundary.0.group` stands.
    pub(crate) fn place(&self, key: &str) -> Place {
        let path: Vec<String> = key.split('.').map(str::to_owned).collect();
        self.origin.place(&path, Part::Value)
    }

    /// An error at the value of a key such as `scheme.cfl` or `boundary.0.group`, for checks that need
    /// more than the scene.
    pub fn error(&self, key: &str, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::at(self.place(key), what, remedy)
    }
}

/// Parses TOML; a syntax error has its place.
fn document<'a>(text: &'a str, path: &Path) -> Result<Document<&'a str>> {
    Document::parse(text).map_err(|why| {
        let byte = why.span().map_or(0, |span| span.start);
        let what = format!("this is not TOML: {}", why.message().replace('\n', ", "));
        Origin::error_at_byte(
            path,
            text,
            byte,
            what,
            "a scene has lines key = value under headers [table] and [[list]]",
        )
    })
}

#[cfg(test)]
mod entry_tests;
#[cfg(test)]
mod tests;
