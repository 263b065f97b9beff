//! The start of a Runge-Kutta stage: U = U^n + dt sum_j a_ij k_j at the nodes, and the law there.

use super::block::Block;
use super::block_work::LawWork;
use super::history::recall;
use super::sums::Terms;
use super::volume;
use crate::lane::{F8, Lanes, Work, store_array};
use crate::material::{Material, Past};
use crate::state::{State, UNKNOWNS};
use crate::tensor::DEFORMATION;

impl Block<'_> {
    /// F, v and P of the stage at the nodes, from the state at t_n and dU/dt in earlier stages, [stage][component][node].
    pub fn stage_at_nodes(&self, state: &State, before: &[F8], nodes: &mut volume::Arrays) {
        let (n, kernel) = (self.scheme.operators.nodes(), self.scheme.kernel);
        let stride = state.components * n;
        // The law needs the six of U alone.
        let start = &self.unknowns(state)[..UNKNOWNS * n];
        let factors = self.stage.row.iter().map(|a| a * self.stage.dt);
        let terms = Terms::new(factors, before, stride, UNKNOWNS * n);
        let (start, term) = match terms.few() {
            Some(term) => (start, term),
            None => {
                let out = &mut nodes.stage[..UNKNOWNS * n];
                kernel.run(Sum { terms, start, out });
                (&nodes.stage[..UNKNOWNS * n], None)
            }
        };
        let (mean, stress) = (&mut nodes.mean[..UNKNOWNS * n], &mut nodes.mean_stress[..DEFORMATION * n]);
        let (internal, dt) = (self.internal(state), self.stage.elapsed);
        self.law().block().stage(kernel, AtNodes { start, term, internal, dt, mean, stress });
    }
}

/// start + the terms of a sum over stages.
pub(super) struct Sum<'a> {
    /// The terms.
    pub terms: Terms<'a>,
    /// What they are added to.
    pub start: &'a [F8],
    /// The sum.
    pub out: &'a mut [F8],
}

impl Work for Sum<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.terms.add_to::<L>(self.start, self.out);
    }
}

/// A state at the nodes, and its Q.
pub(super) struct AtNodes<'a> {
    /// U^n, [component][node].
    pub start: &'a [F8],
    /// One term of the sum, factor and rate, as most tableaux have at each stage.
    pub term: Option<(f64, &'a [F8])>,
    /// Internal variables at t_n, [node][variable]; empty for a law without.
    pub internal: &'a [F8],
    /// From t_n to the stage, s.
    pub dt: f64,
    /// F and v, [node][6], out.
    pub mean: &'a mut [F8],
    /// P, [node][4], out.
    pub stress: &'a mut [F8],
}

impl LawWork for AtNodes<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes, M: Material>(mut self, law: M) {
        match self.term {
            None => self.with::<L, _, 0>(law, 0.0, &[]),
            Some((factor, rate)) => self.with::<L, _, 1>(law, factor, rate),
        }
    }
}

impl AtNodes<'_> {
    /// With so many TERMS, 0 or 1.
    #[inline(always)]
    fn with<L: Lanes, M: Material, const TERMS: usize>(&mut self, law: M, factor: f64, rate: &[F8]) {
        let (mean, stress) = (self.mean.as_chunks_mut::<UNKNOWNS>().0, self.stress.as_chunks_mut::<DEFORMATION>().0);
        let n = stress.len();
        let mean = &mut mean[..n];
        let (mut start, mut slope) = ([&[] as &[F8]; UNKNOWNS], [&[] as &[F8]; UNKNOWNS]);
        for k in 0..UNKNOWNS {
            start[k] = &self.start[k * n..][..n];
            slope[k] = if TERMS > 0 { &rate[k * n..][..n] } else { start[k] };
        }
        let (factor, inverse_density) = (L::splat(factor), L::splat(1.0 / law.density()));
        for a in 0..n {
            let mut u = [L::zero(); UNKNOWNS];
            for k in 0..UNKNOWNS {
                u[k] = L::load(&start[k][a]);
                if TERMS > 0 {
                    u[k] = factor.mul_add(L::load(&slope[k][a]), u[k]);
                }
            }
            let f = [u[0], u[1], u[2], u[3]];
            store_array([u[0], u[1], u[2], u[3], u[4] * inverse_density, u[5] * inverse_density], &mut mean[a]);
            let mut past = Past { history: recall::<L, M>(self.internal, a), dt: self.dt };
            store_array(law.stress(f, &mut past), &mut stress[a]);
        }
    }
}
