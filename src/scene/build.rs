//! Where names become types: from a scene to mesh, cloud, operators, scheme, initial state and observers.

use super::{
    Boundary, Condition, Curl, Expression, LAWS, Mesh as Source, Method, Output, Scene, Step, Sweeps, What, When,
};
use crate::boundary::{self, Data};
use crate::cloud::Cloud;
use crate::error::Result;
use crate::exact::ExactForce;
use crate::io::{gmsh, mesh_file, store};
use crate::lane::Kernel;
use crate::material::Law;
use crate::mesh::{self, Link, Mesh};
use crate::observe::{Contents, Field, Ledger, Line, Observer, Outside, Samples, Schedule, Snapshots};
use crate::operators::{Needs, Operators, Sampling};
use crate::run::{Folder, Settings};
use crate::source::{self, BodyForce};
use crate::state::{State, UNKNOWNS};
use crate::step::{Control, Histories, Method as Integration, Relax, Scheme, Sweeps as Picard, Tableau, cfl};
use crate::tensor;
use crate::{basis::TimeBasis, scene};
use std::path::Path;
use std::sync::Arc;

/// Steps between two rows of the ledger, where the scene does not say.
const LEDGER_STEPS: usize = 10;

/// Reads a mesh: `.h5` as written by `dgmpm mesh`, else Gmsh.
///
/// # Errors
/// Bad input, with its place.
pub fn read_mesh(path: &Path) -> Result<Mesh> {
    if store::is_meant_as_store(path) { mesh_file::read_mesh(path) } else { Ok(gmsh::read(path)?.with_common_axes()) }
}

/// An expression as data of boundary or source.
fn data(expression: &Expression) -> Data {
    let expression = expression.clone();
    Arc::new(move |x, t| expression.eval(x, t))
}

fn pair(value: &[Expression; 2]) -> [Data; 2] {
    value.each_ref().map(data)
}

impl Scene {
    /// The mesh of the scene, its groups checked.
    ///
    /// # Errors
    /// Bad input, with its place.
    pub fn build_mesh(&self) -> Result<Mesh> {
        let mesh = match &self.mesh {
            Source::Rectangle { size, cells } => mesh::rectangle(*size, *cells)?,
            Source::File(path) => read_mesh(&self.resolve(path))?,
        };
        self.check_mesh(&mesh)?;
        self.check_exact_materials(&mesh)?;
        Ok(mesh)
    }

    /// Pairs of boundary groups (by number) that are periodic to each other, each once.
    pub fn periodic_groups(&self, mesh: &Mesh) -> Vec<[usize; 2]> {
        let number = |name: &String| mesh.edge_groups.iter().position(|group| group == name);
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for boundary in &self.boundaries {
            let Condition::Periodic { partner } = &boundary.condition else { continue };
            // `check_mesh` has refused groups that the mesh lacks.
            let (Some(a), Some(b)) = (number(&boundary.group), number(partner)) else { continue };
            if !pairs.contains(&[b, a]) {
                pairs.push([a, b]);
            }
        }
        pairs
    }

    /// What lies behind the faces of each cell: the mesh's neighbours, and those across periodic boundaries.
    ///
    /// # Errors
    /// A mesh whose faces or periodic groups do not fit together.
    pub fn links(&self, mesh: &Mesh) -> Result<Vec<[Link; 4]>> {
        Ok(mesh::periodic_links(mesh, &self.periodic_groups(mesh))?)
    }

    /// The number of the `[[material]]` of each cell.
    pub fn material_of_cells(&self, mesh: &Mesh) -> Vec<usize> {
        let of_group = |group: &String| self.materials.iter().position(|m| m.group.as_ref().is_none_or(|g| g == group));
        // `check_mesh` has refused groups without a material.
        let numbers: Vec<usize> = mesh.groups.iter().map(|group| of_group(group).unwrap_or(0)).collect();
        mesh.cell_group.iter().map(|&group| numbers[group]).collect()
    }

