//! The stages of a step on all blocks, by the plan of [`tiles`].

use super::balance::BlockBalance;
use super::begin::Begin;
use super::block::Block;
use super::creep::Creep;
use super::finish::{Finish, New};
use super::meetings::Meetings;
use super::outside::{self, ExternalWork, FaceForces, Torques};
use super::tile_memory::{Tile, Tiles};
use super::tiles::{Event, Slot};
use super::worst::Worst;
use super::{Scheme, Scratch, Speeds, Stage, Survey, Work, across, with_scratch};
use crate::built;
use crate::lane::{self, F8, ticks};
use crate::operators::Operators;
use crate::state::{Part, State};
use std::sync::Mutex;

/// So many blocks ahead memory is asked for.
const AHEAD: usize = 2;

/// A phase of a tile under way.
struct Pass<'a, B, F> {
    step: Step<'a, B, F>,
    tile: &'a mut Tile,
    /// The traces that it shows after this phase.
    shown: &'a mut [F8],
    /// What the step makes of the tile.
    out: Out<'a>,
    scratch: &'a mut Scratch,
}

impl<B: Fn(Begin), F: Fn(Finish)> Pass<'_, B, F> {
    // By itself in profiles: `make proof` counts what it does.
    #[inline(never)]
    fn run(mut self) {
        if self.step.phase == 0 {
            self.tile.worst = Worst::NONE;
        }
        let start = if self.step.shared { ticks() } else { 0 };
        for number in self.tile.plan.phases[self.step.phase].clone() {
            let event = self.tile.plan.events[number];
            if event.begins { self.begin(&event) } else { self.finish(&event) }
        }
        if self.step.shared {
            self.tile.busy += ticks().wrapping_sub(start);
        }
    }

    /// Begins a block in a stage. Never inlined, and what finishes it always is: else the compiler decides it anew where an effect is left
    /// out, and programs with and without it have other instructions in blocks that have none of it.
    #[inline(never)]
    fn begin(&mut self, event: &Event) {
        let Self { step, tile, shown, out, scratch } = self;
        let Step { scheme, stages, start: state, survey, slots, outside, far, .. } = *step;
        let (number, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        if let (0, Some(later)) = (stage.number, tile.plan.after(number, AHEAD)) {
            scheme.ask_for(state, later);
            if far {
                scheme.ask_for_more(survey, later);
            }
        }
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let (slot, numbers) = (slots[stage.number * blocks + number], scheme.block_traces(out.balance.is_some()));
        let traces = if slot.store == 0 { &mut tile.traces[..] } else { &mut shown[..] };
        let mut external = outside::entry(outside, out.first, out.external, number);
        let mut balance = out.balance.as_mut().and_then(|balance| balance.get_mut(number - out.first));
        if stage.number == 0 {
            external.iter_mut().for_each(|external| **external = ExternalWork::default());
            balance.iter_mut().for_each(|balance| **balance = BlockBalance::default());
            if let (true, Some(forces)) = (built::FORCES, out.forces.as_deref_mut()) {
                let own = outside::entry(outside, out.first, forces, number);
                own.into_iter().for_each(|forces| *forces = FaceForces::default());
            }
            if let Some(torques) = out.torques.as_deref_mut() {
                let own = outside::entry(outside, out.first, torques, number);
                own.into_iter().for_each(|torques| *torques = Torques::default());
            }
        }
        (step.begin)(Begin {
            block: Block { scheme, stage, number },
            later: tile.plan.after(number, 1),
            state,
            before,
            rate: &mut now[..stride],
            traces: &mut traces[1 + slot.index as usize * numbers..][..numbers],
            external,
            balance,
            worst: &mut tile.worst,
            scratch,
        });
    }

    fn finish(&mut self, event: &Event) {
        let Self { step, tile, shown, out, scratch } = self;
        let Step { scheme, stages, state, survey, slots, outside, seen, far, meetings, .. } = *step;
        let (number, stage) = (event.block as usize, &stages[usize::from(event.stage)]);
        let blocks = scheme.operators.blocks.len();
        let stride = state.components * scheme.operators.nodes();
        let rates = &mut tile.rates[event.rates as usize * stages.len() * stride..][..stages.len() * stride];
        let (before, now) = rates.split_at_mut(stage.number * stride);
        let is_last = stage.number + 1 == stages.len();
        if let (true, Some(later)) = (far && is_last, tile.plan.after(number, AHEAD)) {
            out.ask_for(later - out.first, [stride, scheme.creep_of_block()]);
        }
        let later = tile.plan.after(number, 1);
        if let (true, Some(later), Some(curl_free)) = (is_last, later, &scheme.operators.curl_free) {
            curl_free.ask_for(later);
        }
        let at = number - out.first;
        let new = is_last.then(|| {
            let (history, start) = (scheme.histories.range(number), scheme.histories.range(out.first).start);
            New {
                u: &mut out.u[at * stride..][..stride],
                internal: &mut out.internal[history.start - start..history.end - start],
                speed: &mut out.speed[at],
                worst: worst_of(out.worst, at, &mut tile.worst),
            }
        });
        let slots = &slots[stage.number * blocks..][..blocks];
        let external = outside::entry(outside, out.first, out.external, number);
        let forces = out.forces.as_deref_mut().filter(|_| built::FORCES);
        let forces = forces.and_then(|forces| outside::entry(outside, out.first, forces, number));
        let torques = out.torques.as_deref_mut();
        let torques = torques.and_then(|torques| outside::entry(outside, out.first, torques, number));
        let balance = out.balance.as_mut().and_then(|balance| balance.get_mut(at));
        let memory = (scheme.boundary_memory.range(number), scheme.boundary_memory.range(out.first).start);
        let memory = &mut out.memory[memory.0.start - memory.1..memory.0.end - memory.1];
        let count = scheme.creep_of_block();
        let after = out.creep.get_mut(count * at..count * (at + 1));
        let creep = after.map(|now| Creep { start: scheme.creep_of(state, number), now });
        (step.finish)(Finish {
            block: Block { scheme, stage, number },
            state,
            survey,
            before,
            rate: &mut now[..stride],
            traces: across::Traces { own: &tile.traces, seen, shown, slots },
            new,
            external,
            forces,
            torques,
            balance,
            memory,
            creep,
            meetings,
            scratch,
        });
    }
}

