//! Traces of the displacement and their lift between cells that are not equal
//! ([`HeldTraces`](crate::operators::HeldTraces)). A block of equal cells never comes here.

use crate::lane::{F8, Lanes, Work};
use crate::mesh::FACES;
use crate::operators::Line;
use crate::tensor::AXES;

/// The traces of u of a block, once more.
pub(super) struct UnequalTraces<'a> {
    /// The 1D tables.
    pub line: &'a Line,
    /// Their factors, [face][point][node].
    pub factors: &'a [F8],
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
        let displacement = self.displacement.as_chunks::<AXES>().0;
        let traces = self.traces.chunks_exact_mut(self.width).take(FACES * m);
        for (trace, factors) in traces.zip(self.factors.chunks_exact(m * m)) {
            let mut sum = [L::zero(); AXES];
            for (factor, u) in factors.iter().zip(displacement) {
                let factor = L::load(factor);
                for k in 0..AXES {
                    sum[k] = factor.mul_add(L::load(&u[k]), sum[k]);
                }
            }
            for (sum, u) in sum.iter().zip(&mut trace[9..]) {
                sum.store(u);
            }
        }
    }
}

/// What is held is lifted by the same traces; here all of it, which the [`Lift`](super::lift::Lift) of the block then leaves out.
pub(super) struct UnequalLift<'a> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The factors of the traces, [face][point][node].
    pub factors: &'a [F8],
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
        let n = m * m;
        let held = &self.held.as_chunks::<AXES>().0[..FACES * m];
        for a in 0..n {
            let mut sum = [L::zero(); AXES];
            for (point, held) in held.iter().enumerate() {
                let factor = L::load(&self.factors[point * n + a]) * L::splat(weights[point % m]);
                for k in 0..AXES {
                    sum[k] = factor.mul_add(L::load(&held[k]), sum[k]);
                }
            }
            let inverse = L::splat(-1.0 / (weights[a / m] * weights[a % m]));
            for (k, sum) in sum.iter().enumerate() {
                let rate = &mut self.rate[k * n + a];
                sum.mul_add(inverse, L::load(rate)).store(rate);
            }
        }
    }
}
