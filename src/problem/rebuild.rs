//! Another grid in mid-run, `[[regrid]]`, and for a stopped run, `dgmpm regrid`. Mesh, points, operators and scheme are made anew
//! and the state is brought over; time and step go on. Where grid and points are the same nothing is touched, so that no bit
//! changes.

use super::moved::{Moved, scale};
use super::outcome::{Clock, Outcome, columns};
use super::outputs::schedule_of;
use super::ranks::divided;
use super::{Body, Problem, Recent};
use crate::boundary::{Boundary, Free};
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::io::csv::Table;
use crate::io::snapshot::GridFiles;
use crate::io::{hash, pending};
use crate::mesh::Mesh;
use crate::observe::{Schedule, View};
use crate::operators::{Limits, Operators};
use crate::registry::grids::Present;
use crate::regrid::points::{Placed, Policy, Requirements, histories, place};
use crate::regrid::{self, Field, Grid, Transfer};
use crate::run::{Folder, Pause};
use crate::scene::{Scene, When};
use crate::state::{Received, State};
use crate::step::{Scheme, Totals};
use crate::words::{Saved, Words};
use rstar::{RTree, primitives::GeomWithData};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Boundary points with the places of their numbers.
type PointTree = RTree<GeomWithData<[f64; 2], Range<usize>>>;

/// The rules of a scene, and what has come of them.
pub struct Regrids<'a> {
    scene: Scene,
    folder: Option<&'a Folder>,
    schedules: Vec<Schedule>,
    /// How often each rule has fired.
    fired: Vec<usize>,
    /// The rule that fired last, and the mesh that it asks for.
    next: Option<(usize, Result<Mesh>)>,
    material: Vec<usize>,
    cloud: Cloud,
    /// Cells of the grid at the start.
    start: usize,
    recent: Recent,
    files: HashMap<String, GridFiles>,
    table: Option<Table>,
}

impl Pause for Regrids<'_> {
    fn stop(&self, time: f64) -> Option<f64> {
        self.schedules.iter().filter_map(|schedule| schedule.stop(time)).reduce(f64::min)
    }

    fn looks(&self) -> bool {
        !self.schedules.is_empty()
    }

    fn due(&mut self, view: &View) -> bool {
        let (step, time) = (view.state.step, view.state.time);
        let present = Present { view, cloud: &self.cloud, material: &self.material, start: self.start };
        for rule in 0..self.schedules.len() {
            if self.schedules[rule].due(step, time, view.dt) && self.scene.regrid_is_due(rule, &present) {
                let mesh = self.scene.regrid_mesh(rule, self.fired[rule], &present);
                self.fired[rule] += 1;
                self.next = Some((rule, mesh));
            }
        }
        self.next.is_some()
    }

    fn save(&mut self, to: &mut Words) -> Result<()> {
        to.count(self.schedules.len()).count(self.start);
        for (schedule, fired) in self.schedules.iter().zip(&self.fired) {
            to.count(schedule.served()).count(*fired);
        }
        let mut files: Vec<_> = self.files.iter().collect();
        files.sort_unstable_by_key(|(key, _)| *key);
        to.count(files.len());
        for (key, files) in files {
            to.text(key).text(&files.mesh).text(&files.cloud);
        }
        self.table.as_mut().map_or(Ok(()), |table| table.save(to))
    }

    fn restore(&mut self, from: &mut Saved) -> Result<()> {
        if from.count()? != self.schedules.len() {
            return Err(Error::input(
                "the checkpoint was saved with other [[regrid]] rules",
                "resume with those rules",
            ));
        }
        // The bound on `refine` counts from the first grid of the run, and not from the one that it goes on with.
        self.start = from.count()?;
        for (schedule, fired) in self.schedules.iter_mut().zip(&mut self.fired) {
            schedule.resume(from.count()?);
            *fired = from.count()?;
        }
        self.files.clear();
        for _ in 0..from.count()? {
            self.files.insert(from.text()?, GridFiles { mesh: from.text()?, cloud: from.text()? });
        }
        self.table.as_mut().map_or(Ok(()), |table| table.restore(from))
    }
}

