//! For each face of a block: the place of the trace on its other side.

use crate::lane::LANES;

/// The face of a neighbour, seen from this side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Across {
    /// The face among all faces of all blocks: 4 block + local face.
    pub face: usize,
    /// The lane of the cell.
    pub lane: usize,
    /// Whether its points run in the opposite direction.
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

/// The places of the traces on the other side of a face of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The other side of each lane is the same lane of one face of one block, with the points in the same order: it is read
    /// without any reordering. For lanes at a boundary the values there are meaningless and must not be used.
    Aligned(usize),
    /// The other side of lane l is lane l + `by` of the `first` face for l < 8 - `by`, and lane l + `by` - 8 of the
    /// `second` for the rest, with the points in the same order. This is so for cells in rows. For lanes at a boundary
    /// the values there are meaningless and must not be used.
    Joined {
        /// A face, 4 block + local face.
        first: usize,
        /// Another face, or the same.
        second: usize,
        /// The shift of lanes, 1 to 7.
        by: usize,
    },
    /// The other sides are at different places: entry of [`super::Blocks::gathered`].
    Gathered(usize),
}

/// What the flux needs to know of a face of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The places of the other side.
    pub side: Side,
    /// Whether a lane is at a boundary or at another material.
    pub has_boundary_or_interface: bool,
}

/// The lanes whose other sides are in one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Source {
    /// The face, 4 block + local face.
    pub face: u32,
    /// Whether its points run in the opposite direction.
    pub flip: bool,
    /// A bit for each lane.
    pub lanes: u8,
}

/// The other sides of the lanes of a face, at different places. Those that are in one face of a block are read
/// together. On a mesh without rows the other sides are in five faces of blocks on average, and in eight at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gathered {
    /// The lane of the other side of each lane.
    pub lane: [u8; LANES],
    /// How many entries of `all` are used.
    count: u8,
    all: [Source; LANES],
}

impl Gathered {
    /// The faces that have the other sides. Each lane is in one of them.
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

    /// From the other sides of the lanes.
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

/// Whether the other sides of the lanes follow each other in one or two faces.
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
