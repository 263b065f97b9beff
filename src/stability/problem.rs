//! What is looked at: a scene, a free strip or a periodic patch, built as a run of a scene is.

use crate::error::{Error, Result};
use crate::mesh::{self, Mesh};
use crate::problem;
use crate::registry::Value;
use crate::scene::{Scene, Step};
use crate::state::State;
use crate::step::{Method, Motion, Scheme};
use std::fmt::Write;
use std::path::Path;

/// The groups of the sides of a rectangle.
const SIDES: [&str; 4] = ["left", "right", "bottom", "top"];
/// The groups of cells of the two materials of a [`Setup`] with contrast.
const GROUPS: [&str; 2] = ["soft", "stiff"];

names! {
    /// Which cells of a patch or a body are the stiffer ones, where there are two materials.
    Pattern {
        /// Every other cell, by rows and columns.
        Checkerboard = "checkerboard",
        /// Of a body the right half; of a patch every other column.
        Halves = "halves",
    }
}

/// The body.
#[derive(Debug, Clone)]
pub enum Domain {
    /// A patch of unit squares that goes on without end, by Bloch angles.
    Patch,
    /// So many unit squares, with the kinds of boundary condition at left, right, bottom and top.
    Body([usize; 2], [String; 4]),
    /// A scene, as it stands.
    Scene(Box<Scene>),
}

/// One case: everything that a step of it needs is a scene and what is said here.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The body.
    pub domain: Domain,
    /// `--set` of its scene.
    pub sets: Vec<String>,
    /// Young's modulus of the stiffer cells over that of the others; 1: one material.
    pub contrast: f64,
    /// Where the stiffer cells are.
    pub pattern: Pattern,
    /// dt c / h in place of what the scene says.
    pub courant: Option<f64>,
    /// Whether the limit dt -> 0 is looked at in place of a step.
    pub semi_discrete: bool,
}

/// A setup that is ready to step.
pub struct Problem {
    /// The mesh.
    pub mesh: Mesh,
    /// The scheme.
    pub scheme: Scheme,
    /// The state about which it is linearised.
    pub state: State,
    /// The scene as built, for names.
    pub scene: Scene,
    /// Cells of the unit that is repeated, by direction; none of a bounded body.
    pub unit: Option<[usize; 2]>,
    /// Units of a patch by direction, an odd number.
    pub units: usize,
    /// Smallest h_e, m.
    pub h: f64,
    /// Largest wave speed, m/s.
    pub c: f64,
    /// Largest c_p of the laws at F = 1, m/s.
    pub reference: f64,
    /// Largest wave speed of each cell, m/s.
    pub speeds: Vec<f64>,
    /// dt c / h of the case.
    pub courant: f64,
    /// The stability limit that the program has for the method, dt c / h.
    pub known_limit: f64,
}

impl Setup {
    /// Mesh, scheme and state.
    ///
    /// # Errors
    /// Bad input, as for a run of the scene.
    pub fn build(&self) -> Result<Problem> {
        let asked = self.scene(&self.sets)?;
        let known_limit = asked.step_limit();
        let safety = match asked.scheme.step {
            Step::Safety(safety) => safety,
            Step::Cfl(cfl) => cfl / ((2 * asked.scheme.degree + 1) as f64 * known_limit),
        };
        let courant = self.courant.unwrap_or(safety * known_limit);
        // With N_T = 0 every method is its limit dt -> 0 plus terms of order dt.
        let mut sets = self.sets.clone();
        if self.semi_discrete {
            sets.push("scheme.time_degree=0".to_owned());
            sets.push("scheme.sweeps=paper".to_owned());
        } else if known_limit == 0.0 && self.courant.is_none() {
            let what = "explicit Euler (time_degree = 0) has no stable step for this degree";
            return Err(Error::input(what, "give time_degree from 1 to 6, a step by --dt, or --semi-discrete"));
        }
        let mut scene = if self.semi_discrete { self.scene(&sets)? } else { asked };
        // Outputs would ask for the displacement.
        scene.outputs.clear();
        let (mesh, unit, units) = self.mesh(&mut scene)?;
        let mut setup = problem::Setup::of(&scene).mesh(mesh);
        let mut body = setup.body()?;
        if let Some(unit) = unit {
            body.cloud = repeated(&body.cloud, unit, unit.map(|n| n * units));
        }
        let (scheme, _) = setup.scheme(&body)?;
        // A limiter has no derivative at its kinks, and takes small noise for shocks: the step without it is looked at.
        let scheme = scheme.with_corrections(vec![]).with_rescue(None);
        let mesh = body.mesh;
        let state = scene.initial_state(&mesh, &scheme)?;
        Problem::new(mesh, scheme, state, scene, (unit, units), (courant, known_limit))
    }

