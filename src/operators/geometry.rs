//! Metric terms of bilinear cells, per block of 8.
//!
//! All metric terms follow from the three vectors of the map X(xi) = X0 + a xi1 + b xi2 + c xi1 xi2. Kernels compute
//! them where they need them: a few operations cost less than reading some numbers for each node from memory.

use super::{Blocks, Line};
use crate::lane::{F8, LANES, Lane, Lanes, load_array};
use crate::mesh::{FACES, Mesh, map};

/// The map of a cell, or with [`F8`] of the 8 cells of a block; m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Metric<T> {
    /// dX/dxi1 at xi2 = 0.
    along1: [T; 2],
    /// dX/dxi2 at xi1 = 0.
    along2: [T; 2],
    /// d2X/dxi1 dxi2; 0 for parallelograms.
    twist: [T; 2],
    /// 1 / lengths of the faces, 1/m.
    pub inverse_length: [T; FACES],
    /// h_e.
    pub h: T,
}

impl Metric<F8> {
    /// The map of eight cells, one a lane.
    #[inline(always)]
    pub fn load<L: Lanes>(&self) -> Metric<L> {
        Metric {
            along1: load_array(&self.along1),
            along2: load_array(&self.along2),
            twist: load_array(&self.twist),
            inverse_length: load_array(&self.inverse_length),
            h: L::load(&self.h),
        }
    }

    /// The map of the cell in one lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> Metric<f64> {
        let pair = |x: &[F8; 2]| x.map(|x| x.0[lane]);
        Metric {
            along1: pair(&self.along1),
            along2: pair(&self.along2),
            twist: pair(&self.twist),
            inverse_length: self.inverse_length.map(|x| x.0[lane]),
            h: self.h.0[lane],
        }
    }
}

impl<L: Lane> Metric<L> {
    /// J dxi_1/dX_a at xi1, m; it does not depend on xi2. J is the determinant of dX/dxi (an area; not that of F).
    #[inline(always)]
    pub fn cofactor1(&self, xi1: f64) -> [L; 2] {
        let xi1 = L::splat(xi1);
        [xi1.mul_add(self.twist[1], self.along2[1]), -xi1.mul_add(self.twist[0], self.along2[0])]
    }

    /// J dxi_2/dX_a at xi2, m; it does not depend on xi1.
    #[inline(always)]
    pub fn cofactor2(&self, xi2: f64) -> [L; 2] {
        let xi2 = L::splat(xi2);
        [-xi2.mul_add(self.twist[1], self.along1[1]), xi2.mul_add(self.twist[0], self.along1[0])]
    }

    /// The outward normal of a face times its length, m.
    #[inline(always)]
    pub fn face(&self, face: usize) -> [L; 2] {
        match face {
            0 => minus(self.cofactor1(0.0)),
            1 => self.cofactor1(1.0),
            2 => minus(self.cofactor2(0.0)),
            _ => self.cofactor2(1.0),
        }
    }

    /// The unit outward normal of a face.
    #[inline(always)]
    pub fn normal(&self, face: usize) -> [L; 2] {
        let n = self.face(face);
        [n[0] * self.inverse_length[face], n[1] * self.inverse_length[face]]
    }

    /// The length of a face, m.
    #[inline(always)]
    pub fn length(&self, face: usize) -> L {
        let n = self.face(face);
        n[0].mul_add(n[0], n[1] * n[1]) * self.inverse_length[face]
    }
}

#[inline(always)]
fn minus<L: Lane>(x: [L; 2]) -> [L; 2] {
    [-x[0], -x[1]]
}

/// J from the cofactors J dxi_1/dX, J dxi_2/dX, m^2.
#[inline(always)]
pub fn determinant<L: Lane>(one: [L; 2], two: [L; 2]) -> L {
    one[0].mul_add(two[1], -(one[1] * two[0]))
}

/// Metric terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// The map of each block.
    pub blocks: Vec<Metric<F8>>,
    /// Corners X, m: `[block][corner][2]`.
    pub corners: Vec<F8>,
}

impl Geometry {
    /// Metric terms of all blocks.
    pub fn new(mesh: &Mesh, blocks: &Blocks) -> Self {
        let mut out = Self { blocks: vec![], corners: vec![] };
        for cells in &blocks.cells {
            out.push(cells.map(|cell| mesh.corners(cell)));
        }
        out
    }

    fn push(&mut self, corners: [[[f64; 2]; 4]; LANES]) {
        let number = |of: &dyn Fn(&map::Corners) -> f64| F8(std::array::from_fn(|lane| of(&corners[lane])));
        let mut metric = Metric {
            along1: [0, 1].map(|k| number(&|x| x[1][k] - x[0][k])),
            along2: [0, 1].map(|k| number(&|x| x[3][k] - x[0][k])),
            twist: [0, 1].map(|k| number(&|x| (x[0][k] - x[1][k]) + (x[2][k] - x[3][k]))),
            inverse_length: [F8::ZERO; FACES],
            h: number(&map::h_e),
        };
        for lane in 0..LANES {
            let one = metric.lane(lane);
            for face in 0..FACES {
                let n = one.face(face);
                metric.inverse_length[face].0[lane] = 1.0 / n[0].hypot(n[1]);
            }
        }
        self.blocks.push(metric);
        self.corners.extend((0..8).map(|k| number(&|x| x[k / 2][k % 2])));
    }

    /// Corners of the cell in a lane of a block.
    pub fn corners_of(&self, block: usize, lane: usize) -> [[f64; 2]; 4] {
        std::array::from_fn(|corner| std::array::from_fn(|k| self.corners[(block * 4 + corner) * 2 + k].0[lane]))
    }

    /// h_e of all cells, m, by block.
    pub fn h(&self) -> impl Iterator<Item = &F8> {
        self.blocks.iter().map(|metric| &metric.h)
    }

    /// The diagonal, exact mass matrix w_a J_a of the cell in a lane of a block, m^2: by node of `line`.
    pub fn masses(&self, line: &Line, block: usize, lane: usize) -> impl Iterator<Item = f64> {
        let metric = self.blocks[block].lane(lane);
        let nodes = (0..line.m).flat_map(move |i| (0..line.m).map(move |j| (i, j)));
        nodes.map(move |(i, j)| {
            let (xi1, xi2) = (line.basis.nodes[i], line.basis.nodes[j]);
            let weight = line.basis.weights[i] * line.basis.weights[j];
            weight * determinant(metric.cofactor1(xi1), metric.cofactor2(xi2))
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.blocks[..]) + size_of_val(&self.corners[..])
    }
}
