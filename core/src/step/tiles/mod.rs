//! In which order the blocks of a step are begun and finished, and where their rates and traces lie meanwhile.
//!
//! A step is one pass over memory: `finish` follows `begin` as closely as neighbours allow, each stage follows the one
//! before it, and rates and traces live in a few slots that are used again as soon as nobody needs what they hold, so
//! that they stay in the cache. With several threads each has a tile of blocks, and first does all of it that needs nothing
//! from beyond it: a layer of blocks less with each stage. Then, in a phase for each stage, they show each other the traces
//! at the borders of the tiles, and each goes on as far as these reach. (Twice so, at the seams where two tiles begin and at
//! those where they end: what waits at them would leave the cache meanwhile.) Traces that go to another rank need a phase to get there,
//! in which each does other blocks. Nothing is done twice, nothing but these traces goes
//! from one processor to another, and the bits do not depend on it.

mod division;
mod planner;

use crate::lane::LANES;
use crate::mesh::FACES;
use crate::operators::{Blocks, Neighbour};
use division::divide;
use planner::Planner;
use std::ops::Range;

/// A place for the traces of a block in one stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Slot {
    /// 0: that of the tile, for none but itself; 1 + phase x tiles + tile: what the tile shows from that phase on.
    pub store: u32,
    /// The place in it.
    pub index: u32,
}

/// What is done next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Event {
    /// The block.
    pub block: u32,
    /// The slot of its rates.
    pub rates: u32,
    /// The stage.
    pub stage: u8,
    /// Whether it begins; else it finishes.
    pub begins: bool,
}

/// What one thread does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tile {
    /// In their order.
    pub events: Vec<Event>,
    /// Which of them are done in each phase.
    pub phases: Vec<Range<usize>>,
    /// Slots of the rates of a block in all stages.
    pub rates: usize,
    /// Slots of the traces of a block in one stage that no other tile reads.
    pub traces: usize,
    /// Its blocks.
    pub range: Range<usize>,
    /// Whether they are begun from the last to the first: tiles side by side begin, or end, where they touch each other.
    pub falls: bool,
}

impl Tile {
    /// Its blocks in the order in which they are begun.
    fn blocks(&self) -> impl Iterator<Item = usize> + use<> {
        let (Range { start, end }, falls) = (self.range.clone(), self.falls);
        self.range.clone().map(move |block| if falls { start + end - 1 - block } else { block })
    }

    /// The block that is begun so many after another; none where that is not in the tile.
    #[inline]
    pub fn after(&self, block: usize, count: usize) -> Option<usize> {
        let after = if self.falls { block.checked_sub(count)? } else { block + count };
        self.range.contains(&after).then_some(after)
    }
}

/// The events of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// One after the other to the blocks' end.
    pub tiles: Vec<Tile>,
    /// The slots of the traces of each block: [stage][block].
    pub slots: Vec<Slot>,
    /// Slots of the traces that each tile shows: [phase][tile].
    pub shown: Vec<usize>,
    /// Whether what a tile shows in a phase reaches other ranks after the next phase, during which it travels; else at once.
    pub overlaps: bool,
}

/// Events in the time of which threads meet.
const MEETING: u128 = 16;

impl Plan {
    /// A plan for as many tiles of nearly equal weight, up to `threads`, as make the longest way through the step shorter by a
    /// quarter at least: threads that wait for each other are other people's time. `weights` are those of the blocks.
    pub fn new(graph: &[Vec<usize>], weights: &[u64], stages: usize, threads: usize) -> Self {
        let mut best = Self::of_tiles(graph, weights, stages, 1);
        let mut tiles = threads;
        while tiles > 1 {
            let found = Self::of_tiles(graph, weights, stages, tiles);
            if 4 * found.longest(weights) < 3 * best.longest(weights) {
                best = found;
            }
            tiles /= 2;
        }
        best
    }

