//! A step on several ranks.
//!
//! A rank has tiles of the plan as a thread has: [`super::tiles`] knows which traces a tile shows to others and in which phase, and
//! between phases ranks send each other those that they need. Nothing is computed twice and nothing in another order, so that the
//! bits do not depend on the number of ranks.
//!
//! A rank has the unknowns of its own blocks. Where somebody looks at those of others they are fetched (`parts`). Corrections, contact,
//! and angular momentum that is kept look at the whole body in each step: then each rank has memory for the whole state.

use super::Scheme;
use super::numbers::Numbers;
use super::received::ReceivedBySide;
use super::tiles::{Plan, Slot};
use super::worst::Worst;
use crate::error::Result;
use crate::exchange::{Exchange, agree, numbers_of_all};
use crate::lane::{F8, LANES, ticks};
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::sum::ExactSum;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// What a rank knows of itself and the others.
pub(super) struct Ranks {
    pub(super) exchange: Arc<dyn Exchange>,
    /// The tiles of this rank.
    pub tiles: Range<usize>,
    /// The first block of each rank, and the end of the last one.
    pub(super) blocks: Vec<usize>,
    /// What is sent and received after each phase: `[phase][rank]`.
    send: Vec<Vec<Vec<Face>>>,
    receive: Vec<Vec<Vec<Face>>>,
    /// Messages under way.
    letters: [Vec<Vec<f64>>; 2],
    /// Numbers under way to all.
    all: Vec<f64>,
    /// Ticks in which traces were packed, waited for, and unpacked.
    pub(super) ticks: [u64; 3],
    /// Whether states are parts: each rank has those of its own blocks.
    pub parts: bool,
    /// Whether the last step has left this rank with the blocks of all.
    pub whole: bool,
}

/// The traces of a face of a block, where a tile shows them.
#[derive(Debug, Clone, Copy)]
struct Face {
    store: usize,
    slot: usize,
    face: usize,
    /// The cells whose traces are read, a bit each.
    lanes: u8,
}

/// All cells of a block.
const ALL: u8 = u8::MAX;
const _: () = assert!(LANES == u8::BITS as usize);

/// The lanes of these bits.
fn lanes(mut bits: u8) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

impl Face {
    /// Where its numbers are, with so many a block.
    fn range(&self, numbers: usize) -> Range<usize> {
        let first = 1 + self.slot * numbers + self.face * (numbers / FACES);
        first..first + numbers / FACES
    }

    /// How many numbers of it are sent, with so many a block.
    fn count(&self, numbers: usize) -> usize {
        numbers / FACES * self.lanes.count_ones() as usize
    }
}

impl Ranks {
    /// Those of a scheme, for a plan of so many tiles a rank; none where it runs alone.
    pub fn new(scheme: &Scheme, graph: &[Vec<usize>], plan: &Plan, tiles: usize) -> Option<Box<Self>> {
        let exchange = scheme.exchange.clone().filter(|exchange| exchange.ranks() > 1)?;
        let (count, blocks) = (plan.tiles.len(), scheme.operators.blocks.len());
        let of = |rank: usize| (rank * tiles).min(count)..((rank + 1) * tiles).min(count);
        let first = |rank: usize| plan.tiles.get(rank * tiles).map_or(blocks, |tile| tile.range.start);
        let mut out = Self {
            tiles: of(exchange.rank()),
            blocks: (0..=exchange.ranks()).map(first).collect(),
            send: vec![vec![vec![]; exchange.ranks()]; plan.phases()],
            receive: vec![vec![vec![]; exchange.ranks()]; plan.phases()],
            letters: [0, 1].map(|_| vec![vec![]; exchange.ranks()]),
            all: vec![],
            ticks: [0; 3],
            parts: !scheme.looks_at_all(),
            whole: true,
            exchange,
        };
        for rank in 0..out.exchange.ranks() {
            let needs = out.needed_by(rank, scheme, graph);
            out.list(rank, &needs, &plan.slots, count, blocks);
        }
        Some(Box::new(out))
    }

