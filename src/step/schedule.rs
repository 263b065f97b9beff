//! The stages of a step on all blocks, by the plans of [`tiles`].

use super::balance::Sums;
use super::survey::Worst;
use super::tiles::{self, Event, Plan};
use super::{Scheme, Scratch, Stage, Survey, Work, begin, finish, flux, volume, with_scratch};
use crate::lane::{self, F8};
use crate::operators::Operators;
use crate::state::State;
use std::sync::Mutex;

/// A tile of blocks with its memory.
pub(super) struct Tile {
    plan: Plan,
    /// dU/dt: [slot][stage][component][node].
    rates: Vec<F8>,
    /// See [`flux::Traces`], with [`volume::width`] numbers a point.
    traces: Vec<F8>,
    /// The slot of the traces of each block: [stage][block].
    slots: Vec<u32>,
    /// The worst of its blocks after the last step.
    worst: Worst,
    /// Whether the unknowns come from memory, see [`FAR`].
    far: bool,
}

/// The tiles of a step.
pub(super) struct Tiles(Vec<Tile>);

impl Tiles {
    /// For states with `stride` numbers a block, on the current number of threads.
    pub fn new(scheme: &Scheme, stride: usize) -> Self {
        let (stages, blocks) = (scheme.stages(), &scheme.operators.blocks);
        let graph = tiles::graph(blocks);
        let plans = tiles::plans(&graph, stages, rayon::current_num_threads().max(1));
        let numbers = scheme.block_traces(false);
        let tile = |plan: Plan| Tile {
            rates: vec![F8::ZERO; plan.rates * stages * stride],
            traces: vec![F8::ZERO; plan.traces * numbers + 2],
            slots: vec![0; stages * blocks.len()],
            worst: Worst::NONE,
            far: blocks.len() * stride * size_of::<F8>() > FAR,
            plan,
        };
        Self(plans.into_iter().map(tile).collect())
    }

    /// Makes room for the numbers that the balance of energy needs.
    pub fn widen(&mut self, scheme: &Scheme) {
        for tile in &mut self.0 {
            tile.traces.resize(tile.plan.traces * scheme.block_traces(true) + 2, F8::ZERO);
        }
    }

    /// The worst of all blocks after the last step.
    pub fn worst(&self) -> Worst {
        self.0.iter().fold(Worst::NONE, |worst, tile| worst.and(tile.worst))
    }

    /// Numbers of eight lanes held.
    pub fn numbers(&self) -> usize {
        self.0.iter().map(|tile| tile.rates.len() + tile.traces.len()).sum()
    }
}

/// Bytes of unknowns beyond which they come from memory, not from the last cache. There the step asks for all that it will
/// read and write (5 to 9 % of it), elsewhere for the unknowns and the metric only.
const FAR: usize = 4 << 20;

/// So many blocks ahead memory is asked for.
const AHEAD: usize = 2;

/// A tile under way.
struct Pass<'a> {
    scheme: &'a Scheme,
    stages: &'a [Stage<'a>],
    state: &'a State,
    survey: &'a Survey,
    tile: &'a mut Tile,
    /// What the step makes of the tile.
    out: Out<'a>,
    /// That of the blocks around it, which is another's.
    others: Sums,
    scratch: &'a mut Scratch,
}

