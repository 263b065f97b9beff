//! The work that the outside does on the body in a step: metered in every run, since it is known at boundary points and in
//! cells with sources at next to no cost.

use super::{Scheme, Work};
use crate::lane::F8;
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::state::Received;
use crate::sum::{ExactSum, exact_sum};
use std::ops::Range;

/// Work on the cells of a block in a step, J/m, a lane a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ExternalWork {
    /// int t*.v* over boundary and time.
    pub boundary: F8,
    /// int rho0 b.v over cell and time.
    pub source: F8,
    /// int b dt, m/s, b the mean of a source over the cell.
    pub impulse: [F8; 2],
}

/// What the conditions at the faces of a block give to it in a step, a lane a cell. The flux of the corrector itself is metered, where
/// it is made and with the weights that it has there: impulse and change of momentum differ by rounding alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct FaceForces {
    /// int t* over face and time, N s/m.
    pub impulse: [[F8; 2]; FACES],
    /// int t*.v* over face and time, J/m.
    pub work: [F8; FACES],
}

/// int x cross t* over each face of a block and time, N m s/m, with the positions at the start of the step.
pub(super) type Torques = [F8; FACES];

/// That of all blocks on which something outside acts; the others have no entry.
pub(super) struct Outside {
    /// Entries before each block (length: blocks + 1).
    pub first: Vec<u32>,
    /// The cells of the block of each entry.
    cells: Vec<usize>,
    /// The entries.
    pub entries: Vec<ExternalWork>,
    /// The sums over all ranks of boundary and source after a step of several ranks that gave each other no entries.
    pub of_all: Option<[f64; 2]>,
    /// By face, beside the entries; none where nobody asks for forces: nothing is allocated and nothing is done for them then.
    pub forces: Option<Vec<FaceForces>>,
    /// Beside them; none where angular momentum is not kept.
    pub torques: Option<Vec<Torques>>,
    /// What the groups receive in a step, impulse and work: memory for their sums.
    sums: Vec<[ExactSum; 3]>,
}

impl Outside {
    /// No work on any block of a scheme yet.
    pub fn new(scheme: &Scheme) -> Self {
        let blocks = &scheme.operators.blocks;
        let mut out = Self {
            first: vec![0],
            cells: vec![],
            entries: vec![],
            of_all: None,
            forces: None,
            torques: None,
            sums: vec![],
        };
        for (faces, &count) in blocks.neighbours.iter().zip(&blocks.count) {
            let at_boundary = faces.iter().flatten().any(|beyond| matches!(beyond, Neighbour::Boundary(_)));
            if at_boundary || !scheme.sources.is_empty() {
                out.cells.push(count);
            }
            out.first.push(out.cells.len() as u32);
        }
        out.entries = vec![ExternalWork::default(); out.cells.len()];
        // The work between faces is told from that of the outside by them.
        out.forces = scheme.contacts.as_ref().map(|_| vec![FaceForces::default(); out.cells.len()]);
        out.torques = scheme.keeps_angular_momentum().then(|| vec![Torques::default(); out.cells.len()]);
        out
    }

    /// The work of boundary and sources on the blocks of some entries, J/m.
    pub fn sums_of(&self, entries: Range<usize>) -> [ExactSum; 2] {
        let mut sums = <[ExactSum; 2]>::default();
        for (work, &cells) in self.entries[entries.clone()].iter().zip(&self.cells[entries]) {
            for (sum, lanes) in sums.iter_mut().zip([&work.boundary, &work.source]) {
                sum.add(lanes.0[..cells].iter().sum());
            }
        }
        sums
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..])
            + size_of_val(&self.cells[..])
            + size_of_val(&self.entries[..])
            + self.forces.as_ref().map_or(0, |forces| size_of_val(&forces[..]))
            + self.torques.as_ref().map_or(0, |torques| size_of_val(&torques[..]))
    }
}

/// The entry of a block among `all`, works or forces, those of the blocks from `start` on.
#[inline]
pub(super) fn entry<'a, T>(first: &[u32], start: usize, all: &'a mut [T], block: usize) -> Option<&'a mut T> {
    let (from, to) = (first[block], first[block + 1]);
    if from == to { None } else { all.get_mut((from - first[start]) as usize) }
}

