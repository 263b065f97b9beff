//! How and where a state loses stability.

use crate::lane::F8;
use crate::mesh::FACES;
use crate::tensor;

/// How a state lost stability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss {
    /// The cell (index in the mesh).
    pub cell: usize,
    /// The place in the cell.
    pub site: Site,
    /// What was lost.
    pub kind: LossKind,
}

/// Kinds of lost stability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LossKind {
    /// A number of the state is not finite.
    NotFinite,
    /// J <= 0: the material is turned inside out.
    Inverted(f64),
    /// The acoustic tensor has a negative eigenvalue.
    NotHyperbolic,
}

impl std::fmt::Display for LossKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LossKind::NotFinite => write!(f, "a number of the state is not finite"),
            LossKind::Inverted(j) => write!(f, "J = {j:.3e} <= 0: the material is turned inside out"),
            LossKind::NotHyperbolic => {
                write!(f, "loss of hyperbolicity: the acoustic tensor has a negative eigenvalue")
            }
        }
    }
}

/// A place in a cell where F is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// A material point, numbered in its cell.
    Point(usize),
    /// A grid node a = i M + j.
    Node(usize),
    /// A Gauss point of a face: the face (xi1 = 0, xi1 = 1, xi2 = 0, xi2 = 1) and the number of the point along it.
    Face(usize, usize),
}

impl std::fmt::Display for Site {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Site::Point(point) => write!(f, "material point {point}"),
            Site::Node(node) => write!(f, "grid node {node}"),
            Site::Face(face, point) => write!(f, "face point {point} of face {face}"),
        }
    }
}

/// A face point in a block whose J is not above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FacePoint {
    /// The block, by the number that it had before any partition.
    pub block: usize,
    /// The lane.
    pub lane: usize,
    /// The face and the point on it.
    pub at: [usize; 2],
    /// Its J.
    pub j: f64,
}

impl FacePoint {
    /// The place in the cell.
    pub fn site(&self) -> Site {
        Site::Face(self.at[0], self.at[1])
    }

    /// Of two the one in the block that comes first.
    pub fn first(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        match (one, other) {
            (Some(one), Some(other)) => Some(if other.block < one.block { other } else { one }),
            (one, other) => one.or(other),
        }
    }

    /// The point with a J that is not a number, else with the smallest, of the first `count` lanes of a block, from its traces, [face][point][`width`].
    #[cold]
    pub fn find(block: usize, count: usize, traces: &[F8], width: usize) -> Self {
        let m = traces.len() / width / FACES;
        let mut worst = Self { block, lane: 0, at: [0; 2], j: f64::INFINITY };
        for (number, trace) in traces.chunks_exact(width).enumerate() {
            for lane in 0..count {
                let j = tensor::det([0, 1, 2, 3].map(|k| trace[k].0[lane]));
                if j < worst.j || (j.is_nan() && !worst.j.is_nan()) {
                    worst = Self { block, lane, at: [number / m, number % m], j };
                }
            }
        }
        worst
    }
}
