//! Transfer between material points and grid nodes (18), (22) and derivatives at the points (20).

use super::matrix::{Matrix, Pool, classes};
use super::{Blocks, Line};
use crate::basis::MovingLeastSquares;
use crate::cloud::Cloud;
use crate::error::Error;
use crate::lane::{Coefficient, F8, LANES};
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

/// Where the predictor samples the law.
#[derive(Debug, Clone, Copy)]
pub enum Sampling<'a> {
    /// At the grid nodes, chi = Phi: ADER-DGFEM.
    Nodes,
    /// At the material points: ADER-DGMPM.
    Cloud(&'a Cloud),
}

impl<'a> Sampling<'a> {
    /// Parent coordinates of the points of a cell; `nodes` are those of the grid.
    pub fn of(&self, nodes: &'a [[f64; 2]], cell: usize) -> &'a [[f64; 2]] {
        match self {
            Sampling::Nodes => nodes,
            Sampling::Cloud(cloud) => cloud.of(cell),
        }
    }

    /// Cells with the same points to the bit: (class of each cell, a cell of each class).
    pub fn classes(&self, nodes: &'a [[f64; 2]], cells: usize) -> (Vec<usize>, Vec<usize>) {
        classes(cells, |cell| self.of(nodes, cell).iter().flatten().map(|x| x.to_bits()).collect::<Vec<u64>>())
    }
}

/// Matrices of the points of all blocks.
pub type PointPool = Pool<PointMatrices<f64>, PointMatrices<F8>>;

/// Matrices of one class of clouds, in parent coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct PointMatrices<C> {
    /// P2G at the nodes: chi_p(xi_a), (N+1)^2 x N_p.
    pub to_nodes: Matrix<C>,
    /// G2P: Phi_a(xi_p), N_p x (N+1)^2.
    pub from_nodes: Matrix<C>,
    /// d chi_q / d xi_b (xi_p), N_p x N_p, b = 1, 2.
    pub slope: [Matrix<C>; 2],
}

impl<C: Coefficient> PointMatrices<C> {
    /// N_p, the points of a cell (of the fullest cell of the block).
    pub fn points(&self) -> usize {
        self.from_nodes.rows
    }

    /// All matrices in the order of storage.
    pub fn matrices(&self) -> [&Matrix<C>; 4] {
        [&self.to_nodes, &self.from_nodes, &self.slope[0], &self.slope[1]]
    }
}

/// The points of all blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Matrices by class.
    pub pool: PointPool,
    /// First entry of each block in `metric`, in points (length: blocks + 1).
    pub first: Vec<usize>,
    /// dxi_b/dX_a at the points, 1/m: `[point of block][b][a]`.
    pub metric: Vec<F8>,
    /// Parent coordinates of the points: `[point of block][2]`.
    pub parent: Vec<F8>,
}

impl Points {
    /// The matrices of all blocks: what is worth storing.
    ///
    /// # Errors
    /// The first cell whose points cannot carry Q_N.
    pub fn matrices(mesh: &Mesh, blocks: &Blocks, line: &Line, sampling: Sampling) -> Result<PointPool, Error> {
        let nodes = line.nodes();
        let of = |cell: usize| sampling.of(&nodes, cell);
        let (class, examples) = sampling.classes(&nodes, mesh.cells.len());
        let build = |&cell: &usize| match sampling {
            Sampling::Nodes => Ok(at_nodes(line)),
            Sampling::Cloud(_) => at_points(line, of(cell), mesh.number(cell)),
        };
        let all = examples.par_iter().map(build).collect::<Result<Vec<_>, Error>>()?;
        Ok(Pool::new(&blocks.cells, &class, all, interleave))
    }

    /// Adds the metric terms to the matrices.
    pub fn new(mesh: &Mesh, blocks: &Blocks, line: &Line, sampling: Sampling, pool: PointPool) -> Self {
        let nodes = line.nodes();
        let of = |cell: usize| sampling.of(&nodes, cell);
        let mut out = Self { pool, first: vec![0], metric: vec![], parent: vec![] };
        for cells in &blocks.cells {
            let padded = cells.map(|cell| of(cell).len()).into_iter().max().unwrap_or(0);
            for p in 0..padded {
                out.push(cells.map(|cell| (mesh.corners(cell), *of(cell).get(p).unwrap_or(&of(cell)[0]))));
            }
            out.first.push(out.parent.len() / 2);
        }
        out
    }

