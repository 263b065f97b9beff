//! One step of the method, as in section 5 of the paper.
//!
//! Per block of 8 cells: `begin` = G2P, predictor, time averages, volume term, traces; then, with the neighbours'
//! traces, `finish` = flux, lift, update, LCF. [`Scheme`] is read-only, [`State`] is all that changes, [`Work`] carries
//! nothing from step to step: threads, restart and regrid follow from that.

mod balance;
mod begin;
pub mod cfl;
mod curl;
mod dense;
mod energy;
mod finish;
mod flux;
pub mod phase;
mod predictor;
mod runge_kutta;
mod stage;
mod sums;
mod survey;
pub mod sweeps;
mod volume;

pub use balance::Balance;
pub use energy::Totals;
pub use phase::{Phase, Phases};
pub use runge_kutta::Tableau;
pub use survey::{Loss, Survey};
pub use sweeps::Sweeps;

use crate::basis::TimeBasis;
use crate::boundary::{Boundary, TimeNode};
use crate::lane::{F8, Kernel};
use crate::material::Law;
use crate::operators::Operators;
use crate::riemann::Flux;
use crate::source::Source;
use crate::state::State;
use rayon::iter::Either;
use rayon::prelude::*;
use std::sync::Mutex;

/// How time is integrated.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// Local space-time predictor and one corrector a step (15)-(21): ADER-DGMPM, and ADER-DGFEM at the nodes.
    Ader {
        /// The time nodes and their integration matrix.
        time: TimeBasis,
        /// The schedule of its Picard sweeps.
        sweeps: Sweeps,
    },
    /// Explicit Runge-Kutta: RK-DGFEM.
    RungeKutta(Tableau),
}

/// Everything that stays the same during a run.
pub struct Scheme {
    /// Matrices of mesh and cloud.
    pub operators: Operators,
    /// The laws, by number.
    pub laws: Vec<Law>,
    /// Time integration.
    pub method: Method,
    /// Interface flux between cells of one law.
    pub flux: Flux,
    /// Condition of each boundary group of the mesh.
    pub boundaries: Vec<Box<dyn Boundary>>,
    /// Sources of momentum.
    pub sources: Vec<Box<dyn Source>>,
    /// alpha of LCF, theta = 1 - exp(-alpha c dt / h); none where it is off. (The scene's alpha times N.)
    pub curl_rate: Option<f64>,
    /// The instruction set.
    pub kernel: Kernel,
}

/// Memory that a step writes and that nothing reads from an earlier step.
pub struct Work {
    /// The new state, once the step is done; the caller swaps it in if it is healthy.
    pub next: State,
    /// dU/dt of each stage, as `State::u`.
    rates: Vec<Vec<F8>>,
    /// Traces of all faces: [block][face][point][`volume::width` numbers].
    traces: Vec<F8>,
    /// The balance of the step, by block; none where nobody asks for it.
    balance: Option<Vec<balance::Sums>>,
    /// One a thread.
    scratch: Vec<Mutex<Scratch>>,
    /// The clock of the phases.
    rate: phase::Rate,
}

/// Arrays of one block, and the seconds that its thread spent on each phase.
#[derive(Default)]
pub(crate) struct Scratch {
    pub points: predictor::Arrays,
    pub nodes: volume::Arrays,
    pub phases: phase::Ticks,
}

impl Work {
    /// Memory for steps of `scheme` on states like `state`, for the current number of threads.
    pub fn new(scheme: &Scheme, state: &State) -> Self {
        let operators = &scheme.operators;
        let points =
            operators.points.as_ref().map_or(0, |p| p.first.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0));
        let scratch = || {
            Mutex::new(Scratch {
                points: predictor::Arrays::new(points, operators.line.m, &scheme.method, !scheme.sources.is_empty()),
                nodes: volume::Arrays::new(operators.line.m, state.components),
                phases: phase::Ticks::default(),
            })
        };
        Self {
            next: state.clone(),
            rates: vec![vec![F8::ZERO; state.u.len()]; scheme.stages()],
            traces: scheme.room_for_traces(false),
            balance: None,
            scratch: (0..rayon::current_num_threads().max(1)).map(|_| scratch()).collect(),
            rate: phase::Rate::start(),
        }
    }

    /// Seconds per phase, summed over threads, since the last call.
    pub fn take_phases(&mut self) -> Phases {
        let (mut sum, rate) = (Phases::default(), self.rate.measure());
        for scratch in &mut self.scratch {
            let scratch = scratch.get_mut().unwrap_or_else(|poisoned| poisoned.into_inner());
            sum.add(&std::mem::take(&mut scratch.phases).seconds(rate));
        }
        sum
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let numbers = self.next.u.len() + self.traces.len() + self.rates.iter().map(Vec::len).sum::<usize>();
        numbers * size_of::<F8>() + self.balance.as_ref().map_or(0, |sums| size_of_val(&sums[..]))
    }
}