    /// A plan for so many tiles of nearly equal weight; for one a block where there are fewer blocks.
    pub fn of_tiles(graph: &[Vec<usize>], weights: &[u64], stages: usize, tiles: usize) -> Self {
        Self::of_ranks(graph, weights, stages, [1, tiles])
    }

    /// A plan for so many tiles of nearly equal weight on each of some ranks, `[ranks, tiles]`.
    pub fn of_ranks(graph: &[Vec<usize>], weights: &[u64], stages: usize, [ranks, tiles]: [usize; 2]) -> Self {
        Planner::new(graph, stages, divide(weights, ranks * tiles), tiles).plan()
    }

    /// A plan for parts, each of a rank, that begin at `first`, each of so many tiles of nearly equal weight and of at least as many blocks.
    pub fn of_parts(graph: &[Vec<usize>], weights: &[u64], stages: usize, first: &[usize], tiles: usize) -> Self {
        let part = |ends: &[usize]| {
            let shift = move |run: Range<usize>| run.start + ends[0]..run.end + ends[0];
            divide(&weights[ends[0]..ends[1]], tiles).into_iter().map(shift).collect::<Vec<_>>()
        };
        Planner::new(graph, stages, first.windows(2).flat_map(part).collect(), tiles).plan()
    }

    /// The same tiles stage by stage: all blocks begin a stage in one phase, and finish it in the next one.
    pub fn by_stages(mut self, stages: usize) -> Self {
        let (tiles, blocks) = (self.tiles.len(), self.tiles.last().map_or(0, |tile| tile.range.end));
        self.slots = vec![Slot::default(); stages * blocks];
        self.shown = vec![0; 2 * stages * tiles];
        self.overlaps = false;
        for (number, tile) in self.tiles.iter_mut().enumerate() {
            let range = tile.range.clone();
            *tile = Tile { events: vec![], phases: vec![], rates: range.len(), traces: 0, range, falls: false };
            for phase in 0..2 * stages {
                let (stage, begins) = (phase / 2, phase % 2 == 0);
                let store = phase * tiles + number;
                let first = tile.events.len();
                for (index, block) in tile.range.clone().enumerate() {
                    let (index, block32) = (index as u32, block as u32);
                    tile.events.push(Event { block: block32, rates: index, stage: stage as u8, begins });
                    if begins {
                        self.slots[stage * blocks + block] = Slot { store: 1 + store as u32, index };
                        self.shown[store] += 1;
                    }
                }
                tile.phases.push(first..tile.events.len());
            }
        }
        self
    }

    /// The number of phases.
    pub fn phases(&self) -> usize {
        self.tiles.first().map_or(0, |tile| tile.phases.len())
    }

    /// The weight of events that follow each other, all events of a block being equal; a meeting is as long as [`MEETING`] events of
    /// the mean block.
    fn longest(&self, weights: &[u64]) -> u128 {
        let weight = |events: &[Event]| events.iter().map(|event| u128::from(weights[event.block as usize])).sum();
        let longest = |phase: usize| -> u128 {
            self.tiles.iter().map(|tile| weight(&tile.events[tile.phases[phase].clone()])).max().unwrap_or(0)
        };
        let all: u128 = weights.iter().map(|weight| u128::from(*weight)).sum();
        let meeting = MEETING * all / (weights.len() as u128).max(1);
        (0..self.phases()).map(|phase| longest(phase) + meeting).sum()
    }
}

/// For each block the blocks that touch it, ascending, itself among them.
pub fn graph(blocks: &Blocks) -> Vec<Vec<usize>> {
    let around = |(block, neighbours): (usize, &[[Neighbour; LANES]; FACES])| {
        let linked = neighbours.iter().flatten().filter_map(|neighbour| match neighbour {
            Neighbour::Cell(across) | Neighbour::Interface(across, _) => Some(across.face / FACES),
            Neighbour::Boundary(_) | Neighbour::Padding => None,
        });
        let mut all: Vec<usize> = linked.chain([block]).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    blocks.neighbours.iter().enumerate().map(around).collect()
}

#[cfg(test)]
mod tests;
