//! Angular momentum that each body keeps: the least change of its momentum that makes its angular momentum follow the torque from outside.
//!
//! (F, p) schemes keep momentum, and angular momentum only to their order: d/dt int x cross p has the term int (grad x - F) P^T, and what
//! interface fluxes take. After a step each body (cells that are connected through edges) turns a little:
//!
//! ```text
//! p <- p + rho0 omega E (x - x_c),    omega = (dt sum W x_n cross t* - change of int x cross p) / int rho0 |x - x_c|^2,    E = (0, -1; 1, 0)
//! ```
//!
//! Of all changes of p it is the one with the least kinetic energy that leaves momentum and gives this angular momentum (two Lagrange
//! multipliers: Lee, Gil, Bonet, Comput. Struct. 118, 2013, who keep both in each step by such a projection). x_n are the positions at the
//! start of the step, in which contact without friction has no torque on a pair: what one body gets the other one gives.
//!
//! The turning gives back energy that fluxes have lost. A limiter, or a body of few cells, may take less energy than the turning would
//! give back: then all bodies turn by the share of omega whose energy the step has lost, and what is left is counted
//! ([`Work::take_not_restored`]).

use super::block::Block;
use super::outside::Torques;
use super::{Part, Phase, Scheme, Work};
use crate::error::{Error, Result};
use crate::lane::{F8, LANES, ticks};
use crate::mesh::{FACES, map};
use crate::operators::{Neighbour, Operators};
use crate::state::{State, UNKNOWNS};
use crate::sum::{ExactSum, exact_sum};
use crate::tensor::{DEFORMATION, cross, minus};

/// The bodies of a mesh: the block and the lane of each of their cells, in the order of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bodies {
    cells: Vec<Vec<[usize; 2]>>,
    /// The body of each cell of the mesh.
    of_cell: Vec<usize>,
}

impl Bodies {
    fn new(operators: &Operators) -> Self {
        let blocks = &operators.blocks;
        let mut body_of = vec![usize::MAX; blocks.slot.len()];
        let mut count = 0;
        for first in 0..body_of.len() {
            if body_of[first] != usize::MAX {
                continue;
            }
            let mut next = vec![first];
            while let Some(cell) = next.pop() {
                if body_of[cell] != usize::MAX {
                    continue;
                }
                body_of[cell] = count;
                let (block, lane) = blocks.slot[cell];
                next.extend(blocks.neighbours[block].iter().filter_map(|lanes| match lanes[lane] {
                    Neighbour::Cell(across) | Neighbour::Interface(across, _) => {
                        Some(blocks.cells[across.face / FACES][across.lane])
                    }
                    Neighbour::Boundary(_) | Neighbour::Padding => None,
                }));
            }
            count += 1;
        }
        let mut cells = vec![vec![]; count];
        for (cell, &body) in body_of.iter().enumerate() {
            let (block, lane) = blocks.slot[cell];
            cells[body].push([block, lane]);
        }
        Self { cells, of_cell: body_of }
    }
}

/// What the motion of a body adds up to.
struct Sums {
    mass: f64,
    /// int rho0 x.
    first: [f64; 2],
    /// int rho0 |x|^2.
    second: f64,
    /// int p.
    momentum: [f64; 2],
    /// int x cross p.
    angular: f64,
    /// Its change in the step.
    change: f64,
}

/// How many numbers [`Sums`] has.
const SUMS: usize = 8;

/// How a body has to turn so that it keeps its angular momentum.
struct Turn {
    centre: [f64; 2],
    /// omega, a change of the angle's rate, 1/s.
    turn: f64,
    /// int rho0 |x - x_c|^2.
    inertia: f64,
    /// int (x - x_c) cross p before it turns.
    spin: f64,
}

/// The energy of a body that rounding may take for made in a step, over that energy.
const ROUNDING: f64 = 1e-14;

