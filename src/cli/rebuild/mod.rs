//! Another grid in mid-run: `[[regrid]]`. Mesh, points, operators and scheme are made anew and the state is brought over;
//! time and step go on. Where grid and points are the same nothing is touched, so that no bit changes.

mod outcome;

use super::pipeline::{self, Body};
use super::print::say;
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::cloud_file::{self, More};
use crate::io::csv::Table;
use crate::io::snapshot::GridFiles;
use crate::io::{hash, mesh_file, operators_file};
use crate::lane::Kernel;
use crate::observe::{NewGrid, Schedule, View};
use crate::operators::{Blocks, Limits, Line, Operators, Stored};
use crate::regrid::points::{Demand, Placed, Policy, histories, place};
use crate::regrid::{self, Field, Grid, Transfer};
use crate::run::{Folder, Pause};
use crate::scene::grids::Present;
use crate::scene::{Method, Scene, build};
use crate::state::State;
use crate::step::{Scheme, Totals};
use outcome::{Clock, Outcome, columns};
use std::collections::{HashMap, VecDeque};

/// Grids whose matrices are kept in memory, so that grids that alternate are built once.
const KEPT: usize = 4;

/// A grid with everything that is built on it.
pub struct Built {
    /// Mesh and points.
    pub body: Body,
    /// The scheme.
    pub scheme: Scheme,
    /// Its files in the run folder.
    pub files: GridFiles,
}

/// The rules of a scene, and what has come of them.
pub struct Regrids<'a> {
    scene: &'a Scene,
    folder: &'a Folder,
    kernel: Kernel,
    schedules: Vec<Schedule>,
    /// How often each rule has fired.
    fired: Vec<usize>,
    /// The rule that fired last, and the mesh that it asks for.
    due: Option<(usize, Result<crate::mesh::Mesh>)>,
    material: Vec<usize>,
    cloud: Cloud,
    /// Matrices by key, the latest last.
    cache: VecDeque<(String, Stored)>,
    files: HashMap<String, GridFiles>,
    table: Option<Table>,
}

impl Pause for Regrids<'_> {
    fn stop(&self, time: f64) -> Option<f64> {
        self.schedules.iter().filter_map(|schedule| schedule.stop(time)).reduce(f64::min)
    }

    fn due(&mut self, view: &View) -> bool {
        let (step, time) = (view.state.step, view.state.time);
        let present = Present { view, cloud: &self.cloud, material: &self.material };
        for rule in 0..self.schedules.len() {
            if self.schedules[rule].due(step, time, view.dt) && self.scene.regrid_is_due(rule, &present) {
                let mesh = self.scene.regrid_mesh(rule, self.fired[rule], &present);
                self.fired[rule] += 1;
                self.due = Some((rule, mesh));
            }
        }
        self.due.is_some()
    }
}

impl<'a> Regrids<'a> {
    /// The rules of a scene at the start of a run on `first`.
    pub fn new(scene: &'a Scene, folder: &'a Folder, kernel: Kernel, first: &Body, start: &State) -> Result<Self> {
        let mut schedules: Vec<Schedule> =
            scene.regrids.iter().map(|rule| build::schedule_of(&rule.when, rule.exact_times)).collect();
        // `every` and `every_steps` count from the start, whose grid is that of [mesh]; `at` may name it.
        for (schedule, rule) in schedules.iter_mut().zip(&scene.regrids) {
            if !matches!(rule.when, crate::scene::When::At(_)) && rule.criteria == Default::default() {
                schedule.due(start.step, start.time, 0.0);
            }
        }
        let table = if scene.regrids.is_empty() { None } else { Some(Table::create(&folder.regrids(), &columns())?) };
        let files = HashMap::from([(key_of_files(first), GridFiles::default())]);
        let fired = vec![0; schedules.len()];
        let (material, cloud) = (first.material.clone(), first.cloud.clone());
        Ok(Self {
            scene,
            folder,
            kernel,
            schedules,
            fired,
            due: None,
            material,
            cloud,
            cache: VecDeque::new(),
            files,
            table,
        })
    }

