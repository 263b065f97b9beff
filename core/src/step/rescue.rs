//! The rescue: cells that a step has lost are stepped again at order 0, with their neighbours.
//!
//! After a step (with its corrections) each cell is looked at: J at nodes, face points and material points, numbers that are not
//! finite, hyperbolicity. Where something is lost, or J somewhere in the cell falls below a share of the J of its mean F, the cell
//! and [`LAYERS`] of cells around it, across faces, are marked, and the step is done again with the unknowns of marked cells replaced
//! by their mean, before it, in each of its stages, and after it. A constant cell has no volume term and its traces are its mean: this is the
//! finite-volume scheme of first order with the flux of the run. Both sides of a face see one flux as ever, so that mass,
//! momentum and mean F of the body are kept to rounding. Where more cells are lost then, they join; a cell that is lost at order 0
//! is a loss. (A posteriori limiting after Clain, Diot, Loubere, J. Comput. Phys. 230, 2011, on the cells of a DG scheme: Dumbser,
//! Zanotti, Loubere, Diot, J. Comput. Phys. 278, 2014.)

use super::{Loss, Scheme, Survey, Work, with_scratch};
use crate::lane::{F8, LANES, Lanes};
use crate::mesh::FACES;
use crate::operators::{Neighbour, with_nodes};
use crate::state::State;
use crate::step::volume::Masses;
use crate::sum::ExactSum;
use crate::tensor::{self, DEFORMATION};
use rayon::prelude::*;
use std::time::Instant;

/// When a cell is rescued.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rescue {
    /// A cell is rescued where J somewhere in it is below this share of the J of its mean F.
    pub trigger: f64,
}

impl Default for Rescue {
    /// Energy that the paper's impact (30 x 30 cells, to 1.77 ms) makes out of nothing, as a share of the start: at 4000 m/s, S2, .59 %
    /// with one layer and .5, 0 with two layers and .7 or .8; at 6000 m/s, S1, it is lost with one layer and .5, makes 5.6 % with one
    /// layer and .8, .14 % with two layers and .7, .002 % with two layers and .8. At 2000 m/s no cell is rescued with .8.
    fn default() -> Self {
        Self { trigger: 0.8 }
    }
}

/// So many layers of cells around a lost one are stepped at order 0 with it. Its neighbours of high order would tear it again.
const LAYERS: usize = 2;

/// So often a step is done again. Each round adds the neighbours of what is lost.
const ROUNDS: usize = 8;

/// Memory of the rescue.
pub(super) struct Memory {
    /// The state before the step with marked cells constant.
    start: State,
    /// The lanes that are lost: `[block]`.
    lost: Vec<u8>,
    /// Seconds spent on looking for lost cells and on stepping again, since [`Work::take_rescue_seconds`].
    seconds: f64,
}

impl Memory {
    /// For states like `state` of so many blocks.
    pub fn new(state: &State, blocks: usize) -> Self {
        Self { start: state.clone(), lost: vec![0; blocks], seconds: 0.0 }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.start.u.len() + self.start.internal.len() + self.start.creep.len()) * size_of::<F8>() + self.lost.len()
    }
}

impl Scheme {
    /// A step of `dt` to `time` with its survey, cells rescued where it lost them.
    ///
    /// # Errors
    /// The first cell that is lost at order 0, or after [`ROUNDS`] rounds.
    pub(super) fn step_with(
        &self,
        rescue: Rescue,
        (state, survey): (&State, &Survey),
        (dt, time): (f64, f64),
        work: &mut Work,
        out: &mut Survey,
    ) -> Result<(), Loss> {
        if let Some(memory) = work.corrections.as_deref_mut() {
            memory.blocks.flat.fill(0);
        }
        self.step_to(state, survey, dt, time, work);
        let mut result = self.surveyed(work, out);
        let clock = Instant::now();
        if let Some(memory) = work.corrections.as_deref_mut() {
            memory.loss[0] = 0.0;
        }
        for _ in 0..ROUNDS {
            if !self.mark(rescue, result.err(), work) {
                break;
            }
            let Some(mut start) = self.start_of(state, work) else { break };
            self.step_to(&start, survey, dt, time, work);
            result = self.surveyed(work, out);
            if let Some(memory) = work.corrections.as_deref_mut().and_then(|memory| memory.rescue.as_mut()) {
                std::mem::swap(&mut memory.start, &mut start);
            }
        }
        if result.is_ok() {
            count(work);
        }
        if let Some(own) = work.corrections.as_deref_mut().and_then(|memory| memory.rescue.as_mut()) {
            own.seconds += clock.elapsed().as_secs_f64();
        }
        result
    }

