//! Metric terms of blocks with curved cells, in memory.
//!
//! The map of a curved cell is of degree 2 in each direction ([`map::Bulge`]), so that J dxi_1/dX = (dX_2/dxi_2, -dX_1/dxi_2) is of
//! degree 2 in xi1 and 1 in xi2, and the other one likewise. What the quadrature of N + 1 Gauss points sees of them is exact:
//!
//! - uniform states stay (free stream): d(phi J dxi_b/dX)/dxi_b is of degree N + 1 along xi_b;
//! - strong and weak form agree: phi psi J dxi_1/dX is of degree 2N + 2 along xi1, its derivative of degree 2N + 1, as along xi2.
//!
//! So what holds of the energy on straight cells holds here (`docs/method.md`). The mass matrix w_a J_a is no exact integral: J is
//! of degree 3. Source: D. A. Kopriva, Metric identities and the discontinuous spectral element method on curvilinear meshes,
//! J. Sci. Comput. 26, 2006.

use super::{Blocks, Cofactors, Line, NodeMetric};
use crate::lane::{F8, LANES, Lanes, load_array};
use crate::mesh::map::{self, Bulge, CellMap};
use crate::mesh::{FACES, Mesh};

/// The place of a block without a curved cell.
const STRAIGHT: u32 = u32::MAX;

/// Metric terms of the blocks that have a curved cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Curved {
    /// The place of each block below, or `STRAIGHT`.
    place: Vec<u32>,
    /// Nodes and face points a direction.
    m: usize,
    /// J dxi_1/dX and J dxi_2/dX at the nodes, m: `[place][node]`.
    nodes: Vec<[F8; 4]>,
    /// Unit outward normal and |dX/ds| (m) at the face points: `[place][face][point]`.
    faces: Vec<[F8; 3]>,
    /// `[place]`, by lane.
    bulges: Vec<[Option<Bulge>; LANES]>,
}

/// Those of a block.
#[derive(Debug, Clone, Copy)]
pub struct CurvedBlock<'a> {
    m: usize,
    nodes: &'a [[F8; 4]],
    faces: &'a [[F8; 3]],
}

impl Curved {
    /// Of the blocks of a mesh; none where no cell is curved.
    pub fn of(mesh: &Mesh, blocks: &Blocks, line: &Line) -> Option<Self> {
        let m = line.m;
        let mut out = Self { place: vec![], m, nodes: vec![], faces: vec![], bulges: vec![] };
        for cells in &blocks.cells {
            let maps = cells.map(|cell| mesh.map(cell));
            let is_curved = maps.iter().any(|map| map.bulge.is_some());
            out.place.push(if is_curved { out.bulges.len() as u32 } else { STRAIGHT });
            if is_curved {
                out.push(&maps, line);
            }
        }
        (!out.bulges.is_empty()).then_some(out)
    }

    fn push(&mut self, maps: &[CellMap; LANES], line: &Line) {
        let nodes = &line.basis.nodes;
        for xi in line.nodes() {
            let of = maps.each_ref().map(|map| map::cofactors(map, xi).concat());
            self.nodes.push(std::array::from_fn(|k| F8(of.each_ref().map(|of| of[k]))));
        }
        for face in 0..FACES {
            for s in nodes {
                let of = maps.each_ref().map(|map| map::outward(map, face, *s));
                let of = of.map(|([a, b], length)| [a, b, length]);
                self.faces.push(std::array::from_fn(|k| F8(of.map(|of| of[k]))));
            }
        }
        self.bulges.push(maps.each_ref().map(|map| map.bulge));
    }

    /// Those of a block; none where all its cells are straight.
    pub fn block(&self, block: usize) -> Option<CurvedBlock<'_>> {
        let (m, place) = (self.m, self.place[block]);
        (place != STRAIGHT).then(|| {
            let place = place as usize;
            let nodes = &self.nodes[place * m * m..(place + 1) * m * m];
            CurvedBlock { m, nodes, faces: &self.faces[place * FACES * m..(place + 1) * FACES * m] }
        })
    }

    /// How the edges of the cell in a lane of a block are curved.
    pub fn bulge(&self, block: usize, lane: usize) -> Option<Bulge> {
        let place = self.place[block];
        if place == STRAIGHT { None } else { self.bulges[place as usize][lane] }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let terms = size_of_val(&self.nodes[..]) + size_of_val(&self.faces[..]);
        terms + size_of_val(&self.place[..]) + size_of_val(&self.bulges[..])
    }
}

impl<'a> CurvedBlock<'a> {
    /// The unit outward normals at the points of the faces, with |dX/ds| there, m.
    #[inline(always)]
    pub fn faces(&self) -> &'a [[F8; 3]] {
        self.faces
    }

    /// The unit outward normal at a point of a face, and |dX/ds| there, m.
    #[inline(always)]
    pub fn at_face<L: Lanes>(&self, face: usize, point: usize) -> ([L; 2], L) {
        let [a, b, length] = load_array::<L, 3>(&self.faces[face * self.m + point]);
        ([a, b], length)
    }

    /// The same of the cell in a lane.
    pub fn at_face_of(&self, lane: usize, face: usize, point: usize) -> ([f64; 2], f64) {
        let [a, b, length] = self.faces[face * self.m + point].map(|x| x.0[lane]);
        ([a, b], length)
    }

    /// J dxi_1/dX and J dxi_2/dX at node (i, j) of the cell in a lane, m.
    pub fn at_node_of(&self, lane: usize, i: usize, j: usize) -> [[f64; 2]; 2] {
        let [a, b, c, d] = self.nodes[i * self.m + j].map(|x| x.0[lane]);
        [[a, b], [c, d]]
    }
}

impl<L: Lanes> Cofactors<L> for CurvedBlock<'_> {
    #[inline(always)]
    fn one(&self, i: usize, j: usize) -> [L; 2] {
        let [a, b, ..] = &self.nodes[i * self.m + j];
        [L::load(a), L::load(b)]
    }

    #[inline(always)]
    fn two(&self, i: usize, j: usize) -> [L; 2] {
        let [.., a, b] = &self.nodes[i * self.m + j];
        [L::load(a), L::load(b)]
    }
}

impl<'a> NodeMetric for CurvedBlock<'a> {
    type At<L: Lanes, const M: usize> = CurvedBlock<'a>;

    #[inline(always)]
    fn cofactors<L: Lanes, const M: usize>(self, _: &Line) -> CurvedBlock<'a> {
        self
    }
}
