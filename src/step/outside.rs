//! The work that the outside does on the body in a step: metered in every run, since it is known at boundary points and in
//! cells with sources at next to no cost.

use super::{Scheme, Work};
use crate::lane::F8;
use crate::operators::Neighbour;

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

/// That of all blocks on which something outside acts; the others have no entry.
pub(super) struct Outside {
    /// Entries before each block (length: blocks + 1).
    pub first: Vec<u32>,
    /// The cells of the block of each entry.
    cells: Vec<usize>,
    /// The entries.
    pub entries: Vec<ExternalWork>,
}

impl Outside {
    /// No work on any block of a scheme yet.
    pub fn new(scheme: &Scheme) -> Self {
        let blocks = &scheme.operators.blocks;
        let mut out = Self { first: vec![0], cells: vec![], entries: vec![] };
        for (faces, &count) in blocks.neighbours.iter().zip(&blocks.count) {
            let at_boundary = faces.iter().flatten().any(|beyond| matches!(beyond, Neighbour::Boundary(_)));
            if at_boundary || !scheme.sources.is_empty() {
                out.cells.push(count);
            }
            out.first.push(out.cells.len() as u32);
        }
        out.entries = vec![ExternalWork::default(); out.cells.len()];
        out
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..]) + size_of_val(&self.cells[..]) + size_of_val(&self.entries[..])
    }
}

/// The entry of a block among `all`, those of the blocks from `start` on.
#[inline]
pub(super) fn entry<'a>(
    first: &[u32],
    start: usize,
    all: &'a mut [ExternalWork],
    block: usize,
) -> Option<&'a mut ExternalWork> {
    let (from, to) = (first[block], first[block + 1]);
    if from == to { None } else { all.get_mut((from - first[start]) as usize) }
}

impl Work {
    /// The work of the boundary and of sources in the last step, J/m, cells in a fixed order.
    pub fn external_work(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (work, &cells) in self.outside.entries.iter().zip(&self.outside.cells) {
            sum[0] += work.boundary.0[..cells].iter().sum::<f64>();
            sum[1] += work.source.0[..cells].iter().sum::<f64>();
        }
        sum
    }
}