impl<'a> Regrids<'a> {
    /// The rules of a scene at the start of a run; files go to `folder` where there is one.
    ///
    /// # Errors
    /// A table that cannot be made in the folder.
    pub fn new(problem: &Problem, folder: Option<&'a Folder>) -> Result<Self> {
        let (scene, start, first) = (problem.scene.clone(), &problem.state, &problem.body);
        let mut schedules: Vec<Schedule> =
            scene.regrids.iter().map(|rule| schedule_of(&rule.when, rule.exact_times)).collect();
        // `every` and `every_steps` count from the start, whose grid is that of [mesh]; `at` may name it.
        for (schedule, rule) in schedules.iter_mut().zip(&scene.regrids) {
            if !matches!(rule.when, When::At(_)) && rule.criteria.are_none() {
                schedule.due(start.step, start.time, 0.0);
            }
        }
        let table = match folder.filter(|_| !scene.regrids.is_empty()) {
            Some(folder) => Some(Table::create(&folder.regrids(), &columns())?),
            None => None,
        };
        let files = HashMap::from([(key_of_files(first), problem.files.clone())]);
        let fired = vec![0; schedules.len()];
        // Nobody looks at them without a rule.
        let (material, cloud) = match schedules.is_empty() {
            true => Default::default(),
            false => (first.material.clone(), first.cloud.clone()),
        };
        let (recent, start) = (Recent::default(), first.mesh.cells.len());
        Ok(Self { scene, folder, schedules, fired, next: None, material, cloud, start, recent, files, table })
    }

    /// Whether it has a folder, with a table of what regrids did.
    pub(super) fn writes(&self) -> bool {
        self.folder.is_some()
    }

    /// Puts the grid that is due in place of that of `problem`, and the state on it; what happened in words, and totals before
    /// and after, none where the grid is the same.
    ///
    /// # Errors
    /// A mesh that cannot be made or does not fit the body.
    pub fn rebuild(&mut self, problem: &mut Problem) -> Result<(Vec<String>, Option<[Totals; 2]>)> {
        let Some((rule, mesh)) = self.next.take() else { return Ok((vec![], None)) };
        let mut clock = Clock::new();
        let rule_of = &self.scene.regrids[rule];
        let place = || self.scene.place(&format!("regrid.{rule}.{}", rule_of.grid.name()));
        let mesh = mesh.map_err(|why| why.or_at(place()))?;
        clock.lap("mesh");
        let (policy, recent) = (rule_of.points, &mut self.recent);
        let moved = problem.moved(mesh, policy, |scene, body| recent.operators(scene, body), &mut clock);
        let moved = moved.map_err(|why| why.or_at(place()))?;
        let (step, time) = (problem.state.step, problem.state.time);
        let Some(moved) = moved else {
            return Ok((vec![format!("regrid at step {step}, t = {time:.6e} s: the grid is the same")], None));
        };
        let totals = [problem.scheme.totals(&problem.state), moved.scheme.totals(&moved.state)];
        clock.lap("scheme");
        let files = self.write(&moved.body, step)?;
        clock.lap("files");
        (self.material, self.cloud) = (moved.body.material.clone(), moved.body.cloud.clone());
        let outcome = Outcome { rule, old: &problem.body, new: &moved, totals: &totals };
        let words = outcome.words(&clock);
        if let Some(table) = &mut self.table {
            table.push(&outcome.row(&clock))?;
            table.flush()?;
        }
        let Moved { body, scheme, state, .. } = moved;
        (problem.body, problem.scheme, problem.state, problem.files) = (body, scheme, state, files);
        Ok((words, Some(totals)))
    }

    /// Writes mesh and points beside those of the start, each grid once; nothing where no output takes snapshots.
    fn write(&mut self, body: &Body, step: usize) -> Result<GridFiles> {
        let snapshots = self.scene.outputs.iter().any(|output| output.what.build().snapshots);
        let Some(folder) = self.folder.filter(|_| snapshots) else { return Ok(GridFiles::after(step)) };
        let key = key_of_files(body);
        if let Some(files) = self.files.get(&key) {
            return Ok(files.clone());
        }
        let files = GridFiles::after(step);
        pending::check_folder(&folder.root)?;
        body.write(folder, &files)?;
        self.files.insert(key, files.clone());
        Ok(files)
    }
}

fn key_of_files(body: &Body) -> String {
    hash::of_mesh(&body.mesh) + &hash::of_cloud(&body.cloud)
}

impl Body {
    fn grid(&self) -> Grid<'_> {
        Grid { mesh: &self.mesh, material: &self.material }
    }
}