    /// What the method needs of the operators.
    pub fn needs<'a>(&self, cloud: &'a Cloud) -> Needs<'a> {
        let sampling = match self.scheme.method {
            Method::AderDgmpm => Some(Sampling::Cloud(cloud)),
            Method::AderDgfem => Some(Sampling::Nodes),
            Method::RkDgfem => None,
        };
        // Constants have no curl.
        let curl_free = self.scheme.degree > 0 && self.curl != Curl::Off;
        Needs { degree: self.scheme.degree, sampling, curl_free }
    }

    /// The laws, in the order of the `[[material]]` tables.
    pub fn build_laws(&self) -> Vec<Law> {
        laws(&self.materials)
    }

    /// Time integration.
    pub fn integration(&self) -> Integration {
        let (n, n_t) = (self.scheme.degree, self.scheme.time_degree);
        match self.scheme.method {
            Method::RkDgfem => Integration::RungeKutta(Tableau::of_degree(n_t)),
            Method::AderDgmpm | Method::AderDgfem => {
                let time = TimeBasis::new(n_t);
                let sweeps = match self.scheme.sweeps {
                    Sweeps::Ladder => Picard::ladder(&time),
                    Sweeps::Paper => Picard::paper(&time, n.max(n_t) + 1),
                };
                Integration::Ader { time, sweeps }
            }
        }
    }

    /// The scheme.
    pub fn build_scheme(&self, mesh: &Mesh, operators: Operators, kernel: Kernel) -> Scheme {
        let condition = |group: &String| self.boundaries.iter().find(|b| b.group == *group).map(condition);
        // `check_mesh` has refused groups without a condition; no face looks at that of a periodic group.
        let free = || Box::new(boundary::Free) as Box<dyn boundary::Boundary>;
        let boundaries = mesh.edge_groups.iter().map(|group| condition(group).unwrap_or_else(free)).collect();
        let control = |relax, alpha| Control { relax, rate: alpha * self.scheme.degree as f64 };
        let curl = match self.curl {
            Curl::Rotation { alpha } => Some(control(Relax::Rotation, alpha)),
            Curl::Lcf { alpha } => Some(control(Relax::Gradient, alpha)),
            Curl::Off => None,
        };
        let mut sources: Vec<_> = self.sources.iter().map(|s| self.source(s)).collect();
        // A solution has a body force everywhere and always, or nowhere.
        if let Some(exact) = self.build_exact().filter(|exact| exact.body_force([0.0; 2], 0.0).is_some()) {
            sources.push(Box::new(ExactForce(exact)));
        }
        let laws = self.build_laws();
        Scheme {
            histories: Histories::new(&operators, &laws),
            operators,
            laws,
            method: self.integration(),
            flux: self.scheme.flux,
            boundaries,
            sources,
            corrections: vec![],
            // Constants have no curl.
            curl: curl.filter(|_| self.scheme.degree > 0),
            kernel,
        }
    }

    fn source(&self, source: &scene::Source) -> Box<dyn source::Source> {
        let named = |m: &scene::Material| source.group.is_some() && m.group == source.group;
        Box::new(BodyForce { value: pair(&source.value), material: self.materials.iter().position(named) })
    }

    /// The speeds that conditions prescribe: the group, and one component (along N) or both, m/s.
    pub fn prescribed_speeds(&self) -> Vec<(&str, Vec<Data>)> {
        let of = |boundary: &Boundary| match &boundary.condition {
            Condition::Wall { speed } => vec![data(speed)],
            Condition::Velocity(value) => pair(value).to_vec(),
            _ => vec![],
        };
        self.boundaries.iter().map(|boundary| (boundary.group.as_str(), of(boundary))).collect()
    }

    /// The initial state: F and p at the grid nodes from the scene's expressions, from its exact solution, or from the
    /// fields of its cloud.
    ///
    /// # Errors
    /// A value that is not finite, or J <= 0, with its place in the mesh.
    pub fn initial_state(&self, mesh: &Mesh, scheme: &Scheme) -> Result<State> {
        if let Some(path) = &self.initial.snapshot {
            return self.state_of_snapshot(&self.resolve(path), scheme);
        }
        if self.initial.from_cloud {
            return self.state_from_cloud(mesh, scheme);
        }
        let (basis, n) = (&scheme.operators.line.basis, scheme.operators.nodes());
        let components = self.components();
        let mut cells = vec![0.0; mesh.cells.len() * components * n];
        let material = self.material_of_cells(mesh);
        let exact = self.exact.as_ref().filter(|exact| exact.initial).and_then(|_| self.build_exact());
        for (cell, values) in cells.chunks_mut(components * n).enumerate() {
            let density = scheme.laws[material[cell]].density();
            for a in 0..n {
                let x = mesh::map::position(&mesh.corners(cell), basis.node_2d(a));
                let (f, v) = match &exact {
                    Some(exact) => (exact.deformation(x, self.start), exact.velocity(x, self.start)),
                    None => {
                        self.check_initial_expressions(x, mesh.number(cell))?;
                        self.initial.at(x)
                    }
                };
                self.check_initial(f, v, x, mesh.number(cell))?;
                let u = [f[0], f[1], f[2], f[3], density * v[0], density * v[1]];
                u.into_iter().enumerate().for_each(|(k, u)| values[k * n + a] = u);
            }
        }
        let mut state = State { time: self.start, ..State::pack(&scheme.operators.blocks, n, components, &cells) };
        scheme.set_internal(&mut state, &scheme.virgin_internal());
        Ok(state)
    }

    /// Whether the expressions of the initial fields are finite at X.
    fn check_initial_expressions(&self, x: [f64; 2], cell: u64) -> Result<()> {
        let velocity = ["v1", "v2"].iter().zip(&self.initial.velocity);
        let deformation = ["F11", "F12", "F21", "F22"].iter().zip(&self.initial.deformation);
        let keyed = velocity.enumerate().map(|entry| ("velocity", entry));
        for (key, (k, (name, expression))) in keyed.chain(deformation.enumerate().map(|entry| ("deformation", entry))) {
            let value = expression.eval(x, 0.0);
            if !value.is_finite() {
                let source = expression.source();
                let what = format!(
                    "the initial {key} {name} = `{source}` is {value} at X = ({}, {}) in cell {cell}",
                    x[0], x[1]
                );
                let remedy = "give an expression that is finite all over the body";
                return Err(self.error(&format!("initial.{key}.{k}"), what, remedy));
            }
        }
        Ok(())
    }

    pub(super) fn check_initial(&self, f: [f64; 4], v: [f64; 2], x: [f64; 2], cell: u64) -> Result<()> {
        // Called for every node: no text is made before there is an error.
        let at = || format!("at X = ({}, {}) in cell {cell}", x[0], x[1]);
        if v.iter().any(|v| !v.is_finite()) {
            let what = format!("the initial velocity {} is ({}, {})", at(), v[0], v[1]);
            return Err(self.error("initial.velocity", what, "give expressions that are finite all over the body"));
        }
        let j = tensor::det(f);
        if f.iter().any(|f| !f.is_finite()) || j <= 0.0 {
            let what = format!("the initial deformation gradient {} has J = {j}", at());
            return Err(self.error("initial.deformation", what, "give expressions with F11 F22 - F12 F21 > 0"));
        }
        Ok(())
    }

    /// Whether an output asks for the displacement: as a field, or for the angular momentum of a ledger.
    pub fn wants_displacement(&self) -> bool {
        let balance = |output: &Output| output.what == What::Ledger { balance: true };
        self.outputs.iter().any(|output| output.fields.contains(&Field::Displacement) || balance(output))
    }

    /// Components of the state: with the displacement where an output asks for it or the flux looks at it.
    pub(super) fn components(&self) -> usize {
        if self.wants_displacement() { UNKNOWNS + 2 } else { self.scheme.flux.components() }
    }

    /// dt c / h and the end.
    ///
    /// # Errors
    /// A step beyond the stability limit.
    pub fn settings(&self) -> Result<Settings> {
        let (n, integration) = (self.scheme.degree, self.integration());
        let limit = cfl::limit(&integration, n);
        if limit == 0.0 {
            return Err(self.error(
                "scheme.time_degree",
                format!("explicit Euler (time_degree = 0) is unstable at every step for degree {n}"),
                "give time_degree from 1 to 6 (the default is the degree), or degree = 0",
            ));
        }
        let (key, safety) = match self.scheme.step {
            Step::Safety(safety) => ("scheme.safety", safety),
            Step::Cfl(cfl) => ("scheme.cfl", cfl::safety_of_cfl(cfl, &integration, n)),
        };
        if safety > 1.0 {
            let allowed = limit * (2 * n + 1) as f64;
            return Err(self.error(
                key,
                format!("the step is {safety:.2} of the stability limit in 2D (dt c / h = {limit:.4} for degree {n}) and blows up"),
                format!("give scheme.safety up to 1 (0.9 is the default), or scheme.cfl up to {allowed:.3}"),
            ));
        }
        Ok(Settings { end: self.end, courant: safety * limit, watch: self.watch })
    }

    /// Whether all lines of the outputs lie in the mesh.
    ///
    /// # Errors
    /// A line that leaves it, with its place in the scene.
    pub fn check_lines(&self, mesh: &Mesh) -> Result<()> {
        for (i, output) in self.outputs.iter().enumerate() {
            let Some(samples) = samples(output) else { continue };
            samples.check(mesh).map_err(|outside| {
                let key = if outside.sample == 0 { "from" } else { "to" };
                self.error(&format!("output.{i}.{key}"), outside.to_string(), Outside::REMEDY)
            })?;
        }
        Ok(())
    }

    /// The observers that the scene asks for, writing into a run folder; and a ledger in any case.
    ///
    /// # Errors
    /// A line that leaves the mesh ([`Scene::check_lines`] has its place); files that cannot be made.
    pub fn observers(&self, mesh: &Mesh, folder: &Folder) -> Result<Vec<Box<dyn Observer>>> {
        let material = self.material_of_cells(mesh);
        let plastic = self.build_laws().iter().any(|law| !law.internal().is_empty());
        let drift = self.components() > UNKNOWNS;
        let contents = Contents { drift, plastic, regrids: !self.regrids.is_empty(), balance: false };
        let mut out: Vec<Box<dyn Observer>> = Vec::new();
        for output in &self.outputs {
            let schedule = schedule(output);
            out.push(match (output.what, samples(output)) {
                (What::Ledger { balance }, _) => {
                    let contents = Contents { balance, ..contents };
                    Box::new(Ledger::create(&folder.ledger(), schedule.with_end(), contents)?)
                }
                (_, Some(samples)) => {
                    Box::new(Line::create(&folder.line(&output.name), mesh, &material, &samples, schedule)?)
                }
                _ => Box::new(Snapshots::new(&folder.snapshots(), schedule)),
            });
        }
        if !self.outputs.iter().any(|output| matches!(output.what, What::Ledger { .. })) {
            let schedule = Schedule::new(crate::observe::When::EverySteps(LEDGER_STEPS), false).with_end();
            out.push(Box::new(Ledger::create(&folder.ledger(), schedule, contents)?));
        }
        Ok(out)
    }

    /// The fields that an export shows: those of the first `fields` output, or all that the state has.
    pub fn export_fields(&self) -> Vec<Field> {
        let asked = self.outputs.iter().find(|output| output.what == What::Fields).map(|output| output.fields.clone());
        let laws = self.build_laws();
        let there = |field: &Field| *field != Field::Displacement && field.is_of(&laws);
        let all = || Field::NAMES.iter().map(|(_, field)| *field).filter(there).collect();
        asked.unwrap_or_else(all)
    }
}

