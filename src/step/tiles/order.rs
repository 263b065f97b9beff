//! The order of the events of a step.

use super::Plan;
use super::seams::Seams;
use super::slots::Slots;
use std::ops::Range;

/// An event that has no slots yet.
#[derive(Clone, Copy)]
pub struct Todo {
    pub block: usize,
    pub stage: usize,
    /// Whether it begins; else it finishes.
    pub begins: bool,
}

/// The events of the first phase, and how far each block has come.
pub struct Order<'a> {
    pub graph: &'a [Vec<usize>],
    pub stages: usize,
    /// The blocks of each tile.
    pub ranges: Vec<Range<usize>>,
    /// By tile.
    pub tiles: Vec<Vec<Todo>>,
    /// By block, the tile, or in the second phase the seam that works on it.
    part: Vec<usize>,
    /// By block, the number of stages that have begun and that have finished.
    begun: Vec<usize>,
    pub finished: Vec<usize>,
}

impl<'a> Order<'a> {
    /// The first phase for so many tiles of equal size.
    pub fn new(graph: &'a [Vec<usize>], stages: usize, tiles: usize) -> Self {
        let count = graph.len();
        let size = count.div_ceil(tiles).max(1);
        let ranges: Vec<_> = (0..count).step_by(size).map(|first| first..count.min(first + size)).collect();
        let part = (0..count).map(|block| block / size).collect();
        let (begun, finished) = (vec![0; count], vec![0; count]);
        let mut order = Self { graph, stages, ranges, tiles: vec![], part, begun, finished };
        order.tiles = order.ranges.clone().into_iter().map(|range| order.pass(range)).collect();
        order
    }

    /// Adds the second phase and all slots.
    pub fn plan(mut self, seams: Seams) -> Plan {
        let mut slots = Slots::new(&self, &seams);
        let tiles = self.tiles.iter().map(|todo| slots.pass(true, todo)).collect();
        self.part.clone_from(&seams.part);
        let passes = seams.lists(self.graph).into_iter().map(|list| {
            let todo = self.pass(list);
            slots.pass(false, &todo)
        });
        let seam_passes = passes.collect();
        Plan { tiles, seams: seam_passes, ranges: self.ranges, slots: slots.table(), pieces: seams.pieces }
    }

    /// All that can be done of the blocks of a part.
    fn pass(&mut self, list: impl IntoIterator<Item = usize>) -> Vec<Todo> {
        let mut out = Vec::new();
        for block in list {
            match self.begun[block] {
                0 => self.advance(block, &mut out),
                begun if begun > self.finished[block] => self.follow(begun - 1, block, &mut out),
                _ => {}
            }
        }
        out
    }

    /// Begins the next stage of a block, finishes it for all blocks that have waited for that, and begins the next stage of
    /// each of them, while what it needs is in the cache.
    fn advance(&mut self, block: usize, out: &mut Vec<Todo>) {
        let stage = self.begun[block];
        out.push(Todo { block, stage, begins: true });
        self.begun[block] += 1;
        let graph = self.graph;
        for &near in &graph[block] {
            self.follow(stage, near, out);
        }
    }

    /// Finishes a stage of a block, if it waits for nothing but that, and goes on with it.
    fn follow(&mut self, stage: usize, block: usize, out: &mut Vec<Todo>) {
        let ready = |&near: &usize| self.begun[near] > stage && self.part[near] == self.part[block];
        if self.finished[block] != stage || !self.graph[block].iter().all(ready) {
            return;
        }
        out.push(Todo { block, stage, begins: false });
        self.finished[block] += 1;
        if stage + 1 < self.stages {
            self.advance(block, out);
        }
    }
}
