//! The survey, the internal variables and the energy of blocks that corrections have changed.

use super::Memory;
use crate::lane::F8;
use crate::state::State;
use crate::step::balance::BlockBalance;
use crate::step::block_energy::BlockEnergy;
use crate::step::survey::{Examine, History};
use crate::step::worst::Worst;
use crate::step::{Scheme, Scratch, Speeds, Work, with_scratch};
use crate::sum::ExactSum;
use std::sync::Mutex;

/// What is found anew of some blocks that follow each other.
struct Part<'a> {
    first: usize,
    worst: &'a mut [Worst],
    speed: &'a mut [Speeds],
    internal: &'a mut [F8],
}

/// What they are found from.
#[derive(Clone, Copy)]
struct Given<'a> {
    scheme: &'a Scheme,
    before: &'a State,
    /// Unknowns after the corrections.
    u: &'a [F8],
    dt: f64,
    changed: &'a [u8],
    renewed: &'a [bool],
    scratch: &'a [Mutex<Scratch>],
}

/// So many blocks are looked at by one thread at least.
const PART: usize = 16;

impl Part<'_> {
    /// Looks at the changed ones: halves until few are left, since nothing may be allocated.
    fn look(self, given: Given) {
        let Self { first, worst, speed, internal } = self;
        let histories = &given.scheme.histories;
        let start = histories.range(first).start;
        if worst.len() > PART {
            let half = worst.len() / 2;
            let ((worst, worst2), (speed, speed2)) = (worst.split_at_mut(half), speed.split_at_mut(half));
            let (internal, internal2) = internal.split_at_mut(histories.range(first + half).start - start);
            let left = Part { first, worst, speed, internal };
            let right = Part { first: first + half, worst: worst2, speed: speed2, internal: internal2 };
            rayon::join(|| left.look(given), || right.look(given));
            return;
        }
        for (at, (worst, speed)) in worst.iter_mut().zip(speed).enumerate() {
            let block = first + at;
            if given.changed[block] != 0 {
                let range = histories.range(block);
                given.examine(block, worst, speed, &mut internal[range.start - start..range.end - start]);
            }
        }
    }
}

impl Given<'_> {
    fn examine(self, block: usize, worst: &mut Worst, speed: &mut Speeds, internal: &mut [F8]) {
        let Self { scheme, before, dt, renewed, scratch, .. } = self;
        let stride = before.components * scheme.operators.nodes();
        let u = &self.u[stride * block..stride * (block + 1)];
        let law = &scheme.laws[scheme.operators.blocks.material[block]];
        with_scratch(scratch, |scratch| {
            *worst = Worst::NONE;
            let history = match renewed[block] {
                true => History::Before(scheme.histories.of(before, block), internal, dt),
                false => History::Now(internal),
            };
            law.block().examine(scheme.kernel, Examine { scheme, block, u, history, scratch, speed, worst });
        });
    }
}

impl Scheme {
    /// Surveys changed blocks, with their internal variables where these are found anew, and their energy.
    pub(super) fn look_anew(&self, before: &State, dt: f64, work: &mut Work) {
        let Work { next, speed, balance, corrections, scratch, .. } = work;
        let Some(Memory { worst, blocks, loss, .. }) = corrections.as_deref_mut() else { return };
        let (changed, renewed) = (&blocks.changed[..], &blocks.renewed[..]);
        let given = Given { scheme: self, before, u: &next.u, dt, changed, renewed, scratch };
        Part { first: 0, worst, speed, internal: &mut next.internal }.look(given);
        loss[1] = balance.as_mut().map_or(0.0, |balance| self.renew_energy(next, changed, balance, scratch));
    }

    /// Renews the energy of changed blocks; what they lost, by an exact sum.
    fn renew_energy(
        &self,
        state: &State,
        changed: &[u8],
        balance: &mut [BlockBalance],
        scratch: &[Mutex<Scratch>],
    ) -> f64 {
        let mut loss = ExactSum::default();
        for (block, balance) in balance.iter_mut().enumerate().filter(|(block, _)| changed[*block] != 0) {
            let energy = self.energy_of_block(state, block, scratch);
            let cells = 0..self.operators.blocks.count[block];
            loss.add(cells.map(|lane| balance.energy.0[lane] - energy.0[lane]).sum());
            balance.energy = energy;
        }
        loss.value()
    }

    /// The energy of the cells of a block, with what laws have dissipated, J/m.
    pub(in crate::step) fn energy_of_block(&self, state: &State, block: usize, scratch: &[Mutex<Scratch>]) -> F8 {
        let u = state.of_block(block, self.operators.nodes());
        let internal = self.histories.of(state, block);
        let creep = self.creep_of(state, block);
        with_scratch(scratch, |scratch| {
            BlockEnergy { scheme: self, block, u, internal, creep, dt: 0.0, scratch }.find()
        })
    }
}
