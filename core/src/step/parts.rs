//! The parts of a state on several ranks: cut from the whole, and put together again where somebody looks at it.

use super::ranks::Ranks;
use super::{Scheme, Speeds};
use crate::lane::{F8, LANES, as_f64};
use crate::state::{Part, State};

/// Blocks of eight numbers that go from rank to rank at once: 1 MiB. No more than that is held twice.
const PIECE: usize = 1 << 14;

/// Where the numbers of a block begin in the arrays of a whole state: unknowns, internal variables, creep.
fn places(scheme: &Scheme, state: &State, block: usize) -> [usize; 3] {
    let creep = if state.creep.is_empty() { 0 } else { scheme.creep_of_block() };
    [block * state.components * scheme.operators.nodes(), scheme.histories.start(block), block * creep]
}

impl Ranks {
    /// The part of this rank of a whole state.
    pub fn part_of(&self, scheme: &Scheme, whole: &State) -> State {
        let own = self.own();
        let (from, to) = (places(scheme, whole, own.start), places(scheme, whole, own.end));
        State {
            part: Part { is_part: true, block: own.start, internal: from[1] },
            u: whole.u[from[0]..to[0]].to_vec(),
            internal: whole.internal[from[1]..to[1]].to_vec(),
            creep: whole.creep[from[2]..to[2]].to_vec(),
            boundary: whole.boundary.clone(),
            unheld: whole.unheld.clone(),
            received: whole.received.clone(),
            ..*whole
        }
    }

    /// The whole state of which each rank has its part: on rank 0, or on all ranks. All ranks call it.
    pub fn whole_of(&mut self, scheme: &Scheme, part: &State, on_all: bool) -> Option<State> {
        let starts: Vec<[usize; 3]> = self.blocks.iter().map(|block| places(scheme, part, *block)).collect();
        let held = places(scheme, part, part.part.block);
        let mut boundary = part.boundary.clone();
        self.gather_boundary(scheme, &mut boundary);
        let array = |numbers: &[F8], k: usize| {
            let starts: Vec<usize> = starts.iter().map(|start| start[k]).collect();
            self.collect(numbers, held[k], &starts, on_all)
        };
        let [u, internal, creep] = [(&part.u, 0), (&part.internal, 1), (&part.creep, 2)].map(|(of, k)| array(of, k));
        let (unheld, received) = (part.unheld.clone(), part.received.clone());
        let (u, internal, creep) = (u?, internal?, creep?);
        Some(State { part: Part::default(), u, internal, creep, boundary, unheld, received, ..*part })
    }

    /// The numbers of all ranks, those of rank r at `starts[r]..starts[r + 1]`, from those that each of them holds, of which the first is
    /// number `held` of all.
    fn collect(&self, own: &[F8], held: usize, starts: &[usize], on_all: bool) -> Option<Vec<F8>> {
        let rank = self.exchange.rank();
        let mut out = (on_all || rank == 0).then(|| Vec::with_capacity(starts[self.exchange.ranks()]));
        for (from, ends) in starts.windows(2).enumerate() {
            for start in (ends[0]..ends[1]).step_by(PIECE) {
                let range = start..ends[1].min(start + PIECE);
                let sent = (from == rank).then(|| &own[range.start - held..range.end - held]);
                let numbers = self.piece(from, sent, range.len(), on_all);
                if let Some(out) = &mut out {
                    out.extend(numbers.as_chunks::<LANES>().0.iter().map(|lanes| F8(*lanes)));
                }
            }
        }
        out
    }

    /// A piece of what a rank has, on rank 0 or on all ranks; nothing on others.
    fn piece(&self, from: usize, sent: Option<&[F8]>, count: usize, on_all: bool) -> Vec<f64> {
        let ranks = self.exchange.ranks();
        let mut numbers = sent.map_or_else(Vec::new, |sent| as_f64(sent).to_vec());
        if on_all {
            numbers.resize(count * LANES, 0.0);
            let ends: Vec<usize> = (0..=ranks).map(|rank| if rank > from { numbers.len() } else { 0 }).collect();
            self.exchange.gather(&mut numbers, &ends);
            return numbers;
        }
        if from == 0 {
            return numbers;
        }
        let [mut send, mut receive] = [0, 1].map(|_| vec![vec![]; ranks]);
        if sent.is_some() {
            send[0] = numbers;
        }
        if self.exchange.rank() == 0 {
            receive[from] = vec![0.0; count * LANES];
        }
        self.exchange.swap(&send, &mut receive, &mut || {});
        receive.swap_remove(from)
    }

    /// Gives all ranks the memory of boundary conditions of all blocks.
    fn gather_boundary(&mut self, scheme: &Scheme, boundary: &mut [f64]) {
        if !boundary.is_empty() {
            let (blocks, end) = (scheme.operators.blocks.len(), scheme.boundary_memory.len());
            let first = |block: usize| if block < blocks { scheme.boundary_memory.range(block).start } else { end };
            self.gather(boundary, first);
        }
    }

    /// Fetches the blocks of other ranks of a state that has room for them, and its speeds.
    pub fn state(&mut self, scheme: &Scheme, state: &mut State, speed: &mut [Speeds]) {
        let stride = state.components * scheme.operators.nodes();
        self.gather(&mut state.u, |block| block * stride);
        if !state.internal.is_empty() {
            self.gather(&mut state.internal, |block| scheme.histories.start(block));
        }
        self.gather_boundary(scheme, &mut state.boundary);
        if !state.creep.is_empty() {
            self.gather(&mut state.creep, |block| block * scheme.creep_of_block());
        }
        self.gather(speed, |block| block);
        self.whole = true;
    }
}
