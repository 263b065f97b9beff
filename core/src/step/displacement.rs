//! The displacement where a state carries it: its rate, and its mean over a stage.

use super::Method;
use super::block::Block;
use super::volume;
use crate::lane::{F8, Lanes, Work};
use crate::state::{State, UNKNOWNS};
use crate::tensor::DEFORMATION;

/// du/dt = v at the nodes.
pub(super) struct DisplacementRate<'a> {
    /// Averages of F and v, [node][6].
    pub mean: &'a [F8],
    /// dU/dt, whose components behind the six of U these are.
    pub rate: &'a mut [F8],
    /// Number of nodes.
    pub nodes: usize,
}

impl Work for DisplacementRate<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { mean, rate, nodes: n } = self;
        for (a, mean) in mean.as_chunks::<UNKNOWNS>().0.iter().enumerate() {
            rate[UNKNOWNS * n + a] = mean[DEFORMATION];
            rate[(UNKNOWNS + 1) * n + a] = mean[DEFORMATION + 1];
        }
    }
}

/// u at the nodes, averaged as F and v are: of the stage by Runge-Kutta, u^n + dt/2 v by ADER, which is what the mean over the step is
/// to second order; 0 where the displacement is not carried. Less what is not held ([`State::unheld`]).
pub(super) struct MeanDisplacement<'a> {
    /// The block.
    pub block: Block<'a>,
    /// The state at t_n.
    pub state: &'a State,
    /// dU/dt of the block in earlier stages, [stage][component][node].
    pub before: &'a [F8],
    /// With v (in), and u (out).
    pub nodes: &'a mut volume::Arrays,
}

impl Work for MeanDisplacement<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { block, state, before, nodes } = self;
        let (n, dt) = (block.scheme.operators.nodes(), block.stage.dt);
        let displacement = &mut nodes.displacement.as_chunks_mut::<2>().0[..n];
        if !state.has_displacement() {
            displacement.fill([F8::ZERO; 2]);
            return;
        }
        let unheld = state.unheld.chunks_exact(2 * n).nth(block.number);
        let (stride, own) = (state.components * n, UNKNOWNS * n..(UNKNOWNS + 2) * n);
        let start = &block.unknowns(state)[own.clone()];
        match &block.scheme.method {
            Method::Ader { .. } => {
                let half = L::splat(0.5 * dt);
                for (a, (u, mean)) in displacement.iter_mut().zip(nodes.mean.as_chunks::<UNKNOWNS>().0).enumerate() {
                    for k in 0..2 {
                        half.mul_add(L::load(&mean[DEFORMATION + k]), L::load(&start[k * n + a])).store(&mut u[k]);
                    }
                }
            }
            Method::RungeKutta(_) => {
                for (a, u) in displacement.iter_mut().enumerate() {
                    *u = [start[a], start[n + a]];
                }
                for (stage, factor) in block.stage.row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
                    let (rate, factor) = (&before[stage * stride..][own.clone()], L::splat(factor * dt));
                    for (a, u) in displacement.iter_mut().enumerate() {
                        for k in 0..2 {
                            factor.mul_add(L::load(&rate[k * n + a]), L::load(&u[k])).store(&mut u[k]);
                        }
                    }
                }
            }
        }
        if let Some(unheld) = unheld {
            for (a, u) in displacement.iter_mut().enumerate() {
                for k in 0..2 {
                    (L::load(&u[k]) - L::load(&unheld[k * n + a])).store(&mut u[k]);
                }
            }
        }
    }
}
