//! Corrections: what changes the new state after the pass over all blocks, as limiters and dampings do.
//!
//! A correction sees the whole new state, as it is before the correction has changed any block; what it makes of a block does
//! not depend on the order of the blocks or on the number of threads. The blocks that it changed are surveyed anew. A scheme
//! without corrections does no sweep and holds no memory for them.

use super::balance::BlockBalance;
use super::block_energy::BlockEnergy;
use super::survey::{Examine, History};
use super::worst::Worst;
use super::{Scheme, Scratch, Work, with_scratch};
use crate::lane::F8;
use crate::state::State;
use rayon::prelude::*;
use std::sync::Mutex;

/// Changes some blocks of a new state.
pub trait Correction: Send + Sync {
    /// The name, as printed.
    fn name(&self) -> &str;

    /// Whether it acts after each stage of Runge-Kutta, too: on U = U^n + dt sum_j a_ij k_j before the rates of the stage are found
    /// from it. (The stages then wait for each other on all blocks, which is slower. What is changed in a stage does not enter
    /// the sums of later stages, only their rates.)
    fn after_stages(&self) -> bool {
        false
    }

    /// Whether it has to change a block.
    fn applies(&self, made: &Made, block: usize) -> bool;

    /// Changes a block to which it applies. What the law has made of the internal variables stays unless it is changed here.
    fn correct(&self, made: &Made, block: &mut Corrected);
}

/// A state that a step, or a stage of it, has made of all blocks.
#[derive(Clone, Copy)]
pub struct Made<'a> {
    /// The scheme, with mesh, neighbours, laws.
    pub scheme: &'a Scheme,
    /// The state before the step.
    pub before: &'a State,
    /// The state before this correction.
    pub state: &'a State,
    /// Step, s.
    pub dt: f64,
    /// The stage of Runge-Kutta that begins with the state; none at the end of the step.
    pub stage: Option<usize>,
}

impl Made<'_> {
    /// The unknowns of a block, `[component][node]`.
    pub fn unknowns(&self, block: usize) -> &[F8] {
        let stride = self.state.components * self.scheme.operators.nodes();
        &self.state.u[stride * block..stride * (block + 1)]
    }

    /// The internal variables of a block, `[point][variable]`.
    pub fn internal(&self, block: usize) -> &[F8] {
        self.scheme.histories.of(&self.state.internal, block)
    }
}

/// A block that a correction changes: the numbers of [`Made`] to begin with.
pub struct Corrected<'a> {
    /// Its number.
    pub number: usize,
    /// Its unknowns, `[component][node]`.
    pub u: &'a mut [F8],
    /// Its internal variables, `[point][variable]`.
    pub internal: &'a mut [F8],
}

/// Memory of the corrections of a scheme that has some.
pub(super) struct Memory {
    /// The worst of each block by itself.
    pub worst: Vec<Worst>,
    /// The state that a stage of Runge-Kutta begins with; none where no correction acts on stages.
    pub stage: Option<State>,
    /// Energy that corrections took in the last step, J/m; 0 where the balance is off.
    pub loss: f64,
    /// Changed blocks.
    pub blocks: Blocks,
}

/// Blocks that corrections change, made beside the state.
pub(super) struct Blocks {
    /// Whether a correction has changed the block since the step began.
    changed: Vec<bool>,
    /// Whether the correction under way changes the block.
    applies: Vec<bool>,
    /// What it makes of those blocks.
    u: Vec<F8>,
    internal: Vec<F8>,
}

impl Memory {
    /// For a scheme and states like `state`; none where there is no correction.
    pub fn new(scheme: &Scheme, state: &State) -> Option<Box<Self>> {
        if scheme.corrections.is_empty() {
            return None;
        }
        let count = scheme.operators.blocks.len();
        let (u, internal) = (state.u.clone(), state.internal.clone());
        Some(Box::new(Self {
            worst: vec![Worst::NONE; count],
            stage: scheme.corrects_stages().then(|| state.clone()),
            loss: 0.0,
            blocks: Blocks { changed: vec![false; count], applies: vec![false; count], u, internal },
        }))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let Blocks { changed, applies, u, internal } = &self.blocks;
        let stage = self.stage.as_ref().map_or(0, |stage| stage.u.len() + stage.internal.len());
        let numbers = u.len() + internal.len() + stage;
        numbers * size_of::<F8>() + size_of_val(&self.worst[..]) + changed.len() + applies.len()
    }
}

impl Scheme {
    /// Whether a correction acts on the stages of Runge-Kutta.
    pub(super) fn corrects_stages(&self) -> bool {
        self.stages() > 1 && self.corrections.iter().any(|correction| correction.after_stages())
    }

