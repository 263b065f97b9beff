//! The memory of the tiles of a step: rates and traces under way.

use super::ranks::Ranks;
use super::tiles::{self, Plan, Slot};
use super::worst::Worst;
use super::{Scheme, Shares, volume};
use crate::lane::F8;
use crate::mesh::FACES;

/// A tile of blocks with its memory.
pub(super) struct Tile {
    /// What is done in it, in which order.
    pub plan: tiles::Tile,
    /// dU/dt: [slot][stage][component][node].
    pub rates: Vec<F8>,
    /// See [`across::Traces`], with [`volume::width`] numbers a point.
    pub traces: Vec<F8>,
    /// The worst of its blocks after the last step.
    pub worst: Worst,
    /// The estimate of a step of its blocks, ns.
    weight: u64,
    /// Ticks in its phases since they were last taken; 0 where it is the only tile.
    pub busy: u64,
}

/// The tiles of a step.
pub(super) struct Tiles {
    /// The tiles.
    pub tiles: Vec<Tile>,
    /// Phases of a step.
    pub phases: usize,
    /// The traces that each tile shows: [phase][tile].
    pub shown: Vec<Vec<F8>>,
    /// Slots of each of them.
    shown_slots: Vec<usize>,
    /// The slot of the traces of each block: [stage][block].
    pub slots: Vec<Slot>,
    /// Whether the unknowns come from memory, see [`FAR`].
    pub far: bool,
    /// See [`Plan::overlaps`].
    pub overlaps: bool,
    /// The ranks that step the body together; none where it runs alone.
    pub ranks: Option<Box<Ranks>>,
}

impl Tiles {
    /// For states with `stride` numbers a block, on the current number of threads.
    pub fn new(scheme: &Scheme, stride: usize) -> Self {
        let (stages, blocks) = (scheme.stages(), &scheme.operators.blocks);
        let mut graph = tiles::graph(blocks);
        if let Some(contacts) = &scheme.contacts {
            contacts.link(&mut graph);
        }
        let (threads, weights) = (rayon::current_num_threads().max(1), scheme.weights());
        let plan = match (&scheme.exchange, &scheme.partition) {
            (Some(_), Some(parts)) => Plan::of_parts(&graph, &weights, stages, &parts.first, threads),
            (Some(exchange), None) => Plan::of_ranks(&graph, &weights, stages, [exchange.ranks(), threads]),
            (None, _) => Plan::new(&graph, &weights, stages, threads),
        };
        // Corrections of stages need all blocks of a stage at once.
        let plan = if scheme.corrects_stages() { plan.by_stages(stages) } else { plan };
        let phases = plan.phases();
        let ranks = Ranks::new(scheme, &graph, &plan, threads);
        let is_own = |tile: usize| ranks.as_ref().is_none_or(|ranks| ranks.tiles.contains(&tile));
        let tile = |(number, mut plan): (usize, tiles::Tile)| {
            if !is_own(number) {
                (plan.rates, plan.traces) = (0, 0);
            }
            let rates = vec![F8::ZERO; plan.rates * stages * stride];
            let weight = weights[plan.range.clone()].iter().sum();
            Tile { rates, traces: vec![], worst: Worst::NONE, weight, busy: 0, plan }
        };
        let mut out = Self {
            tiles: plan.tiles.into_iter().enumerate().map(tile).collect(),
            phases,
            shown: vec![vec![]; plan.shown.len()],
            shown_slots: plan.shown,
            slots: plan.slots,
            overlaps: plan.overlaps,
            far: blocks.len() * stride * size_of::<F8>() > FAR,
            ranks,
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
    pub fn worst(&mut self) -> Worst {
        let worst = self.tiles.iter().fold(Worst::NONE, |worst, tile| worst.and(tile.worst));
        match &mut self.ranks {
            Some(ranks) => ranks.worst(worst),
            None => worst,
        }
    }

    /// Adds a step to the shares of the tiles, with what they took since the last call at a `rate` of ticks per second.
    pub fn add_shares(&mut self, rate: impl Fn() -> f64, to: &mut Shares) {
        if self.tiles.len() > 1 {
            let rate = rate();
            let share = |tile: &mut Tile| [tile.weight as f64 / 1e9, std::mem::take(&mut tile.busy) as f64 / rate];
            to.add(self.tiles.iter_mut().map(share));
            if let Some(ranks) = &mut self.ranks {
                to.add_messages(std::mem::take(&mut ranks.ticks).map(|ticks| ticks as f64 / rate));
            }
        }
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

impl Scheme {
    /// Numbers of the traces of a block.
    pub(super) fn block_traces(&self, metered: bool) -> usize {
        FACES * self.operators.line.m * volume::width(self.flux.looks(), metered)
    }

    /// Bytes of the traces of all faces, without the balance.
    pub fn trace_bytes(&self) -> usize {
        self.operators.blocks.len() * self.block_traces(false) * size_of::<F8>()
    }
}
