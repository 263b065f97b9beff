//! The stages of a step on all blocks, by the plan of [`tiles`].

use super::out::Out;
use super::survey::Worst;
use super::tiles::{self, Event, Piece, STORES, Slot, TILES};
use super::{Scheme, Scratch, Stage, Survey, Work, begin, finish, flux, volume, with_scratch};
use crate::lane::{self, F8};
use crate::operators::Operators;
use crate::state::State;
use std::mem::swap;
use std::ops::Range;
use std::sync::Mutex;

/// A pass with its memory.
pub(super) struct Pass {
    plan: tiles::Pass,
    /// By store, dU/dt: [slot][stage][component][node].
    rates: [Vec<F8>; STORES],
    /// By store, see [`flux::Traces`], with [`volume::width`] numbers a point.
    traces: [Vec<F8>; STORES],
    /// The worst of the blocks of which it made the new state in the last step.
    worst: Worst,
}

impl Pass {
    /// With so many numbers of the rates and of the traces of a block.
    fn new(plan: tiles::Pass, rates: usize, traces: usize) -> Self {
        Self {
            rates: plan.rates.map(|slots| vec![F8::ZERO; slots * rates]),
            traces: plan.traces.map(|slots| vec![F8::ZERO; slots * traces + 2]),
            worst: Worst::NONE,
            plan,
        }
    }
}

/// All passes of a step.
pub(super) struct Passes {
    /// One after the other to the blocks' end.
    tiles: Vec<Pass>,
    ranges: Vec<Range<usize>>,
    seams: Vec<Pass>,
    pieces: Vec<Piece>,
    /// The slot of the traces of each block: [stage][block].
    slots: Vec<Slot>,
    /// Whether the unknowns come from memory, see [`FAR`].
    far: bool,
}

impl Passes {
    /// For states with `stride` numbers a block, on the current number of threads.
    pub fn new(scheme: &Scheme, stride: usize) -> Self {
        let (stages, blocks) = (scheme.stages(), &scheme.operators.blocks);
        let threads = rayon::current_num_threads().max(1);
        let tiles::Plan { tiles, seams, ranges, pieces, slots } =
            tiles::Plan::new(&tiles::graph(blocks), stages, threads);
        let numbers = scheme.block_traces(false);
        let with_memory =
            |plans: Vec<tiles::Pass>| plans.into_iter().map(|plan| Pass::new(plan, stages * stride, numbers)).collect();
        let far = blocks.len() * stride * size_of::<F8>() > FAR;
        Self { tiles: with_memory(tiles), seams: with_memory(seams), ranges, pieces, slots, far }
    }

    /// Makes room for the numbers that the balance of energy needs.
    pub fn widen(&mut self, scheme: &Scheme) {
        for pass in self.tiles.iter_mut().chain(&mut self.seams) {
            for (traces, slots) in pass.traces.iter_mut().zip(pass.plan.traces) {
                traces.resize(slots * scheme.block_traces(true) + 2, F8::ZERO);
            }
        }
    }

    /// The worst of all blocks after the last step.
    pub fn worst(&self) -> Worst {
        self.tiles.iter().chain(&self.seams).fold(Worst::NONE, |worst, pass| worst.and(pass.worst))
    }

    /// Numbers of eight lanes held.
    pub fn numbers(&self) -> usize {
        let of = |pass: &Pass| pass.rates.iter().chain(&pass.traces).map(Vec::len).sum::<usize>();
        self.tiles.iter().chain(&self.seams).map(of).sum()
    }
}

/// Bytes of unknowns beyond which they come from memory, not from the last cache. There the step asks for all that it will
/// read and write (5 to 9 % of it), elsewhere for the unknowns and the metric only.
const FAR: usize = 4 << 20;

/// So many blocks ahead memory is asked for.
const AHEAD: usize = 2;

/// What a pass makes, see [`Out`]: of a tile all in one, of a seam by the store of its pieces.
type Outs<'a> = [Out<'a>; STORES];

/// A pass under way.
struct Run<'a> {
    step: Step<'a>,
    pass: &'a mut Pass,
    outs: Outs<'a>,
    /// Which of them is meant by the number of a store: of a tile always the first.
    mask: usize,
    scratch: &'a mut Scratch,
}

