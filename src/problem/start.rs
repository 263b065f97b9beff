//! The initial state of a scene: from its expressions, its exact solution, a snapshot, the fields of its cloud or those of another mesh.

use super::from_fields::{self, Sampler};
use crate::error::Result;
use crate::exact::Exact;
use crate::expression::Expression;
use crate::io::snapshot::Snapshot;
use crate::mesh::{self, Mesh};
use crate::operators::Line;
use crate::scene::{self, Scene};
use crate::state::State;
use crate::step::Scheme;
use crate::tensor;
use std::sync::Arc;

impl Scene {
    /// The initial state: F and p at the grid nodes from the scene's expressions, from its exact solution, or from the
    /// fields of its cloud.
    ///
    /// # Errors
    /// A value that is not finite, or J <= 0, with its place in the mesh.
    pub fn initial_state(&self, mesh: &Mesh, scheme: &Scheme) -> Result<State> {
        if let Some(path) = &self.initial.snapshot {
            return self.state_of_snapshot(&self.existing("initial.snapshot", path)?, scheme);
        }
        if self.initial.from_cloud {
            return self.state_from_cloud(mesh, scheme);
        }
        let n = scheme.operators.nodes();
        let components = self.components();
        let blocks = &scheme.operators.blocks;
        let mut state = State { time: self.start, ..State::at_rest(blocks, n, components) };
        let material = self.material_of_cells(mesh);
        let start = Start::of(self, mesh, &scheme.operators.line)?;
        for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
            let values = &mut state.u[block * components * n..];
            let density = scheme.laws[material[cell]].density();
            for a in 0..n {
                let (f, v, displacement) = start.at(cell, a)?;
                let u = [f[0], f[1], f[2], f[3], density * v[0], density * v[1]].into_iter().chain(displacement);
                u.take(components).enumerate().for_each(|(k, u)| values[k * n + a].0[lane] = u);
            }
        }
        if start.fields.is_some() {
            state = state.holding_from_now(n);
        }
        scheme.set_internal(&mut state, &scheme.virgin_internal());
        Ok(state)
    }

    /// Looks for what is wrong with the initial state before matrices are built and written for it.
    ///
    /// # Errors
    /// As [`Scene::initial_state`]; what is at the points and faces alone is found by the first step.
    pub fn check_start(&self, mesh: &Mesh) -> Result<()> {
        if let Some(path) = &self.initial.snapshot {
            let snapshot = Snapshot::read(&self.existing("initial.snapshot", path)?)?;
            self.check_time(&snapshot)?;
            return self.check_snapshot(&snapshot, mesh.cells.len());
        }
        if self.initial.from_cloud {
            return Ok(());
        }
        let line = Line::new(self.scheme.degree);
        let (start, n) = (Start::of(self, mesh, &line)?, line.m * line.m);
        let all = self.initial.velocity.iter().chain(&self.initial.deformation);
        let varies = start.exact.is_none() && all.map(Expression::constant).any(|value| value.is_none())
            || start.fields.is_some();
        // What is the same at all nodes is looked at once. An exact solution is good within its ranges: one look is enough, too.
        let cells = if varies { mesh.cells.len() } else { 1 };
        (0..cells).try_for_each(|cell| (0..n).try_for_each(|a| start.at(cell, a).map(drop)))
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
}

/// F and v of the start at the nodes of a mesh.
struct Start<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    line: &'a Line,
    exact: Option<Arc<dyn Exact>>,
    /// Those of a file.
    fields: Option<Sampler>,
}

impl<'a> Start<'a> {
    fn of(scene: &'a Scene, mesh: &'a Mesh, line: &'a Line) -> Result<Self> {
        let exact = scene.exact.as_ref().filter(|exact| exact.initial).and_then(|_| scene.build_exact());
        Ok(Self { scene, mesh, line, exact, fields: scene.sampler()? })
    }

    /// F, v and u at a node of a cell.
    fn at(&self, cell: usize, node: usize) -> Result<([f64; 4], [f64; 2], [f64; 2])> {
        let Self { scene, mesh, .. } = self;
        let x = mesh::map::position(&mesh.map(cell), self.line.basis.node_2d(node));
        let (f, v) = match &self.exact {
            Some(exact) => (exact.deformation(x, scene.start), exact.velocity(x, scene.start)),
            None => {
                scene.check_initial_expressions(x, mesh.number(cell))?;
                scene.initial.at(x)
            }
        };
        let of_file = match &self.fields {
            Some(fields) => scene.sampled(fields, x, mesh.number(cell))?,
            None => from_fields::Values::default(),
        };
        let (f, v) = (of_file.deformation.unwrap_or(f), of_file.velocity.unwrap_or(v));
        scene.check_initial(f, v, x, mesh.number(cell))?;
        // Without the field the displacement counts from the start.
        Ok((f, v, of_file.displacement.unwrap_or_default()))
    }
}

impl scene::Initial {
    /// F and v at X.
    fn at(&self, x: [f64; 2]) -> ([f64; 4], [f64; 2]) {
        let value = |e: &Expression| e.eval(x, 0.0);
        (self.deformation.each_ref().map(value), self.velocity.each_ref().map(value))
    }
}
