//! The stages of a step on all blocks, by the plan of [`tiles`].

use super::balance::Sums;
use super::outside::{self, Given};
use super::survey::{Speeds, Worst};
use super::tiles::{self, Event, Plan, Slot};
use super::{Scheme, Scratch, Stage, Survey, Work, across, begin, finish, volume, with_scratch};
use crate::lane::{self, F8};
use crate::operators::Operators;
use crate::state::State;
use std::sync::Mutex;

/// A tile of blocks with its memory.
struct Tile {
    plan: tiles::Tile,
    /// dU/dt: [slot][stage][component][node].
    rates: Vec<F8>,
    /// See [`across::Traces`], with [`volume::width`] numbers a point.
    traces: Vec<F8>,
    /// The worst of its blocks after the last step.
    worst: Worst,
}

/// The tiles of a step.
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    phases: usize,
    /// The traces that each tile shows: [phase][tile].
    shown: Vec<Vec<F8>>,
    /// Slots of each of them.
    shown_slots: Vec<usize>,
    /// The slot of the traces of each block: [stage][block].
    slots: Vec<Slot>,
    /// Whether the unknowns come from memory, see [`FAR`].
    far: bool,
}

impl Tiles {
    /// For states with `stride` numbers a block, on the current number of threads.
    pub fn new(scheme: &Scheme, stride: usize) -> Self {
        let (stages, blocks) = (scheme.stages(), &scheme.operators.blocks);
        let plan = Plan::new(&tiles::graph(blocks), stages, rayon::current_num_threads().max(1));
        let phases = plan.phases();
        let tile = |plan: tiles::Tile| {
            let rates = vec![F8::ZERO; plan.rates * stages * stride];
            Tile { rates, traces: vec![], worst: Worst::NONE, plan }
        };
        let mut out = Self {
            tiles: plan.tiles.into_iter().map(tile).collect(),
            phases,
            shown: vec![vec![]; plan.shown.len()],
            shown_slots: plan.shown,
            slots: plan.slots,
            far: blocks.len() * stride * size_of::<F8>() > FAR,
        };
        out.make_room(scheme.block_traces(false));
        out
    }

    /// How many.
    #[cfg(test)]
    pub fn count(&self) -> usize {
        self.tiles.len()
    }

    /// Makes room for the numbers that the balance of energy needs.
    pub fn widen(&mut self, scheme: &Scheme) {
        self.make_room(scheme.block_traces(true));
    }

    /// Makes room for so many numbers of the traces of a block.
    fn make_room(&mut self, numbers: usize) {
        let own = self.tiles.iter_mut().map(|tile| (&mut tile.traces, tile.plan.traces));
        for (traces, slots) in own.chain(self.shown.iter_mut().zip(self.shown_slots.iter().copied())) {
            traces.resize(slots * numbers + 2, F8::ZERO);
        }
    }

    /// The worst of all blocks after the last step.
    pub fn worst(&self) -> Worst {
        self.tiles.iter().fold(Worst::NONE, |worst, tile| worst.and(tile.worst))
    }

    /// Numbers of eight lanes held.
    pub fn numbers(&self) -> usize {
        let own = self.tiles.iter().map(|tile| tile.rates.len() + tile.traces.len());
        own.chain(self.shown.iter().map(Vec::len)).sum()
    }
}

/// Bytes of unknowns beyond which they come from memory, not from the last cache. There the step asks for all that it will
/// read and write (5 to 9 % of it), elsewhere for the unknowns and the metric only.
const FAR: usize = 4 << 20;

/// So many blocks ahead memory is asked for.
const AHEAD: usize = 2;

/// A phase of a tile under way.
struct Pass<'a> {
    step: Step<'a>,
    tile: &'a mut Tile,
    /// The traces that it shows after this phase.
    shown: &'a mut [F8],
    /// What the step makes of the tile.
    out: Out<'a>,
    scratch: &'a mut Scratch,
}

