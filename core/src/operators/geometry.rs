//! Metric terms of cells, per block of 8.
//!
//! Of straight cells all metric terms follow from the three vectors of the map X(xi) = X0 + a xi1 + b xi2 + c xi1 xi2. Kernels
//! compute them where they need them: a few operations cost less than reading some numbers for each node from memory. Blocks with
//! a curved cell have theirs in memory ([`super::curved`]).

use super::curved::{Curved, CurvedBlock};
use super::{Blocks, Line};
use crate::lane::{F8, LANES, Lane, Lanes, load_array, store_array};
use crate::mesh::map::{self, CellMap};
use crate::mesh::{FACES, Mesh};

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
    inverse_length: [T; FACES],
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

/// J dxi_1/dX and J dxi_2/dX at the nodes (i, j) of a block, as a kernel has them.
pub trait Cofactors<L>: Copy {
    /// J dxi_1/dX, m.
    fn one(&self, i: usize, j: usize) -> [L; 2];
    /// J dxi_2/dX, m.
    fn two(&self, i: usize, j: usize) -> [L; 2];
}

/// Those of straight cells: the first by the nodes of xi1, the second by those of xi2.
impl<L: Lane, const M: usize> Cofactors<L> for [[[L; 2]; M]; 2] {
    #[inline(always)]
    fn one(&self, i: usize, _: usize) -> [L; 2] {
        self[0][i]
    }

    #[inline(always)]
    fn two(&self, _: usize, j: usize) -> [L; 2] {
        self[1][j]
    }
}

/// What gives the [`Cofactors`] of a block to a kernel.
pub trait NodeMetric: Copy {
    /// What they are with M nodes a direction.
    type At<L: Lanes, const M: usize>: Cofactors<L>;
    /// Finds them.
    fn cofactors<L: Lanes, const M: usize>(self, line: &Line) -> Self::At<L, M>;
}

impl NodeMetric for &Metric<F8> {
    type At<L: Lanes, const M: usize> = [[[L; 2]; M]; 2];

    #[inline(always)]
    fn cofactors<L: Lanes, const M: usize>(self, line: &Line) -> [[[L; 2]; M]; 2] {
        let (metric, nodes, mut out) = (self.load::<L>(), &line.basis.nodes[..M], [[[L::zero(); 2]; M]; 2]);
        for k in 0..M {
            out[0][k] = metric.cofactor1(nodes[k]);
            out[1][k] = metric.cofactor2(nodes[k]);
        }
        out
    }
}

/// The metric terms of a block.
#[derive(Debug, Clone, Copy)]
pub struct BlockMetric<'a> {
    /// Those of its cells with straight edges.
    pub straight: &'a Metric<F8>,
    /// Those of its cells as they are; none where all edges are straight.
    pub curved: Option<CurvedBlock<'a>>,
}

/// Runs `$body` with `$terms` as the [`NodeMetric`] of a block: once for straight cells, once for curved ones.
macro_rules! with_terms {
    ($metric:expr, $terms:ident => $body:expr) => {
        match $metric.curved {
            None => {
                let $terms = $metric.straight;
                $body
            }
            Some($terms) => $body,
        }
    };
}
pub(crate) use with_terms;

impl<'a> BlockMetric<'a> {
    /// The unit outward normal at a point of a face and the length of the face there (|dX/ds|, m), for the points of a face one after the
    /// other. On straight faces one is as the other: see [`BlockMetric::runs`].
    #[inline(always)]
    pub fn at_face<L: Lanes>(&self, face: usize, point: usize) -> ([L; 2], L) {
        match self.curved {
            None => {
                let metric = self.straight.load::<L>();
                (metric.normal(face), metric.length(face))
            }
            Some(curved) => curved.at_face(face, point),
        }
    }

    /// 1/|dX/ds| at a point of a face, 1/m.
    #[inline(always)]
    pub fn inverse_length<L: Lanes>(&self, face: usize, point: usize) -> L {
        match self.curved {
            None => L::load(&self.straight.inverse_length[face]),
            Some(curved) => L::splat(1.0) / curved.at_face::<L>(face, point).1,
        }
    }

    /// How the `points` of a face lie in runs of one normal and length: the number of runs, and of points in each.
    #[inline(always)]
    pub fn runs(&self, points: usize) -> [usize; 2] {
        if self.curved.is_some() { [points, 1] } else { [1, points] }
    }

    /// The unit outward normals of the four faces, of straight cells; those of curved ones are [`BlockMetric::normal_at`].
    #[inline(always)]
    pub fn normals<L: Lanes>(&self) -> [[L; 2]; FACES] {
        let metric = self.straight.load::<L>();
        [metric.normal(0), metric.normal(1), metric.normal(2), metric.normal(3)]
    }

