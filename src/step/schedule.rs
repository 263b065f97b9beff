//! The stages of a step on all blocks, by the plans of [`tiles`].

use super::balance::Sums;
use super::tiles::{self, Event, Plan};
use super::{Scheme, Scratch, Stage, Survey, Work, begin, finish, flux, volume, with_scratch};
use crate::lane::{self, F8};
use crate::state::State;
use rayon::iter::Either;
use rayon::prelude::*;

/// A tile of blocks with its memory.
pub(super) struct Tile {
    plan: Plan,
    /// dU/dt: [slot][stage][component][node].
    rates: Vec<F8>,
    /// See [`flux::Traces`], with [`volume::width`] numbers a point.
    traces: Vec<F8>,
    /// The slot of the traces of each block: [stage][block].
    slots: Vec<u32>,
}

/// The tiles of a step, of equal size but for the last.
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    /// Blocks of a tile.
    size: usize,
}

impl Tiles {
    /// For states with `stride` numbers a block, on the current number of threads.
    pub fn new(scheme: &Scheme, stride: usize) -> Self {
        let (stages, blocks) = (scheme.stages(), &scheme.operators.blocks);
        let graph = tiles::graph(blocks);
        let plans = tiles::plans(&graph, stages, rayon::current_num_threads().max(1));
        let size = plans.first().map_or(1, |plan| plan.range.len().max(1));
        let numbers = scheme.block_traces(false);
        let tile = |plan: Plan| Tile {
            rates: vec![F8::ZERO; plan.rates * stages * stride],
            traces: vec![F8::ZERO; plan.traces * numbers + 2],
            slots: vec![0; stages * blocks.len()],
            plan,
        };
        Self { tiles: plans.into_iter().map(tile).collect(), size }
    }

    /// Makes room for the numbers that the balance of energy needs.
    pub fn widen(&mut self, scheme: &Scheme) {
        for tile in &mut self.tiles {
            tile.traces.resize(tile.plan.traces * scheme.block_traces(true) + 2, F8::ZERO);
        }
    }

    /// Numbers of eight lanes held.
    pub fn numbers(&self) -> usize {
        self.tiles.iter().map(|tile| tile.rates.len() + tile.traces.len()).sum()
    }
}

/// So many blocks ahead memory is asked for.
pub(super) const AHEAD: usize = 2;

/// A tile under way.
struct Pass<'a> {
    scheme: &'a Scheme,
    stages: &'a [Stage<'a>],
    state: &'a State,
    survey: &'a Survey,
    tile: &'a mut Tile,
    /// New unknowns of the tile.
    next: &'a mut [F8],
    /// The balance of its blocks; none where it is off.
    balance: Option<&'a mut [Sums]>,
    /// That of the blocks around it, which is another's.
    others: Sums,
    scratch: &'a mut Scratch,
}

impl Pass<'_> {
    fn run(mut self) {
        for number in 0..self.tile.plan.events.len() {
            let event = self.tile.plan.events[number];
            match event.traces {
                Some(slot) => self.begin(&event, slot as usize),
                None => self.finish(&event),
            }
        }
    }

    fn begin(&mut self, event: &Event, slot: usize) {
        let Self { scheme, stages, state, tile, .. } = self;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        if stage.number == 0 && block + AHEAD < blocks {
            scheme.ask_for(state, block + AHEAD);
        }
        tile.slots[stage.number * blocks + block] = slot as u32;
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let numbers = scheme.block_traces(self.balance.is_some());
        let work = begin::Block {
            scheme,
            stage,
            block,
            state,
            before,
            rate: &mut now[..stride],
            traces: &mut tile.traces[1 + slot * numbers..][..numbers],
            sums: sums_of(&mut self.balance, &tile.plan, &mut self.others, block),
            scratch: self.scratch,
        };
        work.run();
    }

    fn finish(&mut self, event: &Event) {
        let Self { scheme, stages, state, survey, tile, next, .. } = self;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        // Blocks around the tile have no last stage.
        let next = if stage.number + 1 < stages.len() {
            &mut []
        } else {
            &mut next[(block - tile.plan.range.start) * stride..][..stride]
        };
        let work = finish::Block {
            scheme,
            stage,
            block,
            state,
            survey,
            before,
            rate: &mut now[..stride],
            traces: flux::Traces { all: &tile.traces, slots: &tile.slots[stage.number * blocks..][..blocks] },
            next,
            sums: sums_of(&mut self.balance, &tile.plan, &mut self.others, block),
            scratch: self.scratch,
        };
        work.run();
    }
}

/// Where a block's balance is kept; none where it is off.
fn sums_of<'a>(
    balance: &'a mut Option<&mut [Sums]>,
    plan: &Plan,
    others: &'a mut Sums,
    block: usize,
) -> Option<&'a mut Sums> {
    let own = balance.as_mut()?;
    if plan.range.contains(&block) { own.get_mut(block - plan.range.start) } else { Some(others) }
}

/// The balance of each tile, or for each tile none.
fn sums(
    balance: &mut Option<Vec<Sums>>,
    size: usize,
    tiles: usize,
) -> impl IndexedParallelIterator<Item = Option<&mut [Sums]>> {
    match balance {
        Some(sums) => Either::Left(sums.par_chunks_mut(size).map(Some)),
        None => Either::Right((0..tiles).into_par_iter().map(|_| None)),
    }
}

impl Scheme {
    /// All stages of a step.
    pub(super) fn run_stages(&self, stages: &[Stage], state: &State, survey: &Survey, work: &mut Work) {
        let stride = state.components * self.operators.nodes();
        let Work { tiles: Tiles { tiles, size }, next, balance, scratch, .. } = work;
        let balance = sums(balance, *size, tiles.len());
        let parts = next.u.par_chunks_mut((*size * stride).max(1)).zip(balance);
        tiles.par_iter_mut().with_max_len(1).zip(parts).for_each(|(tile, (next, balance))| {
            with_scratch(scratch, |scratch| {
                let others = Sums::default();
                Pass { scheme: self, stages, state, survey, tile, next, balance, others, scratch }.run();
            });
        });
    }

    /// Asks for what the first stage of a block will read.
    #[inline]
    fn ask_for(&self, state: &State, block: usize) {
        let (n, geometry) = (self.operators.nodes(), &self.operators.geometry);
        let stride = state.components * n;
        lane::prefetch(&state.u[stride * block..stride * (block + 1)]);
        lane::prefetch(&geometry.cofactor[4 * n * block..4 * n * (block + 1)]);
        lane::prefetch(&geometry.inverse_mass[n * block..n * (block + 1)]);
        lane::prefetch(&geometry.mass[n * block..n * (block + 1)]);
        lane::prefetch(&geometry.normal[8 * block..8 * (block + 1)]);
    }

    /// Numbers of the traces of a block.
    fn block_traces(&self, metered: bool) -> usize {
        4 * self.operators.line.m * volume::width(self.flux.has_shear(), metered)
    }

    /// Bytes of the traces of all faces, without the balance.
    pub fn trace_bytes(&self) -> usize {
        self.operators.blocks.len() * self.block_traces(false) * size_of::<F8>()
    }
}