    fn push(&mut self, at: [([[f64; 2]; 4], [f64; 2]); LANES]) {
        let inverse = at.map(|(corners, xi)| {
            let [first, second] = map::inverse(&map::jacobian(&corners, xi));
            [first[0], first[1], second[0], second[1]]
        });
        self.metric.extend((0..4).map(|k| F8(inverse.map(|m| m[k]))));
        self.parent.extend((0..2).map(|k| F8(at.map(|(_, xi)| xi[k]))));
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let shared = self.pool.shared.iter().flat_map(|m| m.matrices()).map(|m| m.data.len() * 8).sum::<usize>();
        let own = self.pool.own.iter().flat_map(|m| m.matrices()).map(|m| m.data.len() * 64).sum::<usize>();
        shared + own + (self.metric.len() + self.parent.len()) * 64
    }
}

/// The Gauss nodes themselves as points.
fn at_nodes(line: &Line) -> PointMatrices<f64> {
    let n = line.m * line.m;
    let identity: Vec<f64> = (0..n * n).map(|e| if e / n == e % n { 1.0 } else { 0.0 }).collect();
    let slopes: Vec<[Vec<f64>; 2]> = (0..n).map(|a| line.basis.gradients_2d(line.basis.node_2d(a))).collect();
    PointMatrices {
        to_nodes: Matrix::new(n, n, identity.clone()),
        from_nodes: Matrix::new(n, n, identity),
        slope: [0, 1].map(|b| Matrix::new(n, n, slopes.iter().flat_map(|s| s[b].clone()).collect())),
    }
}

/// Moving least squares on any unisolvent cloud.
fn at_points(line: &Line, xi: &[[f64; 2]], number: u64) -> Result<PointMatrices<f64>, Error> {
    let (n, np) = (line.m * line.m, xi.len());
    let fit = MovingLeastSquares::new(line.m - 1, xi)?;
    if fit.rank < n {
        return Err(Error::input(
            format!(
                "cell {number} cannot carry degree {}: its {np} points have rank {}, needed is {n}",
                line.m - 1,
                fit.rank
            ),
            format!(
                "put at least {} x {} points in general position into each cell, or lower scheme.degree",
                line.m, line.m
            ),
        ));
    }
    let slopes: Vec<[Vec<f64>; 2]> = xi.iter().map(|&x| fit.gradients(x)).collect();
    let to_nodes = (0..n).flat_map(|a| fit.values(line.basis.node_2d(a))).collect();
    let from_nodes = xi.iter().flat_map(|&x| line.basis.values_2d(x)).collect();
    Ok(PointMatrices {
        to_nodes: Matrix::new(n, np, to_nodes),
        from_nodes: Matrix::new(np, n, from_nodes),
        slope: [0, 1].map(|b| Matrix::new(np, np, slopes.iter().flat_map(|s| s[b].clone()).collect())),
    })
}

/// Eight different cells side by side. Cells with fewer points than the fullest get copies of their first point, which
/// no fit uses (zero columns).
fn interleave(lanes: [&PointMatrices<f64>; LANES]) -> PointMatrices<F8> {
    let np = lanes.iter().map(|m| m.points()).max().unwrap_or(0);
    let padded = lanes.map(|lane| PointMatrices {
        to_nodes: pad(&lane.to_nodes, lane.to_nodes.rows, np),
        from_nodes: pad(&lane.from_nodes, np, lane.from_nodes.columns),
        slope: [0, 1].map(|b| pad(&lane.slope[b], np, np)),
    });
    PointMatrices {
        to_nodes: Matrix::interleave(padded.each_ref().map(|m| &m.to_nodes)),
        from_nodes: Matrix::interleave(padded.each_ref().map(|m| &m.from_nodes)),
        slope: [0, 1].map(|b| Matrix::interleave(padded.each_ref().map(|m| &m.slope[b]))),
    }
}

/// More rows by repeating the first, more columns by zeros.
fn pad(matrix: &Matrix<f64>, rows: usize, columns: usize) -> Matrix<f64> {
    let mut data = Vec::with_capacity(rows * columns);
    for r in 0..rows {
        let row = matrix.row(if r < matrix.rows { r } else { 0 });
        data.extend_from_slice(row);
        data.resize((r + 1) * columns, 0.0);
    }
    Matrix::new(rows, columns, data)
}