    /// Faces (FACES block + face) of other ranks whose traces a rank reads, with the lanes of these.
    fn needed_by(&self, rank: usize, scheme: &Scheme, graph: &[Vec<usize>]) -> BTreeMap<usize, u8> {
        let own = self.blocks[rank]..self.blocks[rank + 1];
        let mut needs = BTreeMap::<usize, u8>::new();
        for block in own.clone() {
            for neighbour in scheme.operators.blocks.neighbours[block].iter().flatten() {
                if let Neighbour::Cell(across) | Neighbour::Interface(across, _) = neighbour {
                    *needs.entry(across.face).or_default() |= 1 << across.lane;
                }
            }
            if scheme.contacts.is_some() {
                // Which of its faces meet changes from step to step.
                let faces = graph[block].iter().flat_map(|near| FACES * near..FACES * (near + 1));
                needs.extend(faces.map(|face| (face, ALL)));
            }
        }
        needs.retain(|face, _| !own.contains(&(face / FACES)));
        needs
    }

    /// Lists what is sent and received so that a rank has what it needs.
    fn list(&mut self, rank: usize, needs: &BTreeMap<usize, u8>, slots: &[Slot], tiles: usize, blocks: usize) {
        let own = self.exchange.rank();
        let stages = 0..slots.len() / blocks.max(1);
        for (stage, (&needed, &lanes)) in stages.flat_map(|stage| needs.iter().map(move |need| (stage, need))) {
            let (block, face) = (needed / FACES, needed % FACES);
            let from = self.blocks.partition_point(|first| *first <= block) - 1;
            let slot = slots[stage * blocks + block];
            let Some(store) = (slot.store as usize).checked_sub(1) else { continue };
            let face = Face { store, slot: slot.index as usize, face, lanes };
            if from == own {
                self.send[store / tiles][rank].push(face);
            }
            if rank == own {
                self.receive[store / tiles][from].push(face);
            }
        }
    }

    /// Gives others the traces that this rank has shown in a phase, and takes theirs; `numbers` are those of a block. `meanwhile` runs while
    /// they are under way.
    pub fn swap(
        &mut self,
        phase: usize,
        shown: &mut [Vec<F8>],
        numbers: usize,
        meanwhile: impl FnOnce(&mut [Vec<F8>]) + Send,
    ) {
        let start = ticks();
        let [send, receive] = &mut self.letters;
        for (letter, faces) in send.iter_mut().zip(&self.send[phase]) {
            letter.clear();
            for face in faces {
                for number in &shown[face.store][face.range(numbers)] {
                    match face.lanes {
                        ALL => letter.extend_from_slice(&number.0),
                        some => letter.extend(lanes(some).map(|lane| number.0[lane])),
                    }
                }
            }
        }
        for (letter, faces) in receive.iter_mut().zip(&self.receive[phase]) {
            letter.resize(faces.iter().map(|face| face.count(numbers)).sum(), 0.0);
        }
        let (packed, mut meanwhile, mut busy) = (ticks(), Some(meanwhile), 0);
        self.exchange.swap(send, receive, &mut || {
            let start = ticks();
            if let Some(run) = meanwhile.take() {
                run(shown);
            }
            busy = ticks().wrapping_sub(start);
        });
        let come = ticks();
        for (letter, faces) in receive.iter().zip(&self.receive[phase]) {
            let mut letter = letter.iter();
            for face in faces {
                for number in &mut shown[face.store][face.range(numbers)] {
                    lanes(face.lanes).zip(&mut letter).for_each(|(lane, from)| number.0[lane] = *from);
                }
            }
        }
        let passed =
            [packed.wrapping_sub(start), come.wrapping_sub(packed).saturating_sub(busy), ticks().wrapping_sub(come)];
        self.ticks.iter_mut().zip(passed).for_each(|(sum, passed)| *sum += passed);
    }

    /// Gives all ranks what each has of `all`, rank r those of its blocks; numbers of block b begin at `first(b)`.
    pub fn gather<T: Numbers>(&mut self, all: &mut [T], first: impl Fn(usize) -> usize) {
        let first: Vec<usize> = self.blocks.iter().map(|block| first(*block)).collect();
        let (rank, count) = (self.exchange.rank(), T::COUNT);
        self.all.clear();
        self.all.resize(all.len() * count, 0.0);
        let own = first[rank]..first[rank + 1];
        for (to, from) in self.all.chunks_exact_mut(count).zip(all.iter()).take(own.end).skip(own.start) {
            from.write(to);
        }
        let ends: Vec<usize> = first.iter().map(|first| first * count).collect();
        self.exchange.gather(&mut self.all, &ends);
        for (number, (to, from)) in all.iter_mut().zip(self.all.chunks_exact(count)).enumerate() {
            if !own.contains(&number) {
                to.read(from);
            }
        }
    }

