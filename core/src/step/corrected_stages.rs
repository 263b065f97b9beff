//! The stages of a Runge-Kutta step one after the other on all blocks, so that corrections can act on each of them.

use super::correction::{Blocks, Memory};
use super::ranks::Ranks;
use super::stage::Sum;
use super::sums::Terms;
use super::tile_memory::Tile;
use super::worst::Worst;
use super::{Method, Scheme, Stage};
use crate::state::State;
use rayon::prelude::*;

/// What stages begin with.
pub(super) struct Starts<'a> {
    /// The state of the stage under way.
    start: &'a mut State,
    blocks: &'a mut Blocks,
}

impl Memory {
    /// The worst of each block, and what stages begin with where corrections act on them.
    pub fn parts(&mut self) -> (&mut [Worst], Option<Starts<'_>>) {
        let Self { worst, stage, blocks, .. } = self;
        (worst, stage.as_mut().map(|start| Starts { start, blocks }))
    }
}

impl Starts<'_> {
    /// The state that a stage begins with: U^n + dt sum_j a_ij k_j of all blocks, on which corrections have acted.
    pub fn of(
        &mut self,
        scheme: &Scheme,
        stage: &Stage,
        state: &State,
        tiles: &[Tile],
        ranks: Option<&mut Ranks>,
    ) -> &State {
        let Self { start, blocks } = self;
        let Method::RungeKutta(tableau) = &scheme.method else { return start };
        let (stride, row) = (state.components * scheme.operators.nodes(), &tableau.a[stage.number]);
        (start.time, start.step) = (state.time + tableau.c[stage.number] * stage.dt, state.step);
        start.unheld.clone_from(&state.unheld);
        start.internal.copy_from_slice(&state.internal);
        start.u.par_chunks_mut(stride).enumerate().for_each(|(block, out)| {
            let Some(tile) = tiles.iter().find(|tile| tile.plan.range.contains(&block)) else { return };
            let rates = scheme.stages() * stride;
            let first = rates * (block - tile.plan.range.start);
            // A tile of another rank has none.
            let Some(before) = tile.rates.get(first..first + rates) else { return };
            let terms = Terms::new(row.iter().map(|a| a * stage.dt), before, stride, stride);
            scheme.kernel.run(Sum { terms, start: &state.u[stride * block..stride * (block + 1)], out });
        });
        if let Some(ranks) = ranks {
            ranks.gather(&mut start.u, |block| block * stride);
        }
        scheme.correct_stage((state, start), (stage.dt, stage.number), blocks);
        start
    }
}