/// Where the survey of a block goes: to the worst of the block by itself, where that is kept, else to that of its tile.
#[inline]
fn worst_of<'a>(by_block: &'a mut [Worst], block: usize, tile: &'a mut Worst) -> &'a mut Worst {
    let Some(worst) = by_block.get_mut(block) else { return tile };
    *worst = Worst::NONE;
    worst
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
    /// The worst of each block, where corrections may change it; else nothing.
    worst: &'a mut [Worst],
    /// The work on those blocks that something outside acts on.
    external: &'a mut [ExternalWork],
    /// The forces there; none where nobody asks for them.
    forces: Option<&'a mut [FaceForces]>,
    /// The torques there; none where angular momentum is not kept.
    torques: Option<&'a mut [Torques]>,
    /// The balance of the blocks; none where it is off.
    balance: Option<&'a mut [BlockBalance]>,
    /// The memory of boundary conditions.
    memory: &'a mut [f64],
    /// The creep of faces; empty where they have no springs.
    creep: &'a mut [F8],
}

impl<'a> Out<'a> {
    /// Asks for what will be written of a block. (A store to a line that is not there waits as a load does.)
    #[inline]
    fn ask_for(&self, block: usize, [stride, creep]: [usize; 2]) {
        lane::prefetch(self.creep.get(creep * block..creep * (block + 1)).unwrap_or_default());
        if let Some(u) = self.u.get(stride * block..stride * (block + 1)) {
            lane::prefetch(u);
            lane::prefetch(std::slice::from_ref(&self.speed[block].fastest));
        }
    }

    /// The same for a shorter time.
    fn again(&mut self) -> Out<'_> {
        let Self { first, u, internal, speed, worst, external, forces, torques, balance, memory, creep } = self;
        let (forces, torques, balance) = (forces.as_deref_mut(), torques.as_deref_mut(), balance.as_deref_mut());
        Out { first: *first, u, internal, speed, worst, external, forces, torques, balance, memory, creep }
    }

    /// Those from a block on, of a state of these `components`; where it is a `part` it begins there.
    fn from(self, block: usize, scheme: &Scheme, (components, part): (usize, Part), outside: &[u32]) -> Self {
        let (history, memory) = (scheme.histories.range(block).start, scheme.boundary_memory.range(block).start);
        let before = block - part.block;
        let numbers = [components * scheme.operators.nodes(), scheme.creep_of_block()].map(|count| count * before);
        self.split(block, numbers, [history - part.internal, outside[block] as usize, memory]).1
    }

    /// Those of the first `blocks`, with so many unknowns and numbers of the creep, and with so many internal variables, entries of `external` and numbers of `memory`, and the rest.
    fn split(
        self,
        blocks: usize,
        [unknowns, creep]: [usize; 2],
        [internal, external, memory]: [usize; 3],
    ) -> (Self, Self) {
        let (first, second) = (self.first, self.first + blocks);
        let (u, u2) = self.u.split_at_mut(unknowns);
        let (internal, internal2) = self.internal.split_at_mut(internal);
        let (speed, speed2) = self.speed.split_at_mut(blocks);
        let (worst, worst2) = self.worst.split_at_mut(blocks.min(self.worst.len()));
        let (forces, forces2) = self.forces.map(|forces| forces.split_at_mut(external)).unzip();
        let (torques, torques2) = self.torques.map(|torques| torques.split_at_mut(external)).unzip();
        let (external, external2) = self.external.split_at_mut(external);
        let (balance, balance2) = self.balance.map(|balance| balance.split_at_mut(blocks)).unzip();
        let (memory, memory2) = self.memory.split_at_mut(memory);
        let (creep, creep2) = self.creep.split_at_mut(creep.min(self.creep.len()));
        let left = Out { first, u, internal, speed, worst, external, forces, torques, balance, memory, creep };
        let (first, u, internal, speed, memory, creep) = (second, u2, internal2, speed2, memory2, creep2);
        let (worst, external, forces, torques, balance) = (worst2, external2, forces2, torques2, balance2);
        (left, Out { first, u, internal, speed, worst, external, forces, torques, balance, memory, creep })
    }
}