impl Problem {
    /// The problem on another mesh of the same body; none where grid and points are the same. `operators` makes the matrices.
    ///
    /// # Errors
    /// A mesh that is not of the same body, or whose points cannot carry the degree.
    pub(super) fn moved(
        &self,
        mesh: Mesh,
        policy: Policy,
        operators: impl FnOnce(&Scene, &Body) -> Result<Operators>,
        clock: &mut Clock,
    ) -> Result<Option<Moved>> {
        let Self { scene, body: old, scheme, state, .. } = self;
        let material = scene.material_of_cells(&mesh);
        let (from, to) = (old.grid(), Grid { mesh: &mesh, material: &material });
        let n = scheme.operators.nodes();
        let (unknowns, scale) = (state.unpack(&scheme.operators.blocks, n), scale(scheme));
        let basis = &scheme.operators.line.basis;
        let field = Field { basis, components: state.components, u: &unknowns, scale: &scale };
        let mut transfer = regrid::transfer(&from, &to, &field)?;
        clock.lap("transfer");
        let placed = self.place_points(&to, &transfer, policy)?;
        clock.lap("points");
        if mesh == old.mesh && placed.cloud == old.cloud {
            return Ok(None);
        }
        let body = Body::as_placed(mesh, placed.cloud.clone(), placed.virtual_points.clone(), material);
        let operators = operators(scene, &body)?;
        clock.lap("matrices");
        // Laws, conditions, sources and corrections may be the user's own: they go on as they are.
        let on_grid = |operators| {
            let conditions = conditions_on(&body.mesh, &old.mesh, scheme);
            scheme.on_grid(operators, conditions, &self.scene.pairings(&body.mesh))
        };
        let after = divided(on_grid(operators)?, scene, &body, on_grid)?;
        regrid::curl_free(&after, state.components, &transfer.same, &mut transfer.u);
        let new = State::pack(&after.operators.blocks, n, state.components, &transfer.u);
        let mut new = State { time: state.time, step: state.step, ..new }.holding(state, &transfer.same, n);
        new.creep = after.creep_from(scheme, state, &transfer.same);
        let internal = self.internal_on(body.grid(), (&after, &new), &transfer.same, &placed)?;
        after.set_internal(&mut new, &internal);
        let boundary = self.boundary_memory_on(&body.mesh, &after);
        after.set_boundary_memory(&mut new, &boundary);
        new.received = received_on(&body.mesh, &old.mesh, state);
        Ok(Some(Moved { body, scheme: after, state: new, transfer, placed }))
    }

    /// The problem on another mesh of the same body: fields by projection, histories at their points, time and step as they are.
    ///
    /// # Errors
    /// A mesh that is not of the same body, whose groups are not those of the scene, or whose points cannot carry the degree.
    pub fn regrid(&mut self, mesh: Mesh, policy: Policy) -> Result<()> {
        let mesh = self.scene.cut_mesh(mesh)?;
        let moved = self.moved(mesh, policy, |scene, body| body.operators(scene), &mut Clock::new())?;
        if let Some(Moved { body, scheme, state, .. }) = moved {
            (self.body, self.scheme, self.state) = (body, scheme, state);
            self.files = GridFiles::after(self.state.step);
        }
        Ok(())
    }

    /// Internal variables at the points (or nodes) of a new grid; empty where no law has any.
    fn internal_on(
        &self,
        to: Grid,
        (after, new): (&Scheme, &State),
        same: &[Option<usize>],
        placed: &Placed,
    ) -> Result<Vec<f64>> {
        let (from, before) = (self.body.grid(), &self.scheme);
        if before.histories.is_empty() {
            return Ok(vec![]);
        }
        let count: Vec<usize> = before.laws.iter().map(|law| law.history_len()).collect();
        let (old_places, places) = (before.places(), after.places());
        // The law is evaluated at the nodes, which are new points in cells that are new.
        let stays = |(cell, twin): (usize, &Option<usize>)| twin.filter(|&twin| old_places.of(twin) == places.of(cell));
        let same = &same.iter().enumerate().map(stays).collect::<Vec<_>>();
        let (line, limits) = (&after.operators.line, &Limits::of_degree(after.operators.degree));
        let own = old_places == self.body.cloud && places == placed.cloud;
        let nodes = match own {
            true => None,
            false => {
                let (policy, fresh, histories) = (Policy::Layout, &places, true);
                let (virtual_points, on_nodes) = (&[][..], &[][..]);
                let required =
                    Requirements { line, policy, fresh, samples: false, limits, virtual_points, histories, on_nodes };
                Some(place(&from, &old_places, &to, same, &required)?)
            }
        };
        let placed = nodes.as_ref().unwrap_or(placed);
        let mut values = histories(&from, &old_places, placed, &before.internal_of(&self.state), &count);
        let (f_old, f_new) = (deformation(before, &self.state, &old_places), deformation(after, new, &places));
        let (mut rest, mut p) = (&mut values[..], 0);
        for (cell, &material) in to.material.iter().enumerate() {
            for _ in places.of(cell) {
                let (own, more) = rest.split_at_mut(count[material]);
                rest = more;
                // A point that stays where it is keeps its history to the bit.
                if same[cell].is_none() && !placed.kept[p] {
                    after.laws[material].move_history(f_old[placed.source[p]], f_new[p], own);
                }
                p += 1;
            }
        }
        Ok(values)
    }

