//! The problem: a simple wave that stays far from the sides of its rectangle, which are periodic.

use crate::error::{Error, Place, Result};
use crate::exact::Exact;
use crate::mesh::{Mesh, map};
use crate::state::State;
use crate::step::Scheme;
use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// Centre and width of the pulse at the start, and the way of the wave, over the length L of the rectangle. The sides are
/// 6 widths away from the start to the end (at most 1.15 c_p t for 10 % compression): exp(-36) = 2e-16 there, so the
/// periodic sides see a body at rest to the last bit. It would break after 21 widths and runs 3.
const CENTRE: f64 = 0.4;
const WIDTH: f64 = 1.0 / 16.0;
const WAY: f64 = 0.18;
/// Largest compression, 1 - F11.
const AMPLITUDE: f64 = 0.1;
/// c_p of the paper's steel at F = 1, m/s.
const SPEED: f64 = 5875.097;
/// Part of the length of the rectangle within which an edge lies on a side.
const ON_SIDE: f64 = 1e-9;

/// Smallest and largest coordinates, m.
pub fn extent(mesh: &Mesh) -> [[f64; 2]; 2] {
    let fold = |start: f64, pick: fn(f64, f64) -> f64| {
        mesh.nodes.iter().fold([start; 2], |a, x| [pick(a[0], x[0]), pick(a[1], x[1])])
    };
    [fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)]
}

/// The scene on a mesh with the groups and the extent of a rectangle. (Its own rectangle only stands for that mesh.)
pub fn scene([low, high]: [[f64; 2]; 2]) -> String {
    let size = [high[0] - low[0], high[1] - low[1]];
    let (centre, width, end) = (low[0] + CENTRE * size[0], WIDTH * size[0], WAY * size[0] / SPEED);
    format!(
        "title = \"Simple wave on a periodic rectangle\"\n\
         [mesh]\nrectangle = {{ size = {size:?}, cells = [1, 1] }}\n\
         [[material]]\nlaw = \"neo-hookean\"\nyoung = 2e11\npoisson = 0.3\ndensity = 7800.0\n\
         [exact]\nkind = \"simple-wave\"\namplitude = {AMPLITUDE}\ncentre = {centre:?}\nwidth = {width:?}\n\
         [[boundary]]\ngroup = \"left\"\nkind = \"periodic\"\npartner = \"right\"\n\
         [[boundary]]\ngroup = \"bottom\"\nkind = \"periodic\"\npartner = \"top\"\n\
         [scheme]\nmethod = \"rk-dgfem\"\ndegree = 1\n[time]\nend = {end:?}\n"
    )
}

/// A mesh from a file with the groups of a rectangle: `body`, and its sides by where their edges lie.
///
/// # Errors
/// A mesh with an edge of a group that lies on no side of its bounding box.
pub fn periodic(mut mesh: Mesh, path: &Path) -> Result<Mesh> {
    let [low, high] = extent(&mesh);
    let length = (high[0] - low[0]).max(high[1] - low[1]);
    let sides = [(0, low[0]), (0, high[0]), (1, low[1]), (1, high[1])];
    for edge in 0..mesh.edges.len() {
        let at = mesh.edges[edge];
        let ends = mesh.face_nodes(at.cell, at.face).map(|node| mesh.nodes[node]);
        let on = |&(axis, value): &(usize, f64)| ends.iter().all(|x| (x[axis] - value).abs() < ON_SIDE * length);
        let Some(side) = sides.iter().position(on) else {
            return Err(Error::at(
                Place::file(path),
                format!("the edge from {:?} to {:?} lies on no side of a rectangle along the axes", ends[0], ends[1]),
                "bench needs a rectangle without holes and inner groups, such as meshes/square_unstructured.msh",
            ));
        };
        mesh.edges[edge].group = side;
    }
    mesh.edge_groups = ["left", "right", "bottom", "top"].map(str::to_owned).to_vec();
    mesh.groups = vec!["body".to_owned()];
    mesh.cell_group.fill(0);
    Ok(mesh)
}

/// F and v by the bits of X1 and t.
type Known = HashMap<[u64; 2], ([f64; 4], [f64; 2])>;

/// The exact solution, which depends on X1 and t only and costs a search: each is done once.
pub struct Wave {
    exact: Arc<dyn Exact>,
    known: Mutex<Known>,
}

impl Wave {
    /// Of a solution that does not depend on X2.
    pub fn new(exact: Arc<dyn Exact>) -> Self {
        Self { exact, known: Mutex::default() }
    }

    fn at(&self, x: [f64; 2], t: f64) -> ([f64; 4], [f64; 2]) {
        let mut known = self.known.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let value = || (self.exact.deformation(x, t), self.exact.velocity(x, t));
        *known.entry([x[0].to_bits(), t.to_bits()]).or_insert_with(value)
    }

    /// The state at t = 0.
    pub fn state(&self, mesh: &Mesh, scheme: &Scheme) -> State {
        let (basis, n) = (&scheme.operators.line.basis, scheme.operators.nodes());
        let density = scheme.laws[0].density();
        let components = scheme.flux.components();
        let mut cells = vec![0.0; mesh.cells.len() * components * n];
        for (cell, values) in cells.chunks_mut(components * n).enumerate() {
            let map = mesh.map(cell);
            for a in 0..n {
                let (f, v) = self.at(map::position(&map, basis.node_2d(a)), 0.0);
                let u = [f[0], f[1], f[2], f[3], density * v[0], density * v[1]];
                u.into_iter().enumerate().for_each(|(k, u)| values[k * n + a] = u);
            }
        }
        State::pack(&scheme.operators.blocks, n, components, &cells)
    }
}

impl Exact for Wave {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        self.at(x, t).0
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        self.at(x, t).1
    }
}