impl Run<'_> {
    fn run(mut self) {
        self.pass.worst = Worst::NONE;
        for number in 0..self.pass.plan.events.len() {
            let event = self.pass.plan.events[number];
            if event.begins { self.begin(&event) } else { self.finish(&event) }
        }
    }

    fn begin(&mut self, event: &Event) {
        let Self { step, pass, outs, mask, scratch } = self;
        let Step { scheme, stages, state, survey, slots, far, .. } = *step;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        if stage.number == 0 && block + AHEAD < blocks {
            scheme.ask_for(state, block + AHEAD);
            if far {
                scheme.ask_for_more(survey, block + AHEAD);
            }
        }
        let stride = state.components * scheme.operators.nodes();
        let rates = rates_of(&mut pass.rates, event.rates, stages.len() * stride);
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let out = &mut outs[event.rates.store() & *mask];
        let (slot, numbers) = (slots[stage.number * blocks + block], scheme.block_traces(out.balance.is_some()));
        let work = begin::Block {
            scheme,
            stage,
            block,
            state,
            before,
            rate: &mut now[..stride],
            traces: &mut pass.traces[slot.store()][1 + slot.index() * numbers..][..numbers],
            sums: out.sums(block),
            scratch,
        };
        work.run();
    }

    fn finish(&mut self, event: &Event) {
        let Self { step, pass, outs, mask, scratch } = self;
        let Step { scheme, stages, state, survey, slots, far, .. } = *step;
        let (block, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        let stride = state.components * scheme.operators.nodes();
        let rates = rates_of(&mut pass.rates, event.rates, stages.len() * stride);
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let out = &mut outs[event.rates.store() & *mask];
        let is_last = stage.number + 1 == stages.len();
        if far && is_last {
            out.ask_for(block + AHEAD, stride);
        }
        let at = block - out.first;
        let new = is_last.then(|| {
            let (history, start) = (scheme.histories.range(block), scheme.histories.before(out.first));
            finish::New {
                u: &mut out.u[at * stride..][..stride],
                internal: &mut out.internal[history.start - start..history.end - start],
                speed: &mut out.speed[at],
                worst: &mut pass.worst,
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
            traces: flux::Traces { all: &pass.traces, slots: &slots[stage.number * blocks..][..blocks] },
            new,
            sums: out.balance.as_mut().and_then(|sums| sums.get_mut(at)),
            scratch,
        };
        work.run();
    }
}

/// The rates of a block, of which each has so many numbers.
#[inline]
fn rates_of(stores: &mut [Vec<F8>; STORES], slot: Slot, numbers: usize) -> &mut [F8] {
    &mut stores[slot.store()][slot.index() * numbers..][..numbers]
}

/// A step under way.
#[derive(Clone, Copy)]
struct Step<'a> {
    scheme: &'a Scheme,
    stages: &'a [Stage<'a>],
    state: &'a State,
    survey: &'a Survey,
    slots: &'a [Slot],
    far: bool,
    scratch: &'a [Mutex<Scratch>],
}

impl Step<'_> {
    fn pass(self, pass: &mut Pass, outs: Outs, mask: usize) {
        with_scratch(self.scratch, |scratch| Run { step: self, pass, outs, mask, scratch }.run());
    }

    /// The first phase. Halves until a tile is left: nothing may be allocated.
    fn tiles(self, tiles: &mut [Pass], ranges: &[Range<usize>], out: Out) {
        match tiles {
            [] => {}
            [tile] => self.pass(tile, [out, Out::default(), Out::default(), Out::default()], 0),
            _ => {
                let half = tiles.len() / 2;
                let (left, right) = tiles.split_at_mut(half);
                let (one, two) = out.split(ranges[half].start, &self.scheme.histories);
                rayon::join(|| self.tiles(left, &ranges[..half], one), || self.tiles(right, &ranges[half..], two));
            }
        }
    }

    /// The second phase, with what each seam makes.
    fn seams(self, seams: &mut [Pass], outs: &mut [Outs]) {
        match (seams, outs) {
            ([seam], [outs, ..]) => self.pass(seam, std::mem::take(outs), STORES - 1),
            (seams, outs) if seams.len() > 1 => {
                let half = seams.len() / 2;
                let ((left, right), (one, two)) = (seams.split_at_mut(half), outs.split_at_mut(half));
                rayon::join(|| self.seams(left, one), || self.seams(right, two));
            }
            _ => {}
        }
    }
}

/// Hands what is under way of the pieces from tiles to seams, or back.
fn hand_over(pieces: &[Piece], tiles: &mut [Pass], seams: &mut [Pass]) {
    for &Piece { tile, seam, store, .. } in pieces {
        let (tile, seam) = (&mut tiles[tile], &mut seams[seam]);
        swap(&mut tile.rates[store], &mut seam.rates[store]);
        swap(&mut tile.traces[store], &mut seam.traces[store]);
    }
}

/// Hands out what each of the seams makes.
fn hand_out<'a>(pieces: &[Piece], mut rest: Out<'a>, scheme: &Scheme) -> [Outs<'a>; TILES] {
    let mut outs: [Outs; TILES] = std::array::from_fn(|_| Outs::default());
    for Piece { seam, store, range, .. } in pieces {
        let (_, from) = rest.split(range.start, &scheme.histories);
        (outs[*seam][*store], rest) = from.split(range.end, &scheme.histories);
    }
    outs
}

impl Scheme {
    /// All stages of a step.
    pub(super) fn run_stages(&self, stages: &[Stage], state: &State, survey: &Survey, work: &mut Work) {
        let Work { passes, next, speed, balance, scratch, .. } = work;
        let Passes { tiles, ranges, seams, pieces, slots, far } = passes;
        let (u, internal) = (&mut next.u[..], &mut next.internal[..]);
        let mut out = Out { first: 0, u, internal, speed, balance: balance.as_deref_mut() };
        let step = Step { scheme: self, stages, state, survey, slots, far: *far, scratch };
        step.tiles(tiles, ranges, out.again());
        if !seams.is_empty() {
            hand_over(pieces, tiles, seams);
            step.seams(seams, &mut hand_out(pieces, out, self));
            hand_over(pieces, tiles, seams);
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
