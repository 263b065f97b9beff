//! Metric terms of bilinear cells, per block of 8.

use super::{Blocks, Line};
use crate::lane::{F8, LANES};
use crate::mesh::{FACE_CORNERS, Mesh, map};

/// Metric terms. J_a is the determinant of dX/dxi at node a (an area, m^2; not the jacobian of F).
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// J dxi_b / dX_a at the nodes, m: `[block][node][b][a]`.
    pub cofactor: Vec<F8>,
    /// The diagonal, exact mass matrix w_a J_a, m^2: `[block][node]`.
    pub mass: Vec<F8>,
    /// Its inverse, m^-2: `[block][node]`.
    pub inverse_mass: Vec<F8>,
    /// Unit outward normals: `[block][face][2]`.
    pub normal: Vec<F8>,
    /// Lengths of the faces, m: `[block][face]`.
    pub length: Vec<F8>,
    /// Corners X, m: `[block][corner][2]`.
    pub corners: Vec<F8>,
    /// h_e, m: `[block]`.
    pub h: Vec<F8>,
}

impl Geometry {
    /// Metric terms of all blocks at the nodes of `line`.
    pub fn new(mesh: &Mesh, blocks: &Blocks, line: &Line) -> Self {
        let mut out = Self {
            cofactor: vec![],
            mass: vec![],
            inverse_mass: vec![],
            normal: vec![],
            length: vec![],
            corners: vec![],
            h: vec![],
        };
        for cells in &blocks.cells {
            out.push(cells.map(|cell| mesh.corners(cell)), line);
        }
        out
    }

    fn push(&mut self, corners: [[[f64; 2]; 4]; LANES], line: &Line) {
        for a in 0..line.m * line.m {
            let jacobians = corners.map(|c| map::jacobian(&c, line.basis.node_2d(a)));
            let cofactors = jacobians.map(cofactor);
            self.cofactor.extend((0..4).map(|k| F8(cofactors.map(|c| c[k]))));
            let mass = jacobians.map(|j| line.basis.weight_2d(a) * map::determinant(&j));
            self.mass.push(F8(mass));
            self.inverse_mass.push(F8(mass.map(|m| 1.0 / m)));
        }
        for face in 0..4 {
            let faces = corners.map(|c| outward(&c, face));
            self.normal.extend((0..2).map(|k| F8(faces.map(|(n, _)| n[k]))));
            self.length.push(F8(faces.map(|(_, length)| length)));
        }
        for corner in 0..4 {
            self.corners.extend((0..2).map(|k| F8(corners.map(|c| c[corner][k]))));
        }
        self.h.push(F8(corners.map(|c| map::h_e(&c))));
    }

    /// Corners of the cell in a lane of a block.
    pub fn corners_of(&self, block: usize, lane: usize) -> [[f64; 2]; 4] {
        std::array::from_fn(|corner| std::array::from_fn(|k| self.corners[(block * 4 + corner) * 2 + k].0[lane]))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let all = [&self.cofactor, &self.mass, &self.inverse_mass, &self.normal, &self.length, &self.corners, &self.h];
        all.iter().map(|v| std::mem::size_of_val(&v[..])).sum()
    }
}

/// J dxi_b/dX_a as `[b][a]`, from dX_a/dxi_b as `[a][b]`.
pub fn cofactor(j: [[f64; 2]; 2]) -> [f64; 4] {
    [j[1][1], -j[0][1], -j[1][0], j[0][0]]
}

/// Unit outward normal and length of a face (corners run counter-clockwise).
fn outward(corners: &[[f64; 2]; 4], face: usize) -> ([f64; 2], f64) {
    let [a, b] = FACE_CORNERS[face].map(|k| corners[k]);
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]);
    // Faces 1 and 2 run counter-clockwise: outward is to their right; the others run clockwise.
    let sign = if face == 1 || face == 2 { 1.0 } else { -1.0 };
    ([sign * along[1] / length, -sign * along[0] / length], length)
}
