//! Cells in blocks of 8 lanes of one law, and where each face's neighbour keeps its trace.

use crate::lane::{F8, LANES};
use crate::mesh::Link;

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
    /// Anywhere: entry of [`Blocks::gathered`].
    Gathered(usize),
}

/// What the flux of a face of a block does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The other side.
    pub side: Side,
    /// Whether a lane is at a boundary or at another material.
    pub special: bool,
}

/// A block whose fluxes can be found once the traces of all blocks up to `after` are there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ready {
    /// The last of itself and its neighbours.
    pub after: usize,
    /// The block.
    pub block: usize,
}

/// The blocks; the last one of a law is padded with its last cell.
///
/// Which cells share a block is chosen by counting faces that are [`Side::Aligned`]. Far apart: the cells of a law, in
/// their order, are cut into eight runs, and lane l goes through the l-th, so that on structured meshes neighbours are in
/// the same lane of another block nearly everywhere. Side by side: eight cells that follow each other, which keeps
/// neighbours near in memory where the mesh has no such order. Bits of the cells do not depend on it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    /// The cell of each lane (padding repeats the last real one).
    pub cells: Vec<[usize; LANES]>,
    /// Number of real cells in each block.
    pub count: Vec<usize>,
    /// The law of each block.
    pub material: Vec<usize>,
    /// Block and lane of each cell.
    pub slot: Vec<(usize, usize)>,
    /// For each block, local face and lane the other side.
    pub neighbours: Vec<[[Neighbour; LANES]; 4]>,
    /// For each block and local face how to get at the other side.
    pub plan: Vec<[Plan; 4]>,
    /// Other sides lane by lane; lanes at a boundary and padding see themselves.
    pub gathered: Vec<[Across; LANES]>,
    /// All blocks in the order in which their neighbours are done, if blocks are done one by one.
    pub sequence: Vec<Ready>,
}

impl Blocks {
    /// Blocks for cells with the given laws and links.
    pub fn new(material: &[usize], links: &[[Link; 4]]) -> Self {
        let [near, far] = [side_by_side, far_apart].map(|order| Self::ordered(material, links, order));
        if far.aligned() > near.aligned() { far } else { near }
    }

