//! In which order the blocks of a step are begun and finished, and where their rates and traces lie meanwhile.
//!
//! A step is one pass over memory: `finish` follows `begin` as closely as neighbours allow, each stage follows the one
//! before it, and rates and traces live in a few slots that are used again as soon as nobody needs what they hold, so
//! that they stay in the cache. With several threads each first does all of a tile of blocks that needs nothing from beyond
//! it, a layer less with each stage; then what is left at the seams between tiles is done, seam by seam. Nothing is done
//! twice, threads wait for each other between the two phases only, and the bits do not depend on it.

mod order;
mod seams;
mod slots;

use super::Stage;
use crate::operators::{Blocks, Neighbour};
use order::Order;
use seams::Seams;
use std::ops::Range;

/// Stores of a pass: number 0 is its own, the others are pieces, see [`Piece`].
pub const STORES: usize = 4;

/// Tiles of a step at most: what each makes of the new state is listed on the stack.
pub const TILES: usize = 128;

/// A place in one of the stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Slot(u32);

impl Slot {
    /// The place `index` of a store.
    fn new(store: usize, index: usize) -> Self {
        Self((store as u32) << Self::BITS | index as u32)
    }

    /// Bits of an index.
    const BITS: u32 = u32::BITS - STORES.ilog2();

    /// The store.
    #[inline(always)]
    pub fn store(self) -> usize {
        (self.0 >> Self::BITS) as usize
    }

    /// The place in it.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & ((1 << Self::BITS) - 1)) as usize
    }
}

/// What is done next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Event {
    /// The block.
    pub block: u32,
    /// The slot of its rates.
    pub rates: Slot,
    /// The stage.
    pub stage: u8,
    /// Whether it begins; else it finishes.
    pub begins: bool,
}

/// What one thread does without waiting for anybody.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Pass {
    /// In their order.
    pub events: Vec<Event>,
    /// Slots of the rates of a block in all stages, by store.
    pub rates: [usize; STORES],
    /// Slots of the traces of a block in one stage, by store.
    pub traces: [usize; STORES],
}

/// The blocks of a tile that are not done after the first phase, at one of its seams. What is under way of them is handed
/// from the tile to the seam: a store that has the same number in both.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Piece {
    /// The tile.
    pub tile: usize,
    /// The seam.
    pub seam: usize,
    /// The number of the store.
    pub store: usize,
    /// From its first block to its last, with some others of the tile that have been done in the first phase.
    pub range: Range<usize>,
}

/// The events of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// The first phase.
    pub tiles: Vec<Pass>,
    /// The second phase; nothing where there is one tile.
    pub seams: Vec<Pass>,
    /// The blocks of each tile.
    pub ranges: Vec<Range<usize>>,
    /// In the order of the blocks; those of different seams do not overlap.
    pub pieces: Vec<Piece>,
    /// The slots of the traces: [stage][block].
    pub slots: Vec<Slot>,
}

impl Plan {
    /// A plan for as many tiles of equal size, up to `threads`, as make the longest way through the step shorter by a
    /// quarter at least: threads that wait for each other are other people's time.
    pub fn new(graph: &[Vec<usize>], stages: usize, threads: usize) -> Self {
        let mut best = Order::new(graph, stages, 1).plan(Seams::default());
        let mut tiles = threads.min(TILES);
        while tiles > 1 {
            let order = Order::new(graph, stages, tiles);
            if let Some(seams) = Seams::new(&order) {
                let found = order.plan(seams);
                if 4 * found.longest() < 3 * best.longest() {
                    best = found;
                }
            }
            tiles /= 2;
        }
        best
    }

    /// Events that follow each other.
    fn longest(&self) -> usize {
        let longest = |passes: &[Pass]| passes.iter().map(|pass| pass.events.len()).max().unwrap_or(0);
        longest(&self.tiles) + longest(&self.seams)
    }
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

/// Time nodes of the stages of a step on the stack: at most so many stages.
pub const STAGES: usize = 12;

/// The stages 0 to `STAGES` of a step, each with its one time node.
pub fn stages<'a>(times: &'a [[crate::boundary::TimeNode; 1]; STAGES], dt: f64) -> [Stage<'a>; STAGES] {
    std::array::from_fn(|number| Stage { number, times: &times[number], dt })
}

#[cfg(test)]
mod tests;
