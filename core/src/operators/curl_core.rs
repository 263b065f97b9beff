//! Pi of cells of different shapes, by the curl in parent coordinates, which is the same for all cells, and a small
//! matrix of each cell.
//!
//! The components g_k = F_ia dX_a/dxi_k of a gradient are the derivatives of a function in parent coordinates, whatever the
//! cell is. With K those functionals of g at the nodes that vanish on the gradients of Q_N, and J the Jacobian matrices
//! dX/dxi at the nodes, F - Pi F = W^-1 J K^T Z K J^T F for a symmetric Z of (N+1)^2 + 1 rows. Half of Z has a third of the
//! numbers of C, see [`super::CurlFree`], and K is a product of 1D tables.

use super::{Line, Matrix};
use crate::basis::mls::legendre;
use crate::mesh::map::{self, Map};
use nalgebra::DMatrix;

/// K: for g_1, g_2 at the nodes, with P_k the Legendre polynomials,
///
/// - int P_a(xi1) P_c(xi2) (dg_1/dxi2 - dg_2/dxi1), a, c < N: row a N + c;
/// - int P_N(xi1) g_1 at the nodes j of xi2: row N^2 + j;
/// - int P_N(xi2) g_2 at the nodes i of xi1: row N^2 + N + 1 + i.
#[derive(Debug, Clone, PartialEq)]
pub struct Curl {
    /// w_i P_k(x_i) at `[k][i]`, k = 0..=N.
    pub moments: Vec<f64>,
    /// int P_k l_i' at `[k][i]`, k = 0..=N.
    pub slopes: Vec<f64>,
    /// K, columns (k, node).
    pub all: Matrix<f64>,
    /// (K K^T)^-1 K.
    inverse: Matrix<f64>,
}

/// The rows of K for M nodes a direction.
pub const fn functionals(m: usize) -> usize {
    m * m + 1
}

/// The packed numbers of Z. Rows are taken in pairs: first the entries left of the diagonal, the two rows side by side,
/// then the diagonal.
pub const fn numbers(m: usize) -> usize {
    functionals(m) * (functionals(m) + 1) / 2
}

impl Curl {
    /// The tables for the nodes of a line.
    pub fn new(line: &Line) -> Self {
        let (m, basis) = (line.m, &line.basis);
        let degree = m - 1;
        let p: Vec<Vec<f64>> = basis.nodes.iter().map(|x| legendre(degree, *x).0).collect();
        let square = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> { (0..m * m).map(|e| f(e / m, e % m)).collect() };
        let moments = square(&|k, i| basis.weights[i] * p[i][k]);
        let slopes = square(&|k, i| (0..m).map(|q| basis.weights[q] * p[q][k] * line.slope[q * m + i]).sum());
        let (moment, slope) = (|k: usize, i: usize| moments[k * m + i], |k: usize, i: usize| slopes[k * m + i]);
        let entry = |row: usize, axis: usize, i: usize, j: usize| {
            if row < degree * degree {
                let (a, c) = (row / degree, row % degree);
                return if axis == 0 { moment(a, i) * slope(c, j) } else { -slope(a, i) * moment(c, j) };
            }
            let at = row - degree * degree;
            match (axis, at < m) {
                (0, true) if at == j => moment(degree, i),
                (1, false) if at - m == i => moment(degree, j),
                _ => 0.0,
            }
        };
        let (rows, columns) = (functionals(m), 2 * m * m);
        let entries = (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c)));
        let data = entries.map(|(r, c)| entry(r, c / (m * m), c % (m * m) / m, c % m)).collect();
        let all = Matrix::new(rows, columns, data);
        let k = DMatrix::from_row_slice(rows, columns, &all.data);
        // Of full rank: least squares by QR, K^T = Q R, (K K^T)^-1 K = R^-1 Q^T.
        let qr = k.transpose().qr();
        let inverse = qr.r().solve_upper_triangular(&qr.q().transpose()).unwrap_or(k);
        let inverse = Matrix::new(rows, columns, inverse.transpose().as_slice().to_vec());
        Self { moments, slopes, all, inverse }
    }

    /// Z of a cell from its complement C: C = W^-1 J K^T Y, Z = Y Y^T, packed as [`numbers`] says; `masses` are W.
    pub fn core(&self, c: &Matrix<f64>, cell: &impl Map, line: &Line, masses: &[f64]) -> Vec<f64> {
        let n = masses.len();
        // J^-1 W C.
        let parent: Vec<_> = line.nodes().iter().map(|xi| map::inverse(&map::jacobian(cell, *xi))).collect();
        let entry = |r: usize, k: usize| {
            let (axis, a) = (r / n, r % n);
            masses[a] * (parent[a][axis][0] * c.row(a)[k] + parent[a][axis][1] * c.row(n + a)[k])
        };
        let all = (0..2 * n).flat_map(|r| (0..c.columns).map(move |k| (r, k)));
        let y = self.inverse.times(&Matrix::new(2 * n, c.columns, all.map(|(r, k)| entry(r, k)).collect()));
        let z = |r: usize, s: usize| -> f64 { y.row(r).iter().zip(y.row(s)).map(|(a, b)| a * b).sum() };
        let mut out = Vec::with_capacity(numbers(line.m));
        for r in (0..y.rows).step_by(2) {
            let pair = r + 1 < y.rows;
            for s in 0..r {
                out.push(z(r, s));
                out.extend(pair.then(|| z(r + 1, s)));
            }
            out.push(z(r, r));
            if pair {
                out.extend([z(r + 1, r), z(r + 1, r + 1)]);
            }
        }
        out
    }

    /// F <- Pi F of one cell: `f` as `[component][node]`, `core` gives the packed numbers of its Z.
    pub fn project(&self, core: impl Fn(usize) -> f64, cell: &impl Map, line: &Line, masses: &[f64], f: &mut [f64]) {
        let n = masses.len();
        let jacobians: Vec<_> = line.nodes().iter().map(|xi| map::jacobian(cell, *xi)).collect();
        for row in f.chunks_exact_mut(2 * n) {
            let g = (0..2 * n).map(|r| {
                let (axis, a) = (r / n, r % n);
                jacobians[a][0][axis] * row[a] + jacobians[a][1][axis] * row[n + a]
            });
            let g: Vec<f64> = g.collect();
            let values: Vec<f64> =
                (0..self.all.rows).map(|r| self.all.row(r).iter().zip(&g).map(|(k, g)| k * g).sum()).collect();
            let values = times_packed(&core, &values);
            let back = |r: usize| -> f64 { values.iter().enumerate().map(|(k, v)| self.all.row(k)[r] * v).sum() };
            for a in 0..n {
                let (one, two) = (back(a), back(n + a));
                row[a] -= (jacobians[a][0][0] * one + jacobians[a][0][1] * two) / masses[a];
                row[n + a] -= (jacobians[a][1][0] * one + jacobians[a][1][1] * two) / masses[a];
            }
        }
    }
}

/// Z x.
fn times_packed(z: impl Fn(usize) -> f64, x: &[f64]) -> Vec<f64> {
    let (mut out, mut at) = (vec![0.0; x.len()], 0);
    let mut add = |r: usize, s: usize| {
        let z = z(at);
        at += 1;
        out[r] += z * x[s];
        if r != s {
            out[s] += z * x[r];
        }
    };
    for r in (0..x.len()).step_by(2) {
        let pair = r + 1 < x.len();
        for s in 0..r {
            add(r, s);
            if pair {
                add(r + 1, s);
            }
        }
        add(r, r);
        if pair {
            add(r + 1, r);
            add(r + 1, r + 1);
        }
    }
    out
}