/// The laws of some materials.
pub(super) fn laws(materials: &[scene::Material]) -> Vec<Law> {
    let build = |m: &scene::Material| {
        let parameter = |name: &str| m.parameters.get(name).copied().unwrap_or(f64::NAN);
        let law = LAWS.iter().find(|law| law.name == m.law)?;
        Some((law.build)(&parameter, m.density))
    };
    // Parsing has refused names that the list lacks.
    materials.iter().filter_map(build).collect()
}

impl scene::Initial {
    /// F and v at X.
    fn at(&self, x: [f64; 2]) -> ([f64; 4], [f64; 2]) {
        let value = |e: &Expression| e.eval(x, 0.0);
        (self.deformation.each_ref().map(value), self.velocity.each_ref().map(value))
    }
}

/// What a line output samples.
fn samples(output: &Output) -> Option<Samples> {
    let What::Line { from, to, samples } = output.what else { return None };
    Some(Samples { ends: [from, to], count: samples, fields: output.fields.clone() })
}

fn schedule(output: &Output) -> Schedule {
    schedule_of(&output.when, output.exact_times)
}

/// When something is done.
pub fn schedule_of(when: &When, exact: bool) -> Schedule {
    let when = match when {
        When::At(times) => crate::observe::When::At(times.clone()),
        When::Every(interval) => crate::observe::When::Every(*interval),
        When::EverySteps(steps) => crate::observe::When::EverySteps(*steps),
    };
    Schedule::new(when, exact)
}

/// The registry of boundary conditions.
fn condition(boundary: &Boundary) -> Box<dyn boundary::Boundary> {
    let zero = || data(&Expression::number(0.0));
    match &boundary.condition {
        // The faces of a periodic group are inner faces: nothing asks for its condition.
        Condition::Free | Condition::Periodic { .. } => Box::new(boundary::Free),
        Condition::Symmetry => Box::new(boundary::Wall { speed: None }),
        Condition::Wall { speed } if speed.constant() == Some(0.0) => Box::new(boundary::Wall { speed: None }),
        Condition::Wall { speed } => Box::new(boundary::Wall { speed: Some(data(speed)) }),
        Condition::Clamped => Box::new(boundary::Velocity { value: [zero(), zero()] }),
        Condition::Velocity(value) => Box::new(boundary::Velocity { value: pair(value) }),
        Condition::Traction(value) => Box::new(boundary::Traction { value: pair(value) }),
        Condition::Absorbing => Box::new(boundary::Absorbing),
    }
}