    /// Puts the grid that is due in place of `old`, and the state on it; totals before and after, none where it is the same.
    ///
    /// # Errors
    /// A mesh that cannot be made or does not fit the body.
    pub fn rebuild(&mut self, old: &mut Built, state: &mut State) -> Result<Option<[Totals; 2]>> {
        let Some((rule, mesh)) = self.due.take() else { return Ok(None) };
        let mut clock = Clock::new();
        let mesh = mesh?;
        clock.lap(0);
        let material = self.scene.material_of_cells(&mesh);
        let (from, to) = (grid(&old.body.mesh, &old.body.material), grid(&mesh, &material));
        let n = old.scheme.operators.nodes();
        let unknowns = state.unpack(&old.scheme.operators.blocks, n);
        let scale = scale(&old.scheme);
        let basis = &old.scheme.operators.line.basis;
        let field = Field { basis, components: state.components, u: &unknowns, scale: &scale };
        let mut moved = regrid::transfer(&from, &to, &field)?;
        clock.lap(1);
        let policy = self.scene.regrids[rule].points;
        let placed = place_points(self.scene, &from, &old.body, &to, &moved, policy, &old.scheme)?;
        clock.lap(2);
        if mesh == old.body.mesh && placed.cloud == old.body.cloud {
            say(format!("regrid at step {}, t = {:.6e} s: the grid is the same", state.step, state.time));
            return Ok(None);
        }
        let (cloud, virtual_points) = (placed.cloud.clone(), placed.virtual_points.clone());
        let body = Body { mesh, cloud, virtual_points, deficient: vec![], material };
        let links = self.scene.links(&body.mesh)?;
        clock.lap(3);
        let operators = self.operators(&body, &links)?;
        clock.lap(4);
        let scheme = pipeline::scheme(self.scene, &body, operators, self.kernel);
        regrid::curl_free(&scheme, state.components, &moved.same, &mut moved.u);
        let new = State::pack(&scheme.operators.blocks, n, state.components, &moved.u);
        let mut new = State { time: state.time, step: state.step, ..new }.holding(state, &moved.same, n);
        let before = (grid(&old.body.mesh, &old.body.material), &old.body.cloud, &old.scheme);
        let after = (grid(&body.mesh, &body.material), &scheme);
        let internal = internal(before, state, after, &moved.same, &placed)?;
        scheme.set_internal(&mut new, &internal);
        let totals = [old.scheme.totals(state), scheme.totals(&new)];
        clock.lap(5);
        let files = self.write(&body, state.step)?;
        clock.lap(6);
        *state = new;
        (self.material, self.cloud) = (body.material.clone(), body.cloud.clone());
        let built = Built { body, scheme, files };
        let result = Outcome { rule, old, new: &built, state, moved: &moved, placed: &placed, totals: &totals };
        result.print(&clock);
        if let Some(table) = &mut self.table {
            table.push(&result.row(&clock))?;
            table.flush()?;
        }
        *old = built;
        Ok(Some(totals))
    }

    /// The operators, their matrices from memory where they have been built before.
    fn operators(&mut self, body: &Body, links: &[[crate::mesh::Link; 4]]) -> Result<Operators> {
        let places = body.places(self.scene);
        let needs = self.scene.needs(&places);
        let (line, blocks) = (Line::new(needs.degree), Blocks::new(&body.material, links));
        let key = operators_file::key(&body.mesh, &self.scene.periodic_groups(&body.mesh), &body.material, &needs);
        let known = self.cache.iter().position(|(known, _)| *known == key).and_then(|k| self.cache.remove(k));
        let stored = match known {
            Some((_, stored)) => stored,
            None => Stored::build(&body.mesh, &blocks, &line, &needs)?,
        };
        self.cache.push_back((key, stored.clone()));
        if self.cache.len() > KEPT {
            self.cache.pop_front();
        }
        Ok(Operators::assemble(&body.mesh, line, blocks, &needs, stored))
    }

    /// Writes mesh and points beside those of the start, each grid once; nothing where no output takes snapshots.
    fn write(&mut self, body: &Body, step: usize) -> Result<GridFiles> {
        let snapshots = self.scene.outputs.iter().any(|output| output.what == crate::scene::What::Fields);
        if !snapshots {
            return Ok(GridFiles::after(step));
        }
        let key = key_of_files(body);
        if let Some(files) = self.files.get(&key) {
            return Ok(files.clone());
        }
        let files = GridFiles::after(step);
        write_grid(body, &files, self.folder)?;
        self.files.insert(key, files.clone());
        Ok(files)
    }
}