    /// Blocks of the cells of each law in an `order`.
    fn ordered(material: &[usize], links: &[[Link; 4]], order: fn(usize) -> Vec<Vec<usize>>) -> Self {
        let laws = material.iter().max().map_or(0, |last| last + 1);
        let mut blocks = Self {
            cells: vec![],
            count: vec![],
            material: vec![],
            slot: vec![(0, 0); material.len()],
            neighbours: vec![],
            plan: vec![],
            gathered: vec![],
            sequence: vec![],
        };
        for law in 0..laws {
            let cells: Vec<usize> = (0..material.len()).filter(|&cell| material[cell] == law).collect();
            for chunk in order(cells.len()) {
                let chunk: Vec<usize> = chunk.into_iter().map(|k| cells[k]).collect();
                for (lane, &cell) in chunk.iter().enumerate() {
                    blocks.slot[cell] = (blocks.cells.len(), lane);
                }
                blocks.cells.push(std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)]));
                blocks.count.push(chunk.len());
                blocks.material.push(law);
            }
        }
        blocks.neighbours = (0..blocks.len()).map(|b| blocks.neighbours_of(b, material, links)).collect();
        for block in 0..blocks.len() {
            let plan = std::array::from_fn(|face| blocks.plan_of(block, face));
            blocks.plan.push(plan);
        }
        blocks.sequence = (0..blocks.len()).map(|block| blocks.ready(block)).collect();
        blocks.sequence.sort_by_key(|ready| (ready.after, ready.block));
        blocks
    }

    fn ready(&self, block: usize) -> Ready {
        let neighbours = self.neighbours[block].iter().flatten().filter_map(|neighbour| match neighbour {
            Neighbour::Cell(across) | Neighbour::Interface(across, _) => Some(across.face / 4),
            Neighbour::Boundary(_) | Neighbour::Padding => None,
        });
        Ready { after: neighbours.fold(block, usize::max), block }
    }

    /// Number of faces that are read as they lie.
    fn aligned(&self) -> usize {
        self.plan.iter().flatten().filter(|plan| matches!(plan.side, Side::Aligned(_))).count()
    }

    fn plan_of(&mut self, block: usize, face: usize) -> Plan {
        let lanes = self.neighbours[block][face];
        let special = lanes.iter().any(|n| matches!(n, Neighbour::Boundary(_) | Neighbour::Interface(..)));
        let own = |lane: usize| Across { face: 4 * block + face, lane, flip: false };
        // Padding stays at rest only where it sees itself: a block that has it is never aligned.
        let (mut across, mut source, mut aligned) = ([own(0); LANES], None, self.count[block] == LANES);
        for (lane, neighbour) in lanes.iter().enumerate() {
            match *neighbour {
                Neighbour::Cell(there) | Neighbour::Interface(there, _) => {
                    across[lane] = there;
                    aligned &= there.lane == lane && !there.flip && *source.get_or_insert(there.face) == there.face;
                }
                Neighbour::Boundary(_) | Neighbour::Padding => across[lane] = own(lane),
            }
        }
        if aligned {
            return Plan { side: Side::Aligned(source.unwrap_or(4 * block + face)), special };
        }
        self.gathered.push(across);
        Plan { side: Side::Gathered(self.gathered.len() - 1), special }
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there is no block.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        std::mem::size_of_val(&self.neighbours[..])
            + std::mem::size_of_val(&self.cells[..])
            + std::mem::size_of_val(&self.plan[..])
            + std::mem::size_of_val(&self.gathered[..])
            + std::mem::size_of_val(&self.sequence[..])
    }

    fn neighbours_of(&self, block: usize, material: &[usize], links: &[[Link; 4]]) -> [[Neighbour; LANES]; 4] {
        let law = self.material[block];
        std::array::from_fn(|face| {
            std::array::from_fn(|lane| {
                if lane >= self.count[block] {
                    return Neighbour::Padding;
                }
                match links[self.cells[block][lane]][face] {
                    Link::Boundary(group) => Neighbour::Boundary(group),
                    Link::Cell { cell, face, flip } => {
                        let (block, lane) = self.slot[cell];
                        let across = Across { face: 4 * block + face, lane, flip };
                        if material[cell] == law {
                            Neighbour::Cell(across)
                        } else {
                            Neighbour::Interface(across, material[cell])
                        }
                    }
                }
            })
        })
    }

    /// Numbers per cell, `[cell][stride]`, to blocks, `[block][stride]`; padding lanes get `padding(k)`.
    pub fn pack(&self, values: &[f64], stride: usize, padding: impl Fn(usize) -> f64) -> Vec<F8> {
        let mut out = Vec::with_capacity(self.len() * stride);
        for (cells, &count) in self.cells.iter().zip(&self.count) {
            for k in 0..stride {
                out.push(F8(std::array::from_fn(|lane| {
                    if lane < count { values[cells[lane] * stride + k] } else { padding(k) }
                })));
            }
        }
        out
    }

    /// The inverse of [`Blocks::pack`].
    pub fn unpack(&self, values: &[F8], stride: usize) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.slot.len() * stride);
        for &(block, lane) in &self.slot {
            out.extend((0..stride).map(|k| values[block * stride + k].0[lane]));
        }
        out
    }
}

/// Blocks of `count` cells that follow each other.
fn side_by_side(count: usize) -> Vec<Vec<usize>> {
    (0..count).step_by(LANES).map(|first| (first..count.min(first + LANES)).collect()).collect()
}

/// Blocks of one cell of each of eight runs. Runs differ by at most one cell, the longer ones first.
fn far_apart(count: usize) -> Vec<Vec<usize>> {
    let (short, longer) = (count / LANES, count % LANES);
    let start = |lane: usize| lane * short + lane.min(longer);
    let runs = |k: usize| if k < short { LANES } else { longer };
    (0..count.div_ceil(LANES)).map(|k| (0..runs(k)).map(|lane| start(lane) + k).collect()).collect()
}
