//! Transfer between material points and grid nodes (18), (22) and derivatives at the points (20).

use super::matrix::{Matrix, Pool, Share, classes};
use super::{Blocks, Line, PointMatrices};
use crate::cloud::Cloud;
use crate::error::Error;
use crate::lane::{F8, LANES};
use crate::mesh::{Mesh, map};
use rayon::prelude::*;

/// The places where the predictor evaluates the law.
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

    /// Classes of cells with the same points to the bit: (class of each cell, a cell of each class).
    pub fn classes(&self, nodes: &'a [[f64; 2]], cells: usize) -> (Vec<usize>, Vec<usize>) {
        classes(cells, |cell| self.of(nodes, cell).iter().flatten().map(|x| x.to_bits()).collect::<Vec<u64>>())
    }
}

/// Matrices of the points of all blocks.
pub type PointPool = Pool<PointMatrices<f64>, PointMatrices<F8>>;

/// The points of all blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Matrices by class.
    pub pool: PointPool,
    /// First point of each block in `parent` (length: blocks + 1).
    pub first: Vec<usize>,
    /// First entry of each block in `metric` (length: blocks + 1).
    first_metric: Vec<usize>,
    /// dxi_b/dX_a, 1/m: `[b][a]` at each point, or once for a block, or no entry ([`Points::metric`]).
    metric: Vec<F8>,
    /// Parent coordinates of the points: `[point of block][2]`.
    pub parent: Vec<F8>,
    /// The number of points of each lane of each block. Further points of the lane are copies of its first.
    pub count: Vec<[u32; LANES]>,
}

impl Points {
    /// The matrices of all blocks: the part that is worth storing.
    ///
    /// # Errors
    /// The first cell whose points cannot carry Q_N.
    pub fn matrices(mesh: &Mesh, blocks: &Blocks, line: &Line, sampling: Sampling) -> Result<PointPool, Error> {
        let nodes = line.nodes();
        let of = |cell: usize| sampling.of(&nodes, cell);
        let (class, examples) = sampling.classes(&nodes, mesh.cells.len());
        let build = |&cell: &usize| match sampling {
            Sampling::Nodes => Ok(PointMatrices::at_nodes(line)),
            Sampling::Cloud(_) => PointMatrices::at_points(line, of(cell), mesh.number(cell)),
        };
        let all = examples.par_iter().map(build).collect::<Result<Vec<_>, Error>>()?;
        Ok(Pool::new(&blocks.cells, &class, all, PointMatrices::interleave))
    }

    /// Adds the metric terms to the matrices.
    pub fn new(mesh: &Mesh, blocks: &Blocks, line: &Line, sampling: Sampling, pool: PointPool) -> Self {
        let nodes = line.nodes();
        let of = |cell: usize| sampling.of(&nodes, cell);
        let mut out =
            Self { pool, first: vec![0], first_metric: vec![0], metric: vec![], parent: vec![], count: vec![] };
        for (block, cells) in blocks.cells.iter().enumerate() {
            let padded = cells.map(|cell| of(cell).len()).into_iter().max().unwrap_or(0);
            out.count.push(cells.map(|cell| of(cell).len() as u32));
            let mut metric = Vec::with_capacity(padded);
            for p in 0..padded {
                let xi = cells.map(|cell| *of(cell).get(p).unwrap_or(&of(cell)[0]));
                metric.push(inverse(&cells.map(|cell| mesh.map(cell)), xi));
                out.parent.extend((0..2).map(|k| F8(xi.map(|xi| xi[k]))));
            }
            out.hold(block, metric);
            out.first.push(out.parent.len() / 2);
            out.first_metric.push(out.metric.len());
        }
        out
    }