    /// Whether its method has material points.
    ///
    /// # Errors
    /// Bad input, as for a run of the scene.
    pub(super) fn has_points(&self) -> Result<bool> {
        Ok(self.scene(&self.sets)?.scheme.method.has_points())
    }

    /// The scene with overrides.
    fn scene(&self, sets: &[String]) -> Result<Scene> {
        let scene = match &self.domain {
            Domain::Scene(scene) => return scene.with(sets),
            _ => Scene::parse(&self.text(), Path::new("stability.toml"), sets)?,
        };
        if self.contrast == 1.0 {
            return Ok(scene);
        }
        let material = &scene.materials[0];
        let mut second = format!("material.1={{group=\"{}\",law=\"{}\"", GROUPS[1], material.law.name());
        for (name, value) in material.law.values.iter() {
            let Value::Number(value) = value else { continue };
            let value = if name == "young" { self.contrast * value } else { *value };
            let _ = write!(second, ",{name}={value:?}");
        }
        scene.with(&[format!("material.0.group={}", GROUPS[0]), second + "}"])
    }

    /// The text of the scene of a patch or a body. The mesh is made in [`Setup::mesh`]: the name of its file only stands
    /// for that.
    fn text(&self) -> String {
        let mut text = "title = \"stability\"\n[mesh]\nfile = \"made.msh\"\n[[material]]\nlaw = \"neo-hookean\"\n\
             young = 1.0\npoisson = 0.3\ndensity = 1.0\n[scheme]\nmethod = \"rk-dgfem\"\ndegree = 1\n[time]\nend = 1.0\n"
            .to_owned();
        match &self.domain {
            Domain::Body(_, kinds) => {
                for (side, kind) in SIDES.iter().zip(kinds) {
                    let _ = write!(text, "[[boundary]]\ngroup = \"{side}\"\nkind = \"{kind}\"\n");
                }
            }
            _ => {
                for [side, partner] in [[SIDES[0], SIDES[1]], [SIDES[2], SIDES[3]]] {
                    let periodic = format!("kind = \"periodic\"\npartner = \"{partner}\"\n");
                    let _ = write!(text, "[[boundary]]\ngroup = \"{side}\"\n{periodic}");
                }
            }
        }
        text
    }

    /// The mesh, and of a patch the cells of its unit and the number of units per direction.
    fn mesh(&self, scene: &mut Scene) -> Result<(Mesh, Option<[usize; 2]>, usize)> {
        let (cells, unit, units) = match &self.domain {
            Domain::Scene(_) => return Ok((scene.build_mesh()?, None, 1)),
            Domain::Body(cells, _) => (*cells, None, 1),
            Domain::Patch => {
                let unit = match self.pattern {
                    _ if self.contrast == 1.0 => [1, 1],
                    Pattern::Checkerboard => [2, 2],
                    Pattern::Halves => [2, 1],
                };
                // What a cell does in a step reaches as many cells as it has stages; what the face of a cell has crept is known to the
                // predictor of the cell beyond it, and so reaches the neighbours of that one.
                let reach = match scene.integration() {
                    Method::RungeKutta(tableau) => tableau.stages(),
                    Method::Ader { .. } => 1 + usize::from(scene.scheme.springs),
                };
                let units = 1 + 2 * reach.div_ceil(unit[0].min(unit[1]));
                (unit.map(|n| n * units), Some(unit), units)
            }
        };
        let mut mesh = mesh::rectangle(cells.map(|n| n as f64), cells)?;
        if self.contrast != 1.0 {
            mesh.groups = GROUPS.map(str::to_owned).to_vec();
            for (cell, group) in mesh.cell_group.iter_mut().enumerate() {
                let [ix, iy] = [cell % cells[0], cell / cells[0]];
                *group = match self.pattern {
                    Pattern::Checkerboard => (ix + iy) % 2,
                    Pattern::Halves if unit.is_some() => ix % 2,
                    Pattern::Halves => usize::from(2 * ix >= cells[0]),
                };
            }
        }
        scene.check_groups(&mesh.groups, &mesh.edge_groups)?;
        Ok((mesh, unit, units))
    }
}

