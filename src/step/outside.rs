//! The work that the outside does on the body in a step: metered in every run, since it is known at boundary points and in
//! cells with sources at next to no cost.

use super::{Scheme, Work};
use crate::lane::F8;
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::state::Received;

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
    /// int x cross t* over face and time, N m s/m, with the positions at the start of the step; 0 where angular momentum is not kept.
    pub torque: [F8; FACES],
}

/// That of all blocks on which something outside acts; the others have no entry.
pub(super) struct Outside {
    /// Entries before each block (length: blocks + 1).
    pub first: Vec<u32>,
    /// The cells of the block of each entry.
    cells: Vec<usize>,
    /// The entries.
    pub entries: Vec<ExternalWork>,
    /// By face, beside the entries; none where nobody asks for forces: nothing is allocated and nothing is done for them then.
    pub forces: Option<Vec<FaceForces>>,
}

impl Outside {
    /// No work on any block of a scheme yet.
    pub fn new(scheme: &Scheme) -> Self {
        let blocks = &scheme.operators.blocks;
        let mut out = Self { first: vec![0], cells: vec![], entries: vec![], forces: None };
        for (faces, &count) in blocks.neighbours.iter().zip(&blocks.count) {
            let at_boundary = faces.iter().flatten().any(|beyond| matches!(beyond, Neighbour::Boundary(_)));
            if at_boundary || !scheme.sources.is_empty() {
                out.cells.push(count);
            }
            out.first.push(out.cells.len() as u32);
        }
        out.entries = vec![ExternalWork::default(); out.cells.len()];
        // The work between faces is told from that of the outside by them; and the torque on each body is metered with them.
        let metered = scheme.contacts.is_some() || scheme.keeps_angular_momentum();
        out.forces = metered.then(|| vec![FaceForces::default(); out.cells.len()]);
        out
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..])
            + size_of_val(&self.cells[..])
            + size_of_val(&self.entries[..])
            + self.forces.as_ref().map_or(0, |forces| size_of_val(&forces[..]))
    }
}

/// The entry of a block among `all`, works or forces, those of the blocks from `start` on.
#[inline]
pub(super) fn entry<'a, T>(first: &[u32], start: usize, all: &'a mut [T], block: usize) -> Option<&'a mut T> {
    let (from, to) = (first[block], first[block + 1]);
    if from == to { None } else { all.get_mut((from - first[start]) as usize) }
}

impl Work {
    /// The work of the boundary, of sources, and of what acts between faces of the body in the last step, J/m, cells in a fixed order. The
    /// last is no work of the outside: contact takes it from the body.
    pub fn external_work(&self, scheme: &Scheme) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (work, &cells) in self.outside.entries.iter().zip(&self.outside.cells) {
            sum[0] += work.boundary.0[..cells].iter().sum::<f64>();
            sum[1] += work.source.0[..cells].iter().sum::<f64>();
        }
        if let (Some(contacts), Some(forces)) = (&scheme.contacts, &self.outside.forces) {
            for face in &contacts.faces {
                let entry = self.outside.first[face.face / FACES] as usize;
                sum[2] += forces[entry].work[face.face % FACES].0[face.lane];
            }
            sum[0] -= sum[2];
        }
        sum
    }

    /// With the memory that forces need; the steps then meter them.
    pub fn with_forces(mut self) -> Self {
        self.outside.forces = Some(vec![FaceForces::default(); self.outside.entries.len()]);
        self
    }

    /// Whether the steps meter forces.
    pub fn has_forces(&self) -> bool {
        self.outside.forces.is_some()
    }

    /// Adds what the last step received through each boundary group to `before`, into the new state; blocks, faces and cells in a
    /// fixed order. Nothing where forces are not metered.
    pub(super) fn receive(&mut self, scheme: &Scheme, before: &[Received]) {
        let Some(forces) = &self.outside.forces else { return };
        let (blocks, out) = (&scheme.operators.blocks, &mut self.next.received);
        out.clear();
        out.extend_from_slice(before);
        for (block, &count) in blocks.count.iter().enumerate() {
            let entries = self.outside.first[block] as usize..self.outside.first[block + 1] as usize;
            let Some(entry) = forces[entries].first() else { continue };
            for (face, neighbours) in blocks.neighbours[block].iter().enumerate() {
                for (lane, neighbour) in neighbours.iter().enumerate().take(count) {
                    let Neighbour::Boundary(group) = neighbour else { continue };
                    let Some(out) = out.get_mut(*group) else { continue };
                    (0..2).for_each(|axis| out.impulse[axis] += entry.impulse[face][axis].0[lane]);
                    out.work += entry.work[face].0[lane];
                }
            }
        }
    }
}