    /// Lets all corrections act on what a step of `dt` has made of `before`, and surveys the changed blocks anew.
    #[inline(never)]
    pub(super) fn correct(&self, before: &State, dt: f64, work: &mut Work) {
        let Work { next, speed, balance, corrections, scratch, .. } = work;
        let Some(Memory { worst, blocks, loss, .. }) = corrections.as_deref_mut() else { return };
        blocks.changed.fill(false);
        for correction in &self.corrections {
            self.correct_by(&**correction, (before, next), (dt, None), blocks);
        }
        let (changed, state) = (&blocks.changed, &*next);
        let stride = state.components * self.operators.nodes();
        let all = worst.par_iter_mut().zip(speed).zip(changed).enumerate();
        all.filter(|(_, (_, changed))| **changed).for_each(|(block, ((worst, speed), _))| {
            with_scratch(scratch, |scratch| {
                *worst = Worst::NONE;
                let u = &state.u[stride * block..stride * (block + 1)];
                let history = History::Now(self.histories.of(&state.internal, block));
                let law = &self.laws[self.operators.blocks.material[block]];
                law.block().examine(self.kernel, Examine { scheme: self, block, u, history, scratch, speed, worst });
            });
        });
        *loss = balance.as_mut().map_or(0.0, |balance| self.renew_energy(state, changed, balance, scratch));
    }

    /// Renews the energy of changed blocks; what they lost, cells in a fixed order.
    fn renew_energy(
        &self,
        state: &State,
        changed: &[bool],
        balance: &mut [BlockBalance],
        scratch: &[Mutex<Scratch>],
    ) -> f64 {
        let stride = state.components * self.operators.nodes();
        let mut loss = 0.0;
        for (block, balance) in balance.iter_mut().enumerate().filter(|(block, _)| changed[*block]) {
            let u = &state.u[stride * block..stride * (block + 1)];
            let internal = self.histories.of(&state.internal, block);
            let energy = with_scratch(scratch, |scratch| {
                BlockEnergy { scheme: self, block, u, internal, dt: 0.0, scratch }.find()
            });
            for lane in 0..self.operators.blocks.count[block] {
                loss += balance.energy.0[lane] - energy.0[lane];
            }
            balance.energy = energy;
        }
        loss
    }

    /// Lets those corrections that act on stages act on the state that a stage begins with.
    #[inline(never)]
    pub(super) fn correct_stage(
        &self,
        (before, start): (&State, &mut State),
        (dt, stage): (f64, usize),
        blocks: &mut Blocks,
    ) {
        for correction in self.corrections.iter().filter(|correction| correction.after_stages()) {
            self.correct_by(&**correction, (before, start), (dt, Some(stage)), blocks);
        }
    }

    /// Lets one correction act: all changed blocks are made beside the state, and then copied into it.
    fn correct_by(
        &self,
        correction: &dyn Correction,
        (before, next): (&State, &mut State),
        (dt, stage): (f64, Option<usize>),
        blocks: &mut Blocks,
    ) {
        let Blocks { changed, applies, u, internal } = blocks;
        let made = Made { scheme: self, before, state: next, dt, stage };
        Part { first: 0, applies, u, internal }.correct(correction, made);
        let stride = next.components * self.operators.nodes();
        for block in (0..applies.len()).filter(|block| applies[*block]) {
            changed[block] = true;
            let (numbers, history) = (stride * block..stride * (block + 1), self.histories.range(block));
            next.u[numbers.clone()].copy_from_slice(&u[numbers]);
            next.internal[history.clone()].copy_from_slice(&internal[history]);
        }
    }
}

/// The memory of some blocks that follow each other.
struct Part<'a> {
    first: usize,
    applies: &'a mut [bool],
    u: &'a mut [F8],
    internal: &'a mut [F8],
}

/// So many blocks are corrected by one thread at least.
const PART: usize = 16;

impl Part<'_> {
    /// Corrects the blocks to which a correction applies: halves until few are left, since nothing may be allocated.
    fn correct(self, correction: &dyn Correction, made: Made) {
        let Self { first, applies, u, internal } = self;
        let start = made.scheme.histories.range(first).start;
        if applies.len() > PART {
            let half = applies.len() / 2;
            let (applies, applies2) = applies.split_at_mut(half);
            let (u, u2) = u.split_at_mut(half * made.state.components * made.scheme.operators.nodes());
            let (internal, internal2) = internal.split_at_mut(made.scheme.histories.range(first + half).start - start);
            let left = Part { first, applies, u, internal };
            let right = Part { first: first + half, applies: applies2, u: u2, internal: internal2 };
            rayon::join(|| left.correct(correction, made), || right.correct(correction, made));
            return;
        }
        let stride = made.state.components * made.scheme.operators.nodes();
        for (at, (applies, u)) in applies.iter_mut().zip(u.chunks_exact_mut(stride)).enumerate() {
            let number = first + at;
            *applies = correction.applies(&made, number);
            if *applies {
                let history = made.scheme.histories.range(number);
                let internal = &mut internal[history.start - start..history.end - start];
                u.copy_from_slice(made.unknowns(number));
                internal.copy_from_slice(made.internal(number));
                correction.correct(&made, &mut Corrected { number, u, internal });
            }
        }
    }
}

#[cfg(test)]
mod tests;