impl Scheme {
    /// With angular momentum that each body keeps. States must have the displacement, and steps must meter forces.
    ///
    /// # Errors
    /// Sources, whose torque is not metered; degree 0, which loses so much that the turning would make energy.
    pub fn keeping_angular_momentum(mut self) -> Result<Self> {
        if !self.sources.is_empty() {
            let what = "angular momentum is kept only where no source acts: the torque of sources is not metered";
            return Err(Error::input(what, "remove `angular_momentum` of [scheme], or the [[source]]"));
        }
        if self.operators.degree == 0 {
            let what =
                "angular momentum is not kept at degree 0: it loses so much that to restore it would make energy";
            return Err(Error::input(what, "take degree = 1 or more, or remove `angular_momentum` of [scheme]"));
        }
        self.bodies = Some(Bodies::new(&self.operators));
        Ok(self)
    }

    /// Whether each body keeps its angular momentum.
    pub fn keeps_angular_momentum(&self) -> bool {
        self.bodies.is_some()
    }
}

impl Block<'_> {
    /// Books the torque of the conditions at the block about the origin, from the lifted numbers of its faces, [face][point][6]; `state` is that
    /// at the start of the step.
    pub(super) fn book_torque(&self, state: &State, lift: &[F8], torques: &mut Torques) {
        let (operators, line) = (&self.scheme.operators, &self.scheme.operators.line);
        let (m, n) = (line.m, operators.nodes());
        let u = &self.unknowns(state)[UNKNOWNS * n..];
        for (face, neighbours) in operators.blocks.neighbours[self.number].iter().enumerate() {
            for lane in (0..LANES).filter(|lane| matches!(neighbours[*lane], Neighbour::Boundary(_))) {
                let corners = operators.geometry.map_of(self.number, lane);
                for point in 0..m {
                    let node = |j: usize| if face < 2 { j * m + point } else { point * m + j };
                    let moved = |axis: usize| -> f64 {
                        (0..m).map(|j| line.ends[face % 2][j] * u[axis * n + node(j)].0[lane]).sum()
                    };
                    let at = map::position(&corners, map::on_face(face, line.basis.nodes[point]));
                    let lift = &lift[UNKNOWNS * (m * face + point) + DEFORMATION..];
                    // The flux of momentum is -t*, and its lifted numbers are those times the length of the face.
                    let force = [0, 1].map(|k| -line.basis.weights[point] * self.factor() * lift[k].0[lane]);
                    torques[face].0[lane] += cross([at[0] + moved(0), at[1] + moved(1)], force);
                }
            }
        }
    }
}

impl Work {
    /// Turns each body of the new state so that its angular momentum has changed by the torque from outside, as far as the step has lost the
    /// energy that this takes. `before`: the state that the step began with. Nothing where the scheme does not ask for it.
    pub(super) fn keep_angular_momentum(&mut self, scheme: &Scheme, before: &State) {
        let Some(bodies) = &scheme.bodies else { return };
        let start = ticks();
        let between = self.torque_without_reaction(scheme, bodies);
        let turn_of = |(body, between): (&Vec<[usize; 2]>, f64)| {
            let sums = self.sums_of(scheme, before, body);
            let centre = sums.first.map(|x| x / sums.mass);
            let inertia = sums.second - sums.mass * (centre[0] * centre[0] + centre[1] * centre[1]);
            let turn = (self.torque_on(scheme, body) - between - sums.change) / inertia;
            let spin = sums.angular - cross(centre, sums.momentum);
            // A body that is lost turns no more.
            let turn = if turn.is_finite() { turn } else { 0.0 };
            Turn { centre, turn, inertia, spin }
        };
        let turns: Vec<Turn> = bodies.cells.iter().zip(between).map(turn_of).collect();
        let share = self.share_that_is_paid(scheme, before, &turns);
        self.turning_loss = -energy_of(&turns, share);
        for (body, Turn { centre, turn, inertia, .. }) in bodies.cells.iter().zip(&turns) {
            self.turn(scheme, body, *centre, share * turn);
            self.not_restored += (1.0 - share) * (turn * inertia).abs();
        }
        let scratch = self.scratch[0].get_mut().unwrap_or_else(|poisoned| poisoned.into_inner());
        scratch.phases.add_both(Phase::Corrections, Part::AngularMomentum, ticks().wrapping_sub(start));
    }

