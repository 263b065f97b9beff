//! Slots for what is under way.

use super::order::{Order, Todo};
use super::seams::Seams;
use super::{Event, Pass, STORES, Slot};

/// Slots of one store; the one that was used last is taken first, while it is in the cache.
#[derive(Default)]
struct Store {
    free: Vec<Slot>,
    count: usize,
}

impl Store {
    fn take(&mut self, store: usize) -> Slot {
        self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            Slot::new(store, self.count - 1)
        })
    }
}

/// Gives a slot to each event of all passes, in the order of the phases.
pub struct Slots<'a> {
    graph: &'a [Vec<usize>],
    stages: usize,
    /// By block, whether its rates are of the first phase only.
    done: Vec<bool>,
    /// By block, so many stages are finished by all that touch it in the first phase: their traces are needed there only.
    read: Vec<usize>,
    /// By block, the number of the store of its piece; 0 where it is in none.
    piece: Vec<usize>,
    /// [stage][block], how many have still to read the traces, and their slot.
    readers: Vec<usize>,
    traces: Vec<Slot>,
    /// By block.
    rates: Vec<Slot>,
}

impl<'a> Slots<'a> {
    pub fn new(order: &Order<'a>, seams: &Seams) -> Self {
        let (graph, stages, count) = (order.graph, order.stages, order.graph.len());
        let slowest = |near: &Vec<usize>| near.iter().map(|&near| order.finished[near]).min().unwrap_or(stages);
        let mut piece = vec![0; count];
        for (tile, range) in order.ranges.iter().enumerate() {
            let own: Vec<_> = seams.pieces.iter().filter(|piece| piece.tile == tile).collect();
            for block in range.clone() {
                let mine = own.iter().find(|piece| seams.part.get(block) == Some(&piece.seam));
                piece[block] = mine.map_or(0, |piece| piece.store);
            }
        }
        Self {
            graph,
            stages,
            done: order.finished.iter().map(|&finished| finished == stages).collect(),
            read: graph.iter().map(slowest).collect(),
            piece,
            readers: graph.iter().map(Vec::len).collect::<Vec<_>>().repeat(stages),
            traces: vec![Slot::default(); stages * count],
            rates: vec![Slot::default(); count],
        }
    }

    /// A pass of the first or second phase.
    pub fn pass(&mut self, first: bool, todo: &[Todo]) -> Pass {
        let (mut rates, mut traces) = <[[Store; STORES]; 2]>::default().into();
        let count = self.graph.len();
        let mut events = Vec::with_capacity(todo.len());
        for &Todo { block, stage, begins } in todo {
            if begins && stage == 0 {
                let store = if self.done[block] { 0 } else { self.piece[block] };
                self.rates[block] = rates[store].take(store);
            }
            let slot = self.rates[block];
            events.push(Event { block: block as u32, rates: slot, stage: stage as u8, begins });
            if begins {
                let store = if first && stage >= self.read[block] { self.piece[block] } else { 0 };
                self.traces[stage * count + block] = traces[store].take(store);
                continue;
            }
            if stage + 1 == self.stages && slot.store() == 0 {
                rates[0].free.push(slot);
            }
            for &near in &self.graph[block] {
                let at = stage * count + near;
                self.readers[at] -= 1;
                if self.readers[at] == 0 && self.traces[at].store() == 0 {
                    traces[0].free.push(self.traces[at]);
                }
            }
        }
        Pass { events, rates: rates.map(|store| store.count), traces: traces.map(|store| store.count) }
    }

    /// The slots of the traces.
    pub fn table(self) -> Vec<Slot> {
        self.traces
    }
}
