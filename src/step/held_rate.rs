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
use super::volume::row;
use crate::boundary::GivesBack;
use crate::lane::{F8, LANES, Lanes, Work, load_array, store_array};
use crate::mesh::FACES;
use crate::operators::{BlockMetric, Line, MOST_FACE_POINTS, Neighbour, determinant, with_nodes};
use crate::riemann::{creep, tangent};
use crate::state::State;
use crate::tensor::{AXES, DEFORMATION, dot};

/// l k R a at the points of the faces, N/m.
type Pulls = [[[F8; AXES]; MOST_FACE_POINTS]; FACES];

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
    /// What pulls along walls in, of all springs out.
    pulls: &'a mut Pulls,
    /// N/m^3, [component][node]: rows of p; those of F are left.
    rate: &'a mut [F8],
}

impl<const M: usize> Work for HeldRate<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { line, metric, u, creep, moduli, pulls, rate } = self;
        let (rotation, creep) = (mean_rotation::<L, M>(u), creep.as_chunks::<AXES>().0);
        for face in 0..FACES {
            let modulus = L::load(&moduli[face]);
            for point in 0..M {
                let a = creep::turned(rotation, load_array::<L, AXES>(&creep[face * M + point]));
                let pull = &mut pulls[face][point];
                let [one, two] = load_array::<L, AXES>(&pull[..]);
                store_array([modulus.mul_add(a[0], one), modulus.mul_add(a[1], two)], pull);
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
fn lift<L: Lanes, const M: usize>(line: &Line, metric: BlockMetric, pulls: &Pulls, rate: &mut [F8]) {
    let ends = [row::<M>(&line.lift[0]), row::<M>(&line.lift[1])];
    for i in 0..M {
        for j in 0..M {
            let [one, two] = metric.at_node::<L>(line, i, j);
            let inverse = L::splat(1.0) / determinant(one, two);
            for k in 0..AXES {
                let mut sum = L::splat(ends[0][i]) * L::load(&pulls[0][j][k]);
                sum = L::splat(ends[1][i]).mul_add(L::load(&pulls[1][j][k]), sum);
                sum = L::splat(ends[0][j]).mul_add(L::load(&pulls[2][i][k]), sum);
                sum = L::splat(ends[1][j]).mul_add(L::load(&pulls[3][i][k]), sum);
                (sum * inverse).store(&mut rate[(DEFORMATION + k) * M * M + i * M + j]);
            }
        }
    }
}

impl Block<'_> {
    /// dp/dt at the nodes by the springs of the faces, N/m^3, into the rows of p of `rate`, [component][node].
    pub(super) fn held_rate(&self, state: &State, rate: &mut [F8]) {
        let (line, metric, u) = (&self.scheme.operators.line, self.metric(), self.unknowns(state));
        let creep = self.scheme.creep_of(state, self.number);
        let own = self.spring_between(self.material());
        let moduli = &[0, 1, 2, 3].map(|face| self.held_modulus(face, own));
        let pulls = &mut [[[F8::ZERO; AXES]; MOST_FACE_POINTS]; FACES];
        self.pull_along_walls(creep, pulls);
        with_nodes!(line.m, M => self.scheme.kernel.run(HeldRate::<'_, M> { line, metric, u, creep, moduli, pulls, rate }));
    }

    /// What a cell takes of l k of a face, Pa: half of `own` between two cells of one law, all of it at a side that gives back all; walls are
    /// in [`Block::pull_along_walls`].
    fn held_modulus(&self, face: usize, own: f64) -> F8 {
        let (scheme, law, mut out) = (self.scheme, self.material(), F8::ZERO);
        for (lane, neighbour) in scheme.operators.blocks.neighbours[self.number][face].iter().enumerate() {
            out.0[lane] = match neighbour {
                Neighbour::Cell(_) => 0.5 * own,
                Neighbour::Interface(_, there) => 0.5 * self.spring_between(*there),
                Neighbour::Boundary(group) if scheme.boundaries[*group].gives_back() == GivesBack::All => {
                    scheme.spring_at(*group, law)
                }
                Neighbour::Boundary(_) | Neighbour::Padding => 0.0,
            };
        }
        out
    }

    /// The faces that give back along themselves alone, with half of a spring.
    fn pull_along_walls(&self, creep: &[F8], pulls: &mut Pulls) {
        let m = self.scheme.operators.line.m;
        for (face, pulls) in pulls.iter_mut().enumerate() {
            for lane in 0..LANES {
                let neighbour = &self.scheme.operators.blocks.neighbours[self.number][face][lane];
                let Neighbour::Boundary(group) = neighbour else { continue };
                if self.scheme.boundaries[*group].gives_back() != GivesBack::Along {
                    continue;
                }
                let modulus = 0.5 * self.scheme.spring_at(*group, self.material());
                for (point, pull) in pulls.iter_mut().enumerate().take(m) {
                    let along = tangent(self.metric().at_face_of(lane, face, point).0);
                    let a = [0, 1].map(|k| creep[AXES * (face * m + point) + k].0[lane]);
                    let size = modulus * dot(a, along);
                    (0..AXES).for_each(|k| pull[k].0[lane] = size * along[k]);
                }
            }
        }
    }
}