    /// The share of the turns whose energy is no more than what the step has lost before them: 1 but where few cells or a limiter have
    /// taken much angular momentum and little energy.
    fn share_that_is_paid(&mut self, scheme: &Scheme, before: &State, turns: &[Turn]) -> f64 {
        let made = energy_of(turns, 1.0);
        if made <= 0.0 {
            return 1.0;
        }
        let mut cells = vec![];
        let next = std::mem::take(&mut self.next);
        let [had, has] =
            [before, &next].map(|state| scheme.energy(state, self, &mut cells) + self.stored_in_contact(scheme, state));
        self.next = next;
        let [boundary, sources, _] = self.external_work(scheme);
        let lost = (had + boundary + sources - has).max(0.0) + ROUNDING * had;
        if made <= lost {
            return 1.0;
        }
        // a share + b share^2 = lost.
        let b = exact_sum(turns.iter().map(|own| 0.5 * own.turn * own.turn * own.inertia));
        let a = made - b;
        let root = (a * a + 4.0 * b * lost).sqrt();
        // Without cancellation for either sign of a.
        (if a > 0.0 { 2.0 * lost / (a + root) } else { (root - a) / (2.0 * b) }).clamp(0.0, 1.0)
    }

    /// The angular momentum that bodies were not given back since the last call, as its energy was not lost, kg m/s.
    pub fn take_not_restored(&mut self) -> f64 {
        std::mem::take(&mut self.not_restored)
    }

    /// The part of each body in what the torques of contact on bodies that touch sum up to, N m s/m: friction between sides that do not quite
    /// coincide has a torque on the pair, friction times gap. Each body gets of it what its own torque of contact has of all.
    fn torque_without_reaction(&self, scheme: &Scheme, bodies: &Bodies) -> Vec<f64> {
        let mut out = vec![0.0; bodies.cells.len()];
        let (Some(contacts), Some(torques), Some(meetings)) = (&scheme.contacts, &self.outside.torques, &self.meetings)
        else {
            return out;
        };
        let cells = &scheme.operators.blocks.cells;
        let body = |face: usize| {
            let face = &contacts.faces[face];
            bodies.of_cell[cells[face.face / FACES][face.lane]]
        };
        // Bodies that touch have the same, lowest, number.
        let mut set: Vec<usize> = (0..out.len()).collect();
        for segment in &meetings.segments {
            let [a, b] = segment.faces.map(|face| set[body(face)]);
            set.iter_mut().filter(|set| **set == a.max(b)).for_each(|set| *set = a.min(b));
        }
        // In the order of the mesh, which does not depend on the blocks.
        for (number, face) in contacts.faces.iter().enumerate() {
            let entry = self.outside.first[face.face / FACES] as usize;
            out[body(number)] += torques[entry][face.face % FACES].0[face.lane];
        }
        let (mut sums, mut sizes) = (vec![0.0; out.len()], vec![0.0; out.len()]);
        for (torque, &set) in out.iter().zip(&set) {
            sums[set] += torque;
            sizes[set] += torque.abs();
        }
        for (torque, set) in out.iter_mut().zip(set) {
            *torque = if sizes[set] > 0.0 { sums[set] * (torque.abs() / sizes[set]) } else { 0.0 };
        }
        out
    }