    /// The sums over all ranks of what each of them has summed: whatever the ranks, the bits of one sum.
    pub fn sum<const N: usize>(&mut self, own: [ExactSum; N]) -> [f64; N] {
        let (rank, count) = (self.exchange.rank(), N * ExactSum::NUMBERS);
        self.all.clear();
        self.all.resize(self.exchange.ranks() * count, 0.0);
        for (own, to) in own.iter().zip(self.all[rank * count..].chunks_exact_mut(ExactSum::NUMBERS)) {
            own.write(to);
        }
        let ends: Vec<usize> = (0..=self.exchange.ranks()).map(|rank| rank * count).collect();
        self.exchange.gather(&mut self.all, &ends);
        let mut sums: [ExactSum; N] = std::array::from_fn(|_| ExactSum::default());
        for numbers in self.all.chunks_exact(count) {
            let each = numbers.chunks_exact(ExactSum::NUMBERS);
            sums.iter_mut().zip(each).for_each(|(sum, numbers)| sum.add_written(numbers));
        }
        sums.map(|sum| sum.value())
    }

    /// The largest that a rank has of each number.
    pub fn most<const N: usize>(&mut self, own: [f64; N]) -> [f64; N] {
        let (rank, ranks) = (self.exchange.rank(), self.exchange.ranks());
        self.all.clear();
        self.all.resize(ranks * N, 0.0);
        self.all[rank * N..][..N].copy_from_slice(&own);
        self.exchange.gather(&mut self.all, &(0..=ranks).map(|rank| rank * N).collect::<Vec<_>>());
        let most = |most: [f64; N], of: &[f64; N]| std::array::from_fn(|k| most[k].max(of[k]));
        self.all.as_chunks::<N>().0.iter().fold(own, most)
    }

    /// Gives all ranks what the sides of segments have received: each side on the rank of its cell, 0 elsewhere.
    pub fn add_up(&mut self, received: &mut [[ReceivedBySide; 2]]) {
        let (rank, count) = (self.exchange.rank(), 6 * received.len());
        self.all.clear();
        self.all.resize(self.exchange.ranks() * count, 0.0);
        for (to, side) in self.all[rank * count..].chunks_exact_mut(3).zip(received.iter().flatten()) {
            to.copy_from_slice(&side.values());
        }
        let ends: Vec<usize> = (0..=self.exchange.ranks()).map(|rank| rank * count).collect();
        self.exchange.gather(&mut self.all, &ends);
        for (number, side) in received.iter_mut().flatten().enumerate() {
            let of = |rank: usize, k: usize| self.all[rank * count + 3 * number + k];
            let sum = |k: usize| (0..self.exchange.ranks()).map(|rank| of(rank, k)).sum();
            *side = ReceivedBySide::of([0, 1, 2].map(sum));
        }
    }

    /// The worst of the blocks of all ranks, from that of its own.
    pub fn worst(&mut self, own: Worst) -> Worst {
        let (rank, ranks) = (self.exchange.rank(), self.exchange.ranks());
        let mut all = vec![Worst::NONE; ranks];
        all[rank] = own;
        let mut numbers = vec![0.0; ranks * Worst::COUNT];
        own.write(&mut numbers[rank * Worst::COUNT..][..Worst::COUNT]);
        let ends: Vec<usize> = (0..=ranks).map(|rank| rank * Worst::COUNT).collect();
        self.exchange.gather(&mut numbers, &ends);
        for (worst, numbers) in all.iter_mut().zip(numbers.chunks_exact(Worst::COUNT)) {
            worst.read(numbers);
        }
        all.into_iter().fold(Worst::NONE, Worst::and)
    }

    /// To each question whether a rank says yes.
    pub fn any<const N: usize>(&self, yes: [bool; N]) -> [bool; N] {
        let bits = yes.iter().rev().fold(0_u32, |bits, yes| 2 * bits + u32::from(*yes));
        let all = numbers_of_all(&*self.exchange, f64::from(bits)).into_iter().fold(0, |all, bits| all | bits as u32);
        std::array::from_fn(|k| all >> k & 1 == 1)
    }

    /// See [`agree`].
    pub fn agree<T>(&self, result: Result<T>) -> Result<T> {
        agree(&*self.exchange, result)
    }
}

impl Ranks {
    /// Whether this is rank 0.
    pub fn is_first(&self) -> bool {
        self.exchange.rank() == 0
    }

    /// The blocks of this rank.
    pub fn own(&self) -> Range<usize> {
        self.blocks[self.exchange.rank()]..self.blocks[self.exchange.rank() + 1]
    }
}
