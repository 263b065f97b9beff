//! In which order the blocks of a step are begun and finished, and where their rates and traces lie meanwhile.
//!
//! A step is one pass over memory: `finish` follows `begin` as closely as neighbours allow, each stage follows the one
//! before it, and rates and traces live in a few slots that are used again as soon as nobody needs what they hold, so
//! that they stay in the cache. With several threads each works on a tile of blocks and, once more, on the blocks around
//! it, as many layers as there are stages: nobody waits for anybody within a step. The bits do not depend on it.

use super::Stage;
use crate::operators::{Blocks, Neighbour};
use std::ops::Range;

/// What is done next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Event {
    /// The block.
    pub block: u32,
    /// The slot of its rates.
    pub rates: u32,
    /// The slot of its traces at this stage, where it begins; where it finishes, none.
    pub traces: Option<u32>,
    /// The stage.
    pub stage: u8,
}

/// The events of a step on a tile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// In their order.
    pub events: Vec<Event>,
    /// Slots of the rates of a block in all stages.
    pub rates: usize,
    /// Slots of the traces of a block in one stage.
    pub traces: usize,
    /// The blocks whose new state it makes.
    pub range: Range<usize>,
}

/// For each block the blocks that touch it, ascending, itself among them.
pub fn graph(blocks: &Blocks) -> Vec<Vec<usize>> {
    let around = |(block, neighbours): (usize, &[[Neighbour; 8]; 4])| {
        let linked = neighbours.iter().flatten().filter_map(|neighbour| match neighbour {
            Neighbour::Cell(across) | Neighbour::Interface(across, _) => Some(across.face / 4),
            Neighbour::Boundary(_) | Neighbour::Padding => None,
        });
        let mut all: Vec<usize> = linked.chain([block]).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    blocks.neighbours.iter().enumerate().map(around).collect()
}

/// Plans of as many tiles of equal size, up to `threads`, as make the longest of them shorter by a quarter at least: what
/// several tiles do more than once is other people's time.
pub fn plans(graph: &[Vec<usize>], stages: usize, threads: usize) -> Vec<Plan> {
    let cut = |tiles: usize| {
        let size = graph.len().div_ceil(tiles).max(1);
        let ranges = (0..graph.len()).step_by(size).map(|first| first..graph.len().min(first + size));
        ranges.map(|range| Plan::new(graph, stages, range)).collect::<Vec<_>>()
    };
    let longest = |plans: &[Plan]| plans.iter().map(|plan| plan.events.len()).max().unwrap_or(0);
    let mut best = cut(1);
    let mut tiles = threads;
    while tiles > 1 {
        let found = cut(tiles);
        if 4 * longest(&found) < 3 * longest(&best) {
            best = found;
        }
        tiles /= 2;
    }
    best
}

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

/// A plan under way.
struct Planner<'a> {
    graph: &'a [Vec<usize>],
    stages: usize,
    /// Layers between a block and the tile; `stages + 1` and more are left out.
    distance: Vec<usize>,
    /// By block, the number of stages that have begun and that have finished.
    begun: Vec<usize>,
    finished: Vec<usize>,
    /// By stage and block, how many have still to read the traces, and their slot.
    readers: Vec<Vec<u32>>,
    slot: Vec<Vec<u32>>,
    rate: Vec<u32>,
    rates: Slots,
    traces: Slots,
    events: Vec<Event>,
}

impl Planner<'_> {
    /// Stages that a block finishes: all in the tile, one less with each layer.
    fn finishes(&self, block: usize) -> usize {
        self.stages.saturating_sub(self.distance[block])
    }

    /// Stages that it begins: those that a neighbour or itself finishes.
    fn begins(&self, block: usize) -> usize {
        (self.stages + 1).saturating_sub(self.distance[block]).min(self.stages)
    }

    /// Begins a stage of a block, finishes it for all blocks that have waited for that, and begins the next stage of each of
    /// them, while what it needs is in the cache.
    fn advance(&mut self, stage: usize, block: usize) {
        self.begin(stage, block);
        let graph = self.graph;
        for &near in &graph[block] {
            let waits = self.finished[near] == stage && stage < self.finishes(near);
            if waits && graph[near].iter().all(|&other| self.begun[other] > stage) {
                self.finish(stage, near);
                if stage + 1 < self.begins(near) {
                    self.advance(stage + 1, near);
                }
            }
        }
    }

    fn begin(&mut self, stage: usize, block: usize) {
        if stage == 0 {
            self.rate[block] = self.rates.take();
        }
        let slot = self.traces.take();
        self.slot[stage][block] = slot;
        self.readers[stage][block] =
            self.graph[block].iter().filter(|&&other| stage < self.finishes(other)).count() as u32;
        self.begun[block] = stage + 1;
        let (block32, rates) = (block as u32, self.rate[block]);
        self.events.push(Event { block: block32, rates, traces: Some(slot), stage: stage as u8 });
        // Outside the tile the last that is asked of a block are its traces.
        if self.finishes(block) < self.begins(block) && stage + 1 == self.begins(block) {
            self.rates.free.push(rates);
        }
    }

    fn finish(&mut self, stage: usize, block: usize) {
        self.finished[block] = stage + 1;
        let rates = self.rate[block];
        self.events.push(Event { block: block as u32, rates, traces: None, stage: stage as u8 });
        if stage + 1 == self.stages {
            self.rates.free.push(rates);
        }
        for &near in &self.graph[block] {
            self.readers[stage][near] -= 1;
            if self.readers[stage][near] == 0 {
                self.traces.free.push(self.slot[stage][near]);
            }
        }
    }
}