    /// The impulse of the torque on a body in the step, N m s/m.
    fn torque_on(&self, scheme: &Scheme, body: &[[usize; 2]]) -> f64 {
        let Some(torques) = &self.outside.torques else { return 0.0 };
        let blocks = &scheme.operators.blocks;
        let of_face = |block: usize, face: usize, lane: usize| match blocks.neighbours[block][face][lane] {
            Neighbour::Boundary(_) => torques[self.outside.first[block] as usize][face].0[lane],
            _ => 0.0,
        };
        let all = |&[block, lane]: &[usize; 2]| (0..FACES).map(move |face| [block, face, lane]);
        exact_sum(body.iter().flat_map(all).map(|[block, face, lane]| of_face(block, face, lane)))
    }

    fn sums_of(&self, scheme: &Scheme, before: &State, body: &[[usize; 2]]) -> Sums {
        let mut sums: [ExactSum; SUMS] = Default::default();
        for cell in body {
            let mut own = [0.0; SUMS];
            each_node(scheme, &[*cell], |place, a, x, mass, density| {
                let [[p0, u0], [p1, u1]] = [before, &self.next].map(|state| at_node(scheme, state, place, a));
                let at = [x[0] + u1[0], x[1] + u1[1]];
                let heavy = mass * density;
                let new = [
                    heavy,
                    heavy * at[0],
                    heavy * at[1],
                    heavy * (at[0] * at[0] + at[1] * at[1]),
                    mass * p1[0],
                    mass * p1[1],
                    mass * cross(at, p1),
                    mass * (cross(at, minus(p1, p0)) + cross(minus(u1, u0), p0)),
                ];
                own.iter_mut().zip(new).for_each(|(own, new)| *own += new);
            });
            sums.iter_mut().zip(own).for_each(|(sum, own)| sum.add(own));
        }
        let [mass, x, y, second, one, two, angular, change] = sums.map(|sum| sum.value());
        Sums { mass, first: [x, y], second, momentum: [one, two], angular, change }
    }

    /// p += rho0 turn E (x - centre).
    fn turn(&mut self, scheme: &Scheme, body: &[[usize; 2]], centre: [f64; 2], turn: f64) {
        let n = scheme.operators.nodes();
        let next = &mut self.next;
        each_node(scheme, body, |[block, lane], a, x, _, density| {
            let [_, u] = at_node(scheme, next, [block, lane], a);
            let from = [x[0] + u[0] - centre[0], x[1] + u[1] - centre[1]];
            let first = block * next.components * n + DEFORMATION * n + a;
            next.u[first].0[lane] -= density * turn * from[1];
            next.u[first + n].0[lane] += density * turn * from[0];
        });
    }
}

/// The energy that a share of these turns gives to the bodies, J/m.
fn energy_of(turns: &[Turn], share: f64) -> f64 {
    let of = |Turn { turn, inertia, spin, .. }: &Turn| share * turn * (spin + 0.5 * share * turn * inertia);
    exact_sum(turns.iter().map(of))
}

/// p and u at a node.
fn at_node(scheme: &Scheme, state: &State, [block, lane]: [usize; 2], a: usize) -> [[f64; 2]; 2] {
    let n = scheme.operators.nodes();
    let number = |component: usize| state.u[(block * state.components + component) * n + a].0[lane];
    [[number(DEFORMATION), number(DEFORMATION + 1)], [number(UNKNOWNS), number(UNKNOWNS + 1)]]
}

/// Calls `visit` with cell, node, X, w_a J_a and rho0.
fn each_node(scheme: &Scheme, body: &[[usize; 2]], mut visit: impl FnMut([usize; 2], usize, [f64; 2], f64, f64)) {
    let (operators, line) = (&scheme.operators, &scheme.operators.line);
    for &[block, lane] in body {
        let corners = operators.geometry.map_of(block, lane);
        let density = scheme.laws[operators.blocks.material[block]].density();
        for (a, mass) in operators.geometry.masses(line, block, lane).enumerate() {
            visit([block, lane], a, map::position(&corners, line.basis.node_2d(a)), mass, density);
        }
    }
}