impl Pass<'_> {
    fn run(mut self) {
        self.tile.worst = Worst::NONE;
        for number in 0..self.tile.plan.events.len() {
            let event = self.tile.plan.events[number];
            match event.traces {
                Some(slot) => self.begin(&event, slot as usize),
                None => self.finish(&event),
            }
        }
    }

    fn begin(&mut self, event: &Event, slot: usize) {
        let Self { scheme, stages, state, survey, tile, .. } = self;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        if stage.number == 0 && block + AHEAD < blocks {
            scheme.ask_for(state, block + AHEAD);
            if tile.far {
                scheme.ask_for_more(survey, block + AHEAD);
            }
        }
        tile.slots[stage.number * blocks + block] = slot as u32;
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let numbers = scheme.block_traces(self.out.balance.is_some());
        let work = begin::Block {
            scheme,
            stage,
            block,
            state,
            before,
            rate: &mut now[..stride],
            traces: &mut tile.traces[1 + slot * numbers..][..numbers],
            sums: sums_of(&mut self.out.balance, &tile.plan, &mut self.others, block),
            scratch: self.scratch,
        };
        work.run();
    }

    fn finish(&mut self, event: &Event) {
        let Self { scheme, stages, state, survey, tile, out, .. } = self;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        if stage.number + 1 == stages.len()
            && let Some(curl_free) = &scheme.operators.curl_free
        {
            curl_free.ask_for(block + 1);
        }
        // Blocks around the tile have no last stage.
        if tile.far && stage.number + 1 == stages.len() {
            out.ask_for(block - tile.plan.range.start + AHEAD, stride);
        }
        let new = (stage.number + 1 == stages.len()).then(|| {
            let at = block - tile.plan.range.start;
            let history = scheme.histories.range(block);
            let start = scheme.histories.range(tile.plan.range.start).start;
            finish::New {
                u: &mut out.u[at * stride..][..stride],
                internal: &mut out.internal[history.start - start..history.end - start],
                speed: &mut out.speed[at],
                worst: &mut tile.worst,
            }
        });
        let work = finish::Block {
            scheme,
            stage,
            block,
            state,
            survey,
            before,
            rate: &mut now[..stride],
            traces: flux::Traces { all: &tile.traces, slots: &tile.slots[stage.number * blocks..][..blocks] },
            new,
            sums: sums_of(&mut out.balance, &tile.plan, &mut self.others, block),
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

/// What a step makes of the blocks of some tiles that follow each other.
struct Out<'a> {
    /// New unknowns.
    u: &'a mut [F8],
    /// New internal variables.
    internal: &'a mut [F8],
    /// New wave speeds.
    speed: &'a mut [F8],
    /// The balance of the blocks; none where it is off.
    balance: Option<&'a mut [Sums]>,
}

impl<'a> Out<'a> {
    /// Asks for what will be written of a block. (A store to a line that is not there waits as a load does.)
    #[inline]
    fn ask_for(&self, block: usize, stride: usize) {
        if let Some(u) = self.u.get(stride * block..stride * (block + 1)) {
            lane::prefetch(u);
            lane::prefetch(&self.speed[block..=block]);
        }
    }

    /// Those of the first `blocks`, with so many internal variables, and the rest.
    fn split(self, blocks: usize, stride: usize, internal: usize) -> (Self, Self) {
        let (u, u2) = self.u.split_at_mut(blocks * stride);
        let (internal, internal2) = self.internal.split_at_mut(internal);
        let (speed, speed2) = self.speed.split_at_mut(blocks);
        let (balance, balance2) = self.balance.map(|sums| sums.split_at_mut(blocks)).unzip();
        (Out { u, internal, speed, balance }, Out { u: u2, internal: internal2, speed: speed2, balance: balance2 })
    }
}

/// A step under way.
#[derive(Clone, Copy)]
struct Step<'a> {
    scheme: &'a Scheme,
    stages: &'a [Stage<'a>],
    state: &'a State,
    survey: &'a Survey,
    scratch: &'a [Mutex<Scratch>],
}

impl Step<'_> {
    /// Halves until a tile is left: nothing may be allocated.
    fn run(self, tiles: &mut [Tile], out: Out) {
        let Self { scheme, stages, state, survey, scratch } = self;
        match tiles {
            [] => {}
            [tile] => with_scratch(scratch, |scratch| {
                Pass { scheme, stages, state, survey, tile, out, others: Sums::default(), scratch }.run();
            }),
            _ => {
                let (left, right) = tiles.split_at_mut(tiles.len() / 2);
                let (start, middle) = (left[0].plan.range.start, right[0].plan.range.start);
                let first = |block| scheme.histories.range(block).start;
                let stride = state.components * scheme.operators.nodes();
                let (one, two) = out.split(middle - start, stride, first(middle) - first(start));
                rayon::join(|| self.run(left, one), || self.run(right, two));
            }
        }
    }
}

impl Scheme {
    /// All stages of a step.
    pub(super) fn run_stages(&self, stages: &[Stage], state: &State, survey: &Survey, work: &mut Work) {
        let Work { tiles: Tiles(tiles), next, speed, balance, scratch, .. } = work;
        let out = Out { u: &mut next.u, internal: &mut next.internal, speed, balance: balance.as_deref_mut() };
        Step { scheme: self, stages, state, survey, scratch }.run(tiles, out);
    }

    /// Asks for what the stages of a block will read.
    #[inline]
    fn ask_for(&self, state: &State, block: usize) {
        let stride = state.components * self.operators.nodes();
        lane::prefetch(&state.u[stride * block..stride * (block + 1)]);
        lane::prefetch(&self.operators.geometry.blocks[block..=block]);
    }

    /// Asks for what else they will read: a line or two of each.
    #[inline]
    fn ask_for_more(&self, survey: &Survey, block: usize) {
        let Operators { blocks, points, .. } = &self.operators;
        lane::prefetch(&blocks.plan[block..=block]);
        lane::prefetch(&survey.speed[block..=block]);
        if let Some(points) = points {
            lane::prefetch(points.metric_of(block));
        }
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
