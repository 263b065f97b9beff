//! A plan under way.

use super::{Event, Plan, Slot, Tile};
use std::ops::Range;

/// Slots that are free; the one that was used last is taken first, while it is in the cache.
#[derive(Default)]
struct Slots {
    free: Vec<u32>,
    count: u32,
}

impl Slots {
    fn take(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        })
    }
}

/// Plays a step, and notes what happens.
pub struct Planner<'a> {
    graph: &'a [Vec<usize>],
    stages: usize,
    /// By block, the number of stages that have begun, that had begun before this phase, and that have finished.
    begun: Vec<usize>,
    seen: Vec<usize>,
    finished: Vec<usize>,
    /// By block, its tile, whether another one reads its traces, and whether it is begun before others are.
    tile: Vec<usize>,
    shows: Vec<bool>,
    early: Vec<bool>,
    /// By stage and block, how many have still to read the traces, and their slot.
    readers: Vec<u32>,
    slots: Vec<Slot>,
    /// By block, the slot of its rates.
    rate: Vec<u32>,
    /// By tile.
    tiles: Vec<Tile>,
    rates: Vec<Slots>,
    traces: Vec<Slots>,
    /// By phase and tile.
    shown: Vec<usize>,
}

impl<'a> Planner<'a> {
    /// For tiles of these blocks, which are all blocks one after the other.
    pub fn new(graph: &'a [Vec<usize>], stages: usize, ranges: Vec<Range<usize>>) -> Self {
        let count = graph.len();
        let mut tile = vec![0; count];
        ranges.iter().enumerate().for_each(|(number, range)| tile[range.clone()].fill(number));
        let tile_of = |(number, range): (usize, Range<usize>)| Tile {
            events: vec![],
            phases: vec![],
            rates: 0,
            traces: 0,
            range,
            falls: number % 2 == 1,
        };
        let tiles: Vec<Tile> = ranges.into_iter().enumerate().map(tile_of).collect();
        let slots = || tiles.iter().map(|_| Slots::default()).collect();
        let shows = |(block, near): (usize, &Vec<usize>)| near.iter().any(|&near| tile[near] != tile[block]);
        Self {
            graph,
            stages,
            begun: vec![0; count],
            seen: vec![0; count],
            finished: vec![0; count],
            shows: graph.iter().enumerate().map(shows).collect(),
            early: early(graph, stages, &tiles),
            readers: graph.iter().map(|near| near.len() as u32).collect::<Vec<_>>().repeat(stages),
            slots: vec![Slot::default(); stages * count],
            rate: vec![0; count],
            rates: slots(),
            traces: slots(),
            shown: vec![],
            tile,
            tiles,
        }
    }

    /// Phase by phase until all is done: first at the seams where tiles begin, then on to those where they end. What waits
    /// there for the next phase is still in the cache.
    pub fn plan(mut self) -> Plan {
        for early in [true, false] {
            let mut begins = Some(early);
            while self.phase(begins.take()) {}
        }
        for ((tile, rates), traces) in self.tiles.iter_mut().zip(&self.rates).zip(&self.traces) {
            (tile.rates, tile.traces) = (rates.count as usize, traces.count as usize);
        }
        Plan { tiles: self.tiles, slots: self.slots, shown: self.shown }
    }

    /// All that can be done without what others do meanwhile, of early or other blocks that begin now, and of those that have
    /// begun. No phase where that is nothing.
    fn phase(&mut self, begins: Option<bool>) -> bool {
        self.seen.clone_from(&self.begun);
        let shown = self.shown.len();
        self.shown.resize(shown + self.tiles.len(), 0);
        let mut is_some = false;
        for tile in 0..self.tiles.len() {
            let first = self.tiles[tile].events.len();
            for block in self.tiles[tile].blocks() {
                match self.begun[block] {
                    0 if begins == Some(self.early[block]) => self.advance(block),
                    0 => {}
                    begun => self.follow(begun - 1, block),
                }
            }
            let events = first..self.tiles[tile].events.len();
            is_some |= !events.is_empty();
            self.tiles[tile].phases.push(events);
        }
        if !is_some {
            self.shown.truncate(shown);
            self.tiles.iter_mut().for_each(|tile| tile.phases.truncate(tile.phases.len().saturating_sub(1)));
        }
        is_some
    }

    /// Begins the next stage of a block, finishes it for all blocks of the tile that have waited for that, and begins the
    /// next stage of each of them, while what it needs is in the cache.
    fn advance(&mut self, block: usize) {
        let stage = self.begun[block];
        self.begin(stage, block);
        let graph = self.graph;
        for &near in &graph[block] {
            if self.tile[near] == self.tile[block] {
                self.follow(stage, near);
            }
        }
    }

    /// Finishes a stage of a block, if it waits for nothing but that, and goes on with it.
    fn follow(&mut self, stage: usize, block: usize) {
        let ready = |&near: &usize| {
            let begun = if self.tile[near] == self.tile[block] { &self.begun } else { &self.seen };
            begun[near] > stage
        };
        if self.finished[block] == stage && self.graph[block].iter().all(ready) {
            self.finish(stage, block);
            if stage + 1 < self.stages {
                self.advance(block);
            }
        }
    }

    fn begin(&mut self, stage: usize, block: usize) {
        let tile = self.tile[block];
        if stage == 0 {
            self.rate[block] = self.rates[tile].take();
        }
        self.begun[block] = stage + 1;
        self.slots[stage * self.graph.len() + block] = if self.shows[block] {
            let at = self.shown.len() - self.tiles.len() + tile;
            self.shown[at] += 1;
            Slot { store: 1 + at as u32, index: self.shown[at] as u32 - 1 }
        } else {
            Slot { store: 0, index: self.traces[tile].take() }
        };
        self.note(stage, block, true);
    }

    fn finish(&mut self, stage: usize, block: usize) {
        let tile = self.tile[block];
        self.finished[block] = stage + 1;
        self.note(stage, block, false);
        if stage + 1 == self.stages {
            self.rates[tile].free.push(self.rate[block]);
        }
        for &near in &self.graph[block] {
            let at = stage * self.graph.len() + near;
            self.readers[at] -= 1;
            if self.readers[at] == 0 && self.slots[at].store == 0 {
                self.traces[tile].free.push(self.slots[at].index);
            }
        }
    }

    fn note(&mut self, stage: usize, block: usize, begins: bool) {
        let event = Event { block: block as u32, rates: self.rate[block], stage: stage as u8, begins };
        self.tiles[self.tile[block]].events.push(event);
    }
}

/// By block, whether it is one of as many layers as all stages need at a seam where both tiles begin.
fn early(graph: &[Vec<usize>], stages: usize, tiles: &[Tile]) -> Vec<bool> {
    let (mut tile, mut begins) = (vec![0; graph.len()], vec![false; graph.len()]);
    for (number, one) in tiles.iter().enumerate() {
        let half = one.range.len().div_ceil(2);
        one.blocks().enumerate().for_each(|(at, block)| (tile[block], begins[block]) = (number, at < half));
    }
    let meets = |block: usize| graph[block].iter().any(|&near| tile[near] != tile[block] && begins[near]);
    let mut early: Vec<bool> = (0..graph.len()).map(|block| begins[block] && meets(block)).collect();
    for _ in 0..stages {
        let touches = |(block, near): (usize, &Vec<usize>)| near.iter().any(|&n| early[n] && tile[n] == tile[block]);
        early = graph.iter().enumerate().map(touches).collect();
    }
    early
}