/// A phase of a step under way.
#[derive(Clone, Copy)]
struct Step<'a, B, F> {
    /// What is done to begin and to finish a block.
    begin: B,
    finish: F,
    scheme: &'a Scheme,
    stages: &'a [Stage<'a>],
    state: &'a State,
    /// What blocks begin a stage with: the state, but where corrections have acted on the stage.
    start: &'a State,
    survey: &'a Survey,
    slots: &'a [Slot],
    /// See [`outside::Outside::first`].
    outside: &'a [u32],
    far: bool,
    /// Whether there are several tiles: what each of them takes is measured.
    shared: bool,
    meetings: Option<&'a Meetings>,
    scratch: &'a [Mutex<Scratch>],
    phase: usize,
    /// The traces that tiles have shown in the phases before.
    seen: &'a [Vec<F8>],
}

impl<B: Fn(Begin) + Copy + Send + Sync, F: Fn(Finish) + Copy + Send + Sync> Step<'_, B, F> {
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
                let memory = |block| self.scheme.boundary_memory.range(block).start;
                let memory = memory(middle) - memory(start);
                let numbers = [first(middle) - first(start), entries(middle) - entries(start), memory];
                let stride = self.state.components * self.scheme.operators.nodes();
                let unknowns = [stride, self.scheme.creep_of_block()].map(|count| count * (middle - start));
                let (one, two) = out.split(middle - start, unknowns, numbers);
                rayon::join(|| self.run(left, shown, one), || self.run(right, shown2, two));
            }
            _ => {}
        }
    }
}

impl Scheme {
    /// Begins and finishes all blocks in all stages of a step: a block finishes when its neighbours have begun.
    pub(super) fn on_all_blocks(
        &self,
        stages: &[Stage],
        (state, survey): (&State, &Survey),
        work: &mut Work,
        begin: impl Fn(Begin) + Copy + Send + Sync,
        finish: impl Fn(Finish) + Copy + Send + Sync,
    ) {
        let Work { tiles, next, speed, outside, balance, scratch, corrections, meetings, .. } = work;
        let Tiles { tiles, phases, shown, slots, overlaps, far, ranks, .. } = tiles;
        let held = (next.components, next.part);
        let (u, internal, balance) = (&mut next.u[..], &mut next.internal[..], balance.as_deref_mut());
        let (worst, mut starts) = match corrections.as_deref_mut() {
            Some(memory) => memory.parts(),
            None => (&mut [][..], None),
        };
        let (external, forces) = (&mut outside.entries[..], outside.forces.as_deref_mut());
        let torques = outside.torques.as_deref_mut();
        let memory = &mut next.boundary[..];
        memory.copy_from_slice(&state.boundary);
        let numbers = self.block_traces(balance.is_some());
        let creep = &mut next.creep[..];
        let mut out = Out { first: 0, u, internal, speed, worst, external, forces, torques, balance, memory, creep };
        let count = tiles.len();
        let own = ranks.as_ref().map_or(0..count, |ranks| ranks.tiles.clone());
        if let Some(first) = tiles[own.clone()].first().filter(|_| own.start > 0) {
            out = out.from(first.plan.range.start, self, held, &outside.first);
        }
        for phase in 0..*phases {
            let start = match &mut starts {
                // Stage by stage, see `Plan::by_stages`.
                Some(starts) if phase >= 2 && phase % 2 == 0 => {
                    starts.of(self, &stages[phase / 2], state, tiles, ranks.as_deref_mut())
                }
                _ => state,
            };
            let outside = &outside.first[..];
            let (scheme, far, shared, meetings) = (self, *far, count > 1, meetings.as_deref());
            let mut run = |shown: &mut [Vec<F8>]| {
                let (seen, showing) = shown.split_at_mut(phase * count);
                let step = Step {
                    begin,
                    finish,
                    scheme,
                    stages,
                    state,
                    start,
                    survey,
                    slots,
                    outside,
                    far,
                    shared,
                    meetings,
                    scratch,
                    phase,
                    seen,
                };
                step.run(&mut tiles[own.clone()], &mut showing[own.clone()], out.again());
            };
            match (ranks.as_deref_mut(), phase.checked_sub(1)) {
                // The last phase shows nothing to others: all of them end in it.
                (Some(ranks), Some(before)) if *overlaps => ranks.swap(before, shown, numbers, run),
                (ranks, _) => {
                    run(shown);
                    if let Some(ranks) = ranks.filter(|_| !*overlaps) {
                        ranks.swap(phase, shown, numbers, |_| {});
                    }
                }
            }
        }
    }

    /// Asks for what the stages of a block will read.
    #[inline]
    fn ask_for(&self, state: &State, block: usize) {
        lane::prefetch(state.of_block(block, self.operators.nodes()));
        lane::prefetch(&self.operators.geometry.blocks[block..=block]);
        if !state.creep.is_empty() {
            lane::prefetch(self.creep_of(state, block));
        }
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
}