    /// The same for blocks in another order: place k has block `order[k]`.
    pub(super) fn in_order(self, order: &[usize]) -> Self {
        let mut out = Self {
            first: vec![0],
            first_metric: vec![0],
            metric: vec![],
            parent: vec![],
            count: vec![],
            pool: self.pool,
        };
        for &block in order {
            out.metric.extend_from_slice(&self.metric[self.first_metric[block]..self.first_metric[block + 1]]);
            out.parent.extend_from_slice(&self.parent[2 * self.first[block]..2 * self.first[block + 1]]);
            out.count.push(self.count[block]);
            out.first.push(out.parent.len() / 2);
            out.first_metric.push(out.metric.len());
        }
        Self { pool: out.pool.in_order(order), ..out }
    }

    /// Stores the metric of a block as the predictor needs it. If each lane has its own dense matrices, these take in
    /// the metric, as derivatives along X. If the metric is the same at all points (affine cells, to rounding), it is
    /// stored once.
    fn hold(&mut self, block: usize, metric: Vec<[F8; 4]>) {
        if let Share::Own(k) = self.pool.share[block]
            && let PointMatrices::Dense { slope, .. } = &mut self.pool.own[k]
        {
            return turn(slope, &metric);
        }
        let count = if is_constant(&metric) { 1 } else { metric.len() };
        self.metric.extend(metric[..count.min(metric.len())].as_flattened());
    }

    /// dxi_b/dX_a of a block, 1/m: `[b][a]` at each point; once, if it is the same at all points; no entry, if the
    /// derivatives of its matrices are along X.
    pub fn metric_of(&self, block: usize) -> &[F8] {
        &self.metric[self.first_metric[block]..self.first_metric[block + 1]]
    }

    /// P2G of one lane of a block as a dense matrix, chi_p(X_a): nodes x points.
    pub fn to_nodes(&self, block: usize, lane: usize) -> Matrix<f64> {
        let one = match self.pool.share[block] {
            Share::Shared(k) => self.pool.shared[k].to_dense(),
            Share::Own(k) => self.pool.own[k].lane(lane).to_dense(),
        };
        if let PointMatrices::Dense { to_nodes, .. } = one { to_nodes } else { Matrix::default() }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let shared = self.pool.shared.iter().flat_map(|m| m.matrices()).map(|m| m.data.len() * 8).sum::<usize>();
        let own = self.pool.own.iter().flat_map(|m| m.matrices()).map(|m| m.data.len() * 64).sum::<usize>();
        shared + own + (self.metric.len() + self.parent.len()) * 64 + size_of_val(&self.count[..])
    }
}

/// dxi_b/dX_a `[b][a]` at one point of each lane.
fn inverse(maps: &[map::CellMap; LANES], xi: [[f64; 2]; LANES]) -> [F8; 4] {
    let inverse: [[[f64; 2]; 2]; LANES] =
        std::array::from_fn(|lane| map::inverse(&map::jacobian(&maps[lane], xi[lane])));
    std::array::from_fn(|k| F8(inverse.map(|m| m[k / 2][k % 2])))
}

/// Whether the metric is the same at all points, up to rounding. In cells that are given as parallelograms it differs
/// by 1e-15 times the size of the mesh over the size of the cell.
fn is_constant(metric: &[[F8; 4]]) -> bool {
    (0..LANES).all(|lane| {
        let size = metric.iter().flatten().fold(0.0_f64, |size, m| size.max(m.0[lane].abs()));
        let near = |m: &[F8; 4]| (0..4).all(|k| (m[k].0[lane] - metric[0][k].0[lane]).abs() <= 1e-13 * size);
        metric.iter().all(near)
    })
}

/// From d/dxi_b to d/dX_a = sum_b dxi_b/dX_a d/dxi_b, row by row.
fn turn(slope: &mut [super::Matrix<F8>; 2], metric: &[[F8; 4]]) {
    let [first, second] = slope;
    let columns = first.columns;
    for (e, (a, b)) in first.data.iter_mut().zip(&mut second.data).enumerate() {
        let m = &metric[e / columns];
        for lane in 0..LANES {
            let (x, y) = (a.0[lane], b.0[lane]);
            a.0[lane] = m[0].0[lane] * x + m[2].0[lane] * y;
            b.0[lane] = m[1].0[lane] * x + m[3].0[lane] * y;
        }
    }
}
