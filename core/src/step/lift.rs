//! The lift (14): from the face points to the nodes of a block.

use super::volume::row;
use crate::lane::{F8, Lanes, Work};
use crate::mesh::FACES;
use crate::operators::{Cofactors, Line, NodeMetric, determinant};
use crate::state::UNKNOWNS;
use crate::tensor::{AXES, DEFORMATION};

/// The sum over the faces of what is lifted to node (i, j), number k of W.
#[inline(always)]
pub(super) fn at_node<L: Lanes, const W: usize, const M: usize>(
    lift: &[[F8; W]],
    ends: &[[f64; M]; 2],
    [i, j]: [usize; 2],
    k: usize,
) -> L {
    let mut sum = L::splat(ends[0][i]) * L::load(&lift[j][k]);
    sum = L::splat(ends[1][i]).mul_add(L::load(&lift[M + j][k]), sum);
    sum = L::splat(ends[0][j]).mul_add(L::load(&lift[2 * M + i][k]), sum);
    L::splat(ends[1][j]).mul_add(L::load(&lift[3 * M + i][k]), sum)
}

/// dU_a/dt = (J dU_a/dt - Phi_a(x_fk) w_k lifted_fk / w_a) / J_a; w_k and one factor of w_a are the same number.
pub(super) struct Lift<'a, const M: usize, G> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The block.
    pub metric: G,
    /// [face][point][6].
    pub lift: &'a [F8],
    /// [face][point][2], by the traces of what is held; none where the flux holds nothing.
    pub held: Option<&'a [F8]>,
    /// J dU/dt without the faces in, dU/dt out.
    pub rate: &'a mut [F8],
}

impl<const M: usize, G: NodeMetric> Work for Lift<'_, M, G> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = M * M;
        let ends = [row::<M>(&self.line.lift[0]), row::<M>(&self.line.lift[1])];
        let lift = &self.lift.as_chunks::<UNKNOWNS>().0[..FACES * M];
        let cofactors = self.metric.cofactors::<L, M>(self.line);
        let mut inverse = [[L::zero(); M]; M];
        for (i, inverse) in inverse.iter_mut().enumerate() {
            for (j, inverse) in inverse.iter_mut().enumerate() {
                *inverse = L::splat(1.0) / determinant(cofactors.one(i, j), cofactors.two(i, j));
            }
        }
        for (k, rate) in self.rate.chunks_exact_mut(n).enumerate().take(UNKNOWNS) {
            for (i, inverse) in inverse.iter().enumerate() {
                for (j, inverse) in inverse.iter().enumerate() {
                    let a = i * M + j;
                    let sum = at_node::<L, UNKNOWNS, M>(lift, &ends, [i, j], k);
                    ((L::load(&rate[a]) - sum) * *inverse).store(&mut rate[a]);
                }
            }
        }
        let Some(held) = self.held else { return };
        let ends = [row::<M>(&self.line.held_lift[0]), row::<M>(&self.line.held_lift[1])];
        let held = &held.as_chunks::<AXES>().0[..FACES * M];
        for (k, rate) in self.rate[DEFORMATION * n..UNKNOWNS * n].chunks_exact_mut(n).enumerate() {
            for (i, inverse) in inverse.iter().enumerate() {
                for (j, inverse) in inverse.iter().enumerate() {
                    let a = i * M + j;
                    let sum = at_node::<L, AXES, M>(held, &ends, [i, j], k);
                    (-*inverse).mul_add(sum, L::load(&rate[a])).store(&mut rate[a]);
                }
            }
        }
    }
}