/// A stage of a step; ADER has one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage<'a> {
    /// Its number, from 0.
    pub number: usize,
    /// The time nodes over which data that depends on time is averaged.
    pub times: &'a [TimeNode],
    /// Step, s.
    pub dt: f64,
}

/// Runs `body` with the scratch of the current thread. Uncontended: a thread holds one block at a time.
pub(crate) fn with_scratch<R>(scratch: &[Mutex<Scratch>], body: impl FnOnce(&mut Scratch) -> R) -> R {
    let thread = rayon::current_thread_index().unwrap_or(0) % scratch.len();
    let mut guard = scratch[thread].lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    body(&mut guard)
}

/// The balance of each block, or for each block none.
fn sums(
    balance: &mut Option<Vec<balance::Sums>>,
    blocks: usize,
) -> impl IndexedParallelIterator<Item = Option<&mut balance::Sums>> {
    match balance {
        Some(sums) => Either::Left(sums.par_iter_mut().map(Some)),
        None => Either::Right((0..blocks).into_par_iter().map(|_| None)),
    }
}

impl Method {
    /// ADER of degree N_T in time for degree N in space, with the sweeps of [`Sweeps::of_degree`].
    pub fn ader(degree: usize, time_degree: usize) -> Self {
        let time = TimeBasis::new(time_degree);
        Method::Ader { sweeps: Sweeps::of_degree(degree, &time), time }
    }
}

impl Scheme {
    /// Advances `state` by `dt` into `work.next`. `survey` is that of `state`.
    pub fn step(&self, state: &State, dt: f64, survey: &Survey, work: &mut Work) {
        match &self.method {
            Method::Ader { time, .. } => {
                let node = |(tau, weight): (&f64, &f64)| TimeNode { time: state.time + tau * dt, weight: *weight };
                // At most 7 nodes: on the stack, no allocation in a step.
                let mut times = [TimeNode { time: 0.0, weight: 0.0 }; 8];
                times.iter_mut().zip(time.tau.iter().zip(&time.weights)).for_each(|(t, n)| *t = node(n));
                let times = &times[..time.len()];
                let stage = Stage { number: 0, times, dt };
                self.stage(&stage, state, survey, work);
            }
            Method::RungeKutta(tableau) => {
                for number in 0..tableau.stages() {
                    let times = [TimeNode { time: state.time + tableau.c[number] * dt, weight: 1.0 }];
                    let stage = Stage { number, times: &times, dt };
                    self.stage(&stage, state, survey, work);
                }
            }
        }
        work.next.time = state.time + dt;
        work.next.step = state.step + 1;
    }

    /// `begin` and `finish` of every block; the bits do not depend on the order.
    fn stage(&self, stage: &Stage, state: &State, survey: &Survey, work: &mut Work) {
        if rayon::current_num_threads() == 1 {
            self.pipelined(stage, state, survey, work);
        } else {
            self.begin(stage, state, work);
            self.finish(stage, state, survey, work);
        }
    }

