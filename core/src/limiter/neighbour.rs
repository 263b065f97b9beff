//! The cells around a cell, and how their axes lie to its own.

use crate::mesh::FACES;
use crate::operators::{Blocks, Neighbour};

/// How the axes of another cell lie, seen from a cell: its axis d is the other's axis d, or 1 - d where they are swapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Axes {
    /// Whether xi1 of one is along xi2 of the other.
    pub swapped: bool,
    /// For each own axis, whether the other's runs in the opposite direction.
    pub reversed: [bool; 2],
}

impl Axes {
    /// The axis of the other cell along an own axis.
    pub fn of(self, axis: usize) -> usize {
        axis ^ usize::from(self.swapped)
    }

    /// The axes of a third cell that is seen from the second with `next`.
    pub fn then(self, next: Axes) -> Axes {
        let reversed = [0, 1].map(|axis| self.reversed[axis] ^ next.reversed[self.of(axis)]);
        Axes { swapped: self.swapped ^ next.swapped, reversed }
    }
}

/// A cell of the same law behind a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Behind {
    /// Its block.
    pub block: usize,
    /// Its lane.
    pub lane: usize,
    /// Its face.
    pub face: usize,
    /// Whether the points of its face run in the opposite direction.
    pub flip: bool,
    /// Its axes.
    pub axes: Axes,
}

/// The cell of the same law behind a face; none at a boundary and at another material, whose F jumps as it should.
pub fn behind(blocks: &Blocks, block: usize, lane: usize, face: usize) -> Option<Behind> {
    let Neighbour::Cell(there) = blocks.neighbours[block][face][lane] else { return None };
    let other = there.face % FACES;
    let mut reversed = [false; 2];
    // Both are seen along the way out of the first: through a high end into a low end is the same direction.
    reversed[face / 2] = face % 2 == other % 2;
    reversed[1 - face / 2] = there.flip;
    let axes = Axes { swapped: face / 2 != other / 2, reversed };
    Some(Behind { block: there.face / FACES, lane: there.lane, face: other, flip: there.flip, axes })
}

/// Most cells around a corner that are looked at.
const MOST_AROUND: usize = 16;

/// Calls `see` for each cell of the same law around a corner, but for the cell itself: block, lane and axes. The corner lies at the ends
/// `ends` (0 or 1) of the axes.
pub fn around(
    blocks: &Blocks,
    (block, lane): (usize, usize),
    ends: [usize; 2],
    see: &mut dyn FnMut(usize, usize, Axes),
) {
    for axis in 0..2 {
        let (mut at, mut axes, mut corner, mut leave) = ((block, lane), Axes::default(), ends, axis);
        for _ in 0..MOST_AROUND {
            let Some(next) = behind(blocks, at.0, at.1, 2 * leave + corner[leave]) else { break };
            if (next.block, next.lane) == (block, lane) {
                // All around.
                return;
            }
            // The corner, in the axes of the next cell: at the face that was crossed, and along it where it was.
            let mut there = [0; 2];
            there[next.face / 2] = next.face % 2;
            there[1 - next.face / 2] = corner[1 - leave] ^ usize::from(next.flip);
            axes = axes.then(next.axes);
            see(next.block, next.lane, axes);
            (at, corner, leave) = ((next.block, next.lane), there, 1 - next.face / 2);
        }
    }
}