    /// Marks the cells that the step has lost and those across their faces; whether one was not marked before.
    fn mark(&self, rescue: Rescue, loss: Option<Loss>, work: &mut Work) -> bool {
        let Work { next, corrections, scratch, .. } = work;
        let Some(memory) = corrections.as_deref_mut() else { return false };
        let Some(own) = &mut memory.rescue else { return false };
        let (worst, state) = (&memory.worst, &*next);
        own.lost.par_iter_mut().enumerate().for_each(|(block, lost)| {
            *lost = with_scratch(scratch, |scratch| {
                let masses = &mut scratch.nodes.masses;
                let u = &state.u[block * state.components * self.operators.nodes()..];
                let trouble = Trouble { scheme: self, block, u, share: rescue.trigger, masses };
                with_nodes!(self.operators.line.m, M => self.kernel.run(OfDegree::<'_, M>(trouble)))
            });
            if worst[block].lost != usize::MAX {
                *lost |= self.lost_lanes(state, block);
            }
            *lost &= (u16::from(u8::MAX) >> (LANES - self.operators.blocks.count[block])) as u8;
        });
        if let Some(loss) = loss {
            let (block, lane) = self.operators.blocks.slot[loss.cell];
            own.lost[block] |= 1 << lane;
        }
        let flat = &mut memory.blocks.flat;
        let mut any = self.spread(&own.lost, flat);
        for _ in 1..LAYERS {
            own.lost.copy_from_slice(flat);
            any |= self.spread(&own.lost, flat);
        }
        any
    }

    /// Marks cells and those across their faces; whether one was not marked before.
    fn spread(&self, cells: &[u8], flat: &mut [u8]) -> bool {
        let mut any = false;
        let mut add = |block: usize, lane: usize| {
            any |= flat[block] >> lane & 1 == 0;
            flat[block] |= 1 << lane;
        };
        for (block, &lanes) in cells.iter().enumerate().filter(|(_, lanes)| **lanes != 0) {
            for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
                add(block, lane);
                for face in 0..FACES {
                    if let Neighbour::Cell(there) | Neighbour::Interface(there, _) =
                        self.operators.blocks.neighbours[block][face][lane]
                    {
                        add(there.face / FACES, there.lane);
                    }
                }
            }
        }
        any
    }

    /// The lanes of a block where a number is not finite, J <= 0 or hyperbolicity is lost.
    fn lost_lanes(&self, state: &State, block: usize) -> u8 {
        let mut lanes = 0;
        for lane in 0..self.operators.blocks.count[block] {
            self.losses(state, block, lane, &mut |_, _| lanes |= 1 << lane);
        }
        lanes
    }

    /// The state before the step with marked cells constant, and what this takes of their energy.
    fn start_of(&self, state: &State, work: &mut Work) -> Option<State> {
        let Work { corrections, balance, scratch, .. } = work;
        let memory = corrections.as_deref_mut()?;
        let mut start = std::mem::take(&mut memory.rescue.as_mut()?.start);
        (start.time, start.step) = (state.time, state.step);
        start.u.copy_from_slice(&state.u);
        start.internal.copy_from_slice(&state.internal);
        start.boundary.clone_from(&state.boundary);
        start.unheld.clone_from(&state.unheld);
        start.creep.clone_from(&state.creep);
        let stride = state.components * self.operators.nodes();
        let mut loss = ExactSum::default();
        for (block, &lanes) in memory.blocks.flat.iter().enumerate().filter(|(_, lanes)| **lanes != 0) {
            flatten(self, block, lanes, &mut start.u[stride * block..stride * (block + 1)]);
            self.move_histories(block, lanes, (state, &mut start));
            if balance.is_some() {
                let [before, after] = [state, &start].map(|state| self.energy_of_block(state, block, scratch));
                let cells = 0..self.operators.blocks.count[block];
                loss.add(cells.map(|lane| before.0[lane] - after.0[lane]).sum());
            }
        }
        memory.loss[0] = loss.value();
        Some(start)
    }
}

impl Scheme {
    /// Moves the histories of lanes that have become constant, so that their elastic strain stays but for its volume: with the F of
    /// the mean alone, what the points have flowed apart would turn into stress.
    fn move_histories(&self, block: usize, lanes: u8, (state, start): (&State, &mut State)) {
        let law = &self.laws[self.operators.blocks.material[block]];
        let (count, n) = (law.history_len(), self.operators.nodes());
        if count == 0 {
            return;
        }
        let (first, unknowns) = (self.histories.range(block).start, block * state.components * n);
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
            let to = std::array::from_fn(|k| start.u[unknowns + k * n].0[lane]);
            let points = self.points_from_nodes(block, lane);
            let places = self.operators.points.as_ref().map_or(n, |points| points.count[block][lane] as usize);
            for point in 0..places {
                let from = std::array::from_fn(|k| {
                    let number = |a: usize| state.u[unknowns + k * n + a].0[lane];
                    points.as_ref().map_or_else(
                        || number(point),
                        |matrix| matrix.row(point).iter().enumerate().map(|(a, w)| w * number(a)).sum(),
                    )
                });
                let mut history = self.internal_at(state, block, lane, point);
                law.move_history(from, to, &mut history);
                let out = &mut start.internal[first + count * point..][..count];
                out.iter_mut().zip(history).for_each(|(out, value)| out.0[lane] = value);
            }
        }
    }
}