    /// The unit outward normals at the points of the faces, one after the other, and for how many points each is: on straight faces
    /// one for all `points`, in the `room`. The third number of each is none of them. (No point asks whether its face is curved.)
    #[inline(always)]
    pub fn normals_of_points<'r, L: Lanes>(
        &self,
        points: usize,
        room: &'r mut [[F8; 3]; FACES],
    ) -> (&'r [[F8; 3]], usize)
    where
        'a: 'r,
    {
        // All of the room, and always: then nobody need clear it.
        for (room, normal) in room.iter_mut().zip(&self.normals::<L>()) {
            store_array([normal[0], normal[1], L::zero()], room);
        }
        match self.curved {
            None => (room, points),
            Some(curved) => (curved.faces(), 1),
        }
    }

    /// The unit outward normal at a point of a face, `straight` being that of a straight face.
    #[inline(always)]
    pub fn normal_at<L: Lanes>(&self, straight: [L; 2], face: usize, point: usize) -> [L; 2] {
        match self.curved {
            None => straight,
            Some(curved) => curved.at_face(face, point).0,
        }
    }

    /// The unit outward normal at a point of a face of the cell in a lane, and the length of the face there, m.
    pub fn at_face_of(&self, lane: usize, face: usize, point: usize) -> ([f64; 2], f64) {
        match self.curved {
            None => {
                let metric = self.straight.lane(lane);
                (metric.normal(face), metric.length(face))
            }
            Some(curved) => curved.at_face_of(lane, face, point),
        }
    }

    /// J dxi_1/dX and J dxi_2/dX at node (i, j), m.
    #[inline(always)]
    pub fn at_node<L: Lanes>(&self, line: &Line, i: usize, j: usize) -> [[L; 2]; 2] {
        match self.curved {
            None => {
                let (metric, nodes) = (self.straight.load::<L>(), &line.basis.nodes);
                [metric.cofactor1(nodes[i]), metric.cofactor2(nodes[j])]
            }
            Some(curved) => [curved.one(i, j), curved.two(i, j)],
        }
    }

    /// The same of the cell in a lane.
    pub fn at_node_of(&self, line: &Line, lane: usize, i: usize, j: usize) -> [[f64; 2]; 2] {
        match self.curved {
            None => {
                let (metric, nodes) = (self.straight.lane(lane), &line.basis.nodes);
                [metric.cofactor1(nodes[i]), metric.cofactor2(nodes[j])]
            }
            Some(curved) => curved.at_node_of(lane, i, j),
        }
    }

    /// h_e, m.
    pub fn h(&self) -> &'a F8 {
        &self.straight.h
    }
}

/// From what length over h on the face of a cell is long. h of a rectangle a x b is 2/(1/a + 1/b).
const LONG: f64 = 2.5;

/// Metric terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// The maps of the corners of each block.
    pub blocks: Vec<Metric<F8>>,
    /// Corners X, m: `[block][corner][2]`.
    pub corners: Vec<F8>,
    /// Of the blocks with curved cells; none where there are no such cells.
    curved: Option<Curved>,
}

impl Geometry {
    /// Metric terms of all blocks.
    pub fn new(mesh: &Mesh, blocks: &Blocks, line: &Line) -> Self {
        let mut out = Self { blocks: vec![], corners: vec![], curved: Curved::of(mesh, blocks, line) };
        for cells in &blocks.cells {
            out.push(cells.map(|cell| mesh.map(cell)));
        }
        out
    }

    fn push(&mut self, cells: [CellMap; LANES]) {
        let corners = cells.each_ref().map(|cell| &cell.corners);
        let number = |of: &dyn Fn(&map::Corners) -> f64| F8(std::array::from_fn(|lane| of(corners[lane])));
        let mut metric = Metric {
            along1: [0, 1].map(|k| number(&|x| x[1][k] - x[0][k])),
            along2: [0, 1].map(|k| number(&|x| x[3][k] - x[0][k])),
            twist: [0, 1].map(|k| number(&|x| (x[0][k] - x[1][k]) + (x[2][k] - x[3][k]))),
            inverse_length: [F8::ZERO; FACES],
            h: F8(cells.each_ref().map(map::h_e)),
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

    /// The metric terms of a block. (No call where no cell is curved: four a block and stage took 45 instructions a cell and step.)
    #[inline(always)]
    pub fn of(&self, block: usize) -> BlockMetric<'_> {
        let curved = match &self.curved {
            None => None,
            Some(curved) => curved.block(block),
        };
        BlockMetric { straight: &self.blocks[block], curved }
    }

    /// The map of the cell in a lane of a block.
    pub fn map_of(&self, block: usize, lane: usize) -> CellMap {
        let corner = |corner: usize| [0, 1].map(|k| self.corners[(block * 4 + corner) * 2 + k].0[lane]);
        let bulge = self.curved.as_ref().and_then(|curved| curved.bulge(block, lane));
        CellMap { corners: std::array::from_fn(corner), bulge }
    }

    /// h_e of all cells, m, by block.
    pub fn h(&self) -> impl Iterator<Item = &F8> {
        self.blocks.iter().map(|metric| &metric.h)
    }

    /// Whether a face of a cell is longer than [`LONG`] h, as in rectangles of more than 1 : 4.
    pub fn has_long_cells(&self) -> bool {
        let mut lanes = self.blocks.iter().flat_map(|metric| (0..LANES).map(|lane| metric.lane(lane)));
        lanes.any(|metric| (0..FACES).any(|face| metric.length(face) > LONG * metric.h))
    }

    /// The diagonal mass matrix w_a J_a of the cell in a lane of a block, m^2: by node of `line`. On straight cells it is exact.
    pub fn masses(&self, line: &Line, block: usize, lane: usize) -> impl Iterator<Item = f64> {
        let metric = self.of(block);
        let nodes = (0..line.m).flat_map(move |i| (0..line.m).map(move |j| (i, j)));
        nodes.map(move |(i, j)| {
            let weight = line.basis.weights[i] * line.basis.weights[j];
            let [one, two] = metric.at_node_of(line, lane, i, j);
            weight * determinant(one, two)
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let curved = self.curved.as_ref().map_or(0, Curved::bytes);
        size_of_val(&self.blocks[..]) + size_of_val(&self.corners[..]) + curved
    }
}
