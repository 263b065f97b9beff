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

/// The blocks. Cells keep their order within a law; the last block of a law is padded with its last cell.
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
}

impl Blocks {
    /// Blocks for cells with the given laws and links.
    pub fn new(material: &[usize], links: &[[Link; 4]]) -> Self {
        let laws = material.iter().max().map_or(0, |last| last + 1);
        let mut blocks = Self {
            cells: vec![],
            count: vec![],
            material: vec![],
            slot: vec![(0, 0); material.len()],
            neighbours: vec![],
        };
        for law in 0..laws {
            let cells: Vec<usize> = (0..material.len()).filter(|&cell| material[cell] == law).collect();
            for chunk in cells.chunks(LANES) {
                for (lane, &cell) in chunk.iter().enumerate() {
                    blocks.slot[cell] = (blocks.cells.len(), lane);
                }
                blocks.cells.push(std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)]));
                blocks.count.push(chunk.len());
                blocks.material.push(law);
            }
        }
        blocks.neighbours = (0..blocks.len()).map(|b| blocks.neighbours_of(b, material, links)).collect();
        blocks
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
        std::mem::size_of_val(&self.neighbours[..]) + std::mem::size_of_val(&self.cells[..])
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
