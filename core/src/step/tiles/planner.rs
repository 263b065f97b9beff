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
    /// By block, the number of stages that have begun, that had begun before this phase, that had begun before the phase before it, and
    /// that have finished.
    begun: Vec<usize>,
    seen: Vec<usize>,
    come: Vec<usize>,
    finished: Vec<usize>,
    /// Tiles of a rank.
    per_rank: usize,
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
    /// For tiles of these blocks, which are all blocks one after the other, so many tiles on each rank.
    pub fn new(graph: &'a [Vec<usize>], stages: usize, ranges: Vec<Range<usize>>, per_rank: usize) -> Self {
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
            come: vec![0; count],
            finished: vec![0; count],
            per_rank,
            shows: graph.iter().enumerate().map(shows).collect(),
            early: early(graph, stages, &tiles, per_rank),
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
        let overlaps = self.tiles.len() > self.per_rank;
        if overlaps {
            self.hide_messages();
        } else {
            for early in [true, false] {
                let mut begins = Some(Begins::all(early));
                while self.phase(begins.take()) {}
            }
        }
        for ((tile, rates), traces) in self.tiles.iter_mut().zip(&self.rates).zip(&self.traces) {
            (tile.rates, tile.traces) = (rates.count as usize, traces.count as usize);
        }
        Plan { tiles: self.tiles, slots: self.slots, shown: self.shown, overlaps }
    }

    /// What ranks show each other in a phase travels during the next one. So phases at the seams of ranks, each of which goes on by a stage,
    /// take turns with phases in which a part of the other blocks begins.
    fn hide_messages(&mut self) {
        self.note_phase(Some(Begins::all(true)));
        for part in 0..self.stages {
            self.note_phase(Some(Begins { early: false, part, parts: self.stages }));
            self.note_phase(None);
        }
        while self.finished.iter().any(|stages| *stages < self.stages) {
            self.note_phase(None);
        }
    }

    /// All that can be done without what others do meanwhile, of blocks that begin now, and of those that have begun. No phase where that
    /// is nothing.
    fn phase(&mut self, begins: Option<Begins>) -> bool {
        let is_some = self.note_phase(begins);
        if !is_some {
            self.shown.truncate(self.shown.len() - self.tiles.len());
            self.tiles.iter_mut().for_each(|tile| tile.phases.truncate(tile.phases.len().saturating_sub(1)));
        }
        is_some
    }

    /// The same, where a phase may be empty. Whether it has an event.
    fn note_phase(&mut self, begins: Option<Begins>) -> bool {
        self.come.clone_from(&self.seen);
        self.seen.clone_from(&self.begun);
        let shown = self.shown.len();
        self.shown.resize(shown + self.tiles.len(), 0);
        let mut is_some = false;
        for tile in 0..self.tiles.len() {
            let first = self.tiles[tile].events.len();
            for (at, block) in self.tiles[tile].blocks().enumerate() {
                match self.begun[block] {
                    0 if begins
                        .is_some_and(|begins| begins.has(self.early[block], at, self.tiles[tile].range.len())) =>
                    {
                        self.advance(block);
                    }
                    0 => {}
                    begun => self.follow(begun - 1, block),
                }
            }
            let events = first..self.tiles[tile].events.len();
            is_some |= !events.is_empty();
            self.tiles[tile].phases.push(events);
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
            let [own, other] = [self.tile[block], self.tile[near]];
            let begun = match own == other {
                true => &self.begun,
                false if own / self.per_rank == other / self.per_rank => &self.seen,
                false => &self.come,
            };
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

/// Which blocks of each tile begin in a phase: the early ones or the others, all of them or one part.
#[derive(Clone, Copy)]
struct Begins {
    /// Whether it is the early ones.
    early: bool,
    /// The number of the part, from 0.
    part: usize,
    /// How many parts there are.
    parts: usize,
}

impl Begins {
    fn all(early: bool) -> Self {
        Self { early, part: 0, parts: 1 }
    }

    /// Whether a block is among them that is number `at` of so many of its tile.
    fn has(self, early: bool, at: usize, blocks: usize) -> bool {
        self.early == early && self.parts * at / blocks == self.part
    }
}

/// By block, whether it is one of as many layers as all stages need at a seam where both tiles begin, or at one of two ranks.
fn early(graph: &[Vec<usize>], stages: usize, tiles: &[Tile], per_rank: usize) -> Vec<bool> {
    let (mut tile, mut begins) = (vec![0; graph.len()], vec![false; graph.len()]);
    for (number, one) in tiles.iter().enumerate() {
        let half = one.range.len().div_ceil(2);
        one.blocks().enumerate().for_each(|(at, block)| (tile[block], begins[block]) = (number, at < half));
    }
    let meets = |block: usize| {
        graph[block].iter().any(|&near| {
            let is_far = tile[near] / per_rank != tile[block] / per_rank;
            tile[near] != tile[block] && (is_far || begins[block] && begins[near])
        })
    };
    let mut early: Vec<bool> = (0..graph.len()).map(meets).collect();
    for _ in 0..stages {
        let touches = |(block, near): (usize, &Vec<usize>)| near.iter().any(|&n| early[n] && tile[n] == tile[block]);
        early = graph.iter().enumerate().map(touches).collect();
    }
    early
}
