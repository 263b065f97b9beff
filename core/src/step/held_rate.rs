//! What the springs of the faces do to the momentum of a cell, for its predictor.
//!
//! The predictor of ADER sees no neighbours. To first order in dt a step follows G - (dt/2) G B for the operator G of the body, where B are
//! the faces alone: what faces undo of the motion of a cell drives that motion, in proportion to dt. Jumps that pass decay by the faces
//! themselves. Jumps that springs hold stay, and a body that spins or swings would gain energy by them. At rest a spring holds `[t]` = k R a
//! ([`crate::riemann::creep`]), of which each of two cells takes a half. So the predictor knows, all along the step, the rate
//!
//! ```text
//! (dp/dt)_a = 1/(w_a J_a) sum over faces f, points k of Phi_a(x_fk) w_k l_f (k R a)_fk / 2
//! ```
//!
//! with R of the mean F of the cell. The corrector takes the faces as they are, and nothing of this rate.

use super::block::Block;
use super::lift::at_node;
use super::springs::Held;
use super::volume::row;
use crate::boundary::GivesBack;
use crate::lane::{F8, Lanes, Work, load_array, store_array};
use crate::mesh::FACES;
use crate::operators::{BlockMetric, Line, MOST_FACE_POINTS, Neighbour, determinant, with_nodes};
use crate::riemann::{creep, tangent};
use crate::state::State;
use crate::tensor::{AXES, DEFORMATION, dot};

/// l k R a at the points of the faces, N/m, [face][point][2] without gaps between the faces.
type Pulls = [[F8; AXES]; FACES * MOST_FACE_POINTS];

/// dp/dt at the nodes of a block by the springs of its faces.
struct HeldRate<'a, const M: usize> {
    line: &'a Line,
    metric: BlockMetric<'a>,
    /// The unknowns at t_n, [component][node].
    u: &'a [F8],
    /// The creep of the faces, [face][point][2], m.
    creep: &'a [F8],
    /// What a cell takes of l k of a face, Pa.
    moduli: &'a [F8; FACES],
    /// What pulls along walls; none where the block has no wall.
    walls: Option<&'a Pulls>,
    /// N/m^3, [2][node].
    rate: &'a mut [F8],
}

impl<const M: usize> Work for HeldRate<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { line, metric, u, creep, moduli, walls, rate } = self;
        let (rotation, creep) = (mean_rotation::<L, M>(u), &creep.as_chunks::<AXES>().0[..FACES * M]);
        let mut pulls = [[[F8::ZERO; AXES]; M]; FACES];
        for (face, pulls) in pulls.iter_mut().enumerate() {
            let modulus = L::load(&moduli[face]);
            for (point, pull) in pulls.iter_mut().enumerate() {
                let a = creep::turned(rotation, load_array::<L, AXES>(&creep[face * M + point]));
                store_array([modulus * a[0], modulus * a[1]], pull);
            }
        }
        let pulls = pulls.as_flattened_mut();
        if let Some(walls) = walls {
            for (pull, wall) in pulls.iter_mut().zip(walls) {
                for (pull, wall) in pull.iter_mut().zip(wall) {
                    (L::load(pull) + L::load(wall)).store(pull);
                }
            }
        }
        lift::<L, M>(line, metric, pulls, rate);
    }
}

/// R of the sum of F over the nodes.
#[inline(always)]
fn mean_rotation<L: Lanes, const M: usize>(u: &[F8]) -> [L; 2] {
    let (n, mut sum) = (M * M, [L::zero(); DEFORMATION]);
    for (k, sum) in sum.iter_mut().enumerate() {
        for f in &u[n * k..n * (k + 1)] {
            *sum = *sum + L::load(f);
        }
    }
    creep::rotation(sum)
}

/// From the face points to the nodes, as [`super::lift::Lift`] does.
#[inline(always)]
fn lift<L: Lanes, const M: usize>(line: &Line, metric: BlockMetric, pulls: &[[F8; AXES]], rate: &mut [F8]) {
    let ends = [row::<M>(&line.lift[0]), row::<M>(&line.lift[1])];
    let (pulls, rate) = (&pulls[..FACES * M], &mut rate[..AXES * M * M]);
    for i in 0..M {
        for j in 0..M {
            let [one, two] = metric.at_node::<L>(line, i, j);
            let inverse = L::splat(1.0) / determinant(one, two);
            for k in 0..AXES {
                (at_node::<L, AXES, M>(pulls, &ends, [i, j], k) * inverse).store(&mut rate[k * M * M + i * M + j]);
            }
        }
    }
}

impl Block<'_> {
    /// dp/dt at the nodes by the springs of the faces, N/m^3, into `rate`, [2][node].
    pub(super) fn held_rate(&self, state: &State, rate: &mut [F8]) {
        let (line, metric, u) = (&self.scheme.operators.line, self.metric(), self.unknowns(state));
        let creep = self.scheme.creep_of(state, self.number);
        let Held { moduli, has_walls } = self.scheme.held_of(self.number);
        let walls = has_walls.then(|| self.pull_along_walls(creep));
        let walls = walls.as_ref();
        with_nodes!(line.m, M => self.scheme.kernel.run(HeldRate::<'_, M> { line, metric, u, creep, moduli, walls, rate }));
    }

    /// The faces that give back along themselves alone, with half of a spring.
    fn pull_along_walls(&self, creep: &[F8]) -> Pulls {
        let (m, scheme, mut out) = (self.scheme.operators.line.m, self.scheme, [[F8::ZERO; AXES]; _]);
        for (face, neighbours) in scheme.operators.blocks.neighbours[self.number].iter().enumerate() {
            for (lane, neighbour) in neighbours.iter().enumerate() {
                let Neighbour::Boundary(group) = neighbour else { continue };
                if scheme.gives_back(*group) != GivesBack::Along {
                    continue;
                }
                let modulus = 0.5 * scheme.spring_at(*group, self.material());
                for (at, pull) in out.iter_mut().enumerate().take(m * (face + 1)).skip(m * face) {
                    let along = tangent(self.metric().at_face_of(lane, face, at - m * face).0);
                    let a = [0, 1].map(|k| creep[AXES * at + k].0[lane]);
                    let size = modulus * dot(a, along);
                    (0..AXES).for_each(|k| pull[k].0[lane] = size * along[k]);
                }
            }
        }
        out
    }
}