/// Writes mesh and points of a grid into the folder of the run.
fn write_grid(body: &Body, files: &GridFiles, folder: &Folder) -> Result<()> {
    mesh_file::write_mesh(&folder.root.join(&files.mesh), &body.mesh)?;
    let more = More { virtual_points: body.virtual_points.clone(), ..More::default() };
    cloud_file::write_with(&folder.root.join(&files.cloud), &body.cloud, &body.mesh, &more)
}

fn key_of_files(body: &Body) -> String {
    hash::of_mesh(&body.mesh) + &hash::of_cloud(&body.cloud)
}

fn grid<'a>(mesh: &'a crate::mesh::Mesh, material: &'a [usize]) -> Grid<'a> {
    Grid { mesh, material }
}

/// The weights of the standard error: |F|^2 + |v|^2 / c_p^2 with the speed of the unstrained material.
pub fn scale(scheme: &Scheme) -> Vec<[f64; 8]> {
    let of = |law: &crate::material::Law| {
        let [c_p, _] = law.largest_speeds([1.0, 0.0, 0.0, 1.0], &law.virgin());
        let p = (law.density() * c_p).powi(-2);
        [1.0, 1.0, 1.0, 1.0, p, p, 0.0, 0.0]
    };
    scheme.laws.iter().map(of).collect()
}

/// Internal variables of a state at the points (or nodes) of a new grid; empty where no law has any.
pub fn internal(
    (from, cloud, before): (Grid, &Cloud, &Scheme),
    state: &State,
    (to, after): (Grid, &Scheme),
    same: &[Option<usize>],
    placed: &Placed,
) -> Result<Vec<f64>> {
    let count: Vec<usize> = before.laws.iter().map(|law| law.internal().len()).collect();
    if count.iter().all(|count| *count == 0) {
        return Ok(vec![]);
    }
    let (places, new, values) = (before.places(), after.places(), before.internal_of(state));
    if places == *cloud && new == placed.cloud {
        return Ok(histories(&from, &places, placed, &values, &count));
    }
    // The law is evaluated at the nodes, which are new points in cells that are new.
    let stays = |(cell, twin): (usize, &Option<usize>)| twin.filter(|&twin| places.of(twin) == new.of(cell));
    let same = &same.iter().enumerate().map(stays).collect::<Vec<_>>();
    let (line, limits) = (&after.operators.line, &Limits::of_degree(after.operators.degree));
    let (policy, fresh, virtual_points) = (Policy::Layout, &new, &[][..]);
    let demand = Demand { line, policy, fresh, samples: false, limits, virtual_points, histories: true, on_nodes: &[] };
    Ok(histories(&from, &places, &place(&from, &places, &to, same, &demand)?, &values, &count))
}

/// Places the points on the new grid.
pub fn place_points(
    scene: &Scene,
    from: &Grid,
    old: &Body,
    to: &Grid,
    moved: &Transfer,
    policy: Policy,
    scheme: &Scheme,
) -> Result<Placed> {
    let fresh = match policy {
        Policy::Keep => Cloud::default(),
        Policy::Enrich | Policy::Layout => scene.build_cloud(to.mesh)?,
    };
    let samples = scene.scheme.method == Method::AderDgmpm;
    let histories = scheme.laws.iter().any(|law| !law.internal().is_empty());
    let (limits, virtual_points) = (&scene.limits, &old.virtual_points[..]);
    let line = &scheme.operators.line;
    let on_nodes = &scene.on_nodes(to.material);
    let demand = Demand { line, policy, fresh: &fresh, samples, limits, virtual_points, histories, on_nodes };
    place(from, &old.cloud, to, &moved.same, &demand)
}

impl Built {
    /// Writes its files where they are not there yet: a run that stops keeps its state on this grid.
    pub fn keep_files(&self, folder: &Folder) -> Result<()> {
        if folder.root.join(&self.files.mesh).exists() {
            return Ok(());
        }
        write_grid(&self.body, &self.files, folder)
    }

    /// What observers are told.
    pub fn news(&self) -> NewGrid<'_> {
        NewGrid { mesh: &self.body.mesh, material: &self.body.material, files: &self.files }
    }
}

/// An error that names the regrid.
pub fn at_step(error: Error, state: &State) -> Error {
    match error {
        Error::Input { what, place, remedy } => Error::Input {
            what: format!("regrid at step {}, t = {:.6e} s: {what}", state.step, state.time),
            place,
            remedy,
        },
        other => other,
    }
}
