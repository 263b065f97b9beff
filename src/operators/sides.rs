//! Where the trace across each face of a block lies.

use crate::lane::LANES;

/// A face of a cell as the neighbour across it sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Across {
    /// The face among all faces of all blocks: 4 block + local face.
    pub face: usize,
    /// The lane of the cell.
    pub lane: usize,
    /// Whether its points run the other way.
    pub flip: bool,
}

/// The other side of a face, for one lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Neighbour {
    /// A cell of the same law.
    Cell(Across),
    /// A cell of another law, with the number of that law.
    Interface(Across, usize),
    /// A boundary group of the mesh.
    Boundary(usize),
    /// A lane that fills up the block.
    Padding,
}

/// Where the traces across a face of a block lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Each lane's in the same lane of one face of one block, with the points in the same order: read as it lies. Lanes
    /// at a boundary find there what they must not use.
    Aligned(usize),
    /// Lane l in lane l + `by` of the `first` face for l < 8 - `by`, then in lane l + `by` - 8 of the `second`, with the
    /// points in the same order: cells in rows. Lanes at a boundary find there what they must not use.
    Joined {
        /// A face, 4 block + local face.
        first: usize,
        /// Another, or the same.
        second: usize,
        /// 1 to 7.
        by: usize,
    },
    /// Anywhere: entry of [`super::Blocks::gathered`].
    Gathered(usize),
}

/// What the flux of a face of a block does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The other side.
    pub side: Side,
    /// Whether a lane is at a boundary or at another material.
    pub has_boundary_or_interface: bool,
}

/// Lanes whose other sides lie in one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Source {
    /// The face, 4 block + local face.
    pub face: u32,
    /// Whether its points run the other way.
    pub flip: bool,
    /// A bit for each lane.
    pub lanes: u8,
}

/// The other sides of lanes that lie anywhere. Those that one face has are read together: neighbouring cells of a mesh without
/// rows have five faces of blocks across theirs in the middle, at most eight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gathered {
    /// The lane of the other side of each lane.
    pub lane: [u8; LANES],
    /// How many of `all` count.
    count: u8,
    all: [Source; LANES],
}

impl Gathered {
    /// The faces in which the other sides lie; each lane is in one of them.
    pub fn sources(&self) -> &[Source] {
        &self.all[..usize::from(self.count)]
    }

    /// The other side of a lane.
    pub fn across(&self, lane: usize) -> Across {
        // Each lane is in one source.
        let at = self.sources().iter().position(|source| source.lanes >> lane & 1 == 1).unwrap_or(0);
        let Source { face, flip, .. } = self.all[at];
        Across { face: face as usize, lane: usize::from(self.lane[lane]), flip }
    }

    /// Of the other sides.
    pub fn of(across: &[Across; LANES]) -> Self {
        let none = Source { face: 0, flip: false, lanes: 0 };
        let mut out = Self { lane: across.map(|there| there.lane as u8), count: 0, all: [none; LANES] };
        for (lane, there) in across.iter().enumerate() {
            let same = |source: &Source| source.face as usize == there.face && source.flip == there.flip;
            let at = out.sources().iter().position(same).unwrap_or_else(|| {
                out.count += 1;
                let at = usize::from(out.count) - 1;
                out.all[at] = Source { face: there.face as u32, flip: there.flip, lanes: 0 };
                at
            });
            out.all[at].lanes |= 1 << lane;
        }
        out
    }
}

/// Whether the lanes across a face follow each other in one or two faces.
pub(super) fn joined(across: &[Across; LANES], neighbours: &[Neighbour; LANES]) -> Option<Side> {
    let is_cell = |lane: &usize| matches!(neighbours[*lane], Neighbour::Cell(_) | Neighbour::Interface(..));
    (1..LANES).find_map(|by| {
        let mut faces = [None; 2];
        for lane in (0..LANES).filter(is_cell) {
            let (at, second) = (across[lane], lane + by >= LANES);
            let face = *faces[usize::from(second)].get_or_insert(at.face);
            if at != (Across { face, lane: (lane + by) % LANES, flip: false }) {
                return None;
            }
        }
        let any = faces[0].or(faces[1])?;
        Some(Side::Joined { first: faces[0].unwrap_or(any), second: faces[1].unwrap_or(any), by })
    })
}