impl Pass<'_> {
    fn run(mut self) {
        if self.step.phase == 0 {
            self.tile.worst = Worst::NONE;
        }
        for number in self.tile.plan.phases[self.step.phase].clone() {
            let event = self.tile.plan.events[number];
            if event.begins { self.begin(&event) } else { self.finish(&event) }
        }
    }

    fn begin(&mut self, event: &Event) {
        let Self { step, tile, shown, out, scratch } = self;
        let Step { scheme, stages, state, survey, slots, outside, far, .. } = *step;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        if let (0, Some(later)) = (stage.number, tile.plan.after(block, AHEAD)) {
            scheme.ask_for(state, later);
            if far {
                scheme.ask_for_more(survey, later);
            }
        }
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let (slot, numbers) = (slots[stage.number * blocks + block], scheme.block_traces(out.balance.is_some()));
        let traces = if slot.store == 0 { &mut tile.traces[..] } else { &mut shown[..] };
        let work = begin::Block {
            scheme,
            stage,
            block,
            later: tile.plan.after(block, 1),
            state,
            before,
            rate: &mut now[..stride],
            traces: &mut traces[1 + slot.index as usize * numbers..][..numbers],
            given: outside::entry(outside, out.first, out.given, block),
            sums: out.balance.as_mut().and_then(|sums| sums.get_mut(block - out.first)),
            worst: &mut tile.worst,
            scratch,
        };
        work.run();
    }

    fn finish(&mut self, event: &Event) {
        let Self { step, tile, shown, out, scratch } = self;
        let Step { scheme, stages, state, survey, slots, outside, seen, far, .. } = *step;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let (blocks, at) = (scheme.operators.blocks.len(), block - out.first);
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let is_last = stage.number + 1 == stages.len();
        if let (true, Some(later)) = (far && is_last, tile.plan.after(block, AHEAD)) {
            out.ask_for(later - out.first, stride);
        }
        if let (true, Some(later), Some(curl_free)) = (is_last, tile.plan.after(block, 1), &scheme.operators.curl_free)
        {
            curl_free.ask_for(later);
        }
        let new = is_last.then(|| {
            let (history, start) = (scheme.histories.range(block), scheme.histories.range(out.first).start);
            finish::New {
                u: &mut out.u[at * stride..][..stride],
                internal: &mut out.internal[history.start - start..history.end - start],
                speed: &mut out.speed[at],
                worst: &mut tile.worst,
            }
        });
        let slots = &slots[stage.number * blocks..][..blocks];
        let work = finish::Block {
            scheme,
            stage,
            block,
            state,
            survey,
            before,
            rate: &mut now[..stride],
            traces: across::Traces { own: &tile.traces, seen, shown, slots },
            new,
            given: outside::entry(outside, out.first, out.given, block),
            sums: out.balance.as_mut().and_then(|sums| sums.get_mut(at)),
            scratch,
        };
        work.run();
    }
}

/// What a step makes of the blocks of some tiles that follow each other.
struct Out<'a> {
    /// The first of them.
    first: usize,
    /// New unknowns.
    u: &'a mut [F8],
    /// New internal variables.
    internal: &'a mut [F8],
    /// New wave speeds.
    speed: &'a mut [Speeds],
    /// The work on those blocks that something outside acts on.
    given: &'a mut [Given],
    /// The balance of the blocks; none where it is off.
    balance: Option<&'a mut [Sums]>,
}

impl<'a> Out<'a> {
    /// Asks for what will be written of a block. (A store to a line that is not there waits as a load does.)
    #[inline]
    fn ask_for(&self, block: usize, stride: usize) {
        if let Some(u) = self.u.get(stride * block..stride * (block + 1)) {
            lane::prefetch(u);
            lane::prefetch(std::slice::from_ref(&self.speed[block].fastest));
        }
    }