impl Work {
    /// The work of the boundary, of sources, and of what acts between faces of the body in the last step, J/m, by exact sums. The last
    /// is no work of the outside: contact takes it from the body.
    pub fn external_work(&self, scheme: &Scheme) -> [f64; 3] {
        let own = || self.outside.sums_of(0..self.outside.entries.len()).map(|sum| sum.value());
        let [boundary, source] = self.outside.of_all.unwrap_or_else(own);
        let (Some(contacts), Some(forces)) = (&scheme.contacts, &self.outside.forces) else {
            return [boundary, source, 0.0];
        };
        let between = exact_sum(contacts.faces.iter().map(|face| {
            let entry = self.outside.first[face.face / FACES] as usize;
            forces[entry].work[face.face % FACES].0[face.lane]
        }));
        [boundary - between, source, between]
    }

    /// With the memory that forces need; the steps then meter them.
    pub fn with_forces(mut self) -> Self {
        self.outside.forces = Some(vec![FaceForces::default(); self.outside.entries.len()]);
        self.outside.sums = vec![Default::default(); self.next.received.len()];
        if let Some(meetings) = &mut self.meetings {
            meetings.received = Some(vec![]);
        }
        self
    }

    /// Whether the steps meter forces.
    pub fn has_forces(&self) -> bool {
        self.outside.forces.is_some()
    }

    /// Adds what the last step received through each boundary group, by exact sums over its faces, to `before`, into the new state.
    /// Nothing where forces are not metered.
    pub(super) fn receive(&mut self, scheme: &Scheme, before: &[Received]) {
        let Some(forces) = &self.outside.forces else { return };
        let (blocks, sums) = (&scheme.operators.blocks, &mut self.outside.sums);
        sums.resize_with(before.len(), Default::default);
        sums.iter_mut().flatten().for_each(ExactSum::clear);
        for (block, &count) in blocks.count.iter().enumerate() {
            let entries = self.outside.first[block] as usize..self.outside.first[block + 1] as usize;
            let Some(entry) = forces[entries].first() else { continue };
            for (face, neighbours) in blocks.neighbours[block].iter().enumerate() {
                for (lane, neighbour) in neighbours.iter().enumerate().take(count) {
                    let Neighbour::Boundary(group) = neighbour else { continue };
                    let Some([one, two, work]) = sums.get_mut(*group) else { continue };
                    one.add(entry.impulse[face][0].0[lane]);
                    two.add(entry.impulse[face][1].0[lane]);
                    work.add(entry.work[face].0[lane]);
                }
            }
        }
        let received = |(before, [one, two, work]): (&Received, &[ExactSum; 3])| Received {
            impulse: [before.impulse[0] + one.value(), before.impulse[1] + two.value()],
            work: before.work + work.value(),
        };
        self.next.received.clear();
        self.next.received.extend(before.iter().zip(sums.iter()).map(received));
        self.receive_from_pairs(scheme.boundaries.len());
    }
}

impl Scheme {
    /// How many entries [`crate::state::State::received`] has: the boundary groups, then both sides of each pair of [`Scheme::pairs`], what
    /// the first receives from the second and the second from the first.
    pub fn receivers(&self) -> usize {
        self.boundaries.len() + 2 * self.contacts.as_ref().map_or(0, |contacts| contacts.len())
    }
}

impl Work {
    /// Adds what pairs gave to each other in the last step to the entries behind the `groups` of the new state, by exact sums over segments.
    pub(super) fn receive_from_pairs(&mut self, groups: usize) {
        let Some(meetings) = self.meetings.as_deref() else { return };
        let (segments, Some(received)) = (&meetings.segments, &meetings.received) else { return };
        let into = self.next.received.get_mut(groups..).unwrap_or_default();
        for (pairing, into) in into.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let own = || segments.iter().zip(received).filter(|(segment, _)| segment.pairing == pairing);
            for (side, Received { impulse, work }) in into.iter_mut().enumerate() {
                let mut sums: [ExactSum; 3] = Default::default();
                for (_, received) in own() {
                    sums.iter_mut().zip(received[side].values()).for_each(|(sum, value)| sum.add(value));
                }
                let [one, two, more] = sums.map(|sum| sum.value());
                *impulse = [impulse[0] + one, impulse[1] + two];
                *work += more;
            }
        }
    }
}
