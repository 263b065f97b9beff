//! Traces of the displacement and their lift between cells of unequal size or direction
//! ([`HeldShares`](crate::operators::HeldShares)). A block of equal cells never comes here.

use crate::lane::{F8, Lanes, Work};
use crate::mesh::FACES;
use crate::operators::Line;
use crate::tensor::AXES;

/// The traces of u of a block, once more: those of degree N, less s times the part of the highest coefficient.
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
            let (ends, highest, share) = (&self.line.ends[face % 2], &self.line.highest[face % 2], L::load(share));
            let of_face = self.traces.chunks_exact_mut(self.width).skip(face * m).take(m);
            for (point, trace) in of_face.enumerate() {
                let (first, stride) = if face < 2 { (point, m) } else { (point * m, 1) };
                for k in 0..AXES {
                    let mut sum = L::zero();
                    for (i, (plain, highest)) in ends.iter().zip(highest).enumerate() {
                        let factor = L::splat(*plain) - share * L::splat(*highest);
                        let u = L::load(&self.displacement[AXES * (first + stride * i) + k]);
                        sum = factor.mul_add(u, sum);
                    }
                    sum.store(&mut trace[9 + k]);
                }
            }
        }
    }
}

/// What is held is lifted by the same traces; here all of it, which the [`Lift`](super::lift::Lift) of the block then leaves out.
pub(super) struct UnequalLift<'a> {
    /// The 1D tables.
    pub line: &'a Line,
    /// s, by face.
    pub shares: &'a [F8; FACES],
    /// [face][point][2].
    pub held: &'a [F8],
    /// J dp/dt, [component][node]: out of it goes what is lifted.
    pub rate: &'a mut [F8],
}

impl Work for UnequalLift<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (m, weights) = (self.line.m, &self.line.basis.weights);
        for (face, share) in self.shares.iter().enumerate() {
            let (ends, highest, share) = (&self.line.ends[face % 2], &self.line.highest[face % 2], L::load(share));
            for (point, held) in self.held.as_chunks::<AXES>().0.iter().skip(face * m).take(m).enumerate() {
                let (first, stride) = if face < 2 { (point, m) } else { (point * m, 1) };
                for (i, ((plain, highest), weight)) in ends.iter().zip(highest).zip(weights).enumerate() {
                    let factor = L::splat(plain / weight) - share * L::splat(highest / weight);
                    for (k, held) in held.iter().enumerate() {
                        let rate = &mut self.rate[k * m * m + first + stride * i];
                        (L::load(rate) - factor * L::load(held)).store(rate);
                    }
                }
            }
        }
    }
}
