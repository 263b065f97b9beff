//! Quadrilateral meshes: geometry and groups only; a mesh knows nothing of a solver.

mod axes;
pub mod check;
mod error;
pub mod faces;
pub mod map;
pub mod parts;
pub mod periodic;
pub mod quality;
pub mod recover;
mod refine;
mod split;
pub mod structured;
mod summary;

pub use error::Error;
pub use faces::links;
use map::{Bulge, CellMap};
pub use periodic::periodic_links;
pub use structured::rectangle;

/// A mesh of quadrilaterals, bilinear or curved, in the initial configuration, in metres.
///
/// Corner `k` of a cell has the parent coordinates (0,0), (1,0), (1,1), (0,1) for k = 0..4, and the
/// corners run counter-clockwise. Local faces: 0 is xi1 = 0 (corners 0, 3), 1 is xi1 = 1 (corners 1, 2),
/// 2 is xi2 = 0 (corners 0, 1), 3 is xi2 = 1 (corners 3, 2); a face is run through in the direction of
/// its increasing parent coordinate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Node coordinates X, in m.
    pub nodes: Vec<[f64; 2]>,
    /// The four nodes of each cell, counter-clockwise.
    pub cells: Vec<[usize; 4]>,
    /// For each cell the index of its group in [`Mesh::groups`].
    pub cell_group: Vec<usize>,
    /// Names of the cell groups (physical surfaces).
    pub groups: Vec<String>,
    /// The boundary edges that bear a group.
    pub edges: Vec<BoundaryEdge>,
    /// Names of the boundary groups (physical curves).
    pub edge_groups: Vec<String>,
    /// Number of each cell in the file that it came from (for messages and output).
    pub original: Vec<u64>,
    /// How the edges of each cell are curved, [`map::Bulge`]; empty where all edges are straight. Two cells at an edge have the
    /// same bits there.
    pub bulges: Vec<Bulge>,
}

impl Mesh {
    /// The corners of a cell, in m: corner k at the parent coordinates (0,0), (1,0), (1,1), (0,1).
    pub fn corners(&self, cell: usize) -> [[f64; 2]; 4] {
        self.cells[cell].map(|node| self.nodes[node])
    }

    /// The map of a cell.
    pub fn map(&self, cell: usize) -> CellMap {
        CellMap { corners: self.corners(cell), bulge: map::bulge_in(&self.bulges, cell) }
    }

    /// How many cells have a curved edge.
    pub fn curved_cells(&self) -> usize {
        self.bulges.iter().filter(|bulge| **bulge != Bulge::default()).count()
    }

    /// The number of a cell in messages: its number in the file, or its index from 1 if the mesh comes from no file.
    pub fn number(&self, cell: usize) -> u64 {
        self.original.get(cell).copied().unwrap_or(cell as u64 + 1)
    }

    /// min_e h_e, m: the time step is proportional to it.
    pub fn smallest_h(&self) -> f64 {
        (0..self.cells.len()).map(|cell| map::h_e(&self.map(cell))).fold(f64::INFINITY, f64::min)
    }

    /// The smallest height of a cell ([`map::height`]), m.
    pub fn smallest_height(&self) -> f64 {
        (0..self.cells.len()).map(|cell| map::height(&self.map(cell))).fold(f64::INFINITY, f64::min)
    }

    /// The lower left and the upper right corner of the box around its nodes and the middles of its edges, m.
    pub fn extent(&self) -> [[f64; 2]; 2] {
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let middles = (0..self.bulges.len()).flat_map(|cell| {
            let map = self.map(cell);
            [[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0]].map(|xi| map::position(&map, xi))
        });
        self.nodes.iter().copied().chain(middles).fold(start, |[low, high], x| {
            [[low[0].min(x[0]), low[1].min(x[1])], [high[0].max(x[0]), high[1].max(x[1])]]
        })
    }

    /// The two nodes of a face, in the direction of increasing parent coordinate.
    pub fn face_nodes(&self, cell: usize, face: usize) -> [usize; 2] {
        FACE_CORNERS[face].map(|corner| self.cells[cell][corner])
    }
}

/// A boundary edge: local face `face` of cell `cell` belongs to boundary group `group`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundaryEdge {
    /// The cell.
    pub cell: usize,
    /// Its local face, 0..4.
    pub face: usize,
    /// Index in [`Mesh::edge_groups`].
    pub group: usize,
}

/// Faces of a cell: xi1 = 0, xi1 = 1, xi2 = 0, xi2 = 1.
pub const FACES: usize = 4;

/// Corners (first, last) of local face f, in the direction of increasing parent coordinate.
pub const FACE_CORNERS: [[usize; 2]; FACES] = [[0, 3], [1, 2], [0, 1], [3, 2]];

/// The other side of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Link {
    /// Another cell's face; `flip` where the two run in opposite directions.
    Cell {
        /// The other cell.
        cell: usize,
        /// Its local face.
        face: usize,
        /// Whether the faces run in opposite directions.
        flip: bool,
    },
    /// The boundary group with this index in [`Mesh::edge_groups`].
    Boundary(usize),
}

impl Link {
    /// The cell on the other side.
    pub fn cell(&self) -> Option<usize> {
        match *self {
            Link::Cell { cell, .. } => Some(cell),
            Link::Boundary(_) => None,
        }
    }
}