impl Plan {
    /// The plan of the tile `range`.
    pub fn new(graph: &[Vec<usize>], stages: usize, range: Range<usize>) -> Self {
        let count = graph.len();
        let distance = distances(graph, stages, range.clone());
        let list: Vec<usize> = (0..count).filter(|&block| distance[block] <= stages).collect();
        let by_stage = || vec![vec![0; count]; stages];
        let mut planner = Planner {
            graph,
            stages,
            distance,
            begun: vec![0; count],
            finished: vec![0; count],
            readers: by_stage(),
            slot: by_stage(),
            rate: vec![0; count],
            rates: Slots::default(),
            traces: Slots::default(),
            events: Vec::new(),
        };
        for block in list {
            planner.advance(0, block);
        }
        let (rates, traces) = (planner.rates.count as usize, planner.traces.count as usize);
        Self { events: planner.events, rates, traces, range }
    }
}

/// Layers between each block and those in `range`, up to `most`; `most + 1` beyond.
fn distances(graph: &[Vec<usize>], most: usize, range: Range<usize>) -> Vec<usize> {
    let mut distance = vec![most + 1; graph.len()];
    let mut layer: Vec<usize> = range.collect();
    layer.iter().for_each(|&block| distance[block] = 0);
    for d in 1..=most {
        let mut next = Vec::new();
        for &other in layer.iter().flat_map(|&block| &graph[block]) {
            if distance[other] > d {
                distance[other] = d;
                next.push(other);
            }
        }
        layer = next;
    }
    distance
}

/// Time nodes of the stages of a step on the stack: at most so many stages.
pub const STAGES: usize = 12;

/// The stages 0 to `STAGES` of a step, each with its one time node.
pub fn stages<'a>(times: &'a [[crate::boundary::TimeNode; 1]; STAGES], dt: f64) -> [Stage<'a>; STAGES] {
    std::array::from_fn(|number| Stage { number, times: &times[number], dt })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A graph of n blocks in a row, each of which touches those up to `reach` away, closed to a ring or not.
    fn row(n: usize, reach: usize, ring: bool) -> Vec<Vec<usize>> {
        let near = |a: usize, b: usize| {
            let d = a.abs_diff(b);
            d <= reach || (ring && n - d <= reach)
        };
        (0..n).map(|a| (0..n).filter(|&b| near(a, b)).collect()).collect()
    }

    /// Plays a plan with the values that a step would have, here the history of each block, in its slots.
    fn play(graph: &[Vec<usize>], stages: usize, plan: &Plan) -> Vec<Option<u64>> {
        let mix = |a: u64, b: u64| (a ^ b.rotate_left(17)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31);
        let mut rates = vec![vec![0; stages]; plan.rates];
        let mut traces = vec![0; plan.traces];
        let mut place = vec![vec![usize::MAX; graph.len()]; stages];
        let mut next = vec![None; graph.len()];
        for event in &plan.events {
            let (block, stage, slot) = (event.block as usize, event.stage as usize, event.rates as usize);
            match event.traces {
                Some(at) => {
                    let start = rates[slot][..stage].iter().fold(block as u64 + 1, |sum, rate| mix(sum, *rate));
                    rates[slot][stage] = start;
                    traces[at as usize] = mix(start, stage as u64);
                    place[stage][block] = at as usize;
                }
                None => {
                    let all = graph[block].iter().fold(0, |sum, &other| mix(sum, traces[place[stage][other]]));
                    rates[slot][stage] = mix(rates[slot][stage], all);
                    if stage + 1 == stages {
                        let end = rates[slot].iter().fold(block as u64, |sum, rate| mix(sum, *rate));
                        assert!(next[block].replace(end).is_none(), "block {block} is finished twice");
                    }
                }
            }
        }
        next
    }

    proptest! {
        #[test]
        fn every_plan_gives_what_all_blocks_give_stage_by_stage(
            n in 1usize..40, reach in 1usize..5, ring: bool, stages in 1usize..6, threads in 1usize..5) {
            let graph = row(n, reach, ring);
            // Stage by stage with a slot for each block: the plan of the definition.
            let mut events = Vec::new();
            for stage in 0..stages as u8 {
                for begins in [true, false] {
                    events.extend((0..n as u32).map(|block| {
                        let traces = begins.then_some(block + u32::from(stage) * n as u32);
                        Event { block, rates: block, traces, stage }
                    }));
                }
            }
            let expected = play(&graph, stages, &Plan { events, rates: n, traces: n * stages, range: 0..n });
            let plans = plans(&graph, stages, threads);
            prop_assert!(plans.len() <= threads);
            let mut found = vec![None; n];
            for plan in &plans {
                for (block, end) in play(&graph, stages, plan).into_iter().enumerate() {
                    prop_assert_eq!(end.is_some(), plan.range.contains(&block));
                    found[block] = found[block].or(end);
                }
            }
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn slots_are_as_few_as_the_blocks_under_way() {
        let plan = Plan::new(&row(1000, 4, false), 4, 0..1000);
        // A stage follows the one before it by the reach of 4, and a trace is read by blocks up to 4 behind and before.
        assert!(plan.rates <= 4 * 5 + 4 && plan.traces <= 4 * 10, "{} {}", plan.rates, plan.traces);
        assert_eq!(plan.events.len(), 2 * 4 * 1000);
    }

    #[test]
    fn a_tile_begins_as_many_layers_around_it_as_there_are_stages() {
        let plan = Plan::new(&row(100, 1, false), 3, 40..60);
        let begun = |stage: u8| plan.events.iter().filter(|e| e.stage == stage && e.traces.is_some()).count();
        assert_eq!([0, 1, 2].map(begun), [26, 24, 22]);
        // Two tiles that are nothing but layers would both do all the work: one is as quick.
        assert_eq!(plans(&row(4, 3, false), 3, 2).len(), 1);
    }
}