    /// The same for a shorter time.
    fn again(&mut self) -> Out<'_> {
        let balance = self.balance.as_deref_mut();
        Out { first: self.first, u: self.u, internal: self.internal, speed: self.speed, given: self.given, balance }
    }

    /// Those of the first `blocks`, with so many internal variables and entries of `given`, and the rest.
    fn split(self, blocks: usize, stride: usize, [internal, given]: [usize; 2]) -> (Self, Self) {
        let (first, second) = (self.first, self.first + blocks);
        let (u, u2) = self.u.split_at_mut(blocks * stride);
        let (internal, internal2) = self.internal.split_at_mut(internal);
        let (speed, speed2) = self.speed.split_at_mut(blocks);
        let (given, given2) = self.given.split_at_mut(given);
        let (balance, balance2) = self.balance.map(|sums| sums.split_at_mut(blocks)).unzip();
        let left = Out { first, u, internal, speed, given, balance };
        (left, Out { first: second, u: u2, internal: internal2, speed: speed2, given: given2, balance: balance2 })
    }
}

/// A phase of a step under way.
#[derive(Clone, Copy)]
struct Step<'a> {
    scheme: &'a Scheme,
    stages: &'a [Stage<'a>],
    state: &'a State,
    survey: &'a Survey,
    slots: &'a [Slot],
    /// See [`outside::Outside::first`].
    outside: &'a [u32],
    far: bool,
    scratch: &'a [Mutex<Scratch>],
    phase: usize,
    /// The traces that tiles have shown in the phases before.
    seen: &'a [Vec<F8>],
}

impl Step<'_> {
    /// Halves until a tile is left: nothing may be allocated.
    fn run(self, tiles: &mut [Tile], shown: &mut [Vec<F8>], out: Out) {
        match (tiles, shown) {
            ([tile], [shown]) => with_scratch(self.scratch, |scratch| {
                Pass { step: self, tile, shown, out, scratch }.run();
            }),
            (tiles, shown) if tiles.len() > 1 => {
                let half = tiles.len() / 2;
                let ((left, right), (shown, shown2)) = (tiles.split_at_mut(half), shown.split_at_mut(half));
                let (start, middle) = (left[0].plan.range.start, right[0].plan.range.start);
                let first = |block| self.scheme.histories.range(block).start;
                let entries = |block: usize| self.outside[block] as usize;
                let numbers = [first(middle) - first(start), entries(middle) - entries(start)];
                let stride = self.state.components * self.scheme.operators.nodes();
                let (one, two) = out.split(middle - start, stride, numbers);
                rayon::join(|| self.run(left, shown, one), || self.run(right, shown2, two));
            }
            _ => {}
        }
    }
}

impl Scheme {
    /// All stages of a step.
    pub(super) fn run_stages(&self, stages: &[Stage], state: &State, survey: &Survey, work: &mut Work) {
        let Work {
            tiles: Tiles { tiles, phases, shown, slots, far, .. }, next, speed, outside, balance, scratch, ..
        } = work;
        let (u, internal, balance) = (&mut next.u[..], &mut next.internal[..], balance.as_deref_mut());
        let mut out = Out { first: 0, u, internal, speed, given: &mut outside.given, balance };
        let count = tiles.len();
        for phase in 0..*phases {
            let (seen, shown) = shown.split_at_mut(phase * count);
            let outside = &outside.first[..];
            let step = Step { scheme: self, stages, state, survey, slots, outside, far: *far, scratch, phase, seen };
            step.run(tiles, &mut shown[..count], out.again());
        }
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
        lane::prefetch(std::slice::from_ref(&survey.speed[block].fastest));
        if let Some(points) = points {
            lane::prefetch(points.metric_of(block));
        }
    }

    /// Numbers of the traces of a block.
    fn block_traces(&self, metered: bool) -> usize {
        4 * self.operators.line.m * volume::width(self.flux.looks(), metered)
    }

    /// Bytes of the traces of all faces, without the balance.
    pub fn trace_bytes(&self) -> usize {
        self.operators.blocks.len() * self.block_traces(false) * size_of::<F8>()
    }
}