impl Work {
    /// Seconds that the rescue took since the last call; 0 where there is none.
    pub fn take_rescue_seconds(&mut self) -> f64 {
        let own = self.corrections.as_deref_mut().and_then(|memory| memory.rescue.as_mut());
        own.map_or(0.0, |own| std::mem::take(&mut own.seconds))
    }
}

/// Counts the rescued cells.
fn count(work: &mut Work) {
    let Some(memory) = work.corrections.as_deref_mut() else { return };
    for (lanes, treated) in memory.blocks.flat.iter().zip(memory.treated.as_chunks_mut::<2>().0) {
        for (lane, rescued) in treated[1].0.iter_mut().enumerate() {
            *rescued += f64::from(lanes >> lane & 1);
        }
    }
}

/// Replaces all unknowns of some lanes of a block by their mean over the cell, sum_a w_a J_a U_a / sum_a w_a J_a. The displacement, where
/// it is carried, gets the gradient of the mean F: the velocity of a constant cell would leave its gradient as it is, while the faces
/// change F.
pub(super) fn flatten(scheme: &Scheme, block: usize, lanes: u8, u: &mut [F8]) {
    let n = scheme.operators.nodes();
    for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
        let weights = scheme.operators.node_weights(block, lane);
        let area: f64 = weights[..n].iter().sum();
        for values in u.chunks_exact_mut(n) {
            let sum: f64 = weights.iter().zip(&*values).map(|(weight, value)| weight * value.0[lane]).sum();
            values.iter_mut().for_each(|value| value.0[lane] = sum / area);
        }
        scheme.follow(block, lane, u);
    }
}

/// Looks for cells with J far below that of their mean.
struct Trouble<'a> {
    scheme: &'a Scheme,
    block: usize,
    u: &'a [F8],
    share: f64,
    masses: &'a mut [F8],
}

struct OfDegree<'a, const M: usize>(Trouble<'a>);

impl<const M: usize> crate::lane::Work for OfDegree<'_, M> {
    type Out = u8;
    #[inline(always)]
    fn run<L: Lanes>(self) -> u8 {
        let Trouble { scheme, block, u, share, masses } = self.0;
        let (n, line) = (M * M, &scheme.operators.line);
        let metric = scheme.operators.geometry.of(block);
        Masses::<'_, M> { line, metric, masses: &mut *masses }.run::<L>();
        let at = |k: usize, a: usize| L::load(&u[k * n + a]);
        let (mut sum, mut area, mut smallest) = ([L::zero(); DEFORMATION], L::zero(), L::splat(f64::INFINITY));
        for (a, mass) in masses[..n].iter().enumerate() {
            let mass = L::load(mass);
            let f = [at(0, a), at(1, a), at(2, a), at(3, a)];
            for k in 0..DEFORMATION {
                sum[k] = mass.mul_add(f[k], sum[k]);
            }
            area = area + mass;
            smallest = smallest.min(tensor::det(f));
        }
        for face in 0..FACES {
            for point in 0..M {
                let (first, stride) = line.across(face, point);
                let mut f = [L::zero(); DEFORMATION];
                for (i, l) in line.ends[face % 2].iter().enumerate() {
                    for (k, f) in f.iter_mut().enumerate() {
                        *f = L::splat(*l).mul_add(at(k, first + stride * i), *f);
                    }
                }
                smallest = smallest.min(tensor::det(f));
            }
        }
        let mean = tensor::det(sum) / (area * area);
        let (mut margin, mut lanes) = (F8::ZERO, 0);
        (smallest - L::splat(share) * mean).store(&mut margin);
        for (lane, margin) in margin.0.iter().enumerate() {
            // NaN is trouble, too.
            lanes |= u8::from(margin.is_nan() || *margin < 0.0) << lane;
        }
        lanes
    }
}

#[cfg(test)]
mod tests;