    /// The memory of boundary conditions on a new grid: that of the nearest point of the group.
    fn boundary_memory_on(&self, mesh: &Mesh, after: &Scheme) -> Vec<f64> {
        let values = self.scheme.boundary_memory_of(&self.state);
        let mut trees: HashMap<&str, PointTree> = HashMap::new();
        for point in self.scheme.points_with_memory() {
            let group = &self.body.mesh.edge_groups[point.group][..];
            trees.entry(group).or_default().insert(GeomWithData::new(point.x, point.numbers));
        }
        let mut out = Vec::new();
        for point in after.points_with_memory() {
            // Groups are those of the scene on every grid: a group with points has a tree.
            let tree = trees.get(&mesh.edge_groups[point.group][..]);
            if let Some(nearest) = tree.and_then(|tree| tree.nearest_neighbor(point.x)) {
                out.extend_from_slice(&values[nearest.data.clone()]);
            }
        }
        out
    }

    /// Places the points on the new grid.
    fn place_points(&self, to: &Grid, transfer: &Transfer, policy: Policy) -> Result<Placed> {
        let Self { scene, body: old, scheme, .. } = self;
        let fresh = match policy {
            Policy::Keep => Cloud::default(),
            Policy::Enrich | Policy::Layout => scene.build_cloud(to.mesh)?,
        };
        let samples = scene.scheme.method.has_points();
        let histories = scheme.laws.iter().any(|law| law.has_memory());
        let (limits, virtual_points) = (&scene.limits_of_cells(), &old.virtual_points[..]);
        let line = &scheme.operators.line;
        let on_nodes = &scene.on_nodes(to.material);
        let required =
            Requirements { line, policy, fresh: &fresh, samples, limits, virtual_points, histories, on_nodes };
        place(&old.grid(), &old.cloud, to, &transfer.same, &required)
    }
}

/// The conditions of the groups of a new mesh, which are those of the old one by name; groups inside the body have none.
fn conditions_on(mesh: &Mesh, old: &Mesh, scheme: &Scheme) -> Vec<Arc<dyn Boundary>> {
    let number = |group: &String| old.edge_groups.iter().position(|known| known == group);
    let of = |group: &String| number(group).and_then(|k| scheme.boundaries.get(k)).cloned();
    mesh.edge_groups.iter().map(|group| of(group).unwrap_or_else(|| Arc::new(Free))).collect()
}

/// What the groups of a new mesh have received so far, by their names; nothing where nobody asks for it.
fn received_on(mesh: &Mesh, old: &Mesh, state: &State) -> Vec<Received> {
    if state.received.is_empty() {
        return vec![];
    }
    let number = |group: &String| old.edge_groups.iter().position(|known| known == group);
    let of = |group: &String| number(group).and_then(|k| state.received.get(k)).copied();
    let pairs = state.received.get(old.edge_groups.len()..).unwrap_or_default();
    mesh.edge_groups.iter().map(|group| of(group).unwrap_or_default()).chain(pairs.iter().copied()).collect()
}

/// F at points, in the order of the cloud.
fn deformation(scheme: &Scheme, state: &State, places: &Cloud) -> Vec<[f64; 4]> {
    let (basis, n) = (&scheme.operators.line.basis, scheme.operators.nodes());
    let cells = state.unpack(&scheme.operators.blocks, n);
    let at = |(cell, u): (usize, &[f64])| {
        let of_point = |xi: &[f64; 2]| {
            let phi = basis.values_2d(*xi);
            [0, 1, 2, 3].map(|k| phi.iter().zip(&u[k * n..]).map(|(phi, u)| phi * u).sum())
        };
        places.of(cell).iter().map(of_point).collect::<Vec<_>>()
    };
    cells.chunks_exact(state.components * n).enumerate().flat_map(at).collect()
}