    /// One thread: `finish` follows `begin` as closely as neighbours allow, while traces and rates are still in the cache.
    fn pipelined(&self, stage: &Stage, state: &State, survey: &Survey, work: &mut Work) {
        let blocks = &self.operators.blocks;
        let (stride, width) = (state.components * self.operators.nodes(), work.traces.len() / blocks.len().max(1));
        let (before, now) = work.rates.split_at_mut(stage.number);
        let (before, rates, next) = (&*before, &mut now[0], &mut work.next.u);
        let (traces, balance) = (&mut work.traces, &mut work.balance);
        let mut sequence = blocks.sequence.iter().copied().peekable();
        with_scratch(&work.scratch, |scratch| {
            for block in 0..blocks.len() {
                let rate = &mut rates[block * stride..(block + 1) * stride];
                let sums = balance.as_mut().map(|sums| &mut sums[block]);
                let traces_of = &mut traces[block * width..(block + 1) * width];
                let scratch = &mut *scratch;
                begin::Block { scheme: self, stage, block, state, before, rate, traces: traces_of, sums, scratch }
                    .run();
                while let Some(ready) = sequence.next_if(|ready| ready.after <= block) {
                    let at = ready.block * stride..(ready.block + 1) * stride;
                    let block = finish::Block {
                        scheme: self,
                        stage,
                        block: ready.block,
                        state,
                        survey,
                        before,
                        rate: &mut rates[at.clone()],
                        traces,
                        next: &mut next[at],
                        sums: balance.as_mut().map(|sums| &mut sums[ready.block]),
                        scratch: &mut *scratch,
                    };
                    block.run();
                }
            }
        });
    }

    /// Volume term and traces of every block.
    fn begin(&self, stage: &Stage, state: &State, work: &mut Work) {
        let stride = state.components * self.operators.nodes();
        let blocks = self.operators.blocks.len();
        let traces = work.traces.len() / blocks.max(1);
        let (before, now) = work.rates.split_at_mut(stage.number);
        let (before, scratch) = (&*before, &work.scratch);
        let outputs = now[0].par_chunks_mut(stride).zip(work.traces.par_chunks_mut(traces.max(1)));
        outputs.zip(sums(&mut work.balance, blocks)).enumerate().for_each(|(block, ((rate, traces), sums))| {
            with_scratch(scratch, |scratch| {
                begin::Block { scheme: self, stage, block, state, before, rate, traces, sums, scratch }.run()
            })
        });
    }

    /// Fluxes, lift, and after the last stage the update, of every block.
    fn finish(&self, stage: &Stage, state: &State, survey: &Survey, work: &mut Work) {
        let stride = state.components * self.operators.nodes();
        let (before, now) = work.rates.split_at_mut(stage.number);
        let (before, scratch, traces) = (&*before, &work.scratch, &work.traces[..]);
        let outputs = now[0].par_chunks_mut(stride).zip(work.next.u.par_chunks_mut(stride));
        let sums = sums(&mut work.balance, self.operators.blocks.len());
        outputs.zip(sums).enumerate().for_each(|(block, ((rate, next), sums))| {
            with_scratch(scratch, |scratch| {
                let block = finish::Block {
                    scheme: self,
                    stage,
                    block,
                    state,
                    survey,
                    before,
                    rate,
                    traces,
                    next,
                    sums,
                    scratch,
                };
                block.run()
            })
        });
    }

    /// Memory for the traces of all faces.
    fn room_for_traces(&self, metered: bool) -> Vec<F8> {
        vec![F8::ZERO; self.trace_numbers(metered)]
    }

    fn trace_numbers(&self, metered: bool) -> usize {
        let points = 4 * self.operators.blocks.len() * self.operators.line.m;
        points * volume::width(self.flux.has_shear(), metered)
    }

    /// Bytes of the traces of all faces, without the balance.
    pub fn trace_bytes(&self) -> usize {
        self.trace_numbers(false) * size_of::<F8>()
    }

    /// What the rate of a stage counts in U^(n+1) = U^n + dt sum_s b_s k_s; 1 for ADER.
    fn weight(&self, stage: usize) -> f64 {
        match &self.method {
            Method::Ader { .. } => 1.0,
            Method::RungeKutta(tableau) => tableau.b[stage],
        }
    }

    /// Number of stages of a step (1 for ADER).
    pub fn stages(&self) -> usize {
        match &self.method {
            Method::Ader { .. } => 1,
            Method::RungeKutta(tableau) => tableau.stages(),
        }
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod sweep_tests;
