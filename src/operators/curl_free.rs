//! LCF: the locally curl-free projection of the rows of F (design section 5; not in the paper).

use super::matrix::{Matrix, Pool, Share, classes};
use super::{Blocks, Line};
use crate::lane::{Coefficient, F8};
use crate::mesh::{Mesh, map};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Pivots below this share of the largest are rounding: the set of columns is rank-deficient by construction,
/// with ranks 5, 10, 17 of 8, 18, 32 on affine cells and 6, 12, 20 on others (N = 1, 2, 3).
const RANK_TOLERANCE: f64 = 1e-9;

/// C of all blocks.
pub type CurlPool = Pool<Matrix<f64>, Matrix<F8>>;

/// The complement of the gradients: F - Pi F = C (C^T W F), C of 2 (N+1)^2 rows (direction, node), W the mass matrix.
///
/// Pi projects (F_i1, F_i2) at the nodes, in the weights w_a J_a, onto the gradients of Q_N in parent coordinates and
/// of P_(N+1) in X. Uniform F and the cell mean are kept exactly. Units of C: 1/m.
#[derive(Debug, Clone, PartialEq)]
pub struct CurlFree {
    /// C by class of congruent cells.
    pub pool: CurlPool,
    /// For each shared matrix of the pool its [`Halves`], where cells of the class are parallelograms.
    pub halves: Vec<Option<Halves>>,
}

/// C C^T W of a parallelogram, by parity.
///
/// Half a turn about the middle leaves a parallelogram as it is and takes node a to (N+1)^2 - 1 - a. So the parts
/// F_a + F_a' and F_a - F_a' of each pair of nodes are projected on their own, by matrices of half the size, on rows
/// (direction, a), a up to the middle. They are so small that one product is no more work than C^T W and then C.
#[derive(Debug, Clone, PartialEq)]
pub struct Halves {
    /// On F_a + F_a' of ((N+1)^2 + 1)/2 nodes; of the node in the middle, where there is one, on F itself.
    pub even: Matrix<f64>,
    /// On F_a - F_a' of (N+1)^2/2 nodes.
    pub odd: Matrix<f64>,
}

impl CurlFree {
    /// From the matrices of all blocks.
    pub fn new(pool: CurlPool, mesh: &Mesh, blocks: &Blocks, line: &Line) -> Self {
        let mut halves = vec![None; pool.shared.len()];
        let mut seen = vec![false; pool.shared.len()];
        for (share, cells) in pool.share.iter().zip(&blocks.cells) {
            if let Share::Shared(k) = *share
                && !std::mem::replace(&mut seen[k], true)
            {
                let corners = mesh.corners(cells[0]);
                let masses: Vec<f64> = (0..line.m * line.m).map(|a| mass(&corners, line, a)).collect();
                halves[k] = Halves::of(&pool.shared[k], &masses);
            }
        }
        Self { pool, halves }
    }

    /// Builds C for all blocks.
    pub fn matrices(mesh: &Mesh, blocks: &Blocks, line: &Line) -> CurlPool {
        let size = mesh.nodes.iter().flatten().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        // Cells whose edges agree to 1e-12 of the mesh are congruent up to rounding of the node coordinates.
        let key = |cell: usize| {
            let c = mesh.corners(cell);
            [1, 2, 3].map(|k| [0, 1].map(|i| ((c[k][i] - c[0][i]) / (size * 1e-12)).round() as i64))
        };
        let (class, examples) = classes(mesh.cells.len(), key);
        let all: Vec<_> = examples.par_iter().map(|&cell| complement(&mesh.corners(cell), line)).collect();
        let columns = all.iter().map(|c| c.columns).max().unwrap_or(0);
        Pool::new(&blocks.cells, &class, all, |lanes| {
            let padded = lanes.map(|c| widen(c, columns));
            Matrix::interleave(padded.each_ref())
        })
    }

