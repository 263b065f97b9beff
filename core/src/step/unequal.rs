//! Traces of the displacement and their lift between cells of unequal size or direction ([`HeldShares`](crate::operators::HeldShares)). A
//! block of equal cells never comes here.

use crate::lane::{F8, Lanes, Work};
use crate::mesh::FACES;
use crate::operators::Line;
use crate::state::UNKNOWNS;
use crate::tensor::{AXES, DEFORMATION};

/// The traces of u of a block, once more: plain + s (held - plain).
pub(super) struct UnequalTraces<'a> {
    /// The 1D tables.
    pub line: &'a Line,
    /// s, by face.
    pub shares: &'a [F8; FACES],
    /// u at the nodes, [node][2].
    pub displacement: &'a [F8],
    /// Numbers of a trace.
    pub width: usize,
    /// [face][point][`width`]; u stands at 9 and 10.
    pub traces: &'a mut [F8],
}

impl Work for UnequalTraces<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let m = self.line.m;
        for (face, share) in self.shares.iter().enumerate() {
            let (ends, held, share) = (&self.line.ends[face % 2], &self.line.held[face % 2], L::load(share));
            let of_face = self.traces.chunks_exact_mut(self.width).skip(face * m).take(m);
            for (point, trace) in of_face.enumerate() {
                let (first, stride) = if face < 2 { (point, m) } else { (point * m, 1) };
                for k in 0..AXES {
                    let mut sum = L::zero();
                    for (i, (plain, held)) in ends.iter().zip(held).enumerate() {
                        let factor = share.mul_add(L::splat(held - plain), L::splat(*plain));
                        let u = L::load(&self.displacement[AXES * (first + stride * i) + k]);
                        sum = factor.mul_add(u, sum);
                    }
                    sum.store(&mut trace[9 + k]);
                }
            }
        }
    }
}

/// The lift by the same traces: of what is held the share s is lifted by the held traces, the rest by the plain ones.
pub(super) struct UnequalLift<'a> {
    /// Points of a face.
    pub points: usize,
    /// s, by face.
    pub shares: &'a [F8; FACES],
    /// [face][point][6]; the rest is added to the rows of p.
    pub lift: &'a mut [F8],
    /// [face][point][2]; the share is left.
    pub held: &'a mut [F8],
}

impl Work for UnequalLift<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let lifted = self.lift.as_chunks_mut::<UNKNOWNS>().0.iter_mut();
        let held = self.held.as_chunks_mut::<AXES>().0.iter_mut();
        for (point, (lifted, held)) in lifted.zip(held).take(FACES * self.points).enumerate() {
            let share = L::load(&self.shares[point / self.points]);
            for k in 0..AXES {
                let (all, row) = (L::load(&held[k]), &mut lifted[DEFORMATION + k]);
                let part = share * all;
                (L::load(row) + (all - part)).store(row);
                part.store(&mut held[k]);
            }
        }
    }
}