/// The points of the cells of one unit in all units of a patch, which is the same everywhere then.
fn repeated(cloud: &crate::cloud::Cloud, unit: [usize; 2], cells: [usize; 2]) -> crate::cloud::Cloud {
    let mut out = crate::cloud::Cloud { first: vec![0], xi: vec![] };
    for cell in 0..cells[0] * cells[1] {
        let from = (cell % cells[0]) % unit[0] + (cell / cells[0]) % unit[1] * cells[0];
        out.xi.extend_from_slice(&cloud.xi[cloud.first[from]..cloud.first[from + 1]]);
        out.first.push(out.xi.len());
    }
    out
}

impl Problem {
    fn new(
        mesh: Mesh,
        scheme: Scheme,
        state: State,
        scene: Scene,
        (unit, units): (Option<[usize; 2]>, usize),
        (courant, known_limit): (f64, f64),
    ) -> Result<Self> {
        // With the memory that conditions have at a start.
        let Motion { state, work, mut survey, .. } = Motion::unsurveyed(&scheme, state);
        scheme.survey(&state, &work, &mut survey).map_err(|loss| {
            let what = format!("the state is no state of the law: {} in cell {}", loss.kind, mesh.number(loss.cell));
            Error::input(what, "give another deformation, or a law that is hyperbolic there")
        })?;
        let h = mesh.smallest_h();
        let speeds =
            scheme.operators.blocks.slot.iter().map(|&(block, lane)| survey.speed[block].fastest.0[lane]).collect();
        let reference = scheme.laws.iter().map(|law| law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0]);
        let reference = reference.fold(0.0, f64::max);
        Ok(Self {
            reference,
            mesh,
            scheme,
            state,
            scene,
            unit,
            units,
            h,
            c: survey.fastest,
            speeds,
            courant,
            known_limit,
        })
    }

    /// Unknowns of a cell at its nodes: F, p, and u where its jumps are held.
    pub fn at_nodes(&self) -> usize {
        self.state.components * self.scheme.operators.nodes()
    }

    /// Unknowns of a cell: those at its nodes, then the creep of its faces where they have springs.
    pub fn per_cell(&self) -> usize {
        let creep = if self.state.creep.is_empty() { 0 } else { self.scheme.creep_of_block() };
        self.at_nodes() + creep
    }

    /// The cells whose unknowns are perturbed: one unit in the middle of a patch, or all.
    pub fn columns(&self) -> Vec<usize> {
        let Some(unit) = self.unit else { return (0..self.mesh.cells.len()).collect() };
        let middle = (self.units - 1) / 2;
        (0..unit[1])
            .flat_map(|iy| (0..unit[0]).map(move |ix| (ix, iy)))
            .map(|at| self.cell_at([middle; 2], at))
            .collect()
    }

    /// The cell (ix, iy) of a unit of a patch.
    pub fn cell_at(&self, unit_at: [usize; 2], (ix, iy): (usize, usize)) -> usize {
        let unit = self.unit.unwrap_or([1, 1]);
        (unit_at[1] * unit[1] + iy) * unit[0] * self.units + unit_at[0] * unit[0] + ix
    }

    /// dt of a dt c / h, s.
    pub fn dt(&self, courant: f64) -> f64 {
        courant * self.h / self.c
    }
}