    /// F <- Pi F of one cell: `f` as `[component][node]`, `mass` its w_a J_a. The step has its own, which works on eight cells.
    pub fn project(&self, block: usize, lane: usize, mass: impl Fn(usize) -> f64, f: &mut [f64]) {
        match self.pool.share[block] {
            Share::Shared(k) => project(&self.pool.shared[k], |e| *e, mass, f),
            Share::Own(k) => project(&self.pool.own[k], |e| e.0[lane], mass, f),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.pool.shared.iter().map(|c| c.data.len() * 8).sum::<usize>()
            + self.pool.own.iter().map(|c| c.data.len() * 64).sum::<usize>()
            + self.halves.iter().flatten().map(|h| (h.even.data.len() + h.odd.data.len()) * 8).sum::<usize>()
    }
}

impl Halves {
    /// Those of a complement, none where half a turn changes the projection.
    fn of(c: &Matrix<f64>, masses: &[f64]) -> Option<Self> {
        let n = masses.len();
        let full = |r: usize, s: usize| {
            let products = c.row(r).iter().zip(c.row(s)).map(|(a, b)| a * b);
            products.sum::<f64>() * masses[s % n]
        };
        let turned = |r: usize| r / n * n + (n - 1 - r % n);
        // The entries of a projection are of order one.
        let same = |r: usize, s: usize| (full(r, s) - full(turned(r), turned(s))).abs() <= RANK_TOLERANCE;
        if !(0..2 * n).all(|r| (0..2 * n).all(|s| same(r, s))) {
            return None;
        }
        let half = |nodes: usize, sign: f64| {
            let row = |k: usize| k / nodes * n + k % nodes;
            let entry = |r: usize, s: usize| {
                let mean = |s: usize| 0.5 * (full(r, s) + sign * full(turned(r), s));
                if s == turned(s) { mean(s) } else { 0.5 * (mean(s) + sign * mean(turned(s))) }
            };
            let all = (0..2 * nodes).flat_map(|r| (0..2 * nodes).map(move |s| (r, s)));
            Matrix::new(2 * nodes, 2 * nodes, all.map(|(r, s)| entry(row(r), row(s))).collect())
        };
        Some(Self { even: half(n.div_ceil(2), 1.0), odd: half(n / 2, -1.0) })
    }
}

/// Both rows of F (rows of C long) less C (C^T W F).
fn project<C: Coefficient>(c: &Matrix<C>, number: impl Fn(&C) -> f64, mass: impl Fn(usize) -> f64, f: &mut [f64]) {
    for row in f.chunks_exact_mut(c.rows) {
        let mut coefficients = vec![0.0; c.columns];
        for (r, f) in row.iter().enumerate() {
            let weighted = mass(r % (c.rows / 2)) * f;
            coefficients.iter_mut().zip(c.row(r)).for_each(|(sum, entry)| *sum += number(entry) * weighted);
        }
        for (r, f) in row.iter_mut().enumerate() {
            *f -= coefficients.iter().zip(c.row(r)).map(|(k, entry)| k * number(entry)).sum::<f64>();
        }
    }
}

/// Zero columns up to `columns`: cells of one block may have complements of different sizes.
fn widen(c: &Matrix<f64>, columns: usize) -> Matrix<f64> {
    let entry = |e: usize| c.row(e / columns).get(e % columns).copied().unwrap_or(0.0);
    Matrix::new(c.rows, columns, (0..c.rows * columns).map(entry).collect())
}

/// C of one cell: W^(-1/2) times an orthonormal basis of the complement of W^(1/2) times the gradients.
fn complement(corners: &[[f64; 2]; 4], line: &Line) -> Matrix<f64> {
    let n = line.m * line.m;
    let root: Vec<f64> = (0..n).map(|a| mass(corners, line, a).sqrt()).collect();
    let gradients = gradients(corners, line);
    // At least square (zero columns), so that Q spans the whole space.
    let size = (2 * n).max(gradients.len());
    let mut matrix = DMatrix::zeros(2 * n, size);
    for (k, column) in gradients.iter().enumerate() {
        let weighted: Vec<f64> = column.iter().enumerate().map(|(r, g)| g * root[r % n]).collect();
        let norm = weighted.iter().map(|g| g * g).sum::<f64>().sqrt();
        for (r, g) in weighted.into_iter().enumerate() {
            matrix[(r, k)] = g / norm;
        }
    }
    let qr = matrix.col_piv_qr();
    let (u, r) = (qr.q(), qr.r());
    // Pivoted: the diagonal of R falls, and columns of Q behind the rank span the complement.
    let outside: Vec<usize> = (0..2 * n).filter(|&k| r[(k, k)].abs() <= RANK_TOLERANCE * r[(0, 0)].abs()).collect();
    let entries = (0..2 * n).flat_map(|r| outside.iter().map(move |&k| (r, k))).map(|(r, k)| u[(r, k)] / root[r % n]);
    Matrix::new(2 * n, outside.len(), entries.collect())
}

fn mass(corners: &[[f64; 2]; 4], line: &Line, a: usize) -> f64 {
    line.basis.weight_2d(a) * map::determinant(&map::jacobian(corners, line.basis.node_2d(a)))
}

/// Columns [direction][node]: gradients in X of the monomials of Q_N in xi and of P_(N+1) in (X - Xc)/h.
fn gradients(corners: &[[f64; 2]; 4], line: &Line) -> Vec<Vec<f64>> {
    let (m, centre, h) = (line.m as i32, map::position(corners, [0.5, 0.5]), map::h_e(corners));
    let nodes = line.nodes();
    let mut columns = Vec::new();
    for (i, j) in (0..m).flat_map(|i| (0..m).map(move |j| (i, j))).filter(|&(i, j)| i + j > 0) {
        columns.push(stack(nodes.iter().map(|&xi| {
            let inverse = map::inverse(&map::jacobian(corners, xi));
            // Monomials about the middle are better conditioned and span the same space.
            let g = monomial_gradient([xi[0] - 0.5, xi[1] - 0.5], i, j);
            [0, 1].map(|axis| g[0] * inverse[0][axis] + g[1] * inverse[1][axis])
        })));
    }
    for (i, j) in (0..=m).flat_map(|i| (0..=m - i).map(move |j| (i, j))).filter(|&(i, j)| i + j > 0) {
        columns.push(stack(nodes.iter().map(|&xi| {
            let x = map::position(corners, xi);
            monomial_gradient([(x[0] - centre[0]) / h, (x[1] - centre[1]) / h], i, j)
        })));
    }
    columns
}

fn stack(gradients: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
    let (first, second): (Vec<f64>, Vec<f64>) = gradients.map(|g| (g[0], g[1])).unzip();
    [first, second].concat()
}

/// Gradient of x^i y^j.
fn monomial_gradient(x: [f64; 2], i: i32, j: i32) -> [f64; 2] {
    let slope = |x: f64, k: i32| if k == 0 { 0.0 } else { k as f64 * x.powi(k - 1) };
    [slope(x[0], i) * x[1].powi(j), x[0].powi(i) * slope(x[1], j)]
}
